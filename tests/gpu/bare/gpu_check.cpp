/// gpu_check PREPARED [--queries N] [--small] [--json FILE]
///
/// On a machine with a GPU: are the answers those of the processor, on the prepared queries and on N (10^7) made from
/// them; what happens when memory is short; and how fast is it, beside the limits of the device, measured here too.
/// --small: only the prepared queries, for compute-sanitizer. Exit status 1 if an answer differs.

#include <cuda_runtime.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "ccd/gpu/decide_open.h"
#include "derived.h"
#include "device_limits.h"
#include "tightrope/gpu.h"
#include "tightrope/plain.h"

namespace tightrope::gpu_check {
namespace {

using ccd::Kind;
using ccd::Layout;
using ccd::Method;
using ccd::Queries;

constexpr std::uint64_t seed = 20260801;
constexpr std::size_t grain = 1024;

void check(cudaError_t error) {
  if (error == cudaSuccess) return;
  std::fprintf(stderr, "gpu_check: %s\n", cudaGetErrorString(error));
  std::exit(1);
}

/// Memory of the device or, pinned, of the host.
template <class T>
class Buffer {
 public:
  Buffer(std::size_t count, bool pinned) : pinned_(pinned) {
    check(pinned ? cudaMallocHost(&start_, count * sizeof(T)) : cudaMalloc(&start_, count * sizeof(T)));
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() { pinned_ ? cudaFreeHost(start_) : cudaFree(start_); }
  T* get() const { return static_cast<T*>(start_); }

 private:
  void* start_ = nullptr;
  bool pinned_;
};

class Check {
 public:
  explicit Check(const std::string& json) {
    if (!json.empty()) json_.open(json);
    if (json_.is_open()) json_ << "{\"rows\": [";
  }
  ~Check() {
    if (json_.is_open()) json_ << "\n], \"mistakes\": " << mistakes << "}\n";
  }
  /// A line of the table, and of the JSON file.
  void row(const std::string& what, const std::string& method, const std::string& how,
           const std::vector<std::pair<std::string, double>>& numbers) {
    std::printf("%-26s %-11s %-26s", what.c_str(), method.c_str(), how.c_str());
    for (const auto& [name, x] : numbers) std::printf("  %s %.4g", name.c_str(), x);
    std::printf("\n");
    std::fflush(stdout);
    if (!json_.is_open()) return;
    json_ << (first_ ? "\n" : ",\n") << R"({"what": ")" << what << R"(", "method": ")" << method << R"(", "how": ")"
          << how << '"';
    for (const auto& [name, x] : numbers) json_ << ", \"" << name << "\": " << x;
    json_ << "}";
    first_ = false;
  }
  void mistake(const std::string& what) {
    ++mistakes;
    std::printf("MISTAKE: %s\n", what.c_str());
  }

  std::uint64_t mistakes = 0;

