/// HDF5 query files: groups vertex-face and edge-edge, each with `queries` (n x 8 x 3 float64 or float32) and
/// optionally `truth` (n integers, 0 or 1).

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "query_io/hdf5_dataset.h"
#include "query_io/hdf5_guard.h"
#include "query_io/query_reader.h"

namespace tightrope::ccd {
namespace {

using hdf5::Handle;

/// One kind's datasets.
struct Part {
  Kind kind{};
  Handle queries;
  Handle truth;  ///< absent if the file does not tell
  hsize_t count = 0;
};

class Hdf5Reader final : public QueryReader {
 public:
  explicit Hdf5Reader(std::filesystem::path path) : path_(std::move(path)) {}

  std::optional<FileError> open(std::optional<Kind> only);
  std::optional<FileError> next(std::size_t limit, QueryBlock& block) override;
  std::uint64_t skip(std::size_t limit) override;

 private:
  FileError wrong(std::string_view where, std::string_view what) const {
    return {fmt::format("{}{}{}: {}", path_.string(), where.empty() ? "" : ":/", where, what)};
  }
  std::optional<FileError> open_part(Kind kind);
  std::optional<FileError> open_dataset(const Handle& group, Kind kind, const char* name, Handle& dataset) const;
  hsize_t rows_at_hand(std::size_t limit);
  std::optional<FileError> check_queries(const Part& part, const std::string& where, hsize_t& count) const;
  std::optional<FileError> check_truth(const Part& part, const std::string& where) const;
  std::optional<FileError> read_points(const Part& part, hsize_t count, QueryBlock& block) const;
  std::optional<FileError> read_truths(const Part& part, hsize_t count, QueryBlock& block);

