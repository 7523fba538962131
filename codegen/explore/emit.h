#pragma once
/// The header of one scheme.

#include <optional>

#include "codegen/explore/candidate.h"
#include "codegen/write_files.h"

namespace tightrope::codegen::explore {

struct EmitRequest {
  std::string file;  ///< the .pred file
  std::uint64_t source_hash = 0;
  Precision inputs = Precision::binary64;
  std::filesystem::path directory = ".";
  bool tests = false;
};

/// What `tightrope compile` would write for this predicate alone, FILE.BOUND.REAL.h, computed by the candidate's
/// scheme, which the header's top names. Validated as all headers are; of a filter in single precision its two
/// predicates are, the few lines between them are not. With tests also FILE.test.cpp and a CMakeLists.txt, against the
/// predicate as written.
std::vector<TextFile> emitted_files(const Candidate& candidate, const dsl::Predicate& written,
                                    const EmitRequest& request);

/// Whether there are generated tests of this scheme: not of float-first on floats, whose results are doubles.
bool has_tests(const Scheme& scheme, Precision inputs);

}  // namespace tightrope::codegen::explore