 private:
  std::ofstream json_;
  bool first_ = true;
};

template <class Real>
std::vector<unsigned char> on_processor(Kind kind, const std::vector<Real>& points, Method method) {
  std::vector<unsigned char> results(points.size() / 24);
  ccd::gpu::in_parts(results.size(), grain, 0, [&](std::size_t first, std::size_t count) {
    ccd::collides(kind, points.data() + 24 * first, count, results.data() + first, method);
  });
  return results;
}

template <class Real>
std::vector<Real> by_coordinate(const std::vector<Real>& points) {
  std::vector<Real> apart(points.size());
  const std::size_t count = points.size() / 24;
  for (std::size_t i = 0; i < points.size(); ++i) apart[i % 24 * count + i / 24] = points[i];
  return apart;
}

/// Host and device pointers, both layouts. Returns how many queries exact arithmetic decided.
template <class Real>
std::size_t compare(Check& check_, const std::string& what, Kind kind, const std::vector<Real>& points, Method method,
                    ccd::gpu::Workspace& workspace) {
  const std::size_t count = points.size() / 24;
  const std::vector<unsigned char> expected = on_processor(kind, points, method);
  const std::vector<Real> apart = by_coordinate(points);
  const ccd::gpu::Options options{.method = method, .threads = 0};
  ccd::gpu::Report report;
  for (const Layout layout : {Layout::by_query, Layout::by_coordinate}) {
    const std::vector<Real>& numbers = layout == Layout::by_query ? points : apart;
    std::vector<unsigned char> results(count, 9);
    const auto host = ccd::gpu::collides(Queries<Real>{kind, count, numbers.data(), layout, count}, results.data(),
                                         workspace, options, &report);
    if (!host) check_.mistake(what + ": " + host.text);
    if (results != expected) check_.mistake(what + ": answers differ, pointers of the host");
    const Buffer<Real> on_device(numbers.size(), false);
    const Buffer<unsigned char> device_results(count, false);
    check(cudaMemcpy(on_device.get(), numbers.data(), numbers.size() * sizeof(Real), cudaMemcpyHostToDevice));
    const auto device = ccd::gpu::collides_on_device(Queries<Real>{kind, count, on_device.get(), layout, count},
                                                     device_results.get(), workspace, nullptr, options);
    if (!device) check_.mistake(what + ": " + device.text);
    std::fill(results.begin(), results.end(), static_cast<unsigned char>(9));
    check(cudaMemcpy(results.data(), device_results.get(), count, cudaMemcpyDeviceToHost));
    if (results != expected) check_.mistake(what + ": answers differ, pointers of the device");
  }
  return report.open;
}

void compare_all(Check& check_, const std::string& what, Kind kind, const std::vector<double>& points,
                 ccd::gpu::Workspace& workspace) {
  const std::vector<float> single = in_float(points);
  for (const auto& method : ccd::methods()) {
    const std::string name(method.name);
    const auto numbers = [&](std::size_t open) {
      return std::vector<std::pair<std::string, double>>{{"queries", static_cast<double>(points.size() / 24)},
                                                         {"open", static_cast<double>(open)}};
    };
    const std::string kind_name(ccd::name(kind));
    const std::size_t open = compare(check_, what + " " + name, kind, points, method.method, workspace);
    check_.row("equality " + kind_name, name, what + " double", numbers(open));
    const std::size_t open_in_float =
        compare(check_, what + " " + name + " float", kind, single, method.method, workspace);
    check_.row("equality " + kind_name, name, what + " float", numbers(open_in_float));
  }
}

/// All queries of a kind that are prepared, one after another.
std::vector<double> pool_of(const std::vector<QuerySet>& sets, Kind kind, const std::string& only = "") {
  std::vector<double> pool;
  for (const QuerySet& set : sets) {
    if (set.kind == kind && (only.empty() || set.name == only)) {
      pool.insert(pool.end(), set.points.begin(), set.points.end());
    }
  }
  return pool;
}

std::vector<double> many(const std::vector<double>& pool, std::size_t count, std::uint64_t first, bool jitter) {
  std::vector<double> points(24 * count);
  ccd::gpu::in_parts(count, grain, 0, [&](std::size_t part, std::size_t length) {
    for (std::size_t i = part; i < part + length; ++i) derive(pool, seed, first + i, jitter, &points[24 * i]);
  });
  return points;
}

void compare_derived(Check& check_, const std::vector<QuerySet>& sets, std::size_t count,
                     ccd::gpu::Workspace& workspace) {
  constexpr std::size_t at_once = 1'000'000;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const std::vector<double> pool = pool_of(sets, kind);
    std::vector<std::size_t> open(ccd::methods().size());
    std::size_t done = 0;
    for (; done < count / 2; done += at_once) {
      const std::vector<double> points = many(pool, std::min(at_once, count / 2 - done), done, true);
      for (std::size_t m = 0; m < open.size(); ++m) {
        const auto& method = ccd::methods()[m];
        open[m] += compare(check_, "derived " + std::string(method.name), kind, points, method.method, workspace);
      }
      compare(check_, "derived tightrope float", kind, in_float(points), Method::tightrope, workspace);
    }
    for (std::size_t m = 0; m < open.size(); ++m) {
      check_.row("equality " + std::string(ccd::name(kind)), std::string(ccd::methods()[m].name), "derived double",
                 {{"queries", static_cast<double>(count / 2)}, {"open", static_cast<double>(open[m])}});
    }
  }
}

void short_of_memory(Check& check_, const std::vector<double>& points, ccd::gpu::Workspace& warm) {
  const std::size_t count = points.size() / 24;
  const Queries<double> queries{Kind::vertex_face, count, points.data()};
  const std::vector<unsigned char> expected = on_processor(Kind::vertex_face, points, Method::tightrope);
  std::vector<unsigned char> results(count);
  if (!ccd::gpu::collides(queries, results.data(), warm))
    check_.mistake("short of memory: not even before");  // loads all kernels
  warm.release();
  for (const std::size_t left : {std::size_t{32} << 20, std::size_t{8} << 20, std::size_t{0}}) {
    std::vector<void*> taken;
    for (std::size_t piece = std::size_t{1} << 40; piece >= std::size_t{1} << 20;) {
      std::size_t free = 0, all = 0;
      check(cudaMemGetInfo(&free, &all));
      void* memory = nullptr;
      if (free < left + piece || cudaMalloc(&memory, piece) != cudaSuccess) {
        cudaGetLastError();
        piece /= 2;
      } else {
        taken.push_back(memory);
      }
    }
    ccd::gpu::Workspace workspace;
    ccd::gpu::Report report;
    const auto result =
        ccd::gpu::collides(queries, results.data(), workspace, {.threads = 0, .chunk = 1U << 18}, &report);
    for (void* memory : taken) check(cudaFree(memory));
    if (result && results != expected) check_.mistake("short of memory: answers differ");
    if (!result && result.status != ccd::gpu::Status::out_of_memory)
      check_.mistake(std::string("short of memory: ") + result.text);
    check_.row("short of memory", "tightrope", result ? "done" : "out of memory",
               {{"MiB left", static_cast<double>(left >> 20)}, {"chunk", static_cast<double>(report.chunk)}});
    workspace.release();
    if (!ccd::gpu::collides(queries, results.data(), workspace) || results != expected) {
      check_.mistake("short of memory: not well again afterwards");
    }
  }
}

/// Median seconds of `run`, after one to warm up.
template <class Run>
double median_seconds(const Run& run) {
  std::vector<float> times;
  cudaEvent_t start, end;
  check(cudaEventCreate(&start));
  check(cudaEventCreate(&end));
  for (int i = 0; i < 6; ++i) {
    check(cudaEventRecord(start));
    run();
    check(cudaEventRecord(end));
    check(cudaEventSynchronize(end));
    float milliseconds = 0;
    check(cudaEventElapsedTime(&milliseconds, start, end));
    if (i > 0) times.push_back(milliseconds);
  }
  check(cudaEventDestroy(start));
  check(cudaEventDestroy(end));
  std::sort(times.begin(), times.end());
  return times[times.size() / 2] / 1e3;
}

/// Operations of the first stage of a generated header, for values and bounds; 0: not found.
double operations_of(const std::string& header) {
  std::ifstream file(header);
  double sum = 0;
  std::string line;
  for (int found = 0; found < 2 && std::getline(file, line);) {
    const std::size_t at = line.find("operations for ");
    if (at == std::string::npos) continue;
    sum += std::atof(line.c_str() + line.find_first_of("0123456789", at));
    ++found;
  }
  return sum;
}

/// Operations that every query costs at least: those of the method's first look.
double least_operations(const std::string& prepared, Method method, Kind kind) {
  const std::string folder = prepared + "/include/";
  if (method == Method::tightrope) return operations_of(folder + "separating_plane.safe.double.h");
  const std::string predicate = kind == Kind::vertex_face ? "vertex_face" : "edge_edge";
  return operations_of(folder + predicate + (method == Method::bsc_float ? ".float" : ".safe") + ".double.h");
}

struct Limits {
  double copy, upload, fma;
};

template <class Real>
void resident(Check& check_, const std::string& prepared, Kind kind, const std::vector<Real>& points,
              const Limits& limits, ccd::gpu::Workspace& workspace) {
  const std::size_t count = points.size() / 24;
  const Buffer<Real> together(points.size(), false), apart(points.size(), false);
  const Buffer<unsigned char> results(count, false);
  check(cudaMemcpy(together.get(), points.data(), points.size() * sizeof(Real), cudaMemcpyHostToDevice));
  transpose(together.get(), count, apart.get());
  for (const Layout layout : {Layout::by_coordinate, Layout::by_query}) {
    const Queries<Real> queries{kind, count, layout == Layout::by_query ? together.get() : apart.get(), layout, count};
    for (const auto& method : ccd::methods()) {
      for (const bool leave_open : {true, false}) {
        if (leave_open && !method.exact) continue;
        const ccd::gpu::Options options{.method = method.method, .threads = 0, .leave_open = leave_open};
        const double seconds = median_seconds([&] {
          const auto done = ccd::gpu::collides_on_device(queries, results.get(), workspace, nullptr, options);
          if (!done) check_.mistake(std::string("resident: ") + done.text);
        });
        const double rate = static_cast<double>(count) / seconds;
        const double bytes = 24 * sizeof(Real) + 1;
        std::vector<std::pair<std::string, double>> numbers{{"queries/s", rate},
                                                            {"of bandwidth", rate * bytes / limits.copy}};
        if (sizeof(Real) == sizeof(double)) {
          // Without fused operations half the peak is what there is.
          numbers.emplace_back("of FP64", rate * least_operations(prepared, method.method, kind) / (limits.fma / 2));
        }
        check_.row("resident " + std::string(ccd::name(kind)), std::string(method.name),
                   std::string(layout == Layout::by_query ? "by query" : "by coordinate") +
                       (sizeof(Real) == 8 ? " double" : " float") + (leave_open ? " open left" : ""),
                   numbers);
      }
    }
  }
}

void end_to_end(Check& check_, Kind kind, const std::vector<double>& points, const Limits& limits,
                ccd::gpu::Workspace& workspace) {
  const std::size_t count = points.size() / 24;
  const Buffer<double> pinned(points.size(), true);
  const Buffer<unsigned char> pinned_results(count, true);
  std::vector<unsigned char> results(count);
  std::copy(points.begin(), points.end(), pinned.get());
  for (const bool is_pinned : {true, false}) {
    const Queries<double> queries{kind, count, is_pinned ? pinned.get() : points.data()};
    for (const Method method : {Method::tight, Method::tightrope}) {
      const double seconds = median_seconds([&] {
        const auto done = ccd::gpu::collides(queries, is_pinned ? pinned_results.get() : results.data(), workspace,
                                             {.method = method, .threads = 0});
        if (!done) check_.mistake(std::string("end to end: ") + done.text);
      });
      const double rate = static_cast<double>(count) / seconds;
      check_.row("from host " + std::string(ccd::name(kind)), std::string(ccd::name(method)),
                 is_pinned ? "pinned" : "not pinned",
                 {{"queries/s", rate}, {"of PCIe", rate * 24 * sizeof(double) / limits.upload}});
    }
  }
}

int run(const std::string& prepared, std::size_t count, bool small, const std::string& json) {
  Check check_(json);
  const auto devices = ccd::gpu::device_count();
  if (devices.count == 0) {
    std::printf("gpu_check: no device: %s\n", devices.result.text);
    return 2;
  }
  const auto device = ccd::gpu::device(0);
  std::printf("%s, compute capability %d.%d, %d multiprocessors, %.1f GiB\n", device->name,
              device->compute_capability / 10, device->compute_capability % 10, device->multiprocessors,
              static_cast<double>(device->memory) / (1U << 30));
  const std::vector<QuerySet> sets = query_sets(prepared + "/queries");
  if (sets.empty()) {
    std::printf("gpu_check: no queries in %s/queries\n", prepared.c_str());
    return 2;
  }
  ccd::gpu::Workspace workspace;
  for (const QuerySet& set : sets) {
    std::vector<double> points = set.points;
    constexpr std::size_t few = 500;
    if (small && points.size() > 24 * few) points.resize(24 * few);
    compare_all(check_, set.name, set.kind, points, workspace);
  }
  if (!small) {
    compare_derived(check_, sets, count, workspace);
    short_of_memory(check_, many(pool_of(sets, Kind::vertex_face), 1U << 19, 0, true), workspace);
    const Limits limits{copy_bytes_per_second(), upload_bytes_per_second(), fma_operations_per_second()};
    check_.row(
        "limits", "", "",
        {{"copy GB/s", limits.copy / 1e9}, {"upload GB/s", limits.upload / 1e9}, {"FP64 GFLOP/s", limits.fma / 1e9}});
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      const std::vector<double> points = many(pool_of(sets, kind, "cloth-fold"), count, 0, false);
      resident(check_, prepared, kind, points, limits, workspace);
      resident(check_, prepared, kind, in_float(points), limits, workspace);
      end_to_end(check_, kind, points, limits, workspace);
    }
  }
  std::printf("%s: %llu mistakes\n", check_.mistakes == 0 ? "PASSED" : "FAILED",
              static_cast<unsigned long long>(check_.mistakes));
  return check_.mistakes == 0 ? 0 : 1;
}

}  // namespace
}  // namespace tightrope::gpu_check

int main(int argc, char** argv) {
  std::string prepared, json;
  std::size_t count = 10'000'000;
  bool small = false;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--queries" && i + 1 < argc) {
      count = std::strtoull(argv[++i], nullptr, 10);
    } else if (argument == "--json" && i + 1 < argc) {
      json = argv[++i];
    } else if (argument == "--small") {
      small = true;
    } else {
      prepared = argument;
    }
  }
  if (prepared.empty() || count == 0) {
    std::fprintf(stderr, "usage: gpu_check PREPARED [--queries N] [--small] [--json FILE]\n");
    return 2;
  }
  return tightrope::gpu_check::run(prepared, count, small, json);
}
