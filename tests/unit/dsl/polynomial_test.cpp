#include "dsl/polynomial.h"

#include <algorithm>

#include "tests/unit/dsl/compile.h"

namespace tightrope::dsl::testing {
namespace {

// -- The very operations that an expression becomes, for the shapes that bounds and speed rest on.
// ----------------------

/// The graph of `sign expression` but for its inputs, then the output's nodes: "%9 = sub %4 %5; %10 = neg %9 -> %10".
std::string lowered(const std::string& expression, ProductScheme scheme) {
  const Compiled c = compile("predicate f(moving scalar m, n, scalar s, r, k[3]) { sign " + expression + " as o }",
                             {.products = scheme});
  if (!c.errors().empty()) return c.errors();
  const Predicate& predicate = c.program.predicates.front();
  std::string text = print(predicate.graph);
  text.erase(0, text.find("%8 = input 8\n") + 13);
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    result += (result.empty() ? "" : "; ") + text.substr(begin, end - begin);
    begin = end + 1;
  }
  result += result.empty() ? "->" : " ->";
  for (const NodeId node : predicate.stages.front().outputs.front().nodes) result += " %" + std::to_string(node);
  return result;
}

struct Golden {
  const char* expression;
  const char* graph;  // inputs: m %0 %1, n %2 %3, s %4, r %5, k %6 %7 %8
};

const Golden direct_table[] = {
    // Numbers fold, inputs never vanish.
    {"0 + s", "-> %4"},
    {"s * 1", "-> %4"},
    {"s * 0", "%9 = constant 0; %10 = mul %4 %9 -> %10"},
    {"s - s", "%9 = sub %4 %4 -> %9"},
    {"s + s", "%9 = mul_pow2 %4 1 -> %9"},
    {"-(s - r)", "%9 = sub %4 %5; %10 = neg %9 -> %10"},
    {"s - -r", "%9 = add %4 %5 -> %9"},
    {"-s + r", "%9 = sub %5 %4 -> %9"},
    {"1 / 10 + s", "%9 = constant 1; %10 = constant 10; %11 = div %9 %10; %12 = add %4 %11 -> %12"},
    // Rational factors: one rounding, none for powers of two; they cancel.
    {"s / 7", "%9 = constant 7; %10 = div %4 %9 -> %10"},
    {"6 * s", "%9 = constant 6; %10 = mul %4 %9 -> %10"},
    {"2/3 * s", "%9 = constant 1.5; %10 = div %4 %9 -> %10"},
    {"s / 8 * 4", "%9 = mul_pow2 %4 -1 -> %9"},
    {"3 * (s / 3)", "-> %4"},
    {"5/7 * s", "%9 = constant 5; %10 = mul %4 %9; %11 = constant 7; %12 = div %10 %11 -> %12"},
    {"s / 3 + r", "%9 = constant 3; %10 = div %4 %9; %11 = add %5 %10 -> %11"},
    {"s / 3 + r / 3", "%9 = add %4 %5; %10 = constant 3; %11 = div %9 %10 -> %11"},
    // Bernstein products, MATH 1.1 and 1.2.
    {"m * n",
     "%9 = mul %0 %2; %10 = mul %0 %3; %11 = mul %1 %2; %12 = mul %1 %3; %13 = add %10 %11; %14 = mul_pow2 %13 -1 "
     "-> %9 %14 %12"},
    {"m * m", "%9 = mul %0 %0; %10 = mul %0 %1; %11 = mul %1 %1 -> %9 %10 %11"},
    {"3 * (m * (m * n))",
     "%9 = mul %0 %2; %10 = mul %0 %3; %11 = mul %1 %2; %12 = mul %1 %3; %13 = add %10 %11; %14 = mul %0 %9; "
     "%15 = mul %0 %13; %16 = mul %1 %9; %17 = mul %0 %12; %18 = mul %1 %13; %19 = mul %1 %12; %20 = add %15 %16; "
     "%21 = add %17 %18; %22 = constant 3; %23 = mul %14 %22; %24 = mul %19 %22 -> %23 %20 %21 %24"},
    {"m + s", "%9 = add %0 %4; %10 = add %1 %4 -> %9 %10"},
    {"m * n + m",
     "%9 = mul %0 %2; %10 = mul %0 %3; %11 = mul %1 %2; %12 = mul %1 %3; %13 = add %10 %11; %14 = add %0 %1; "
     "%15 = add %0 %9; %16 = add %13 %14; %17 = add %1 %12; %18 = mul_pow2 %16 -1 -> %15 %18 %17"},
    {"diff(m * n)",
     "%9 = mul %0 %2; %10 = mul %0 %3; %11 = mul %1 %2; %12 = mul %1 %3; %13 = add %10 %11; %14 = mul_pow2 %9 1; "
     "%15 = sub %13 %14; %16 = mul_pow2 %12 1; %17 = sub %16 %13 -> %15 %17"},
    {"elevate(m, 3)",
     "%9 = mul_pow2 %0 1; %10 = add %1 %9; %11 = mul_pow2 %1 1; %12 = add %0 %11; %13 = constant 3; "
     "%14 = div %10 %13; %15 = div %12 %13 -> %0 %14 %15 %1"},
    // Coefficients come back as they went in.
    {"bernstein(k)", "-> %6 %7 %8"},
    {"coefficients(bernstein(k))", "-> %6 %7 %8"},
    {"bernstein(k) at 0", "-> %6"},
    {"bernstein(k) at 1", "-> %8"},
    // Evaluation and splitting.
    {"m at s", "%9 = constant 1; %10 = sub %9 %4; %11 = mul %1 %4; %12 = mul %0 %10; %13 = add %11 %12 -> %13"},
    {"m at r/s", "%9 = sub %4 %5; %10 = mul %1 %5; %11 = mul %0 %9; %12 = add %10 %11 -> %12"},
    // s - (s - r) is r, r + s - s is r: exactly, without an operation
    {"m at s/(s - r)", "%9 = sub %4 %5; %10 = mul %1 %4; %11 = mul %0 %5; %12 = sub %10 %11 -> %12"},
    {"m at s/(r + s)", "%9 = add %4 %5; %10 = mul %1 %4; %11 = mul %0 %5; %12 = add %10 %11 -> %12"},
    {"m at 3 * s/(3 * s - r)",
     "%9 = constant 3; %10 = mul %4 %9; %11 = sub %10 %5; %12 = mul %1 %10; %13 = mul %0 %5; %14 = sub %12 %13 -> %14"},
    {"(m * n) at (1/2)",
     "%9 = mul %0 %2; %10 = mul %0 %3; %11 = mul %1 %2; %12 = mul %1 %3; %13 = add %10 %11; %14 = add %12 %13; "
     "%15 = add %9 %14; %16 = mul_pow2 %15 -2 -> %16"},
    {"split(bernstein(k), (1/2))",
     "%9 = add %6 %7; %10 = add %7 %8; %11 = add %9 %10; %12 = mul_pow2 %9 -1; %13 = mul_pow2 %11 -2; "
     "%14 = mul_pow2 %10 -1 -> %6 %12 %13 %13 %14 %8"},
    {"sqrt(4 * s)", "%9 = sqrt %4; %10 = mul_pow2 %9 1 -> %10"},
    {"max(s, r, 1)", "%9 = max %4 %5; %10 = constant 1; %11 = max %9 %10 -> %11"},
};

const Golden karatsuba_table[] = {
    {"m * n",
     "%9 = mul %0 %2; %10 = mul %1 %3; %11 = sub %3 %2; %12 = sub %1 %0; %13 = mul %11 %12; %14 = add %9 %10; "
     "%15 = sub %14 %13; %16 = mul_pow2 %15 -1 -> %9 %16 %10"},
    {"m * m", "%9 = mul %0 %0; %10 = mul %0 %1; %11 = mul %1 %1 -> %9 %10 %11"},
    {"m * (s + r)", "%9 = add %4 %5; %10 = mul %0 %9; %11 = mul %1 %9 -> %10 %11"},
};

TEST(Lowering, MakesExactlyTheseOperations) {
  for (const Golden& g : direct_table) {
    EXPECT_EQ(lowered(g.expression, ProductScheme::direct), g.graph) << g.expression;
  }
}

TEST(Lowering, MakesExactlyTheseOperationsByKaratsuba) {
  for (const Golden& g : karatsuba_table) {
    EXPECT_EQ(lowered(g.expression, ProductScheme::karatsuba), g.graph) << g.expression;
  }
}

int count(const Graph& graph, Op op) {
  int n = 0;
  for (NodeId id = 0; id < graph.size(); ++id) n += graph[id].op == op ? 1 : 0;
  return n;
}

TEST(Lowering, CountsOfTheCoplanarityCubicAreThoseOfTheMathematics) {
  const std::string text =
      "predicate f(point a0, a1, b0, b1, c0, c1) { let u = bernstein([a0, a1]) let v = bernstein([b0, b1]) "
      "let n = cross(u, v) sign 3 * dot(n, bernstein([c0, c1])) as y, coefficients(n)[1] as middle }";
  const Compiled direct = compile(text);
  ASSERT_EQ(direct.errors(), "");
  const Graph& d = direct.program.predicates.front().graph;
  EXPECT_EQ(count(d, Op::mul), 24 + 18 + 2);                      // MATH 1.1 and 1.2, and the two factors 3
  EXPECT_EQ(count(d, Op::add) + count(d, Op::sub), 15 + 12 + 2);  // six dot products, two sums of them
  const Compiled karatsuba = compile(text, {.products = ProductScheme::karatsuba});
  const Graph& k = karatsuba.program.predicates.front().graph;
  EXPECT_EQ(count(k, Op::mul), 18 + 18 + 2);
  EXPECT_EQ(count(k, Op::add) + count(k, Op::sub), 21 + 12 + 2);
  EXPECT_EQ(count(k, Op::div) + count(d, Op::div), 0);
}

TEST(Lowering, SharesDifferencesOfInputs) {
  const Compiled c = compile("predicate f(point a, b, p) { sign cross(b - a, p - a), dot(b - a, b - a), (b - a).x }");
  ASSERT_EQ(c.errors(), "");
  const Graph& g = c.program.predicates.front().graph;
  int differences = 0;
  for (NodeId id = 0; id < g.size(); ++id) {
    differences += g[id].op == Op::sub && g[g[id].a].op == Op::input ? 1 : 0;
  }
  EXPECT_EQ(differences, 6);
}

TEST(Lowering, ReachesHighDegrees) {
  const Compiled c = compile("predicate f(moving scalar m, n) { sign m ^ 32 * n ^ 32 as high }");
  ASSERT_EQ(c.errors(), "");
  const Predicate& p = c.program.predicates.front();
  const std::vector<double> values = evaluate<double>(p.graph, std::vector<double>{1, 1, 1, 1});
  for (const NodeId node : p.stages.front().outputs.front().nodes) {
    EXPECT_NEAR(values[static_cast<std::size_t>(node)], 1, 1e-13);  // 1 = sum of the Bernstein basis
  }
}

// -- Coefficients ----------------------------------------------------------------------------------------------------

class CoefficientTest : public ::testing::Test {
 protected:
  Lowering low;
  Coefficient x = run_time(low.graph.input(0));
  Coefficient y = run_time(low.graph.input(1));
  Coefficient times(const Rational& factor, const Coefficient& c) { return scale(low, c, factor); }
};

TEST_F(CoefficientTest, CommonFactorSavesRoundings) {
  const auto q = [](std::int64_t n, std::int64_t d) { return Rational::quotient(n, d); };
  EXPECT_EQ(common_factor(std::vector<Rational>{1, 1}), Rational(1));
  EXPECT_EQ(common_factor(std::vector<Rational>{q(1, 3), q(1, 3)}), q(1, 3));
  EXPECT_EQ(common_factor(std::vector<Rational>{q(2, 3), q(1, 3)}), q(1, 3));
  EXPECT_EQ(common_factor(std::vector<Rational>{q(1, 3), 1}), Rational(1));
  EXPECT_EQ(common_factor(std::vector<Rational>{1, 3, 3, 1}), Rational(1));
  EXPECT_EQ(common_factor(std::vector<Rational>{q(1, 2), q(1, 4)}), q(1, 4));
  EXPECT_EQ(common_factor(std::vector<Rational>{}), Rational(1));
}

TEST_F(CoefficientTest, ComplementFindsTheOtherSummand) {
  const Coefficient sum = add(low, x, y);
  const Coefficient difference = subtract(low, x, y);
  EXPECT_EQ(complement(low, x, sum), y);
  EXPECT_EQ(complement(low, y, sum), x);
  EXPECT_EQ(complement(low, x, difference), negate(y));
  EXPECT_EQ(complement(low, negate(y), difference), x);
  EXPECT_EQ(complement(low, times(3, x), times(3, sum)), times(3, y));
  const Coefficient mixed = add(low, times(3, x), y);
  EXPECT_EQ(complement(low, times(3, x), mixed), y);
  const NodeId before = low.graph.size();
  EXPECT_GE(complement(low, x, times(2, sum)).node, before);  // 2 (x + y) - x is no part: a new node
}

TEST_F(CoefficientTest, MaterialisesWithFewestRoundings) {
  const auto op = [&](const Rational& factor) { return low.graph[materialise(low, times(factor, x))]; };
  EXPECT_EQ(materialise(low, x), x.node);
  EXPECT_EQ(op(Rational::power_of_two(-5)), (Node{.op = Op::mul_pow2, .a = x.node, .index = -5}));
  EXPECT_EQ(op(-1), (Node{.op = Op::neg, .a = x.node}));
  EXPECT_EQ(op(-6).op, Op::mul);
  EXPECT_EQ(low.graph[op(-6).b].value, -6);
  EXPECT_EQ(op(Rational::quotient(1, 12)).op, Op::div);
  EXPECT_EQ(low.graph[op(Rational::quotient(1, 12)).b].value, 12);
  EXPECT_FALSE(low.unrepresentable);
  op(Rational((std::int64_t{1} << 61) - 1));  // a prime of 61 bits
  EXPECT_TRUE(low.unrepresentable);
}

TEST_F(CoefficientTest, ReportsOverflowOnce) {
  Coefficient c = x;
  for (int i = 0; i < 5; ++i) c = times(Rational(3).power(40), c);
  EXPECT_TRUE(low.overflow);
  EXPECT_TRUE(c.factor.valid());
}

TEST_F(CoefficientTest, SumKeepsTheOrderOfItsTerms) {
  const Coefficient z = run_time(low.graph.input(2));
  const std::vector<Coefficient> terms = {negate(x), y, negate(z)};
  const Coefficient total = sum(low, terms);
  EXPECT_TRUE(total.factor.is_one());
  const Node& outer = low.graph[total.node];  // (y - x) - z
  EXPECT_EQ(outer, (Node{.op = Op::sub, .a = outer.a, .b = z.node}));
  EXPECT_EQ(low.graph[outer.a], (Node{.op = Op::sub, .a = y.node, .b = x.node}));
  const std::vector<Coefficient> negatives = {negate(x), negate(y)};
  EXPECT_EQ(sum(low, negatives).factor, Rational(-1));
}

}  // namespace
}  // namespace tightrope::dsl::testing
