#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <utility>

#include "query_io/query_files.h"
#include "query_io/query_writer.h"
#include "tests/unit/ccd/scratch_directory.h"

namespace tightrope::ccd {
namespace {

struct Contents {
  std::array<QueryBlock, 2> kinds;  ///< vertex-face, edge-edge
  std::string error;
  std::uint64_t rounded = 0;
};

/// Everything that the paths stand for, read in blocks of at most `limit`.
Contents read(const std::vector<std::string>& paths, std::optional<Kind> kind = {}, std::size_t limit = 100) {
  Contents contents;
  auto found = find_query_files(paths, kind);
  if (auto* wrong = std::get_if<FileError>(&found)) {
    contents.error = wrong->message;
    return contents;
  }
  QueryStream stream(std::get<std::vector<QueryFile>>(found));
  QueryBlock block;
  while (true) {
    if (auto wrong = stream.next(limit, block)) {
      contents.error = wrong->message;
      break;
    }
    if (block.size() == 0) break;
    EXPECT_LE(block.size(), limit);
    EXPECT_TRUE(block.has_truth() || block.truths.empty());
    QueryBlock& sum = contents.kinds[block.kind == Kind::vertex_face ? 0 : 1];
    sum.points.insert(sum.points.end(), block.points.begin(), block.points.end());
    sum.truths.insert(sum.truths.end(), block.truths.begin(), block.truths.end());
  }
  contents.rounded = stream.rounded();
  return contents;
}

std::vector<std::uint64_t> bits(const std::vector<double>& values) {
  std::vector<std::uint64_t> result;
  for (const double value : values) result.push_back(std::bit_cast<std::uint64_t>(value));
  return result;
}

/// Coordinates of all magnitudes, subnormal to almost overflowing; no -0, which the rational format cannot tell.
QueryBlock random_block(Kind kind, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  QueryBlock block;
  block.kind = kind;
  while (block.points.size() < count * coordinates_per_query) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value) && value != 0) block.points.push_back(value);
  }
  block.points.front() = 0;
  block.points.back() = 0x1p-1074;
  for (std::size_t i = 0; i < count; ++i) block.truths.push_back(static_cast<unsigned char>(random() % 2));
  return block;
}

/// Eight rows of coordinates 0, 1/2, 1, .. 23/2.
std::string rational_query(char truth) {
  std::string text;
  for (int row = 0; row < 8; ++row) {
    for (int k = 0; k < 3; ++k) text += std::to_string(3 * row + k) + ",2,";
    text += truth;
    text += '\n';
  }
  return text;
}

std::string plain_row(const std::string& coordinate, const std::string& end) {
  std::string text;
  for (int i = 0; i < 24; ++i) text += (i > 0 ? "," : "") + coordinate;
  return text + end + "\n";
}

void write(const std::filesystem::path& output, const std::vector<QueryBlock>& blocks) {
  auto created = create_queries(output, "scene");
  ASSERT_TRUE(std::holds_alternative<std::unique_ptr<QueryWriter>>(created)) << std::get<FileError>(created).message;
  QueryWriter& writer = *std::get<std::unique_ptr<QueryWriter>>(created);
  for (const QueryBlock& block : blocks) ASSERT_FALSE(writer.append(block));
  ASSERT_FALSE(writer.commit());
}

TEST(QueryFiles, RationalRowsAreTheEightPointsInOrder) {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("edge-edge/data.csv", rational_query('1') + rational_query('0'));
  const Contents contents = read({file});
  EXPECT_EQ(contents.error, "");
  ASSERT_EQ(contents.kinds[1].size(), 2U);
  for (std::size_t i = 0; i < 48; ++i) EXPECT_EQ(contents.kinds[1].points[i], static_cast<double>(i % 24) / 2);
  EXPECT_EQ(contents.kinds[1].truths, (std::vector<unsigned char>{1, 0}));
  EXPECT_EQ(contents.kinds[0].size(), 0U);
}

TEST(QueryFiles, RationalsThatAreNoDoublesAreRoundedAndCounted) {
  const ScratchDirectory scratch;
  std::string text = rational_query('0');
  text.replace(text.find("5,2,"), 4, "1,3,");
  const Contents contents = read({scratch.write("vertex-face/data.csv", text + text)});
  EXPECT_EQ(contents.error, "");
  EXPECT_EQ(contents.kinds[0].points[5], 1.0 / 3.0);
  EXPECT_EQ(contents.rounded, 2U);
}

