#pragma once
/// The exact meaning of a predicate, as generated tests hold it: its operations as a table, evaluated in exact
/// arithmetic (what is true) or in plain floating point (what the generated values must be). Host only.

#include <tightrope/enclosure.h>
#include <tightrope/sign.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace tightrope::testing {

/// Where these tests themselves divide by what may be 0 (and mean infinity or NaN); generated code never does.
#if defined(__GNUC__)
#define TIGHTROPE_MAY_DIVIDE_BY_ZERO __attribute__((no_sanitize("float-divide-by-zero")))
#else
#define TIGHTROPE_MAY_DIVIDE_BY_ZERO
#endif

enum class Op : unsigned char {
  input,
  constant,
  add,
  sub,
  neg,
  mul,
  scale,
  div,
  sqrt,
  abs,
  min,
  max,
  fma,
  larger,
  select
};

/// One line of a table; `a`, `b` and `c` are lines above it, or the input slot, or the power of two of `scale`.
struct Operation {
  Op op;
  int a;
  int b;
  double value;
  int c = 0;
};

constexpr Operation input(int slot) { return {Op::input, slot, 0, 0}; }
constexpr Operation constant(double value) { return {Op::constant, 0, 0, value}; }
constexpr Operation add(int a, int b) { return {Op::add, a, b, 0}; }
constexpr Operation sub(int a, int b) { return {Op::sub, a, b, 0}; }
constexpr Operation neg(int a) { return {Op::neg, a, 0, 0}; }
constexpr Operation mul(int a, int b) { return {Op::mul, a, b, 0}; }
constexpr Operation scale(int a, int exponent) { return {Op::scale, a, exponent, 0}; }  ///< a * 2^exponent
constexpr Operation div(int a, int b) { return {Op::div, a, b, 0}; }
constexpr Operation sqrt(int a) { return {Op::sqrt, a, 0, 0}; }
constexpr Operation abs(int a) { return {Op::abs, a, 0, 0}; }
constexpr Operation min(int a, int b) { return {Op::min, a, b, 0}; }
constexpr Operation max(int a, int b) { return {Op::max, a, b, 0}; }
constexpr Operation fma(int a, int b, int c) { return {Op::fma, a, b, 0, c}; }  ///< a * b + c
constexpr Operation larger(int a, int b) { return {Op::larger, a, b, 0}; }      ///< max, may ignore a NaN in b
/// b if a >= 0, else c: of alternatives that are equal in the end (`either`).
constexpr Operation select(int a, int b, int c) { return {Op::select, a, b, 0, c}; }

/// A parameter; its slots follow each other: elements outermost, then time, then component.
struct Parameter {
  const char* name;
  int elements;
  int times;  ///< 2 if it moves
  int dimension;
  bool bounded;
  bool point;           ///< a translation moves it
  double range;         ///< |coordinate| <= range; infinite if none was declared
  int normalized = -1;  ///< the group of inputs that generated code multiplies by one power of two
  int slots() const { return elements * times * dimension; }
};

struct Output {
  const char* name;
  std::vector<int> extents;
  bool sign;  ///< its sign is asked for, not only its value
  int elements() const {
    int n = 1;
    for (const int extent : extents) n *= extent;
    return n;
  }
};

/// What was declared to hold for some outputs.
struct Property {
  enum class Kind : unsigned char { permutation, translation, scale };
  const char* text;
  Kind kind;
  int factor;                    ///< permutation: the outputs are multiplied by 1 or -1
  int exponent;                  ///< scale: f(s x) = s^exponent f(x)
  std::vector<int> permutation;  ///< slot i of the permuted inputs is slot permutation[i] of the inputs
  std::vector<int> outputs;      ///< elements it holds for, counted over all outputs
};

struct Reference {
  const char* name;
  std::span<const Operation> operations;
  std::span<const Parameter> parameters;
  std::span<const Output> outputs;
  std::span<const int> results;  ///< the operation of each output element, over all stages and outputs in order
  std::span<const Property> properties;
  bool same_values;  ///< generated values are those of `operations` in floating point, operation by operation
  int cases;         ///< inputs to try in each test
};

