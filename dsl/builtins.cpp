#include "dsl/builtins.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "dsl/ast.h"
#include "dsl/either.h"
#include "dsl/elaborate_expression.h"

namespace tightrope::dsl {
namespace {

using Arguments = std::span<const Value>;

/// "`cross` cannot take a scalar of degree 1 and a vector of degree 1".
Value refuse(ExpressionElaborator& e, const Expr& call, Arguments arguments, std::string hint) {
  std::string list;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    list += i == 0 ? "" : i + 1 < arguments.size() ? ", " : " and ";
    list += describe(arguments[i]);
  }
  e.error(call.span, fmt::format("`{}` cannot take {}", call.text, list), std::move(hint));
  return {};
}

bool are_vectors(Arguments arguments) {
  return std::all_of(arguments.begin(), arguments.end(), [&](const Value& v) {
    return !v.is_array() && v.dimension() > 1 && v.dimension() == arguments.front().dimension();
  });
}

bool are_plain_scalars(Arguments arguments) {
  return std::all_of(arguments.begin(), arguments.end(),
                     [](const Value& v) { return v.is_scalar() && v.degree() == 0; });
}

const Coefficient& coefficient(const Value& plain_scalar) { return plain_scalar.elements.front().coefficients.front(); }

Value bilinear(ExpressionElaborator& e, const Expr& call, Bilinear operation, const Value& a, const Value& b) {
  if (!e.degree_allowed(a.degree() + b.degree(), call.span)) return {};
  return {.extents = {}, .elements = {product(e.lowering(), operation, a.elements.front(), b.elements.front())}};
}

Value apply_dot(ExpressionElaborator& e, const Expr& call, Arguments a) {
  if (!are_vectors(a)) return refuse(e, call, a, "it takes two vectors of one dimension");
  return bilinear(e, call, Bilinear::dot, a[0], a[1]);
}

Value apply_cross(ExpressionElaborator& e, const Expr& call, Arguments a) {
  if (!are_vectors(a)) return refuse(e, call, a, "it takes two vectors of one dimension");
  return bilinear(e, call, Bilinear::cross, a[0], a[1]);
}

/// det(u, v) in the plane, det(u, v, w) = dot(u, cross(v, w)) in space.
Value apply_det(ExpressionElaborator& e, const Expr& call, Arguments a) {
  if (!are_vectors(a) || a[0].dimension() != static_cast<int>(a.size())) {
    return refuse(e, call, a, "it takes two 2D vectors or three vectors");
  }
  if (a.size() == 2) return bilinear(e, call, Bilinear::cross, a[0], a[1]);
  const Value inner = bilinear(e, call, Bilinear::cross, a[1], a[2]);
  return inner.poisoned() ? Value{} : bilinear(e, call, Bilinear::dot, a[0], inner);
}

Value apply_abs(ExpressionElaborator& e, const Expr& call, Arguments a) {
  if (!are_plain_scalars(a)) return refuse(e, call, a, "it takes a scalar of degree 0");
  return scalar(abs(e.lowering(), coefficient(a[0])));
}

Value apply_sqrt(ExpressionElaborator& e, const Expr& call, Arguments a) {
  if (!are_plain_scalars(a)) return refuse(e, call, a, "it takes a scalar of degree 0");
  const Coefficient& c = coefficient(a[0]);
  if (c.is_number() && c.factor.sign() < 0) {
    e.error(call.span, "square root of a negative number");
    return {};
  }
  return scalar(square_root(e.lowering(), c));
}

/// The value with its compile-time factor multiplied in here, where the text says so, and not where it costs least.
Value apply_rounded(ExpressionElaborator& e, const Expr& call, Arguments a) {
  if (!are_plain_scalars(a)) return refuse(e, call, a, "it takes a scalar of degree 0");
  const Coefficient& c = coefficient(a[0]);
  return c.is_number() ? a[0] : scalar(run_time(materialise(e.lowering(), c)));
}

Value apply_fma(ExpressionElaborator& e, const Expr& call, Arguments a) {
  if (!are_plain_scalars(a)) return refuse(e, call, a, "it takes three scalars of degree 0");
  return scalar(fused(e.lowering(), coefficient(a[0]), coefficient(a[1]), coefficient(a[2])));
}

Value apply_extremum(ExpressionElaborator& e, const Expr& call, Arguments a) {
  std::vector<Value> elements(a.begin(), a.end());
  if (a.size() == 1 && a[0].extents.size() == 1) {
    elements.clear();
    for (int i = 0; i < a[0].extents.front(); ++i) elements.push_back(element(a[0], i));
  }
  if (!are_plain_scalars(elements)) return refuse(e, call, a, "it takes scalars of degree 0, or one array of them");
  const Op op = call.text == "min" ? Op::min : Op::max;
  Coefficient result = coefficient(elements.front());
  for (std::size_t i = 1; i < elements.size(); ++i) {
    result = minimum_or_maximum(e.lowering(), op, result, coefficient(elements[i]));
  }
  return scalar(result);
}

Value apply_sum(ExpressionElaborator& e, const Expr& call, Arguments a) {
  if (!a[0].is_array()) return refuse(e, call, a, "it takes an array");
  Value total = element(a[0], 0);
  for (int i = 1; i < a[0].extents.front(); ++i) {
    const Value next = element(a[0], i);
    for (std::size_t k = 0; k < total.elements.size(); ++k) {
      total.elements[k] = sum(e.lowering(), total.elements[k], next.elements[k]);
    }
  }
  return total;
}

Value apply_diff(ExpressionElaborator& e, const Expr&, Arguments a) {
  return map_elements(a[0], [&](const Polynomial& p) { return derivative(e.lowering(), p); });
}

Value apply_elevate(ExpressionElaborator& e, const Expr& call, Arguments a) {
  const auto degree = e.whole_number(a[1], e.operand_span(call, 1), "a degree");
  if (!degree) return {};
  if (*degree < a[0].degree()) {
    e.error(call.span, fmt::format("cannot elevate {} to degree {}", describe(a[0]), *degree),
            "a degree can only be raised");
    return {};
  }
  const int wanted = static_cast<int>(std::min<std::int64_t>(*degree, 1 << 30));
  if (!e.degree_allowed(wanted, call.span)) return {};
  return map_elements(a[0], [&](const Polynomial& p) { return elevate(e.lowering(), p, wanted); });
}

Value apply_split(ExpressionElaborator& e, const Expr& call, Arguments a) {
  return split_at(e, call, a[0], a[1], nullptr);
}

/// The last extent of the result counts the coefficients.
Value apply_coefficients(ExpressionElaborator&, const Expr&, Arguments a) {
  Value result{.extents = a[0].extents, .elements = {}};
  result.extents.push_back(a[0].degree() + 1);
  for (const Polynomial& p : a[0].elements) {
    for (int i = 0; i <= p.degree; ++i) {
      Polynomial& b =
          result.elements.emplace_back(Polynomial{.dimension = p.dimension, .degree = 0, .coefficients = {}});
      for (int c = 0; c < p.dimension; ++c) b.coefficients.push_back(p.at(i, c));
    }
  }
  return result;
}

Value apply_bernstein(ExpressionElaborator& e, const Expr& call, Arguments a) {
  if (!a[0].is_array() || a[0].degree() != 0) return refuse(e, call, a, "it takes an array of values of degree 0");
  const int degree = a[0].extents.back() - 1;
  if (!e.degree_allowed(degree, call.span)) return {};
  Value result;
  result.extents.assign(a[0].extents.begin(), a[0].extents.end() - 1);
  for (auto b = a[0].elements.begin(); b != a[0].elements.end();) {
    Polynomial& p =
        result.elements.emplace_back(Polynomial{.dimension = a[0].dimension(), .degree = degree, .coefficients = {}});
    for (int i = 0; i <= degree; ++i, ++b) {
      p.coefficients.insert(p.coefficients.end(), b->coefficients.begin(), b->coefficients.end());
    }
  }
  return result;
}

Value apply_vector(ExpressionElaborator& e, const Expr& call, Arguments a) {
  if (!std::all_of(a.begin(), a.end(), [](const Value& v) { return v.is_scalar(); })) {
    return refuse(e, call, a, "the components of a vector are scalars");
  }
  std::vector<Value> components(a.begin(), a.end());
  elevate_to_common_degree(e.lowering(), components);
  Polynomial p{.dimension = static_cast<int>(a.size()), .degree = components.front().degree(), .coefficients = {}};
  for (int i = 0; i <= p.degree; ++i) {
    for (const Value& v : components) p.coefficients.push_back(v.elements.front().at(i, 0));
  }
  return {.extents = {}, .elements = {std::move(p)}};
}

/// False, with a diagnostic, if alternative `i` of an `either` is certainly not equal to the first.
bool equal_to_first(ExpressionElaborator& e, const Expr& call, const Value& first, const Value& other, std::size_t i) {
  for (std::size_t k = 0; k < first.elements.size(); ++k) {
    for (std::size_t c = 0; c < first.elements[k].coefficients.size(); ++c) {
      const Comparison found = e.compare(first.elements[k].coefficients[c], other.elements[k].coefficients[c]);
      if (found == Comparison::equal || found == Comparison::unknown) continue;
      e.error(e.operand_span(call, i), "this alternative of `either` is not equal to the first",
              found == Comparison::opposite ? "the signs differ: it is the first one's negative"
                                            : "alternatives are one polynomial, written in several ways");
      return false;
    }
  }
  return true;
}

Value apply_either(ExpressionElaborator& e, const Expr& call, Arguments a) {
  std::vector<Value> values(a.begin(), a.end());
  for (const Value& v : values) {
    if (v.extents != a[0].extents || v.dimension() != a[0].dimension()) {
      return refuse(e, call, a, "its alternatives are values of one shape");
    }
  }
  elevate_to_common_degree(e.lowering(), values);
  std::vector<std::vector<Coefficient>> alternatives;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && !equal_to_first(e, call, values[0], values[i], i)) return {};
    std::vector<Coefficient>& coefficients = alternatives.emplace_back();
    for (const Polynomial& p : values[i].elements) {
      coefficients.insert(coefficients.end(), p.coefficients.begin(), p.coefficients.end());
    }
  }
  const std::vector<Coefficient> taken = either(e.lowering(), alternatives);
  Value result = values[0];
  auto next = taken.begin();
  for (Polynomial& p : result.elements) {
    for (Coefficient& c : p.coefficients) c = *next++;
  }
  return result;
}

constexpr std::array<Builtin, 18> table = {{
    {"abs", 1, 1, apply_abs},
    {"bernstein", 1, 1, apply_bernstein},
    {"coefficients", 1, 1, apply_coefficients},
    {"cross", 2, 2, apply_cross},
    {"det", 2, 3, apply_det},
    {"diff", 1, 1, apply_diff},
    {"dot", 2, 2, apply_dot},
    {"either", 2, -1, apply_either},
    {"elevate", 2, 2, apply_elevate},
    {"fma", 3, 3, apply_fma},
    {"max", 1, -1, apply_extremum},
    {"min", 1, -1, apply_extremum},
    {"rounded", 1, 1, apply_rounded},
    {"split", 2, 2, apply_split},
    {"sqrt", 1, 1, apply_sqrt},
    {"sum", 1, 1, apply_sum},
    {"vec2", 2, 2, apply_vector},
    {"vec3", 3, 3, apply_vector},
}};

}  // namespace

const Builtin* find_builtin(std::string_view name) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const Builtin& b) { return b.name == name; });
  return found == table.end() ? nullptr : &*found;
}

std::span<const Builtin> builtins() { return table; }

}  // namespace tightrope::dsl