TEST(QueryFiles, PlainRowsTakeDecimalAndHexFloats) {
  const ScratchDirectory scratch;
  const std::pair<const char*, double> floats[] = {{"0.1", 0.1},
                                                   {"-2.5e-3", -2.5e-3},
                                                   {"+7", 7.0},
                                                   {"0x1.8p-3", 0.1875},
                                                   {"-0X1P4", -16.0},
                                                   {"1e-400", 0.0},
                                                   {" 3.25\t", 3.25},
                                                   {".5", 0.5},
                                                   {"4.9e-324", 0x1p-1074},
                                                   {"-0", -0.0},
                                                   {"0x1p-1074", 0x1p-1074},
                                                   {"1E22", 1e22},
                                                   {"0x.8", 0.5},
                                                   {"1.7976931348623157e308", 0x1.fffffffffffffp1023}};
  for (const auto& [text, value] : floats) {
    const Contents contents = read({scratch.write("vertex-face.csv", plain_row(text, ""))});
    ASSERT_EQ(contents.error, "") << text;
    EXPECT_EQ(bits(contents.kinds[0].points), bits(std::vector<double>(24, value))) << text;
    EXPECT_TRUE(contents.kinds[0].truths.empty());
  }
  const Contents contents =
      read({scratch.write("q.csv", plain_row("1", ",1") + plain_row("2", ",0"))}, Kind::edge_edge);
  EXPECT_EQ(contents.error, "");
  EXPECT_EQ(contents.kinds[1].truths, (std::vector<unsigned char>{1, 0}));
}

TEST(QueryFiles, BlankLinesCommentsAndForeignLineEndsAreAccepted) {
  const ScratchDirectory scratch;
  std::string text =
      "\xEF\xBB\xBF# a comment\r\n\r\n" + rational_query('1') + "\n \t\n# another\n" + rational_query('0');
  text.pop_back();  // no newline at the end
  for (std::size_t at = text.find(",1\n"); at != std::string::npos; at = text.find(",1\n"))
    text.replace(at, 3, ",1\r\n");
  const Contents contents = read({scratch.write("edge-edge.csv", text)});
  EXPECT_EQ(contents.error, "");
  EXPECT_EQ(contents.kinds[1].truths, (std::vector<unsigned char>{1, 0}));
}

class RoundTrip : public testing::TestWithParam<const char*> {};

TEST_P(RoundTrip, EveryCoordinateBitAndTruthInBlocksOfAnySize) {
  const ScratchDirectory scratch;
  const QueryBlock faces = random_block(Kind::vertex_face, 37, 1);
  const QueryBlock edges = random_block(Kind::edge_edge, 5000, 2);
  write(scratch.path() / GetParam(), {faces, edges});
  for (const std::size_t limit : {1U, 7U, 4096U, 100000U}) {
    const Contents contents = read({(scratch.path() / GetParam()).string()}, {}, limit);
    EXPECT_EQ(contents.error, "");
    EXPECT_EQ(contents.rounded, 0U);
    EXPECT_EQ(bits(contents.kinds[0].points), bits(faces.points));
    EXPECT_EQ(bits(contents.kinds[1].points), bits(edges.points));
    EXPECT_EQ(contents.kinds[0].truths, faces.truths);
    EXPECT_EQ(contents.kinds[1].truths, edges.truths);
  }
}

TEST_P(RoundTrip, BlocksOfBothKindsInTurn) {
  const ScratchDirectory scratch;
  const QueryBlock face = random_block(Kind::vertex_face, 3, 1);
  const QueryBlock edge = random_block(Kind::edge_edge, 2, 2);
  write(scratch.path() / GetParam(), {face, edge, face});
  const Contents contents = read({(scratch.path() / GetParam()).string()});
  EXPECT_EQ(contents.kinds[0].size(), 6U);
  EXPECT_EQ(contents.kinds[1].size(), 2U);
  const Contents only = read({(scratch.path() / GetParam()).string()}, Kind::edge_edge);
  EXPECT_EQ(only.kinds[0].size(), 0U);
  EXPECT_EQ(bits(only.kinds[1].points), bits(edge.points));
}

TEST_P(RoundTrip, NothingAppearsBeforeTheCommit) {
  const ScratchDirectory scratch;
  {
    auto created = create_queries(scratch.path() / GetParam(), "scene");
    ASSERT_FALSE(std::get<std::unique_ptr<QueryWriter>>(created)->append(random_block(Kind::vertex_face, 3, 1)));
    for (const std::string& name : scratch.names()) {
      const std::filesystem::path path = scratch.path() / name;
      EXPECT_TRUE(std::filesystem::is_directory(path) || path.filename().string().starts_with('.')) << name;
    }
  }
  for (const std::string& name : scratch.names())
    EXPECT_TRUE(std::filesystem::is_directory(scratch.path() / name)) << name;
}

INSTANTIATE_TEST_SUITE_P(Formats, RoundTrip, testing::Values("queries", "queries.h5", "queries.hdf5"));

