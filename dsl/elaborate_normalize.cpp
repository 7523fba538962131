/// `normalize a, b`: names become groups, and the outputs are looked at: a common factor must not change their signs.

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "dsl/elaborate_predicate.h"
#include "dsl/names.h"

namespace tightrope::dsl {
namespace {

void add_to_group(const std::string& name, SourceSpan span, int group, Reporter& reporter, Predicate& predicate) {
  const auto found = std::find_if(predicate.parameters.begin(), predicate.parameters.end(),
                                  [&](const Parameter& p) { return p.name == name; });
  if (found == predicate.parameters.end()) {
    std::vector<std::string_view> names;
    for (const Parameter& p : predicate.parameters) names.push_back(p.name);
    const std::string_view closest = closest_name(name, names);
    reporter.error(span, fmt::format("`{}` is no parameter of this predicate", name),
                   closest.empty() ? "" : fmt::format("did you mean `{}`?", closest));
  } else if (found->bounded) {
    reporter.error(span, fmt::format("`{}` cannot be normalized: it comes with an error bound", name));
  } else if (found->range) {
    reporter.error(span, fmt::format("`{}` cannot be normalized: it has a declared range", name),
                   "normalized inputs have the range 1");
  } else if (found->normalized >= 0) {
    reporter.error(span, fmt::format("`{}` is normalized already", name));
  } else {
    found->normalized = group;
  }
}

/// What becomes of a value when a group of inputs is multiplied by s > 0.
struct Homogeneity {
  enum class Kind { zero, homogeneous, neither } kind = Kind::homogeneous;
  std::int64_t degree = 0;  ///< homogeneous: it is multiplied by s^(degree / 2)
  std::int64_t other = 0;   ///< neither: the degrees of two terms that were added
};

Homogeneity of_degree(std::int64_t degree) {
  constexpr std::int64_t limit = std::int64_t{1} << 40;
  return {Homogeneity::Kind::homogeneous, std::clamp(degree, -limit, limit), 0};
}

Homogeneity sum(const Homogeneity& a, const Homogeneity& b) {
  using Kind = Homogeneity::Kind;
  if (a.kind == Kind::neither || b.kind == Kind::zero) return a;
  if (b.kind == Kind::neither || a.kind == Kind::zero) return b;
  if (a.degree != b.degree) return {Kind::neither, std::min(a.degree, b.degree), std::max(a.degree, b.degree)};
  return a;
}

Homogeneity product(const Homogeneity& a, const Homogeneity& b, int sign) {
  if (a.kind != Homogeneity::Kind::homogeneous) return a;
  if (b.kind != Homogeneity::Kind::homogeneous) return b;
  return of_degree(a.degree + sign * b.degree);
}

class Degrees {
 public:
  Degrees(const Predicate& predicate, int group) : predicate_(predicate), group_(group) {
    for (NodeId id = 0; id < predicate.graph.size(); ++id) degrees_.push_back(of_node(predicate.graph[id]));
  }
  const Homogeneity& at(NodeId id) const { return degrees_[static_cast<std::size_t>(id)]; }

 private:
  Homogeneity of_node(const Node& n) const {
    switch (n.op) {
      case Op::input: {
        const Slot& slot = predicate_.slots[static_cast<std::size_t>(n.index)];
        return of_degree(predicate_.parameters[static_cast<std::size_t>(slot.parameter)].normalized == group_ ? 2 : 0);
      }
      case Op::constant:
        return n.value == 0 ? Homogeneity{Homogeneity::Kind::zero, 0, 0} : of_degree(0);
      case Op::add:
      case Op::sub:
      case Op::min:
      case Op::max:
      case Op::max_magnitude:
        return sum(at(n.a), at(n.b));
      case Op::select:
        return sum(at(n.b), at(n.c));
      case Op::mul:
        return product(at(n.a), at(n.b), 1);
      case Op::div:
        return product(at(n.a), at(n.b), -1);
      case Op::fma:
        return sum(product(at(n.a), at(n.b), 1), at(n.c));
      case Op::sqrt: {
        Homogeneity h = at(n.a);
        if (h.kind == Homogeneity::Kind::homogeneous) h.degree /= 2;
        return h;
      }
      case Op::neg:
      case Op::mul_pow2:
      case Op::abs:
      case Op::certain_nonzero:
      case Op::certain_nonnegative:
      case Op::normalizer:
        return at(n.a);
    }
    return {};
  }

  const Predicate& predicate_;
  int group_;
  std::vector<Homogeneity> degrees_;
};

std::string degree_text(std::int64_t doubled) {
  return doubled % 2 == 0 ? std::to_string(doubled / 2) : fmt::format("{}/2", doubled);
}

/// False, with a diagnostic, if the output may not stand in a predicate where this group is normalized.
bool check_output(const Output& output, const Degrees& degrees, Reporter& reporter) {
  for (const NodeId id : output.nodes) {
    const Homogeneity& h = degrees.at(id);
    if (h.kind == Homogeneity::Kind::neither) {
      reporter.error(output.span,
                     fmt::format("`{}` is not homogeneous in the normalized inputs: it adds terms of degree {} and {}",
                                 output.text, degree_text(h.degree), degree_text(h.other)),
                     "`normalize` multiplies them all by one power of two, which must not change a sign");
      return false;
    }
    if (!output.sign && h.degree != 0) {
      reporter.error(output.span,
                     fmt::format("the value of `{}` may overflow where its normalized inputs do not", output.text),
                     "of normalized inputs there are signs, and values of degree 0 in them");
      return false;
    }
  }
  return true;
}

}  // namespace

void elaborate_normalizations(const PredicateRequest& request, Reporter& reporter, Predicate& predicate) {
  int group = 0;
  for (const NormalizeDecl& normalize : request.declaration->normalizations) {
    for (const auto& [name, span] : normalize.names) add_to_group(name, span, group, reporter, predicate);
    ++group;
  }
}

void check_homogeneity(Reporter& reporter, const Predicate& predicate) {
  int groups = 0;
  for (const Parameter& p : predicate.parameters) groups = std::max(groups, p.normalized + 1);
  for (int group = 0; group < groups; ++group) {
    const Degrees degrees(predicate, group);
    for (const Stage& stage : predicate.stages) {
      for (const Output& output : stage.outputs) {
        if (!check_output(output, degrees, reporter)) return;
      }
    }
  }
}

}  // namespace tightrope::dsl
