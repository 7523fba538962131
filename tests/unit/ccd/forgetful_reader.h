#pragma once
/// A reader of signs that forgets some of them (MATH 6.4): an answer must never rest on what is not known.

#include <cstdint>

#include "contacts.h"
#include "tightrope/sign.h"

namespace tightrope::ccd::test {

class ForgetfulReader {
 public:
  /// Forgets `percent` of all signs.
  ForgetfulReader(std::uint64_t seed, int percent) : random_(seed), percent_(percent) {}
  template <class Real>
  Sign operator()(const Bounded<Real>& x) {
    return random_.chance(percent_) ? Sign::uncertain : sign(x);
  }

 private:
  Random random_;
  int percent_;
};

}  // namespace tightrope::ccd::test
