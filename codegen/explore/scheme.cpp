#include "codegen/explore/scheme.h"

namespace tightrope::codegen::explore {

std::string name(const Scheme& scheme) {
  std::string text = codegen::name(scheme.bound);
  if (scheme.float_first) text += "-float-first";
  if (scheme.products == dsl::ProductScheme::karatsuba) text += "-delta";
  if (scheme.evaluation == dsl::EvaluationScheme::de_casteljau) text += "-casteljau";
  if (scheme.sums == Sums::balanced) text += "-balanced";
  if (scheme.sums == Sums::factored) text += "-factored";
  if (scheme.fma) text += "-fma";
  if (scheme.recomputes) text += "-recompute";
  return text;
}

std::vector<Scheme> all_schemes() {
  using enum BoundMode;
  using enum dsl::ProductScheme;
  using enum dsl::EvaluationScheme;
  std::vector<Scheme> schemes;
  for (const BoundMode bound : {tight, safe, fixed, interval, none}) {
    for (const bool recomputes : {false, true}) {
      if (recomputes && bound != tight && bound != safe) continue;
      for (const bool fma : {false, true}) {
        for (const dsl::EvaluationScheme evaluation : {horner, de_casteljau}) {
          for (const Sums sums : {Sums::written, Sums::balanced, Sums::factored}) {
            if (sums != Sums::written && (recomputes || bound == interval)) continue;
            for (const dsl::ProductScheme products : {direct, karatsuba}) {
              schemes.push_back({bound, products, evaluation, sums, fma, recomputes, false});
            }
          }
        }
      }
    }
    if (bound == tight || bound == safe) schemes.push_back({.bound = bound, .float_first = true});
  }
  return schemes;
}

std::string legend() {
  return "  tight, safe, static, interval, float: the bound (float has none)\n"
         "  delta: products of polynomials by c1 = c0 + c2 - (u1 - u0)(v1 - v0)\n"
         "  casteljau: P at t by de Casteljau's scheme, not Horner's\n"
         "  balanced: sums in halves, not left to right; factored: common factors taken out of sums\n"
         "  fma: fused multiply-add\n"
         "  recompute: stages compute anew what earlier ones found\n"
         "  float-first: in single precision, in double where that leaves a sign open\n";
}

}  // namespace tightrope::codegen::explore
