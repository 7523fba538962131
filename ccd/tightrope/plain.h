#pragma once
/// Queries on plain memory: the functions of ccd.h and impact.h for callers who have pointers. Needs the standard
/// library alone.

#include <array>
#include <cstddef>
#include <optional>

#include "tightrope/method.h"

namespace tightrope::ccd {

/// Do the features of a query touch? `points` holds 8 points of 3 coordinates in the order of `Kind`; coordinates that
/// are not finite give true. In single precision the same question about the coordinates as they are given, decided in
/// single precision (by `tightrope` and `bsc_exact`: exactly).
bool collides(Kind kind, const double* points, Method method = Method::tightrope);
bool collides(Kind kind, const float* points, Method method = Method::tightrope);

/// `count` queries, `points` holding 24 * count numbers; `results` must hold `count` bytes and gets 0 or 1.
void collides(Kind kind, const double* points, std::size_t count, unsigned char* results,
              Method method = Method::tightrope);
void collides(Kind kind, const float* points, std::size_t count, unsigned char* results,
              Method method = Method::tightrope);

/// The pairs of features. Order of points: vertex-vertex: v w; vertex-edge: v e0 e1; the others as `Kind` has them; all
/// of them at t = 0, then at t = 1.
enum class Pair { vertex_vertex, vertex_edge, vertex_face, edge_edge };

/// The pair that a query of this kind is about.
constexpr Pair pair_of(Kind kind) { return kind == Kind::vertex_face ? Pair::vertex_face : Pair::edge_edge; }

/// Where and when the features touch first.
struct Impact {
  /// In steps, in [0, 1]: time <= first contact <= time + tolerance. 0 only if there is contact at 0, or before the
  /// smallest positive double.
  double time;
  /// Barycentric weights of the pair's points, in their order, where the features touch, about: those of each feature
  /// are in [0, 1] and sum to 1.
  std::array<double, 4> weights;
};

struct ImpactOptions {
  /// Of the step; 0: `time` is the largest double not above the first contact. Negative or NaN: 0.
  double tolerance = 1e-6;
  /// Contacts after it do not count. Above 1 or NaN: 1; negative: no contact counts.
  double t_max = 1;
  /// In the coordinates' unit: coming within this distance counts as contact. `time` is a guarantee as before: they are
  /// farther apart until then; and they come that near by time + tolerance, but for a slack: 2^-20 of the distance and
  /// 2^-47 of the query's extent. Negative: 0, contact itself; infinity or NaN: contact at 0.
  double minimum_separation = 0;
};

/// When and where the features touch first; none: not in [0, t_max], a guarantee. `points` holds 2 * (number of points)
/// points of 3 coordinates in the order of `Pair`. Coordinates that are not finite: contact at 0. The same bits on
/// every machine. In single precision the same question about the coordinates as they are given, decided as exactly.
std::optional<Impact> first_impact(Pair pair, const double* points, const ImpactOptions& options = {});
std::optional<Impact> first_impact(Pair pair, const float* points, const ImpactOptions& options = {});

/// Do the features touch in [0, 1]? Exactly, as first_impact; faster, where the time is not wanted.
bool collides(Pair pair, const double* points);
bool collides(Pair pair, const float* points);

}  // namespace tightrope::ccd
