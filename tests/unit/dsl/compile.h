#pragma once
/// Compiles program text for tests, and evaluates graphs exactly.

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dsl/elaborate.h"
#include "dsl/evaluate.h"
#include "dsl/parser.h"
#include "dsl/program.h"

namespace tightrope::dsl::testing {

struct Compiled {
  SourceMap sources;
  Diagnostics diagnostics;
  Program program;

  /// "1:5: message (hint)", one a line, in the order found.
  std::string errors() const {
    std::string result;
    for (const Diagnostic& d : diagnostics.entries()) {
      const SourceMap::Position p = sources.position(d.span.file, d.span.begin);
      result += std::to_string(p.line) + ":" + std::to_string(p.column) + ": " + d.message;
      if (!d.hint.empty()) result += " (" + d.hint + ")";
      result += '\n';
    }
    return result;
  }
};

inline Compiled compile(const std::string& text, const ElaborateOptions& options = {}) {
  Compiled result;
  const std::uint32_t file = result.sources.add("test.pred", text);
  std::vector<Module> modules;
  modules.push_back(parse(result.sources, file, result.diagnostics));
  const bool incomplete = result.diagnostics.has_errors();
  result.program = elaborate(result.sources, modules, incomplete, result.diagnostics, options);
  return result;
}

/// An exact rational with the operations that `evaluate` needs.
struct Exact {
  mpq_class value;
  Exact() = default;
  Exact(mpq_class v) : value(std::move(v)) {}  // NOLINT(google-explicit-constructor)
  Exact(double v) : value(v) {}                // NOLINT(google-explicit-constructor)
  friend Exact operator+(const Exact& a, const Exact& b) { return {mpq_class(a.value + b.value)}; }
  friend Exact operator-(const Exact& a, const Exact& b) { return {mpq_class(a.value - b.value)}; }
  friend Exact operator*(const Exact& a, const Exact& b) { return {mpq_class(a.value * b.value)}; }
  friend Exact operator/(const Exact& a, const Exact& b) {
    EXPECT_NE(b.value, 0);
    return {mpq_class(a.value / b.value)};
  }
  Exact operator-() const { return {mpq_class(-value)}; }
  friend bool operator<(const Exact& a, const Exact& b) { return a.value < b.value; }
  int sign() const { return sgn(value); }
  friend bool operator>(const Exact& a, const Exact& b) { return a.value > b.value; }
  friend bool operator==(const Exact& a, const Exact& b) { return a.value == b.value; }
  friend Exact abs(const Exact& a) { return {mpq_class(::abs(a.value))}; }
  friend Exact fma(const Exact& a, const Exact& b, const Exact& c) { return a * b + c; }
  friend Exact mul_pow2(const Exact& a, int exponent) {
    mpq_class result = a.value;
    if (exponent >= 0) {
      mpq_mul_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
    } else {
      mpq_div_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
    }
    return {result};
  }
  /// Of squares only.
  friend Exact sqrt(const Exact& a) {
    mpz_class n, d;
    mpz_sqrt(n.get_mpz_t(), a.value.get_num_mpz_t());
    mpz_sqrt(d.get_mpz_t(), a.value.get_den_mpz_t());
    const mpq_class root(n, d);
    EXPECT_EQ(root * root, a.value) << "not a square";
    return {root};
  }
};

/// Small rationals: exact zeros and coincidences happen.
inline mpq_class random_rational(std::mt19937_64& random) {
  const long numerator = std::uniform_int_distribution<long>(-20, 20)(random);
  const long denominator = std::uniform_int_distribution<long>(1, 8)(random);
  mpq_class result(numerator, denominator);
  result.canonicalize();
  return result;
}

}  // namespace tightrope::dsl::testing
