#pragma once
/// What reads the signs of bounded numbers on behalf of the methods. A method takes its reader as a template parameter,
/// so that counting them costs nothing where it is not wanted, and tests can forget some (MATH 6.4).

#include <cstdint>

#include "ccd/host_device.h"
#include "tightrope/sign.h"

namespace tightrope::ccd {

struct SignReader {
  template <class Real>
  TIGHTROPE_HOST_DEVICE Sign operator()(const Bounded<Real>& x) const {
    return sign(x);
  }
};

/// How many signs a method read, and how many of them it met uncertain.
struct SignCounts {
  std::uint64_t read = 0;
  std::uint64_t uncertain = 0;
};

class CountingSignReader {
 public:
  template <class Real>
  Sign operator()(const Bounded<Real>& x) {
    const Sign result = sign(x);
    counts_.read += 1;
    counts_.uncertain += result == Sign::uncertain ? 1 : 0;
    return result;
  }
  const SignCounts& counts() const { return counts_; }

 private:
  SignCounts counts_;
};

}  // namespace tightrope::ccd
