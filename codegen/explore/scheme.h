#pragma once
/// Evaluation schemes: ways to compute one predicate that are equal as polynomials and differ in roundings and cost.

#include <string>
#include <vector>

#include "codegen/bounds.h"

namespace tightrope::codegen::explore {

/// How sums are associated.
enum class Sums {
  written,   ///< left to right, as the source has them
  balanced,  ///< in halves: balance.h
  factored,  ///< common factors taken out: factor.h
};

/// One choice out of each list. The defaults are those of `tightrope compile`.
struct Scheme {
  BoundMode bound = BoundMode::tight;
  dsl::ProductScheme products = dsl::ProductScheme::direct;
  dsl::EvaluationScheme evaluation = dsl::EvaluationScheme::horner;
  Sums sums = Sums::written;
  bool fma = false;          ///< products contracted into sums (codegen/fuse.h)
  bool recomputes = false;   ///< stages compute anew what earlier ones have found
  bool float_first = false;  ///< a filter in single precision, double where that leaves a sign open: float_first.h
  bool operator==(const Scheme&) const = default;
};

/// The bound, then the choices that are not the default: "tight", "tight-delta-balanced-fma", "safe-recompute".
std::string name(const Scheme& scheme);

/// The combinations that are tried, 122 of them, the defaults of each bound first. Products, evaluation, sums and fma
/// freely with tight, safe, static and no bound (4 x 24); interval, which is there for comparison, with sums as written
/// (8). Recomputing leaves every number as it is, so it is tried with tight and safe and sums as written alone (16). A
/// filter in single precision before tight and safe, all else as by default (2). Most coincide for any one predicate.
std::vector<Scheme> all_schemes();

/// What the parts of a name mean, one line each.
std::string legend();

}  // namespace tightrope::codegen::explore