/// A number that may be infinite or undefined (0/0, inf - inf, sqrt(-1), and all that depends on it); or it is unknown
/// whether it is a number (a divisor too near to 0 to tell).
struct Exact {
  enum class Kind : unsigned char { finite, positive_infinity, negative_infinity, undefined, unknown };
  Kind kind = Kind::finite;
  Enclosure value;  ///< if finite; exact but for roots

  bool finite() const { return kind == Kind::finite; }
  static Exact undefined() { return {Kind::undefined, {}}; }
  static Exact of(const Enclosure& x) {
    return {x.is_number() ? Kind::finite : x.is_undefined() ? Kind::undefined : Kind::unknown, x};
  }
  static Exact of(double x) {
    if (std::isnan(x)) return undefined();
    if (std::isinf(x)) return {x > 0 ? Kind::positive_infinity : Kind::negative_infinity, {}};
    return {Kind::finite, Enclosure(x)};
  }
};

namespace detail {

inline Exact negated(const Exact& a) {
  switch (a.kind) {
    case Exact::Kind::finite:
      return {a.kind, -a.value};
    case Exact::Kind::positive_infinity:
      return {Exact::Kind::negative_infinity, {}};
    case Exact::Kind::negative_infinity:
      return {Exact::Kind::positive_infinity, {}};
    case Exact::Kind::undefined:
    case Exact::Kind::unknown:
      break;
  }
  return a;
}

/// Of numbers that are not both finite.
inline bool less(const Exact& a, const Exact& b) {
  if (a.kind == Exact::Kind::negative_infinity || b.kind == Exact::Kind::positive_infinity) return a.kind != b.kind;
  return false;
}

inline Exact smaller(const Exact& a, const Exact& b, bool smaller_one) {
  for (const Exact::Kind kind : {Exact::Kind::undefined, Exact::Kind::unknown}) {
    if (a.kind == kind || b.kind == kind) return {kind, {}};
  }
  if (a.finite() && b.finite()) return Exact::of(smaller_one ? min(a.value, b.value) : max(a.value, b.value));
  return less(a, b) == smaller_one ? a : b;
}

inline Exact apply(const Operation& o, const Exact& a, const Exact& b) {
  if (o.op == Op::min || o.op == Op::max || o.op == Op::larger) return smaller(a, b, o.op == Op::min);
  if (o.op == Op::neg) return negated(a);
  if (o.op == Op::abs && a.kind == Exact::Kind::negative_infinity) return negated(a);
  if (o.op == Op::abs && !a.finite()) return a;
  const bool unknown = a.kind == Exact::Kind::unknown || b.kind == Exact::Kind::unknown;
  if (unknown && a.kind != Exact::Kind::undefined && b.kind != Exact::Kind::undefined)
    return {Exact::Kind::unknown, {}};
  if (!a.finite() || !b.finite()) return Exact::undefined();
  switch (o.op) {
    case Op::add:
      return Exact::of(a.value + b.value);
    case Op::sub:
      return Exact::of(a.value - b.value);
    case Op::mul:
      return Exact::of(a.value * b.value);
    case Op::scale:
      return Exact::of(mul_pow2(a.value, o.b));
    case Op::div:
      return Exact::of(a.value / b.value);
    case Op::abs:
      return Exact::of(abs(a.value));
    case Op::sqrt:
      return Exact::of(sqrt(a.value));
    case Op::input:
    case Op::constant:
    case Op::neg:
    case Op::min:
    case Op::max:
    case Op::fma:
    case Op::larger:
    case Op::select:
      break;
  }
  return Exact::undefined();
}

constexpr bool has_second_operand(Op op) {
  return op == Op::add || op == Op::sub || op == Op::mul || op == Op::div || op == Op::min || op == Op::max ||
         op == Op::fma || op == Op::larger || op == Op::select;
}

}  // namespace detail

/// Whether generated code tests preconditions: where a divisor may be 0 or a radicand negative it has NaN in place of
/// a value.
inline bool has_preconditions(const Reference& reference) {
  for (const Operation& o : reference.operations) {
    const bool quotient = o.op == Op::div && reference.operations[static_cast<std::size_t>(o.b)].op != Op::constant;
    if (quotient || o.op == Op::sqrt) return true;
  }
  return false;
}

