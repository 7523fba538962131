#include "codegen/exact_program.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "codegen/alternatives.h"
#include "codegen/simplify.h"

namespace tightrope::codegen {
namespace {

using dsl::Node;
using dsl::NodeId;
using dsl::Op;
using dsl::Rational;

/// (a + b sqrt(c)) / d with d > 0; without root b is zero, without denominator d is -1.
struct ExactNumber {
  ScaledNode a, b, c;
  ExactId d = -1;
  const char* refusal = nullptr;  ///< why there is no such form
};

constexpr const char* several_roots = "it needs more than one square root";
constexpr const char* root_divisor = "it divides by a sum with a square root";
constexpr const char* long_constants = "its constants multiply to more than 126 bits";

Rational exact_rational(double value) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return Rational(static_cast<std::int64_t>(std::ldexp(fraction, 53))) * Rational::power_of_two(exponent - 53);
}

class Rewriter {
 public:
  explicit Rewriter(const dsl::Predicate& predicate) : predicate_(predicate) {
    const auto size = static_cast<std::size_t>(predicate.graph.size());
    numbers_.resize(size);
    guards_.resize(size);
    visited_in_.assign(size, -1);
    for (NodeId id = 0; id < predicate.graph.size(); ++id) {
      numbers_[static_cast<std::size_t>(id)] = number(id);
    }
  }

  std::optional<ExactProgram> finish(dsl::Diagnostics& diagnostics) {
    ExactProgram program;
    for (const dsl::Stage& stage : predicate_.stages) {
      ExactStage& exact = program.stages.emplace_back();
      for (const dsl::Output& output : stage.outputs) {
        ExactOutput& entry = exact.outputs.emplace_back();
        for (const NodeId id : output.nodes) entry.elements.push_back(element(id));
        const char* const refusal = graph_.factors_fit() ? reason(output, entry) : long_constants;
        if (refusal != nullptr) {
          const std::string_view what = output.sign ? "sign" : "value";
          diagnostics.error(
              output.span, "the exact " + std::string(what) + " of `" + output.text + "` is not supported: " + refusal);
          failed_ = true;
        }
      }
    }
    if (failed_) return std::nullopt;
    program.graph = std::move(graph_);
    return program;
  }

 private:
  const ExactNumber& at(NodeId id) const { return numbers_[static_cast<std::size_t>(id)]; }
  bool rational(const ExactNumber& x) const { return graph_.is_zero(x.b); }

  ExactNumber plain(const ScaledNode& a, ExactId d = -1) const { return {a, graph_.zero(), graph_.one(), d}; }
  ExactNumber refused(const char* why) const {
    ExactNumber x = plain(graph_.zero());
    x.refusal = why;
    return x;
  }

  /// x times the denominator d (-1: times 1).
  ScaledNode times(const ScaledNode& x, ExactId d) { return d == -1 ? x : graph_.product(x, {d, 1}); }
  ExactId product_of_denominators(ExactId d, ExactId e) {
    if (d == -1) return e;
    return e == -1 ? d : graph_.product({d, 1}, {e, 1}).node;
  }
  bool same_root(const ExactNumber& x, const ExactNumber& y) const {
    return x.c.node == y.c.node && x.c.factor == y.c.factor;
  }

  ExactNumber negated(const ExactNumber& x) { return {graph_.negated(x.a), graph_.negated(x.b), x.c, x.d, x.refusal}; }

  /// Both numbers over their common denominator.
  void share_denominator(ExactNumber& x, ExactNumber& y) {
    if (x.d == y.d) return;
    const ExactId d = x.d, e = y.d;
    x.a = times(x.a, e), x.b = times(x.b, e);
    y.a = times(y.a, d), y.b = times(y.b, d);
    x.d = y.d = product_of_denominators(d, e);
  }

  ExactNumber sum(ExactNumber x, ExactNumber y) {
    if (!rational(x) && !rational(y) && !same_root(x, y)) return refused(several_roots);
    share_denominator(x, y);
    return {graph_.sum(x.a, y.a), graph_.sum(x.b, y.b), rational(x) ? y.c : x.c, x.d};
  }

