#pragma once
/// The survey of degenerate families: queries whose truth is known from how they are made. Half of them touch as
/// narrowly as can be (in one point, for a moment, or along an edge), half miss by a margin of 2^-10 .. 2^-45 of their
/// size.
///
/// Each is first made on a dyadic grid in simple coordinates, then takes a random affine map that is exact there, so
/// that nothing changes: shears, a permutation and reflection of the axes, a translation of each end of the step, a
/// power of two.

#include <optional>

#include "scenes/point.h"
#include "scenes/random.h"
#include "scenes/scene.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd {

struct Constructed {
  Query query;
  std::optional<bool> touches;  ///< empty: only the oracle knows
};

/// A query of one of the survey's scenes (SceneInfo::survey).
Constructed construct(Scene scene, Kind kind, Random& random);

// Parts of it

/// A query while it is made, in simple coordinates: all numbers are multiples of the margin or coarse.
struct Construction {
  Construction(Kind kind_of_query, Random& source, int finest_margin)
      : kind(kind_of_query),
        random(source),
        finest(finest_margin),
        touches(source.chance(0.5)),
        margin(std::ldexp(1.0, source.integer(-finest_margin, -10))),
        gap(touches ? 0 : margin) {}

  Kind kind;
  Random& random;
  int finest;     ///< the margin is at least 2^-finest
  bool touches;   ///< to be made touching
  double margin;  ///< 2^-10 .. 2^-45: by how much others miss
  double gap;     ///< 0 if touching, else the margin
  Query query{};

  /// Points of the two features: the first one has two (edge-edge) or three (vertex-face), the second one two or one.
  /// Several families keep the first one at z <= 0, the second one at z >= 0: apart but for what is at z = 0.
  std::size_t first(std::size_t i) const { return kind == Kind::vertex_face ? i + 1 : i; }
  std::size_t second(std::size_t i) const { return kind == Kind::vertex_face ? 0 : i + 2; }
  std::size_t first_size() const { return kind == Kind::vertex_face ? 3 : 2; }
  std::size_t second_size() const { return kind == Kind::vertex_face ? 1 : 2; }

  /// A multiple of 1/8 in [-2, 2], positive or not zero.
  double coarse() { return 0.125 * random.integer(-16, 16); }
  double coarse_positive() { return 0.125 * random.integer(1, 16); }
  double coarse_not_zero() { return random.chance(0.5) ? coarse_positive() : -coarse_positive(); }
  Point coarse_at(double z);  ///< x and y coarse
  double time() { return 0.125 * random.integer(0, 8); }

  void set(std::size_t point, const Point& start, const Point& end) {
    query.start[point] = start;
    query.end[point] = end;
  }
  /// The point passes `start` .. `end`, another point's path, at time t with relative velocity u.
  void pass(std::size_t point, const Point& start, const Point& end, double t, const Point& u) {
    set(point, start - t * u, end + (1 - t) * u);
  }
  /// What the construction has not placed yet: points of the first feature from the i-th on get z < 0, of the second
  /// from the j-th on z > 0, at both ends.
  void place_rest(std::size_t i, std::size_t j);

  Constructed done() const { return {query, touches}; }
};

// survey_touch.cpp: contact of a corner or a side for a moment or along the way
Constructed coplanar(Construction c);
Constructed sliding(Construction c);
Constructed through_vertex(Construction c);
Constructed through_edge(Construction c);
Constructed step_ends(Construction c);
Constructed at_rest(Construction c);

// survey_thin.cpp: features with less than their dimension
Constructed parallel_edges(Construction c);
Constructed zero_area(Construction c);
Constructed zero_length(Construction c);

// survey_roots.cpp: times of contact that are no simple roots, turning, displacements of all sizes
Constructed double_root(Construction c);
Constructed triple_root(Construction c);
Constructed rotation(Construction c);
Constructed displacements(Kind kind, Random& random);  ///< not to be mapped: exact as it is

}  // namespace tightrope::ccd
