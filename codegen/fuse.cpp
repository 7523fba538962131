#include "codegen/fuse.h"

#include <vector>

#include "codegen/node_uses.h"
#include "codegen/simplify.h"

namespace tightrope::codegen {

namespace {

using dsl::Graph;
using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

class Contraction {
 public:
  explicit Contraction(const dsl::Predicate& predicate) : predicate_(predicate), uses_(uses_of_nodes(predicate)) {}

  dsl::Predicate run() {
    dsl::Predicate result = predicate_;
    for (NodeId id = 0; id < predicate_.graph.size(); ++id) image_.push_back(rebuilt(predicate_.graph[id]));
    for (dsl::Stage& stage : result.stages) {
      for (dsl::Output& output : stage.outputs) {
        for (NodeId& id : output.nodes) id = at(id);
      }
    }
    result.graph = std::move(graph_);
    return simplify(result);  // leaves the products behind that nothing uses any more
  }

 private:
  NodeId at(NodeId id) const { return id == no_node ? no_node : image_[static_cast<std::size_t>(id)]; }
  bool fusible(NodeId id) const {
    return predicate_.graph[id].op == Op::mul && uses_[static_cast<std::size_t>(id)] == 1;
  }

  NodeId rebuilt(const Node& n) {
    if (n.op == Op::add || n.op == Op::sub) {
      const bool subtract = n.op == Op::sub;
      const bool second = fusible(n.b) && !(fusible(n.a) && n.a > n.b);
      if (second) {  // a + x y, a - x y = (-x) y + a
        const Node& product = predicate_.graph[n.b];
        const NodeId x = subtract ? graph_.neg(at(product.a)) : at(product.a);
        return graph_.fma(x, at(product.b), at(n.a));
      }
      if (fusible(n.a)) {  // x y + b, x y - b
        const Node& product = predicate_.graph[n.a];
        return graph_.fma(at(product.a), at(product.b), subtract ? graph_.neg(at(n.b)) : at(n.b));
      }
    }
    return graph_.intern({n.op, at(n.a), at(n.b), at(n.c), n.index, n.value});
  }

  const dsl::Predicate& predicate_;
  std::vector<int> uses_;
  std::vector<NodeId> image_;
  Graph graph_;
};

}  // namespace

dsl::Predicate contract_products(const dsl::Predicate& predicate) {
  const dsl::Predicate simple = simplify(predicate);
  return Contraction(simple).run();
}

}  // namespace tightrope::codegen
