// On which side of a line is a point? One point steps through 256 x 256 neighbouring doubles around a place on the
// line. Plain double gets thousands of the signs wrong; TightBound calls them uncertain; the staged predicate gets all
// right.
#include <cstdio>

#include "orientation.float.double.h"
#include "orientation.staged.double.h"
#include "orientation.tight.double.h"

using namespace tightrope;
using generated::orient2d;

const double q[] = {12, 12}, r[] = {24, 24};

// p = (x, y) against the line x = y from q to r: left of it is y > x.
int truth(const double* p) { return (p[1] > p[0]) - (p[1] < p[0]); }

int main() {
  int wrong = 0, uncertain = 0, wrong_tight = 0, wrong_staged = 0;
  for (int i = 0; i < 256; ++i) {
    for (int j = 0; j < 256; ++j) {
      const double p[] = {0.5 + i * 0x1p-53, 0.5 + j * 0x1p-53};
      const auto plain = orient2d<bound::none, double>::evaluate(p, q, r).area.value;
      wrong += (plain > 0) - (plain < 0) != truth(p);
      const Sign tight = sign(orient2d<bound::tight, double>::evaluate(p, q, r).area);
      uncertain += tight == Sign::uncertain;
      wrong_tight += tight != Sign::uncertain && static_cast<int>(tight) != truth(p);
      wrong_staged += static_cast<int>(orient2d<bound::staged, double>::evaluate(p, q, r).area) != truth(p);
    }
  }
  std::printf("double: %6d of 65536 signs wrong\n", wrong);
  std::printf("tight:  %6d wrong, %d uncertain\n", wrong_tight, uncertain);
  std::printf("staged: %6d wrong\n", wrong_staged);
}
