#include "command/evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <span>
#include <utility>

#include "command/progress.h"
#include "query_io/query_files.h"
#include "scenes/truth.h"

namespace tightrope::ccd {
namespace {

constexpr std::size_t queries_per_block = 65536;  // 12 MiB of points: as a caller's batch they come from memory

/// One method's sums over the blocks of one kind.
struct Tally {
  Method method{};
  double nanoseconds = 0;
  std::uint64_t answers_true = 0;
  std::uint64_t false_positives = 0;
  std::uint64_t false_negatives = 0;
};

/// Queries of one kind from one or more files, until there are enough for a block; and what the blocks before gave.
struct KindEvaluation {
  QueryBlock pending;
  std::vector<Tally> tallies;  ///< of the methods asked for and, if not among them, of `tight` at the end
  std::uint64_t queries = 0;
  std::uint64_t collisions = 0;
  bool truth_known = true;
};

using Clock = std::chrono::steady_clock;

/// Nanoseconds of `repeats` passes over the block.
double pass_time(const QueryBlock& block, Method method, int repeats, std::vector<unsigned char>& answers) {
  const auto begin = Clock::now();
  for (int i = 0; i < repeats; ++i) collides(block.kind, block.points.data(), block.size(), answers.data(), method);
  return std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Runs all methods over the block and adds to their tallies. The time of a method is the median of several passes; the
/// methods take turns, so that a change of the machine's speed meets all of them.
void run_methods(const QueryBlock& block, std::vector<Tally>& tallies, bool truth_known) {
  constexpr double least_pass = 2e4;  // ns: far above the clock's resolution
  constexpr double whole_time = 2e7;  // ns a method, for small blocks
  std::vector<std::vector<unsigned char>> answers(tallies.size(), std::vector<unsigned char>(block.size()));
  std::vector<int> repeats;
  double slowest = 0;
  for (std::size_t m = 0; m < tallies.size(); ++m) {
    const double first = std::max(pass_time(block, tallies[m].method, 1, answers[m]), 1.0);
    repeats.push_back(static_cast<int>(std::ceil(std::max(least_pass / first, 1.0))));
    slowest = std::max(slowest, first * repeats.back());
  }
  const int passes = std::clamp(static_cast<int>(whole_time / slowest), 5, 101);
  std::vector<std::vector<double>> times(tallies.size());
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t m = 0; m < tallies.size(); ++m) {
      times[m].push_back(pass_time(block, tallies[m].method, repeats[m], answers[m]) / repeats[m]);
    }
  }
  for (std::size_t m = 0; m < tallies.size(); ++m) {
    Tally& tally = tallies[m];
    tally.nanoseconds += median(times[m]);
    for (std::size_t i = 0; i < block.size(); ++i) {
      const bool answer = answers[m][i] != 0;
      tally.answers_true += answer ? 1 : 0;
      if (!truth_known) continue;
      const bool truth = block.truths[i] != 0;
      tally.false_positives += answer && !truth ? 1 : 0;
      tally.false_negatives += !answer && truth ? 1 : 0;
    }
  }
}

class Evaluator {
 public:
  explicit Evaluator(const EvaluationRequest& request) : request_(request) {
    std::vector<Method> measured = request.methods;
    if (std::find(measured.begin(), measured.end(), Method::tight) == measured.end()) measured.push_back(Method::tight);
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      KindEvaluation& evaluation = of(kind);
      evaluation.pending.kind = kind;
      for (const Method method : measured) evaluation.tallies.push_back({.method = method});
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
      if (evaluation.queries > 0) add_rows(evaluation);
    }
    return std::move(result_);
  }

 private:
  KindEvaluation& of(Kind kind) { return kinds_[kind == Kind::vertex_face ? 0 : 1]; }

  void append_truths(const QueryBlock& block, KindEvaluation& evaluation) {
    std::vector<unsigned char>& truths = evaluation.pending.truths;
    if (request_.truth != TruthSource::exact) {
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

  static void run(KindEvaluation& evaluation) {
    run_methods(evaluation.pending, evaluation.tallies, evaluation.truth_known);
    evaluation.queries += evaluation.pending.size();
    for (const unsigned char truth : evaluation.pending.truths) evaluation.collisions += truth;
    evaluation.pending.clear();
  }

  void add_rows(const KindEvaluation& evaluation) {
    const auto& tallies = evaluation.tallies;
    const auto tight =
        std::find_if(tallies.begin(), tallies.end(), [](const Tally& t) { return t.method == Method::tight; });
    for (std::size_t m = 0; m < request_.methods.size(); ++m) {
      const Tally& tally = tallies[m];
      EvaluationRow row{.method = tally.method,
                        .kind = evaluation.pending.kind,
                        .queries = evaluation.queries,
                        .answers_true = tally.answers_true,
                        .mistakes = std::nullopt,
                        .ns_per_query = tally.nanoseconds / static_cast<double>(evaluation.queries),
                        .time_ratio_to_tight = tally.nanoseconds / tight->nanoseconds};
      if (evaluation.truth_known) {
        row.mistakes = Mistakes{evaluation.collisions, tally.false_positives, tally.false_negatives};
      }
      result_.rows.push_back(row);
    }
  }

  const EvaluationRequest& request_;
  std::array<KindEvaluation, 2> kinds_;
  Evaluation result_;
};

}  // namespace

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
