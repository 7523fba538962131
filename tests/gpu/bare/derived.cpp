#include "derived.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

namespace tightrope::gpu_check {
namespace {

/// splitmix64 [Steele, Lea, Flood 2014].
class Random {
 public:
  explicit Random(std::uint64_t state) : state_(state) {}
  std::uint64_t operator()() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9U;
    z = (z ^ z >> 27) * 0x94d049bb133111ebU;
    return z ^ z >> 31;
  }

 private:
  std::uint64_t state_;
};

}  // namespace

std::vector<QuerySet> query_sets(const std::string& folder) {
  std::vector<QuerySet> sets;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    for (const ccd::Kind kind : {ccd::Kind::vertex_face, ccd::Kind::edge_edge}) {
      const std::string ending = "." + std::string(ccd::name(kind)) + ".raw";
      if (name.size() <= ending.size() || name.substr(name.size() - ending.size()) != ending) continue;
      QuerySet set{name.substr(0, name.size() - ending.size()), kind, {}};
      set.points.resize(std::filesystem::file_size(entry.path()) / sizeof(double) / 24 * 24);
      std::ifstream file(entry.path(), std::ios::binary);
      file.read(reinterpret_cast<char*>(set.points.data()),
                static_cast<std::streamsize>(set.points.size() * sizeof(double)));
      if (file && !set.points.empty()) sets.push_back(std::move(set));
    }
  }
  std::sort(sets.begin(), sets.end(),
            [](const QuerySet& a, const QuerySet& b) { return std::pair(a.name, a.kind) < std::pair(b.name, b.kind); });
  return sets;
}

void derive(const std::vector<double>& pool, std::uint64_t seed, std::uint64_t number, bool jitter, double* points) {
  constexpr std::array<std::array<int, 3>, 6> permutations{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  Random random(seed * 0x2545f4914f6cdd1dU + number);
  random();
  const double* from = pool.data() + 24 * (random() % (pool.size() / 24));
  const auto& axes = permutations[random() % 6];
  const std::uint64_t signs = random();
  const double scale = std::ldexp(1.0, static_cast<int>(random() % 41) - 20);
  for (std::size_t i = 0; i < 24; ++i) {
    const double x = from[i / 3 * 3 + static_cast<std::size_t>(axes[i % 3])] * scale;
    points[i] = (signs >> i % 3 & 1U) != 0 ? -x : x;
  }
  if (!jitter || random() % 2 == 0) return;
  for (std::uint64_t moved = random() % 4 + 1; moved > 0; --moved) {
    double& x = points[random() % 24];
    for (std::uint64_t ulps = random() % 3 + 1; ulps > 0; --ulps) {
      x = std::nextafter(
          x, (signs & 8U) != 0 ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity());
    }
  }
}

std::vector<float> in_float(const std::vector<double>& points) {
  std::vector<float> result(points.size());
  std::transform(points.begin(), points.end(), result.begin(), [](double x) { return static_cast<float>(x); });
  return result;
}

}  // namespace tightrope::gpu_check
