#pragma once
/// The tests that come with generated code: FILE.test.cpp (GoogleTest) and a CMakeLists.txt that builds and runs it.

#include <cstdint>
#include <string>
#include <vector>

#include "codegen/bounds.h"

namespace tightrope::codegen {

struct TestOptions {
  std::string stem;         ///< the headers are STEM.BOUND.REAL.h
  std::string source_name;  ///< of the .pred file, no folder
  std::uint64_t source_hash = 0;
  std::vector<BoundMode> modes;
  std::vector<Precision> precisions;
  /// The generated values are those of the reference, operation by operation (false under --products karatsuba).
  bool same_products = true;
};

/// Tests of every header of the options against `reference`, the program lowered with direct products and not
/// simplified, whose value graph the test file evaluates in exact arithmetic.
std::string print_tests(const dsl::Program& reference, const TestOptions& options);

/// CMakeLists.txt for a folder of generated code: builds every *.test.cpp in it and registers it with CTest.
std::string print_test_project();

}  // namespace tightrope::codegen
