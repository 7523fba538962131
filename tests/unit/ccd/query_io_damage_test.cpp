/// Query files that were cut off, damaged, or not finished: an error, or what was written; never anything else.

#include <fcntl.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "query_io/query_writer.h"
#include "scenes/scene.h"
#include "tests/unit/ccd/command_runner.h"
#include "tests/unit/ccd/hdf5_file.h"

namespace tightrope::ccd {
namespace {

QueryBlock block_of(Kind kind, std::size_t count) {
  QueryBlock block;
  block.kind = kind;
  block.points.resize(count * coordinates_per_query);
  block.truths.resize(count);
  generate(Scene::random, kind, count, 7)->fill(block.points);
  for (std::size_t i = 0; i < count; ++i) block.truths[i] = i % 3 == 0 ? 1 : 0;
  return block;
}

bool same(const Contents& mine, const Contents& other) {
  return std::equal(mine.blocks.begin(), mine.blocks.end(), other.blocks.begin(), other.blocks.end(),
                    [](const QueryBlock& a, const QueryBlock& b) {
                      return a.kind == b.kind && a.points == b.points && a.truths == b.truths;
                    });
}

/// How many of the damaged files are read without an error although they now say something else.
struct Damage {
  int errors = 0;
  int silent = 0;
};

/// Flips a bit, or overwrites a run of bytes, at seeded places: those given and `more` others.
Damage damage(const ScratchDirectory& scratch, const std::filesystem::path& path, std::set<std::size_t> places,
              int more) {
  const std::string whole = text_of(path);
  const Contents before = read(path, 100);
  EXPECT_EQ(before.error, "");
  std::mt19937_64 random(11);
  for (int i = 0; i < more; ++i) places.insert(random() % whole.size());
  Damage found;
  const std::filesystem::path damaged = scratch.write("damaged.h5", whole);
  for (const std::size_t at : places) {
    const std::size_t length = random() % 4 == 0 ? std::min<std::size_t>(1 + random() % 64, whole.size() - at) : 1;
    std::string bytes = whole.substr(at, length);
    for (char& byte : bytes) {
      byte = static_cast<char>(length == 1 ? byte ^ (1 << random() % 8) : static_cast<int>(random() % 256));
    }
    const int file = ::open(damaged.c_str(), O_WRONLY);
    EXPECT_EQ(::pwrite(file, bytes.data(), length, static_cast<off_t>(at)), static_cast<ssize_t>(length));
    const Contents after = read(damaged, 100);
    found.errors += after.error.empty() ? 0 : 1;
    found.silent += after.error.empty() && !same(after, before) ? 1 : 0;
    EXPECT_EQ(::pwrite(file, whole.data() + at, length, static_cast<off_t>(at)), static_cast<ssize_t>(length));
    ::close(file);
  }
  return found;
}

/// Where the file holds anything: the headers, the few queries, and no space that was only set aside.
std::set<std::size_t> used_places(const std::string& file) {
  std::set<std::size_t> places;
  for (std::size_t i = 0; i < file.size(); ++i) {
    if (file[i] != '\0') places.insert(i);
  }
  return places;
}

class DamagedFiles : public testing::Test {
 protected:
  void SetUp() override {
    auto created = create_hdf5(path);
    QueryWriter& writer = *std::get<std::unique_ptr<QueryWriter>>(created);
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) ASSERT_FALSE(writer.append(block_of(kind, 5)));
    ASSERT_FALSE(writer.commit());
  }
  ScratchDirectory scratch;
  std::filesystem::path path = scratch.path() / "q.h5";
};

TEST_F(DamagedFiles, OurFilesNoticeEveryDamageThatChangesTheQueries) {
  const Damage found = damage(scratch, path, used_places(text_of(path)), 500);
  EXPECT_EQ(found.silent, 0);
  EXPECT_GT(found.errors, 1500);
}

/// The same queries without checksums: what the test above looks for is there, and none of it is a crash.
TEST_F(DamagedFiles, OtherFilesMayHideDamageButNeverCrashTheReader) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "HDF5 1.10 itself reads beyond a chunk whose size was damaged";
#endif
  const QueryBlock block = block_of(Kind::edge_edge, 5);
  const std::vector<int> truths(block.truths.begin(), block.truths.end());
  for (const unsigned compression : {0U, 6U}) {
    const std::filesystem::path other = scratch.path() / "other.h5";
    Hdf5File file(other);
    file.chunks({5, 8, 3}, compression).queries("edge-edge/queries", block.points);
    file.chunks({5}, compression).truth("edge-edge/truth", truths).close();
    const Damage found = damage(scratch, other, used_places(text_of(other)), 100);
    EXPECT_GT(found.errors, 100);
    if (compression == 0) {
      EXPECT_GT(found.silent, 100);
    }
  }
}

