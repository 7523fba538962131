#include "ccd/impact/weights.h"

#include "edge_edge.safe.double.h"
#include "edge_edge.tight.double.h"
#include "safe_cubic.float.double.h"
#include "safe_cubic.tight.double.h"
#include "safe_culling.tight.double.h"
#include "safe_inside.float.double.h"
#include "safe_inside.tight.double.h"
#include "vertex_face.safe.double.h"
#include "vertex_face.tight.double.h"

// After the generated headers:
#include "ccd/methods/safe_contact.h"

namespace tightrope::ccd {
namespace {

/// The moments of the four points, at rest at x (MATH 1.4), in the order of the weights; rescaled.
std::optional<safe::Moments<double>> moments(Kind kind, const std::array<safe::Position<double>, 4>& x) {
  safe::Moments<double> result{};
  const auto place = [&](std::size_t function, const Bounded<double>(&m)[3][3]) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < 3; ++i) result[axis][function][i] = m[i][axis];
    }
  };
  const double *a = x[0].data(), *b = x[1].data(), *c = x[2].data(), *d = x[3].data();
  if (kind == Kind::vertex_face) {
    using predicate = generated::vertex_face<bound::tight, double>;
    predicate::State state;
    predicate::coplanarity_in_range(a, a, b, b, c, c, d, d, state);
    const auto m = predicate::inside_in_range(a, a, b, b, c, c, d, d, state);
    place(0, m.m_bc);
    place(1, m.m_ca);
    place(2, m.m_ab);
  } else {
    using predicate = generated::edge_edge<bound::tight, double>;
    predicate::State state;
    predicate::coplanarity_in_range(a, a, b, b, c, c, d, d, c, c, a, a, state);
    const auto m = predicate::inside_in_range(a, a, b, b, c, c, d, d, c, c, a, a, state);
    place(0, m.m_b);
    place(1, m.m_a);
    place(2, m.m_d);
    place(3, m.m_c);
  }
  if (!rescale(std::span(&result[0][0][0], 36))) return std::nullopt;
  return result;
}

/// How far apart the weights take the features' points to be, in the largest coordinate.
double residual(Kind kind, const std::array<safe::Position<double>, 4>& x, const std::array<double, 4>& weights) {
  double largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double first = kind == Kind::vertex_face ? x[0][axis] : weights[0] * x[0][axis] + weights[1] * x[1][axis];
    double second = weights[2] * x[2][axis] + weights[3] * x[3][axis];
    if (kind == Kind::vertex_face) second += weights[1] * x[1][axis];
    largest = std::max(largest, std::fabs(first - second));
  }
  return largest;
}

}  // namespace

std::array<double, 4> contact_weights(Kind kind, const double* points, double t) {
  const NormalizedQuery<double> query = normalize(points);
  if (query.kind != NormalizedQuery<double>::Kind::scaled) return weights_of_first_vertices(kind);
  std::array<safe::Position<double>, 4> x;
  for (int i = 0; i < 4; ++i) x[static_cast<std::size_t>(i)] = safe::position(moving_point(query.points.data(), i), t);
  // Where the normal is small its weights are bad, but then the contact is next to an edge.
  const auto m = moments(kind, x);
  const auto by_normal = m ? safe::weights_by_normal(kind, *m) : std::nullopt;
  constexpr double good = 0x1p-40;  // of the size of the query
  if (by_normal && residual(kind, x, *by_normal) <= good) return *by_normal;
  const auto by_edge = safe::weights_by_vertex_edge(kind, x);
  return by_normal && residual(kind, x, *by_normal) < residual(kind, x, by_edge) ? *by_normal : by_edge;
}

}  // namespace tightrope::ccd
