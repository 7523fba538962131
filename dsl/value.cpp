#include "dsl/value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace tightrope::dsl {

Value scalar(const Coefficient& value) {
  Value result;
  result.elements.push_back({.dimension = 1, .degree = 0, .coefficients = {value}});
  return result;
}

std::optional<Rational> as_number(const Value& value) {
  if (value.poisoned() || !value.is_scalar() || value.degree() != 0) return std::nullopt;
  const Coefficient& c = value.elements.front().coefficients.front();
  if (!c.is_number()) return std::nullopt;
  return c.factor;
}

std::string describe(const Value& value) {
  if (as_number(value)) return "a number";
  const char* const kinds[] = {"scalar", "2D vector", "vector"};
  const char* kind = kinds[value.dimension() - 1];
  if (!value.is_array()) return fmt::format("a {} of degree {}", kind, value.degree());
  std::string extents;
  for (const int extent : value.extents) extents += fmt::format("[{}]", extent);
  return fmt::format("an array {} of {}s of degree {}", extents, kind, value.degree());
}

void elevate_to_common_degree(Lowering& low, std::vector<Value>& values) {
  int degree = 0;
  for (const Value& v : values) degree = std::max(degree, v.degree());
  for (Value& v : values) {
    if (v.degree() != degree) v = map_elements(v, [&](const Polynomial& p) { return elevate(low, p, degree); });
  }
}

Value make_array(std::vector<Value> values) {
  Value result;
  result.extents = values.front().extents;
  result.extents.insert(result.extents.begin(), static_cast<int>(values.size()));
  for (Value& v : values) std::move(v.elements.begin(), v.elements.end(), std::back_inserter(result.elements));
  return result;
}

Value element(const Value& array, int index) {
  Value result;
  result.extents.assign(array.extents.begin() + 1, array.extents.end());
  const auto size = static_cast<std::ptrdiff_t>(array.elements.size()) / array.extents.front();
  result.elements.assign(array.elements.begin() + index * size, array.elements.begin() + (index + 1) * size);
  return result;
}

}  // namespace tightrope::dsl