/// A chunk of size zero, by which HDF5 1.10 divides.
TEST_F(DamagedFiles, ACrashOfTheHdf5LibraryIsAnErrorOfTheFile) {
  const std::filesystem::path other = scratch.path() / "other.h5";
  Hdf5File(other).chunks({5, 8, 3}).queries("edge-edge/queries", block_of(Kind::edge_edge, 5).points).close();
  std::string bytes = text_of(other);
  constexpr std::string_view sizes("\5\0\0\0\10\0\0\0\3\0\0\0\10\0\0\0", 16);  // 5 x 8 x 3 x 8 bytes
  const std::size_t at = bytes.find(sizes);
  ASSERT_NE(at, std::string::npos);
  bytes[at] = '\0';
  const std::string damaged = scratch.write("damaged.h5", bytes);
  for (const std::string command : {"evaluate", "toi"}) {
    const Outcome outcome = run_command(scratch, {command, damaged});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err.find("tightrope-ccd: error: " + damaged + ":"), 0U) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
  }
}

TEST_F(DamagedFiles, CutOffAnywhereIsAnError) {
  const std::string whole = text_of(path);
  std::set<std::size_t> lengths = {0, 1, whole.size() - 1};
  std::mt19937_64 random(3);
  for (int i = 0; i < 150; ++i) lengths.insert(random() % (i < 50 ? 8192 : whole.size()));
  const std::filesystem::path cut = scratch.write("cut.h5", whole);
  for (auto length = lengths.rbegin(); length != lengths.rend(); ++length) {
    std::filesystem::resize_file(cut, *length);
    EXPECT_EQ(read(cut).error, cut.string() + ": not a readable HDF5 file (truncated, damaged or of another format)");
  }
  EXPECT_EQ(
      read(scratch.write("text.h5", "not HDF5")).error,
      (scratch.path() / "text.h5").string() + ": not a readable HDF5 file (truncated, damaged or of another format)");
}

/// Three chunks of 2048 queries; a bit of the third one flips.
TEST_F(DamagedFiles, TheMessageNamesTheQueriesThatAreLostAndNothingIsPrinted) {
  const std::filesystem::path large = scratch.path() / "large.h5";
  auto created = create_hdf5(large);
  QueryWriter& writer = *std::get<std::unique_ptr<QueryWriter>>(created);
  QueryBlock block = block_of(Kind::edge_edge, 5000);
  for (double& x : block.points) x = 1.5;
  block.points[24 * 4999] = 3.25;
  ASSERT_FALSE(writer.append(block));
  ASSERT_FALSE(writer.commit());
  std::string bytes = text_of(large);
  const double marked = block.points[24 * 4999];
  const std::size_t at = bytes.find(std::string_view(reinterpret_cast<const char*>(&marked), sizeof(marked)));
  ASSERT_NE(at, std::string::npos);
  bytes[at + 4] = static_cast<char>(bytes[at + 4] ^ 1);
  const std::string damaged = scratch.write("damaged.h5", bytes);
  for (const std::string command : {"evaluate", "toi", "exact", "stages"}) {
    const Outcome outcome = run_command(scratch, {command, damaged});
    EXPECT_EQ(outcome.status, 2) << command;
    EXPECT_EQ(outcome.out, "") << command;
    EXPECT_EQ(outcome.err, "tightrope-ccd: error: " + damaged +
                               ":/edge-edge/queries: queries 4096 .. 4999 cannot be read (truncated or damaged)\n");
  }
}

