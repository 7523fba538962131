#include "codegen/bounds.h"

#include <cassert>

#include "codegen/interval_bound.h"
#include "codegen/normalize.h"
#include "codegen/precision.h"
#include "codegen/safe_bound.h"
#include "codegen/simplify.h"
#include "codegen/static_bound.h"
#include "codegen/tight_bound.h"

namespace tightrope::codegen {

const char* name(BoundMode mode) {
  switch (mode) {
    case BoundMode::none:
      return "float";
    case BoundMode::safe:
      return "safe";
    case BoundMode::tight:
      return "tight";
    case BoundMode::fixed:
      return "static";
    case BoundMode::interval:
      return "interval";
    case BoundMode::exact:
      return "exact";
    case BoundMode::staged:
      return "staged";
  }
  return "";
}

const char* name(Precision precision) { return precision == Precision::binary64 ? "double" : "float"; }

const char* name(Weakening weakening) {
  switch (weakening) {
    case Weakening::none:
      return "none";
    case Weakening::drop_rounding_of_sums:
      return "drop_rounding_of_sums";
    case Weakening::drop_rounding_of_products:
      return "drop_rounding_of_products";
    case Weakening::drop_rounding_of_differences:
      return "drop_rounding_of_differences";
    case Weakening::drop_first_factor_error:
      return "drop_first_factor_error";
    case Weakening::drop_second_factor_error:
      return "drop_second_factor_error";
    case Weakening::drop_operand_error_of_sums:
      return "drop_operand_error_of_sums";
    case Weakening::drop_division_rounding:
      return "drop_division_rounding";
    case Weakening::drop_input_bound:
      return "drop_input_bound";
    case Weakening::drop_underflow:
      return "drop_underflow";
    case Weakening::halve_unit_roundoff:
      return "halve_unit_roundoff";
    case Weakening::drop_product_of_errors:
      return "drop_product_of_errors";
    case Weakening::drop_dividend_error:
      return "drop_dividend_error";
    case Weakening::drop_divisor_error:
      return "drop_divisor_error";
    case Weakening::drop_divisor_margin:
      return "drop_divisor_margin";
    case Weakening::drop_root_rounding:
      return "drop_root_rounding";
    case Weakening::drop_radicand_error:
      return "drop_radicand_error";
    case Weakening::drop_fma_rounding:
      return "drop_fma_rounding";
    case Weakening::drop_guards:
      return "drop_guards";
    case Weakening::drop_second_alternative:
      return "drop_second_alternative";
  }
  return "";
}

namespace {

/// Mode `float`: the values as they are, bounds 0.
void add_no_bounds(const dsl::Predicate& predicate, BoundedPredicate& result) {
  result.graph = predicate.graph;
  const dsl::NodeId zero = result.graph.constant(0);
  for (const auto& stage : predicate.stages) {
    BoundedStage& bounded = result.stages.emplace_back();
    for (const auto& output : stage.outputs) {
      OutputBound& entry = bounded.outputs.emplace_back();
      for (const dsl::NodeId id : output.nodes) entry.elements.push_back({id, zero});
    }
  }
}

/// A constant that the precision does not hold would silently be another number.
bool constants_fit(const dsl::Predicate& predicate, const FloatFormat& format, dsl::Diagnostics& diagnostics) {
  for (dsl::NodeId id = 0; id < predicate.graph.size(); ++id) {
    const dsl::Node& n = predicate.graph[id];
    if (n.op == dsl::Op::constant && !representable(n.value, format)) {
      diagnostics.error(predicate.stages.front().outputs.front().span,
                        "predicate `" + predicate.name + "` needs a constant that `float` does not hold exactly",
                        "write it as a quotient of smaller whole numbers, or compile for --real double");
      return false;
    }
  }
  return true;
}

}  // namespace

BoundedPredicate add_bounds(const dsl::Predicate& original, BoundMode mode, const FloatFormat& format,
                            dsl::Diagnostics& diagnostics, Weakening weakening) {
  BoundedPredicate result;
  const dsl::Predicate predicate = simplify(with_normalized_ranges(original));
  if (!constants_fit(predicate, format, diagnostics)) return result;
  switch (mode) {
    case BoundMode::none:
      add_no_bounds(predicate, result);
      break;
    case BoundMode::safe:
      add_safe_bounds(predicate, format, diagnostics, weakening, result);
      break;
    case BoundMode::tight:
      add_tight_bounds(predicate, format, diagnostics, weakening, result);
      break;
    case BoundMode::fixed:
      add_static_bounds(predicate, format, diagnostics, weakening, result);
      break;
    case BoundMode::interval:
      add_interval_bounds(predicate, format, diagnostics, weakening, result);
      break;
    case BoundMode::exact:
    case BoundMode::staged:
      assert(false && "these modes have no bounds");
      break;
  }
  if (!diagnostics.has_errors()) normalize_inputs(predicate, result);
  return result;
}

BoundedPredicate add_bounds(const dsl::Predicate& predicate, BoundMode mode, Precision precision,
                            dsl::Diagnostics& diagnostics, Weakening weakening) {
  return add_bounds(predicate, mode, format(precision), diagnostics, weakening);
}

}  // namespace tightrope::codegen