  ExactNumber product(const ExactNumber& x, const ExactNumber& y) {
    const ExactId d = product_of_denominators(x.d, y.d);
    if (rational(x)) return {graph_.product(x.a, y.a), graph_.product(x.a, y.b), y.c, d};
    if (rational(y)) return product(y, x);
    const ScaledNode bb = graph_.product(x.b, y.b);
    if (same_root(x, y)) {
      const ScaledNode a = graph_.sum(graph_.product(x.a, y.a), graph_.product(bb, x.c));
      return {a, graph_.sum(graph_.product(x.a, y.b), graph_.product(x.b, y.a)), x.c, d};
    }
    if (!graph_.is_zero(x.a) || !graph_.is_zero(y.a)) return refused(several_roots);
    return {graph_.zero(), bb, graph_.product(x.c, y.c), d};
  }

  /// x * d / |v| * sign(v) for a numerator v over d: the quotient by v / d.
  ExactNumber over(const ExactNumber& x, const ScaledNode& v, ExactId d) {
    const Rational inverse = Rational(1) / v.factor;
    const ScaledNode positive = graph_.magnitude({v.node, 1});
    ExactNumber r = x;
    r.a = graph_.signed_by(graph_.scaled(times(x.a, d), inverse), v.node);
    r.b = graph_.signed_by(graph_.scaled(times(x.b, d), inverse), v.node);
    if (!graph_.is_one(positive.node)) r.d = product_of_denominators(x.d, positive.node);
    return r;
  }

  ExactNumber quotient(NodeId id, const ExactNumber& x, const ExactNumber& y) {
    auto& guards = guards_[static_cast<std::size_t>(id)];
    if (rational(y)) {
      guards = {ExactGuard::Kind::nonzero, y.a.node};
      return over(x, y.a, y.d);
    }
    if (!graph_.is_zero(y.a)) return refused(root_divisor);
    // 1 / (b sqrt(c) / d) = (d / (b c)) sqrt(c)
    const ScaledNode bc = graph_.product(y.b, y.c);
    guards = {ExactGuard::Kind::nonzero, bc.node};
    const ExactNumber root = {graph_.zero(), graph_.one(), y.c, -1};
    return over(product(x, root), bc, y.d);
  }

  ExactNumber root(NodeId id, const ExactNumber& x) {
    if (!rational(x)) return refused(several_roots);
    guards_[static_cast<std::size_t>(id)] = {ExactGuard::Kind::nonnegative, x.a.node};
    if (graph_.is_zero(x.a)) return plain(graph_.zero());
    return {graph_.zero(), graph_.one(), times(x.a, x.d), x.d};
  }

  /// The node whose sign is that of x.
  ExactId sign_node(const ExactNumber& x) {
    if (rational(x)) return x.a.node;
    const ScaledNode b = graph_.signed_by(x.b, x.c.node);  // no root of zero
    if (graph_.is_zero(x.a)) return b.node;
    const ScaledNode squares =
        graph_.difference(graph_.product(x.a, x.a), graph_.product(graph_.product(x.b, x.b), x.c));
    return graph_.root_sign(x.a, b, squares);
  }

  ExactNumber magnitude(const ExactNumber& x) {
    if (rational(x)) return plain(graph_.magnitude(x.a), x.d);
    const ExactId s = sign_node(x);
    return {graph_.signed_by(x.a, s), graph_.signed_by(x.b, s), x.c, x.d};
  }

  ExactNumber extremum(bool smaller, ExactNumber x, ExactNumber y) {
    if (!rational(x) && !rational(y) && !same_root(x, y)) return refused(several_roots);
    share_denominator(x, y);
    const ExactNumber d = sum(x, negated(y));
    const ExactId condition = sign_node(d);
    if (!smaller) std::swap(x, y);
    const ScaledNode a = graph_.selected(condition, x.a, y.a);
    const bool has_root = !rational(x) || !rational(y);
    return {a, has_root ? graph_.selected(condition, x.b, y.b) : graph_.zero(), rational(x) ? y.c : x.c, x.d};
  }

