#include "dsl/polynomial.h"

#include <algorithm>
#include <cassert>
#include <span>

namespace tightrope::dsl {
namespace {

using Vector = std::vector<Coefficient>;

Polynomial zero(int dimension, int degree) {
  Polynomial result{.dimension = dimension, .degree = degree, .coefficients = {}};
  result.coefficients.assign(result.place(degree + 1, 0), number(0));
  return result;
}

std::span<const Coefficient> coefficient(const Polynomial& p, int i) {
  return std::span(p.coefficients).subspan(p.place(i, 0), static_cast<std::size_t>(p.dimension));
}

/// x y' - y x' or one component of the cross product.
Coefficient minor(Lowering& low, const Coefficient& x, const Coefficient& y, const Coefficient& xx,
                  const Coefficient& yy) {
  const Coefficient terms[] = {multiply(low, x, yy), negate(multiply(low, y, xx))};
  return sum(low, terms);
}

Vector apply(Lowering& low, Bilinear operation, std::span<const Coefficient> u, std::span<const Coefficient> v) {
  Vector result;
  switch (operation) {
    case Bilinear::multiply:
      for (const Coefficient& c : v) result.push_back(multiply(low, u[0], c));
      break;
    case Bilinear::dot: {
      Vector terms;
      for (std::size_t c = 0; c < u.size(); ++c) terms.push_back(multiply(low, u[c], v[c]));
      result.push_back(sum(low, terms));
      break;
    }
    case Bilinear::cross:
      if (u.size() == 2) {
        result.push_back(minor(low, u[0], u[1], v[0], v[1]));
      } else {
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t next = (c + 1) % 3;
          const std::size_t last = (c + 2) % 3;
          result.push_back(minor(low, u[next], u[last], v[next], v[last]));
        }
      }
      break;
  }
  return result;
}

int result_dimension(Bilinear operation, const Polynomial& q) {
  switch (operation) {
    case Bilinear::multiply:
      return q.dimension;
    case Bilinear::dot:
      return 1;
    case Bilinear::cross:
      return q.dimension == 3 ? 3 : 1;
  }
  return 1;
}

/// The terms whose sum is scaled coefficient k of a product, each a vector.
using Terms = std::vector<std::vector<Vector>>;

Terms direct_terms(Lowering& low, Bilinear operation, const Polynomial& p, const Polynomial& q) {
  Terms terms(static_cast<std::size_t>(p.degree + q.degree + 1));
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const int last = static_cast<int>(k);
    for (int i = std::max(0, last - q.degree); i <= std::min(p.degree, last); ++i) {
      terms[k].push_back(apply(low, operation, coefficient(p, i), coefficient(q, last - i)));
    }
  }
  return terms;
}

Vector componentwise_difference(Lowering& low, std::span<const Coefficient> a, std::span<const Coefficient> b) {
  Vector result;
  for (std::size_t c = 0; c < a.size(); ++c) result.push_back(subtract(low, a[c], b[c]));
  return result;
}

/// s_i s'_j + s_j s'_i = s_i s'_i + s_j s'_j - (s_j - s_i)(s'_j - s'_i).
Terms karatsuba_terms(Lowering& low, Bilinear operation, const Polynomial& p, const Polynomial& q) {
  const int n = p.degree;
  Terms terms(static_cast<std::size_t>(2 * n + 1));
  std::vector<Vector> diagonal;
  for (int i = 0; i <= n; ++i) diagonal.push_back(apply(low, operation, coefficient(p, i), coefficient(q, i)));
  for (int k = 0; k <= 2 * n; ++k) {
    std::vector<Vector>& of_k = terms[static_cast<std::size_t>(k)];
    for (int i = std::max(0, k - n); 2 * i < k; ++i) {
      const int j = k - i;
      of_k.push_back(diagonal[static_cast<std::size_t>(i)]);
      of_k.push_back(diagonal[static_cast<std::size_t>(j)]);
      of_k.push_back(apply(low, operation, componentwise_difference(low, coefficient(p, j), coefficient(p, i)),
                           componentwise_difference(low, coefficient(q, j), coefficient(q, i))));
      for (Coefficient& c : of_k.back()) c = negate(c);
    }
    if (k % 2 == 0) of_k.push_back(diagonal[static_cast<std::size_t>(k / 2)]);
  }
  return terms;
}

}  // namespace

