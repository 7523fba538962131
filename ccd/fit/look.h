#pragma once
/// The first looks that a fit chooses from, and their predicates.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "tightrope/ccd.h"

namespace tightrope::ccd {

/// The full model's own first look has none of these.
struct Look {
  bool single = false;     ///< coordinates and operations in single precision
  bool range = false;      ///< one bound for the scene (mode static), else run-time maxima (SafeBound)
  bool at_rest = false;    ///< an instance for a feature at rest, where one is
  bool both_ends = false;  ///< the plane at t = 1 too, before the full model gets the query

  bool operator==(const Look&) const = default;
};

/// How much there is to it: of two looks that are as fast the simpler one is taken.
inline int complexity(const Look& look) {
  return int{look.single} + int{look.range} + 2 * int{look.at_rest} + int{look.both_ends};
}

/// The least k with largest <= 2^k; none where bounds for coordinates up to 2^k would overflow, or drown in underflow.
std::optional<int> range_exponent(double largest, bool single);

/// The source of the look's predicates, PREFIX_plane_of_face and PREFIX_face_at_rest, or PREFIX_plane_of_edges and
/// PREFIX_edge_at_rest; with a range of 2^exponent if there is one.
std::string predicates(std::string_view prefix, Kind kind, std::optional<int> exponent);

/// Decides `count` queries, 24 numbers each; results as `collides` gives them.
template <class Real>
using Contacts = void (*)(const Real* points, std::size_t count, unsigned char* results);

/// The look with the full model behind it, for coordinates up to 1 where it has a range. (Scaled by a power of two
/// every scene is such a one.)
template <class Real>
Contacts<Real> unit_contacts(Kind kind, const Look& look);

/// The look alone: 1 where it leaves the query open.
template <class Real>
Contacts<Real> unit_open(Kind kind, const Look& look);

}  // namespace tightrope::ccd
