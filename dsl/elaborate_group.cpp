/// `group all`, `group (a, b), (c)` and their kin: names become indices.

#include <fmt/format.h>

#include <algorithm>

#include "dsl/elaborate_predicate.h"
#include "dsl/names.h"

namespace tightrope::dsl {
namespace {

/// The index of a parameter that may stand in a list, or -1 after an error.
int listed_parameter(const std::string& name, SourceSpan span, const Predicate& predicate, Reporter& reporter) {
  std::vector<std::string_view> names;
  for (const Parameter& p : predicate.parameters) names.push_back(p.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    const std::string_view closest = closest_name(name, names);
    reporter.error(span, fmt::format("`{}` is no parameter of this predicate", name),
                   closest.empty() ? "" : fmt::format("did you mean `{}`?", closest));
    return -1;
  }
  const int index = static_cast<int>(found - names.begin());
  if (predicate.parameters[static_cast<std::size_t>(index)].bounded) {
    reporter.error(span, fmt::format("`{}` cannot be grouped: a bounded input has a maximum of its own", name));
    return -1;
  }
  for (const std::vector<int>& list : predicate.grouping.lists) {
    if (std::find(list.begin(), list.end(), index) == list.end()) continue;
    reporter.error(span, fmt::format("`{}` is in a group already", name));
    return -1;
  }
  return index;
}

void apply_word(const std::string& word, SourceSpan span, const PredicateRequest& request, Reporter& reporter,
                Predicate& predicate, bool& axis) {
  Grouping& grouping = predicate.grouping;
  const bool moves = std::any_of(predicate.parameters.begin(), predicate.parameters.end(),
                                 [](const Parameter& p) { return p.moving; });
  if (word == "all") {
    grouping.all = true;
  } else if (word == "axis") {
    axis = true;
  } else if (word == "displacements") {
    grouping.displacements = true;
    if (!moves && !request.is_instance) {
      reporter.error(span, "no parameter moves, so there are no displacements to group");
    }
  } else {
    reporter.error(span, fmt::format("inputs cannot be grouped by `{}`", word),
                   "write `all`, `axis`, `displacements` or parameters in parentheses");
  }
}

}  // namespace

void elaborate_groups(const PredicateRequest& request, Reporter& reporter, Predicate& predicate) {
  const std::vector<GroupDecl>& groups = request.declaration->groups;
  bool axis = false;
  for (const GroupDecl& group : groups) {
    if (&group != &groups.front()) {
      reporter.error(group.span, "the groups of this predicate are declared already");
      return;
    }
    for (const auto& [word, span] : group.words) apply_word(word, span, request, reporter, predicate, axis);
    if (axis && predicate.grouping.all)
      reporter.error(group.span, "inputs are grouped by `all` or by `axis`, not both");
    for (const auto& names : group.lists) {
      predicate.grouping.lists.emplace_back();
      for (const auto& [name, span] : names) {
        const int index = listed_parameter(name, span, predicate, reporter);
        if (index >= 0) predicate.grouping.lists.back().push_back(index);
      }
    }
  }
}

}  // namespace tightrope::dsl
