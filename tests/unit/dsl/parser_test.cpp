#include "dsl/parser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace tightrope::dsl {
namespace {

struct Parsed {
  SourceMap sources;
  Diagnostics diagnostics;
  Module module;
  std::string messages() const {
    std::string all;
    for (const Diagnostic& entry : diagnostics.entries()) all += entry.message + "\n";
    return all;
  }
};

Parsed parse_text(std::string text) {
  Parsed parsed;
  parsed.sources.add("test.pred", std::move(text));
  parsed.module = parse(parsed.sources, 0, parsed.diagnostics);
  return parsed;
}

/// The expression with every operand in parentheses, from its nodes alone: (+ a (* b c)).
std::string print(const Module& module, ExprId id) {
  const char* heads[] = {"", "",      "neg", "+",  "-",        "*",           "/",     "^",
                         "", "index", ".",   "at", "at_ratio", "split_ratio", "array", "for"};
  const Expr& expr = module.exprs[static_cast<std::size_t>(id)];
  if (expr.kind == ExprKind::number || expr.kind == ExprKind::name) return expr.text;
  std::string text = std::string("(") + heads[static_cast<std::size_t>(expr.kind)];
  if (expr.kind == ExprKind::call || expr.kind == ExprKind::component) text += expr.text;
  if (expr.kind == ExprKind::comprehension) text += " " + expr.text;
  for (const ExprId operand : expr.operands) text += " " + print(module, operand);
  if (expr.kind == ExprKind::comprehension) text += " : " + print(module, expr.body_end - 1);
  return text + ")";
}

/// What `let x = text` binds.
std::string parse_expression_text(const std::string& text) {
  const Parsed parsed = parse_text("predicate p(scalar a) { let x = " + text + " }");
  if (parsed.diagnostics.has_errors()) return parsed.messages();
  const ExprRange range = parsed.module.predicates.at(0).body.at(0).expr;
  return print(parsed.module, range.root());
}

TEST(Parser, BindsOperatorsAsTheLanguageSays) {
  const struct {
    const char* text;
    const char* tree;
  } table[] = {
      {"a", "a"},
      {"1.5e3", "1.5e3"},
      {"a + b + c", "(+ (+ a b) c)"},
      {"a - b - c", "(- (- a b) c)"},
      {"a - (b - c)", "(- a (- b c))"},
      {"a + b * c - d / e", "(- (+ a (* b c)) (/ d e))"},
      {"a / b / c", "(/ (/ a b) c)"},
      {"a * b ^ c * d", "(* (* a (^ b c)) d)"},
      {"a ^ b ^ c", "(^ a (^ b c))"},
      {"-a ^ 2", "(neg (^ a 2))"},
      {"(-a) ^ 2", "(^ (neg a) 2)"},
      {"2 ^ -3", "(^ 2 (neg 3))"},
      {"2 ^ -3 * a", "(* (^ 2 (neg 3)) a)"},
      {"2 ^ -a ^ b", "(^ 2 (neg (^ a b)))"},
      {"-a * b", "(* (neg a) b)"},
      {"a * -b - -c", "(- (* a (neg b)) (neg c))"},
      {"- - a", "(neg (neg a))"},
      {"-v[0].x", "(neg (.x (index v 0)))"},
      {"a[1][2] ^ 2", "(^ (index (index a 1) 2) 2)"},
      {"(a + b)[0]", "(index (+ a b) 0)"},
      {"f()", "(f)"},
      {"f(a, b + c)(0)", "expected the end of the statement, found `(`\n"},
      {"vec3(1, a, -b).y", "(.y (vec3 1 a (neg b)))"},
      {"[a, b]", "(array a b)"},
      {"[[a]]", "(array (array a))"},
      {"[i * a for i in 0..n - 1]", "(for i 0 (- n 1) : (* i a))"},
      {"[[a[i][j] for j in 0..2] for i in 0..3][k]", "(index (for i 0 3 : (for j 0 2 : (index (index a i) j))) k)"},
  };
  for (const auto& row : table) EXPECT_EQ(parse_expression_text(row.text), row.tree) << row.text;
}

TEST(Parser, TakesQuotientsAfterAtAndInSplitAsHomogeneous) {
  const struct {
    const char* text;
    const char* tree;
  } table[] = {
      {"P at 0", "(at P 0)"},
      {"P at s", "(at P s)"},
      {"P at r/s", "(at_ratio P r s)"},
      {"P at (r/s)", "(at P (/ r s))"},
      {"P at 2*r/s", "(at_ratio P (* 2 r) s)"},
      {"P at r/s*2", "(at P (* (/ r s) 2))"},
      {"P at r/(s + t)", "(at_ratio P r (+ s t))"},
      {"P at -r/s", "(at_ratio P (neg r) s)"},
      {"P at f(r/s)", "(at P (f (/ r s)))"},
      {"P + Q at r/s", "(at_ratio (+ P Q) r s)"},
      {"P at 0 at 1", "(at (at P 0) 1)"},
      {"(P at 0) + Q", "(+ (at P 0) Q)"},
      {"P at (s + q)", "(at P (+ s q))"},
      {"-P at 1", "(at (neg P) 1)"},
      {"split(P, s)", "(split P s)"},
      {"split(P, r/s)", "(split_ratio P r s)"},
      {"split(P, (r/s))", "(split P (/ r s))"},
      {"split(P, r/s)[1] at 1/2", "(at_ratio (index (split_ratio P r s) 1) 1 2)"},
      {"split(P, r/s, t)", "(split P (/ r s) t)"},
      {"split(P/2, s)", "(split (/ P 2) s)"},
      {"splat(P, r/s)", "(splat P (/ r s))"},
      {"at at at", "(at at at)"},
      {"at + at(0)", "(+ at (at 0))"},
  };
  for (const auto& row : table) EXPECT_EQ(parse_expression_text(row.text), row.tree) << row.text;
}

/// Every node's operands and body stand before it, and in the same expression.
void expect_ordered(const Module& module, ExprRange range) {
  for (ExprId id = range.begin; id < range.end; ++id) {
    const Expr& expr = module.exprs[static_cast<std::size_t>(id)];
    for (const ExprId operand : expr.operands) {
      EXPECT_GE(operand, range.begin);
      EXPECT_LT(operand, id);
    }
    if (expr.kind == ExprKind::comprehension) {
      EXPECT_GE(expr.body_begin, range.begin);
      EXPECT_LT(expr.body_begin, expr.body_end);
      EXPECT_LE(expr.body_end, expr.operands[0]);
    }
  }
}

TEST(Parser, PutsNodesOfAnExpressionTogetherAndInOrder) {
  const Parsed parsed = parse_text(
      "predicate p(scalar a[2 + 1]) {\n"
      "  let x = [f(a[i], split(P, i / 2) at r/s) + 1 for i in 0 .. 1 + 1] \n"
      "  sign a * b, (c + d) at (1/2) as e\n"
      "}");
  ASSERT_FALSE(parsed.diagnostics.has_errors()) << parsed.messages();
  const PredicateDecl& p = parsed.module.predicates[0];
  std::vector<ExprRange> ranges{p.parameters[0].array[0], p.body[0].expr, p.body[1].expr, p.body[2].expr};
  ExprId end = 0;
  for (const ExprRange range : ranges) {
    EXPECT_EQ(range.begin, end);
    expect_ordered(parsed.module, range);
    end = range.end;
  }
  EXPECT_EQ(end, static_cast<ExprId>(parsed.module.exprs.size()));  // removed quotients leave nothing behind
}

TEST(Parser, GivesNodesTheTextTheyWereReadFrom) {
  const std::string text = "predicate p(scalar a) { sign (a + b) * f( c )[ 0 ].x at r / s as name }";
  const Parsed parsed = parse_text(text);
  const auto text_of = [&](SourceSpan span) { return text.substr(span.begin, span.end - span.begin); };
  std::vector<std::string> texts;
  for (const Expr& expr : parsed.module.exprs) texts.push_back(text_of(expr.span));
  EXPECT_EQ(texts, (std::vector<std::string>{"a", "b", "a + b", "c", "f( c )", "0", "f( c )[ 0 ]", "f( c )[ 0 ].x",
                                             "(a + b) * f( c )[ 0 ].x", "r", "s", "(a + b) * f( c )[ 0 ].x at r / s"}));
  const Statement& sign = parsed.module.predicates[0].body[0];
  EXPECT_EQ(text_of(sign.span), "(a + b) * f( c )[ 0 ].x at r / s as name");
  EXPECT_EQ(text_of(sign.name_span), "name");
}

TEST(Parser, ReadsParametersWithTheTypeThatHolds) {
  const Parsed parsed = parse_text(
      "predicate p(moving point a, b[2][3], bounded scalar k, l, static vec2 u, point2 w, bounded moving vec3 v) {}\n"
      "function f(x, moving vec3 y, z) = x");
  ASSERT_FALSE(parsed.diagnostics.has_errors()) << parsed.messages();
  using Motion = ParameterDecl::Motion;
  using Kind = ParameterDecl::Kind;
  const struct {
    const char* name;
    bool bounded;
    Motion motion;
    Kind kind;
    std::size_t extents;
  } table[] = {
      {"a", false, Motion::moving, Kind::point, 0},      {"b", false, Motion::moving, Kind::point, 2},
      {"k", true, Motion::unspecified, Kind::scalar, 0}, {"l", true, Motion::unspecified, Kind::scalar, 0},
      {"u", false, Motion::fixed, Kind::vec2, 0},        {"w", false, Motion::unspecified, Kind::point2, 0},
      {"v", true, Motion::moving, Kind::vec3, 0},        {"x", false, Motion::unspecified, Kind::unspecified, 0},
      {"y", false, Motion::moving, Kind::vec3, 0},       {"z", false, Motion::moving, Kind::vec3, 0}};
  std::vector<ParameterDecl> parameters = parsed.module.predicates[0].parameters;
  const auto& more = parsed.module.functions[0].parameters;
  parameters.insert(parameters.end(), more.begin(), more.end());
  ASSERT_EQ(parameters.size(), std::size(table));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    EXPECT_EQ(parameters[i].name, table[i].name);
    EXPECT_EQ(parameters[i].bounded, table[i].bounded) << table[i].name;
    EXPECT_EQ(parameters[i].motion, table[i].motion) << table[i].name;
    EXPECT_EQ(parameters[i].kind, table[i].kind) << table[i].name;
    EXPECT_EQ(parameters[i].array.size(), table[i].extents) << table[i].name;
  }
}

