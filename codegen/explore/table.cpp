#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "codegen/explore/exploration.h"

namespace tightrope::codegen::explore {
namespace {

using Json = nlohmann::ordered_json;

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.3g}", x) : "inf"; }

std::string time_text(const Entry& entry) {
  if (entry.time.median == 0) return "-";
  return fmt::format("{:.1f}", entry.time.median);
}

std::string row(const Exploration& exploration, const Entry& entry, std::size_t width) {
  const std::size_t stage = exploration.stages.size() - 1;
  const Accuracy& a = entry.accuracy;
  const bool bounded = entry.candidate.scheme.bound != BoundMode::none;
  const std::string undecided = bounded ? fmt::format("{:.1f} %", 100 * a.undecided) : "";
  const std::string remark = !a.sound ? "UNSOUND" : bounded ? "" : fmt::format("{:.1f} % wrong", 100 * a.wrong);
  return fmt::format("{} {:<{}} {:>5} {:>5}{} {:>9} {:>9} {:>9} {:>8} {}", entry.on_front ? '*' : ' ',
                     entry.candidate.name(), width, entry.candidate.values(stage).total(),
                     entry.candidate.bounds(stage).total(),
                     exploration.timed ? fmt::format(" {:>8}", time_text(entry)) : "", bounded ? number(a.size) : "",
                     bounded ? number(a.median_ratio) : "", bounded ? number(a.p99_ratio) : "", undecided, remark);
}

std::string without_trailing_blanks(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

Json to_json(const OperationCount& count) {
  return {{"total", count.total()},           {"sums", count.sums},
          {"products", count.products},       {"divisions", count.divisions},
          {"comparisons", count.comparisons}, {"exact", count.exact}};
}

Json finite_or_null(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json to_json(const Exploration& exploration, const Entry& entry) {
  const std::size_t stage = exploration.stages.size() - 1;
  const Scheme& scheme = entry.candidate.scheme;
  const Accuracy& a = entry.accuracy;
  const char* const sums[] = {"written", "balanced", "factored"};
  Json json = {
      {"scheme", entry.candidate.name()},
      {"aliases", entry.candidate.aliases},
      {"bound", name(scheme.bound)},
      {"products", scheme.products == dsl::ProductScheme::direct ? "direct" : "karatsuba"},
      {"evaluation", scheme.evaluation == dsl::EvaluationScheme::horner ? "horner" : "casteljau"},
      {"sums", sums[static_cast<int>(scheme.sums)]},
      {"fma", scheme.fma},
      {"recompute", scheme.recomputes},
      {"float_first", scheme.float_first},
      {"front", entry.on_front},
      {"dismissed", entry.dismissed},
      {"value_operations", to_json(entry.candidate.values(stage))},
      {"bound_operations", to_json(entry.candidate.bounds(stage))},
  };
  if (entry.time.median > 0) {
    json["nanoseconds"] = {{"median", entry.time.median},
                           {"lower_quartile", entry.time.lower_quartile},
                           {"upper_quartile", entry.time.upper_quartile}};
  }
  json["sound"] = a.sound;
  if (scheme.bound != BoundMode::none) {
    json["bound_size"] = finite_or_null(a.size);
    json["bound_to_error"] = {{"median", finite_or_null(a.median_ratio)}, {"p99", finite_or_null(a.p99_ratio)}};
    json["undecided_near_zero"] = a.undecided;
  }
  json["wrong_near_zero"] = a.wrong;
  return json;
}

}  // namespace

std::string text(const Exploration& exploration) {
  std::size_t combinations = 0;
  std::size_t width = 0;
  std::vector<std::string> dismissed;
  for (const Entry& entry : exploration.entries) {
    if (!entry.dismissed) width = std::max(width, entry.candidate.name().size());
    combinations += 1 + entry.candidate.aliases.size();
    if (entry.dismissed) dismissed.push_back(entry.candidate.name());
  }
  std::string result = fmt::format(
      "{}, stages {}, inputs {}: {} schemes differ, of {} combinations\n"
      "{} {} inputs, {} inputs near zero; bounds in units of those of {}\n",
      exploration.predicate, fmt::join(exploration.stages, ", "), name(exploration.inputs), exploration.entries.size(),
      combinations, exploration.rows, exploration.given_inputs ? "given" : "random", exploration.near_zero,
      exploration.reference);
  if (exploration.timed) result += fmt::format("nanoseconds a call: medians, compiled with {}\n", exploration.flags);
  result +=
      without_trailing_blanks(fmt::format("\n{:<{}} {:>11}{} {:>9} {:>19} {:>9}", "", width + 2, "operations",
                                          exploration.timed ? "         " : "", "bound", "bound / error", "near zero"));
  result += fmt::format("  {:<{}} {:>5} {:>5}{} {:>9} {:>9} {:>9} {:>8}\n", "scheme", width, "value", "bound",
                        exploration.timed ? fmt::format(" {:>8}", "ns") : "", "size", "median", "p99", "open");
  for (const Entry& entry : exploration.entries) {
    if (!entry.dismissed) result += without_trailing_blanks(row(exploration, entry, width));
  }
  result += fmt::format("* on the front of {} against size of bound\n", exploration.timed ? "time" : "operations");
  if (!dismissed.empty()) {
    result += fmt::format(
        "left out, more than {} times the operations of one with the same bound that is as tight (--all has them):\n",
        dismissal_factor);
    for (const std::string& scheme : dismissed) result += "  " + scheme + "\n";
  }
  return result + "\n" + legend();
}

std::string json(const Exploration& exploration) {
  Json result = {{"predicate", exploration.predicate},
                 {"stages", exploration.stages},
                 {"real", name(exploration.inputs)},
                 {"timed", exploration.timed},
                 {"flags", exploration.timed ? Json(exploration.flags) : Json(nullptr)},
                 {"inputs", exploration.given_inputs ? "given" : "random"},
                 {"samples", exploration.rows},
                 {"near_zero", exploration.near_zero},
                 {"reference", exploration.reference}};
  result["schemes"] = Json::array();
  for (const Entry& entry : exploration.entries) result["schemes"].push_back(to_json(exploration, entry));
  return result.dump(2) + "\n";
}

}  // namespace tightrope::codegen::explore
