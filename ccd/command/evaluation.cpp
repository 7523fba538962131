#include "command/evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>

#include "command/measurement.h"
#include "command/progress.h"
#include "query_io/query_files.h"
#include "scenes/single_precision.h"
#include "scenes/truth.h"

namespace tightrope::ccd {
namespace {

/// What the blocks of one kind gave in one precision.
struct PrecisionEvaluation {
  Precision precision{};
  std::vector<Tally> tallies;  ///< of the methods asked for and, if not among them, of `tight` at the end
  std::uint64_t queries = 0;
  std::uint64_t collisions = 0;

  template <class Real>
  BatchStatus add(Kind kind, std::span<const Real> points, std::span<const unsigned char> truths,
                  const Execution& execution) {
    const Queries<Real> batch{.kind = kind, .count = points.size() / coordinates_per_query, .points = points.data()};
    queries += batch.count;
    for (const unsigned char truth : truths) collisions += truth;
    return measure(batch, truths, execution, tallies);
  }
};

/// Queries of one kind from one or more files, until there are enough for a block; and what the blocks before gave.
struct KindEvaluation {
  QueryBlock pending;
  std::vector<PrecisionEvaluation> precisions;
  std::uint64_t blocks_without_truth = 0;

  bool truth_known() const { return blocks_without_truth == 0; }
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

  /// Takes what `block` holds.
  std::optional<FileError> add(QueryBlock& block) {
    KindEvaluation& evaluation = of(block.kind);
    append_truths(block, evaluation);
    std::vector<double>& points = evaluation.pending.points;
    if (points.empty()) {
      points.swap(block.points);
    } else {
      points.insert(points.end(), block.points.begin(), block.points.end());
    }
    return evaluation.pending.size() >= request_.queries_per_block ? run(evaluation) : std::nullopt;
  }

  /// After the last block.
  std::optional<FileError> finish() {
    for (KindEvaluation& evaluation : kinds_) {
      if (evaluation.pending.size() == 0) continue;
      if (auto wrong = run(evaluation)) return wrong;
    }
    return std::nullopt;
  }

  /// What all processes have found.
  Evaluation result(std::uint64_t rounded, Processes& processes) {
    result_.rounded = rounded;
    sum(processes);
    for (const KindEvaluation& evaluation : kinds_) {
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
      evaluation.blocks_without_truth += block.has_truth() ? 0 : 1;
      truths.insert(truths.end(), block.truths.begin(), block.truths.end());
      return;
    }
    const std::size_t before = truths.size();
    truths.resize(before + block.size());
    const auto exact = std::span(truths).subspan(before);
    exact_truths(block.kind, block.points, exact);
    for (std::size_t i = 0; i < block.truths.size(); ++i) result_.wrong_truths += block.truths[i] != exact[i] ? 1 : 0;
  }

  std::optional<FileError> run(KindEvaluation& evaluation) {
    const QueryBlock& block = evaluation.pending;
    BatchStatus status = BatchStatus::done;
    for (PrecisionEvaluation& precision : evaluation.precisions) {
      if (status == BatchStatus::done) status = run(block, evaluation.truth_known(), precision);
    }
    evaluation.pending.clear();
    if (status == BatchStatus::done) return std::nullopt;
    return FileError{std::string(explanation(status))};
  }

  BatchStatus run(const QueryBlock& block, bool truth_known, PrecisionEvaluation& precision) {
    switch (precision.precision) {
      case Precision::in_double:
        return precision.add(block.kind, std::span(block.points),
                             truth_known ? std::span(block.truths) : std::span<const unsigned char>(),
                             request_.execution);
      case Precision::in_float: {
        const SingleBlock single = in_single_precision(block, truth_known);
        result_.changed += single.changed;
        result_.left_out += single.left_out;
        return precision.add(block.kind, std::span(single.points), single.truths, request_.execution);
      }
    }
    return BatchStatus::invalid_argument;
  }

  /// Calls `count` and `time` with everything that is added up over the processes.
  template <class Count, class Time>
  void for_each_number(const Count& count, const Time& time) {
    for (auto* number : {&result_.rounded, &result_.wrong_truths, &result_.changed, &result_.left_out}) count(*number);
    for (KindEvaluation& kind : kinds_) {
      count(kind.blocks_without_truth);
      for (PrecisionEvaluation& precision : kind.precisions) {
        count(precision.queries);
        count(precision.collisions);
        for (Tally& tally : precision.tallies) {
          for (auto* number : {&tally.answers_true, &tally.false_positives, &tally.false_negatives, &tally.uncertain}) {
            count(*number);
          }
          time(tally.nanoseconds);
        }
      }
    }
  }

  void sum(Processes& processes) {
    std::vector<std::uint64_t> counts;
    std::vector<double> times;
    for_each_number([&](std::uint64_t count) { counts.push_back(count); }, [&](double time) { times.push_back(time); });
    processes.sum(counts);
    processes.sum(times);
    auto count = counts.begin();
    auto time = times.begin();
    for_each_number([&](std::uint64_t& number) { number = *count++; }, [&](double& number) { number = *time++; });
  }

