#pragma once
/// Exact signs of the classical predicates by their textbook determinants over GMP's integers: other formulas, and
/// other arithmetic, than those of the code under test.

#include <gmpxx.h>

#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <vector>

namespace tightrope::testing {

template <std::size_t N>
using Point = std::array<double, N>;

/// x * 2^scale, which must be a whole number.
inline mpz_class whole(double x, int scale) {
  const mpq_class exact(x);
  mpz_class numerator = exact.get_num();
  mpz_mul_2exp(numerator.get_mpz_t(), numerator.get_mpz_t(), static_cast<mp_bitcnt_t>(scale));
  if (!mpz_divisible_p(numerator.get_mpz_t(), exact.get_den().get_mpz_t())) throw std::logic_error("scale too small");
  return numerator / exact.get_den();
}

using Matrix = std::vector<std::vector<mpz_class>>;

/// By expansion along the first column.
inline mpz_class determinant(const Matrix& m) {
  if (m.empty()) return 1;
  mpz_class sum = 0;
  for (std::size_t row = 0; row < m.size(); ++row) {
    if (m[row][0] == 0) continue;
    Matrix minor;
    for (std::size_t i = 0; i < m.size(); ++i) {
      if (i != row) minor.emplace_back(m[i].begin() + 1, m[i].end());
    }
    const mpz_class term = m[row][0] * determinant(minor);
    if (row % 2 == 0) {
      sum += term;
    } else {
      sum -= term;
    }
  }
  return sum;
}

/// Rows (1, x, y, ...) of the points, with a last column x^2 + y^2 + ... if `lifted`; coordinates times 2^scale.
template <std::size_t N>
Matrix homogeneous_rows(std::span<const Point<N>> points, bool lifted, int scale) {
  Matrix rows;
  for (const Point<N>& p : points) {
    std::vector<mpz_class> row = {1};
    mpz_class lift = 0;
    for (const double x : p) {
      row.push_back(whole(x, scale));
      lift += row.back() * row.back();
    }
    if (lifted) row.push_back(lift);
    rows.push_back(row);
  }
  return rows;
}

/// Of det [x y .. 1]: the orientation of N + 1 points; with `lifted`, det [x y .. x^2 + y^2 + .. 1]: the in-sphere
/// determinant of N + 2 points.
template <std::size_t N>
int sign_of_determinant(std::span<const Point<N>> points, bool lifted, int scale) {
  const int sign = sgn(determinant(homogeneous_rows(points, lifted, scale)));
  const std::size_t moved = points.size() - 1;  // the column of ones stands first here: that many swaps
  return moved % 2 == 0 ? sign : -sign;
}

/// The centre of the circle through three points of the plane, from the two equations 2 (q - p) . c = q^2 - p^2.
inline std::array<mpq_class, 2> circumcentre(const Point<2>& a, const Point<2>& b, const Point<2>& c) {
  const auto equation = [&](const Point<2>& p, const Point<2>& q) {
    const mpq_class px(p[0]), py(p[1]), qx(q[0]), qy(q[1]);
    return std::array<mpq_class, 3>{2 * (qx - px), 2 * (qy - py), qx * qx + qy * qy - px * px - py * py};
  };
  const auto e = equation(a, b);
  const auto f = equation(b, c);
  const mpq_class d = e[0] * f[1] - e[1] * f[0];
  if (d == 0) throw std::logic_error("no circle through points of a line");
  return {mpq_class((e[2] * f[1] - e[1] * f[2]) / d), mpq_class((e[0] * f[2] - e[2] * f[0]) / d)};
}

}  // namespace tightrope::testing
