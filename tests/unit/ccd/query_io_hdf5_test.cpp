#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "query_io/hdf5_handle.h"
#include "query_io/query_reader.h"
#include "query_io/query_writer.h"
#include "tests/unit/ccd/scratch_directory.h"

/// LeakSanitizer: on damaged files libhdf5 1.10 itself leaks what it had begun to read.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace tightrope::ccd {
namespace {

using hdf5::Handle;

/// A file as other programs might write it.
class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& path)
      : path_(path), file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose) {}

  template <class T>
  Hdf5File& dataset(const char* name, std::vector<hsize_t> shape, hid_t file_type, hid_t type,
                    const std::vector<T>& values) {
    const Handle parents(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(parents.get(), 1);
    const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
    const Handle made(H5Dcreate2(file_.get(), name, file_type, space.get(), parents.get(), H5P_DEFAULT, H5P_DEFAULT),
                      H5Dclose);
    if (!values.empty()) {
      EXPECT_GE(H5Dwrite(made.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    }
    return *this;
  }
  Hdf5File& queries(const char* name, const std::vector<double>& points, hid_t file_type = H5T_IEEE_F64LE) {
    return dataset(name, {points.size() / 24, 8, 3}, file_type, H5T_NATIVE_DOUBLE, points);
  }
  Hdf5File& truth(const char* name, const std::vector<int>& truths, hid_t file_type = H5T_STD_U8LE) {
    return dataset(name, {truths.size()}, file_type, H5T_NATIVE_INT, truths);
  }
  Hdf5File& group(const char* name) {
    const Handle made(H5Gcreate2(file_.get(), name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    return *this;
  }
  std::filesystem::path close() {
    file_.close();
    return path_;
  }

 private:
  std::filesystem::path path_;
  Handle file_;
};

std::vector<double> counting(std::size_t queries) {
  std::vector<double> points(24 * queries);
  std::iota(points.begin(), points.end(), 0.0);
  return points;
}

struct Contents {
  std::vector<QueryBlock> blocks;
  std::string error;
};

Contents read(const std::filesystem::path& path, std::size_t limit = 1000) {
  Contents contents;
  auto opened = open_hdf5(path, {});
  if (auto* wrong = std::get_if<FileError>(&opened)) {
    contents.error = wrong->message;
    return contents;
  }
  QueryReader& reader = *std::get<std::unique_ptr<QueryReader>>(opened);
  while (true) {
    QueryBlock block;
    if (auto wrong = reader.next(limit, block)) {
      contents.error = wrong->message;
      return contents;
    }
    if (block.size() == 0) return contents;
    contents.blocks.push_back(block);
  }
}

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

/// Of every truncation and of bytes overwritten anywhere: an error or some answer, and never a crash.
TEST(Hdf5, TruncatedAndDamagedFilesAreNoCrash) {
  const ScratchDirectory scratch;
  const std::filesystem::path path = scratch.path() / "q.h5";
  {
    auto created = create_hdf5(path);
    QueryBlock block;
    block.points = counting(40);
    block.truths.assign(40, 1);
    ASSERT_FALSE(std::get<std::unique_ptr<QueryWriter>>(created)->append(block));
    ASSERT_FALSE(std::get<std::unique_ptr<QueryWriter>>(created)->commit());
  }
  const std::string whole = text_of(path);
  ASSERT_EQ(read(path).error, "");
  for (std::size_t length = 0; length < whole.size(); length += 4999) {
    const std::string file = scratch.write("cut.h5", whole.substr(0, length));
    EXPECT_NE(read(file).error, "") << length;
  }
  int errors = 0;
  for (std::size_t at = 0; at < 4096; at += 17) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(~damaged[at]);
    errors += read(scratch.write("damaged.h5", damaged)).error.empty() ? 0 : 1;
  }
  EXPECT_GT(errors, 10);
  EXPECT_EQ(
      read(scratch.write("text.h5", "not HDF5")).error,
      (scratch.path() / "text.h5").string() + ": not a readable HDF5 file (truncated, damaged or of another format)");
}

}  // namespace
}  // namespace tightrope::ccd
