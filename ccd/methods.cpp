#include <array>

#include "tightrope/method.h"

namespace tightrope::ccd {
namespace {

constexpr auto all_methods = std::to_array<MethodInfo>({
    {Method::bsc_float, "bsc-float", "none", false, "Wang et al. 2015 (TightCCD), in plain floating point"},
    {Method::bsc_safe, "bsc-safe", "SafeBound", true, "Wang et al. 2015 (TightCCD), bounds of Wang 2014 (SafeCCD)"},
    {Method::tight, "tight", "TightBound", true, "Wang et al. 2015 (TightCCD), decision tables repaired"},
    {Method::bsc_exact, "bsc-exact", "exact", true, "Wang et al. 2015 (TightCCD), every sign exact", true},
    {Method::safe, "safe", "SafeBound", true, "Wang 2014 (SafeCCD), its holes closed"},
    {Method::safe_tight, "safe-tight", "TightBound", true, "Wang 2014 (SafeCCD) with the bounds of Wang et al. 2015"},
    {Method::tightrope, "tightrope", "exact", true, "ours: subdivision on the exact contact criterion", true},
});

}  // namespace

std::span<const MethodInfo> methods() { return all_methods; }

std::optional<Method> method_by_name(std::string_view name) {
  for (const MethodInfo& info : all_methods) {
    if (info.name == name) return info.method;
  }
  return std::nullopt;
}

std::string_view name(Method method) {
  for (const MethodInfo& info : all_methods) {
    if (info.method == method) return info.name;
  }
  return {};
}

std::string_view name(Kind kind) {
  switch (kind) {
    case Kind::vertex_face:
      return "vertex-face";
    case Kind::edge_edge:
      return "edge-edge";
  }
  return {};
}

}  // namespace tightrope::ccd
