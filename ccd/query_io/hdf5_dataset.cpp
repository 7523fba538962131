#include "query_io/hdf5_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace tightrope::ccd::hdf5 {
namespace {

/// Sizes of a chunk; empty: the dataset is stored in one piece.
std::vector<hsize_t> chunk_sizes(const Handle& properties) {
  if (H5Pget_layout(properties.get()) != H5D_CHUNKED) return {};
  std::vector<hsize_t> sizes(H5S_MAX_RANK);
  const int rank = H5Pget_chunk(properties.get(), H5S_MAX_RANK, sizes.data());
  sizes.resize(static_cast<std::size_t>(std::max(rank, 0)));
  return sizes;
}

/// HDF5 reads zeros where nothing was written.
bool is_written(const Handle& dataset, const std::vector<hsize_t>& whole, const std::vector<hsize_t>& chunk) {
  if (std::any_of(whole.begin(), whole.end(), [](hsize_t size) { return size == 0; })) return true;
  if (chunk.empty() || chunk.size() != whole.size()) {
    H5D_space_status_t status{};
    return H5Dget_space_status(dataset.get(), &status) >= 0 && status == H5D_SPACE_STATUS_ALLOCATED;
  }
  const Handle all(H5Dget_space(dataset.get()), H5Sclose);
  hsize_t written = 0;
  hsize_t wanted = 1;
  for (std::size_t i = 0; i < chunk.size(); ++i) wanted *= chunk[i] == 0 ? 0 : (whole[i] - 1) / chunk[i] + 1;
  return H5Dget_num_chunks(dataset.get(), all.get(), &written) >= 0 && written == wanted;
}

/// The name of a filter that the values went through and that is not there to undo it; empty: there is none.
std::string missing_filter(const Handle& properties) {
  for (int i = 0; i < H5Pget_nfilters(properties.get()); ++i) {
    unsigned flags = 0;
    std::size_t parameters = 0;
    std::string name(64, '\0');
    const H5Z_filter_t filter = H5Pget_filter2(properties.get(), static_cast<unsigned>(i), &flags, &parameters, nullptr,
                                               name.size(), name.data(), nullptr);
    if (filter >= 0 && H5Zfilter_avail(filter) > 0) continue;
    name.resize(std::min(name.find('\0'), name.size()));
    return name.empty() ? fmt::format("number {}", static_cast<int>(filter)) : name;
  }
  return {};
}

/// Chunks that hold the rows of one, and the bytes of all of them.
struct Slab {
  hsize_t chunks = 1;
  hsize_t bytes = 0;
};

Slab slab_of(const std::vector<hsize_t>& chunk, const std::vector<hsize_t>& whole, std::size_t element) {
  Slab slab{.chunks = 1, .bytes = element};
  const auto times = [](hsize_t x, hsize_t y) {
    return y != 0 && x > std::numeric_limits<hsize_t>::max() / y ? std::numeric_limits<hsize_t>::max() : x * y;
  };
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    const hsize_t across = i == 0 || chunk[i] == 0 ? 1 : (whole[i] + chunk[i] - 1) / chunk[i];
    slab.chunks = times(slab.chunks, across);
    slab.bytes = times(times(slab.bytes, chunk[i]), across);
  }
  return slab;
}

}  // namespace

std::variant<Handle, std::string> open_rows(hid_t group, const char* name) {
  Handle dataset(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  if (!dataset) return "not a readable dataset";
  const Handle properties(H5Dget_create_plist(dataset.get()), H5Pclose);
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  if (!properties || !type) return "not a readable dataset";
  if (H5Pget_layout(properties.get()) == H5D_VIRTUAL || H5Pget_external_count(properties.get()) > 0) {
    return "its values are in other files";
  }
  if (const std::string filter = missing_filter(properties); !filter.empty()) {
    return fmt::format("its values went through filter {}, which this HDF5 library does not have", filter);
  }
  const std::vector<hsize_t> whole = extents(dataset);
  const std::vector<hsize_t> chunk = chunk_sizes(properties);
  const bool in_chunks = !chunk.empty() && chunk.size() == whole.size();
  const Slab slab = in_chunks ? slab_of(chunk, whole, H5Tget_size(type.get())) : Slab{};
  const bool large = slab.bytes > most_bytes_at_once;
  if (large && H5Pget_nfilters(properties.get()) > 0) {
    return fmt::format("compressed in chunks of more than {} MiB; smaller ones can be read", most_bytes_at_once >> 20);
  }
  if (!is_written(dataset, whole, chunk)) return "not all of its values have been written";
  if (!in_chunks || large) return dataset;  // read piece by piece
  // Room for the rows of two chunks, one of which a block may have begun; chunks that have been read through go first.
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  const std::size_t slots = 100 * static_cast<std::size_t>(std::min<hsize_t>(slab.chunks, 10'000)) + 1;
  H5Pset_chunk_cache(access.get(), slots, static_cast<std::size_t>(2 * slab.bytes), 1.0);
  dataset.close();
  dataset = Handle(H5Dopen2(group, name, access.get()), H5Dclose);
  if (!dataset) return "not a readable dataset";
  return dataset;
}

std::vector<hsize_t> extents(const Handle& dataset) {
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  if (!space || H5Sget_simple_extent_type(space.get()) != H5S_SIMPLE) return {};
  std::vector<hsize_t> sizes(static_cast<std::size_t>(std::max(H5Sget_simple_extent_ndims(space.get()), 0)));
  if (H5Sget_simple_extent_dims(space.get(), sizes.data(), nullptr) < 0) return {};
  return sizes;
}

hsize_t rows_per_chunk(const Handle& dataset) {
  const Handle properties(H5Dget_create_plist(dataset.get()), H5Pclose);
  const std::vector<hsize_t> chunk = chunk_sizes(properties);
  return chunk.empty() ? std::numeric_limits<hsize_t>::max() : std::max<hsize_t>(chunk.front(), 1);
}

bool read_rows(const Handle& dataset, int rank, hsize_t first, hsize_t count, hid_t type, void* values) {
  const hsize_t start[3] = {first, 0, 0};
  const hsize_t size[3] = {count, 8, 3};
  const Handle file_space(H5Dget_space(dataset.get()), H5Sclose);
  const Handle memory_space(H5Screate_simple(rank, size, nullptr), H5Sclose);
  return file_space && memory_space &&
         H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start, nullptr, size, nullptr) >= 0 &&
         H5Dread(dataset.get(), type, memory_space.get(), file_space.get(), H5P_DEFAULT, values) >= 0;
}

}  // namespace tightrope::ccd::hdf5
