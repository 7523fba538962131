#include "command/evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "command/measurement.h"
#include "command/progress.h"
#include "query_io/query_files.h"
#include "scenes/single_precision.h"
#include "scenes/truth.h"

namespace tightrope::ccd {
namespace {

constexpr std::size_t queries_per_block = 65536;  // 12 MiB of points: as a caller's batch they come from memory

/// What the blocks of one kind gave in one precision.
struct PrecisionEvaluation {
  Precision precision{};
  std::vector<Tally> tallies;  ///< of the methods asked for and, if not among them, of `tight` at the end
  std::uint64_t queries = 0;
  std::uint64_t collisions = 0;

  template <class Real>
  void add(Kind kind, std::span<const Real> points, std::span<const unsigned char> truths) {
    measure(kind, points, truths, tallies);
    queries += points.size() / coordinates_per_query;
    for (const unsigned char truth : truths) collisions += truth;
  }
};

/// Queries of one kind from one or more files, until there are enough for a block; and what the blocks before gave.
struct KindEvaluation {
  QueryBlock pending;
  std::vector<PrecisionEvaluation> precisions;
  bool truth_known = true;
};

class Evaluator {
 public:
  explicit Evaluator(const EvaluationRequest& request) : request_(request) {
    std::vector<Tally> tallies;
    for (const Method method : request.methods) tallies.push_back({.method = method});
    if (find_tight(tallies) == tallies.end()) tallies.push_back({.method = Method::tight});
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      KindEvaluation& evaluation = of(kind);
      evaluation.pending.kind = kind;
      for (const Precision precision : request.precisions) {
        evaluation.precisions.push_back({.precision = precision, .tallies = tallies});
      }
    }
  }

  void add(const QueryBlock& block) {
    KindEvaluation& evaluation = of(block.kind);
    evaluation.pending.points.insert(evaluation.pending.points.end(), block.points.begin(), block.points.end());
    append_truths(block, evaluation);
    if (evaluation.pending.size() >= queries_per_block) run(evaluation);
  }

  Evaluation result() {
    for (KindEvaluation& evaluation : kinds_) {
      if (evaluation.pending.size() > 0) run(evaluation);
      for (const PrecisionEvaluation& precision : evaluation.precisions) {
        if (precision.queries > 0) add_rows(evaluation, precision);
      }
    }
    return std::move(result_);
  }

 private:
  static std::vector<Tally>::const_iterator find_tight(const std::vector<Tally>& tallies) {
    return std::find_if(tallies.begin(), tallies.end(), [](const Tally& t) { return t.method == Method::tight; });
  }

  KindEvaluation& of(Kind kind) { return kinds_[kind == Kind::vertex_face ? 0 : 1]; }

  void append_truths(const QueryBlock& block, KindEvaluation& evaluation) {
    std::vector<unsigned char>& truths = evaluation.pending.truths;
    const bool decide =
        request_.truth == TruthSource::exact || (request_.truth == TruthSource::file_or_exact && !block.has_truth());
    if (!decide) {
      evaluation.truth_known = evaluation.truth_known && block.has_truth();
      truths.insert(truths.end(), block.truths.begin(), block.truths.end());
      return;
    }
    const std::size_t before = truths.size();
    truths.resize(before + block.size());
    const auto exact = std::span(truths).subspan(before);
    exact_truths(block.kind, block.points, exact);
    for (std::size_t i = 0; i < block.truths.size(); ++i) result_.wrong_truths += block.truths[i] != exact[i] ? 1 : 0;
  }

  void run(KindEvaluation& evaluation) {
    const QueryBlock& block = evaluation.pending;
    for (PrecisionEvaluation& precision : evaluation.precisions) {
      switch (precision.precision) {
        case Precision::in_double:
          precision.add(block.kind, std::span(block.points),
                        evaluation.truth_known ? std::span(block.truths) : std::span<const unsigned char>());
          break;
        case Precision::in_float: {
          const SingleBlock single = in_single_precision(block, evaluation.truth_known);
          precision.add(block.kind, std::span(single.points), single.truths);
          result_.changed += single.changed;
          result_.left_out += single.left_out;
          break;
        }
      }
    }
    evaluation.pending.clear();
  }

  void add_rows(const KindEvaluation& kind, const PrecisionEvaluation& precision) {
    const double tight = find_tight(precision.tallies)->nanoseconds;
    for (std::size_t m = 0; m < request_.methods.size(); ++m) {
      const Tally& tally = precision.tallies[m];
      EvaluationRow row{.method = tally.method,
                        .kind = kind.pending.kind,
                        .precision = precision.precision,
                        .queries = precision.queries,
                        .answers_true = tally.answers_true,
                        .mistakes = std::nullopt,
                        .uncertain = tally.uncertain,
                        .ns_per_query = tally.nanoseconds / static_cast<double>(precision.queries),
                        .time_ratio_to_tight = tally.nanoseconds / tight};
      if (kind.truth_known) {
        row.mistakes = Mistakes{precision.collisions, tally.false_positives, tally.false_negatives};
      }
      result_.rows.push_back(row);
    }
  }

  const EvaluationRequest& request_;
  std::array<KindEvaluation, 2> kinds_;
  Evaluation result_;
};

}  // namespace

std::string_view name(Precision precision) {
  switch (precision) {
    case Precision::in_double:
      return "double";
    case Precision::in_float:
      return "float";
  }
  return {};
}

std::variant<Evaluation, FileError> evaluate(const EvaluationRequest& request) {
  auto found = find_query_files(request.paths, request.kind);
  if (auto* wrong = std::get_if<FileError>(&found)) return *wrong;
  QueryStream stream(std::get<std::vector<QueryFile>>(std::move(found)));
  Evaluator evaluator(request);
  Progress progress("evaluating");
  QueryBlock block;
  std::uint64_t done = 0;
  while (true) {
    if (auto wrong = stream.next(queries_per_block, block)) return *wrong;
    if (block.size() == 0) break;
    if (request.truth == TruthSource::file && !block.has_truth()) {
      return FileError{
          fmt::format("{}: tells no truth; --truth exact decides the queries exactly", stream.path().string())};
    }
    evaluator.add(block);
    done += block.size();
    progress.show(done);
  }
  Evaluation evaluation = evaluator.result();
  evaluation.rounded = stream.rounded();
  return evaluation;
}

}  // namespace tightrope::ccd
