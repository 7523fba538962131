/// fitted_check KIND FILE ...: the fitted queries against the full ones on the queries in FILE, 24 numbers of type double
/// each, as this machine has them in memory. Exit status 1 if the fit misses a contact.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <vector>

#include "fitted.h"

namespace {

using tightrope::ccd::Kind;

std::vector<double> read(const char* path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<double> numbers(file ? static_cast<std::size_t>(file.tellg()) / sizeof(double) / 24 * 24 : 0);
  file.seekg(0);
  file.read(reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(numbers.size() * sizeof(double)));
  return numbers;
}

template <class Pass>
double nanoseconds(const Pass& pass) {
  const auto start = std::chrono::steady_clock::now();
  pass();
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double>& values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// The number of missed contacts; prints all there is to say.
template <class Real>
std::size_t compare(Kind kind, const char* path, void (*fitted)(const Real*, std::size_t, unsigned char*)) {
  const std::vector<double> points = read(path);
  const std::vector<Real> fitted_points(points.begin(), points.end());
  const std::size_t count = points.size() / 24;
  if (count == 0) {
    std::printf("%s: no queries\n", path);
    return 1;
  }
  std::vector<unsigned char> full_answers(count), answers(count);
  // Both take turns at blocks of queries: few passes are interrupted by whatever else the machine does. Every round goes
  // through all blocks: branch prediction cannot learn a block by heart.
  const std::size_t few = std::min<std::size_t>(count, 256);
  const double slow = nanoseconds([&] { fitted(fitted_points.data(), few, answers.data()); }) / static_cast<double>(few);
  const auto block = static_cast<std::size_t>(std::clamp(1e5 / slow, 16.0, 2048.0));
  const std::size_t blocks = (count + block - 1) / block;
  std::vector<std::vector<double>> full_times(blocks), times(blocks);
  for (int round = 0; round < 31; ++round) {
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::size_t first = b * block, n = std::min(block, count - first);
      full_times[b].push_back(nanoseconds([&] {
        collides(kind, &points[24 * first], n, &full_answers[first], tightrope::ccd::Method::tightrope);
      }));
      times[b].push_back(nanoseconds([&] { fitted(&fitted_points[24 * first], n, &answers[first]); }));
    }
  }
  double full_time = 0, time = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    full_time += median(full_times[b]) / static_cast<double>(count);
    time += median(times[b]) / static_cast<double>(count);
  }
  std::size_t misses = 0, false_positives = 0;
  for (std::size_t i = 0; i < count; ++i) {
    misses += answers[i] < full_answers[i] ? 1 : 0;
    false_positives += answers[i] > full_answers[i] ? 1 : 0;
  }
  std::printf("%s: %zu queries, %zu misses, %zu false positives; full %.1f ns, fitted %.1f ns a query: %.2f times as fast\n",
              kind == Kind::vertex_face ? "vertex-face" : "edge-edge", count, misses, false_positives, full_time, time,
              full_time / time);
  return misses;
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t misses = argc < 3 ? 1 : 0;
  for (int i = 1; i + 1 < argc; i += 2) {
    bool known = false;
    if (std::strcmp(argv[i], "vertex-face") == 0) {
      misses += compare<double>(Kind::vertex_face, argv[i + 1], fitted_vertex_face);
      known = true;
    }
    if (std::strcmp(argv[i], "edge-edge") == 0) {
      misses += compare<double>(Kind::edge_edge, argv[i + 1], fitted_edge_edge);
      known = true;
    }
    if (!known) misses += 1;
  }
  return misses == 0 ? 0 : 1;
}
