// One call for all pairs of two meshes: a sheet falls onto a curved one, and every vertex asks about every face.
#include <tightrope/batch.h>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace ccd = tightrope::ccd;

constexpr std::uint32_t cells = 16;  // along a side of a sheet

/// Appends the vertices of a sheet of size 1 x 1 whose corner is at (x, y), at height z plus `bend` times x y.
void append_sheet(std::vector<double>& vertices, double x, double y, double z, double bend) {
  for (std::uint32_t i = 0; i <= cells; ++i) {
    for (std::uint32_t j = 0; j <= cells; ++j) {
      const double u = double(i) / cells, v = double(j) / cells;
      vertices.insert(vertices.end(), {x + u, y + v, z + bend * u * v});
    }
  }
}

int main() {
  // Vertices of both sheets at the start and at the end of the step: the first falls, the second lies still.
  std::vector<double> start, end;
  append_sheet(start, 1.0 / 64, 1.0 / 32, 0.5, 0);
  append_sheet(end, 1.0 / 64, 1.0 / 32, -0.5, 0);
  const std::uint32_t vertices = std::uint32_t(start.size() / 3);
  append_sheet(start, 0, 0, 0, 0.125);
  append_sheet(end, 0, 0, 0, 0.125);

  // Four vertices a query: the vertex, and the three of the face.
  std::vector<std::uint32_t> indices;
  for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
    for (std::uint32_t i = 0; i < cells; ++i) {
      for (std::uint32_t j = 0; j < cells; ++j) {
        const std::uint32_t a = vertices + i * (cells + 1) + j, b = a + cells + 1;
        indices.insert(indices.end(), {vertex, a, b, a + 1});
        indices.insert(indices.end(), {vertex, b, b + 1, a + 1});
      }
    }
  }

  const ccd::MeshQueries<double> queries{ccd::Kind::vertex_face, indices.size() / 4, start.data(), end.data(),
                                         indices.data()};
  const ccd::BatchOptions options{.threads = 0};  // all processors, the best instructions; the same answers as without
  std::vector<unsigned char> touches(queries.count);
  std::vector<double> times(queries.count);  // of the step; infinity where there is no contact
  if (ccd::collides(queries, touches.data(), options) != ccd::BatchStatus::done) return 1;
  if (ccd::impact_times(queries, times.data(), {.tolerance = 0}, options) != ccd::BatchStatus::done) return 1;

  std::printf("queries:        %zu\n", queries.count);
  std::printf("contacts:       %td\n", std::count(touches.begin(), touches.end(), 1));
  std::printf("first contact:  %.9g of the step\n", *std::min_element(times.begin(), times.end()));
  return 0;
}
