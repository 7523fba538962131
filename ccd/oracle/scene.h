#pragma once
/// A query over the integers: the eight points times one power of two, and the moving vectors between them as forms.

#include <gmpxx.h>

#include <array>
#include <span>
#include <vector>

#include "ccd/oracle/form.h"
#include "ccd/oracle/oracle.h"

namespace tightrope::ccd::oracle {

/// Names of the four moving points: of a vertex-face query, d against triangle abc; of an edge-edge query, ab against
/// cd.
enum class Corner : std::size_t { a, b, c, d };

/// Points 0-3 at t = 0, 4-7 at t = 1, in the order of Corner. Contact does not change under a common scaling.
using IntegerPoints = std::array<std::array<mpz_class, 3>, 8>;
IntegerPoints integer_points(Kind kind, std::span<const double, 24> points);

/// A moving vector: three forms of equal degree.
using Vector = std::array<Form, 3>;

Vector difference(const IntegerPoints& points, Corner p, Corner q);  ///< p - q, of degree 1
Vector operator+(const Vector& u, const Vector& v);
Form dot(const Vector& u, const Vector& v);
Vector cross(const Vector& u, const Vector& v);
bool is_zero(const Vector& u);

/// Whether the axis-aligned boxes that the two features sweep over [0, 1] are strictly apart, seen on the doubles
/// themselves: comparisons are exact, and a linear path stays in the box of its ends.
bool swept_boxes_apart(Kind kind, std::span<const double, 24> points);

}  // namespace tightrope::ccd::oracle
