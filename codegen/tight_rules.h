#pragma once
/// The work of add_tight_bounds (tight_bound.h), shared by its three files: tight_bound.cpp walks the graph and builds
/// r, tight_rules.cpp has the rules of the polynomial operations, tight_quotients.cpp those of division and root.

#include <optional>
#include <vector>

#include "codegen/bound_expression.h"
#include "codegen/precision.h"

namespace tightrope::codegen {

/// One summand of r: coefficient * |node|, or coefficient * node for an expression that is already a (partial) r.
struct Term {
  dsl::NodeId node = dsl::no_node;
  bool magnitude = true;
  double coefficient = 1;
};

/// The error of one value: |computed - exact| <= u+ (sum of terms) + underflow, see lemmas A to D.
struct Error {
  std::vector<Term> terms;
  double underflow = 0;   ///< in units of eta; with ranges a bound of its own, else it becomes a term (4 eta / u each)
  double slack_used = 0;  ///< m of tight_bound.h's last paragraph
  bool exact() const { return terms.empty() && underflow == 0; }
};

/// Nodes of the predicate are told by their number there (`id`), which is what errors and limits are indexed by.
/// `value(id)` is the node of the bounded graph that computes it; another one if a guard came before.
class TightBounds {
 public:
  TightBounds(const dsl::Predicate& predicate, const FloatFormat& format, Weakening weakening, double slack,
              bool use_ranges, dsl::Diagnostics& diagnostics, dsl::Graph& graph);

  void run(BoundedPredicate& result);
  double roundings() const { return roundings_; }  ///< the largest D + m of all outputs and guards
  double largest_floor() const { return largest_floor_; }

 private:
  // The rules, one a kind of operation: tight_rules.cpp.
  Error rule(dsl::NodeId id, const dsl::Node& n, const dsl::Output* reporter);
  Error leaf(const dsl::Node& n);
  Error sum(dsl::NodeId id, const dsl::Node& n);
  Error sum_of_nonnegative(dsl::NodeId id, double relative_a, double relative_b, const Error& a, const Error& b) const;
  Error product(dsl::NodeId id, const dsl::Node& n);
  Error relative_product(dsl::NodeId id, double relative_a, double relative_b);
  Error half_relative_product(dsl::NodeId id, dsl::NodeId a, double relative_a, dsl::NodeId b, bool first);
  void add_general_product(Error& e, const dsl::Node& n);
  void add_product_underflow(Error& e, const dsl::Node& n);
  Error fused(dsl::NodeId id, const dsl::Node& n);
  Error extremum(const dsl::Node& n);
  Error selection(dsl::NodeId id, const dsl::Node& n);
  Error scaling(dsl::NodeId id, const dsl::Node& n);
  Error constant_quotient(dsl::NodeId id, const dsl::Node& n);
  static Error scaled(const Error& error, double factor);

  // tight_quotients.cpp
  Error quotient(dsl::NodeId id, const dsl::Node& n);
  Error general_quotient(dsl::NodeId id, const dsl::Node& n);
  Error root(dsl::NodeId id, const dsl::Node& n);
  Error general_root(dsl::NodeId id, const dsl::Node& n);
  dsl::NodeId guarded_divisor(dsl::NodeId b);
  dsl::NodeId guarded_radicand(dsl::NodeId a);

  // Building r, and the walk: tight_bound.cpp.
  dsl::NodeId make_value(const dsl::Node& n);
  dsl::NodeId plain_value(const dsl::Node& n);
  double magnitude_limit(const dsl::Node& n) const;
  std::optional<double> relative(dsl::NodeId id) const;
  std::optional<double> relative_but_for_underflow(dsl::NodeId id) const;
  bool purely_relative(dsl::NodeId id) const {
    return error(id).underflow == 0 && relative_but_for_underflow(id).has_value();
  }
  void make_run_time(dsl::NodeId id);
  static void add_term(Error& error, Term term);
  void add_rounding(Error& error, dsl::NodeId id, double coefficient) const {
    add_term(error, {r_.base(value(id)), true, coefficient});
  }
  void add_underflow(Error& error, double etas) const;
  dsl::NodeId materialise(const Error& error);
  void fold_if_shared(dsl::NodeId id);
  dsl::NodeId output_bound(dsl::NodeId id);
  bool overflow_shows(const dsl::Node& n) const;
  bool hides_overflow(dsl::NodeId id) const;

  const Error& error(dsl::NodeId id) const { return errors_[static_cast<std::size_t>(id)]; }
  dsl::NodeId value(dsl::NodeId id) const { return values_[static_cast<std::size_t>(id)]; }
  double limit(dsl::NodeId id) const { return limits_[static_cast<std::size_t>(id)]; }
  bool nonnegative(dsl::NodeId id) const { return nonnegative_[static_cast<std::size_t>(id)]; }
  bool weakened(Weakening w) const { return weakening_ == w; }
  const dsl::Node& node(dsl::NodeId id) const { return predicate_.graph[id]; }

  const dsl::Predicate& predicate_;
  const FloatFormat& format_;
  Weakening weakening_;
  double slack_;
  double unit_;  ///< u+
  bool use_ranges_;
  dsl::Diagnostics& diagnostics_;
  dsl::Graph& graph_;
  BoundExpressions r_;
  std::vector<bool> nonnegative_;
  std::vector<dsl::NodeId> values_;
  std::vector<Error> errors_;
  std::vector<double> limits_;  ///< M of lemma C, per node; only with ranges
  std::vector<int> uses_;
  std::vector<bool> overflow_shows_;
  double roundings_ = 0;
  double largest_floor_ = 0;
};

}  // namespace tightrope::codegen
