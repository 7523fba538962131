/// The arithmetic of an imported function, as nodes.

#include <fmt/format.h>

#include <cmath>

#include "codegen/clang/interpreter.h"

namespace tightrope::codegen {

using dsl::NodeId;
using dsl::Op;

void Interpreter::use_real(clang::QualType type, clang::SourceLocation where) {
  const auto* builtin = type->getAs<clang::BuiltinType>();
  const auto kind = builtin == nullptr ? clang::BuiltinType::Void : builtin->getKind();
  if (kind != clang::BuiltinType::Double && kind != clang::BuiltinType::Float) {
    throw ImportError{where,
                      fmt::format("a number of type `{}`: predicates are of `double` or `float`", type.getAsString())};
  }
  if (real_ && *real_ != kind) {
    throw ImportError{where, "`double` and `float` are mixed; a predicate has one type for all its numbers"};
  }
  real_ = kind;
}

const double* Interpreter::constant_value(NodeId node) const {
  return graph_[node].op == Op::constant ? &graph_[node].value : nullptr;
}

/// The result of one operation on numbers of the type, rounded to it: for float, rounding to double in between is
/// innocuous for + - * / and the square root [Figueroa 1995].
double Interpreter::rounded(double value) const {
  return precision() == Precision::binary32 ? static_cast<double>(static_cast<float>(value)) : value;
}

NodeId Interpreter::constant(double value, clang::SourceLocation where) {
  if (!std::isfinite(value)) throw ImportError{where, "a constant that is infinite or no number"};
  return graph_.constant(value);
}

NodeId Interpreter::noted(NodeId node, NodeId a, NodeId b, clang::SourceLocation where) {
  written_order_.try_emplace(node, a, b);
  places_.try_emplace(node, where);
  return node;
}

namespace {

/// The language takes a factor of up to 53 bits times a power of two of an exponent in [-900, 900], or a power of two.
void check_factor(const double* factor, clang::SourceLocation where) {
  if (factor == nullptr || *factor == 0) return;
  int exponent = 0;
  double mantissa = std::frexp(std::abs(*factor), &exponent);
  if (mantissa == 0.5) return;
  while (mantissa != std::floor(mantissa)) mantissa *= 2, --exponent;
  constexpr int farthest = 900;
  if (std::abs(exponent) > farthest) {
    throw ImportError{where,
                      fmt::format("a product or quotient with the constant {}: factors that are no powers of two "
                                  "are odd numbers times 2^-{} to 2^{}",
                                  *factor, farthest, farthest)};
  }
}

}  // namespace

/// Besides folding constants: x + 0, x - 0, 1 x and x / 1 are x (but for the sign of a zero), sums with negative
/// constants become differences and x + x becomes 2 x, the same numbers in the language's own spelling.
NodeId Interpreter::binary(Op op, NodeId a, NodeId b, clang::SourceLocation where) {
  const double* const x = constant_value(a);
  const double* const y = constant_value(b);
  if (x != nullptr && y != nullptr) {
    switch (static_cast<int>(op)) {
      case static_cast<int>(Op::add):
        return constant(rounded(*x + *y), where);
      case static_cast<int>(Op::sub):
        return constant(rounded(*x - *y), where);
      case static_cast<int>(Op::mul):
        return constant(rounded(*x * *y), where);
      case static_cast<int>(Op::div):
        if (*y == 0) throw ImportError{where, "a division by zero"};
        return constant(rounded(*x / *y), where);
      case static_cast<int>(Op::min):
        return constant(std::min(*x, *y), where);
      default:
        return constant(std::max(*x, *y), where);
    }
  }
  if (op == Op::div && y != nullptr && *y == 0) throw ImportError{where, "a division by zero"};
  if (op == Op::mul || op == Op::div) {
    check_factor(x, where);
    check_factor(y, where);
  }
  const auto is = [](const double* constant, double value) { return constant != nullptr && *constant == value; };
  if (is(y, op == Op::add || op == Op::sub ? 0 : 1) && op != Op::min && op != Op::max) return a;
  if ((op == Op::add && is(x, 0)) || (op == Op::mul && is(x, 1))) return b;
  if (op == Op::add && a == b) return binary(Op::mul, a, graph_.constant(2), where);
  if (op == Op::add && x != nullptr && *x < 0) return binary(Op::sub, b, graph_.constant(-*x), where);
  if ((op == Op::add || op == Op::sub) && y != nullptr && *y < 0) {
    return binary(op == Op::add ? Op::sub : Op::add, a, graph_.constant(-*y), where);
  }
  if (op == Op::sub && x != nullptr && *x < 0) {
    return unary(Op::neg, binary(Op::add, graph_.constant(-*x), b, where), where);
  }
  return noted(graph_.binary(op, a, b), a, b, where);
}

NodeId Interpreter::unary(Op op, NodeId a, clang::SourceLocation where) {
  if (const double* const x = constant_value(a)) {
    if (op == Op::neg) return constant(-*x, where);
    if (op == Op::abs) return constant(std::abs(*x), where);
    if (*x < 0) throw ImportError{where, "a square root of a negative number"};
    return constant(rounded(std::sqrt(*x)), where);
  }
  if (op == Op::neg && graph_[a].op == Op::neg) return graph_[a].a;
  return noted(graph_.unary(op, a), a, dsl::no_node, where);
}

}  // namespace tightrope::codegen
