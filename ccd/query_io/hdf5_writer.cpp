#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>

#include "query_io/hdf5_handle.h"
#include "query_io/query_writer.h"
#include "query_io/unfinished_file.h"

namespace tightrope::ccd {
namespace {

using hdf5::Handle;

constexpr hsize_t queries_per_chunk = 2048;  // 384 KiB, within HDF5's default chunk cache of 1 MiB

struct Part {
  Handle queries;
  Handle truth;
  hsize_t count = 0;
};

/// A file of HDF5 1.10: its structures carry checksums. Those of the older default do not, and what is damaged there
/// may pass for other queries.
Handle checked_file(const std::filesystem::path& path) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110);
  return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose};
}

/// An empty dataset that grows in its first dimension; every chunk of it carries a checksum.
Handle growing_dataset(hid_t group, const char* name, int rank, hid_t type) {
  const hsize_t size[3] = {0, 8, 3};
  const hsize_t most[3] = {H5S_UNLIMITED, 8, 3};
  const hsize_t chunk[3] = {queries_per_chunk, 8, 3};
  const Handle space(H5Screate_simple(rank, size, most), H5Sclose);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(properties.get(), rank, chunk);
  H5Pset_fletcher32(properties.get());
  return {H5Dcreate2(group, name, type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Dclose};
}

bool append_rows(const Handle& dataset, int rank, hsize_t first, hsize_t count, hid_t type, const void* values) {
  const hsize_t grown[3] = {first + count, 8, 3};
  const hsize_t start[3] = {first, 0, 0};
  const hsize_t size[3] = {count, 8, 3};
  if (H5Dset_extent(dataset.get(), grown) < 0) return false;
  const Handle file_space(H5Dget_space(dataset.get()), H5Sclose);
  const Handle memory_space(H5Screate_simple(rank, size, nullptr), H5Sclose);
  return H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start, nullptr, size, nullptr) >= 0 &&
         H5Dwrite(dataset.get(), type, memory_space.get(), file_space.get(), H5P_DEFAULT, values) >= 0;
}

class Hdf5Writer final : public QueryWriter {
 public:
  explicit Hdf5Writer(const std::filesystem::path& path) : place_(path) {}

  std::optional<FileError> open() {
    std::FILE* probe = std::fopen(place_.path().c_str(), "wb");  // tells why not, which HDF5 does not
    if (probe == nullptr) return failed(std::strerror(errno));
    std::fclose(probe);
    const hdf5::Quiet quiet;
    file_ = checked_file(place_.path());
    if (!file_) return failed("cannot be created");
    return std::nullopt;
  }

  std::optional<FileError> append(const QueryBlock& block) override {
    const hdf5::Quiet quiet;
    if (block.size() == 0) return std::nullopt;
    auto found = parts_.find(block.kind);
    if (found == parts_.end()) found = parts_.emplace(block.kind, create_part(block.kind)).first;
    Part& part = found->second;
    const hsize_t count = block.size();
    if (!part.queries || !part.truth ||
        !append_rows(part.queries, 3, part.count, count, H5T_NATIVE_DOUBLE, block.points.data()) ||
        !append_rows(part.truth, 1, part.count, count, H5T_NATIVE_UCHAR, block.truths.data())) {
      return failed("cannot be written");
    }
    part.count += count;
    return std::nullopt;
  }

  std::optional<FileError> commit() override {
    const hdf5::Quiet quiet;
    bool closed = true;
    for (auto& [kind, part] : parts_) {
      closed = part.queries.close() && closed;
      closed = part.truth.close() && closed;
    }
    closed = file_.close() && closed;
    if (!closed) return failed("cannot be written");
    return place_.commit();
  }

 private:
  FileError failed(std::string_view what) const { return {fmt::format("{}: {}", place_.final_path().string(), what)}; }

  Part create_part(Kind kind) const {
    const Handle group(H5Gcreate2(file_.get(), hdf5::group_name(kind), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Gclose);
    if (!group) return {};
    return {growing_dataset(group.get(), hdf5::queries_name, 3, H5T_IEEE_F64LE),
            growing_dataset(group.get(), hdf5::truth_name, 1, H5T_STD_U8LE), 0};
  }

  UnfinishedFile place_;  // outlives the handles below
  Handle file_;
  std::map<Kind, Part> parts_;
};

}  // namespace

OpenedWriter create_hdf5(const std::filesystem::path& path) {
  auto writer = std::make_unique<Hdf5Writer>(path);
  if (auto error = writer->open()) return *std::move(error);
  return writer;
}

}  // namespace tightrope::ccd
