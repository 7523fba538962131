#pragma once
/// Datasets as a query file has them: rows that are read in order, in bounded memory.

#include <string>
#include <variant>
#include <vector>

#include "query_io/hdf5_handle.h"

namespace tightrope::ccd::hdf5 {

/// Most that is decompressed at a time.
inline constexpr hsize_t most_bytes_at_once = hsize_t{256} << 20;

/// Opens a dataset to read its rows in order: what chunks of one range of rows hold is unpacked once. Or what is wrong
/// with it: not readable, its values not all written, not in this file, or packed so that reading takes too much memory
/// or a filter that is not there.
std::variant<Handle, std::string> open_rows(hid_t group, const char* name);

/// Extents of a dataset; empty: a scalar, or they cannot be told.
std::vector<hsize_t> extents(const Handle& dataset);

/// Rows that are stored together; of a dataset that is not chunked, all.
hsize_t rows_per_chunk(const Handle& dataset);

/// Reads rows [first, first + count) of a dataset of n (rank 1) or n x 8 x 3 elements (rank 3) as `type`.
bool read_rows(const Handle& dataset, int rank, hsize_t first, hsize_t count, hid_t type, void* values);

}  // namespace tightrope::ccd::hdf5
