#pragma once
/// Where labels go so that none covers another, nor a marker.

#include <span>
#include <vector>

#include "codegen/charts/geometry.h"

namespace tightrope::charts {

/// A label wanted for a marker.
struct LabelRequest {
  Place marker;
  double radius = 0;  ///< of the marker
  double width = 0;
  double height = 0;
};

struct LabelPlace {
  bool placed = false;  ///< false: there is no room for it
  Box box;
  bool has_leader = false;  ///< the label stands so far off that a line must lead to its marker
  Segment leader;           ///< from the marker's rim to the box
};

/// A place for each request, inside of `frame`. No box of a label overlaps another one, nor one of `obstacles` (the
/// markers, their own among them). Among such places a local search from several starts looks for labels near their
/// markers, few crossings of leaders, and few labels upon leaders and `lines`. Deterministic.
std::vector<LabelPlace> place_labels(std::span<const LabelRequest> requests, const Box& frame,
                                     std::span<const Box> obstacles, std::span<const Segment> lines);

}  // namespace tightrope::charts
