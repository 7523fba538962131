#include "codegen/interface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace tightrope::codegen {
namespace {

constexpr std::size_t line_length = 120;

/// Names that generated functions use themselves, so that no argument may have them: the runtime's, the struct's, and
/// those of the function bodies (v0, v1, ... are recognised apart).
std::set<std::string> reserved_names(const dsl::Predicate& predicate) {
  std::set<std::string> names = {"product",
                                 "sum",
                                 "difference",
                                 "magnitude",
                                 "minimum",
                                 "maximum",
                                 "max_magnitude",
                                 "choose",
                                 "normalizer",
                                 "make_uncertain",
                                 "certain_nonzero",
                                 "certain_nonnegative",
                                 "bound",
                                 "Bounded",
                                 "Lanes",
                                 "lanes",
                                 "multiply_add",
                                 "square_root",
                                 "Sign",
                                 "State",
                                 "state",
                                 "result",
                                 "real",
                                 "bounds",
                                 "broken",
                                 "filter",
                                 "finite",
                                 "inputs",
                                 "signs",
                                 "uses",
                                 "wanted",
                                 "in_range",
                                 "sign",
                                 "tightrope",
                                 "generated"};
  names.insert(predicate.name);
  for (const dsl::Stage& stage : predicate.stages) {
    names.insert(stage.name);
    names.insert(stage.name + "_in_range");
    names.insert(stage.name + "_result");
  }
  return names;
}

bool is_local_name(const std::string& name) {
  return name.size() > 1 && name[0] == 'v' &&
         std::all_of(name.begin() + 1, name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::vector<Argument> arguments(const dsl::Predicate& predicate) {
  std::set<std::string> taken = reserved_names(predicate);
  std::vector<Argument> result;
  for (std::size_t p = 0; p < predicate.parameters.size(); ++p) {
    const dsl::Parameter& parameter = predicate.parameters[p];
    for (int time = 0; time < (parameter.moving ? 2 : 1); ++time) {
      Argument argument;
      argument.name = parameter.moving ? fmt::format("{}_t{}", parameter.name, time) : parameter.name;
      while (is_local_name(argument.name) || taken.contains(argument.name)) argument.name += '_';
      taken.insert(argument.name);
      argument.parameter = static_cast<int>(p);
      argument.bounded = parameter.bounded;
      argument.pointer = !parameter.array.empty() || parameter.dimension > 1;
      for (int slot = parameter.first_slot; slot < parameter.first_slot + parameter.slots(); ++slot) {
        if (predicate.slots[static_cast<std::size_t>(slot)].time == time) argument.slots.push_back(slot);
      }
      result.push_back(std::move(argument));
    }
  }
  return result;
}

std::vector<std::string> slot_expressions(const dsl::Predicate& predicate) {
  const std::size_t n = predicate.slots.size();
  std::vector<std::string> result(2 * n);
  for (const Argument& argument : arguments(predicate)) {
    for (std::size_t i = 0; i < argument.slots.size(); ++i) {
      const std::string place = argument.pointer ? fmt::format("{}[{}]", argument.name, i) : argument.name;
      const auto slot = static_cast<std::size_t>(argument.slots[i]);
      result[slot] = argument.bounded ? place + ".value" : place;
      if (argument.bounded) result[n + slot] = place + ".bound";
    }
  }
  return result;
}

std::string_view tag(BoundMode mode) {
  switch (mode) {
    case BoundMode::none:
      return "bound::none";
    case BoundMode::safe:
      return "bound::safe";
    case BoundMode::tight:
      return "bound::tight";
    case BoundMode::fixed:
      return "bound::fixed";
    case BoundMode::interval:
      return "bound::interval";
    case BoundMode::exact:
      return "bound::exact";
    case BoundMode::staged:
      return "bound::staged";
  }
  return {};
}

std::string literal(double value, Precision precision) {
  const bool single = precision == Precision::binary32;
  const std::string_view suffix = single ? "f" : "";
  if (std::isinf(value)) return fmt::format("{}__builtin_inf{}()", value < 0 ? "-" : "", suffix);
  if (std::isnan(value)) return fmt::format("__builtin_nan{}(\"\")", suffix);
  return fmt::format("{:a}{}", value, suffix);
}

std::string comment_text(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = [&](std::size_t k) { return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0U; };
    const bool embedding = byte(0) == 0xe2 && byte(1) == 0x80 && byte(2) >= 0xaa && byte(2) <= 0xae;  // U+202A..E
    const bool isolate = byte(0) == 0xe2 && byte(1) == 0x81 && byte(2) >= 0xa6 && byte(2) <= 0xa9;    // U+2066..9
    if (embedding || isolate) {
      i += 2;
    } else {
      result += byte(0) < 0x20 ? ' ' : text[i];
    }
  }
  while (!result.empty() && result.back() == ' ') result.pop_back();
  if (!result.empty() && result.back() == '\\') result += " .";
  return result;
}

std::string comment_lines(std::string_view indent, std::string_view text) {
  const std::string safe = comment_text(text);
  std::string result;
  std::string line = fmt::format("{}//", indent);
  const std::size_t start = safe.find_first_not_of(' ');
  const std::string blanks(start == std::string::npos ? 0 : std::max<std::size_t>(start, 1), ' ');
  std::string gap = blanks;
  for (std::size_t begin = start; begin < safe.size();) {
    const std::size_t end = std::min(safe.find(' ', begin), safe.size());
    const std::string_view word = std::string_view(safe).substr(begin, end - begin);
    if (gap == " " && line.size() + 1 + word.size() > line_length) {
      result += line + '\n';
      line = fmt::format("{}//{}  ", indent, blanks);
      gap.clear();
    }
    line += gap;
    line += word;
    gap = " ";
    begin = end + 1;
  }
  return result + line + '\n';
}

std::string wrap(std::string_view head, const std::vector<std::string>& words) {
  std::string result;
  std::string line(head);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0 && line.size() + 1 + words[i].size() > line_length) {
      result += line + "\n";
      line.assign(head.size(), ' ');
    } else if (i > 0) {
      line += ' ';
    }
    line += words[i];
  }
  return result + line;
}

std::string wrap_call(std::string_view head, const std::vector<std::string>& words) {
  const std::string aligned = wrap(head, words);
  const std::size_t indent = std::min(head.find_first_not_of(' '), head.size()) + 4;
  const std::string below = fmt::format("{}\n{}", head, wrap(std::string(indent, ' '), words));
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  return lines(below) < lines(aligned) ? below : aligned;
}

std::string extents_text(const std::vector<int>& extents) {
  std::string result;
  for (const int extent : extents) result += fmt::format("[{}]", extent);
  return result;
}

std::string subscripts(const std::vector<int>& extents, int element) {
  std::string result;
  for (std::size_t i = extents.size(); i-- > 0;) {
    result = fmt::format("[{}]", element % extents[i]) + result;
    element /= extents[i];
  }
  return result;
}

}  // namespace tightrope::codegen
