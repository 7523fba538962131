#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "dsl/program.h"
#include "tests/fuzz/mutation.h"

namespace tightrope::dsl {
namespace {

/// What every loaded program must be, whatever the text. Returns the first violation, or empty.
std::string violation(const SourceMap& sources, const Diagnostics& diagnostics, const Program& program) {
  for (const Diagnostic& entry : diagnostics.entries()) {
    const SourceSpan span = entry.span;
    if (span.file >= sources.size() || span.begin > span.end || span.end > sources.file(span.file).text.size()) {
      return "a diagnostic outside of the file: " + entry.message;
    }
    if (entry.message.empty() || entry.message.find('\n') != std::string::npos) return "a message that is no line";
  }
  if (diagnostics.render(sources).empty() == diagnostics.has_errors()) return "errors and their rendering differ";
  if (diagnostics.has_errors()) return {};
  for (const Predicate& predicate : program.predicates) {
    if (predicate.stages.empty()) return "a sound predicate without stages";
    for (const Stage& stage : predicate.stages) {
      if (stage.outputs.empty()) return "a sound stage without outputs";
      for (const Output& output : stage.outputs) {
        std::size_t expected = 1;
        for (const int extent : output.extents) expected *= static_cast<std::size_t>(extent);
        if (output.nodes.size() != expected) return "an output whose nodes are not as many as its extents say";
        for (const NodeId node : output.nodes) {
          if (node < 0 || node >= predicate.graph.size()) return "an output that is no node of the graph";
        }
      }
    }
    for (NodeId id = 0; id < predicate.graph.size(); ++id) {
      const Node& node = predicate.graph[id];
      if (node.a >= id || node.b >= id || node.c >= id) return "an operand that does not stand before its user";
      if (node.op == Op::input && static_cast<std::size_t>(node.index) >= predicate.slots.size())
        return "a slot of nothing";
    }
  }
  return {};
}

TEST(LoadFuzz, MutatedProgramsAreSoundOrReported) {
  namespace fs = std::filesystem;
  const std::vector<std::string> programs = fuzz::corpus();
  const fs::path folder = fs::temp_directory_path() / ("tightrope_fuzz_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  for (const auto& entry : fs::directory_iterator(fs::path(TIGHTROPE_SOURCE_DIR) / "ccd/predicates")) {
    if (entry.path().extension() == ".pred") fs::copy_file(entry.path(), folder / entry.path().filename());  // imports
  }
  const fs::path path = folder / "fuzz.pred";
  ElaborateOptions options;
  options.max_nodes = 20'000;
  std::mt19937_64 random(20110809);
  int with_errors = 0, without = 0;
  for (int i = 0; i < 3'000; ++i) {
    const std::string text = fuzz::mutate(programs[random() % programs.size()], programs, random);
    if (text.find("000") != std::string::npos) continue;  // large loops and arrays: the stress tests' matter
    std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
    options.products = i % 2 == 0 ? ProductScheme::direct : ProductScheme::karatsuba;
    SourceMap sources;
    Diagnostics diagnostics;
    const Program program = load_program(path.string(), sources, diagnostics, options);
    EXPECT_EQ(violation(sources, diagnostics, program), "") << "mutation " << i << ":\n" << text;
    ++(diagnostics.has_errors() ? with_errors : without);
    if (::testing::Test::HasFailure()) break;
  }
  EXPECT_GT(with_errors, 1000);  // both ways are taken
  EXPECT_GT(without, 20);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace tightrope::dsl
