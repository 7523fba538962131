#pragma once
/// C++ text of bounded predicates; docs/generated-code.md is the contract.

#include <cstdint>
#include <span>
#include <string>

#include "codegen/bounds.h"

namespace tightrope::codegen {

/// A predicate and what `add_bounds` made of it.
struct GeneratedPredicate {
  const dsl::Predicate* predicate = nullptr;
  const BoundedPredicate* bounded = nullptr;
};

/// What the numbers of generated code are.
enum class Form {
  scalar,  ///< double or float; FILE.BOUND.REAL.h
  lanes,   ///< a vector class, one query a lane; FILE.BOUND.REAL.simd.h (runtime/tightrope/lanes.h)
};

struct HeaderOptions {
  std::string source_name;        ///< "vertex_face.pred", no folder: the same text on every machine
  std::uint64_t source_hash = 0;  ///< of the file and its imports
  BoundMode mode = BoundMode::tight;
  Precision precision = Precision::binary64;
  bool fma = false;         ///< the products were contracted (codegen/fuse.h)
  std::string scheme = {};  ///< the evaluation scheme's name, if it was chosen (codegen/explore)
  Form form = Form::scalar;
};

/// The whole header, FILE.BOUND.REAL.h. Deterministic byte for byte; compiles without warnings.
///
/// Every product is spelled `product(a, b)`, not only one that is seen to feed a sum: values leave through results and
/// State, the function is inlined, and the caller's sum must not be fused with it either.
///
/// For lanes the same text, but for the type of the numbers, Lanes<double>, and without the functions that test the
/// declared ranges: a lane has no branch of its own. It stands in a namespace of the includer's choice and may be
/// included once for each of them.
std::string print_header(std::span<const GeneratedPredicate> predicates, const HeaderOptions& options);

/// One predicate of a header: the declaration of its template and its specialisation for the mode.
std::string print_predicate(const GeneratedPredicate& generated, const HeaderOptions& options);

/// "vertex_face.tight.double.h"
std::string header_name(const std::string& stem, BoundMode mode, Precision precision, Form form = Form::scalar);

}  // namespace tightrope::codegen
