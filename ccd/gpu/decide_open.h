#pragma once
/// The processor's part: exact arithmetic for what a device leaves open, and copies, on several threads.

#include <cstddef>
#include <functional>

#include "tightrope/batch.h"

namespace tightrope::ccd::gpu {

/// `part(first, count)` for parts of 0 .. count - 1 that are `grain` long or shorter, on up to `threads` threads (0: as
/// many as the machine has). False if one of them threw, or no thread was to be had: there was no memory.
bool in_parts(std::size_t count, std::size_t grain, int threads,
              const std::function<void(std::size_t, std::size_t)>& part) noexcept;

/// `rows` rows of `width` bytes, as far apart as `from_pitch` says, to memory where they lie one after another. False:
/// no memory.
bool copy_rows(void* to, std::size_t width, const void* from, std::size_t from_pitch, std::size_t rows,
               int threads) noexcept;

/// The answers to queries first .. first + count - 1 whose result byte is 2, by the method's functions for one query.
/// `open`: how many they are. False: no memory.
template <class Real>
bool decide_open(const Queries<Real>& queries, std::size_t first, std::size_t count, unsigned char* results,
                 Method method, int threads, std::size_t& open) noexcept;

}  // namespace tightrope::ccd::gpu
