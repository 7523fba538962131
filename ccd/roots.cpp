#include "ccd/roots.h"

namespace tightrope::ccd {

template <class Real>
Real guess_extremum(const std::array<Bounded<Real>, 3>& q) {
  // q0 (1-t)^2 + 2 q1 t (1-t) + q2 t^2 = 0 for s = t / (1 - t): q2 s^2 + 2 q1 s + q0 = 0. Of a valley q0 <= 0 <= q2, of
  // a hill q0 >= 0 >= q2, so that s = (-q1 +- root) / q2 with the sign of q2, written without cancellation.
  const Real q0 = q[0].value, q1 = q[1].value, q2 = q[2].value;
  const Real root = std::sqrt(std::max(tightrope::product(q1, q1) - tightrope::product(q0, q2), Real{0}));
  const Real numerator = std::fabs(q0), denominator = (q2 < 0 ? -q1 : q1) + root;
  const Real t = numerator / (numerator + denominator);
  return t >= 0 && t <= 1 ? t : Real{0.5};
}

template double guess_extremum(const std::array<Bounded<double>, 3>&);
template float guess_extremum(const std::array<Bounded<float>, 3>&);

}  // namespace tightrope::ccd