TEST(QueryFiles, ACommitReplacesAnOlderFileAndFailureKeepsIt) {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("q.h5", "older");
  {
    auto created = create_queries(file, "scene");
    ASSERT_FALSE(std::get<std::unique_ptr<QueryWriter>>(created)->append(random_block(Kind::edge_edge, 1, 1)));
  }
  EXPECT_EQ(text_of(file), "older");
  write(file, {random_block(Kind::edge_edge, 1, 1)});
  EXPECT_EQ(read({file}).kinds[1].size(), 1U);
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"q.h5"}));
}

TEST(QueryFiles, OutputsThatCannotBeAreErrors) {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("plain.txt", "text");
  std::filesystem::create_directory(scratch.path() / "dir.h5");
  for (const auto& [output, what] :
       {std::pair<std::string, std::string>{file, "is a file; the output is a directory or FILE.h5"},
        {(scratch.path() / "dir.h5").string(), "is a directory"},
        {(scratch.path() / "q.csv").string(),
         "CSV goes into a directory, a file for each kind; give a directory or FILE.h5"},
        {(scratch.path() / "missing" / "q.h5").string(), "No such file or directory"}}) {
    const auto created = create_queries(output, "scene");
    ASSERT_TRUE(std::holds_alternative<FileError>(created)) << output;
    EXPECT_EQ(std::get<FileError>(created).message, output + ": " + what);
  }
}

TEST(QueryFiles, ADirectoryStandsForItsQueryFilesSortedHiddenOnesExcepted) {
  const ScratchDirectory scratch;
  const auto query = [](const char* x) { return plain_row(x, ""); };
  scratch.write("b/vertex-face/2.csv", query("2"));
  scratch.write("b/vertex-face/10.csv", query("1"));
  scratch.write("a/edge-edge/x/y/z.csv", query("3"));
  scratch.write("b/vertex-face/.hidden.csv", "no query");
  scratch.write("b/.git/vertex-face/1.csv", "no query");
  scratch.write("b/README.md", "no query");
  const Contents contents = read({scratch.path().string()});
  EXPECT_EQ(contents.error, "");
  ASSERT_EQ(contents.kinds[0].size(), 2U);
  EXPECT_EQ(contents.kinds[0].points[0], 1);
  EXPECT_EQ(contents.kinds[0].points[24], 2);
  ASSERT_EQ(contents.kinds[1].size(), 1U);
  EXPECT_EQ(read({scratch.path().string()}, Kind::edge_edge).kinds[0].size(), 0U);
}

TEST(QueryFiles, TheKindIsTheLastComponentOfThePathThatNamesOne) {
  EXPECT_EQ(kind_of_path("x/vertex-face/data.csv"), Kind::vertex_face);
  EXPECT_EQ(kind_of_path("vertex-face/more/edge-edge/data.csv"), Kind::edge_edge);
  EXPECT_EQ(kind_of_path("edge-edge/vertex-face.csv"), Kind::vertex_face);
  EXPECT_EQ(kind_of_path("vertex-faces/data.csv"), std::nullopt);
  EXPECT_EQ(kind_of_path("edge-edge.txt"), std::nullopt);
}

TEST(QueryFiles, PathsThatStandForNothingAreErrors) {
  const ScratchDirectory scratch;
  const std::string missing = (scratch.path() / "missing").string();
  EXPECT_EQ(read({missing}).error, missing + ": no such file or directory");
  EXPECT_EQ(read({scratch.path().string()}).error,
            scratch.path().string() + ": no query files (.csv, .h5, .hdf5) below this directory");
  const std::string unknown = scratch.write("data.csv", rational_query('1'));
  EXPECT_EQ(read({unknown}).error, unknown +
                                       ": vertex-face or edge-edge? No folder on its path is called so; "
                                       "--kind vertex-face or --kind edge-edge tells");
  EXPECT_EQ(read({unknown}, Kind::edge_edge).kinds[1].size(), 1U);
  const std::string other = scratch.write("vertex-face/data.csv", rational_query('1'));
  EXPECT_EQ(read({other}, Kind::edge_edge).error, other + ": no edge-edge queries");
}

