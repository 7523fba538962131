// Prints every bit that generated code computes on random inputs: the text must not depend on the compiler's flags.
// Exit status 77 where the processor has no fused multiply-add and the flags ask for it.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>

#include "contraction.cpp"

namespace {

std::mt19937_64 random_bits(20150801);

/// Signs, exponents and significands that make sums cancel and round: exponents within 2^-12 .. 2^4 of each other, now
/// and then anywhere. Made of bits, so that the flags under test have no say.
double random_number() {
  const std::uint64_t bits = random_bits();
  const std::uint64_t exponent = bits % 64 == 0 ? random_bits() % 2046 : 1011 + (bits >> 8) % 16;
  const std::uint64_t word = (bits & (1ull << 63)) | exponent << 52 | (random_bits() >> 12);
  double result;
  std::memcpy(&result, &word, sizeof result);
  return result;
}

template <class Real>
void print(Real x) {
  if (x != x) {  // which NaN is the processor's business
    std::puts("nan");
    return;
  }
  std::uint64_t word = 0;
  std::memcpy(&word, &x, sizeof x);
  std::printf("%016llx\n", static_cast<unsigned long long>(word));
}

template <class Bound, class Real>
void run(const char* name) {
  std::puts(name);
  for (int i = 0; i < 1000; ++i) {
    Real x[24];
    Bounded<Real> u[12], y[32] = {};
    for (Real& number : x) number = static_cast<Real>(random_number());
    for (Bounded<Real>& number : u) {
      number.value = static_cast<Real>(random_number());
      const Real bound = static_cast<Real>(random_number());
      number.bound = (bound < 0 ? -bound : bound) * static_cast<Real>(0x1p-20);
    }
    evaluate_stages<Bound>(x, y);
    evaluate_incircle<Bound>(x, y + 17);
    evaluate_bounded<Bound>(u, x[0], y + 18);
    for (int k = 0; k < 22; ++k)
      print(y[k].value), print(y[k].bound), std::printf("%d\n", static_cast<int>(sign(y[k])));
  }
}

}  // namespace

int main() {
#if defined(__FMA__)
  if (!__builtin_cpu_supports("fma")) return 77;
#endif
  run<bound::none, double>("float double");
  run<bound::safe, double>("safe double");
  run<bound::tight, double>("tight double");
  run<bound::safe, float>("safe float");
  run<bound::tight, float>("tight float");
}
