#include "limit_bench.h"

#include <benchmark/benchmark.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <memory>
#include <new>
#include <string>

#include "limits.h"

namespace tightrope::bench {
namespace {

using ccd::InstructionSet;

/// Far larger than the caches, made when it is first asked for. On large pages where there are some: the limit is that
/// of the machine, and some of it is lost to the pages of 4 KiB that most programs have.
std::span<const double> large_array() {
  constexpr std::size_t count = std::size_t{32} << 20;  // 256 MiB
  constexpr std::align_val_t large_page{std::size_t{2} << 20};
  struct Free {
    void operator()(double* numbers) const { ::operator delete[](numbers, large_page); }
  };
  static const std::unique_ptr<double[], Free> numbers = [] {
    std::unique_ptr<double[], Free> array(new (large_page) double[count]);
#if defined(__linux__)
    madvise(array.get(), count * sizeof(double), MADV_HUGEPAGE);  // a wish: without it reading is slower
#endif
    for (std::size_t i = 0; i < count; ++i) array[i] = static_cast<double>(i % 3);
    return array;
  }();
  return {numbers.get(), count};
}

/// Calls run(task) for every task 0 .. tasks - 1, on `threads` threads as a batch does.
template <class Run>
void on_threads(int threads, std::size_t tasks, const Run& run) {
  if (threads == 1) {
    for (std::size_t task = 0; task < tasks; ++task) run(task);
    return;
  }
  oneapi::tbb::task_arena arena(threads);
  arena.execute([&] { oneapi::tbb::parallel_for(std::size_t{0}, tasks, run); });
}

void time_reads(benchmark::State& state, const LimitKernels& kernels, int threads) {
  const auto numbers = large_array();
  const ReadKernel read = fastest(kernels.reads, numbers);
  const std::size_t tasks = threads == 1 ? 1 : 64 * static_cast<std::size_t>(threads);
  const std::size_t each = numbers.size() / tasks / read_granularity * read_granularity;
  for (auto _ : state) {
    on_threads(threads, tasks, [&](std::size_t task) {
      double sum = read(numbers.data() + task * each, each);
      benchmark::DoNotOptimize(sum);
    });
  }
  state.counters["bytes"] = static_cast<double>(tasks * each * sizeof(double));
}

template <class Real>
void time_arithmetic(benchmark::State& state, std::span<const ArithmeticKernel<Real>> kernels, int threads) {
  const ArithmeticKernel<Real> kernel = fastest(kernels);
  const std::size_t tasks = threads == 1 ? 1 : 64 * static_cast<std::size_t>(threads);
  constexpr std::size_t steps = 40'000;
  for (auto _ : state) {
    on_threads(threads, tasks, [&](std::size_t) {
      Real sum = kernel.run(Real{0.5}, Real{1}, steps);
      benchmark::DoNotOptimize(sum);
    });
  }
  state.counters["operations"] = static_cast<double>(tasks * steps * kernel.operations_per_step());
}

template <class Time>
void add(const std::string& label, InstructionSet instructions, int threads, Time time) {
  const std::string text = "limit/" + label + "/" + std::string(ccd::name(instructions));
  auto* benchmark = benchmark::RegisterBenchmark((text + "/threads:" + std::to_string(threads)).c_str(),
                                                 [=](benchmark::State& state) { time(state, threads); });
  benchmark->Unit(benchmark::kMillisecond);
  if (threads > 1) benchmark->MeasureProcessCPUTime()->UseRealTime();
}

void add_arithmetic(const std::string& label, const LimitKernels& kernels, InstructionSet instructions, int threads) {
  add(label + "/double", instructions, threads,
      [&kernels](benchmark::State& state, int n) { time_arithmetic(state, kernels.doubles, n); });
  add(label + "/float", instructions, threads,
      [&kernels](benchmark::State& state, int n) { time_arithmetic(state, kernels.floats, n); });
}

}  // namespace

void register_limits(std::span<const int> numbers_of_threads) {
  for (const int threads : numbers_of_threads) {
    for (const InstructionSet instructions : ccd::instruction_sets()) {
      if (const LimitKernels* kernels = limit_kernels(instructions)) {
        add("read", instructions, threads,
            [kernels](benchmark::State& state, int n) { time_reads(state, *kernels, n); });
        add_arithmetic("arithmetic", *kernels, instructions, threads);
      }
      if (const LimitKernels* kernels = fused_limit_kernels(instructions)) {
        add_arithmetic("fused", *kernels, instructions, threads);
      }
    }
  }
}

}  // namespace tightrope::bench
