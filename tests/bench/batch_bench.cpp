/// Batches of queries: every method, kind, precision and instruction set, and from there layouts, queries a call,
/// results and numbers of threads, each alone; beside them what the machine can do at most. table.py makes a table of
/// the JSON.
///
///   batch_bench [--queries=N] [--kept=FOLDER] [Google Benchmark's options]
///
/// N: queries of cloth-fold of each kind, 10^6 unless said: 192 MB, beyond every cache. FOLDER keeps the generated
/// queries for the next run. A batch whose results are not those of the queries one by one is an error.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <type_traits>
#include <vector>

#include "limit_bench.h"
#include "limits.h"
#include "query_sets.h"

namespace {

using namespace tightrope;
using namespace tightrope::ccd;

enum class Source { cloth_fold, grazing, samples };
enum class Shape { by_query, by_coordinate, mesh };
enum class Result { bytes, bits, times };

std::string_view name(Source source) {
  switch (source) {
    case Source::cloth_fold:
      return "cloth-fold";
    case Source::grazing:
      return "grazing";
    case Source::samples:
      return "samples";
  }
  return {};
}

std::string_view name(Shape shape) {
  switch (shape) {
    case Shape::by_query:
      return "by-query";
    case Shape::by_coordinate:
      return "by-coordinate";
    case Shape::mesh:
      return "mesh";
  }
  return {};
}

std::string_view name(Result result) {
  switch (result) {
    case Result::bytes:
      return "bytes";
    case Result::bits:
      return "bits";
    case Result::times:
      return "times";
  }
  return {};
}

struct Case {
  Source source;
  Kind kind;
  bool single = false;
  Shape shape = Shape::by_query;
  Result result = Result::bytes;
  Method method = Method::tightrope;
  InstructionSet instructions = InstructionSet::scalar;
  Arithmetic arithmetic = Arithmetic::separate;
  int threads = 1;
  std::size_t each = 0;  ///< queries a call, one call after another; 0: all in one
};

struct Options {
  std::size_t queries = 1'000'000;
  std::string kept;
};

/// The queries of all sources and what they answer one by one, each made when it is first asked for.
class Sets {
 public:
  explicit Sets(Options options) : options_(std::move(options)) {}

  template <class Real>
  bench::QuerySet<Real>& queries(Source source, Kind kind) {
    auto& set = sets<Real>()[{source, kind}];
    if (!set) set = std::make_unique<bench::QuerySet<Real>>(kind, points(source, kind));
    return *set;
  }

  template <class Real>
  const std::vector<unsigned char>& answers(Source source, Kind kind, Method method) {
    auto& answers = answers_[{source, kind, method, sizeof(Real)}];
    if (answers.empty()) {
      const auto queries = this->queries<Real>(source, kind).by_query();
      answers.resize(queries.count);
      collides(kind, queries.points, queries.count, answers.data(), method);
    }
    return answers;
  }

 private:
  template <class Real>
  auto& sets() {
    if constexpr (std::is_same_v<Real, double>) {
      return doubles_;
    } else {
      return floats_;
    }
  }

  std::vector<double> points(Source source, Kind kind) const {
    switch (source) {
      case Source::cloth_fold:
        return bench::scene_points(Scene::cloth_fold, kind, options_.queries, options_.kept);
      case Source::grazing:  // a hundred times slower: fewer do
        return bench::scene_points(Scene::grazing, kind, std::max<std::size_t>(options_.queries / 10, 1), "");
      case Source::samples:
        return bench::sample_points(kind);
    }
    return {};
  }

  using Key = std::tuple<Source, Kind>;
  Options options_;
  std::map<Key, std::unique_ptr<bench::QuerySet<double>>> doubles_;
  std::map<Key, std::unique_ptr<bench::QuerySet<float>>> floats_;
  std::map<std::tuple<Source, Kind, Method, std::size_t>, std::vector<unsigned char>> answers_;
};

/// Room for the results of a case, calls of the batch, and whether they got right what was asked.
class Call {
 public:
  Call(const Case& what, std::size_t count) : what_(what), count_(count) {
    what.result == Result::times ? times_.resize(count) : bytes_.resize(count);
  }

