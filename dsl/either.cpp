#include "dsl/either.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <unordered_map>
#include <utility>

namespace tightrope::dsl {
namespace {

using Tuple = std::vector<NodeId>;  // one node of each alternative

/// A product of norms; a norm is the largest magnitude of some nodes, in order. Without factors it is 1.
struct Size {
  std::vector<std::vector<NodeId>> factors;
};
constexpr std::size_t most_factors = 16;
constexpr std::size_t longest_norm = 64;

/// One place in the alternatives' common expression.
struct Place {
  Tuple nodes;
  std::vector<std::size_t> operands;  ///< places; empty: a selected value, or one that the alternatives share
  bool shared = false;
  std::vector<Size> sizes;  ///< by alternative; empty if shared
  NodeId result = no_node;  ///< the node that computes what is taken
};

class Alternatives {
 public:
  explicit Alternatives(Graph& graph) : graph_(graph) {}

  /// The nodes that compute whichever alternative is taken; `roots`: one tuple a coefficient.
  std::vector<NodeId> unite(const std::vector<Tuple>& roots);

 private:
  std::size_t place_of(const Tuple& nodes);
  void open(std::size_t place);
  bool walks_on(const Tuple& nodes);
  bool linear(NodeId id);
  std::uint64_t shape(NodeId id);
  bool swapped(const Node& first, const Node& other);

  const Size& size(NodeId root);
  Size combined_size(Op op, const Size& a, const Size& b, const Size& c);
  Size product(const Size& x, const Size& y);
  Size sum(const Size& x, const Size& y);
  NodeId computed(const Size& size);
  void find_sizes(Place& place);
  std::vector<NodeId> conditions(const std::vector<Tuple>& roots);