Polynomial scaled(Lowering& low, const Polynomial& p) {
  Polynomial result = p;
  if (p.degree == 0) return result;
  for (int i = 1; i < p.degree; ++i) {
    const Rational weight = binomial(p.degree, i);
    for (int c = 0; c < p.dimension; ++c) result.at(i, c) = scale(low, p.at(i, c), weight);
  }
  Vector component(static_cast<std::size_t>(p.degree + 1));
  for (int c = 0; c < p.dimension; ++c) {
    for (int i = 0; i <= p.degree; ++i) component[static_cast<std::size_t>(i)] = result.at(i, c);
    share_factor(low, component);
    for (int i = 0; i <= p.degree; ++i) result.at(i, c) = component[static_cast<std::size_t>(i)];
  }
  return result;
}

Polynomial product(Lowering& low, Bilinear operation, const Polynomial& p, const Polynomial& q) {
  assert(operation == Bilinear::multiply ? p.dimension == 1 : p.dimension == q.dimension);
  const Polynomial u = scaled(low, p);
  const Polynomial v = scaled(low, q);
  const bool karatsuba = low.products == ProductScheme::karatsuba && u.degree == v.degree && u.degree > 0 &&
                         u.coefficients != v.coefficients;
  const Terms terms = karatsuba ? karatsuba_terms(low, operation, u, v) : direct_terms(low, operation, u, v);
  Polynomial result = zero(result_dimension(operation, q), p.degree + q.degree);
  Vector summands;
  for (int k = 0; k <= result.degree; ++k) {
    const Rational weight = Rational(1) / binomial(result.degree, k);
    for (int c = 0; c < result.dimension; ++c) {
      summands.clear();
      for (const Vector& term : terms[static_cast<std::size_t>(k)])
        summands.push_back(term[static_cast<std::size_t>(c)]);
      result.at(k, c) = scale(low, sum(low, summands), weight);
    }
  }
  return result;
}

Polynomial sum(Lowering& low, const Polynomial& p, const Polynomial& q) {
  assert(p.dimension == q.dimension);
  const int degree = std::max(p.degree, q.degree);
  Polynomial result = elevate(low, p, degree);
  const Polynomial other = elevate(low, q, degree);
  for (std::size_t i = 0; i < result.coefficients.size(); ++i) {
    result.coefficients[i] = add(low, result.coefficients[i], other.coefficients[i]);
  }
  return result;
}

Polynomial difference(Lowering& low, const Polynomial& p, const Polynomial& q) { return sum(low, p, negate(q)); }

Polynomial negate(const Polynomial& p) {
  Polynomial result = p;
  for (Coefficient& c : result.coefficients) c = negate(c);
  return result;
}

Polynomial scale(Lowering& low, const Polynomial& p, const Rational& by) {
  Polynomial result = p;
  for (Coefficient& c : result.coefficients) c = scale(low, c, by);
  return result;
}

Polynomial divide(Lowering& low, const Polynomial& p, const Coefficient& by) {
  Polynomial result = p;
  for (Coefficient& c : result.coefficients) c = divide(low, c, by);
  return result;
}

Polynomial elevate(Lowering& low, const Polynomial& p, int degree) {
  assert(degree >= p.degree);
  if (degree == p.degree) return p;
  Polynomial result = zero(p.dimension, degree);
  if (p.degree == 0) {  // every coefficient of a constant is that constant
    for (int i = 0; i <= degree; ++i) {
      for (int c = 0; c < p.dimension; ++c) result.at(i, c) = p.at(0, c);
    }
    return result;
  }
  // Multiplying by 1 = (1 - t + t)^(degree - n) in scaled form: s'_k = sum of C(degree - n, k - i) s_i.
  const Polynomial s = scaled(low, p);
  const int raise = degree - p.degree;
  Vector terms;
  for (int k = 0; k <= degree; ++k) {
    for (int c = 0; c < p.dimension; ++c) {
      terms.clear();
      for (int i = std::max(0, k - raise); i <= std::min(p.degree, k); ++i) {
        terms.push_back(scale(low, s.at(i, c), binomial(raise, k - i)));
      }
      result.at(k, c) = scale(low, sum(low, terms), Rational(1) / binomial(degree, k));
    }
  }
  return result;
}

