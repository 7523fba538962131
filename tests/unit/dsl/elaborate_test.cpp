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
