// Functions that `tightrope import` takes; compare_test.cpp runs them beside what became of them.
#include <algorithm>
#include <array>
#include <cmath>

namespace imported {

double orient2d(const double* a, const double* b, const double* c) {
  const double acx = a[0] - c[0];
  const double bcx = b[0] - c[0];
  const double acy = a[1] - c[1];
  const double bcy = b[1] - c[1];
  return acx * bcy - acy * bcx;
}

struct Vector {
  double x, y, z;
  double dot(const Vector& v) const { return x * v.x + y * v.y + z * v.z; }
};
Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector cross(Vector a, Vector b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

double orient3d(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
  const Vector n = cross(b - a, c - a);
  return n.dot(d - a);
}

// Constants that are no doubles, factors that must be rounded where they stand, min, max, abs, roots, quotients.
double mixture(double x, double y, std::array<double, 4> z) {
  double t = 3 * x * y + std::sqrt(x * x + y * y) * 0.1;
  t -= std::max(std::abs(x), std::fabs(y)) + std::min(z[0], z[3]);
  const double least = x < y ? x : y;
  t += (least - 5) * (2 * x) * y / 3 + (x + x) - 7 - -3.5 + 1e-3;
  t /= 1 + z[1] * z[1];
  return -t * (z[2] < 0 ? -z[2] : z[2]) + (-5 - x) - (0.7 / (1 + y * y)) * 3;
}

constexpr int size = 3;
constexpr double weights[size] = {1.0, 4.0, 1.0};

void smooth(const double matrix[size][size], const double* v, double* out) {
  for (int i = 0; i < size; ++i) {
    out[i] = 0;
    for (int j = 0; j < size; ++j) out[i] += weights[j] * matrix[i][j] * v[j];
    if (i == 1) out[i] = -out[i];
  }
}

template <class Real>
Real horner(const Real* coefficients, int degree, Real x) {
  Real result = coefficients[degree];
  while (degree-- > 0) result = result * x + coefficients[degree];
  return result;
}
float quintic(const float (&c)[6], float x) { return horner(c, 5, x) * 0.1f; }

double sum_of_squares(const std::array<double, 5>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return sum;
}

}  // namespace imported
