#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/ccd/hdf5_file.h"
#include "tests/unit/ccd/scratch_directory.h"

/// LeakSanitizer: on damaged files libhdf5 1.10 itself leaks what it had begun to read.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace tightrope::ccd {
namespace {

TEST(Hdf5, FloatsOf32BitsAndFilesWithoutTruth) {
  const ScratchDirectory scratch;
  Hdf5File file(scratch.path() / "q.h5");
  std::vector<double> points = counting(2);
  points[7] = static_cast<double>(0.1F);
  const Contents contents = read(file.queries("edge-edge/queries", points, H5T_IEEE_F32BE).close());
  EXPECT_EQ(contents.error, "");
  ASSERT_EQ(contents.blocks.size(), 1U);
  EXPECT_EQ(contents.blocks[0].kind, Kind::edge_edge);
  EXPECT_EQ(contents.blocks[0].points, points);
  EXPECT_TRUE(contents.blocks[0].truths.empty());
}

TEST(Hdf5, TruthOfAnyIntegerTypeOrBooleanEnum) {
  const ScratchDirectory scratch;
  const Handle boolean(H5Tenum_create(H5T_NATIVE_INT8), H5Tclose);  // as h5py writes numpy's bool
  const signed char values[] = {0, 1};
  H5Tenum_insert(boolean.get(), "FALSE", &values[0]);
  H5Tenum_insert(boolean.get(), "TRUE", &values[1]);
  for (const hid_t type : {H5T_STD_U8LE, H5T_STD_I64BE}) {
    Hdf5File file(scratch.path() / "q.h5");
    const Contents contents =
        read(file.queries("vertex-face/queries", counting(3)).truth("vertex-face/truth", {1, 0, 1}, type).close());
    EXPECT_EQ(contents.error, "");
    ASSERT_EQ(contents.blocks.size(), 1U);
    EXPECT_EQ(contents.blocks[0].truths, (std::vector<unsigned char>{1, 0, 1}));
  }
  Hdf5File file(scratch.path() / "q.h5");
  file.queries("vertex-face/queries", counting(3));
  const std::vector<signed char> truths = {1, 0, 1};
  const Contents contents = read(file.dataset("vertex-face/truth", {3}, boolean.get(), boolean.get(), truths).close());
  EXPECT_EQ(contents.error, "");
  ASSERT_EQ(contents.blocks.size(), 1U);
  EXPECT_EQ(contents.blocks[0].truths, (std::vector<unsigned char>{1, 0, 1}));
}

TEST(Hdf5, VertexFaceComesFirstAndAnEmptyDatasetIsNoQuery) {
  const ScratchDirectory scratch;
  Hdf5File file(scratch.path() / "q.h5");
  file.queries("edge-edge/queries", counting(5)).queries("vertex-face/queries", counting(3));
  const Contents contents = read(file.close(), 2);
  std::vector<std::pair<Kind, std::size_t>> blocks;
  for (const QueryBlock& block : contents.blocks) blocks.emplace_back(block.kind, block.size());
  const std::vector<std::pair<Kind, std::size_t>> expected = {
      {Kind::vertex_face, 2}, {Kind::vertex_face, 1}, {Kind::edge_edge, 2}, {Kind::edge_edge, 2}, {Kind::edge_edge, 1}};
  EXPECT_EQ(blocks, expected);
  Hdf5File empty(scratch.path() / "empty.h5");
  const Contents none =
      read(empty.queries("vertex-face/queries", {}).queries("edge-edge/queries", counting(1)).close());
  EXPECT_EQ(none.error, "");
  ASSERT_EQ(none.blocks.size(), 1U);
  EXPECT_EQ(none.blocks[0].kind, Kind::edge_edge);
}

TEST(Hdf5, WrongLayoutsAreErrorsThatNameTheDataset) {
  const ScratchDirectory scratch;
  const std::filesystem::path path = scratch.path() / "q.h5";
  const auto error = [&](Hdf5File& file) { return read(file.close()).error.substr(path.string().size()); };
  const auto made = [&](auto fill) {
    Hdf5File file(path);
    fill(file);
    return error(file);
  };
  EXPECT_EQ(made([](Hdf5File& f) { f.group("other"); }),
            ": no queries: neither group 'vertex-face' nor group 'edge-edge'");
  EXPECT_EQ(made([](Hdf5File& f) { f.queries("edge-edge", counting(1)); }), ":/edge-edge: not a group");
  EXPECT_EQ(made([](Hdf5File& f) { f.group("edge-edge"); }), ":/edge-edge/queries: missing dataset");
  EXPECT_EQ(made([](Hdf5File& f) { f.group("edge-edge").group("edge-edge/queries"); }),
            ":/edge-edge/queries: not a readable dataset");
  EXPECT_EQ(made([](Hdf5File& f) {
              f.dataset("edge-edge/queries", {2, 24}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, counting(2));
            }),
            ":/edge-edge/queries: shape is 2 x 24 instead of n x 8 x 3");
  EXPECT_EQ(made([](Hdf5File& f) {
              f.dataset("edge-edge/queries", {2, 3, 8}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, counting(2));
            }),
            ":/edge-edge/queries: shape is 2 x 3 x 8 instead of n x 8 x 3");
  EXPECT_EQ(made([](Hdf5File& f) { f.queries("edge-edge/queries", counting(1), H5T_STD_I32LE); }),
            ":/edge-edge/queries: elements are neither float64 nor float32");
  EXPECT_EQ(made([](Hdf5File& f) { f.queries("vertex-face/queries", counting(2)).truth("vertex-face/truth", {1}); }),
            ":/vertex-face/truth: shape is 1 instead of 2, the number of queries");
  EXPECT_EQ(made([](Hdf5File& f) {
              f.queries("vertex-face/queries", counting(1)).truth("vertex-face/truth", {1}, H5T_IEEE_F32LE);
            }),
            ":/vertex-face/truth: elements are not integers");
}

TEST(Hdf5, WrongValuesAreErrorsThatNameTheQuery) {
  const ScratchDirectory scratch;
  const std::filesystem::path path = scratch.path() / "q.h5";
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    std::vector<double> points = counting(9);
    points[24 * 5 + 23] = bad;
    for (const std::size_t limit : {2U, 100U}) {
      Hdf5File file(path);
      EXPECT_EQ(read(file.queries("edge-edge/queries", points).close(), limit).error,
                path.string() + ":/edge-edge/queries[5]: a coordinate is not finite");
    }
  }
  for (const int bad : {2, -1, 256}) {  // 256 and -1 become 0 and 1, or 255, where bytes are read carelessly
    Hdf5File file(path);
    file.queries("edge-edge/queries", counting(4)).truth("edge-edge/truth", {0, 1, 0, bad}, H5T_STD_I32LE);
    EXPECT_EQ(read(file.close(), 3).error,
              path.string() + ":/edge-edge/truth[3]: truth " + std::to_string(bad) + " is neither 0 nor 1");
  }
}

}  // namespace
}  // namespace tightrope::ccd
