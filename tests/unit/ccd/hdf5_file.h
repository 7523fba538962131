#pragma once
/// HDF5 files as other programs might write them, and all that is read from a file.

#include <gtest/gtest.h>

#include <numeric>

#include "query_io/hdf5_handle.h"
#include "query_io/query_reader.h"

namespace tightrope::ccd {

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
    const Handle made(
        H5Dcreate2(file_.get(), name, file_type, space.get(), parents.get(), properties_.get(), H5P_DEFAULT), H5Dclose);
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
  /// For the datasets that follow: chunks of this shape, compressed if `level` is more than 0.
  Hdf5File& chunks(std::vector<hsize_t> shape, unsigned level = 0) {
    properties_ = Handle(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(properties_.get(), static_cast<int>(shape.size()), shape.data());
    if (level > 0) H5Pset_deflate(properties_.get(), level);
    return *this;
  }
  hid_t file() const { return file_.get(); }
  hid_t properties() const { return properties_.get(); }
  Hdf5File& group(const char* name) {
    const Handle made(H5Gcreate2(file_.get(), name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    return *this;
  }
  std::filesystem::path close() {
    file_.close();
    return path_;
  }

 private:
  hdf5::Quiet quiet_;  // before HDF5 does anything
  std::filesystem::path path_;
  Handle file_;
  Handle properties_{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
};

inline std::vector<double> counting(std::size_t queries) {
  std::vector<double> points(24 * queries);
  std::iota(points.begin(), points.end(), 0.0);
  return points;
}

struct Contents {
  std::vector<QueryBlock> blocks;
  std::string error;
};

inline Contents read(const std::filesystem::path& path, std::size_t limit = 1000) {
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
    contents.blocks.push_back(std::move(block));
  }
}

}  // namespace tightrope::ccd
