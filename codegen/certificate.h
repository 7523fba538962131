#pragma once
/// Gappa scripts [Daumas, Melquiond 2010]: a bound as a claim that a program which does not know ours can prove.

#include <optional>
#include <string>
#include <vector>

#include "codegen/bounds.h"

namespace tightrope::codegen {

/// What is to be proved of one output element: |computed - exact| <= bound while the inputs stay in their ranges.
struct Claim {
  std::string comment;  ///< what the script says at its top, lines
  dsl::NodeId value = dsl::no_node;
  std::vector<double> bounds;  ///< each is a goal of its own
};

/// The script; empty where the value is made by an operation that Gappa does not know (min, max).
///
/// Every input is a number of the format within its range (a bounded one within its bound, itself at most the range, of
/// an exact number). Every node is defined twice: v7 as computed, one rounding an operation, and e7 exactly. The goals
/// are |v - e| <= bound, and the bound that Gappa finds by itself ("v - e in ?"). Gappa's float<..., ne> rounds to
/// nearest with gradual underflow and without overflow, whose absence the compiler shows by the ranges.
std::optional<std::string> gappa_script(const dsl::Predicate& predicate, const dsl::Graph& graph, const Claim& claim,
                                        Precision precision);

}  // namespace tightrope::codegen
