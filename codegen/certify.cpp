#include "codegen/certify.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "codegen/certificate.h"
#include "codegen/gappa.h"
#include "codegen/interface.h"
#include "codegen/precision.h"
#include "codegen/simplify.h"
#include "codegen/static_bound.h"
#include "dsl/evaluate.h"

namespace tightrope::codegen {
namespace {

using Verdict = Certificate::Verdict;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Corners of the box that are tried for one in which every group of inputs reaches its maximum.
constexpr int corners = 64;
/// Gappa's bound is called much smaller from here on.
constexpr double much = 1.5;

/// The largest bound over corners of the box: the inputs at either end of their ranges, the first time by turns.
template <class Real>
std::vector<double> bounds_at_corners(const dsl::Predicate& predicate, const BoundedPredicate& bounded,
                                      const OutputBound& output) {
  std::vector<double> result(output.elements.size(), 0);
  const std::size_t n = predicate.slots.size();
  std::uint64_t state = 1;
  for (int corner = 0; corner < corners; ++corner) {
    std::vector<Real> slots(2 * n, Real(0));
    for (std::size_t i = 0; i < n; ++i) {
      const auto& parameter = predicate.parameters[static_cast<std::size_t>(predicate.slots[i].parameter)];
      state = state * 6364136223846793005U + 1442695040888963407U;
      const bool negative = corner == 0 ? predicate.slots[i].parameter % 2 == 1 : state >> 63 != 0;
      slots[i] = static_cast<Real>(negative ? -*parameter.range : *parameter.range);
      if (parameter.bounded) slots[n + i] = static_cast<Real>(*parameter.range);
    }
    const auto v = dsl::evaluate<Real>(bounded.graph, slots);
    for (std::size_t e = 0; e < result.size(); ++e) {
      const auto bound = static_cast<double>(v[static_cast<std::size_t>(output.elements[e].bound)]);
      result[e] = std::isnan(bound) ? infinity : std::max(result[e], bound);
    }
  }
  return result;
}

/// Whether a quotient by a run-time value or a root is on the way to `value`: SafeBound then has a run-time bound of
/// its own there, which is not largest at the corners of the box.
bool has_guard(const dsl::Graph& graph, dsl::NodeId value) {
  std::vector<bool> guarded;
  for (dsl::NodeId id = 0; id <= value; ++id) {
    const dsl::Node& n = graph[id];
    bool result = n.op == dsl::Op::certain_nonzero || n.op == dsl::Op::certain_nonnegative;
    for (const dsl::NodeId operand : {n.a, n.b, n.c}) {
      result = result || (operand != dsl::no_node && guarded[static_cast<std::size_t>(operand)]);
    }
    guarded.push_back(result);
  }
  return guarded[static_cast<std::size_t>(value)];
}

std::string without_comments(const std::string& script) {
  std::stringstream lines(script);
  std::string result;
  std::string line;
  while (std::getline(lines, line)) result += line.substr(0, line.find('#')) + "\n";
  return result;
}

class Certifier {
 public:
  Certifier(const CertifyRequest& request, std::vector<Certificate>& certificates)
      : request_(request), certificates_(certificates) {}

  std::string run(const dsl::Predicate& predicate, BoundMode mode, Precision precision, dsl::Diagnostics& diagnostics);

 private:
  std::string certify_element(const dsl::Predicate& predicate, const BoundedPredicate& bounded, dsl::NodeId value,
                              Certificate certificate);
  void ask_gappa(const std::string& path, const std::string& script, Certificate& certificate);

