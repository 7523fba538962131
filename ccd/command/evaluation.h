#pragma once
/// What methods answer on query files, and how long they take.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "command/device.h"
#include "command/processes.h"
#include "query_io/query_block.h"

namespace tightrope::ccd {

enum class TruthSource {
  file_if_told,   ///< the files' truth; unknown for a kind if one of its files tells none
  file,           ///< the files' truth, which they must tell
  exact,          ///< the exact oracle's
  file_or_exact,  ///< the files' truth, the exact oracle's where they tell none
};

/// The type that a method computes in.
enum class Precision { in_double, in_float };
std::string_view name(Precision precision);  ///< "double", "float"

struct EvaluationRequest {
  std::vector<std::string> paths;
  std::optional<Kind> kind;
  std::vector<Method> methods;
  std::vector<Precision> precisions = {Precision::in_double};
  TruthSource truth = TruthSource::file_if_told;
  Execution execution = default_execution();
  std::size_t queries_per_block = 65536;  ///< timed as one batch, and of HDF5 files the units that processes share
};

/// Counts against the truth.
struct Mistakes {
  std::uint64_t collisions = 0;  ///< queries that truly collide
  std::uint64_t false_positives = 0;
  std::uint64_t false_negatives = 0;
};

struct EvaluationRow {
  Method method{};
  Kind kind{};
  Precision precision{};
  Execution execution{};
  std::uint64_t queries = 0;
  std::uint64_t answers_true = 0;
  std::optional<Mistakes> mistakes;  ///< empty: the truth is not known
  std::uint64_t uncertain = 0;       ///< signs met that the method could not tell
  double ns_per_query = 0;
  double time_ratio_to_tight = 0;  ///< `tight` in the same precision and execution, measured in the same run
};

struct Evaluation {
  /// Kind by kind, precision by precision, the methods in the order of the request; no rows without queries.
  std::vector<EvaluationRow> rows;
  std::uint64_t rounded = 0;       ///< rational coordinates that were rounded to a double
  std::uint64_t wrong_truths = 0;  ///< TruthSource::exact: truths in files that are not the exact ones
  std::uint64_t changed = 0;       ///< queries that rounding to float changes; their truth there is the exact oracle's
  std::uint64_t left_out = 0;      ///< queries beyond the range of float, left out there
};

/// Each of `processes` takes its share of the files and of the blocks of HDF5 files; all get the same result: the
/// counts that a single process finds, the times of all summed; or the error that a single process meets first. Memory
/// does not grow with the number of queries.
std::variant<Evaluation, FileError> evaluate(const EvaluationRequest& request, Processes& processes);
std::variant<Evaluation, FileError> evaluate(const EvaluationRequest& request);  ///< by this process alone

}  // namespace tightrope::ccd