  /// The queries are those from `first` on; a multiple of 8 where bits are wanted.
  template <class Queries>
  BatchStatus operator()(const Queries& queries, std::size_t first) {
    const BatchOptions options{what_.method, what_.threads, what_.instructions, what_.arithmetic};
    switch (what_.result) {
      case Result::bytes:
        return collides(queries, bytes_.data() + first, options);
      case Result::bits:
        return collides_bits(queries, bytes_.data() + first / 8, options);
      case Result::times:
        return impact_times(queries, times_.data() + first, {}, options);
    }
    return BatchStatus::invalid_argument;
  }

  bool reports(std::size_t i) const {
    switch (what_.result) {
      case Result::bytes:
        return bytes_[i] == 1;
      case Result::bits:
        return ((bytes_[i / 8] >> (i % 8)) & 1) == 1;
      case Result::times:
        return std::isfinite(times_[i]);
    }
    return false;
  }

  std::size_t reported() const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < count_; ++i) sum += reports(i) ? 1 : 0;
    return sum;
  }

  bool agrees(const std::vector<unsigned char>& answers) const {
    for (std::size_t i = 0; i < count_; ++i) {
      if (reports(i) != (answers[i] == 1)) return false;
    }
    return true;
  }

 private:
  Case what_;
  std::size_t count_;
  std::vector<unsigned char> bytes_;
  std::vector<double> times_;
};

