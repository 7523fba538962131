#pragma once
/// The stages of each method as a device takes them: functions of one query, the very ones of the processor. Each stage
/// settles most of what it gets; a kernel a stage runs on what the one before has left, packed densely again.
///
/// Who includes this includes the generated headers of the method first.

#include <array>
#include <cstddef>
#include <type_traits>

#include "ccd/host_device.h"
#include "tightrope/method.h"

namespace tightrope::ccd::gpu {

/// What becomes of a query in a stage. The first three are result bytes.
enum class Answer : unsigned char {
  apart,    ///< proved free of contact
  touches,  ///< what the method answers `true` to
  open,     ///< exact arithmetic decides
  next,     ///< the next stage does
};

/// Stages<method, Real>: `count` stages; look<stage>(kind, points) must answer other than `next` in the last.
template <Method M, class Real>
struct Stages;

TIGHTROPE_HOST_DEVICE constexpr Answer answer(bool touches) { return touches ? Answer::touches : Answer::apart; }
TIGHTROPE_HOST_DEVICE constexpr Answer apart_or(bool apart, Answer otherwise) {
  return apart ? Answer::apart : otherwise;
}

}  // namespace tightrope::ccd::gpu
