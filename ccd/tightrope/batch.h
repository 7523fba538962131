#pragma once
/// Many queries of one kind at once, on plain memory: vector instructions chosen at run time, and threads.
///
/// Every method of ccd.h, with the very answers that it gives one query: the same bits with all instruction sets, any
/// number of threads and every layout. Nothing is thrown. Beyond the arguments a call needs less than 64 KiB of stack a
/// thread and no heap, but for what exact arithmetic takes for the few queries that get there.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "tightrope/plain.h"

namespace tightrope::ccd {

/// The order of the numbers of `count` queries.
enum class Layout : unsigned char {
  by_query,       ///< array of structures: the 24 numbers of query i, in the order of `Kind`, from points + 24 i on
  by_coordinate,  ///< structure of arrays: number c, 0 .. 23, of query i is points[c * pitch + i]
};

/// Queries on their own. Real: double, float.
template <class Real>
struct Queries {
  Kind kind;
  std::size_t count;
  const Real* points;  ///< 24 numbers a query; none if count is 0. Any alignment that Real itself has.
  Layout layout = Layout::by_query;
  std::size_t pitch = 0;  ///< by_coordinate: at least `count`
};

/// Queries between vertices that are stored once.
template <class Real>
struct MeshQueries {
  Kind kind;
  std::size_t count;
  const Real* vertices_t0;       ///< 3 numbers a vertex, at t = 0
  const Real* vertices_t1;       ///< the same vertices at t = 1
  const std::uint32_t* indices;  ///< 4 vertices a query, in the order of `Kind`: v f0 f1 f2; ea0 ea1 eb0 eb1
};

/// What a batch's first tests run on. `scalar`: one query after another.
enum class InstructionSet : unsigned char { scalar, sse4, neon, avx2, avx512 };

std::string_view name(InstructionSet instructions);  ///< "scalar", "sse4", ..
std::optional<InstructionSet> instruction_set_by_name(std::string_view name);
/// Those that this build has and this machine can run, best last; `scalar` is always among them.
std::span<const InstructionSet> instruction_sets();

/// How the vector stages compute.
enum class Arithmetic : unsigned char {
  separate,  ///< every product and sum rounded: the same bits on every machine
  fused,     ///< the first look of method `tightrope` by fused multiply-adds: it settles a query by a proof or not at
             ///< all, and what it leaves is decided as ever, so that answers and times are the same. Other methods
             ///< have no such form, nor have `scalar` and `sse4`.
};

struct BatchOptions {
  Method method = Method::tightrope;
  int threads = 1;                                  ///< 0, or more than there are processors: as many as there are
  std::optional<InstructionSet> instructions = {};  ///< none: the best there is
  Arithmetic arithmetic = Arithmetic::separate;
};

enum class BatchStatus : unsigned char {
  done,
  out_of_memory,     ///< exact arithmetic or the threads got none; what the results hold is not said
  invalid_argument,  ///< a pitch below `count`, a null pointer, a negative number of threads, instructions or
                     ///< arithmetic that are not there, or a method that has no such result; nothing is written
};

/// results[i] = 1 if query i collides, else 0; `results` must hold `count` bytes.
template <class Real>
[[nodiscard]] BatchStatus collides(const Queries<Real>& queries, unsigned char* results,
                                   const BatchOptions& options = {}) noexcept;
template <class Real>
[[nodiscard]] BatchStatus collides(const MeshQueries<Real>& queries, unsigned char* results,
                                   const BatchOptions& options = {}) noexcept;

/// Bit i % 8 of bits[i / 8] tells whether query i collides; `bits` must hold (count + 7) / 8 bytes. Bits beyond
/// `count` are 0.
template <class Real>
[[nodiscard]] BatchStatus collides_bits(const Queries<Real>& queries, unsigned char* bits,
                                        const BatchOptions& options = {}) noexcept;
template <class Real>
[[nodiscard]] BatchStatus collides_bits(const MeshQueries<Real>& queries, unsigned char* bits,
                                        const BatchOptions& options = {}) noexcept;

/// times[i] = time of impact of query i in steps, infinity if there is none; `times` must hold `count` numbers. Method
/// `tightrope`: Impact::time of first_impact with these options. `safe`, `safe_tight`: Contact::earliest of
/// first_contact, infinity where it is after t_max; they know no other option (a minimum separation is invalid). Other
/// methods have no times.
template <class Real>
[[nodiscard]] BatchStatus impact_times(const Queries<Real>& queries, double* times, const ImpactOptions& impact = {},
                                       const BatchOptions& options = {}) noexcept;
template <class Real>
[[nodiscard]] BatchStatus impact_times(const MeshQueries<Real>& queries, double* times,
                                       const ImpactOptions& impact = {}, const BatchOptions& options = {}) noexcept;

}  // namespace tightrope::ccd
