#include "codegen/range_analysis.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "codegen/precision.h"

namespace tightrope::codegen {

namespace {

using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// 2^this vertices at most, and operations at all vertices of all nodes of one predicate (some nanoseconds each).
constexpr int most_vertex_inputs = 16;
constexpr double operation_budget = 40e6;

NearNumber sum(const NearNumber& x, const NearNumber& y, double sign) {
  const double b = sign * y.value;
  const double s = x.value + b;
  const double part = s - b;  // TwoSum: the residual is exact
  const double residual = std::abs((x.value - part) + (b - (s - part)));
  if (residual == 0 && x.error == 0 && y.error == 0) return {s, 0};
  return {s, add_up(add_up(x.error, y.error), residual)};
}

NearNumber product(const NearNumber& x, const NearNumber& y) {
  if ((x.value == 0 && x.error == 0) || (y.value == 0 && y.error == 0)) return {};
  const double p = x.value * y.value;
  // The residual is exact unless it underflows, which costs less than 2^-1074 beyond what is seen of it.
  double residual = std::abs(std::fma(x.value, y.value, -p));
  if (std::abs(p) < 0x1p-900) residual = add_up(residual, 0x1p-1074);
  if (residual == 0 && x.error == 0 && y.error == 0) return {p, 0};
  const double from_y = mul_up(add_up(std::abs(x.value), x.error), y.error);
  return {p, add_up(add_up(from_y, mul_up(std::abs(y.value), x.error)), residual)};
}

NearNumber quotient(const NearNumber& x, double constant) {
  const double q = x.value / constant;
  if (std::fma(-q, constant, x.value) == 0 && x.error == 0 && std::abs(q) > 0x1p-900 && std::abs(x.value) > 0x1p-900)
    return {q, 0};
  const double ulp = std::nextafter(std::abs(q), infinity) - std::abs(q);
  return {q, add_up(div_up(x.error, std::abs(constant)), ulp)};
}

NearNumber scaled(const NearNumber& x, int exponent) {
  const double value = std::ldexp(x.value, exponent);
  const double residual = std::ldexp(value, -exponent) == x.value ? 0 : 0x1p-1074;
  return {value, x.error == 0 ? residual : add_up(scaled_up(x.error, exponent), residual)};
}

bool is_number(const NearNumber& x) { return std::isfinite(x.value) && std::isfinite(x.error); }

}  // namespace

Support Support::of_input(int slot) {
  Support result;
  result.inputs_.set(static_cast<std::size_t>(slot));
  return result;
}

Support Support::joined(const Support& other) const {
  Support result;
  result.inputs_ = inputs_ | other.inputs_;
  result.repeated_ = repeated_ | other.repeated_;
  return result;
}

Support Support::multiplied(const Support& other) const {
  Support result = joined(other);
  result.repeated_ |= inputs_ & other.inputs_;
  return result;
}

RangeAnalysis::RangeAnalysis(const dsl::Graph& graph, std::vector<double> limits, bool vertices)
    : graph_(graph), limits_(std::move(limits)), budget_(vertices ? operation_budget : 0) {
  extend();
}

void RangeAnalysis::extend() {
  for (auto id = static_cast<NodeId>(ranges_.size()); id < graph_.size(); ++id) {
    const Node& n = graph_[id];
    ranges_.push_back(interval(n));
    supports_.push_back(support(n));
    if (!operands_meet(n)) continue;  // interval arithmetic on independent operands is exact
    if (const auto range = vertex_range(id)) ranges_.back() = intersection(ranges_.back(), *range);
  }
}

Range RangeAnalysis::interval(const Node& n) const {
  switch (n.op) {
    case Op::input:
      return symmetric(limits_[static_cast<std::size_t>(n.index)]);
    case Op::constant:
      return {n.value, n.value};
    case Op::add:
      return of(n.a) + of(n.b);
    case Op::sub:
      return n.a == n.b ? Range{} : of(n.a) - of(n.b);
    case Op::neg:
      return -of(n.a);
    case Op::mul:
      return n.a == n.b ? square(of(n.a)) : of(n.a) * of(n.b);
    case Op::mul_pow2:
      return scaled(of(n.a), n.index);
    case Op::div:
      return contains_zero(of(n.b)) ? symmetric(infinity) : quotient(of(n.a), of(n.b));
    case Op::sqrt:
      return root(of(n.a));
    case Op::abs:
      return absolute(of(n.a));
    case Op::min:
      return minimum(of(n.a), of(n.b));
    case Op::max:
    case Op::max_magnitude:
      return maximum(of(n.a), of(n.b));
    case Op::select:
      return hull(of(n.b), of(n.c));
    case Op::fma:
      return (n.a == n.b ? square(of(n.a)) : of(n.a) * of(n.b)) + of(n.c);
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::normalizer:
      return of(n.a);
  }
  return symmetric(infinity);
}

/// Nodes that are no polynomials count as products of their operands with themselves: never multi-affine.
Support RangeAnalysis::support(const Node& n) const {
  switch (n.op) {
    case Op::input:
      return n.index < Support::most_inputs ? Support::of_input(n.index) : Support();
    case Op::constant:
      return {};
    case Op::add:
    case Op::sub:
      return support(n.a).joined(support(n.b));
    case Op::neg:
    case Op::mul_pow2:
      return support(n.a);
    case Op::mul:
      return support(n.a).multiplied(support(n.b));
    case Op::fma:
      return support(n.a).multiplied(support(n.b)).joined(support(n.c));
    case Op::div:
      if (graph_[n.b].op == Op::constant) return support(n.a);
      [[fallthrough]];
    case Op::sqrt:
    case Op::abs:
    case Op::min:
    case Op::max:
    case Op::max_magnitude:
    case Op::certain_nonzero:
    case Op::certain_nonnegative:
    case Op::normalizer:
    case Op::select:
      break;
  }
  Support all = support(n.a);
  if (n.b != no_node) all = all.joined(support(n.b));
  if (n.c != no_node) all = all.joined(support(n.c));
  return all.multiplied(all);
}

bool RangeAnalysis::operands_meet(const Node& n) const {
  if (n.op == Op::fma) {
    const Support factors = support(n.a).joined(support(n.b));
    return support(n.a).meets(support(n.b)) || factors.meets(support(n.c));
  }
  return (n.op == Op::add || n.op == Op::sub || n.op == Op::mul) && support(n.a).meets(support(n.b));
}

bool RangeAnalysis::prepare(const Support& support, std::span<const WeightedNode> roots) {
  if (!support.multi_affine() || support.size() > most_vertex_inputs) return false;
  if (limits_.size() > static_cast<std::size_t>(Support::most_inputs)) return false;
  std::vector<bool> needed(static_cast<std::size_t>(graph_.size()), false);
  NodeId last = 0;
  for (const WeightedNode& root : roots) {
    needed[static_cast<std::size_t>(root.node)] = true;
    last = std::max(last, root.node);
  }
  cone_.clear();
  for (NodeId id = last; id >= 0; --id) {
    if (!needed[static_cast<std::size_t>(id)]) continue;
    cone_.push_back(id);
    for (const NodeId operand : {graph_[id].a, graph_[id].b, graph_[id].c}) {
      if (operand != no_node) needed[static_cast<std::size_t>(operand)] = true;
    }
  }
  std::reverse(cone_.begin(), cone_.end());
  const double operations = std::ldexp(static_cast<double>(cone_.size() + roots.size()), support.size());
  if (operations > budget_) return false;
  budget_ -= operations;
  vertex_inputs_.assign(limits_.size(), -1);
  int bit = 0;
  for (std::size_t slot = 0; slot < limits_.size(); ++slot) {
    if (support.inputs()[slot]) vertex_inputs_[slot] = bit++;
  }
  values_.resize(static_cast<std::size_t>(graph_.size()));
  return true;
}

void RangeAnalysis::evaluate_vertex(unsigned vertex) {
  for (const NodeId id : cone_) {
    const Node& n = graph_[id];
    NearNumber& v = values_[static_cast<std::size_t>(id)];
    switch (n.op) {
      case Op::input: {
        const auto slot = static_cast<std::size_t>(n.index);
        v = {(vertex >> vertex_inputs_[slot] & 1U) != 0 ? limits_[slot] : -limits_[slot], 0};
        break;
      }
      case Op::constant:
        v = {n.value, 0};
        break;
      case Op::add:
      case Op::sub:
        v = sum(at_vertex(n.a), at_vertex(n.b), n.op == Op::add ? 1 : -1);
        break;
      case Op::neg:
        v = {-at_vertex(n.a).value, at_vertex(n.a).error};
        break;
      case Op::mul:
        v = product(at_vertex(n.a), at_vertex(n.b));
        break;
      case Op::mul_pow2:
        v = scaled(at_vertex(n.a), n.index);
        break;
      case Op::fma:
        v = sum(product(at_vertex(n.a), at_vertex(n.b)), at_vertex(n.c), 1);
        break;
      case Op::div:
        v = graph_[n.b].op == Op::constant ? quotient(at_vertex(n.a), graph_[n.b].value) : NearNumber{0, infinity};
        break;
      case Op::sqrt:
      case Op::abs:
      case Op::min:
      case Op::max:
      case Op::max_magnitude:
      case Op::certain_nonzero:
      case Op::certain_nonnegative:
      case Op::normalizer:
      case Op::select:
        v = {0, infinity};  // never below a multi-affine node
        break;
    }
  }
}

std::optional<Range> RangeAnalysis::vertex_range(NodeId id) {
  const WeightedNode root{id, 1};
  if (!prepare(support(id), {&root, 1})) return std::nullopt;
  Range range{infinity, -infinity};
  for (unsigned vertex = 0; vertex < 1U << support(id).size(); ++vertex) {
    evaluate_vertex(vertex);
    const NearNumber& v = at_vertex(id);
    if (!is_number(v)) return std::nullopt;
    range.lo = std::min(range.lo, sum_down(v.value, -v.error));
    range.hi = std::max(range.hi, sum_up(v.value, v.error));
  }
  return range;
}

std::optional<double> RangeAnalysis::largest_sum(std::span<const WeightedNode> terms) {
  Support all;
  for (const WeightedNode& term : terms) all = all.joined(support(term.node));
  if (!prepare(all, terms)) return std::nullopt;
  double largest = 0;
  for (unsigned vertex = 0; vertex < 1U << all.size(); ++vertex) {
    evaluate_vertex(vertex);
    double total = 0;
    for (const WeightedNode& term : terms) {
      const NearNumber& v = at_vertex(term.node);
      if (!is_number(v)) return std::nullopt;
      total = add_up(total, mul_up(add_up(std::abs(v.value), v.error), term.weight));
    }
    largest = std::max(largest, total);
  }
  return largest;
}

}  // namespace tightrope::codegen
