// Asks when moving triangles' features touch during a time step, with positions at its start and its end.
#include <tightrope/impact.h>

#include <cstdio>

namespace ccd = tightrope::ccd;
using Eigen::Vector3d;

void tell(const char* what, const std::optional<ccd::Impact>& impact) {
  if (impact) {
    std::printf("%s touches at %.9g of the step\n", what, impact->time);
  } else {
    std::printf("%s no contact\n", what);
  }
}

int main() {
  // A vertex falls through a face that moves sideways.
  const Vector3d f0(0, 0, 0), f1(1, 0, 0), f2(0, 1, 0), drift(0.1, 0.0, 0.0);
  const Vector3d start(0.3, 0.3, 1.0), fall(0.0, 0.0, -2.0);
  tell("vertex falls through:", ccd::vertex_face(start, f0, f1, f2, start + fall, f0 + drift, f1 + drift, f2 + drift));
  const Vector3d beside(1.5, 0.3, 1.0);  // `no contact` is a guarantee
  tell("vertex passes beside:",
       ccd::vertex_face(beside, f0, f1, f2, beside + fall, f0 + drift, f1 + drift, f2 + drift));
  // One edge sweeps across another; the time is the largest double that is not after the contact.
  const Vector3d a0(-1, 0, 0.5), a1(1, 0, 0.5), b0(0, -1, 0), b1(0, 1, 0), down(0, 0, -1);
  tell("edges cross:         ", ccd::edge_edge(a0, a1, b0, b1, a0 + down, a1 + down, b0, b1, {.tolerance = 0}));
  // Where the time is not needed:
  const bool crosses = ccd::edge_edge_collides(a0, a1, b0, b1, a0 + down, a1 + down, b0, b1);
  std::printf("edges collide:        %s\n", crosses ? "yes" : "no");
}