  void add_rows(const KindEvaluation& kind, const PrecisionEvaluation& precision) {
    const double tight = find_tight(precision.tallies)->nanoseconds;
    for (std::size_t m = 0; m < request_.methods.size(); ++m) {
      const Tally& tally = precision.tallies[m];
      EvaluationRow row{.method = tally.method,
                        .kind = kind.pending.kind,
                        .precision = precision.precision,
                        .execution = request_.execution,
                        .queries = precision.queries,
                        .answers_true = tally.answers_true,
                        .mistakes = std::nullopt,
                        .uncertain = tally.uncertain,
                        .ns_per_query = tally.nanoseconds / static_cast<double>(precision.queries),
                        .time_ratio_to_tight = tally.nanoseconds / tight};
      if (kind.truth_known()) {
        row.mistakes = Mistakes{precision.collisions, tally.false_positives, tally.false_negatives};
      }
      result_.rows.push_back(row);
    }
  }

  const EvaluationRequest& request_;
  std::array<KindEvaluation, 2> kinds_;
  Evaluation result_;
};

/// One process's way through its share of the queries.
class Walk {
 public:
  Walk(const EvaluationRequest& request, std::vector<QueryFile> files, const Processes& processes)
      : request_(request),
        stream_(std::move(files), {.index = processes.rank(), .count = processes.count()}),
        evaluator_(request),
        progress_(processes.rank() == 0 ? "evaluating" : "") {}

  /// The next block, or what is left after the last one.
  std::optional<FileError> step() {
    if (auto wrong = stream_.next(request_.queries_per_block, block_)) return wrong;
    if (block_.size() == 0) {
      at_end_ = true;
      return evaluator_.finish();
    }
    if (request_.truth == TruthSource::file && !block_.has_truth()) {
      return FileError{
          fmt::format("{}: tells no truth; --truth exact decides the queries exactly", stream_.path().string())};
    }
    done_ += block_.size();
    progress_.show(done_);
    return evaluator_.add(block_);
  }

  bool at_end() const { return at_end_; }
  std::uint64_t done() const { return done_; }
  const QueryStream& stream() const { return stream_; }
  Evaluator& evaluator() { return evaluator_; }

 private:
  const EvaluationRequest& request_;
  QueryStream stream_;
  Evaluator evaluator_;
  Progress progress_;
  QueryBlock block_;
  std::uint64_t done_ = 0;
  bool at_end_ = false;
};

constexpr std::uint64_t nowhere = std::numeric_limits<std::uint64_t>::max();

/// What those processes say of which `wrong` is the first, to all of them; some process must.
FileError agreed(Processes& processes, bool is_first, const std::optional<FileError>& wrong) {
  std::uint64_t teller = is_first ? processes.rank() : nowhere;
  processes.smallest(std::span(&teller, 1));
  return {processes.text_of(teller, is_first ? wrong->message : std::string())};
}

/// Every process goes on until none can meet an error before the first one met: the error of a single process.
std::optional<FileError> walk_all(Walk& walk, Processes& processes) {
  std::optional<FileError> wrong;
  while (true) {
    const bool working = !wrong && !walk.at_end();
    const std::uint64_t unit = walk.stream().unit();
    std::array<std::uint64_t, 2> first = {wrong ? unit : nowhere, working ? unit : nowhere};
    processes.smallest(first);
    const auto [first_error, first_working] = first;
    if (first_error != nowhere && first_error <= first_working) {
      return agreed(processes, wrong && unit == first_error, wrong);
    }
    if (first_working == nowhere) return std::nullopt;
    if (working) wrong = walk.step();
  }
}

/// The files, the same for all processes.
std::variant<std::vector<QueryFile>, FileError> find_files(const EvaluationRequest& request, Processes& processes) {
  auto found = find_query_files(request.paths, request.kind);
  std::optional<FileError> wrong;
  std::string list;
  if (const auto* error = std::get_if<FileError>(&found)) {
    wrong = *error;
  } else {
    for (const QueryFile& file : std::get<std::vector<QueryFile>>(found)) list += file.path.string() + "\n";
  }
  const bool same = processes.text_of(0, list) == list;
  if (!wrong && !same) wrong = FileError{"the processes of this command do not see the same files"};
  std::uint64_t unharmed = wrong ? 0 : 1;
  processes.smallest(std::span(&unharmed, 1));
  if (unharmed == 0) return agreed(processes, wrong.has_value(), wrong);
  return found;
}

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

std::variant<Evaluation, FileError> evaluate(const EvaluationRequest& request, Processes& processes) {
  auto found = find_files(request, processes);
  if (auto* wrong = std::get_if<FileError>(&found)) return *wrong;
  Walk walk(request, std::get<std::vector<QueryFile>>(std::move(found)), processes);
  if (auto wrong = walk_all(walk, processes)) return *wrong;
  std::uint64_t queries = walk.done();
  processes.sum(std::span(&queries, 1));
  if (queries == 0) return walk.stream().no_queries();
  return walk.evaluator().result(walk.stream().rounded(), processes);
}

std::variant<Evaluation, FileError> evaluate(const EvaluationRequest& request) {
  SingleProcess alone;
  return evaluate(request, alone);
}

}  // namespace tightrope::ccd