TEST(Parser, ReadsEveryStatement) {
  const Parsed parsed = parse_text(
      "predicate p(point a, b, c) {\n"
      "  range |a, b| <= 2^10 range |c| <= 1;\n"
      "  property translation_invariant\n"
      "  property cyclic(a, b, c) of Y, Z\n"
      "  property scale(-3)\n"
      "  let x = a; let y = b\n"
      "  stage s { sign x, y as z value x for i in 0..3 { sign x[i] as c let q = x } }\n"
      "  ;;\n"
      "}");
  ASSERT_FALSE(parsed.diagnostics.has_errors()) << parsed.messages();
  const PredicateDecl& p = parsed.module.predicates.at(0);
  ASSERT_EQ(p.ranges.size(), 2u);
  EXPECT_EQ(p.ranges[0].names[1].first, "b");
  EXPECT_EQ(print(parsed.module, p.ranges[0].limit.root()), "(^ 2 10)");
  ASSERT_EQ(p.properties.size(), 3u);
  EXPECT_EQ(p.properties[0].name, "translation_invariant");
  EXPECT_TRUE(p.properties[0].number.empty());
  EXPECT_EQ(p.properties[1].arguments.size(), 3u);
  EXPECT_EQ(p.properties[1].outputs.at(1).first, "Z");
  EXPECT_EQ(print(parsed.module, p.properties[2].number.root()), "(neg 3)");
  ASSERT_EQ(p.body.size(), 3u);
  EXPECT_EQ(p.body[1].name, "y");
  const Statement& stage = p.body[2];
  EXPECT_EQ(stage.kind, StatementKind::stage);
  EXPECT_EQ(stage.name, "s");
  ASSERT_EQ(stage.body.size(), 4u);
  EXPECT_EQ(stage.body[0].kind, StatementKind::sign);
  EXPECT_EQ(stage.body[0].name, "");
  EXPECT_EQ(stage.body[1].name, "z");
  EXPECT_EQ(stage.body[2].kind, StatementKind::value);
  const Statement& loop = stage.body[3];
  EXPECT_EQ(loop.kind, StatementKind::for_loop);
  EXPECT_EQ(loop.name, "i");
  EXPECT_EQ(print(parsed.module, loop.last.root()), "3");
  EXPECT_EQ(loop.body.size(), 2u);
}