TEST(ChunkedFiles, OfAnyShapeAndCompressionReadTheSameInBlocksOfAnySize) {
  const ScratchDirectory scratch;
  const QueryBlock block = block_of(Kind::vertex_face, 3000);
  const std::vector<int> truths(block.truths.begin(), block.truths.end());
  const std::vector<std::vector<hsize_t>> shapes = {{1, 8, 3}, {700, 8, 3}, {3000, 8, 3}, {256, 3, 2}, {3000, 1, 1}};
  for (const auto& shape : shapes) {
    for (const unsigned compression : {0U, 4U}) {
      Hdf5File file(scratch.path() / "q.h5");
      file.chunks(shape, compression).queries("vertex-face/queries", block.points);
      const auto path = file.chunks({shape[0]}, compression).truth("vertex-face/truth", truths).close();
      for (const std::size_t limit : {999U, 3000U}) {
        const Contents contents = read(path, limit);
        ASSERT_EQ(contents.error, "");
        QueryBlock all;
        for (const QueryBlock& part : contents.blocks) {
          all.points.insert(all.points.end(), part.points.begin(), part.points.end());
          all.truths.insert(all.truths.end(), part.truths.begin(), part.truths.end());
        }
        EXPECT_TRUE(all.points == block.points && all.truths == block.truths) << shape[0] << " " << limit;
      }
    }
  }
}

TEST(ChunkedFiles, WhatCannotBeReadWholeOrInBoundedMemoryIsAnError) {
  const ScratchDirectory scratch;
  const std::filesystem::path path = scratch.path() / "q.h5";
  const auto error = [&](auto fill) {
    Hdf5File file(path);
    fill(file);
    return read(file.close()).error;
  };
  const std::string where = path.string() + ":/edge-edge/queries: ";
  const std::vector<hsize_t> shape = {3, 8, 3};
  EXPECT_EQ(error([&](Hdf5File& file) {
              file.dataset("edge-edge/queries", shape, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, std::vector<double>());
            }),
            where + "not all of its values have been written");
  EXPECT_EQ(error([&](Hdf5File& file) {  // two chunks, one of them written
              file.chunks({2, 8, 3}).dataset("edge-edge/queries", shape, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                                             std::vector<double>());
              const Handle half(H5Dopen2(file.file(), "edge-edge/queries", H5P_DEFAULT), H5Dclose);
              const Handle rows(H5Dget_space(half.get()), H5Sclose);
              const hsize_t start[] = {0, 0, 0}, count[] = {1, 8, 3};
              H5Sselect_hyperslab(rows.get(), H5S_SELECT_SET, start, nullptr, count, nullptr);
              const Handle memory(H5Screate_simple(3, count, nullptr), H5Sclose);
              const std::vector<double> points(24, 1.0);
              EXPECT_GE(H5Dwrite(half.get(), H5T_NATIVE_DOUBLE, memory.get(), rows.get(), H5P_DEFAULT, points.data()),
                        0);
            }),
            where + "not all of its values have been written");
  EXPECT_EQ(error([&](Hdf5File& file) {
              H5Pset_external(file.properties(), (scratch.path() / "raw").c_str(), 0, 3 * 24 * 8);
              file.queries("edge-edge/queries", std::vector<double>(3 * 24, 1.0));
            }),
            where + "its values are in other files");
  EXPECT_EQ(error([&](Hdf5File& file) {  // all in one chunk of 384 MiB
              file.chunks({2 << 20, 8, 3}, 1)
                  .dataset("edge-edge/queries", {2 << 20, 8, 3}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                           std::vector<double>());
            }),
            where + "compressed in chunks of more than 256 MiB; smaller ones can be read");
}

/// Nothing of a file that is still being written is under its final name, and what was there before stays.
TEST(UnfinishedFiles, AreNotThereForReaders) {
  const ScratchDirectory scratch;
  const std::filesystem::path path = scratch.path() / "q.h5";
  auto created = create_hdf5(path);
  QueryWriter& writer = *std::get<std::unique_ptr<QueryWriter>>(created);
  ASSERT_FALSE(writer.append(block_of(Kind::edge_edge, 10)));
  EXPECT_FALSE(std::filesystem::exists(path));
  for (const std::string& name : scratch.names()) {  // a copy of it, as another process would find it
    const std::string copy = scratch.write("copy.h5", text_of(scratch.path() / name));
    EXPECT_NE(read(copy).error, "");
  }
  ASSERT_FALSE(writer.commit());
  EXPECT_EQ(read(path).error, "");
}

}  // namespace
}  // namespace tightrope::ccd
