/// `property antisymmetric(a, b) of Y` and its kin: names become indices.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "dsl/elaborate_predicate.h"

namespace tightrope::dsl {
namespace {

struct PropertyKind {
  std::string_view name;
  Property::Kind kind;
  std::size_t min_parameters;
  std::size_t max_parameters;
  std::string_view usage;
};

constexpr std::array<PropertyKind, 5> property_kinds = {{
    {"antisymmetric", Property::Kind::antisymmetric, 2, 2, "antisymmetric(a, b)"},
    {"symmetric", Property::Kind::symmetric, 2, 2, "symmetric(a, b)"},
    {"cyclic", Property::Kind::cyclic, 3, 1000, "cyclic(a, b, c)"},
    {"translation_invariant", Property::Kind::translation_invariant, 0, 0, "translation_invariant"},
    {"scale", Property::Kind::scale, 0, 0, "scale(3)"},
}};

const PropertyKind* find_kind(const PropertyDecl& declaration, Reporter& reporter) {
  std::vector<std::string_view> names;
  for (const PropertyKind& kind : property_kinds) {
    if (kind.name == declaration.name) return &kind;
    names.push_back(kind.name);
  }
  const std::string_view closest = closest_name(declaration.name, names);
  reporter.error(declaration.span, fmt::format("unknown property `{}`", declaration.name),
                 closest.empty() ? "the properties are `antisymmetric`, `symmetric`, `cyclic`, `translation_invariant` "
                                   "and `scale`"
                                 : fmt::format("did you mean `{}`?", closest));
  return nullptr;
}

bool same_type(const Parameter& a, const Parameter& b) {
  return a.bounded == b.bounded && a.point == b.point && a.dimension == b.dimension && a.array == b.array;
}

/// The indices of the parameters named, or empty after an error.
std::optional<std::vector<int>> resolve_parameters(const PropertyDecl& declaration, const Predicate& predicate,
                                                   Reporter& reporter) {
  std::vector<int> indices;
  for (const auto& [name, span] : declaration.arguments) {
    std::vector<std::string_view> names;
    for (const Parameter& p : predicate.parameters) names.push_back(p.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      const std::string_view closest = closest_name(name, names);
      reporter.error(span, fmt::format("`{}` is no parameter of this predicate", name),
                     closest.empty() ? "" : fmt::format("did you mean `{}`?", closest));
      return std::nullopt;
    }
    const int index = static_cast<int>(found - names.begin());
    if (std::find(indices.begin(), indices.end(), index) != indices.end()) {
      reporter.error(span, fmt::format("`{}` is named twice in a property", name));
      return std::nullopt;
    }
    indices.push_back(index);
  }
  return indices;
}

/// All outputs, or those named; a name stands also for the outputs that a loop made of it.
bool resolve_outputs(const PropertyDecl& declaration, const Predicate& predicate, Reporter& reporter,
                     std::vector<std::pair<int, int>>& outputs) {
  std::vector<std::string_view> names;
  std::vector<bool> found(declaration.outputs.size(), false);
  for (std::size_t s = 0; s < predicate.stages.size(); ++s) {
    for (std::size_t o = 0; o < predicate.stages[s].outputs.size(); ++o) {
      const std::string_view name = predicate.stages[s].outputs[o].name;
      names.push_back(name);
      bool wanted = declaration.outputs.empty();
      for (std::size_t i = 0; i < declaration.outputs.size(); ++i) {
        const std::string& asked = declaration.outputs[i].first;
        std::string_view rest = name;
        const bool starts = rest.starts_with(asked);
        if (starts) rest.remove_prefix(asked.size());
        // "w" names "w" and the loop's "w_0", "w_1", "w_m1", "w_0_1"
        const bool numbered = starts && rest.size() > 1 && rest[0] == '_' &&
                              rest.find_first_not_of("_m0123456789") == std::string_view::npos;
        if (!starts || (!rest.empty() && !numbered)) continue;
        found[i] = wanted = true;
      }
      if (wanted) outputs.emplace_back(static_cast<int>(s), static_cast<int>(o));
    }
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i]) continue;
    const auto& [name, span] = declaration.outputs[i];
    const std::string_view closest = closest_name(name, names);
    reporter.error(span, fmt::format("this predicate has no output `{}`", name),
                   closest.empty() ? "" : fmt::format("did you mean `{}`?", closest));
    return false;
  }
  return true;
}

}  // namespace

void elaborate_property(const PropertyDecl& declaration, const PredicateRequest& request,
                        ExpressionElaborator& elaborator, Predicate& predicate) {
  Reporter& reporter = elaborator.reporter();
  const PropertyKind* kind = find_kind(declaration, reporter);
  if (kind == nullptr) return;
  Property property{.kind = kind->kind, .parameters = {}, .exponent = 0, .outputs = {}};
  const bool is_scale = kind->kind == Property::Kind::scale;
  const std::size_t count = declaration.arguments.size();
  if (count < kind->min_parameters || count > kind->max_parameters || declaration.number.empty() == is_scale) {
    reporter.error(declaration.span, fmt::format("this property is written `{}`", kind->usage));
    return;
  }
  if (is_scale) {
    Scope none;
    const SourceSpan span = request.module->exprs[static_cast<std::size_t>(declaration.number.root())].span;
    const auto exponent = elaborator.whole_number(elaborator.evaluate(*request.module, declaration.number, none), span,
                                                  "the exponent of `scale`");
    if (!exponent) return;
    if (*exponent < -1000 || *exponent > 1000) {
      reporter.error(span, fmt::format("the exponent of `scale` is not between -1000 and 1000: {}", *exponent));
      return;
    }
    property.exponent = static_cast<int>(*exponent);
  }
  auto parameters = resolve_parameters(declaration, predicate, reporter);
  if (!parameters || !resolve_outputs(declaration, predicate, reporter, property.outputs)) return;
  for (std::size_t i = 1; i < parameters->size(); ++i) {
    const Parameter& first = predicate.parameters[static_cast<std::size_t>(parameters->front())];
    const Parameter& other = predicate.parameters[static_cast<std::size_t>((*parameters)[i])];
    if (same_type(first, other) && first.moving == other.moving) continue;
    if (same_type(first, other) && request.is_instance) return;
    reporter.error(declaration.arguments[i].second,
                   fmt::format("`{}` and `{}` cannot be exchanged: their types differ", first.name, other.name));
    return;
  }
  const bool has_point =
      std::any_of(predicate.parameters.begin(), predicate.parameters.end(), [](const Parameter& p) { return p.point; });
  if (kind->kind == Property::Kind::translation_invariant && !has_point) {
    reporter.error(declaration.span, "no parameter is a point, so there is nothing to translate",
                   "positions are declared `point` or `point2`");
    return;
  }
  property.parameters = std::move(*parameters);
  predicate.properties.push_back(std::move(property));
}

}  // namespace tightrope::dsl