TEST(Parser, ReadsDeclarations) {
  const Parsed parsed = parse_text(
      "import \"shapes/basic.pred\"\n"
      "function f(a, b) = a + b\n"
      "function g(a) { let b = a for i in 0..3 { let c = b } return f(a, b) }\n"
      "predicate p(moving point a, b) { sign g(a) }\n"
      "instance q = p(a, b: static)\n"
      "instance r = p(a: static, b: moving)\n"
      "instance s = p()");
  ASSERT_FALSE(parsed.diagnostics.has_errors()) << parsed.messages();
  const Module& module = parsed.module;
  EXPECT_EQ(module.imports.at(0).path, "shapes/basic.pred");
  EXPECT_EQ(module.functions.at(0).name, "f");
  EXPECT_TRUE(module.functions[0].body.empty());
  EXPECT_EQ(print(module, module.functions.at(1).result.root()), "(f a b)");
  EXPECT_EQ(module.functions[1].body.size(), 2u);
  using Motion = ParameterDecl::Motion;
  ASSERT_EQ(module.instances.size(), 3u);
  EXPECT_EQ(module.instances[0].predicate, "p");
  EXPECT_EQ(module.instances[0].changes.at(0).motion, Motion::fixed);
  EXPECT_EQ(module.instances[0].changes.at(1).motion, Motion::fixed);
  EXPECT_EQ(module.instances[1].changes.at(0).motion, Motion::fixed);
  EXPECT_EQ(module.instances[1].changes.at(1).motion, Motion::moving);
  EXPECT_TRUE(module.instances[2].changes.empty());
}