  ExactNumber number(NodeId id) {
    const Node& n = predicate_.graph[id];
    for (const NodeId operand : {n.a, n.b, n.c}) {
      if (operand != dsl::no_node && at(operand).refusal != nullptr) return refused(at(operand).refusal);
    }
    ExactNumber result = evaluated(id, n);
    if (!graph_.factors_fit() && result.refusal == nullptr) result = refused(long_constants);
    return result;
  }

  ExactNumber evaluated(NodeId id, const Node& n) {
    switch (n.op) {
      case Op::input:
        return plain(graph_.input(n.index));
      case Op::constant:
        return plain(graph_.constant(exact_rational(n.value)));
      case Op::add:
        return sum(at(n.a), at(n.b));
      case Op::sub:
        return sum(at(n.a), negated(at(n.b)));
      case Op::neg:
        return negated(at(n.a));
      case Op::mul:
        return product(at(n.a), at(n.b));
      case Op::mul_pow2: {
        ExactNumber x = at(n.a);
        x.a = graph_.scaled(x.a, Rational::power_of_two(n.index));
        x.b = graph_.scaled(x.b, Rational::power_of_two(n.index));
        return x;
      }
      case Op::div:
        return quotient(id, at(n.a), at(n.b));
      case Op::sqrt:
        return root(id, at(n.a));
      case Op::abs:
        return magnitude(at(n.a));
      case Op::min:
      case Op::max:
        return extremum(n.op == Op::min, at(n.a), at(n.b));
      case Op::fma:
        return sum(product(at(n.a), at(n.b)), at(n.c));
      case Op::certain_nonzero:
      case Op::certain_nonnegative:
      case Op::normalizer:
      case Op::max_magnitude:
      case Op::select:
        break;
    }
    assert(false && "here are neither operations of bounds nor selections");
    return plain(graph_.zero());
  }

  ExactElement element(NodeId id) {
    const ExactNumber x = at(id);
    ExactElement result;
    result.sign = sign_node(x);
    result.numerator = x.a;
    result.denominator = x.d;
    result.rational = rational(x);
    collect_conditions(id, result);
    return result;
  }

  /// Guards and inputs that `root` depends on.
  void collect_conditions(NodeId root, ExactElement& result) {
    ++visit_;
    std::vector<NodeId> stack = {root};
    while (!stack.empty()) {
      const NodeId id = stack.back();
      stack.pop_back();
      const auto i = static_cast<std::size_t>(id);
      if (visited_in_[i] == visit_) continue;
      visited_in_[i] = visit_;
      const Node& n = predicate_.graph[id];
      if (n.op == Op::input) result.slots.push_back(n.index);
      const ExactGuard& guard = guards_[i];
      const bool always = guard.node == -1 || graph_.is_one(guard.node);
      if (!always && std::find(result.guards.begin(), result.guards.end(), guard) == result.guards.end()) {
        result.guards.push_back(guard);
      }
      for (const NodeId operand : {n.a, n.b, n.c}) {
        if (operand != dsl::no_node) stack.push_back(operand);
      }
    }
    std::sort(result.slots.begin(), result.slots.end());
  }

  /// Why an output cannot be given, or null.
  const char* reason(const dsl::Output& output, const ExactOutput& exact) const {
    for (std::size_t i = 0; i < output.nodes.size(); ++i) {
      if (const char* refusal = at(output.nodes[i]).refusal) return refusal;
      if (!output.sign && !exact.elements[i].rational) return "it contains a square root";
    }
    return nullptr;
  }

  const dsl::Predicate& predicate_;
  ExactGraph graph_;
  std::vector<ExactNumber> numbers_;  ///< by node
  std::vector<ExactGuard> guards_;    ///< by node: that of a division or root
  std::vector<int> visited_in_;
  int visit_ = 0;
  bool failed_ = false;
};

}  // namespace

std::optional<ExactProgram> exact_program(const dsl::Predicate& original, dsl::Diagnostics& diagnostics) {
  const dsl::Predicate predicate = first_alternatives(simplify(original));
  return Rewriter(predicate).finish(diagnostics);
}

}  // namespace tightrope::codegen
