/// Evaluation shared by several processes, here threads that talk to each other as the processes would.

#include <gtest/gtest.h>

#include <algorithm>
#include <barrier>
#include <memory>
#include <thread>

#include "command/evaluation.h"
#include "query_io/query_files.h"
#include "query_io/query_writer.h"
#include "scenes/scene.h"
#include "scenes/truth.h"
#include "tests/unit/ccd/scratch_directory.h"

namespace tightrope::ccd {
namespace {

/// What the members of a team leave for each other.
struct Board {
  explicit Board(std::size_t count)
      : meeting(static_cast<std::ptrdiff_t>(count)), numbers(count), times(count), texts(count) {}
  std::barrier<> meeting;
  std::vector<std::vector<std::uint64_t>> numbers;
  std::vector<std::vector<double>> times;
  std::vector<std::string> texts;
};

class Member final : public Processes {
 public:
  Member(Board& board, std::size_t rank) : board_(board), rank_(rank) {}
  std::size_t rank() const override { return rank_; }
  std::size_t count() const override { return board_.numbers.size(); }
  void smallest(std::span<std::uint64_t> numbers) override {
    combine(board_.numbers, numbers, [](std::uint64_t a, std::uint64_t b) { return std::min(a, b); });
  }
  void sum(std::span<std::uint64_t> numbers) override { combine(board_.numbers, numbers, std::plus<>()); }
  void sum(std::span<double> numbers) override { combine(board_.times, numbers, std::plus<>()); }
  std::string text_of(std::size_t rank, std::string text) override {
    board_.texts[rank_] = text;
    board_.meeting.arrive_and_wait();
    std::string told = board_.texts[rank];
    board_.meeting.arrive_and_wait();
    return told;
  }

 private:
  template <class T, class Combine>
  void combine(std::vector<std::vector<T>>& all, std::span<T> mine, Combine combine) {
    all[rank_].assign(mine.begin(), mine.end());
    board_.meeting.arrive_and_wait();
    for (std::size_t i = 0; i < mine.size(); ++i) {
      mine[i] = all[0][i];
      for (std::size_t r = 1; r < all.size(); ++r) mine[i] = combine(mine[i], all[r][i]);
    }
    board_.meeting.arrive_and_wait();
  }

  Board& board_;
  std::size_t rank_;
};

using Result = std::variant<Evaluation, FileError>;

std::vector<Result> evaluate_together(const EvaluationRequest& request, std::size_t count) {
  Board board(count);
  std::vector<Result> results(count);
  {
    std::vector<std::jthread> team;
    for (std::size_t rank = 0; rank < count; ++rank) {
      team.emplace_back([&, rank] {
        Member member(board, rank);
        results[rank] = evaluate(request, member);
      });
    }
  }
  return results;
}

void write_scene(const std::filesystem::path& file, Scene scene, std::size_t count, bool csv = false) {
  auto created = csv ? create_rational_csv(file, std::string(name(scene))) : create_hdf5(file);
  QueryWriter& writer = *std::get<std::unique_ptr<QueryWriter>>(created);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    QueryBlock block;
    block.kind = kind;
    block.points.resize(count * coordinates_per_query);
    block.truths.resize(count);
    generate(scene, kind, count, 5)->fill(block.points);
    exact_truths(kind, block.points, block.truths);
    ASSERT_FALSE(writer.append(block));
  }
  ASSERT_FALSE(writer.commit());
}

EvaluationRequest request_of(const std::filesystem::path& path) {
  return {.paths = {path.string()},
          .kind = std::nullopt,
          .methods = {Method::tight},
          .precisions = {Precision::in_double, Precision::in_float},
          .queries_per_block = 400};
}

void expect_equal(const Evaluation& mine, const Evaluation& alone) {
  EXPECT_EQ(mine.rounded, alone.rounded);
  EXPECT_EQ(mine.changed, alone.changed);
  EXPECT_EQ(mine.left_out, alone.left_out);
  EXPECT_EQ(mine.wrong_truths, alone.wrong_truths);
  ASSERT_EQ(mine.rows.size(), alone.rows.size());
  for (std::size_t i = 0; i < alone.rows.size(); ++i) {
    const EvaluationRow &a = mine.rows[i], &b = alone.rows[i];
    EXPECT_EQ(a.method, b.method);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.precision, b.precision);
    EXPECT_EQ(a.queries, b.queries);
    EXPECT_EQ(a.answers_true, b.answers_true);
    EXPECT_EQ(a.uncertain, b.uncertain);
    ASSERT_EQ(a.mistakes.has_value(), b.mistakes.has_value());
    if (!b.mistakes) continue;
    EXPECT_EQ(a.mistakes->collisions, b.mistakes->collisions);
    EXPECT_EQ(a.mistakes->false_positives, b.mistakes->false_positives);
    EXPECT_EQ(a.mistakes->false_negatives, b.mistakes->false_negatives);
    EXPECT_GT(a.ns_per_query, 0);
  }
}

