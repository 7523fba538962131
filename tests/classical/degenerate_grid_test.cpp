/// The test that floating-point predicates are known to fail: one point steps through a 256 x 256 grid of neighbouring
/// doubles around a degenerate position [Kettner, Mehlhorn, Pion, Schirra, Yap 2008]. The staged predicate must give
/// the exact sign everywhere; bounds must never give a wrong one; plain floating point must be wrong somewhere, or the
/// grid tests nothing.

#include <gtest/gtest.h>

#include <functional>

#include "circles.float.double.h"
#include "circles.interval.double.h"
#include "circles.safe.double.h"
#include "circles.staged.double.h"
#include "circles.tight.double.h"
#include "exact_determinant.h"
#include "orientation.float.double.h"
#include "orientation.interval.double.h"
#include "orientation.safe.double.h"
#include "orientation.staged.double.h"
#include "orientation.tight.double.h"

namespace tightrope::testing {
namespace {

constexpr int grid = 256;
constexpr int scale = 53;  // every coordinate below is a multiple of 2^-53
constexpr double origin = 0.5;

int number(Sign s) { return static_cast<int>(s); }
int number(ExactSign s) { return static_cast<int>(s); }
template <class Real>
int number(const Bounded<Real>& x) {
  return number(sign(x));
}

/// What one predicate answers with the moving point's first two coordinates x and y.
using Answer = std::function<int(double x, double y)>;

struct Modes {
  Answer plain, safe, tight, interval, staged;
};

template <class F>
Modes modes_of(F evaluate) {
  const auto with = [evaluate](auto bound) -> Answer {
    return [evaluate, bound](double x, double y) { return number(evaluate(bound, x, y)); };
  };
  return {with(bound::none{}), with(bound::safe{}), with(bound::tight{}), with(bound::interval{}),
          with(bound::staged{})};
}

void expect_exact_signs(const Modes& modes, const Answer& exact) {
  int wrong_in_plain_arithmetic = 0, uncertain = 0, zeros = 0;
  for (int i = 0; i < grid; ++i) {
    for (int j = 0; j < grid; ++j) {
      const double x = origin + i * 0x1p-53, y = origin + j * 0x1p-53;  // the spacing of doubles in [0.5, 1)
      const int truth = exact(x, y);
      ASSERT_EQ(modes.staged(x, y), truth) << i << ", " << j;
      for (const Answer* bounded : {&modes.safe, &modes.tight, &modes.interval}) {
        const int answer = (*bounded)(x, y);
        ASSERT_TRUE(answer == 0 || answer == truth) << i << ", " << j;
        uncertain += answer == 0;
      }
      wrong_in_plain_arithmetic += modes.plain(x, y) != truth;
      zeros += truth == 0;
    }
  }
  EXPECT_GT(wrong_in_plain_arithmetic, 0);
  EXPECT_GT(uncertain, 0);
  EXPECT_GT(zeros, 0);
  EXPECT_LT(zeros, grid * grid);
}

using generated::compare_circumcentres;
using generated::in_diametral_sphere;
using generated::incircle;
using generated::insphere;
using generated::orient2d;
using generated::orient3d;

TEST(DegenerateGrid, Orient2d) {
  const Point<2> b = {12, 12}, c = {24, 24};
  expect_exact_signs(modes_of([=]<class B>(B, double x, double y) {
                       const Point<2> a = {x, y};
                       return orient2d<B, double>::evaluate(a.data(), b.data(), c.data()).area;
                     }),
                     [=](double x, double y) {
                       const Point<2> points[] = {{x, y}, b, c};
                       return sign_of_determinant<2>(points, false, scale);
                     });
}

TEST(DegenerateGrid, Orient3d) {
  const Point<3> b = {12, 12, 12}, c = {24, 24, 24}, d = {48, 30, 17};
  expect_exact_signs(modes_of([=]<class B>(B, double x, double y) {
                       const Point<3> a = {x, y, origin};
                       return orient3d<B, double>::evaluate(a.data(), b.data(), c.data(), d.data()).volume;
                     }),
                     [=](double x, double y) {
                       const Point<3> points[] = {{x, y, origin}, b, c, d};
                       return sign_of_determinant<3>(points, false, scale);
                     });
}

TEST(DegenerateGrid, Incircle) {  // the corners of a square
  const Point<2> b = {24, origin}, c = {24, 24}, d = {origin, 24};
  expect_exact_signs(modes_of([=]<class B>(B, double x, double y) {
                       const Point<2> a = {x, y};
                       return incircle<B, double>::evaluate(a.data(), b.data(), c.data(), d.data()).inside;
                     }),
                     [=](double x, double y) {
                       const Point<2> points[] = {{x, y}, b, c, d};
                       return sign_of_determinant<2>(points, true, scale);
                     });
}

TEST(DegenerateGrid, Insphere) {  // corners of a box
  const Point<3> b = {24, origin, origin}, c = {origin, 24, origin}, d = {origin, origin, 24}, e = {24, 24, 24};
  expect_exact_signs(modes_of([=]<class B>(B, double x, double y) {
                       const Point<3> a = {x, y, origin};
                       return insphere<B, double>::evaluate(a.data(), b.data(), c.data(), d.data(), e.data()).inside;
                     }),
                     [=](double x, double y) {
                       const Point<3> points[] = {{x, y, origin}, b, c, d, e};
                       return sign_of_determinant<3>(points, true, scale);
                     });
}

// The point sees the segment under a right angle, at t = 0, at t = 1, and in the mixed coefficient between.
TEST(DegenerateGrid, InDiametralSphereOfTwoMovingPoints) {
  const Point<3> a0 = {origin, -4095.5, origin}, a1 = {origin, -4095.5, 24}, b0 = {4096.5, origin, origin},
                 b1 = {2048.5, origin, origin};
  const auto dot = [](const Point<3>& p, const Point<3>& a, const Point<3>& b) {
    mpz_class sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      sum += (whole(a[k], scale) - whole(p[k], scale)) * (whole(b[k], scale) - whole(p[k], scale));
    }
    return sum;
  };
  for (std::size_t coefficient = 0; coefficient < 3; ++coefficient) {
    expect_exact_signs(modes_of([=]<class B>(B, double x, double y) {
                         const Point<3> p = {x, y, origin};
                         return in_diametral_sphere<B, double>::evaluate(p.data(), a0.data(), a1.data(), b0.data(),
                                                                         b1.data())
                             .power[coefficient];
                       }),
                       [=](double x, double y) {
                         const Point<3> p = {x, y, origin};
                         const mpz_class exact[] = {dot(p, a0, b0), dot(p, a0, b1) + dot(p, a1, b0), dot(p, a1, b1)};
                         return sgn(exact[coefficient]);
                       });
  }
}

// Three corners of a square, and another three: one centre.
TEST(DegenerateGrid, CircumcentresCompared) {
  const Point<2> b = {24, origin}, c = {origin, 24}, d = {24, 24};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    expect_exact_signs(modes_of([=]<class B>(B, double x, double y) {
                         const Point<2> a = {x, y};
                         const double *q = b.data(), *r = c.data();
                         return compare_circumcentres<B, double>::evaluate(a.data(), q, r, d.data(), q, r).order[axis];
                       }),
                       [=](double x, double y) {
                         return sgn(mpq_class(circumcentre({x, y}, b, c)[axis] - circumcentre(d, b, c)[axis]));
                       });
  }
}

TEST(DegenerateGrid, NoCircleHasNoCentre) {
  const Point<2> a = {1, 1}, b = {2, 2}, c = {5, 5}, d = {0, 1}, e = {3, 1}, f = {2, 2};
  const auto order = [&]<class B>(B) {
    return compare_circumcentres<B, double>::evaluate(a.data(), b.data(), c.data(), d.data(), e.data(), f.data());
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    EXPECT_EQ(order(bound::staged{}).order[axis], ExactSign::invalid);
    EXPECT_EQ(sign(order(bound::tight{}).order[axis]), Sign::uncertain);
    EXPECT_EQ(sign(order(bound::safe{}).order[axis]), Sign::uncertain);
    EXPECT_EQ(sign(order(bound::interval{}).order[axis]), Sign::uncertain);
  }
}

}  // namespace
}  // namespace tightrope::testing
