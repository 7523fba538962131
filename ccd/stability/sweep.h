#pragma once
/// Makes the atlas.

#include <functional>
#include <optional>
#include <span>

#include "scenes/scene.h"
#include "stability/atlas.h"

namespace tightrope::ccd::stability {

struct SweepRequest {
  std::vector<Scene> families;
  std::vector<Kind> kinds;
  std::vector<Method> methods;
  std::vector<Real> reals;
  Axes axes;
  std::size_t queries = 0;  ///< a cell
  std::uint64_t seed = 1;
};

/// A query on which a method broke its promise.
struct BrokenPromise {
  Method method{};
  Kind kind{};
  Real real{};
  bool contact = false;  ///< the truth
  std::vector<double> points;
};

struct SweepResult {
  Atlas atlas;
  std::vector<BrokenPromise> broken;  ///< the first hundred; there must be none
};

/// How many queries are done, of how many; false: stop.
using Proceed = std::function<bool(std::uint64_t done, std::uint64_t all)>;

/// Decides every query of the sweep by every method and compares with the exact oracle. Determined by the request.
/// Empty: `proceed` said so.
std::optional<SweepResult> sweep(const SweepRequest& request, const Proceed& proceed);

}  // namespace tightrope::ccd::stability