struct Malformed {
  const char* what;
  std::string text;
  std::string message;  ///< after the file's name
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(QueryFiles, MalformedRowsAreToldWithFileAndLine) {
  const std::string query = rational_query('1');
  const std::string beginning =
      query + query.substr(0, query.find("9,2,"));  // the first three rows of the second query
  const Malformed cases[] = {
      {"empty", "", ": no queries in this file"},
      {"comments only", "# nothing\n\n", ": no queries in this file"},
      {"unfinished query", beginning, ":11: the last query has 3 of 8 rows"},
      {"one row", "1,1,1,1,1,1,0\n", ":1: the last query has 1 of 8 rows"},
      {"missing field", replaced(query, "12,2,13", "13"), ":5: 5 fields instead of 7"},
      {"more fields", replaced(query, "12,2,13", "12,2,1,13"), ":5: 8 fields instead of 7"},
      {"neither format", "1,2,3\n",
       ":1: 3 fields; a row has 7 (xn,xd,yn,yd,zn,zd,truth; 8 rows a query), or 24 coordinates and perhaps the truth"},
      {"no numerator", replaced(query, "12,2,", "x2,2,"), ":5: numerator is not an integer in 'x2','2'"},
      {"fraction", replaced(query, "12,2,", "12,2.5,"), ":5: denominator is not an integer in '12','2.5'"},
      {"zero denominator", replaced(query, "12,2,", "12,0,"), ":5: zero denominator in '12','0'"},
      {"too large", replaced(query, "12,2,", "1" + std::string(309, '0') + ",1,"),
       ":5: value beyond the range of double in '100000000000000000000000...','1'"},
      {"truth 2", rational_query('2'), ":1: truth '2' is neither 0 nor 1"},
      {"truth of two kinds", replaced(query, "8,2,1\n", "8,2,0\n"), ":3: truth 0 where the query's rows before have 1"},
      {"control characters", replaced(query, "12,2,", "\x01\x7f\x80,2,"),
       ":5: numerator is not an integer in '\?\?\?','2'"},
      {"word", plain_row("1", "") + plain_row("one", ""), ":2: 'one' is not a number"},
      {"infinity", plain_row("inf", ""), ":1: 'inf' is not finite as a double"},
      {"NaN", plain_row("-nan", ""), ":1: '-nan' is not finite as a double"},
      {"overflow", plain_row("1e400", ""), ":1: '1e400' is not finite as a double"},
      {"two signs", plain_row("+-1", ""), ":1: '+-1' is not a number"},
      {"sign after 0x", plain_row("0x-1", ""), ":1: '0x-1' is not a number"},
      {"empty field", plain_row("", ""), ":1: '' is not a number"},
      {"truth sometimes", plain_row("1", ",1") + plain_row("1", ""), ":2: 24 fields instead of 25"},
      {"truth true", plain_row("1", ",true"), ":1: truth 'true' is neither 0 nor 1"},
      {"very long line", std::string(std::size_t{2} << 20, '1'), ":1: line longer than 1048576 bytes"},
  };
  const ScratchDirectory scratch;
  for (const Malformed& malformed : cases) {
    const std::string file = scratch.write("vertex-face/data.csv", malformed.text);
    EXPECT_EQ(read({file}).error, file + malformed.message) << malformed.what;
  }
}

TEST(QueryFiles, RowsLongerThanTheReadersChunksAreWhole) {
  const ScratchDirectory scratch;
  const std::string digits(40000, '7');
  const std::string file = scratch.write("edge-edge.csv", [&] {
    std::string text;
    for (int row = 0; row < 80; ++row) text += digits + "," + digits + ",1,2,1,1,0\n";
    return text;
  }());
  const Contents contents = read({file});
  EXPECT_EQ(contents.error, "");
  ASSERT_EQ(contents.kinds[1].size(), 10U);
  for (std::size_t i = 0; i < 80; ++i) EXPECT_EQ(contents.kinds[1].points[3 * i], 1);
  EXPECT_EQ(contents.rounded, 0U);
}

/// Bytes changed, dropped and doubled: an error that names the file, or queries that are finite; never a crash.
TEST(QueryFiles, DamagedTextIsAnErrorOrFiniteQueries) {
  const ScratchDirectory scratch;
  std::mt19937_64 random(3);
  const std::string whole[] = {rational_query('1') + rational_query('0'),
                               plain_row("-0x1.8p3", ",1") + plain_row("1e5", ",0")};
  int errors = 0;
  constexpr int rounds = 1000;
  for (int round = 0; round < rounds; ++round) {
    std::string text = whole[round % 2];
    for (auto changes = 1 + random() % 4; changes > 0; --changes) {
      const std::size_t at = random() % text.size();
      switch (random() % 3) {
        case 0:
          text[at] = static_cast<char>(random() % 256);
          break;
        case 1:
          text.erase(at, 1 + random() % 20);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), 20));
          break;
      }
    }
    const std::string file = scratch.write("vertex-face.csv", text);
    const Contents contents = read({file});
    errors += contents.error.empty() ? 0 : 1;
    EXPECT_TRUE(contents.error.empty() || contents.error.starts_with(file + ":")) << contents.error;
    for (const double x : contents.kinds[0].points) EXPECT_TRUE(std::isfinite(x));
  }
  EXPECT_GT(errors, rounds / 2);
}

}  // namespace
}  // namespace tightrope::ccd
