#pragma once
/// The vector stages of a batch: proofs that queries are free of contact, many at once.

#include <cstddef>
#include <cstdint>

#include "tightrope/batch.h"

namespace tightrope::ccd::batch {

/// Queries of a chunk, by their index in it.
using Index = std::uint16_t;
inline constexpr std::size_t queries_per_chunk = 4096;  ///< 768 KiB of doubles: survivors are read again from the cache

/// Looks at queries first .. first + count - 1, count <= queries_per_chunk. Writes the indices (from `first` on) of
/// those that it cannot prove to be what the method answers `false` to, ascending, and returns how many. `survivors`
/// must hold queries_per_chunk indices.
template <class Source>
using Filter = std::size_t (*)(const Source& queries, std::size_t first, std::size_t count, Index* survivors);

/// None: the method has no vector stages there.
template <class Source>
Filter<Source> filter(Method method, InstructionSet instructions);

}  // namespace tightrope::ccd::batch
