/// Batches give every query the answer that it gets alone, to the bit: whatever the instructions, the threads, the
/// layout and the neighbours.

#include "tightrope/batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <string>

#include "ccd/batch/filter.h"
#include "query_sets.h"
#include "tightrope/contact.h"

namespace tightrope::ccd {
namespace {

using test::mixed_queries;
using test::numbers;

constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};
constexpr std::size_t each = 131;  // of 32 scenes: 4,192 queries, more than a chunk

/// The same queries, number by number, with room between the rows.
template <class Real>
std::vector<Real> by_coordinate(const std::vector<Real>& points, std::size_t pitch) {
  std::vector<Real> result(numbers * pitch);
  for (std::size_t i = 0; i < points.size() / numbers; ++i) {
    for (std::size_t c = 0; c < numbers; ++c) result[c * pitch + i] = points[numbers * i + c];
  }
  return result;
}

/// The same queries as a mesh in which no vertex is shared and none is in its place.
template <class Real>
struct Mesh {
  std::vector<Real> t0, t1;
  std::vector<std::uint32_t> indices;

  explicit Mesh(const std::vector<Real>& points) {
    const std::size_t vertices = points.size() / 6;
    t0.resize(3 * vertices);
    t1.resize(3 * vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
      const std::size_t place = vertices - 1 - v;
      const Real* query = points.data() + numbers * (v / 4);
      std::copy_n(query + 3 * (v % 4), 3, &t0[3 * place]);
      std::copy_n(query + 12 + 3 * (v % 4), 3, &t1[3 * place]);
      indices.push_back(static_cast<std::uint32_t>(place));
    }
  }
};

template <class Real>
std::vector<unsigned char> one_by_one(Kind kind, const std::vector<Real>& points, Method method) {
  std::vector<unsigned char> answers;
  for (std::size_t i = 0; i < points.size() / numbers; ++i) {
    answers.push_back(collides(kind, points.data() + numbers * i, method) ? 1 : 0);
  }
  return answers;
}

/// Bytes around the results, which nobody may touch.
class Guarded {
 public:
  explicit Guarded(std::size_t size) : bytes_(size + 2 * margin, mark) {}
  unsigned char* results() { return bytes_.data() + margin; }
  std::vector<unsigned char> checked() const {
    const auto is_mark = [](unsigned char byte) { return byte == mark; };
    EXPECT_TRUE(std::all_of(bytes_.begin(), bytes_.begin() + margin, is_mark));
    EXPECT_TRUE(std::all_of(bytes_.end() - margin, bytes_.end(), is_mark));
    return {bytes_.begin() + margin, bytes_.end() - margin};
  }

