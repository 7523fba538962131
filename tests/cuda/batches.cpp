/// What every generated batch answers, as one line a predicate and family of inputs:
///
///     NAME FAMILY: HASH, finite VALUES, definite SIGNS
///
/// The same source is compiled by the C++ compiler and by nvcc, for the host and (`batches device`) for the GPU: the
/// three outputs must be the same. All bits count, but for those of a NaN. Inputs are seeded.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "connect.h"
#include "inputs.h"

#if defined(__CUDACC__)
#include "device.h"
#endif

namespace tightrope_test {
namespace {

constexpr std::size_t calls = 1000;
constexpr std::size_t pitch = calls + 5;  // neither is a multiple of a block's threads

/// The numbers of a batch; where they lie is cut up by `connect`.
template <class Real>
struct Numbers {
  std::vector<Real> inputs;
  std::vector<signed char> signs;
  std::vector<Real> values;
  std::vector<Real> bounds;
};

/// For `connect`: counts, and hands out the places behind these pointers, one after another.
template <class Real>
struct Places {
  void input(tightrope::ArgumentArray<Real>& array, std::size_t numbers) {
    array = {inputs + inputs_used, pitch};
    inputs_used += numbers * pitch;
  }
  void input(tightrope::BoundedArgumentArray<Real>& array, std::size_t numbers) {
    array = {inputs + inputs_used, inputs + inputs_used + numbers * pitch, pitch};
    error_bounds.push_back({inputs_used + numbers * pitch, numbers * pitch});
    inputs_used += 2 * numbers * pitch;
  }
  void output(tightrope::OutputArray<Real>& array, std::size_t numbers) {
    array = {signs + outputs_used, values + outputs_used, bounds + outputs_used, pitch};
    outputs_used += numbers * pitch;
  }

  const Real* inputs = nullptr;
  signed char* signs = nullptr;
  Real* values = nullptr;
  Real* bounds = nullptr;
  std::size_t inputs_used = 0;
  std::size_t outputs_used = 0;
  std::vector<std::pair<std::size_t, std::size_t>> error_bounds = {};  ///< first place and count in `inputs`
};

/// Seeded inputs, and outputs that no call writes.
template <class Batch, class Real>
Numbers<Real> numbers_of(const char* name, const Family& family) {
  Batch batch;
  Places<Real> places;
  connect(batch, places);
  Numbers<Real> numbers{std::vector<Real>(places.inputs_used), std::vector<signed char>(places.outputs_used, 7),
                        std::vector<Real>(places.outputs_used, 7), std::vector<Real>(places.outputs_used, 7)};
  Random random(name, family.name);
  for (Real& x : numbers.inputs) x = random.number<Real>(family.kind);
  for (const auto& [first, count] : places.error_bounds) {
    for (std::size_t i = first; i < first + count; ++i)
      numbers.inputs[i] = random.error_bound(numbers.inputs[i - count]);
  }
  return numbers;
}

template <class Batch, class Real>
void evaluate_on_host(Numbers<Real>& numbers) {
  Batch batch;
  Places<Real> places{numbers.inputs.data(), numbers.signs.data(), numbers.values.data(), numbers.bounds.data()};
  connect(batch, places);
  for (std::size_t i = 0; i < calls; ++i) batch.evaluate(i);
}

#if defined(__CUDACC__)
template <class Batch, class Real>
void evaluate_on_device(Numbers<Real>& numbers) {
  const OnDevice inputs(numbers.inputs);
  const OnDevice signs(numbers.signs);
  const OnDevice values(numbers.values);
  const OnDevice bounds(numbers.bounds);
  Batch batch;
  Places<Real> places{inputs.data(), signs.data(), values.data(), bounds.data()};
  connect(batch, places);
  must(batch.launch(calls, nullptr));
  must(cudaDeviceSynchronize());
}
#endif

template <class Real>
std::uint64_t bits(Real x) {
  if (x != x) return 0x7ff8;
  if constexpr (sizeof(Real) == 4) return std::bit_cast<std::uint32_t>(x);
  if constexpr (sizeof(Real) == 8) return std::bit_cast<std::uint64_t>(x);
}

template <class Real>
void print(const char* name, const char* family, const Numbers<Real>& numbers) {
  std::uint64_t hash = 0;
  std::size_t finite = 0;
  std::size_t definite = 0;
  const auto add = [&](std::uint64_t x) { hash = (std::rotl(hash, 23) ^ x) * 0x9e3779b97f4a7c15; };
  for (std::size_t i = 0; i < numbers.signs.size(); ++i) {
    add(bits(numbers.values[i]));
    add(bits(numbers.bounds[i]));
    add(static_cast<unsigned char>(numbers.signs[i]));
    if (i % pitch >= calls) continue;
    if (std::isfinite(numbers.values[i])) ++finite;
    if (numbers.signs[i] == 1 || numbers.signs[i] == -1) ++definite;
  }
  std::printf("%s %s: %016llx, finite %zu, definite %zu\n", name, family, static_cast<unsigned long long>(hash), finite,
              definite);
}

struct Run {
  bool on_device;

  template <class Batch>
  void operator()(const char* name) const {
    using Real = typename Batch::predicate::real;
    for (const Family& family : families) {
      auto numbers = numbers_of<Batch, Real>(name, family);
#if defined(__CUDACC__)
      if (on_device) evaluate_on_device<Batch>(numbers);
#endif
      if (!on_device) evaluate_on_host<Batch>(numbers);
      print(name, family.name, numbers);
    }
  }
};

}  // namespace
}  // namespace tightrope_test

int main(int count, char** arguments) {
  const bool on_device = count > 1 && std::strcmp(arguments[1], "device") == 0;
#if defined(__CUDACC__)
  if (on_device && !tightrope_test::device_is_there()) {
    std::puts("no GPU");
    return 77;
  }
#else
  if (on_device) return 2;
#endif
  tightrope_test::for_every_batch(tightrope_test::Run{on_device});
}