/// HDF5 files of less than, exactly, and more than a block; CSV files; a file without truth.
class SharedQueries : public testing::Test {
 protected:
  void SetUp() override {
    write_scene(scratch.path() / "a.h5", Scene::random, 1000);
    write_scene(scratch.path() / "b", Scene::near_coplanar, 300, true);
    write_scene(scratch.path() / "c.h5", Scene::degenerate, 500);
  }
  ScratchDirectory scratch;
};

TEST_F(SharedQueries, ResultsAreThoseOfASingleProcess) {
  const EvaluationRequest request = request_of(scratch.path());
  const Result alone = evaluate(request);
  ASSERT_TRUE(std::holds_alternative<Evaluation>(alone)) << std::get<FileError>(alone).message;
  ASSERT_EQ(std::get<Evaluation>(alone).rows.size(), 4U);
  EXPECT_EQ(std::get<Evaluation>(alone).rows[0].queries, 1800U);
  for (const std::size_t count : {2U, 9U}) {  // 9: more than there are units
    for (const Result& result : evaluate_together(request, count)) {
      ASSERT_TRUE(std::holds_alternative<Evaluation>(result)) << std::get<FileError>(result).message;
      expect_equal(std::get<Evaluation>(result), std::get<Evaluation>(alone));
    }
  }
}

/// Errors in several files, wherever they fall: the first one in file order is told, by all processes.
TEST_F(SharedQueries, TheFirstErrorInFileOrderIsToldByAll) {
  const std::string good = "0,0,1,-1,-1,0,2,-1,0,-1,2,0,0,0,2,-1,-1,0,2,-1,0,-1,2,0,0\n";
  std::string late = good;
  for (int i = 0; i < 500; ++i) late += good;  // an error in the second block of the file
  const std::string first = scratch.write("aa/vertex-face.csv", late + "1,2\n");
  scratch.write("d/vertex-face.csv", good + "nonsense\n");
  scratch.write("e.h5", "no HDF5");
  std::vector<std::string> files = {"aa/vertex-face.csv", "d/vertex-face.csv", "e.h5"};
  for (const std::string& removed : files) {
    const Result alone = evaluate(request_of(scratch.path()));
    ASSERT_TRUE(std::holds_alternative<FileError>(alone));
    EXPECT_NE(std::get<FileError>(alone).message.find(removed), std::string::npos);
    for (const std::size_t count : {3U}) {
      for (const Result& result : evaluate_together(request_of(scratch.path()), count)) {
        ASSERT_TRUE(std::holds_alternative<FileError>(result));
        EXPECT_EQ(std::get<FileError>(result).message, std::get<FileError>(alone).message);
      }
    }
    std::filesystem::remove(scratch.path() / removed);
  }
}

TEST_F(SharedQueries, AFileWithoutTruthLeavesTheKindsTruthUnknownToAll) {
  scratch.write("z/edge-edge.csv", "0,0,1,-1,-1,0,2,-1,0,-1,2,0,0,0,2,-1,-1,0,2,-1,0,-1,2,0\n");
  EvaluationRequest request = request_of(scratch.path());
  const Result alone = evaluate(request);
  EXPECT_TRUE(std::get<Evaluation>(alone).rows[0].mistakes.has_value());
  EXPECT_FALSE(std::get<Evaluation>(alone).rows[2].mistakes.has_value());
  for (const Result& result : evaluate_together(request, 3)) {
    expect_equal(std::get<Evaluation>(result), std::get<Evaluation>(alone));
  }
  request.truth = TruthSource::file;
  const Result demanded = evaluate(request);
  for (const Result& result : evaluate_together(request, 3)) {
    EXPECT_EQ(std::get<FileError>(result).message, std::get<FileError>(demanded).message);
  }
}

/// Every unit is read by exactly one of the readers of shares.
TEST_F(SharedQueries, SharesDivideTheQueries) {
  const std::string path = scratch.path().string();
  auto found = find_query_files(std::span(&path, 1), {});
  const auto files = std::get<std::vector<QueryFile>>(found);
  const auto points_of = [&](Share share, std::size_t limit) {
    QueryStream stream(files, share);
    std::vector<std::vector<double>> blocks;
    QueryBlock block;
    while (true) {
      EXPECT_FALSE(stream.next(limit, block));
      if (block.size() == 0) return blocks;
      EXPECT_EQ(stream.unit() % share.count, share.index);
      blocks.push_back(block.points);
    }
  };
  for (const std::size_t limit : {100U, 333U, 2000U}) {
    auto all = points_of({}, limit);
    std::vector<std::vector<double>> parts;
    for (std::uint64_t rank = 0; rank < 3; ++rank) {
      for (auto& block : points_of({.index = rank, .count = 3}, limit)) parts.push_back(std::move(block));
    }
    std::sort(all.begin(), all.end());
    std::sort(parts.begin(), parts.end());
    EXPECT_TRUE(all == parts) << limit;
  }
}

}  // namespace
}  // namespace tightrope::ccd
