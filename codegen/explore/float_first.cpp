#include "codegen/explore/float_first.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tightrope::codegen::explore {

FloatFilter float_filter(const dsl::Predicate& predicate, BoundMode mode, Precision inputs,
                         dsl::Diagnostics& diagnostics) {
  FloatFilter filter;
  filter.predicate = predicate;
  if (inputs == Precision::binary64) {
    for (dsl::Parameter& parameter : filter.predicate.parameters) {
      parameter.bounded = true;
      parameter.range.reset();
    }
  }
  filter.bounded = add_bounds(filter.predicate, mode, Precision::binary32, diagnostics);
  return filter;
}

bool admits_float_first(const dsl::Predicate& predicate) {
  const auto has_sign = [](const dsl::Stage& stage) {
    return std::any_of(stage.outputs.begin(), stage.outputs.end(), [](const dsl::Output& o) { return o.sign; });
  };
  return std::none_of(predicate.parameters.begin(), predicate.parameters.end(),
                      [](const dsl::Parameter& p) { return p.bounded || p.normalized >= 0; }) &&
         std::all_of(predicate.stages.begin(), predicate.stages.end(), has_sign);
}

RoundedInput rounded_input(double x) {
  const auto value = static_cast<float>(x);
  const double error = std::abs(static_cast<double>(value) - x);
  if (error == 0) return {value, 0};
  // The conversion errs by 2^-24 of `error` or by 2^-150: an ulp more, and 2^-149 more, cover both.
  return {value, static_cast<float>(error) * (1 + 0x1p-22f) + std::numeric_limits<float>::denorm_min()};
}

}  // namespace tightrope::codegen::explore