  std::filesystem::path path_;
  Handle file_;
  std::vector<Part> parts_;
  std::size_t part_ = 0;
  hsize_t position_ = 0;  ///< in the current part
  std::vector<int> truth_numbers_;
};

std::string path_in_file(Kind kind, const char* dataset) {
  return fmt::format("{}/{}", hdf5::group_name(kind), dataset);
}

bool exists(hid_t where, const char* name) { return H5Lexists(where, name, H5P_DEFAULT) > 0; }

std::string shape(const std::vector<hsize_t>& sizes) {
  return sizes.empty() ? "a scalar" : fmt::format("{}", fmt::join(sizes, " x "));
}

std::optional<FileError> Hdf5Reader::open(std::optional<Kind> only) {
  const hdf5::Quiet quiet;
  const hdf5::CrashGuard guard(path_);
  file_ = Handle(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file_) return wrong("", "not a readable HDF5 file (truncated, damaged or of another format)");
  bool any_group = false;
  for (const Kind kind : hdf5::kinds) {
    if (!exists(file_.get(), hdf5::group_name(kind))) continue;
    any_group = true;
    if (only && kind != *only) continue;
    if (auto error = open_part(kind)) return error;
  }
  if (!any_group) return wrong("", "no queries: neither group 'vertex-face' nor group 'edge-edge'");
  return std::nullopt;
}

std::optional<FileError> Hdf5Reader::open_part(Kind kind) {
  const std::string where = path_in_file(kind, hdf5::queries_name);
  const Handle group(H5Gopen2(file_.get(), hdf5::group_name(kind), H5P_DEFAULT), H5Gclose);
  if (!group) return wrong(hdf5::group_name(kind), "not a group");
  if (!exists(group.get(), hdf5::queries_name)) return wrong(where, "missing dataset");
  Part part{.kind = kind, .queries = {}, .truth = {}, .count = 0};
  if (auto error = open_dataset(group, kind, hdf5::queries_name, part.queries)) return error;
  if (auto error = check_queries(part, where, part.count)) return error;
  if (exists(group.get(), hdf5::truth_name)) {
    if (auto error = open_dataset(group, kind, hdf5::truth_name, part.truth)) return error;
    if (auto error = check_truth(part, path_in_file(kind, hdf5::truth_name))) return error;
  }
  parts_.push_back(std::move(part));
  return std::nullopt;
}

std::optional<FileError> Hdf5Reader::open_dataset(const Handle& group, Kind kind, const char* name,
                                                  Handle& dataset) const {
  auto opened = hdf5::open_rows(group.get(), name);
  if (const auto* fault = std::get_if<std::string>(&opened)) return wrong(path_in_file(kind, name), *fault);
  dataset = std::get<Handle>(std::move(opened));
  return std::nullopt;
}

std::optional<FileError> Hdf5Reader::check_queries(const Part& part, const std::string& where, hsize_t& count) const {
  const std::vector<hsize_t> sizes = hdf5::extents(part.queries);
  if (sizes.size() != 3 || sizes[1] != 8 || sizes[2] != 3) {
    return wrong(where, fmt::format("shape is {} instead of n x 8 x 3", shape(sizes)));
  }
  const Handle type(H5Dget_type(part.queries.get()), H5Tclose);
  if (H5Tget_class(type.get()) != H5T_FLOAT || H5Tget_size(type.get()) > sizeof(double)) {
    return wrong(where, "elements are neither float64 nor float32");
  }
  count = sizes[0];
  return std::nullopt;
}

std::optional<FileError> Hdf5Reader::check_truth(const Part& part, const std::string& where) const {
  const std::vector<hsize_t> sizes = hdf5::extents(part.truth);
  if (sizes.size() != 1 || sizes[0] != part.count) {
    return wrong(where, fmt::format("shape is {} instead of {}, the number of queries", shape(sizes), part.count));
  }
  const Handle type(H5Dget_type(part.truth.get()), H5Tclose);
  const H5T_class_t kind_of_type = H5Tget_class(type.get());
  if (kind_of_type != H5T_INTEGER && kind_of_type != H5T_ENUM) return wrong(where, "elements are not integers");
  return std::nullopt;
}

/// "3 .. 17": the first rows of [first, first + count) that cannot be read, chunk by chunk.
std::string unreadable_rows(const Handle& dataset, int rank, hsize_t first, hsize_t count) {
  const hsize_t chunk = hdf5::rows_per_chunk(dataset);
  std::vector<double> values(std::min(chunk, count) * coordinates_per_query);
  const hsize_t last = first + count - 1;
  for (hsize_t from = first; from <= last;) {
    const hsize_t to = std::min(last, from - from % chunk + (chunk - 1));
    if (!hdf5::read_rows(dataset, rank, from, to - from + 1, H5T_NATIVE_DOUBLE, values.data())) {
      return fmt::format("{} .. {}", from, to);
    }
    from = to + 1;
  }
  return fmt::format("{} .. {}", first, last);
}

std::optional<FileError> Hdf5Reader::read_points(const Part& part, hsize_t count, QueryBlock& block) const {
  const std::string where = path_in_file(part.kind, hdf5::queries_name);
  block.points.resize(count * coordinates_per_query);
  if (!hdf5::read_rows(part.queries, 3, position_, count, H5T_NATIVE_DOUBLE, block.points.data())) {
    const std::string rows = unreadable_rows(part.queries, 3, position_, count);
    return wrong(where, fmt::format("queries {} cannot be read (truncated or damaged)", rows));
  }
  const auto bad = std::find_if(block.points.begin(), block.points.end(), [](double x) { return !std::isfinite(x); });
  if (bad == block.points.end()) return std::nullopt;
  const auto query = position_ + static_cast<hsize_t>(bad - block.points.begin()) / coordinates_per_query;
  return wrong(fmt::format("{}[{}]", where, query), "a coordinate is not finite");
}

std::optional<FileError> Hdf5Reader::read_truths(const Part& part, hsize_t count, QueryBlock& block) {
  const std::string where = path_in_file(part.kind, hdf5::truth_name);
  truth_numbers_.resize(count);
  if (!hdf5::read_rows(part.truth, 1, position_, count, H5T_NATIVE_INT, truth_numbers_.data())) {
    const std::string rows = unreadable_rows(part.truth, 1, position_, count);
    return wrong(where, fmt::format("truths {} cannot be read (truncated or damaged)", rows));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const int truth = truth_numbers_[i];
    if (truth != 0 && truth != 1) {
      return wrong(fmt::format("{}[{}]", where, position_ + i), fmt::format("truth {} is neither 0 nor 1", truth));
    }
    block.truths.push_back(static_cast<unsigned char>(truth));
  }
  return std::nullopt;
}

/// How many of the next queries make a block; 0 at the end. Goes on to the next part where one is over.
hsize_t Hdf5Reader::rows_at_hand(std::size_t limit) {
  while (part_ < parts_.size() && position_ == parts_[part_].count) {
    ++part_;
    position_ = 0;
  }
  return part_ == parts_.size() ? 0 : std::min<hsize_t>(limit, parts_[part_].count - position_);
}

std::optional<FileError> Hdf5Reader::next(std::size_t limit, QueryBlock& block) {
  const hdf5::Quiet quiet;
  const hdf5::CrashGuard guard(path_);
  block.clear();
  const hsize_t count = rows_at_hand(limit);
  if (count == 0) return std::nullopt;
  const Part& part = parts_[part_];
  block.kind = part.kind;
  if (auto error = read_points(part, count, block)) return error;
  if (part.truth) {
    if (auto error = read_truths(part, count, block)) return error;
  }
  position_ += count;
  return std::nullopt;
}

std::uint64_t Hdf5Reader::skip(std::size_t limit) {
  const hsize_t count = rows_at_hand(limit);
  position_ += count;
  return count;
}

}  // namespace

OpenedReader open_hdf5(const std::filesystem::path& path, std::optional<Kind> kind) {
  auto reader = std::make_unique<Hdf5Reader>(path);
  if (auto error = reader->open(kind)) return *std::move(error);
  return reader;
}

}  // namespace tightrope::ccd
