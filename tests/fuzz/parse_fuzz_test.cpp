#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "dsl/parser.h"
#include "tests/fuzz/mutation.h"

namespace tightrope::dsl {
namespace {

/// What every parse must leave, whatever the text. Returns the first violation, or empty.
std::string violation(const SourceMap& sources, const Diagnostics& diagnostics, const Module& module) {
  const std::size_t size = sources.file(0).text.size();
  const auto inside = [&](SourceSpan span) { return span.file == 0 && span.begin <= span.end && span.end <= size; };
  for (const Diagnostic& entry : diagnostics.entries()) {
    if (!inside(entry.span)) return "a diagnostic outside of the file: " + entry.message;
    if (entry.message.empty() || entry.message.find('\n') != std::string::npos) return "a message that is no line";
  }
  const std::string rendered = diagnostics.render(sources);
  if (rendered.empty() == diagnostics.has_errors()) return "errors and their rendering differ";
  if (!rendered.empty() && rendered.back() != '\n') return "rendering does not end its line";
  const auto nodes = static_cast<ExprId>(module.exprs.size());
  for (ExprId id = 0; id < nodes; ++id) {
    const Expr& expr = module.exprs[static_cast<std::size_t>(id)];
    if (!inside(expr.span)) return "a node outside of the file";
    for (const ExprId operand : expr.operands) {
      if (operand < 0 || operand >= id) return "an operand that does not stand before its user";
    }
  }
  return {};
}

TEST(ParseFuzz, MutatedProgramsAreParsedOrReported) {
  const std::vector<std::string> programs = fuzz::corpus();
  ASSERT_GT(programs.size(), 40u);
  std::mt19937_64 random(20150701);
  int with_errors = 0, without = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::string text = fuzz::mutate(programs[random() % programs.size()], programs, random);
    SourceMap sources;
    Diagnostics diagnostics;
    sources.add("fuzz.pred", text);
    const Module module = parse(sources, 0, diagnostics);
    ASSERT_EQ(violation(sources, diagnostics, module), "") << "mutation " << i << ":\n" << text;
    ++(diagnostics.has_errors() ? with_errors : without);
  }
  EXPECT_GT(with_errors, 1000);  // both ways are taken
  EXPECT_GT(without, 100);
}

TEST(ParseFuzz, RandomBytesAreReported) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 300; ++i) {
    std::string text(random() % 2000, '\0');
    for (char& c : text) c = static_cast<char>(i % 3 == 0 ? random() : 32 + random() % 95);
    SourceMap sources;
    Diagnostics diagnostics;
    sources.add("fuzz.pred", text);
    const Module module = parse(sources, 0, diagnostics);
    ASSERT_EQ(violation(sources, diagnostics, module), "") << "text " << i;
  }
}

TEST(ParseFuzz, EveryPrefixOfAProgramIsParsedOrReported) {
  for (const std::string& program : fuzz::corpus()) {
    for (std::size_t length = 0; length < std::min<std::size_t>(program.size(), 600); ++length) {
      SourceMap sources;
      Diagnostics diagnostics;
      sources.add("fuzz.pred", program.substr(0, length));
      const Module module = parse(sources, 0, diagnostics);
      ASSERT_EQ(violation(sources, diagnostics, module), "") << program.substr(0, length);
    }
  }
}

}  // namespace
}  // namespace tightrope::dsl