template <class Real>
void run(benchmark::State& state, Sets& sets, const Case& what) {
  auto& set = sets.queries<Real>(what.source, what.kind);
  Call call(what, set.count());
  BatchStatus status = BatchStatus::done;
  const auto time = [&](const auto& call_all) {
    for (auto _ : state) {
      call_all();
      benchmark::ClobberMemory();
    }
  };
  double bytes_per_query = 24 * sizeof(Real);
  switch (what.shape) {
    case Shape::by_query:
      time([&, each = what.each == 0 ? set.count() : what.each] {
        for (std::size_t first = 0; first < set.count(); first += each) {
          status = std::max(status, call(set.by_query(first, std::min(each, set.count() - first)), first));
        }
      });
      break;
    case Shape::by_coordinate:
      time([&, queries = set.by_coordinate()] { status = call(queries, 0); });
      break;
    case Shape::mesh:
      time([&, queries = set.of_mesh()] { status = call(queries, 0); });
      bytes_per_query = 16 + static_cast<double>(6 * sizeof(Real) * set.vertices()) / static_cast<double>(set.count());
      break;
  }
  if (status != BatchStatus::done) state.SkipWithError("the batch was refused");
  // Contact in the sense of the times of safe and safe-tight is wider than that of their answers.
  const bool comparable = what.result != Result::times || what.method == Method::tightrope;
  if (comparable && !call.agrees(sets.answers<Real>(what.source, what.kind, what.method))) {
    state.SkipWithError("not the answers of the queries one by one");
  }
  state.counters["queries"] = static_cast<double>(set.count());
  state.counters["bytes_per_query"] = bytes_per_query;
  state.counters["reported"] = static_cast<double>(call.reported());
  state.counters["per_query"] = benchmark::Counter(
      static_cast<double>(set.count()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

std::string label(const Case& what) {
  std::string text = "batch";
  for (const std::string_view part :
       {name(what.source), name(what.kind), std::string_view(what.single ? "float" : "double"), name(what.shape),
        name(what.result), name(what.method), name(what.instructions)}) {
    text.append("/").append(part);
  }
  if (what.arithmetic == Arithmetic::fused) text.append("/fused");
  text.append("/threads:").append(std::to_string(what.threads));
  if (what.each != 0) text.append("/each:").append(std::to_string(what.each));
  return text;
}

void add(Sets& sets, const Case& what) {
  auto* benchmark = benchmark::RegisterBenchmark(label(what).c_str(), [&sets, what](benchmark::State& state) {
    what.single ? run<float>(state, sets, what) : run<double>(state, sets, what);
  });
  benchmark->Unit(benchmark::kMillisecond);
  if (what.threads > 1) benchmark->MeasureProcessCPUTime()->UseRealTime();
}

/// 1, 2, 4, .., and all processors.
std::vector<int> numbers_of_threads() {
  const int most = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<int> numbers;
  for (int threads = 1; threads < most; threads *= 2) numbers.push_back(threads);
  numbers.push_back(most);
  return numbers;
}

constexpr Method compared[] = {Method::tight, Method::tightrope};

/// All methods and instruction sets on cloth, one thread.
void add_methods(Sets& sets, Kind kind) {
  for (const bool single : {false, true}) {
    for (const MethodInfo& info : methods()) {
      for (const InstructionSet instructions : instruction_sets()) {
        Case what{Source::cloth_fold, kind, single};
        what.method = info.method;
        what.instructions = instructions;
        add(sets, what);
        if (info.method != Method::tightrope || bench::fused_limit_kernels(instructions) == nullptr) continue;
        what.arithmetic = Arithmetic::fused;
        add(sets, what);
      }
    }
  }
}

/// With the best instructions: layouts, queries a call, results, threads, one of them changed at a time.
void add_shapes(Sets& sets, Kind kind, std::size_t most) {
  const InstructionSet best = instruction_sets().back();
  for (const Method method : compared) {
    Case what{Source::cloth_fold, kind};
    what.method = method;
    what.instructions = best;
    for (const Shape shape : {Shape::by_coordinate, Shape::mesh}) {
      Case other = what;
      other.shape = shape;
      add(sets, other);
    }
    for (std::size_t each = 10; each < most; each *= 10) {
      Case other = what;
      other.each = each;
      add(sets, other);
    }
    Case bits = what;
    bits.result = Result::bits;
    add(sets, bits);
  }
  for (const Method method : {Method::safe, Method::safe_tight, Method::tightrope}) {
    Case what{Source::cloth_fold, kind};
    what.result = Result::times;
    what.method = method;
    what.instructions = best;
    add(sets, what);
  }
  for (const int threads : numbers_of_threads()) {
    for (const MethodInfo& info : methods()) {
      if (threads == 1) continue;  // there already
      Case what{Source::cloth_fold, kind};
      what.method = info.method;
      what.instructions = best;
      what.threads = threads;
      add(sets, what);
    }
  }
}

/// Harder queries, one by one and with the best instructions.
void add_sources(Sets& sets, Kind kind) {
  for (const Source source : {Source::grazing, Source::samples}) {
    if (source == Source::samples && sets.queries<double>(source, kind).count() == 0) continue;
    for (const MethodInfo& info : methods()) {
      std::vector<InstructionSet> both{InstructionSet::scalar};
      if (instruction_sets().back() != InstructionSet::scalar) both.push_back(instruction_sets().back());
      for (const InstructionSet instructions : both) {
        Case what{source, kind};
        what.method = info.method;
        what.instructions = instructions;
        add(sets, what);
      }
    }
  }
}

/// Takes the options of this program out of the command line; false: one of them is wrong.
bool take_options(int& argc, char** argv, Options& options) {
  int left = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    constexpr std::string_view queries = "--queries=", kept = "--kept=";
    if (argument.starts_with(queries)) {
      const char *first = argument.data() + queries.size(), *last = argument.data() + argument.size();
      const auto [end, error] = std::from_chars(first, last, options.queries);
      if (error != std::errc() || end != last || options.queries == 0) return false;
    } else if (argument.starts_with(kept)) {
      options.kept = argument.substr(kept.size());
    } else {
      argv[left++] = argv[i];
    }
  }
  argc = left;
  return true;
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!take_options(argc, argv, options)) {
    std::cerr << "batch_bench: --queries wants a positive number\n";
    return 2;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("processor", processor());
  benchmark::AddCustomContext("compiler", TIGHTROPE_COMPILER);
  Sets sets(options);
  bench::register_limits(numbers_of_threads());
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    add_methods(sets, kind);
    add_shapes(sets, kind, options.queries);
    add_sources(sets, kind);
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
