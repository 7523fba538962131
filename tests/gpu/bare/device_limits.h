#pragma once
/// The physical limits of a device, measured.

#include <cstddef>

namespace tightrope::gpu_check {

double copy_bytes_per_second();      ///< read and written, within the device's memory
double upload_bytes_per_second();    ///< from pinned memory
double fma_operations_per_second();  ///< in double precision; an fma counts two

/// by_coordinate[c * count + i] = by_query[24 i + c], in the device's memory.
template <class Real>
void transpose(const Real* by_query, std::size_t count, Real* by_coordinate);

}  // namespace tightrope::gpu_check
