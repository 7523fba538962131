/// `tightrope import` and `tightrope compile` against the compiler that the functions were written for: the same bits.

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>

#include "functions.cpp"
#include "mixture.float.double.h"
#include "orient2d.float.double.h"
#include "orient3d.float.double.h"
#include "quintic.float.float.h"
#include "smooth.float.double.h"
#include "sum_of_squares.float.double.h"

namespace {

using tightrope::bound::none;
namespace generated = tightrope::generated;

class Imported : public ::testing::Test {
 protected:
  /// Of any magnitude for which nothing overflows; often close to another.
  template <class Real = double>
  Real number() {
    const std::uint64_t bits = random_();
    const auto fraction = static_cast<Real>(static_cast<double>(bits >> 11) * 0x1p-53 + 1);
    const int exponent = bits % 4 == 0 ? static_cast<int>(bits >> 3 & 31) - 16 : 0;
    return std::ldexp((bits & 4) != 0 ? fraction : -fraction, exponent);
  }
  template <class Real>
  void fill(Real* numbers, int count) {
    for (int i = 0; i < count; ++i) numbers[i] = number<Real>();
  }

  /// The same number: bit for bit, but for the sign of a zero.
  template <class Real>
  void expect_same(Real imported, Real written) {
    if (imported == 0 && written == 0) return;
    using Bits = std::conditional_t<sizeof(Real) == 8, std::uint64_t, std::uint32_t>;
    EXPECT_EQ(std::bit_cast<Bits>(imported), std::bit_cast<Bits>(written)) << imported << " against " << written;
  }

  static constexpr int cases = 10'000;

 private:
  std::mt19937_64 random_{7};
};

TEST_F(Imported, Orient2d) {
  for (int i = 0; i < cases; ++i) {
    double p[6];
    fill(p, 6);
    expect_same(generated::orient2d<none, double>::evaluate(p, p + 2, p + 4).returned.value,
                imported::orient2d(p, p + 2, p + 4));
  }
}

TEST_F(Imported, Orient3dOfStructs) {
  for (int i = 0; i < cases; ++i) {
    imported::Vector p[4];
    fill(&p[0].x, 12);
    expect_same(generated::orient3d<none, double>::evaluate(&p[0].x, &p[1].x, &p[2].x, &p[3].x).returned.value,
                imported::orient3d(p[0], p[1], p[2], p[3]));
  }
}

TEST_F(Imported, ConstantsAndFunctions) {
  for (int i = 0; i < cases; ++i) {
    const double x = number();
    const double y = number();
    std::array<double, 4> z;
    fill(z.data(), 4);
    expect_same(generated::mixture<none, double>::evaluate(x, y, z.data()).returned.value, imported::mixture(x, y, z));
  }
}

TEST_F(Imported, LoopsAndOutputArrays) {
  for (int i = 0; i < cases; ++i) {
    double m[3][3], v[3], out[3];
    fill(m[0], 9), fill(v, 3);
    imported::smooth(m, v, out);
    const auto result = generated::smooth<none, double>::evaluate(m[0], v);
    for (int k = 0; k < 3; ++k) expect_same(result.out[k].value, out[k]);
  }
}

TEST_F(Imported, SinglePrecisionThroughATemplate) {
  for (int i = 0; i < cases; ++i) {
    float c[6];
    fill(c, 6);
    const auto x = number<float>();
    expect_same(generated::quintic<none, float>::evaluate(c, x).returned.value, imported::quintic(c, x));
  }
}

TEST_F(Imported, RangeLoops) {
  for (int i = 0; i < cases; ++i) {
    std::array<double, 5> v;
    fill(v.data(), 5);
    expect_same(generated::sum_of_squares<none, double>::evaluate(v.data()).returned.value,
                imported::sum_of_squares(v));
  }
}

}  // namespace
