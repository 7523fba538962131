// Does a point stay on its side of a swinging door? The geometry is in side_of_door.pred.
#include <cstdio>

#include "side_of_door.float.double.h"
#include "side_of_door.tight.double.h"

using tightrope::Sign;

const double hinge[] = {0.8, 0.1}, handle_t0[] = {2.6, 0.1}, handle_t1[] = {2.6, 1.9};  // the door, at t = 0 and t = 1

// +1 or -1: left or right of the door during the whole step. 0: it crosses, or touches, or is too close to tell.
template <class Bound>
int side(const double* p_t0, const double* p_t1) {
  using tightrope::generated::side_of_door;
  const auto result = side_of_door<Bound, double>::evaluate(p_t0, p_t1, hinge, hinge, handle_t0, handle_t1);
  const Sign first = sign(result.area[0]);
  for (const auto& coefficient : result.area) {
    if (sign(coefficient) != first) return 0;
  }
  return static_cast<int>(first);
}

int main() {
  const double start[] = {1.1, 1.4};
  const double left[] = {1.1, 0.9};
  const double through[] = {1.1, 0.4};  // 1e-17 beyond the door
  std::printf("ends left of the door:  in double %+d, with its bound %+d\n", side<tightrope::bound::none>(start, left),
              side<tightrope::bound::tight>(start, left));
  std::printf("ends beyond the door:   in double %+d, with its bound %+d\n",
              side<tightrope::bound::none>(start, through), side<tightrope::bound::tight>(start, through));
}
