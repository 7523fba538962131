#pragma once
/// `tightrope certify`: the bounds of a program as Gappa scripts, and what Gappa says about them.

#include <filesystem>
#include <string>
#include <vector>

#include "codegen/compile.h"

namespace tightrope::codegen {

struct CertifyRequest {
  std::vector<BoundMode> modes = {BoundMode::fixed, BoundMode::safe};
  std::vector<Precision> precisions = {Precision::binary64};
  double assumed_range = 1;               ///< of inputs that declare none
  std::filesystem::path directory;        ///< for NAME.STAGE.OUTPUT[i].MODE.REAL.g and what Gappa printed
  std::string gappa;                      ///< the program; empty: scripts are written, nothing is run
  double time_limit = 60;                 ///< seconds a script
  double scale = 1;                       ///< test hook: every claim is multiplied by this
  Weakening weakening = Weakening::none;  ///< test hook: every claim lacks a term
};

/// One output element in one mode and precision.
struct Certificate {
  enum class Verdict {
    proved,      ///< the bound that generated code has
    rules_only,  ///< `static`: the bound without lemmas S and V, which Gappa does not know
    not_proved,
    timed_out,
    failed,     ///< Gappa refuses the script
    no_script,  ///< an operation that Gappa does not know, or SafeBound behind a quotient or a root
    not_run,
  } verdict = Verdict::not_run;
  std::string output;  ///< "orient2d.evaluate.side[0]"
  BoundMode mode = BoundMode::fixed;
  Precision precision = Precision::binary64;
  double bound = 0;        ///< what is claimed
  double rules_bound = 0;  ///< `static`: by the rules alone; else as `bound`
  double gappa_bound = 0;  ///< what Gappa finds by itself; infinite if nothing
  double seconds = 0;
};

/// The predicate with ranges where it declared none.
dsl::Predicate with_assumed_ranges(const dsl::Predicate& predicate, double range);

/// Writes the scripts and runs Gappa. For SafeBound, what is claimed is the bound that the generated code computes
/// where all maxima of groups of inputs take their greatest values: it grows with them, so it certifies B and k.
/// Returns an error if a file cannot be written.
std::string certify(const dsl::Program& program, const CertifyRequest& request, dsl::Diagnostics& diagnostics,
                    std::vector<Certificate>& certificates);

/// Whether Gappa was asked and something remains that it did not prove.
bool unproved(const std::vector<Certificate>& certificates);

/// The table that the command prints.
std::string text(const std::vector<Certificate>& certificates);

}  // namespace tightrope::codegen
