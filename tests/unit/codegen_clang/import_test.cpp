/// `tightrope import`: what becomes of a C++ function, and what is said where nothing can.

#include "codegen/import.h"

#include <gtest/gtest.h>

#include "tests/unit/codegen/test_program.h"

namespace tightrope::codegen {
namespace {

struct Import {
  std::optional<ImportedFunction> function;
  std::string errors;
};

Import import_code(const std::string& code) {
  Import result;
  result.function = import_function("test.cpp", code, "f", {}, result.errors);
  EXPECT_EQ(result.function.has_value(), result.errors.empty()) << result.errors;
  return result;
}

/// The predicate without the comment at its top.
std::string predicate_of(const std::string& code) {
  const Import import = import_code(code);
  if (!import.function) return import.errors;
  const std::string text = import_text(*import.function, "test.cpp");
  return text.substr(text.find('\n') + 1);
}

struct Row {
  const char* code;
  const char* predicate;
};

TEST(Import, WritesWhatTheCodeComputes) {
  const Row table[] = {
      {"double f(double a, double b) { return a * b + a; }",
       "predicate f(scalar a, b) {\n  sign a * b + a as returned\n}\n"},
      // Association and order stay.
      {"double f(double a, double b, double c) { return a + (b + c); }",
       "predicate f(scalar a, b, c) {\n  sign a + (b + c) as returned\n}\n"},
      {"double f(double a, double b, double c) { return a - (b - c) * (c / b) / a; }",
       "predicate f(scalar a, b, c) {\n  sign a - (b - c) * (c / b) / a as returned\n}\n"},
      // Locals and their values.
      {"double f(double a, double b) { double det = a * b; return det; }",
       "predicate f(scalar a, b) {\n  let det = a * b\n  sign det\n}\n"},
      {"double f(double a, double b) { double d = a * b; d -= a; d = d * d; return d + 1; }",
       "predicate f(scalar a, b) {\n  let d = a * b\n  let d_2 = d - a\n  let d_3 = d_2 * d_2\n  sign d_3 + 1 as "
       "returned\n}\n"},
      // Constants: exact ones, factors that are rounded where they stand.
      {"double f(double a) { return 0.5 * a; }", "predicate f(scalar a) {\n  sign 0.5 * a as returned\n}\n"},
      {"double f(double a) { return a + 0.1; }",
       "predicate f(scalar a) {\n  sign a + 3602879701896397 / 2^55 as returned\n}\n"},
      {"double f(double a, double b) { return 3 * a * b; }",
       "predicate f(scalar a, b) {\n  sign rounded(3 * a) * b as returned\n}\n"},
      {"double f(double a, double b) { return 3 * (a * b); }",
       "predicate f(scalar a, b) {\n  sign 3 * (a * b) as returned\n}\n"},
      {"double f(double a) { return 3 * a + a; }",
       "predicate f(scalar a) {\n  sign rounded(3 * a) + a as returned\n}\n"},
      {"double f(double a) { return -a - -2.0; }", "predicate f(scalar a) {\n  sign -a + 2 as returned\n}\n"},
      {"constexpr double k = 2.0 / 3; double f(double a) { return a / k * (1.0 / 4); }",
       "predicate f(scalar a) {\n  sign rounded(a / (6004799503160661 / 2^53)) * 0.25 as returned\n}\n"},
      {"float f(float a) { return a * 0.1f; }",
       "predicate f(scalar a) {\n  sign a * (13421773 / 2^27) as returned\n}\n"},
      // Functions of the standard library and what stands for them.
      {"double f(double a) { return __builtin_sqrt(__builtin_fabs(a)); }",
       "predicate f(scalar a) {\n  sign sqrt(abs(a)) as returned\n}\n"},
      {"double f(double a, double b) { return a < b ? a : b; }",
       "predicate f(scalar a, b) {\n  sign min(a, b) as returned\n}\n"},
      {"double f(double a, double b) { return a >= b ? a : b; }",
       "predicate f(scalar a, b) {\n  sign max(a, b) as returned\n}\n"},
      {"double f(double a) { return a < 0 ? -a : a; }", "predicate f(scalar a) {\n  sign abs(a) as returned\n}\n"},
      // Arrays, pointers, structs.
      {"double f(const double* p) { const double* q = p + 2; return p[0] * *q++ - q[1]; }",
       "predicate f(scalar p[5]) {\n  sign p[0] * p[2] - p[4] as returned\n}\n"},
      {"double f(const double (*p)[2], int) { return p[1][0]; }",
       "predicate f(vec2 p[2]) {\n  sign p[1].x as returned\n}\n"},
      {"struct V { double x, y; }; double f(V a, const V& b) { a.x -= b.x; return a.x * b.y; }",
       "predicate f(vec2 a, b) {\n  let a_x = a.x - b.x\n  sign a_x * b.y as returned\n}\n"},
      {"struct V { double x, y; }; V f(V a) { V b = a; b.x = a.y; return b; }",
       "predicate f(vec2 a) {\n  sign [a.y, a.y] as returned\n}\n"},
      {"void f(double a, double& sum, double* both) { sum = a + 1; both[1] = a - 1; }",
       "predicate f(scalar a) {\n  let sum_2 = a + 1\n  let both_1 = a - 1\n  sign sum_2 as sum\n  sign both_1 as "
       "both_1_2\n}\n"},
      {"void f(double* x) { x[0] += x[1]; }", "predicate f(vec2 x) {\n  let x_0 = x.x + x.y\n  sign [x_0] as x_2\n}\n"},
      // Control flow that is known.
      {"double f(const double* a) { double s = 0; for (int i = 0; i < 3; ++i) { if (i == 1) continue; s += a[i]; } "
       "return "
       "s; }",
       "predicate f(vec3 a) {\n  let s = a.x + a.z\n  sign s\n}\n"},
      {"template <int n> double power(double x) { if constexpr (n == 0) return 1; else return x * power<n - 1>(x); }\n"
       "double f(double a) { return power<3>(a); }",
       "predicate f(scalar a) {\n  sign a * (a * a) as returned\n}\n"},
      {"void swap(double& a, double& b) { double t = a; a = b; b = t; }\n"
       "double f(double a, double b) { swap(a, b); return a - 2 * b; }",
       "predicate f(scalar a, b) {\n  sign b - 2 * a as returned\n}\n"},
      // Whole numbers have their types' ranges: unsigned ones wrap.
      {"double f(double x, double y) { return (~0u) * x - y; }",
       "predicate f(scalar x, y) {\n  sign 4294967295 * x - y as returned\n}\n"},
      {"double f(double x) { return (-1u) * x; }", "predicate f(scalar x) {\n  sign 4294967295 * x as returned\n}\n"},
      {"double f(double x) { unsigned char c = 200; c += 100; return c * x; }",
       "predicate f(scalar x) {\n  sign 44 * x as returned\n}\n"},
      {"double f(double x) { unsigned short c = 65535; c++; c -= 3; return x + c; }",
       "predicate f(scalar x) {\n  sign x + 65533 as returned\n}\n"},
      {"double f(double x) { unsigned char c = 3; c -= 7u; return x + c; }",
       "predicate f(scalar x) {\n  sign x + 252 as returned\n}\n"},
      {"double f(double x) { unsigned u = 1u << 31; u <<= 1; --u; return x + u; }",
       "predicate f(scalar x) {\n  sign x + 4294967295 as returned\n}\n"},
      {"double f(double x) { unsigned char c = 255; return x + (unsigned char)~c + (unsigned char)300; }",
       "predicate f(scalar x) {\n  sign x + 44 as returned\n}\n"},
      {"double f(double x) { bool b = true; b += 4; return x + b; }",
       "predicate f(scalar x) {\n  sign x + 1 as returned\n}\n"},
      {"constexpr unsigned k = -1; double f(double x) { return x + k; }",
       "predicate f(scalar x) {\n  sign x + 4294967295 as returned\n}\n"},
      // A body that is to be seen is what counts, whatever the name.
      {"extern \"C\" double max(double a, double b) { return a + b; } double f(double a, double b) { return max(a, b); "
       "}",
       "predicate f(scalar a, b) {\n  sign a + b as returned\n}\n"},
      {"extern \"C\" double sqrt(double a) { return a + 1; } double f(double a) { return sqrt(a); }",
       "predicate f(scalar a) {\n  sign a + 1 as returned\n}\n"},
      {"extern \"C\" double sqrt(double a); double f(double a) { return sqrt(a); }",
       "predicate f(scalar a) {\n  sign sqrt(a) as returned\n}\n"},
      {"namespace std { double abs(double a) { return a - 1; } } double f(double a) { return std::abs(a); }",
       "predicate f(scalar a) {\n  sign a - 1 as returned\n}\n"},
      // The right side of an assignment is complete before the left changes.
      {"struct V { double x, y; }; double f(V v) { v = V{v.y, v.x}; return v.x - 3 * v.y; }",
       "predicate f(vec2 v) {\n  sign v.y - 3 * v.x as returned\n}\n"},
      // Constants of all sizes: exponents bound only factors.
      {"double f(double a) { return a * 0x1p-1074 + 0x1.8p1000; }",
       "predicate f(scalar a) {\n  sign a * (1 / 2^1074) + 3 * 2^999 as returned\n}\n"},
      // Names that the language has for itself.
      {"double f(double sign, double dot) { double let = sign - dot; return let * let; }",
       "predicate f(scalar sign_2, dot) {\n  let let_2 = sign_2 - dot\n  sign let_2 * let_2 as returned\n}\n"},
      {"double f(double x, double y) { double α = x - y; double dét = α * x; return dét * dét - α; }",
       "predicate f(scalar x, y) {\n  let x_2 = x - y\n  let dt = x_2 * x\n  sign dt * dt - x_2 as returned\n}\n"},
  };
  for (const Row& row : table) EXPECT_EQ(predicate_of(row.code), row.predicate) << row.code;
}

TEST(Import, SaysWhereAndWhyNot) {
  const Row table[] = {
      {"double f(double a) {\n  if (a < 0) return 1;\n  return a;\n}",
       "test.cpp:2:9: error: a branch on a computed number"},
      {"bool f(double a) { return a < 0; }", "test.cpp:1:29: error: a branch on a computed number"},
      {"double f(double a, double b) { return a < b ? a : 2 * b; }", "a branch on a computed number"},
      {"double f(double a, double b) { return a < b ? (b = 1, a) : b; }", "a branch on a computed number"},
      {"int f(double a) { return (int)a; }", "a conversion of a computed number to a whole one"},
      {"double f(float a, double b) { return a * b; }", "a conversion from `float` to `double`"},
      {"float f(double a) { return a; }", "a conversion from `double` to `float`"},
      {"float f(float a) { return a * 0.1; }", "a conversion from `float` to `double`"},
      {"double f(float a) { return a + 1; }", "a conversion from `float` to `double`"},
      {"float f(float a) { a *= 0.1; return a; }", "a computation in another type than the variable's"},
      {"long double f(long double a) { return a + 1; }", "a number of type `long double`"},
      {"double f(double a, int n) { return a * n; }", "`n` is not known at compile time"},
      {"double f(const double* a, int i) { return a[i]; }", "test.cpp:1:45: error: `i` is not known at compile time"},
      {"double f(double a) { for (int i = 0; i >= 0;) a += 1; return a; }", "too many steps"},
      {"double f(double a) { return f(a); }", "`f` calls itself too often"},
      {"double g(double); double f(double a) { return g(a); }", "the body of `g` is not to be seen"},
      {"double f(double a, double (*g)(double)) { return g(a); }", "a parameter of type"},
      {"double f(double a) { volatile double b = a; return b; }", "a volatile object may change"},
      {"double k; double f(double a) { return a * k; }", "`k` is neither a parameter, a local nor a constant"},
      {"double f(double a) { static double s = 0; s += a; return s; }", "a static variable keeps its value"},
      {"double f(double a) { double b; return a + b; }", "`b` is read before it is set"},
      {"double f(double a) { double b[2] = {a, a}; return b[2]; }", "element 2 of `b` is not there"},
      {"double f(const double* a) { return a[-1]; }", "element -1 of `a` is not there"},
      {"double f(double a) { return a / 0.0; }", "a division by zero"},
      {"double f(double a) { return a + 1e300 * 1e300; }", "a constant that is infinite"},
      {"double f(double a) { switch (1) { default: return a; } }", "this statement cannot be followed"},
      {"double f(const double* a) { return *reinterpret_cast<const double*>(reinterpret_cast<const char*>(a) + 4); }",
       "a pointer to another type"},
      {"void f(double a) { a += 1; }", "the function returns nothing and sets nothing"},
      {"double g(double a) { return a; }", "test.cpp: error: no function `f` with a body"},
      {"template <class T> T f(T a) { return a; }", "it is a template that nothing instantiates"},
      {"double f(double a) { return a; } float f(float a) { return a; }", "is one of 2 functions of this name"},
      {"double f(double a) { return b; }", "test.cpp:1:29: error: use of undeclared identifier 'b'"},
      // Whole numbers that are none of their type, or that 64 bits with a sign do not hold.
      {"double f(double x) { return 18446744073709551615ULL * x; }", "test.cpp:1:29: error: a whole number beyond"},
      {"constexpr auto k = ~0ull; double f(double x) { return k * x; }", "a whole number beyond the range"},
      {"double f(double x) { return ~0ull * x; }", "a whole number beyond the range"},
      {"double f(double x) { int k = 1 << 31; return k * x; }", "test.cpp:1:32: error: a whole number beyond"},
      {"double f(double x) { int k = 2147483647; ++k; return k * x; }", "a whole number beyond the range"},
      {"double f(double x) { int k = 2147483647; k += 1; return k * x; }", "a whole number beyond the range"},
      {"double f(double x) { signed char k = 100; k *= 2; return k * x; }", "a whole number beyond the range"},
      {"double f(double x) { int k = -2147483647 - 1; return -k * x; }", "a whole number beyond the range"},
      {"double f(double x) { int k = -2147483647 - 1; return k / -1 * x; }", "a whole number beyond the range"},
      {"double f(double x) { long k = -9223372036854775807 - 1; return k % -1 * x; }",
       "a whole number beyond the range"},
      {"double f(double x) { return __builtin_abs(-2147483647 - 1) * x; }", "a whole number beyond the range"},
      {"double f(double x) { return (signed char)200 * x; }", "a whole number beyond the range"},
      {"double f(double x) { int n = 32; return (1u << n) * x; }", "a shift by more than the type's width"},
      {"double f(double x) { return (unsigned __int128)5 * x; }", "a whole number of more than 64 bits"},
      {"double f(const double* p) { return p[0x2000000000000001]; }", "a pointer far beyond its object"},
      {"struct B { unsigned a : 3; }; double f(double x) { B b{5}; b.a += 5; return b.a * x; }",
       "test.cpp:1:54: error: bit-fields, in type `struct B`"},
      // What would happen besides the arithmetic.
      {"struct G { double& r; ~G() { r += 1; } }; double f(double x) { { G g{x}; } return x; }",
       "an object of type `struct G`, whose destructor does something"},
      {"struct G { double& r; ~G() { r += 1; } }; double f(double x) { G{x}; return x; }", "whose destructor does"},
      {"struct G { double& r; ~G() { r += 1; } }; double f(double x) { return (G{x}.r, x); }", "whose destructor does"},
      {"struct G { double& r; ~G() { r += 1; } }; G g(double& x) { return {x}; }\n"
       "double f(double x) { g(x); return x; }",
       "whose destructor does"},
      {"struct G { double& r; ~G() { r += 1; } }; struct H { G g; }; double f(double x) { H h{{x}}; return x; }",
       "whose destructor does"},
      {"struct G { double& r; ~G() { r += 1; } }; double f(double x) { const G& g = G{x}; return x; }",
       "whose destructor does"},
      {"void g(double* x) { *x += 1; } double f(double x) { __attribute__((cleanup(g))) double y = x; return y; }",
       "a variable with a clean-up function"},
      {"struct A { double x; A(double y) : x(y) {} A(const A& o) : x(o.x + 1) {} }; struct B { A a; };\n"
       "double f(double x) { B b{A(x)}; B c = b; return c.a.x; }",
       "a copy of an object with a member"},
      {"struct V { double x, y; }; double f(V v) { v = V(); return v.x; }", "is read before it is set"},
      {"extern \"C\" double max(double, double); double f(double a) { return max(a, 1); }",
       "the body of `max` is not to be seen"},
      // Constants beyond the language's.
      {"double f(double x) { return 1.7976931348623157e308 * x; }", "test.cpp:1:52: error: a product or quotient with"},
      {"double f(double x) { return 1e-310 * x; }", "a product or quotient with the constant 1e-310"},
      {"double f(double x) { return x / 1e-310; }", "a product or quotient with the constant 1e-310"},
      {"double f(double x) { return 1e-310 / x; }", "a product or quotient with the constant 1e-310"},
      {"double f(double x) { return x * (float)(long double)16777217 - (long double)1; }", "a conversion from"},
      {"struct V { double x; float y; }; double f(V v) { return v.x; }", "a struct of different types"},
  };
  for (const Row& row : table) {
    const Import import = import_code(row.code);
    EXPECT_FALSE(import.function) << row.code;
    EXPECT_NE(import.errors.find(row.predicate), std::string::npos) << row.code << '\n' << import.errors;
  }
}

/// Limits of the language that the interpreter does not know are no internal error.
TEST(Import, SaysThatAFunctionGoesBeyondTheLanguage) {
  ImportedFunction function;
  function.name = "f";
  function.parameters.push_back({"x", {}, 0});
  const dsl::NodeId product =
      function.graph.binary(dsl::Op::mul, function.graph.input(0), function.graph.constant(1e-310));
  function.outputs.push_back({"", {0}, false, {product}});
  EXPECT_THROW(import_text(function, "test.cpp"), InexpressibleFunction);
}

TEST(Import, ShowsTheLineAndACaret) {
  const Import import = import_code("double f(double a) {\n\treturn a < 1 ? 1 : 2;\n}");
  EXPECT_EQ(
      import.errors,
      "test.cpp:2:11: error: a branch on a computed number: a predicate is straight-line (return the number whose "
      "sign decides)\n\treturn a < 1 ? 1 : 2;\n\t         ^\n");
}

/// The last word has a comparison of graphs; it can say no.
TEST(Import, NoticesTextsThatComputeSomethingElse) {
  const Import import = import_code("double f(double a, double b, double c) { return 3 * a * b + c; }");
  ASSERT_TRUE(import.function);
  const auto computed = [&](const std::string& expression) {
    std::string errors;
    return computes("predicate f(scalar a, b, c) { sign " + expression + " as y }", *import.function, errors);
  };
  EXPECT_TRUE(computed("rounded(3 * a) * b + c"));
  EXPECT_TRUE(computed("c + b * rounded(a * 3)"));
  EXPECT_FALSE(computed("3 * a * b + c"));
  EXPECT_FALSE(computed("rounded(3 * b) * a + c"));
  EXPECT_FALSE(computed("rounded(3 * a) * b - c"));
  EXPECT_FALSE(computed("rounded(3 * a) * b + c, a"));
  EXPECT_FALSE(computed("rounded(3 * a) * (b + c)"));
  EXPECT_FALSE(computed("no expression"));
}

}  // namespace
}  // namespace tightrope::codegen
