/// What elaboration says about each mistake, and how often.

#include "tests/unit/dsl/compile.h"

namespace tightrope::dsl::testing {
namespace {

struct Mistake {
  const char* statements;  // of a predicate of (moving point p, a, point2 e, scalar s, moving scalar m, scalar k[4])
  const char* errors;      // columns count from the statements' first character
};

const Mistake mistakes[] = {
    {"sign dot(p, a) + p", "6: cannot add a scalar of degree 2 and a vector of degree 1"},
    {"sign m * m - p", "6: cannot subtract a vector of degree 1 from a scalar of degree 2"},
    {"sign k + s", "6: cannot add an array [4] of scalars of degree 0 and a scalar of degree 0"},
    {"sign p + e", "6: cannot add a vector of degree 1 and a 2D vector of degree 0"},
    {"sign p * a",
     "6: cannot multiply a vector of degree 1 and a vector of degree 1 (the products of vectors are `dot(u, v)` and "
     "`cross(u, v)`)"},
    {"sign s / m",
     "6: cannot divide a scalar of degree 0 by a scalar of degree 1 (a scalar or a vector is divided by a number or a "
     "scalar of degree 0)"},
    {"sign s / 0", "10: division by zero"},
    {"sign s / (2 - 4/2)", "11: division by zero"},
    {"sign crss(p, a)", "6: unknown function `crss` (did you mean `cross`?)"},
    {"sign s + ss", "10: unknown name `ss`"},
    {"sign cross", "6: unknown name `cross` (a function is called with its arguments, `cross(...)`)"},
    {"sign k(1)", "6: unknown function `k` (it is the name of a value; an element of an array is written `a[i]`)"},
    {"sign cross(p)", "6: `cross` takes 2 arguments, not 1"},
    {"sign det(p)", "6: `det` takes 2 or 3 arguments, not 1"},
    {"sign min()", "6: `min` takes at least 1 argument, not 0"},
    {"sign dot(p, e)",
     "6: `dot` cannot take a vector of degree 1 and a 2D vector of degree 0 (it takes two vectors of one dimension)"},
    {"sign sqrt(m)", "6: `sqrt` cannot take a scalar of degree 1 (it takes a scalar of degree 0)"},
    {"sign sqrt(3 - 4)", "6: square root of a negative number"},
    {"sign k[4]", "8: there is no element 4: an array [4] of scalars of degree 0 has elements 0 to 3"},
    {"sign k[-1]", "8: there is no element -1: an array [4] of scalars of degree 0 has elements 0 to 3"},
    {"sign k[s]", "8: an index must be a whole number known at compile time, not a scalar of degree 0"},
    {"sign k[1/2]", "8: an index must be a whole number known at compile time, not 1/2"},
    {"sign m[0]", "6: a scalar of degree 1 has no elements (a Bernstein coefficient is written `coefficients(P)[i]`)"},
    {"sign e.z", "6: a 2D vector of degree 0 has no component `z`"},
    {"sign m ^ 65", "6: a power 65 of a scalar of degree 1 has too high a degree"},
    {"sign (m * m) ^ 33", "6: this polynomial has degree 66; at most 64 is allowed"},
    {"sign s ^ -1", "10: the exponent -1 is not between 0 and 1000000 (a reciprocal is written `1 / x`)"},
    {"sign elevate(m, 0)", "6: cannot elevate a scalar of degree 1 to degree 0 (a degree can only be raised)"},
    {"sign p at m", "11: a polynomial has values at scalars of degree 0, not at a scalar of degree 1"},
    {"sign p at s/0", "13: division by zero"},
    {"sign [s, p]", "6: an array cannot hold both a scalar of degree 0 and a vector of degree 1"},
    {"sign [s for i in 0..0]", "6: this array is empty: no number from 0 on is below 0"},
    {"for i in 0..s { sign s }",
     "13: a loop's bound must be a whole number known at compile time, not a scalar of degree 0"},
    {"for i in 0..1000000000 { let x = s } sign s",
     "13: a loop may have at most 1000000 iterations (loops and calls are unrolled at compile time)"},
    {"sign s + 0.1",
     "10: a literal here is not representable in floating point: its value is exactly 1/10 (write `1/10`, a quotient "
     "whose rounding the bounds account for)"},
    {"sign 1e400 * s",
     "6: a number known at compile time leaves the range of exact arithmetic (its numerator and denominator may have "
     "126 bits besides powers of two)"},
    {"sign s + 3^40",
     "6: the number 12157665459056928801 would have to be a floating-point constant and is not representable "
     "(numerator and denominator of a constant may have 53 bits besides powers of two)"},
    {"let n = s let n = s sign n", "15: the name `n` is already bound in this block (bound before at test.pred:2:5)"},
    {"let s = 1 sign s", "5: the name `s` is already bound in this block (bound before at test.pred:1:49)"},
    {"sign s, m as s", "14: two outputs are called `s` (name the output with `as`)"},
    {"sign s as double", "11: an output cannot be called `double`: it is a keyword of C++"},
    {"sign s as a__b", "11: an output cannot be called `a__b`: it contains `__`, which C++ reserves"},
    {"stage x { sign s } stage x { sign m }", "26: the stage `x` is defined twice (defined before at test.pred:2:7)"},
    {"sign s stage x { sign m }",
     "14: a predicate has stages or outputs at its top level, not both (move the outputs above into a stage)"},
    {"stage x { sign s } sign m",
     "25: a predicate has stages or outputs at its top level, not both (move this into a stage)"},
    {"stage x { let y = s } stage z { sign y }",
     "7: the stage `x` has no outputs (outputs are given with `sign` and `value`)"},
    {"stage f { sign s }", "7: a stage cannot be called `f`: it is the predicate's name"},
    {"stage State { sign s }", "7: a stage cannot be called `State`: it is a name that generated code uses"},
    {"range |q| <= 1 sign s", "8: `q` is no parameter of this predicate"},
    {"range |s| <= 0 sign s", "14: a range's limit must be a positive number known at compile time"},
    {"range |s, p| <= 1 range |s| <= 2 sign s", "26: `s` has a range already"},
    {"property antisymetric(p, a) sign s", "10: unknown property `antisymetric` (did you mean `antisymmetric`?)"},
    {"property antisymmetric(p, e) sign s", "27: `p` and `e` cannot be exchanged: their types differ"},
    {"property antisymmetric(p, p) sign s", "27: `p` is named twice in a property"},
    {"property cyclic(p, a) sign s", "10: this property is written `cyclic(a, b, c)`"},
    {"property scale(1/2) sign s", "16: the exponent of `scale` must be a whole number known at compile time, not 1/2"},
    {"property scale(2) of w sign s", "22: this predicate has no output `w`"},
};

TEST(ElaborateDiagnostics, TellsEachMistakeInTheUsersTerms) {
  for (const Mistake& m : mistakes) {
    const Compiled c =
        compile(std::string("predicate f(moving point p, a, point2 e, scalar s, moving scalar m, scalar k[4]) {\n") +
                m.statements + "\n}");
    EXPECT_EQ(c.errors(), "2:" + std::string(m.errors) + "\n") << m.statements;
  }
}

TEST(ElaborateDiagnostics, ReportsOneMistakeOnceHoweverOftenItIsMet) {
  EXPECT_EQ(compile("function g(a, b) = dot(a, b) + a\n"
                    "predicate f(point p, q) { for i in 0..10 { let x = g(p, q) + g(q, p) sign x } }")
                .diagnostics.entries()
                .size(),
            1u);
}

TEST(ElaborateDiagnostics, ReportsEveryMistakeAndPoisonsWhatFollows) {
  EXPECT_EQ(compile("predicate f(point p, scalar s) {\n"
                    "  let n = p + s\n"
                    "  let m = n * n + dot(n, p)\n"
                    "  sign m, n.x, p - 1\n"
                    "}\n"
                    "predicate g(scalar s) { }")
                .errors(),
            "2:11: cannot add a vector of degree 0 and a scalar of degree 0\n"
            "4:16: cannot subtract a number from a vector of degree 0\n"
            "6:11: the predicate `g` has no outputs (outputs are given with `sign` and `value`)\n");
}

TEST(ElaborateDiagnostics, ChecksNamesInWhatIsNeverUsed) {
  EXPECT_EQ(compile("function unused(a) { let x = aa for i in 0..0 { let y = frob(i) } return [j for j in 0..x] + j }")
                .errors(),
            "1:30: unknown name `aa`\n"
            "1:57: unknown function `frob`\n"
            "1:94: unknown name `j`\n");
}

TEST(ElaborateDiagnostics, RefusesRecursionAndWhatReachesIt) {
  EXPECT_EQ(compile("function a(x) = b(x)\nfunction b(x) = c(x) + 1\nfunction c(x) = b(x)\n"
                    "predicate f(scalar s) { sign a(s) }")
                .errors(),
            "3:17: the function `b` calls itself (functions are inlined, so they cannot be recursive; `for` loops are "
            "unrolled)\n");
}

TEST(ElaborateDiagnostics, ChecksTheTypesOfFunctionParameters) {
  const std::string functions =
      "function g(vec3 v, static scalar s, moving point p, k[3]) = s\n"
      "predicate f(moving point p, moving scalar m, scalar s, a[3], b[4]) { sign ";
  EXPECT_EQ(compile("function g(u, vec3 v) = v predicate f(moving point p, scalar s) { sign g(s, p), g([p], p) as o }")
                .errors(),
            "");
  EXPECT_EQ(compile(functions + "g(s, s, p, [p, p, p]) as o }").errors(),
            "2:77: `g` takes a vector as `v`, not a scalar of degree 0\n");
  EXPECT_EQ(compile(functions + "g(p, m, p, [p, p, p]) as o }").errors(),
            "2:80: `g` takes a scalar of degree 0 as `s`, not a scalar of degree 1\n");
  EXPECT_EQ(compile(functions + "g(p, s, m * p, [p, p, p]) as o }").errors(),
            "2:83: `g` takes a vector of degree 1 or 0 as `p`, not a vector of degree 2\n");
  EXPECT_EQ(
      compile(functions + "g(p, s, p, a) as o }").errors(),
      "2:86: `g` takes an array [3] of vectors of degree 1 or 0 as `k`, not an array [3] of scalars of degree 0\n");
}

TEST(ElaborateDiagnostics, ReportsWrongDeclarations) {
  EXPECT_EQ(compile("function f(bounded scalar a) = a").errors(),
            "1:27: the parameter `a` of a function cannot be `bounded` (bounds come in through the parameters of "
            "predicates; a function takes any value)\n");
  EXPECT_EQ(compile("function dot(a, b) = a").errors(),
            "1:10: `dot` is a function of the language (choose another name)\n");
  EXPECT_EQ(compile("function g(a) = a function g(b) = b").errors(),
            "1:28: the function `g` is defined twice (defined before at test.pred:1:10)\n");
  EXPECT_EQ(compile("predicate f(scalar a) { sign a } instance f = f()").errors(),
            "1:43: the predicate `f` is defined twice (defined before at test.pred:1:11)\n");
  EXPECT_EQ(compile("predicate f(scalar a, a) { sign a }").errors(),
            "1:23: the parameter `a` is already bound in this block (bound before at test.pred:1:20)\n");
  EXPECT_EQ(compile("predicate f(scalar int) { sign 1 as o }").errors(),
            "1:20: a parameter cannot be called `int`: it is a keyword of C++\n");
  EXPECT_EQ(compile("predicate bound(scalar a) { sign a }").errors(),
            "1:11: a predicate cannot be called `bound`: it is a name that generated code uses\n");
  EXPECT_EQ(compile("predicate evaluate(scalar a) { sign a }").errors(),
            "1:11: a predicate without stages cannot be called `evaluate`: its function has that name\n");
  EXPECT_EQ(compile("predicate f(scalar a[0]) { sign 1 as o }").errors(),
            "1:22: an array's extent must be at least 1, not 0\n");
  EXPECT_EQ(compile("predicate f(scalar a[1000][1000000000]) { sign 1 as o }").errors(),
            "1:28: the parameters hold more than 65536 scalars\n");
  EXPECT_EQ(compile("predicate f(scalar a) { sign a } instance g = ff()").errors(), "1:47: unknown predicate `ff`\n");
  EXPECT_EQ(compile("predicate f(scalar abc) { sign abc } instance g = f(abd: static)").errors(),
            "1:53: `f` has no parameter `abd` (did you mean `abc`?)\n");
  EXPECT_EQ(compile("predicate f(scalar a) { sign a } instance g = f(a: static, a: moving)").errors(),
            "1:60: the motion of `a` is given twice\n");
  EXPECT_EQ(compile("instance g = h() instance h = h()").diagnostics.entries().size(), 1u);
}

}  // namespace
}  // namespace tightrope::dsl::testing
