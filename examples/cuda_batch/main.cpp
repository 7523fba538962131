// A million points against a plane each, on the GPU; on the host where there is none.
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "side_of_plane.tight.double.cuda.h"

using Planes = tightrope::Batch<tightrope::generated::side_of_plane<tightrope::bound::tight, double>>;

void must(cudaError_t error) {
  if (error == cudaSuccess) return;
  std::fprintf(stderr, "%s\n", cudaGetErrorString(error));
  std::exit(1);
}

template <class Number>
Number* on_device(const std::vector<Number>& numbers) {
  void* copy = nullptr;
  must(cudaMalloc(&copy, numbers.size() * sizeof(Number)));
  must(cudaMemcpy(copy, numbers.data(), numbers.size() * sizeof(Number), cudaMemcpyHostToDevice));
  return static_cast<Number*>(copy);
}

int main() {
  // Coordinate c of the point of call i at [c * n + i]. The points are at, just below and just above (0.1, 0.1, 0.3),
  // on the plane x + y + z = 0.5, or as near as doubles come.
  const std::size_t n = 1000000;
  std::vector<double> p(3 * n, 0.1), a(3 * n, 0), b(3 * n, 0), c(3 * n, 0);
  std::vector<signed char> signs(n);
  for (std::size_t i = 0; i < n; ++i) {
    a[i] = b[n + i] = c[2 * n + i] = 0.5;
    p[2 * n + i] = 0.3 + 1e-15 * (static_cast<int>(i % 3) - 1);
  }

  Planes planes;
  int devices = 0;
  if (cudaGetDeviceCount(&devices) == cudaSuccess && devices > 0) {
    double* const arrays[] = {on_device(p), on_device(a), on_device(b), on_device(c)};
    signed char* const answers = on_device(signs);
    planes.inputs = {{arrays[0], n}, {arrays[1], n}, {arrays[2], n}, {arrays[3], n}};
    planes.result.evaluate.volume = {.signs = answers, .pitch = n};
    must(planes.launch(n, cudaStream_t{}));
    must(cudaMemcpy(signs.data(), answers, n, cudaMemcpyDeviceToHost));  // waits for the kernel
    must(cudaFree(answers));
    for (double* array : arrays) must(cudaFree(array));
  } else {
    std::puts("no GPU: on the host");
    planes.inputs = {{p.data(), n}, {a.data(), n}, {b.data(), n}, {c.data(), n}};
    planes.result.evaluate.volume = {.signs = signs.data(), .pitch = n};
    for (std::size_t i = 0; i < n; ++i) planes.evaluate(i);
  }

  std::size_t count[3] = {};
  for (const signed char sign : signs) ++count[sign + 1];
  std::printf("%zu points: %zu below, %zu above, %zu too close to tell\n", n, count[0], count[2], count[1]);
}
