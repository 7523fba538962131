/// Batches on every instruction set against single queries, on as many queries as wanted: all methods, both kinds,
/// double and float, all layouts in turn. Run: batch_campaign [queries of each kind and type, 2,500,000 if not given:
/// 10^7 in all].
///
/// A tenth of the queries are cloth-fold's and every other scene's, the rest are those again with axes permuted and
/// mirrored, scaled by powers of two, and every coordinate moved by a few units in the last place.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "tightrope/batch.h"

namespace {

using namespace tightrope::ccd;

constexpr std::size_t numbers = 24;
constexpr std::size_t block = 65'536;

/// A tenth of the queries: half of them cloth, the others of all scenes.
std::vector<double> base_queries(Kind kind, std::size_t count) {
  std::vector<double> points(numbers * count);
  const std::size_t each = count / 2 / scenes().size(), cloth = count - each * scenes().size();
  const std::span<double> all(points);
  generate(Scene::cloth_fold, kind, cloth, 77)->fill(all.first(numbers * cloth));
  std::size_t next = numbers * cloth;
  for (const SceneInfo& info : scenes()) {
    generate(info.scene, kind, each, 78)->fill(all.subspan(next, numbers * each));
    next += numbers * each;
  }
  return points;
}

template <class Real>
void vary(const double* query, Real* varied, std::mt19937_64& random) {
  std::array<std::size_t, 3> axes{0, 1, 2};
  std::shuffle(axes.begin(), axes.end(), random);
  const std::uint64_t bits = random();
  const int scale = bits % 16 == 0 ? static_cast<int>(bits >> 8 & 63) - 32 : 0;
  const bool jitter = bits % 4 != 1;
  for (std::size_t point = 0; point < 8; ++point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto x = static_cast<Real>(std::ldexp(query[3 * point + axes[axis]], scale));
      if (bits >> (16 + axis) & 1) x = -x;
      const std::uint64_t steps = jitter ? random() % 7 : 3;
      for (std::uint64_t s = 3; s < steps; ++s) x = std::nextafter(x, std::numeric_limits<Real>::infinity());
      for (std::uint64_t s = steps; s < 3; ++s) x = std::nextafter(x, -std::numeric_limits<Real>::infinity());
      varied[3 * point + axis] = x;
    }
  }
}

/// Answers of one block on every instruction set; returns how many differ from those one by one.
template <class Real>
std::size_t differences(Kind kind, const std::vector<Real>& points, Method method, bool by_coordinate) {
  const std::size_t count = points.size() / numbers;
  std::vector<Real> rows;
  Queries<Real> queries{kind, count, points.data()};
  if (by_coordinate) {
    rows.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) rows[i % numbers * count + i / numbers] = points[i];
    queries = {kind, count, rows.data(), Layout::by_coordinate, count};
  }
  std::vector<unsigned char> expected(count), answers(count);
  collides(kind, points.data(), count, expected.data(), method);
  std::size_t different = 0;
  for (const InstructionSet instructions : instruction_sets()) {
    for (const Arithmetic arithmetic : {Arithmetic::separate, Arithmetic::fused}) {
      const BatchOptions options{
          .method = method, .threads = 0, .instructions = instructions, .arithmetic = arithmetic};
      if (collides(queries, answers.data(), options) != BatchStatus::done) {
        if (arithmetic == Arithmetic::separate) different += count;
        continue;
      }
      for (std::size_t i = 0; i < count; ++i) different += answers[i] != expected[i] ? 1 : 0;
    }
  }
  return different;
}

/// The differences of all methods, and how many queries there were.
template <class Real>
std::size_t run(Kind kind, const std::vector<double>& base, std::size_t count, const char* real) {
  std::mt19937_64 random(79);
  std::vector<std::size_t> different(methods().size());
  for (std::size_t done = 0; done < count;) {
    const std::size_t here = std::min(block, count - done);
    std::vector<Real> points(numbers * here);
    for (std::size_t i = 0; i < here; ++i) {
      vary(&base[numbers * ((done + i) % (base.size() / numbers))], &points[numbers * i], random);
    }
    for (std::size_t m = 0; m < different.size(); ++m) {
      different[m] += differences(kind, points, methods()[m].method, done / block % 2 == 1);
    }
    done += here;
  }
  std::size_t sum = 0;
  for (std::size_t m = 0; m < different.size(); ++m) {
    std::printf("%-10s %s %s: %zu queries on %zu instruction sets, %zu answers differ\n",
                std::string(methods()[m].name).c_str(), std::string(name(kind)).c_str(), real, count,
                instruction_sets().size(), different[m]);
    sum += different[m];
  }
  std::fflush(stdout);
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 2'500'000;
  if (count < 1000) {
    std::fprintf(stderr, "usage: batch_campaign [QUERIES], 1000 or more\n");
    return 2;
  }
  std::size_t different = 0;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const std::vector<double> base = base_queries(kind, count / 10);
    different += run<double>(kind, base, count, "double");
    different += run<float>(kind, base, count, "float");
  }
  return different == 0 ? 0 : 1;
}
