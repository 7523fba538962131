// Asks whether moving triangles' features touch during a time step, with positions at its start and its end.
#include <tightrope/ccd.h>

#include <cstdio>

namespace ccd = tightrope::ccd;
using Eigen::Vector3d;

const char* answer(bool contact) { return contact ? "touches" : "no contact"; }

int main() {
  // A vertex falls through a face that moves sideways.
  const Vector3d f0(0, 0, 0), f1(1, 0, 0), f2(0, 1, 0), drift(0.1, 0.0, 0.0);
  const Vector3d start(0.3, 0.3, 1.0), fall(0.0, 0.0, -2.0);
  std::printf("vertex falls through:  %s\n",
              answer(ccd::vertex_face(start, f0, f1, f2, start + fall, f0 + drift, f1 + drift, f2 + drift)));
  const Vector3d beside(1.5, 0.3, 1.0);  // `no contact` is a guarantee
  std::printf("vertex passes beside:  %s\n",
              answer(ccd::vertex_face(beside, f0, f1, f2, beside + fall, f0 + drift, f1 + drift, f2 + drift)));
  // One edge sweeps across another.
  const Vector3d a0(-1, 0, 0.5), a1(1, 0, 0.5), b0(0, -1, 0), b1(0, 1, 0), down(0, 0, -1);
  std::printf("edges cross:           %s\n", answer(ccd::edge_edge(a0, a1, b0, b1, a0 + down, a1 + down, b0, b1)));
}