  Graph& graph_;
  std::vector<Place> places_;
  std::map<Tuple, std::size_t> index_;
  std::vector<bool> linear_;
  std::vector<std::uint64_t> shapes_;
  std::unordered_map<NodeId, Size> sizes_;
};

// ------------------------------------------------------------------ walking together

std::size_t Alternatives::place_of(const Tuple& nodes) {
  const auto [found, inserted] = index_.try_emplace(nodes, places_.size());
  if (inserted) {
    Place& place = places_.emplace_back();
    place.nodes = nodes;
    place.shared = std::all_of(nodes.begin(), nodes.end(), [&](NodeId id) { return id == nodes.front(); });
  }
  return found->second;
}

/// An input, or sums, differences and constant multiples of inputs.
bool Alternatives::linear(NodeId wanted) {
  for (auto id = static_cast<NodeId>(linear_.size()); id <= wanted; ++id) {
    const Node& n = graph_[id];
    const auto constant = [&](NodeId operand) { return graph_[operand].op == Op::constant; };
    const auto at = [&](NodeId operand) { return constant(operand) || linear_[static_cast<std::size_t>(operand)]; };
    bool known = n.op == Op::input;
    if (n.op == Op::neg || n.op == Op::mul_pow2) known = at(n.a);
    if (n.op == Op::add || n.op == Op::sub) known = at(n.a) && at(n.b);
    if (n.op == Op::mul) known = at(n.a) && at(n.b) && (constant(n.a) || constant(n.b));
    if (n.op == Op::div) known = at(n.a) && constant(n.b);
    linear_.push_back(known);
  }
  return linear_[static_cast<std::size_t>(wanted)];
}

/// A number that expressions of one form have in common, whatever their inputs and constants.
std::uint64_t Alternatives::shape(NodeId wanted) {
  for (auto id = static_cast<NodeId>(shapes_.size()); id <= wanted; ++id) {
    const Node& n = graph_[id];
    const auto at = [&](NodeId operand) { return operand == no_node ? 0 : shapes_[static_cast<std::size_t>(operand)]; };
    const bool commutes = n.op == Op::add || n.op == Op::mul;
    std::uint64_t a = at(n.a);
    std::uint64_t b = at(n.b);
    if (commutes && a > b) std::swap(a, b);
    std::uint64_t h = static_cast<std::uint64_t>(n.op) + 1;
    for (const std::uint64_t word : {a, b, at(n.c)}) h = (h ^ word) * 0x9E3779B97F4A7C15U + (h >> 31);
    shapes_.push_back(h);
  }
  return shapes_[static_cast<std::size_t>(wanted)];
}

/// Whether the operands of `other`, a commutative operation, go better with those of `first` the other way round. A
/// guess: any order gives the right values.
bool Alternatives::swapped(const Node& first, const Node& other) {
  const auto alike = [&](NodeId x, NodeId y) { return (x == y ? 2 : 0) + (shape(x) == shape(y) ? 1 : 0); };
  return alike(first.a, other.b) + alike(first.b, other.a) > alike(first.a, other.a) + alike(first.b, other.b);
}

bool Alternatives::walks_on(const Tuple& nodes) {
  const Node& first = graph_[nodes.front()];
  const bool walked = first.op == Op::add || first.op == Op::sub || first.op == Op::mul || first.op == Op::neg ||
                      first.op == Op::abs || first.op == Op::mul_pow2 || first.op == Op::fma || first.op == Op::div;
  return walked && std::all_of(nodes.begin(), nodes.end(), [&](NodeId id) {
           const Node& n = graph_[id];
           if (n.op != first.op || n.index != first.index || linear(id)) return false;
           return n.op != Op::div || n.b == first.b;  // a quotient's size is no product of sizes
         });
}

void Alternatives::open(std::size_t index) {
  const Tuple nodes = places_[index].nodes;
  if (places_[index].shared || !walks_on(nodes)) return;
  std::vector<Tuple> operands(static_cast<std::size_t>(operand_count(graph_[nodes.front()].op)));
  for (const NodeId id : nodes) {
    Node n = graph_[id];
    const bool commutes = n.op == Op::add || n.op == Op::mul || n.op == Op::fma;
    if (commutes && swapped(graph_[nodes.front()], n)) std::swap(n.a, n.b);
    const NodeId of_node[] = {n.a, n.b, n.c};
    for (std::size_t i = 0; i < operands.size(); ++i) operands[i].push_back(of_node[i]);
  }
  std::vector<std::size_t> found;
  found.reserve(operands.size());
  for (const Tuple& operand : operands) found.push_back(place_of(operand));
  places_[index].operands = std::move(found);
}

// ------------------------------------------------------------------ sizes

/// The node that computes a size.
NodeId Alternatives::computed(const Size& size) {
  NodeId result = no_node;
  for (const std::vector<NodeId>& norm : size.factors) {
    NodeId largest = no_node;
    for (const NodeId id : norm) {
      const NodeId magnitude = graph_.abs(id);
      largest = largest == no_node ? magnitude : graph_.binary(Op::max_magnitude, largest, magnitude);
    }
    result = result == no_node ? largest : graph_.mul(result, largest);
  }
  return result == no_node ? graph_.constant(1) : result;
}

Size Alternatives::product(const Size& x, const Size& y) {
  Size result = x;
  result.factors.insert(result.factors.end(), y.factors.begin(), y.factors.end());
  if (result.factors.size() > most_factors) return {{{computed(result)}}};
  std::stable_sort(result.factors.begin(), result.factors.end());  // the nodes of one vector stand together
  return result;
}

/// The larger of both, but for norms that belong together by their order: of u_y v_z and u_z v_y it is |u| |v|.
Size Alternatives::sum(const Size& x, const Size& y) {
  if (x.factors.empty()) return y;
  if (y.factors.empty()) return x;
  if (x.factors.size() != y.factors.size()) return {{{computed(x), computed(y)}}};
  Size result;
  for (std::size_t i = 0; i < x.factors.size(); ++i) {
    std::vector<NodeId>& norm = result.factors.emplace_back();
    std::set_union(x.factors[i].begin(), x.factors[i].end(), y.factors[i].begin(), y.factors[i].end(),
                   std::back_inserter(norm));
    if (norm.size() > longest_norm) norm = {computed({{norm}})};
  }
  return result;
}

Size Alternatives::combined_size(Op op, const Size& a, const Size& b, const Size& c) {
  if (op == Op::mul) return product(a, b);
  if (op == Op::fma) return sum(product(a, b), c);
  return op == Op::div ? a : sum(sum(a, b), c);
}

/// The size of a whole value. No quotients or roots are in it, which would have preconditions. Depth first with a stack
/// of its own: graphs may be deeper than the call stack.
const Size& Alternatives::size(NodeId root) {
  std::vector<NodeId> open = {root};
  while (!open.empty()) {
    const NodeId id = open.back();
    const Node n = graph_[id];
    const bool followed = operand_count(n.op) > 0 && !linear(id);
    const NodeId operands[] = {n.op == Op::select ? no_node : n.a, n.op == Op::div ? no_node : n.b, n.c};
    const std::size_t before = open.size();
    for (const NodeId operand : operands) {
      if (followed && operand != no_node && !sizes_.contains(operand)) open.push_back(operand);
    }
    if (open.size() > before) continue;
    open.pop_back();
    if (sizes_.contains(id)) continue;
    const auto at = [&](NodeId operand) { return operand == no_node ? Size{} : sizes_.at(operand); };
    Size size;
    if (followed) {
      size = combined_size(n.op, at(operands[0]), at(operands[1]), at(operands[2]));
    } else if (n.op != Op::constant) {
      size.factors = {{id}};
    }
    sizes_[id] = std::move(size);
  }
  return sizes_.at(root);
}

void Alternatives::find_sizes(Place& place) {
  if (place.shared) return;
  const Op op = graph_[place.nodes.front()].op;
  for (std::size_t i = 0; i < place.nodes.size(); ++i) {
    const auto at = [&](std::size_t operand) -> Size {
      if (operand >= place.operands.size()) return {};
      const Place& p = places_[place.operands[operand]];
      return p.shared ? Size{} : p.sizes[i];
    };
    place.sizes.push_back(place.operands.empty() ? size(place.nodes[i]) : combined_size(op, at(0), at(1), at(2)));
  }
}

/// Condition i >= 0: what was taken of the alternatives up to i stays, else alternative i + 1 is taken.
std::vector<NodeId> Alternatives::conditions(const std::vector<Tuple>& roots) {
  std::vector<Size> sizes(roots.front().size());
  for (const Tuple& root : roots) {
    const Place& place = places_[index_.at(root)];
    for (std::size_t i = 0; i < place.sizes.size(); ++i) sizes[i] = sum(sizes[i], place.sizes[i]);
  }
  std::vector<NodeId> result;
  NodeId least = computed(sizes.front());
  for (std::size_t i = 1; i < sizes.size(); ++i) {
    const NodeId size = computed(sizes[i]);
    result.push_back(graph_.sub(size, least));
    least = graph_.select(result.back(), least, size);
  }
  return result;
}

std::vector<NodeId> Alternatives::unite(const std::vector<Tuple>& roots) {
  for (const Tuple& root : roots) place_of(root);
  for (std::size_t i = 0; i < places_.size(); ++i) open(i);
  // Operands before users: an operand's node of the first alternative stands before its user's.
  std::vector<std::size_t> order(places_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) {
    return std::pair(places_[x].nodes.front(), x) < std::pair(places_[y].nodes.front(), y);
  });
  for (const std::size_t i : order) find_sizes(places_[i]);
  const std::vector<NodeId> conditions = this->conditions(roots);
  for (const std::size_t i : order) {
    Place& place = places_[i];
    place.result = place.nodes.front();
    if (place.operands.empty()) {
      for (std::size_t k = 1; k < place.nodes.size() && !place.shared; ++k) {
        const NodeId other = place.nodes[k];
        if (other != place.result) place.result = graph_.select(conditions[k - 1], place.result, other);
      }
      continue;
    }
    Node n = graph_[place.nodes.front()];
    NodeId* const operands[] = {&n.a, &n.b, &n.c};
    for (std::size_t k = 0; k < place.operands.size(); ++k) *operands[k] = places_[place.operands[k]].result;
    place.result = graph_.intern(n);
  }
  std::vector<NodeId> result;
  result.reserve(roots.size());
  for (const Tuple& root : roots) result.push_back(places_[index_.at(root)].result);
  return result;
}

/// The alternatives of one coefficient, rewritten to have one positive or negative factor.
void share_sign_and_factor(Lowering& low, std::vector<Coefficient>& alternatives) {
  for (Coefficient& c : alternatives) {
    if (c.is_number()) c = run_time(materialise(low, c));
  }
  share_factor(low, alternatives);
  for (Coefficient& c : alternatives) {
    if (c.factor != alternatives.front().factor) c = {.factor = -c.factor, .node = low.graph.neg(c.node)};
  }
}

}  // namespace

std::vector<Coefficient> either(Lowering& low, std::span<const std::vector<Coefficient>> alternatives) {
  std::vector<Coefficient> result = alternatives.front();
  std::vector<Tuple> roots;
  std::vector<std::size_t> places;  // of the roots in `result`
  for (std::size_t i = 0; i < result.size(); ++i) {
    std::vector<Coefficient> one;
    for (const std::vector<Coefficient>& alternative : alternatives) one.push_back(alternative[i]);
    const auto same = [&](const Coefficient& c) {
      return c == one.front() || (c.is_number() && one.front().is_number());
    };
    if (std::all_of(one.begin(), one.end(), same)) continue;
    share_sign_and_factor(low, one);
    result[i].factor = one.front().factor;
    places.push_back(i);
    Tuple& root = roots.emplace_back();
    for (const Coefficient& c : one) root.push_back(c.node);
  }
  if (roots.empty()) return result;
  const std::vector<NodeId> taken = Alternatives(low.graph).unite(roots);
  for (std::size_t i = 0; i < taken.size(); ++i) result[places[i]].node = taken[i];
  return result;
}

}  // namespace tightrope::dsl
