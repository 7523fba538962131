#include "dsl/elaborate.h"

#include <filesystem>
#include <fstream>

#include "dsl/names.h"
#include "tests/unit/dsl/compile.h"

namespace tightrope::dsl::testing {
namespace {

const Predicate& only(const Compiled& c) {
  EXPECT_EQ(c.errors(), "");
  EXPECT_EQ(c.program.predicates.size(), 1u);
  return c.program.predicates.front();
}

std::string extents_text(const Output& o) {
  std::string result = o.name;
  for (const int extent : o.extents) result += "[" + std::to_string(extent) + "]";
  return result;
}

/// "stage: name[4][3] name; stage: ...".
std::string outputs_text(const Predicate& p) {
  std::string result;
  for (const Stage& s : p.stages) {
    result += (result.empty() ? "" : "; ") + s.name + ":";
    for (const Output& o : s.outputs) {
      result += (o.sign ? " " : " value ") + extents_text(o);
      std::size_t size = 1;
      for (const int extent : o.extents) size *= static_cast<std::size_t>(extent);
      EXPECT_EQ(o.nodes.size(), size) << o.name;
    }
  }
  return result;
}

TEST(Elaborate, NumbersSlotsByElementTimeAndComponent) {
  const Predicate p =
      only(compile("predicate f(moving point a[2], bounded scalar k[3], vec2 v, moving scalar m) { range |v| <= 4 sign "
                   "a[0].x as o }"));
  ASSERT_EQ(p.parameters.size(), 4u);
  EXPECT_EQ(p.slots.size(), 12u + 3 + 2 + 2);
  const auto slot = [&](int i) { return p.slots[static_cast<std::size_t>(i)]; };
  EXPECT_EQ(slot(10).parameter, 0);  // a[1] at t = 1, y
  EXPECT_EQ(slot(10).element, 1);
  EXPECT_EQ(slot(10).time, 1);
  EXPECT_EQ(slot(10).component, 1);
  EXPECT_EQ(slot(13).parameter, 1);
  EXPECT_EQ(slot(13).element, 1);
  EXPECT_EQ(p.parameters[3].first_slot, 17);
  EXPECT_EQ(slot(18).time, 1);
  EXPECT_TRUE(p.parameters[0].point && p.parameters[0].moving && !p.parameters[0].bounded);
  EXPECT_TRUE(!p.parameters[1].point && !p.parameters[1].moving && p.parameters[1].bounded);
  EXPECT_EQ(p.parameters[2].range, 4.0);
  EXPECT_FALSE(p.parameters[0].range);
  for (int i = 0; i < static_cast<int>(p.slots.size()); ++i) {  // inputs are the first nodes
    EXPECT_EQ(p.graph[i], (Node{.op = Op::input, .index = i}));
  }
}

TEST(Elaborate, GivesOutputsTheirExtents) {
  EXPECT_EQ(outputs_text(only(compile("predicate f(moving point p, scalar s, k[2][3]) {\n"
                                      "  sign s, p, dot(p, p) as sq, k, [p, p] as pair\n"
                                      "  value p at 0 as start, [[s], [s]] as nested, coefficients(cross(p, p)) as c\n"
                                      "}"))),
            "evaluate: s p[2][3] sq[3] k[2][3] pair[2][2][3] value start[3] value nested[2][1] value c[3][3]");
}

TEST(Elaborate, NamesOutputsAfterTheirExpressions) {
  const Predicate p =
      only(compile("predicate f(scalar a, b, moving scalar y) {\n"
                   "  sign diff(y), diff(diff(y)), a - b, 3 * y, y at 0, (a) /* first */ *\n b as a_b2 // end\n"
                   "  for i in -1..1 { for j in 0..2 { sign a + i + j as sum } }\n"
                   "}"));
  EXPECT_EQ(outputs_text(p), "evaluate: diff_y diff_diff_y a_b n3_y[2] y_at_0 a_b2 sum_m1_0 sum_m1_1 sum_0_0 sum_0_1");
  EXPECT_EQ(p.stages[0].outputs[3].text, "3 * y");
  EXPECT_EQ(p.stages[0].outputs[5].text, "(a) * b");
  EXPECT_EQ(p.stages[0].outputs[6].text, "a + i + j");
}

TEST(OutputName, IsAnIdentifierMadeOfTheExpression) {
  EXPECT_EQ(output_name("diff(diff(Y))"), "diff_diff_Y");
  EXPECT_EQ(output_name("3 * Y"), "n3_Y");
  EXPECT_EQ(output_name("-x"), "x");
  EXPECT_EQ(output_name("(a - b)[0].x"), "a_b_0_x");
  EXPECT_EQ(output_name("_a__b"), "a_b");
  EXPECT_EQ(fold_white_space("a  +\n\tb // comment\n * /* more */ c "), "a + b * c");
}

TEST(Elaborate, LetsLaterStagesSeeWhatEarlierOnesBound) {
  const Predicate p =
      only(compile("predicate f(scalar a, b) {\n"
                   "  let d = a - b\n"
                   "  stage first { let e = d * d sign e }\n"
                   "  stage second { let a = e + d sign a, e as again }\n"  // shadows the parameter
                   "  stage third { sign a * e as product }\n"
                   "}"));
  EXPECT_EQ(outputs_text(p), "first: e; second: a again; third: product");
  EXPECT_EQ(p.stages[0].outputs[0].nodes, p.stages[1].outputs[1].nodes);
  EXPECT_EQ(p.graph[p.stages[2].outputs[0].nodes[0]].a, p.stages[0].outputs[0].nodes[0]);
  EXPECT_EQ(p.graph[p.stages[2].outputs[0].nodes[0]].b, p.stages[1].outputs[0].nodes[0]);
}

TEST(Elaborate, EndsNamesWithTheirBlock) {
  EXPECT_EQ(compile("predicate f(scalar a) { for i in 0..2 { let b = a * i } sign b as o }").errors(),
            "1:62: unknown name `b`\n");
  EXPECT_EQ(compile("predicate f(scalar a) { sign [i * a for i in 0..2] as o, i as p }").errors(),
            "1:58: unknown name `i`\n");
  EXPECT_EQ(compile("function g(x) = x * a predicate f(scalar a) { sign g(a) }").errors(), "1:21: unknown name `a`\n");
}

TEST(Elaborate, InlinesFunctionsAndUnrollsLoops) {
  const Predicate p =
      only(compile("function twice(f) = plus(f, f)\n"
                   "function plus(scalar a, b) { let c = a + b for i in 0..2 { let c = 0 } return c }\n"
                   "predicate f(scalar k[3], s) { sign twice(s), [[k[i] * j for j in 1..3] for i in 0..3] as table }"));
  EXPECT_EQ(outputs_text(p), "evaluate: twice_s table[3][2]");
  const std::vector<double> values = evaluate<double>(p.graph, std::vector<double>{3, 5, 7, 11});
  const auto value = [&](NodeId n) { return values[static_cast<std::size_t>(n)]; };
  EXPECT_EQ(value(p.stages[0].outputs[0].nodes[0]), 22);
  std::vector<double> table;
  for (const NodeId n : p.stages[0].outputs[1].nodes) table.push_back(value(n));
  EXPECT_EQ(table, (std::vector<double>{3, 6, 5, 10, 7, 14}));
}

TEST(Elaborate, RoundsRangesDown) {
  const Predicate p = only(compile("predicate f(scalar a, b) { range |a| <= 1/10 range |b| <= 2^2000 sign a }"));
  EXPECT_EQ(p.parameters[0].range, std::nextafter(0.1, 0));  // the double 0.1 is above one tenth
  EXPECT_EQ(p.parameters[1].range, std::numeric_limits<double>::max());
}

TEST(Elaborate, ResolvesProperties) {
  const Predicate p =
      only(compile("predicate f(point a, b, c, scalar s) {\n"
                   "  property antisymmetric(a, c) of w\n"
                   "  property cyclic(a, b, c) of v, w\n"
                   "  property translation_invariant\n"
                   "  property scale(-3) of wide\n"
                   "  stage one { sign a.x as v, b.x as wide }\n"
                   "  stage two { for i in 0..2 { sign c[i] as w } }\n"
                   "}"));
  ASSERT_EQ(p.properties.size(), 4u);
  using Places = std::vector<std::pair<int, int>>;
  EXPECT_EQ(p.properties[0].kind, Property::Kind::antisymmetric);
  EXPECT_EQ(p.properties[0].parameters, (std::vector<int>{0, 2}));
  EXPECT_EQ(p.properties[0].outputs, (Places{{1, 0}, {1, 1}}));  // w_0 and w_1, not "wide"
  EXPECT_EQ(p.properties[1].outputs, (Places{{0, 0}, {1, 0}, {1, 1}}));
  EXPECT_EQ(p.properties[2].outputs, (Places{{0, 0}, {0, 1}, {1, 0}, {1, 1}}));
  EXPECT_EQ(p.properties[3].exponent, -3);
  EXPECT_EQ(p.properties[3].outputs, (Places{{0, 1}}));
}

TEST(Elaborate, MakesInstancesOfPredicatesAndOfInstances) {
  const Compiled c = compile(
      "instance late = moving_cubic(p: static)\n"
      "// Three points.\n"
      "predicate moving_cubic(moving point p, a, b) {\n"
      "  range |p| <= 8\n"
      "  property antisymmetric(a, b)\n"
      "  property antisymmetric(a, p)\n"
      "  sign det(p, a, b) as y\n"
      "}\n"
      "// All but one fixed.\n"
      "instance wall = late(a, b: static)\n"
      "instance again = wall(p: moving, a: moving)\n");
  ASSERT_EQ(c.errors(), "");
  std::string text;
  for (const Predicate& p : c.program.predicates) {
    text += p.name + " " + std::to_string(p.stages[0].outputs[0].degree) + " " + std::to_string(p.slots.size()) + " " +
            std::to_string(p.properties.size()) + " " + p.doc + "\n";
    EXPECT_EQ(p.parameters[0].range, 8.0);
  }
  // in order of appearance; a property of parameters that have come to differ is dropped
  EXPECT_EQ(text,
            "late 2 15 1 Three points.\n"
            "moving_cubic 3 18 2 Three points.\n"
            "wall 0 9 2 All but one fixed.\n"
            "again 2 15 1 All but one fixed.\n");
}

class Files : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() / ("tightrope_elaborate_" + std::to_string(std::random_device{}()));
    std::filesystem::create_directories(folder / "sub");
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
  Compiled load(const std::string& name) {
    Compiled c;
    c.program = load_program((folder / name).string(), c.sources, c.diagnostics);
    return c;
  }
  std::filesystem::path folder;
};

TEST_F(Files, ImportsAreRelativeToTheImportingFileAndLoadedOnce) {
  write("main.pred",
        "import \"sub/shapes.pred\"\nimport \"./sub/../sub/shapes.pred\"\n"
        "predicate f(point a, b) { sign len2(a - b) }\ninstance g = base(v: moving)");
  write("sub/shapes.pred",
        "import \"more.pred\"\nfunction len2(v) = square(v)\npredicate base(vec3 v) { sign len2(v) }");
  write("sub/more.pred", "import \"../main.pred\"\nfunction square(v) = dot(v, v)");  // a cycle does no harm
  const Compiled c = load("main.pred");
  ASSERT_EQ(c.errors(), "");
  ASSERT_EQ(c.program.predicates.size(), 2u);  // imported predicates are not compiled again
  EXPECT_EQ(c.program.predicates[1].stages[0].outputs[0].degree, 2);
  EXPECT_EQ(c.program.files.size(), 3u);
  EXPECT_EQ(c.program.files[0], 0u);
}

TEST_F(Files, MissingFilesAreReportedWhereTheyAreAskedFor) {
  EXPECT_NE(load("nothing.pred").errors().find("1:1: cannot read"), std::string::npos);
  EXPECT_NE(load("sub").errors().find("1:1: cannot read"), std::string::npos);  // a folder
  write("main.pred", "\n  import \"gone.pred\"\npredicate f(scalar a) { sign a + zz }");
  const std::string errors = load("main.pred").errors();
  EXPECT_NE(errors.find("2:10: cannot read"), std::string::npos) << errors;
  EXPECT_EQ(errors.find("zz"), std::string::npos) << errors;  // it might come from the missing file
}

TEST_F(Files, ErrorsInImportedFilesAreReportedThere) {
  write("main.pred", "import \"sub/shapes.pred\"\npredicate f(point a, b) { sign area(a, b) }");
  write("sub/shapes.pred", "function area(a, b) = dot(a, b) + a");
  const Compiled c = load("main.pred");
  ASSERT_EQ(c.diagnostics.entries().size(), 1u);
  const Diagnostic& d = c.diagnostics.entries().front();
  EXPECT_EQ(d.span.file, 1u);
  EXPECT_EQ(d.message, "cannot add a scalar of degree 0 and a vector of degree 0");
  EXPECT_NE(d.hint.find("`area` is called at"), std::string::npos);
  EXPECT_NE(d.hint.find("main.pred:2:32"), std::string::npos) << d.hint;
}

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

TEST(Elaborate, TellsEachMistakeInTheUsersTerms) {
  for (const Mistake& m : mistakes) {
    const Compiled c =
        compile(std::string("predicate f(moving point p, a, point2 e, scalar s, moving scalar m, scalar k[4]) {\n") +
                m.statements + "\n}");
    EXPECT_EQ(c.errors(), "2:" + std::string(m.errors) + "\n") << m.statements;
  }
}

TEST(Elaborate, ReportsOneMistakeOnceHoweverOftenItIsMet) {
  EXPECT_EQ(compile("function g(a, b) = dot(a, b) + a\n"
                    "predicate f(point p, q) { for i in 0..10 { let x = g(p, q) + g(q, p) sign x } }")
                .diagnostics.entries()
                .size(),
            1u);
}

TEST(Elaborate, ReportsEveryMistakeAndPoisonsWhatFollows) {
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

TEST(Elaborate, ChecksNamesInWhatIsNeverUsed) {
  EXPECT_EQ(compile("function unused(a) { let x = aa for i in 0..0 { let y = frob(i) } return [j for j in 0..x] + j }")
                .errors(),
            "1:30: unknown name `aa`\n"
            "1:57: unknown function `frob`\n"
            "1:94: unknown name `j`\n");
}

TEST(Elaborate, RefusesRecursionAndWhatReachesIt) {
  EXPECT_EQ(compile("function a(x) = b(x)\nfunction b(x) = c(x) + 1\nfunction c(x) = b(x)\n"
                    "predicate f(scalar s) { sign a(s) }")
                .errors(),
            "3:17: the function `b` calls itself (functions are inlined, so they cannot be recursive; `for` loops are "
            "unrolled)\n");
}

TEST(Elaborate, ChecksTheTypesOfFunctionParameters) {
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

TEST(Elaborate, ReportsWrongDeclarations) {
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

TEST(Elaborate, KeepsWithinItsLimits) {
  const auto repeated = [](const std::string& text, int count) {
    std::string result;
    for (int i = 0; i < count; ++i) result += text;
    return result;
  };
  // a chain as long as a file may be: a loop, not a recursion
  EXPECT_EQ(compile("predicate f(scalar a, b) { sign a" + repeated(" + b * a", 60000) + " as o }").errors(), "");
  // every function calls the one before it twice: 2^60 calls
  std::string calls = "function f0(x) = x * x\n";
  for (int i = 1; i <= 60; ++i) {
    const std::string callee = "f" + std::to_string(i - 1);
    calls += "function f" + std::to_string(i) + "(x) = " + callee + "(x) + " + callee + "(2 * x)\n";
  }
  const Compiled doubling = compile(calls + "predicate f(scalar a) { sign f60(a) }");
  ASSERT_EQ(doubling.diagnostics.entries().size(), 1u);
  EXPECT_NE(doubling.errors().find("too large"), std::string::npos) << doubling.errors();
  // a chain of calls
  std::string deep = "function f0(x) = x\n";
  for (int i = 1; i <= 5000; ++i)
    deep += "function f" + std::to_string(i) + "(x) = f" + std::to_string(i - 1) + "(x)\n";
  const Compiled chain = compile(deep + "predicate f(scalar a) { sign f5000(a) }");
  ASSERT_EQ(chain.diagnostics.entries().size(), 1u);
  EXPECT_NE(chain.errors().find("nested more than 400 levels"), std::string::npos) << chain.errors();
  // loops of loops that do nothing, and nodes without end
  EXPECT_EQ(compile("predicate f(scalar a) { for i in 0..100000 { for j in 0..100000 { } } sign a }")
                .diagnostics.entries()
                .size(),
            1u);
  EXPECT_NE(
      compile("predicate f(scalar a) { for i in 0..1000 { let x = a * i + 1 / (a + i) } sign a }", {.max_nodes = 1000})
          .errors()
          .find("beyond 1000 nodes"),
      std::string::npos);
  EXPECT_EQ(compile("predicate f(moving scalar m) { sign m ^ 9 as o }", {.max_degree = 8}).diagnostics.entries().size(),
            1u);
}

}  // namespace
}  // namespace tightrope::dsl::testing
