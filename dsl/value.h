#pragma once
/// The values of the language: arrays (of zero or more extents) of scalars or vectors, each a polynomial in t.

#include <optional>
#include <string>
#include <vector>

#include "dsl/polynomial.h"

namespace tightrope::dsl {

/// Elements row-major, all of one dimension and one degree. Without elements it is *poison*: what an erroneous
/// expression is worth. An operation with a poisoned operand is poison and reports nothing.
struct Value {
  std::vector<int> extents;
  std::vector<Polynomial> elements;

  bool poisoned() const { return elements.empty(); }
  int dimension() const { return elements.front().dimension; }
  int degree() const { return elements.front().degree; }
  bool is_array() const { return !extents.empty(); }
  bool is_scalar() const { return extents.empty() && dimension() == 1; }  ///< of any degree
  std::size_t coefficient_count() const {
    return poisoned() ? 0 : elements.size() * elements.front().coefficients.size();
  }
};

Value scalar(const Coefficient& value);
/// The compile-time number that a value is, if it is one.
std::optional<Rational> as_number(const Value& value);
/// "a number", "a scalar of degree 3", "a 2D vector of degree 0", "an array [4] of vectors of degree 1".
std::string describe(const Value& value);

/// The same degree for all: that of the highest, so that values of one shape can stand in one array.
void elevate_to_common_degree(Lowering& low, std::vector<Value>& values);
/// An array of values of one shape and degree.
Value make_array(std::vector<Value> values);
/// Element `index` of an array's first extent.
Value element(const Value& array, int index);
/// `operation` on each element.
template <class Operation>
Value map_elements(const Value& value, Operation operation) {
  Value result{.extents = value.extents, .elements = {}};
  result.elements.reserve(value.elements.size());
  for (const Polynomial& p : value.elements) result.elements.push_back(operation(p));
  return result;
}

}  // namespace tightrope::dsl