TEST(Parser, TakesTheCommentLinesAboveAsDocumentation) {
  const struct {
    const char* text;
    const char* doc;
  } table[] = {
      {"// one\n//  two \n///three\npredicate p(){}", "one\n two\nthree"},
      {"// one\r\n// two\r\npredicate p(){}", "one\ntwo"},
      {"// far\n\n// near\npredicate p(){}", "near"},
      {"// far\n\npredicate p(){}", ""},
      {"import \"a\" // beside\npredicate p(){}", ""},
      {"import \"a\" // beside\n// above\npredicate p(){}", "above"},
      {"// above\n/* block */ predicate p(){}", "above"},
      {"// above\nimport \"a\" predicate p(){}", ""},
      {"predicate p(){ // inside\n}", ""},
      {"//\npredicate p(){}", ""},
  };
  for (const auto& row : table) {
    const Parsed parsed = parse_text(row.text);
    ASSERT_FALSE(parsed.diagnostics.has_errors()) << parsed.messages();
    EXPECT_EQ(parsed.module.predicates.at(0).doc, row.doc) << row.text;
  }
  EXPECT_EQ(parse_text("predicate p(point a){}\n// about q\ninstance q = p(a: moving)").module.instances.at(0).doc,
            "about q");
}

TEST(Parser, ReportsEveryErrorOfAFileAndKeepsTheRest) {
  const Parsed parsed = parse_text(
      "predicate p(scalar a, b) {\n"
      "  let x = a +\n"
      "  let y = a * (b\n"
      "  sign y\n"
      "  for i in 0..3 { sign [y for k in ] }\n"
      "}\n"
      "function f(a) = a ^\n"
      "predicate q(scalar c) { sign c c }\n");
  EXPECT_EQ(parsed.messages(),
            "expected an expression\n"
            "expected `)` to close the `(`\n"
            "expected an expression, found `]`\n"
            "expected an expression\n"
            "expected the end of the statement, found `c`\n");
  ASSERT_EQ(parsed.module.predicates.size(), 2u);
  const PredicateDecl& p = parsed.module.predicates[0];
  ASSERT_EQ(p.body.size(), 4u);
  EXPECT_TRUE(p.body[0].expr.empty());
  EXPECT_EQ(p.body[0].name, "x");
  EXPECT_TRUE(p.body[1].expr.empty());
  EXPECT_FALSE(p.body[2].expr.empty());
  EXPECT_EQ(parsed.module.functions.at(0).name, "f");
  EXPECT_TRUE(parsed.module.functions[0].result.empty());
}