inline bool has_alternatives(const Reference& reference) {
  for (const Operation& o : reference.operations) {
    if (o.op == Op::select) return true;
  }
  return false;
}

/// The exact outputs for the exact inputs `slots`. Of alternatives the one that `takes_first`, which gets the line of a
/// condition and is to answer the same for the same line, says.
template <class TakesFirst>
std::vector<Exact> evaluate_exact(const Reference& reference, std::span<const Exact> slots,
                                  const TakesFirst& takes_first) {
  std::vector<Exact> v;
  v.reserve(reference.operations.size());
  for (const Operation& o : reference.operations) {
    const auto a = static_cast<std::size_t>(o.a);
    if (o.op == Op::input) {
      v.push_back(slots[a]);
    } else if (o.op == Op::constant) {
      v.push_back(Exact::of(o.value));
    } else if (o.op == Op::fma) {
      const Exact product = detail::apply(mul(o.a, o.b), v[a], v[static_cast<std::size_t>(o.b)]);
      v.push_back(detail::apply(add(o.a, o.c), product, v[static_cast<std::size_t>(o.c)]));
    } else if (o.op == Op::select) {
      v.push_back(v[static_cast<std::size_t>(takes_first(o.a) ? o.b : o.c)]);
    } else {
      v.push_back(detail::apply(o, v[a], v[detail::has_second_operand(o.op) ? static_cast<std::size_t>(o.b) : a]));
    }
  }
  std::vector<Exact> results;
  for (const int r : reference.results) results.push_back(v[static_cast<std::size_t>(r)]);
  return results;
}

/// The same whichever alternatives are taken; unknown where they do not agree on there being a number.
inline std::vector<Exact> evaluate_exact(const Reference& reference, std::span<const Exact> slots) {
  std::vector<Exact> results = evaluate_exact(reference, slots, [](int) { return true; });
  if (!has_alternatives(reference)) return results;
  const std::vector<Exact> last = evaluate_exact(reference, slots, [](int) { return false; });
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].kind != last[i].kind) results[i] = {Exact::Kind::unknown, {}};
  }
  return results;
}

/// The outputs in plain floating point, every operation rounded once.
template <class Real>
TIGHTROPE_MAY_DIVIDE_BY_ZERO std::vector<Real> evaluate_plain(const Reference& reference, std::span<const Real> slots) {
  std::vector<Real> v;
  v.reserve(reference.operations.size());
  for (const Operation& o : reference.operations) {
    const auto a = static_cast<std::size_t>(o.a);
    const auto b = detail::has_second_operand(o.op) ? static_cast<std::size_t>(o.b) : a;
    switch (o.op) {
      case Op::input:
        v.push_back(slots[a]);
        break;
      case Op::constant:
        v.push_back(static_cast<Real>(o.value));
        break;
      case Op::add:
        v.push_back(v[a] + v[b]);
        break;
      case Op::sub:
        v.push_back(v[a] - v[b]);
        break;
      case Op::neg:
        v.push_back(-v[a]);
        break;
      case Op::mul:
        v.push_back(product(v[a], v[b]));
        break;
      case Op::scale:
        v.push_back(std::ldexp(v[a], o.b));
        break;
      case Op::div:
        v.push_back(v[a] / v[b]);
        break;
      case Op::sqrt:
        v.push_back(std::sqrt(v[a]));
        break;
      case Op::abs:
        v.push_back(magnitude(v[a]));
        break;
      case Op::min:
        v.push_back(minimum(v[a], v[b]));
        break;
      case Op::max:
        v.push_back(maximum(v[a], v[b]));
        break;
      case Op::larger:
        v.push_back(max_magnitude(v[a], v[b]));
        break;
      case Op::select:
        v.push_back(choose(v[a], v[b], v[static_cast<std::size_t>(o.c)]));
        break;
      case Op::fma:
        v.push_back(std::fma(v[a], v[b], v[static_cast<std::size_t>(o.c)]));
        break;
    }
  }
  std::vector<Real> results;
  for (const int r : reference.results) results.push_back(v[static_cast<std::size_t>(r)]);
  return results;
}

}  // namespace tightrope::testing
