#pragma once
/// A predicate rewritten for exact signs: quotients as numerator and denominator, square roots as a + b sqrt(c), until
/// every sign is that of a polynomial over integers (exact_graph.h) or follows from such signs.

#include <optional>
#include <string>
#include <vector>

#include "codegen/exact_graph.h"
#include "dsl/program.h"

namespace tightrope::codegen {

/// What must hold for an output to have a value.
struct ExactGuard {
  enum class Kind { nonzero, nonnegative } kind = Kind::nonzero;
  ExactId node = -1;  ///< a divisor's numerator, a radicand's numerator
  bool operator==(const ExactGuard&) const = default;
};

/// One output element.
struct ExactElement {
  ExactId sign = -1;               ///< the node whose sign is the element's
  std::vector<ExactGuard> guards;  ///< the element is invalid unless all hold
  std::vector<int> slots;          ///< the input slots it depends on, ascending: invalid unless all are finite
  ScaledNode numerator;            ///< the value is numerator / denominator
  ExactId denominator = -1;        ///< positive; -1: none
  bool rational = true;            ///< false: the value contains a square root and is not given
};

struct ExactOutput {
  std::vector<ExactElement> elements;  ///< as Output::nodes
};

struct ExactStage {
  std::vector<ExactOutput> outputs;  ///< as Stage::outputs
};

struct ExactProgram {
  ExactGraph graph;
  std::vector<ExactStage> stages;
};

/// Rewrites; errors (more than one square root in an output, a value with a square root) go to `diagnostics` with the
/// place of the output.
///
/// The rules, for exact real numbers; D > 0 throughout, so that the sign of a quotient is that of its numerator:
///   x / D + y / E = (x E + y D) / (D E), equal denominators kept; min, max by the sign of the aligned difference
///   (x / D) / (y / E) = x E sign(y) / (D |y|), y not zero
///   sqrt(x / D) = sqrt(x D) / D, x not negative
///   sums and products of a + b sqrt(c) with one c; 1 / (b sqrt(c) / D) = D sqrt(c) / (b c)
///   sign(a + b sqrt(c)): that of the term whose square is larger, a^2 against b^2 c, where they differ
std::optional<ExactProgram> exact_program(const dsl::Predicate& predicate, dsl::Diagnostics& diagnostics);

}  // namespace tightrope::codegen