std::string repeat(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST(Parser, AllowsNestingUpToTheLimit) {
  const auto nested = [](int depth) { return repeat("(", depth) + "a" + repeat(")", depth); };
  EXPECT_EQ(parse_expression_text(nested(max_nesting - 1)), "a");  // the predicate's block is one level
  EXPECT_EQ(parse_expression_text(nested(max_nesting)), "this is nested more than 200 levels deep\n");
}

TEST(Parser, ReportsDeepNestingOfEveryKindOnce) {
  const int depth = 10'000;
  const std::string texts[] = {
      repeat("(", depth) + "a" + repeat(")", depth),
      repeat("[", depth) + "a" + repeat("]", depth),
      repeat("f(", depth) + "a" + repeat(")", depth),
      repeat("a[", depth) + "a" + repeat("]", depth),
      repeat("-", depth) + "a",
      repeat("a ^ ", depth) + "a",
      repeat("a at (", depth) + "a" + repeat(")", depth),
      repeat("[a for i in 0..", depth) + "a" + repeat("]", depth),
  };
  for (const std::string& text : texts) {
    EXPECT_EQ(parse_expression_text(text), "this is nested more than 200 levels deep\n") << text.substr(0, 20);
  }
  const std::string blocks = repeat("for i in 0..2 {\n", depth) + repeat("}\n", depth);
  EXPECT_EQ(parse_text("predicate p(scalar a) {" + blocks + "}").messages(),
            "this is nested more than 200 levels deep\n");
}

TEST(Parser, ReadsLongChainsWithoutRecursion) {
  const int length = 300'000;
  for (const std::string op : {"+", "-", "*", "/", " at "}) {
    const Parsed parsed = parse_text("predicate p(scalar a) { let x = a" + repeat(op + "a", length) + " }");
    EXPECT_FALSE(parsed.diagnostics.has_errors()) << op;
    EXPECT_EQ(parsed.module.exprs.size(), 2u * length + 1) << op;
  }
  const Parsed indices = parse_text("predicate p(scalar a) { let x = a" + repeat("[0]", length) + " }");
  EXPECT_FALSE(indices.diagnostics.has_errors());
}

TEST(Parser, StopsAfterManyErrors) {
  const Parsed parsed = parse_text("predicate p(scalar a) {\n" + repeat("sign a a\n", 100'000) + "}");
  EXPECT_EQ(parsed.diagnostics.entries().size(), 1000u);
}

TEST(Parser, AnswersForFilesThatHoldNothing) {
  for (const char* text : {"", "\n", "// only a comment", "\xEF\xBB\xBF", ";;;", "/* a */"}) {
    const Parsed parsed = parse_text(text);
    EXPECT_FALSE(parsed.diagnostics.has_errors()) << text;
    EXPECT_TRUE(parsed.module.predicates.empty());
  }
}

}  // namespace
}  // namespace tightrope::dsl