  const CertifyRequest& request_;
  std::vector<Certificate>& certificates_;
  std::map<std::string, GappaAnswer> answers_;  ///< by script without comments: outputs often differ in names alone
};

std::string Certifier::run(const dsl::Predicate& predicate, BoundMode mode, Precision precision,
                           dsl::Diagnostics& diagnostics) {
  const BoundedPredicate bounded = add_bounds(predicate, mode, precision, diagnostics, request_.weakening);
  BoundedPredicate by_rules;
  if (mode == BoundMode::fixed) {
    add_static_bounds(simplify(predicate), format(precision), diagnostics, request_.weakening, by_rules,
                      StaticLemmas::none);
  }
  if (diagnostics.has_errors()) return "";
  for (std::size_t s = 0; s < predicate.stages.size(); ++s) {
    for (std::size_t o = 0; o < predicate.stages[s].outputs.size(); ++o) {
      const dsl::Output& output = predicate.stages[s].outputs[o];
      const OutputBound& bound = bounded.stages[s].outputs[o];
      const std::vector<double> claims = precision == Precision::binary64
                                             ? bounds_at_corners<double>(predicate, bounded, bound)
                                             : bounds_at_corners<float>(predicate, bounded, bound);
      for (std::size_t e = 0; e < bound.elements.size(); ++e) {
        Certificate c;
        c.output = fmt::format("{}.{}.{}{}", predicate.name, predicate.stages[s].name, output.name,
                               subscripts(output.extents, static_cast<int>(e)));
        c.mode = mode;
        c.precision = precision;
        c.bound = c.rules_bound = claims[e] * request_.scale;
        if (mode == BoundMode::fixed) {
          const dsl::NodeId constant = by_rules.stages[s].outputs[o].elements[e].bound;
          c.rules_bound = by_rules.graph[constant].value * request_.scale;
        }
        const std::string error = certify_element(predicate, bounded, bound.elements[e].value, std::move(c));
        if (!error.empty()) return error;
      }
    }
  }
  return "";
}

std::string Certifier::certify_element(const dsl::Predicate& predicate, const BoundedPredicate& bounded,
                                       dsl::NodeId value, Certificate c) {
  const std::string u = c.precision == Precision::binary64 ? "2^-53" : "2^-24";
  const double unit = format(c.precision).unit_roundoff;
  Claim claim;
  claim.value = value;
  claim.comment = fmt::format("{}, mode {}, {}: |computed - exact| <= {:.6g} u, u = {}\nby tightrope {}", c.output,
                              name(c.mode), name(c.precision), c.bound / unit, u, TIGHTROPE_VERSION);
  // The rules' own bound is one that Gappa can follow: that is the claim; the sharper one is compared with its answer.
  claim.bounds = {c.rules_bound};
  auto script = gappa_script(predicate, bounded.graph, claim, c.precision);
  if (c.mode == BoundMode::safe && has_guard(bounded.graph, value)) script.reset();
  if (script) {
    const auto path = request_.directory / fmt::format("{}.{}.{}.g", c.output, name(c.mode), name(c.precision));
    const std::vector<TextFile> files = {{path, *script}};
    if (const std::string error = write_files(files); !error.empty()) return error;
    if (!request_.gappa.empty()) ask_gappa(path.string(), *script, c);
  } else {
    c.verdict = Verdict::no_script;
  }
  certificates_.push_back(std::move(c));
  return "";
}

void Certifier::ask_gappa(const std::string& path, const std::string& script, Certificate& c) {
  const std::string key = without_comments(script);
  const auto start = std::chrono::steady_clock::now();
  if (!answers_.contains(key)) {
    answers_[key] = run_gappa(request_.gappa, path, path + ".log", request_.time_limit);
  }
  const GappaAnswer& answer = answers_[key];
  c.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  c.gappa_bound = answer.found.value_or(infinity);
  switch (answer.status) {
    case GappaAnswer::Status::proved:
      c.verdict = c.gappa_bound <= c.bound || c.rules_bound <= c.bound ? Verdict::proved : Verdict::rules_only;
      break;
    case GappaAnswer::Status::not_proved:
      c.verdict = Verdict::not_proved;
      break;
    case GappaAnswer::Status::timed_out:
      c.verdict = Verdict::timed_out;
      break;
    case GappaAnswer::Status::failed:
      c.verdict = Verdict::failed;
      break;
  }
}

std::string verdict_text(const Certificate& c, double unit) {
  switch (c.verdict) {
    case Verdict::proved:
      return c.bound > much * c.gappa_bound ? "proved, and much less" : "proved";
    case Verdict::rules_only:
      return fmt::format("proved {:.6g} u; the rest is lemmas S and V", c.rules_bound / unit);
    case Verdict::not_proved:
      return "NOT PROVED";
    case Verdict::timed_out:
      return "not proved in time";
    case Verdict::failed:
      return "Gappa refuses the script";
    case Verdict::no_script:
      return "no script: min, max, or SafeBound behind / or sqrt";
    case Verdict::not_run:
      return "not run";
  }
  return "";
}

}  // namespace

dsl::Predicate with_assumed_ranges(const dsl::Predicate& predicate, double range) {
  dsl::Predicate result = predicate;
  for (dsl::Parameter& p : result.parameters) {
    if (!p.range) p.range = range;
  }
  return result;
}

std::string certify(const dsl::Program& program, const CertifyRequest& request, dsl::Diagnostics& diagnostics,
                    std::vector<Certificate>& certificates) {
  const auto for_each_combination = [&](const auto& act) -> std::string {
    for (const dsl::Predicate& predicate : program.predicates) {
      const dsl::Predicate ranged = with_assumed_ranges(predicate, request.assumed_range);
      for (const BoundMode mode : request.modes) {
        for (const Precision precision : request.precisions) {
          if (std::string error = act(ranged, mode, precision); !error.empty()) return error;
        }
      }
    }
    return "";
  };
  // All errors first: where there is one, nothing is written.
  for_each_combination([&](const dsl::Predicate& predicate, BoundMode mode, Precision precision) -> std::string {
    add_bounds(predicate, mode, precision, diagnostics, request.weakening);
    return "";
  });
  if (diagnostics.has_errors()) return "";
  Certifier certifier(request, certificates);
  return for_each_combination([&](const dsl::Predicate& predicate, BoundMode mode, Precision precision) {
    return certifier.run(predicate, mode, precision, diagnostics);
  });
}

bool unproved(const std::vector<Certificate>& certificates) {
  return std::any_of(certificates.begin(), certificates.end(), [](const Certificate& c) {
    return c.verdict == Verdict::not_proved || c.verdict == Verdict::timed_out || c.verdict == Verdict::failed;
  });
}

std::string text(const std::vector<Certificate>& certificates) {
  std::string result = fmt::format("{:40} {:8} {:6} {:>12} {:>12} {:>7} {:>8}  {}\n", "output", "mode", "real",
                                   "bound / u", "Gappa / u", "ratio", "seconds", "verdict");
  for (const Certificate& c : certificates) {
    const double unit = format(c.precision).unit_roundoff;
    const bool known = c.gappa_bound > 0 && std::isfinite(c.gappa_bound);
    const bool exact = c.gappa_bound == 0 && c.bound == 0 && c.verdict == Verdict::proved;
    result +=
        fmt::format("{:40} {:8} {:6} {:>12.6g} {:>12} {:>7} {:>8.2f}  {}\n", c.output, name(c.mode), name(c.precision),
                    c.bound / unit,
                    known   ? fmt::format("{:.6g}", c.gappa_bound / unit)
                    : exact ? "0"
                            : "-",
                    known ? fmt::format("{:.2f}", c.bound / c.gappa_bound) : "-", c.seconds, verdict_text(c, unit));
  }
  return result;
}

}  // namespace tightrope::codegen
