#pragma once
/// The vector stages of a batch: proofs that queries are free of contact, many at once.

#include <cstddef>
#include <cstdint>

#include "ccd/batch/vector_tests.h"
#include "tightrope/batch.h"

namespace tightrope::ccd::batch {

/// A query of a chunk.
using Index = std::uint16_t;
inline constexpr std::size_t queries_per_chunk = 4096;  ///< 768 KiB of doubles: survivors are read again from the cache

template <template <class> class Source, class Real>
using RunFilter = std::size_t (*)(const Source<Real>& queries, const VectorTests<Real>& tests, std::size_t first,
                                  std::size_t count, Index* survivors);

template <template <class> class Source, class Real>
class Filter {
 public:
  Filter(Method method, Kind kind, InstructionSet instructions, Arithmetic arithmetic = Arithmetic::separate);

  /// False: this method has no vector stages with these instructions.
  explicit operator bool() const { return run_ != nullptr && tests_.first != nullptr; }

  /// Looks at queries first .. first + count - 1, count <= queries_per_chunk. Writes the indices, from `first` on and
  /// ascending, of those that it cannot prove the method to answer `false` to, and returns how many. `survivors` must
  /// hold queries_per_chunk indices.
  std::size_t operator()(const Source<Real>& queries, std::size_t first, std::size_t count, Index* survivors) const {
    return run_(queries, tests_, first, count, survivors);
  }

 private:
  RunFilter<Source, Real> run_;
  VectorTests<Real> tests_;
};

}  // namespace tightrope::ccd::batch