Polynomial derivative(Lowering& low, const Polynomial& p) {
  if (p.degree == 0) return zero(p.dimension, 0);
  Polynomial result = zero(p.dimension, p.degree - 1);
  for (int i = 0; i < p.degree; ++i) {
    for (int c = 0; c < p.dimension; ++c) {  // n (b_(i+1) - b_i); n first, it cancels the weights of products
      result.at(i, c) = subtract(low, scale(low, p.at(i + 1, c), p.degree), scale(low, p.at(i, c), p.degree));
    }
  }
  return result;
}

Weights weights(Lowering& low, const Coefficient& r, const Coefficient& whole) {
  Coefficient pair[] = {complement(low, r, whole), r};
  share_factor(low, pair);  // otherwise their factors would be multiplied to every product with a coefficient
  return {.zero = pair[0], .one = pair[1], .whole = whole};
}

Polynomial value_at_end(const Polynomial& p, int end) {
  const std::span<const Coefficient> b = coefficient(p, end == 0 ? 0 : p.degree);
  return {.dimension = p.dimension, .degree = 0, .coefficients = Vector(b.begin(), b.end())};
}

namespace {

bool is_number_zero(const Coefficient& c) { return c.is_number() && c.factor.is_zero(); }

/// One level of de Casteljau's scheme: whole times the points between those of `points`, the last of which goes.
void interpolate(Lowering& low, Vector& points, const Weights& w) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    points[i] = add(low, multiply(low, points[i], w.zero), multiply(low, points[i + 1], w.one));
  }
  points.pop_back();
}

/// whole^n times the point in which de Casteljau's scheme ends, for the weights at r / whole.
Polynomial last_point(Lowering& low, const Polynomial& p, const Weights& w) {
  Polynomial result = value_at_end(p, 0);
  for (int c = 0; c < p.dimension; ++c) {
    Vector points;
    for (int i = 0; i <= p.degree; ++i) points.push_back(p.at(i, c));
    share_factor(low, points);
    while (points.size() > 1) interpolate(low, points, w);
    result.at(0, c) = points.front();
  }
  return result;
}

}  // namespace

Polynomial value_at(Lowering& low, const Polynomial& p, const Weights& w) {
  if (p.degree == 0) return p;
  const Polynomial s = scaled(low, p);
  Polynomial result = value_at_end(s, 1);
  if (is_number_zero(w.one)) {  // at 0 / whole
    result = value_at_end(s, 0);
    for (int i = 0; i < p.degree; ++i) {
      for (Coefficient& c : result.coefficients) c = multiply(low, c, w.zero);
    }
    return result;
  }
  if (low.evaluation == EvaluationScheme::de_casteljau && !is_number_zero(w.zero)) return last_point(low, p, w);
  Coefficient power = w.zero;
  for (int i = p.degree - 1; i >= 0; --i) {
    for (int c = 0; c < p.dimension; ++c) {
      Coefficient& total = result.at(0, c);
      total = multiply(low, total, w.one);
      if (!is_number_zero(w.zero)) total = add(low, total, multiply(low, s.at(i, c), power));
    }
    if (i > 0) power = multiply(low, power, w.zero);
  }
  return result;
}

std::array<Polynomial, 2> split(Lowering& low, const Polynomial& p, const Weights& w) {
  const int n = p.degree;
  Vector powers = {number(1)};  // of whole
  for (int i = 0; i < n; ++i) powers.push_back(i == 0 ? w.whole : multiply(low, powers.back(), w.whole));
  std::array<Polynomial, 2> parts = {p, p};
  for (int c = 0; c < p.dimension; ++c) {
    Vector points;
    for (int i = 0; i <= n; ++i) points.push_back(p.at(i, c));
    share_factor(low, points);
    // Level r holds whole^r times the points of the scheme; the rest of whole^n is multiplied to the results.
    for (int level = 0; level <= n; ++level) {
      const Coefficient& rest = powers[static_cast<std::size_t>(n - level)];
      parts[0].at(level, c) = multiply(low, points.front(), rest);
      parts[1].at(n - level, c) = multiply(low, points[static_cast<std::size_t>(n - level)], rest);
      if (level < n) interpolate(low, points, w);
    }
  }
  return parts;
}

}  // namespace tightrope::dsl
