/// The operators: + - * / ^, elements and components, evaluation and splitting.

#include <fmt/format.h>

#include "dsl/ast.h"
#include "dsl/elaborate_expression.h"

namespace tightrope::dsl {

Value ExpressionElaborator::apply_sum(const Expr& expr, const Value& a, const Value& b) {
  const bool minus = expr.kind == ExprKind::subtract;
  if (a.extents != b.extents || a.dimension() != b.dimension()) {
    const std::string message = minus ? fmt::format("cannot subtract {} from {}", describe(b), describe(a))
                                      : fmt::format("cannot add {} and {}", describe(a), describe(b));
    error(expr.span, message);
    return {};
  }
  Value result{.extents = a.extents, .elements = {}};
  result.elements.reserve(a.elements.size());
  for (std::size_t i = 0; i < a.elements.size(); ++i) {
    result.elements.push_back(minus ? difference(low_, a.elements[i], b.elements[i])
                                    : sum(low_, a.elements[i], b.elements[i]));
  }
  return result;
}

Value ExpressionElaborator::apply_product(const Expr& expr, const Value& a, const Value& b) {
  if (a.is_array() || b.is_array() || (a.dimension() != 1 && b.dimension() != 1)) {
    const bool vectors = !a.is_array() && !b.is_array();
    error(expr.span, fmt::format("cannot multiply {} and {}", describe(a), describe(b)),
          vectors ? "the products of vectors are `dot(u, v)` and `cross(u, v)`"
                  : "an array is made with `[f(i) for i in 0..3]`");
    return {};
  }
  if (!degree_allowed(a.degree() + b.degree(), expr.span)) return {};
  const Polynomial& p = a.elements.front();
  const Polynomial& q = b.elements.front();
  Value result;
  if (const auto factor = as_number(a)) {
    result.elements.push_back(scale(low_, q, *factor));
  } else if (const auto right_factor = as_number(b)) {
    result.elements.push_back(scale(low_, p, *right_factor));
  } else {
    result.elements.push_back(p.dimension == 1 ? product(low_, Bilinear::multiply, p, q)
                                               : product(low_, Bilinear::multiply, q, p));
  }
  return result;
}

Value ExpressionElaborator::apply_quotient(const Expr& expr, const Value& a, const Value& b) {
  if (a.is_array() || !b.is_scalar() || b.degree() != 0) {
    error(expr.span, fmt::format("cannot divide {} by {}", describe(a), describe(b)),
          "a scalar or a vector is divided by a number or a scalar of degree 0");
    return {};
  }
  if (const auto divisor = as_number(b); divisor && divisor->is_zero()) {
    error(operand_span(expr, 1), "division by zero");
    return {};
  }
  const Coefficient& divisor = b.elements.front().coefficients.front();
  return map_elements(a, [&](const Polynomial& p) { return divide(low_, p, divisor); });
}

Value ExpressionElaborator::apply_power(const Expr& expr, const Value& a, const Value& b) {
  constexpr std::int64_t max_exponent = 1'000'000;
  const auto exponent = whole_number(b, operand_span(expr, 1), "an exponent");
  if (!exponent) return {};
  if (const auto base = as_number(a)) {
    if (base->is_zero() && *exponent < 0) {
      error(expr.span, "division by zero");
      return {};
    }
    const Rational power = base->power(*exponent);
    if (!power.valid()) low_.overflow = true;
    return scalar(number(power.valid() ? power : Rational()));
  }
  if (!a.is_scalar()) {
    error(expr.span, fmt::format("cannot take a power of {}", describe(a)), "`dot(v, v)` is the square of a vector");
    return {};
  }
  if (*exponent < 0 || *exponent > max_exponent) {
    error(operand_span(expr, 1), fmt::format("the exponent {} is not between 0 and {}", *exponent, max_exponent),
          *exponent < 0 ? "a reciprocal is written `1 / x`" : "");
    return {};
  }
  if (a.degree() > 0 && *exponent > options_.max_degree) {
    error(expr.span, fmt::format("a power {} of {} has too high a degree", *exponent, describe(a)));
    return {};
  }
  if (!degree_allowed(static_cast<int>(a.degree() * *exponent), expr.span)) return {};
  if (*exponent == 0) return scalar(number(1));
  // By squaring: no more roundings than one by one, and shared squares. x^3 is x^2 * x.
  Polynomial square = a.elements.front();
  std::optional<Polynomial> result;
  for (std::int64_t rest = *exponent;;) {
    if (rest % 2 == 1) result = result ? product(low_, Bilinear::multiply, square, *result) : square;
    rest /= 2;
    if (rest == 0) break;
    square = product(low_, Bilinear::multiply, square, square);
  }
  return {.extents = {}, .elements = {*result}};
}

Value ExpressionElaborator::apply_index(const Expr& expr, const Value& a, const Value& b) {
  const int count = a.is_array() ? a.extents.front() : a.dimension() > 1 ? a.dimension() : 0;
  if (count == 0) {
    error(expr.span, fmt::format("{} has no elements", describe(a)),
          a.degree() > 0 ? "a Bernstein coefficient is written `coefficients(P)[i]`" : "");
    return {};
  }
  const auto index = whole_number(b, operand_span(expr, 1), "an index");
  if (!index) return {};
  if (*index < 0 || *index >= count) {
    error(operand_span(expr, 1),
          fmt::format("there is no element {}: {} has elements 0 to {}", *index, describe(a), count - 1));
    return {};
  }
  const int i = static_cast<int>(*index);
  if (a.is_array()) return element(a, i);
  const Polynomial& p = a.elements.front();
  Polynomial component{.dimension = 1, .degree = p.degree, .coefficients = {}};
  for (int k = 0; k <= p.degree; ++k) component.coefficients.push_back(p.at(k, i));
  return {.extents = {}, .elements = {std::move(component)}};
}

Value ExpressionElaborator::apply_component(const Expr& expr, const Value& a) {
  const int i = expr.text == "x" ? 0 : expr.text == "y" ? 1 : 2;
  if (a.is_array() || a.dimension() == 1 || i >= a.dimension()) {
    error(expr.span, fmt::format("{} has no component `{}`", describe(a), expr.text));
    return {};
  }
  Polynomial component{.dimension = 1, .degree = a.degree(), .coefficients = {}};
  for (int k = 0; k <= a.degree(); ++k) component.coefficients.push_back(a.elements.front().at(k, i));
  return {.extents = {}, .elements = {std::move(component)}};
}

namespace {

/// The weights of the place r or r / whole, or empty after an error.
std::optional<Weights> place_weights(ExpressionElaborator& elaborator, const Expr& expr, const Value& r,
                                     const Value* whole) {
  for (std::size_t i = 1; i <= (whole == nullptr ? 1 : 2); ++i) {
    const Value* v = i == 1 ? &r : whole;
    if (v->is_scalar() && v->degree() == 0) continue;
    elaborator.error(elaborator.operand_span(expr, i),
                     fmt::format("a polynomial has values at scalars of degree 0, not at {}", describe(*v)));
    return std::nullopt;
  }
  const Coefficient whole_scalar = whole == nullptr ? number(1) : whole->elements.front().coefficients.front();
  if (whole_scalar.is_number() && whole_scalar.factor.is_zero()) {
    elaborator.error(elaborator.operand_span(expr, 2), "division by zero");
    return std::nullopt;
  }
  return weights(elaborator.lowering(), r.elements.front().coefficients.front(), whole_scalar);
}

}  // namespace

Value evaluate_at(ExpressionElaborator& elaborator, const Expr& expr, const Value& p, const Value& where,
                  const Value* whole) {
  const auto number = as_number(where);
  if (whole == nullptr && number && (number->is_zero() || number->is_one())) {
    const int end = number->is_zero() ? 0 : 1;
    return map_elements(p, [&](const Polynomial& q) { return value_at_end(q, end); });
  }
  const auto w = place_weights(elaborator, expr, where, whole);
  if (!w) return {};
  return map_elements(p, [&](const Polynomial& q) { return value_at(elaborator.lowering(), q, *w); });
}

Value split_at(ExpressionElaborator& elaborator, const Expr& expr, const Value& p, const Value& where,
               const Value* whole) {
  const auto w = place_weights(elaborator, expr, where, whole);
  if (!w) return {};
  Value before{.extents = p.extents, .elements = {}};
  Value after = before;
  for (const Polynomial& q : p.elements) {
    auto [left, right] = split(elaborator.lowering(), q, *w);
    before.elements.push_back(std::move(left));
    after.elements.push_back(std::move(right));
  }
  return make_array({std::move(before), std::move(after)});
}

}  // namespace tightrope::dsl
