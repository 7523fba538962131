#include <gtest/gtest.h>
#include <tightrope/testing.h>

// The checks of generated tests against code that is wrong in one way each: every check must notice.

namespace tightrope::testing {
namespace {

// a * b + c, and the product as a second output.
constexpr Operation operations[] = {input(0), input(1), mul(0, 1), input(2), add(2, 3)};
constexpr int results[] = {4, 2};
const std::vector<Parameter> parameters = {{"a", 1, 1, 1, false, false, HUGE_VAL},
                                           {"b", 1, 1, 1, false, false, HUGE_VAL},
                                           {"c", 1, 1, 1, false, false, HUGE_VAL}};
const std::vector<Parameter> limited = {
    {"a", 1, 1, 1, false, false, 4}, {"b", 1, 1, 1, false, false, 4}, {"c", 1, 1, 1, false, false, 4}};
const std::vector<Output> outputs = {{"sum", {}, true}, {"product", {1}, true}};
const std::vector<Property> properties = {
    {"symmetric(a, b)", Property::Kind::permutation, 1, 0, {1, 0, 2}, {0, 1}},
    {"scale(2)", Property::Kind::scale, 1, 2, {}, {1}},
    {"antisymmetric(a, b)", Property::Kind::permutation, -1, 0, {1, 0, 2}, {0}},
    {"scale(2) of sum", Property::Kind::scale, 1, 2, {}, {0}},
};
const Reference reference = {"f", operations, parameters, outputs, results, properties, true, 500};
const Reference limited_reference = {"f", operations, limited, outputs, results, {}, true, 500};

/// Sound bounds: u |a b| + u |a b + c|, generously.
template <class Real>
void sound(const Bounded<Real>* x, Bounded<Real>* y) {
  const Real u = std::numeric_limits<Real>::epsilon();
  const Real p = product(x[0].value, x[1].value);
  const Real s = p + x[2].value;
  const Real tiny = std::numeric_limits<Real>::min();
  y[1] = {p, product(u, magnitude(p)) + tiny};
  y[0] = {s, y[1].bound + product(u, magnitude(s))};
}

enum class Fault {
  none,
  no_underflow_term,
  half_bound,
  other_value,
  flipped_sign,
  infinite_bound,
  negative_bound,
  sign_of_infinity,
  no_range_check,
  range_too_small,
  other_function_differs,
};

template <class Real, Fault fault>
void faulty(const Bounded<Real>* x, Bounded<Real>* y) {
  sound(x, y);
  switch (fault) {
    case Fault::no_underflow_term:
      y[1].bound = product(std::numeric_limits<Real>::epsilon(), magnitude(y[1].value));
      break;
    case Fault::half_bound:
      y[0].bound /= 8;
      break;
    case Fault::other_value:
      y[0].value += y[0].bound / 2;
      break;
    case Fault::flipped_sign:
      y[0].value = -y[0].value;
      break;
    case Fault::infinite_bound:
      y[0].bound = y[1].bound = std::numeric_limits<Real>::infinity();
      break;
    case Fault::negative_bound:
      y[1].bound = -std::numeric_limits<Real>::denorm_min();
      break;
    case Fault::sign_of_infinity:
      if (!std::isfinite(y[1].value)) y[1] = {Real(1), Real(0)};
      break;
    case Fault::none:
    case Fault::no_range_check:
    case Fault::range_too_small:
    case Fault::other_function_differs:
      break;
  }
}

template <class Real>
bool in_range(const Bounded<Real>* x, Real limit) {
  return magnitude(x[0].value) <= limit && magnitude(x[1].value) <= limit && magnitude(x[2].value) <= limit;
}

template <class Real, Fault fault>
bool range_test(const Bounded<Real>* x) {
  return in_range(x, fault == Fault::range_too_small ? Real(0.5) : Real(4));
}

template <class Real, Fault fault>
void checked(const Bounded<Real>* x, Bounded<Real>* y) {
  sound(x, y);
  if (fault != Fault::no_range_check && !in_range(x, Real(4))) make_uncertain(y[0]), make_uncertain(y[1]);
}

template <class Real, Fault fault>
void unchecked(const Bounded<Real>* x, Bounded<Real>* y) {
  sound(x, y);
  if (fault == Fault::other_function_differs) y[0].bound *= 2;
}

template <class Real, Fault fault>
Code<Real> code() {
  return {"test", true, 0.5, faulty<Real, fault>, nullptr, nullptr};
}

/// What all checks of a predicate without ranges say about code with this fault.
template <class Real, Fault fault>
std::string all_checks() {
  const Code<Real> codes[] = {code<Real, fault>()};
  std::string text;
  for (const Family family :
       {Family::uniform, Family::lattice, Family::zero_set, Family::dependent, Family::scales, Family::far_away,
        Family::mixed, Family::underflow, Family::extreme, Family::not_finite}) {
    text += check_family<Real>(reference, codes, family);
  }
  text += check_worst_errors<Real>(reference, codes);
  text += check_usefulness<Real>(reference, codes);
  return text + check_property<Real>(reference, codes, 0) + check_property<Real>(reference, codes, 1);
}

template <class Real, Fault fault>
std::string range_checks() {
  const Code<Real> codes[] = {
      {"test", true, 0.5, checked<Real, fault>, unchecked<Real, fault>, range_test<Real, fault>}};
  return check_ranges<Real>(limited_reference, codes);
}

::testing::AssertionResult mentions(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "no \"" << part << "\" in \"" << text.substr(0, 1000) << "\"";
}

template <class Real>
class Checks : public ::testing::Test {};
using Reals = ::testing::Types<double, float>;
TYPED_TEST_SUITE(Checks, Reals, );

TYPED_TEST(Checks, AcceptSoundCode) {
  EXPECT_EQ((all_checks<TypeParam, Fault::none>()), "");
  EXPECT_EQ((range_checks<TypeParam, Fault::none>()), "");
}

TYPED_TEST(Checks, NoticeBoundsThatAreTooSmall) {
  EXPECT_TRUE(mentions(all_checks<TypeParam, Fault::half_bound>(), "f, test, sum: the bound does not cover the error"));
  const std::string text = all_checks<TypeParam, Fault::no_underflow_term>();
  EXPECT_TRUE(mentions(text, "f, test, product[0]: the bound does not cover the error"));
}

TYPED_TEST(Checks, NoticeValuesThatAreNotThoseOfPlainEvaluation) {
  EXPECT_TRUE(mentions(all_checks<TypeParam, Fault::other_value>(), "the value is not that of plain evaluation"));
}

TYPED_TEST(Checks, NoticeWrongSigns) {
  EXPECT_TRUE(mentions(all_checks<TypeParam, Fault::flipped_sign>(), "the bound does not cover the error"));
  EXPECT_EQ(detail::judge(Bounded<TypeParam>{1, 2}, Exact::of(-1)), "");
  EXPECT_EQ(detail::judge(Bounded<TypeParam>{1, 0.5}, Exact::undefined()),
            "a definite sign of an exact value that is not finite");
}

TYPED_TEST(Checks, NoticeUselessBounds) {
  EXPECT_TRUE(mentions(all_checks<TypeParam, Fault::infinite_bound>(), "only 0 of 1000 signs are definite"));
}

TYPED_TEST(Checks, NoticeNegativeBounds) {
  EXPECT_TRUE(mentions(all_checks<TypeParam, Fault::negative_bound>(), "a negative bound"));
}

TYPED_TEST(Checks, NoticeSignsOfInfinitiesAndNaN) {
  EXPECT_TRUE(mentions(all_checks<TypeParam, Fault::sign_of_infinity>(), "definite sign"));
}

TYPED_TEST(Checks, NoticePropertiesThatDoNotHold) {
  const Code<TypeParam> codes[] = {code<TypeParam, Fault::none>()};
  EXPECT_TRUE(mentions(check_property<TypeParam>(reference, codes, 2), "property antisymmetric(a, b) does not hold"));
  EXPECT_TRUE(mentions(check_property<TypeParam>(reference, codes, 3), "property scale(2) of sum does not hold"));
}

template <class Real>
void contradicting(const Bounded<Real>* x, Bounded<Real>* y) {
  y[0] = y[1] = {x[0].value < x[1].value ? Real(1) : Real(-1), Real(0)};
}

TYPED_TEST(Checks, NoticeSignsThatContradictAProperty) {
  const Code<TypeParam> codes[] = {{"test", true, 0.5, contradicting<TypeParam>, nullptr, nullptr}};
  EXPECT_TRUE(mentions(check_property<TypeParam>(reference, codes, 0), "contradicts property symmetric(a, b)"));
}

TYPED_TEST(Checks, NoticeRangesThatAreNotKept) {
  EXPECT_TRUE(mentions(range_checks<TypeParam, Fault::no_range_check>(), "a sign beyond the declared range"));
  EXPECT_TRUE(mentions(range_checks<TypeParam, Fault::range_too_small>(), "refused although in range"));
  EXPECT_TRUE(mentions(range_checks<TypeParam, Fault::other_function_differs>(), "the function without check differs"));
}

TYPED_TEST(Checks, FailuresNameTheInputsInHexadecimal) {
  const std::string text = all_checks<TypeParam, Fault::half_bound>();
  EXPECT_TRUE(mentions(text, "\n  a = "));
  EXPECT_TRUE(mentions(text, "0x1."));
}

TEST(Random, UniformNumbersHaveFullMantissasAndBothSigns) {
  Random random(1);
  int odd = 0;
  int negative = 0;
  double sum = 0;
  for (int n = 0; n < 4000; ++n) {
    const double x = random.uniform<double>();
    EXPECT_LE(std::abs(x), 1);
    int exponent = 0;
    const double mantissa = std::ldexp(std::frexp(std::abs(x), &exponent), 53);
    odd += static_cast<std::uint64_t>(mantissa) % 2 == 1 ? 1 : 0;
    negative += x < 0 ? 1 : 0;
    sum += std::abs(x);
  }
  EXPECT_NEAR(odd, 2000, 200);
  EXPECT_NEAR(negative, 2000, 200);
  EXPECT_NEAR(sum / 4000, 0.5, 0.03);
}

TEST(Inputs, DrivenToZerosAreOftenTooCloseToDecide) {
  Random random(2);
  Inputs<double> inputs(reference, random);
  int uncertain = 0;
  for (int n = 0; n < 400; ++n) {
    const Case<double> c = inputs.make(Family::zero_set);
    Bounded<double> y[2];
    sound(c.x.data(), y);
    uncertain += sign(y[0]) == Sign::uncertain || sign(y[1]) == Sign::uncertain ? 1 : 0;
  }
  EXPECT_GT(uncertain, 100);
}

TEST(Inputs, ExactNumbersLieWithinTheBoundsOfBoundedInputs) {
  const std::vector<Parameter> bounded = {{"a", 2, 1, 3, true, true, 8}};
  const Reference r = {"g", operations, bounded, outputs, results, {}, true, 1};
  Random random(3);
  Inputs<float> inputs(r, random);
  int at_the_end = 0;
  for (const Family family : {Family::uniform, Family::lattice, Family::extreme, Family::far_away}) {
    for (int n = 0; n < 200; ++n) {
      Case<float> c = inputs.make(family);
      if (n % 2 == 1) c = inputs.mutate(c);
      for (std::size_t i = 0; i < c.x.size(); ++i) {
        EXPECT_LE(std::abs(c.x[i].value), 8);
        EXPECT_LE(c.x[i].bound, 8);
        ASSERT_TRUE(c.exact[i].finite());
        const DyadicRatio distance = abs(c.exact[i].value.lower() - DyadicRatio(static_cast<double>(c.x[i].value)));
        EXPECT_LE(distance, DyadicRatio(static_cast<double>(c.x[i].bound)));
        if (c.x[i].bound > 0 && distance == DyadicRatio(static_cast<double>(c.x[i].bound))) ++at_the_end;
      }
    }
  }
  EXPECT_GT(at_the_end, 1000);
}

TEST(EvaluateExact, InfinitiesAndUndefinedValuesStayApart) {
  constexpr Operation table[] = {input(0), input(1), min(0, 1), max(0, 1), abs(0), add(0, 1), div(1, 0), neg(0)};
  constexpr int all[] = {2, 3, 4, 5, 6, 7};
  const Reference r = {"g", table, {}, {}, all, {}, true, 1};
  const auto kinds = [&](double a, double b) {
    const Exact slots[] = {Exact::of(a), Exact::of(b)};
    std::string text;
    for (const Exact& e : evaluate_exact(r, slots)) text += "fpnu"[static_cast<int>(e.kind)];
    return text;
  };
  EXPECT_EQ(kinds(1, 2), "ffffff");
  EXPECT_EQ(kinds(0, 2), "ffffuf");
  EXPECT_EQ(kinds(-HUGE_VAL, 2), "nfpuup");
  EXPECT_EQ(kinds(2, HUGE_VAL), "fpfuuf");
  EXPECT_EQ(kinds(NAN, 2), "uuuuuu");
}

}  // namespace
}  // namespace tightrope::testing