 private:
  static constexpr std::ptrdiff_t margin = 64;
  static constexpr unsigned char mark = 0xA5;
  std::vector<unsigned char> bytes_;
};

template <class Source>
void expect_answers(const Source& queries, const BatchOptions& options, const std::vector<unsigned char>& expected) {
  Guarded bytes(queries.count);
  ASSERT_EQ(collides(queries, bytes.results(), options), BatchStatus::done);
  EXPECT_EQ(bytes.checked(), expected);
  Guarded bits((queries.count + 7) / 8);
  ASSERT_EQ(collides_bits(queries, bits.results(), options), BatchStatus::done);
  const auto packed = bits.checked();
  for (std::size_t i = 0; i < 8 * packed.size(); ++i) {
    ASSERT_EQ(packed[i / 8] >> (i % 8) & 1, i < queries.count ? expected[i] : 0) << i;
  }
}

template <class Real>
void expect_same_answers(Kind kind, Method method) {
  const std::vector<Real> points = mixed_queries<Real>(kind, each, 7);
  const std::size_t count = points.size() / numbers, pitch = count + 5;
  const std::vector<Real> rows = by_coordinate(points, pitch);
  const Mesh<Real> mesh(points);
  const std::vector<unsigned char> expected = one_by_one(kind, points, method);
  ASSERT_GT(std::count(expected.begin(), expected.end(), 1), 200);
  ASSERT_GT(std::count(expected.begin(), expected.end(), 0), 200);
  for (const InstructionSet instructions : instruction_sets()) {
    SCOPED_TRACE(std::string(name(instructions)));
    const BatchOptions options{.method = method, .instructions = instructions};
    expect_answers(Queries<Real>{kind, count, points.data()}, options, expected);
    expect_answers(Queries<Real>{kind, count, rows.data(), Layout::by_coordinate, pitch}, options, expected);
    expect_answers(MeshQueries<Real>{kind, count, mesh.t0.data(), mesh.t1.data(), mesh.indices.data()}, options,
                   expected);
  }
}

/// Fused first tests leave other queries for the later ones; the answers are the same.
template <class Real>
void expect_same_answers_fused(Kind kind) {
  const std::vector<Real> points = mixed_queries<Real>(kind, each, 12);
  const std::vector<unsigned char> expected = one_by_one(kind, points, Method::tightrope);
  const Queries<Real> queries{kind, expected.size(), points.data()};
  for (const InstructionSet instructions : instruction_sets()) {
    SCOPED_TRACE(std::string(name(instructions)));
    const BatchOptions options{.instructions = instructions, .arithmetic = Arithmetic::fused};
    if (instructions == InstructionSet::scalar || instructions == InstructionSet::sse4) {
      unsigned char byte = 7;
      EXPECT_EQ(collides(Queries<Real>{kind, 1, points.data()}, &byte, options), BatchStatus::invalid_argument);
      EXPECT_EQ(byte, 7);
    } else {
      expect_answers(queries, options, expected);
    }
  }
}

TEST(BatchFused, AnswersAsSingleQueries) {
  for (const Kind kind : kinds) {
    expect_same_answers_fused<double>(kind);
    expect_same_answers_fused<float>(kind);
  }
}

class BatchOfMethod : public testing::TestWithParam<Method> {};

TEST_P(BatchOfMethod, AnswersAsSingleQueriesInDouble) {
  for (const Kind kind : kinds) expect_same_answers<double>(kind, GetParam());
}
TEST_P(BatchOfMethod, AnswersAsSingleQueriesInFloat) {
  for (const Kind kind : kinds) expect_same_answers<float>(kind, GetParam());
}

std::string test_name(const testing::TestParamInfo<Method>& info) {
  std::string text(name(info.param));
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}
INSTANTIATE_TEST_SUITE_P(Each, BatchOfMethod,
                         testing::Values(Method::bsc_float, Method::bsc_safe, Method::tight, Method::bsc_exact,
                                         Method::safe, Method::safe_tight, Method::tightrope),
                         test_name);

template <class Real>
double single_time(Kind kind, const Real* points, Method method, const ImpactOptions& options) {
  constexpr double never = std::numeric_limits<double>::infinity();
  if (method == Method::tightrope) {
    const auto impact = first_impact(pair_of(kind), points, options);
    return impact ? impact->time : never;
  }
  const auto contact = first_contact(kind, points, method);
  return contact && static_cast<double>(contact->earliest) <= options.t_max ? static_cast<double>(contact->earliest)
                                                                            : never;
}

template <class Real>
void expect_same_times(Kind kind, Method method, const ImpactOptions& impact, std::size_t queries_of_each) {
  const std::vector<Real> points = mixed_queries<Real>(kind, queries_of_each, 8);
  const Queries<Real> queries{kind, points.size() / numbers, points.data()};
  std::vector<double> expected;
  for (std::size_t i = 0; i < queries.count; ++i) {
    expected.push_back(single_time(kind, points.data() + numbers * i, method, impact));
  }
  for (const InstructionSet instructions : instruction_sets()) {
    SCOPED_TRACE(std::string(name(instructions)));
    std::vector<double> times(queries.count);
    const BatchOptions options{.method = method, .threads = 2, .instructions = instructions};
    ASSERT_EQ(impact_times(queries, times.data(), impact, options), BatchStatus::done);
    EXPECT_EQ(std::memcmp(times.data(), expected.data(), sizeof(double) * times.size()), 0);
  }
}

TEST(BatchTimes, AreThoseOfSingleQueries) {
  for (const Kind kind : kinds) {
    for (const Method method : {Method::tightrope, Method::safe, Method::safe_tight}) {
      expect_same_times<double>(kind, method, {}, 100);
      expect_same_times<float>(kind, method, {}, 40);
      expect_same_times<double>(kind, method, {.t_max = 0.5}, 40);
      expect_same_times<double>(kind, method, {.t_max = -1}, 10);
    }
    expect_same_times<double>(kind, Method::tightrope, {.tolerance = 0}, 40);
  }
}

TEST(BatchTimes, KnowTheMinimumSeparation) {
  for (const Kind kind : kinds) {
    expect_same_times<double>(kind, Method::tightrope, {.minimum_separation = 0.01}, 5);
    expect_same_times<double>(kind, Method::tightrope, {.minimum_separation = std::nan("")}, 5);
    expect_same_times<double>(kind, Method::tightrope, {.minimum_separation = -1}, 5);
  }
}

TEST(BatchThreads, ChangeNothing) {
  const std::vector<double> points = mixed_queries<double>(Kind::edge_edge, each, 9);
  const Queries<double> queries{Kind::edge_edge, points.size() / numbers, points.data()};
  const std::vector<unsigned char> expected = one_by_one(Kind::edge_edge, points, Method::tightrope);
  for (const int threads : {0, 1, 2, 3, 7}) {
    SCOPED_TRACE(threads);
    expect_answers(queries, {.threads = threads}, expected);
  }
}

TEST(BatchSizes, AreAllAnswered) {
  const std::vector<double> points = mixed_queries<double>(Kind::vertex_face, each, 10);
  const std::vector<unsigned char> expected = one_by_one(Kind::vertex_face, points, Method::tight);
  for (const InstructionSet instructions : instruction_sets()) {
    const BatchOptions options{.method = Method::tight, .instructions = instructions};
    for (std::size_t count = 0; count < 40; ++count) {
      for (const std::size_t first : {std::size_t{0}, std::size_t{1}, std::size_t{1999}}) {
        const Queries<double> queries{Kind::vertex_face, count, points.data() + numbers * first};
        const auto from = expected.begin() + static_cast<std::ptrdiff_t>(first);
        expect_answers(queries, options, {from, from + static_cast<std::ptrdiff_t>(count)});
      }
    }
  }
  expect_answers(Queries<double>{Kind::vertex_face, 0, nullptr}, {}, {});
}

TEST(BatchPoints, NeedNoAlignment) {
  for (const InstructionSet instructions : instruction_sets()) {
    std::vector<float> points = mixed_queries<float>(Kind::edge_edge, 20, 11);
    const std::vector<unsigned char> expected = one_by_one(Kind::edge_edge, points, Method::tightrope);
    points.insert(points.begin(), 0.0F);
    const Queries<float> queries{Kind::edge_edge, expected.size(), points.data() + 1};
    expect_answers(queries, {.instructions = instructions}, expected);
  }
}

TEST(BatchArguments, ThatAreWrongAreRefusedAndNothingIsWritten) {
  const std::vector<double> points(numbers * 3);
  const Queries<double> good{Kind::vertex_face, 3, points.data()};
  unsigned char results[3] = {7, 7, 7};
  double times[3] = {7, 7, 7};
  const auto refused = [&](const auto& queries, const BatchOptions& options, const ImpactOptions& impact) {
    return impact_times(queries, times, impact, options) == BatchStatus::invalid_argument && times[0] == 7;
  };
  EXPECT_EQ(collides(good, nullptr), BatchStatus::invalid_argument);
  EXPECT_EQ(collides_bits(good, nullptr), BatchStatus::invalid_argument);
  EXPECT_EQ(collides(good, results, {.threads = -1}), BatchStatus::invalid_argument);
  EXPECT_EQ(collides(Queries<double>{Kind::vertex_face, 3, nullptr}, results), BatchStatus::invalid_argument);
  EXPECT_EQ(collides(Queries<double>{Kind::vertex_face, 3, points.data(), Layout::by_coordinate, 2}, results),
            BatchStatus::invalid_argument);
  EXPECT_EQ(collides(MeshQueries<double>{Kind::vertex_face, 3, points.data(), points.data(), nullptr}, results),
            BatchStatus::invalid_argument);
  for (const InstructionSet set : {InstructionSet::neon, InstructionSet::avx512}) {
    const auto there = instruction_sets();
    if (std::find(there.begin(), there.end(), set) != there.end()) continue;
    EXPECT_EQ(collides(good, results, {.instructions = set}), BatchStatus::invalid_argument);
  }
  EXPECT_EQ(collides(good, results, {.method = Method::tight, .arithmetic = Arithmetic::fused}),
            BatchStatus::invalid_argument);
  EXPECT_TRUE(std::all_of(results, results + 3, [](unsigned char result) { return result == 7; }));
  for (const Method method : {Method::bsc_float, Method::bsc_safe, Method::tight, Method::bsc_exact}) {
    EXPECT_TRUE(refused(good, {.method = method}, {}));
  }
  EXPECT_TRUE(refused(good, {.method = Method::safe}, {.minimum_separation = 1}));
}

TEST(InstructionSets, HaveNames) {
  for (const InstructionSet instructions : instruction_sets()) {
    EXPECT_EQ(instruction_set_by_name(name(instructions)), instructions);
  }
  EXPECT_EQ(instruction_sets().front(), InstructionSet::scalar);
  EXPECT_EQ(instruction_set_by_name("mmx"), std::nullopt);
}

/// What speed rests on: the vector stages settle the queries of a broad phase; and they leave no contact out.
TEST(VectorStages, SettleNearlyAllOfCloth) {
  if (instruction_sets().size() == 1) GTEST_SKIP() << "no vector instructions";
  constexpr std::size_t count = 4000;
  for (const Kind kind : kinds) {
    const std::vector<double> points = test::queries_of(Scene::cloth_fold, kind, count, 3);
    const Queries<double> queries{kind, count, points.data()};
    for (const MethodInfo& info : methods()) {
      const batch::Filter<Queries, double> filter(info.method, kind, instruction_sets().back());
      ASSERT_TRUE(filter) << info.name;
      std::array<batch::Index, batch::queries_per_chunk> survivors;
      const std::size_t left = filter(queries, 0, count, survivors.data());
      EXPECT_LT(left, count / 40) << info.name;
      const auto end = survivors.begin() + static_cast<std::ptrdiff_t>(left);
      EXPECT_EQ(std::adjacent_find(survivors.begin(), end, std::greater_equal<>()), end);  // each once, in order
      for (std::size_t i = 0; i < count; ++i) {
        const bool settled = !std::binary_search(survivors.begin(), end, i);
        ASSERT_FALSE(settled && collides(kind, points.data() + numbers * i, info.method)) << info.name << ' ' << i;
      }
    }
  }
}

}  // namespace
}  // namespace tightrope::ccd
