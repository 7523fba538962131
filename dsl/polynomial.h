#pragma once
/// Polynomials in t in the Bernstein basis over [0, 1], scalar- or vector-valued, while they are being lowered.
///
/// A polynomial holds its true Bernstein coefficients b_i, each an exact multiple of a node. Products work on the
/// scaled coefficients s_i = C(n,i) b_i, for which a product is a plain convolution: s_k = sum over i + j = k of
/// s_i s'_j. The coefficients of a product therefore are b_k = (1 / C(n,k)) * node, and a further product finds factor
/// 1 again: `cross` of linear vectors gives c0, X/2, c2 and the cubic of MATH 1.2 the nodes w0.c0, w0.X + w1.c0, ...

#include <array>
#include <cstddef>
#include <vector>

#include "dsl/coefficient.h"

namespace tightrope::dsl {

struct Polynomial {
  int dimension = 1;  ///< 1, 2 or 3
  int degree = 0;
  std::vector<Coefficient> coefficients;  ///< (degree + 1) x dimension: coefficient, then component

  /// The place of coefficient i's component in `coefficients`.
  std::size_t place(int i, int component) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(dimension) + static_cast<std::size_t>(component);
  }
  Coefficient& at(int i, int component) { return coefficients[place(i, component)]; }
  const Coefficient& at(int i, int component) const { return coefficients[place(i, component)]; }
};

enum class Bilinear {
  multiply,  ///< scalar * anything, the scalar first
  dot,       ///< x x' + y y' + z z', left to right
  cross,     ///< vec3: y z' - z y', ...; vec2: the scalar x y' - y x'
};

/// P with each coefficient replaced by C(n,i) b_i; the factors of a component are the same.
Polynomial scaled(Lowering& low, const Polynomial& p);

/// The product, of the sum of the degrees, by `low.products`. Karatsuba's identity s_i s'_j + s_j s'_i = s_i s'_i +
/// s_j s'_j - (s_j - s_i)(s'_j - s'_i) is used on whole bilinear operations of factors of equal degree (degree 1 is
/// MATH 1.1; for higher degrees it holds as well, being free of weights in scaled form); squares are always direct.
Polynomial product(Lowering& low, Bilinear operation, const Polynomial& p, const Polynomial& q);

Polynomial sum(Lowering& low, const Polynomial& p, const Polynomial& q);
Polynomial difference(Lowering& low, const Polynomial& p, const Polynomial& q);
Polynomial negate(const Polynomial& p);
Polynomial scale(Lowering& low, const Polynomial& p, const Rational& by);
Polynomial divide(Lowering& low, const Polynomial& p, const Coefficient& by);
/// The same polynomial with a degree not less than its own.
Polynomial elevate(Lowering& low, const Polynomial& p, int degree);
Polynomial derivative(Lowering& low, const Polynomial& p);

/// The place of an evaluation: the homogeneous weights (whole - r, r) of t = r / whole.
struct Weights {
  Coefficient zero;   ///< the weight at t = 0, whole - r
  Coefficient one;    ///< the weight at t = 1, r
  Coefficient whole;  ///< their sum; the number 1 for an evaluation at r itself
};
Weights weights(Lowering& low, const Coefficient& r, const Coefficient& whole);

/// whole^n * P(r / whole) by `low.evaluation`. Horner: ((s_n r + s_(n-1) q) r + s_(n-2) q^2) r + ... with q = whole -
/// r: no coefficient suffers more roundings than in de Casteljau's scheme (n products and n sums), and scaled
/// coefficients need no division. De Casteljau: the last point of his scheme, as in `split`.
Polynomial value_at(Lowering& low, const Polynomial& p, const Weights& w);
/// The end coefficient at t = 0 or 1.
Polynomial value_at_end(const Polynomial& p, int end);
/// The two parts at t = r / whole by de Casteljau's scheme, all coefficients scaled by whole^n (MATH 3.1).
std::array<Polynomial, 2> split(Lowering& low, const Polynomial& p, const Weights& w);

}  // namespace tightrope::dsl
