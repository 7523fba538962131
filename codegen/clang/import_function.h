#pragma once
/// A straight-line C++ function as a graph.

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "codegen/bounds.h"

namespace tightrope::codegen {

struct ImportedParameter {
  std::string name;
  std::vector<int>
      extents;  ///< of arrays, innermost last; a struct of n numbers is an array of n; empty for one number
  int first_slot = 0;
};

struct ImportedOutput {
  std::string name;        ///< empty for what the function returns
  std::vector<int> cells;  ///< which elements were set; of one number: {0}
  bool array = false;
  std::vector<dsl::NodeId> nodes;
};

struct ImportedFunction {
  std::string name;
  Precision precision = Precision::binary64;
  std::vector<ImportedParameter> parameters;
  std::vector<ImportedOutput> outputs;
  dsl::Graph graph;                          ///< every operation as the C++ code rounds it
  std::map<dsl::NodeId, std::string> names;  ///< what the C++ code calls a node
  std::map<dsl::NodeId, std::pair<dsl::NodeId, dsl::NodeId>> written_order;  ///< operands as the C++ code orders them
};

/// Parses `file` with Clang (its flags as on a command line: "-I..", "-std=..") and follows the function of this name,
/// plain or qualified. Calls of functions with visible bodies are followed, loops with known bounds unrolled. What
/// cannot become a graph is an error: "FILE:LINE:COLUMN: error: ..." with the source line and a caret goes to `errors`.
std::optional<ImportedFunction> import_function(const std::string& file, const std::string& code,
                                                const std::string& function, const std::vector<std::string>& flags,
                                                std::string& errors);

}  // namespace tightrope::codegen
