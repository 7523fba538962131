/// The loops of one instruction set. Compiled once for each, with
///   TIGHTROPE_LIMIT_KERNELS  the name of the function that gives them
///   TIGHTROPE_LIMIT_BYTES    bytes a vector; 0: no vectors, one number after another
/// and the compiler's options for the set. Nothing of the standard library is called here: an inline function of it
/// compiled with these options could be the one that the whole program gets.

#include <cstddef>
#include <utility>

#include "limits.h"

namespace tightrope::bench {
const LimitKernels& TIGHTROPE_LIMIT_KERNELS();

namespace {

template <class Real, std::size_t bytes>
struct VectorOf {
  using type [[gnu::vector_size(bytes)]] = Real;
  static constexpr std::size_t lanes = bytes / sizeof(Real);
};
template <class Real>
struct VectorOf<Real, 0> {
  using type = Real;
  static constexpr std::size_t lanes = 1;
};

template <class Real>
using Vector = typename VectorOf<Real, TIGHTROPE_LIMIT_BYTES>::type;
template <class Real>
inline constexpr std::size_t lanes = VectorOf<Real, TIGHTROPE_LIMIT_BYTES>::lanes;

template <class Real>
Vector<Real> load(const Real* numbers) {
  Vector<Real> vector;
  __builtin_memcpy(&vector, numbers, sizeof(vector));
  return vector;
}

template <class Real>
Real sum_of_lanes(Vector<Real> vector) {
  Real numbers[lanes<Real>];
  __builtin_memcpy(numbers, &vector, sizeof(vector));
  Real sum = 0;
  for (const Real x : numbers) sum += x;
  return sum;
}

/// Reads at `streams` places of the array at a time, `per_stream` vectors at each.
template <std::size_t streams, std::size_t per_stream>
double read(const double* numbers, std::size_t count) {
  constexpr std::size_t step = per_stream * lanes<double>;
  static_assert(read_granularity % (streams * step) == 0);
  const std::size_t distance = count / streams;
  Vector<double> sums[streams * per_stream] = {};
  const auto add = [&]<std::size_t... i>(const double* x, std::index_sequence<i...>) __attribute__((always_inline)) {
    ((sums[i] += load(x + (i / per_stream) * distance + (i % per_stream) * lanes<double>)), ...);
  };
  for (std::size_t at = 0; at < distance; at += step) {
    add(numbers + at, std::make_index_sequence<streams * per_stream>());
  }
  double sum = 0;
  for (const Vector<double>& x : sums) sum += sum_of_lanes<double>(x);
  return sum;
}

/// `chains` vectors, each of which waits for itself alone.
template <class Real, std::size_t chains>
Real products_and_sums(Real factor, Real term, std::size_t steps) {
  const Vector<Real> factors = Vector<Real>{} + factor, terms = Vector<Real>{} + term;
  Vector<Real> x[chains];
  for (std::size_t i = 0; i < chains; ++i) x[i] = terms + static_cast<Real>(i);  // unlike: else they were one
  const auto advance = [&]<std::size_t... i>(std::index_sequence<i...>) __attribute__((always_inline)) {
    ((x[i] = x[i] * factors + terms), ...);
  };
  for (std::size_t step = 0; step < steps; ++step) advance(std::make_index_sequence<chains>());
  Real sum = 0;
  for (const Vector<Real>& vector : x) sum += sum_of_lanes<Real>(vector);
  return sum;
}

constexpr ReadKernel reads[] = {read<1, 8>, read<2, 4>, read<4, 2>, read<4, 4>, read<8, 1>, read<8, 2>};

template <class Real, std::size_t chains>
constexpr ArithmeticKernel<Real> kernel{products_and_sums<Real, chains>, lanes<Real>, chains};
template <class Real>
constexpr ArithmeticKernel<Real> arithmetic[] = {kernel<Real, 6>,  kernel<Real, 8>,  kernel<Real, 10>,
                                                 kernel<Real, 12>, kernel<Real, 16>, kernel<Real, 24>};
}  // namespace

const LimitKernels& TIGHTROPE_LIMIT_KERNELS() {
  static constexpr LimitKernels kernels{reads, arithmetic<double>, arithmetic<float>};
  return kernels;
}

}  // namespace tightrope::bench
