/// `either` in generated code: whose maxima SafeBound takes, and what choosing the shorter vectors is worth.

#include "codegen/alternatives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "codegen/bounds.h"
#include "codegen/simplify.h"
#include "dsl/evaluate.h"
#include "test_program.h"

namespace tightrope::codegen {
namespace {

BoundedPredicate bounded(const dsl::Predicate& predicate, BoundMode mode) {
  dsl::Diagnostics diagnostics;
  BoundedPredicate result = add_bounds(predicate, mode, Precision::binary64, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  return result;
}

TEST(Alternatives, HaveAMaximumOfWhatIsSelected) {
  const auto magnitude = [](const std::string& text) {
    const dsl::Program program = testing_support::program(text);
    return bounded(program.predicates.front(), BoundMode::safe).stages[0].outputs[0].magnitude;
  };
  EXPECT_EQ(magnitude("predicate f(point2 p, a, b) { sign either(det(a - p, b - a), det(b - p, b - a)) as s }"),
            "d_y c1_x + d_x c1_y");
  EXPECT_EQ(magnitude("predicate f(point2 p, a, b) { group all"
                      " sign either(det(a - p, b - a), det(b - p, b - a)) as s }"),
            "2 b^2");
}

TEST(Alternatives, ArePartOfNoValueThatOnlyDecidesThem) {
  const dsl::Program program =
      testing_support::program("predicate f(scalar x, y, z) { sign either(x * (y - z), x * y - x * z) as s }");
  const dsl::Predicate predicate = simplify(program.predicates.front());
  const std::vector<bool> values = value_nodes(predicate);
  for (dsl::NodeId id = 0; id < predicate.graph.size(); ++id) {
    const dsl::Op op = predicate.graph[id].op;
    const bool of_sizes = op == dsl::Op::abs || op == dsl::Op::max_magnitude;
    EXPECT_FALSE(of_sizes && values[static_cast<std::size_t>(id)]);
  }
  EXPECT_EQ(values.size(), static_cast<std::size_t>(predicate.graph.size()));
  const dsl::Predicate first = first_alternatives(predicate);
  EXPECT_EQ(first.graph.size(), 5);  // three inputs, a difference, a product
}

/// Vertex-face geometry from the vertex (apex), and from the nearer end of each edge (pivot), MATH 1.3.
const char* const geometries =
    "predicate apex(moving point p, a, b, c) {"
    "  let k = cross(b - p, c - p) sign k, dot(a - p, k) as Y }"
    "predicate pivot(moving point p, a, b, c) {"
    "  let m = either(cross(a - p, b - a), cross(b - p, b - a))"
    "  let k = either(cross(b - p, c - b), cross(c - p, c - b))"
    "  sign k, either(dot(c - b, m), dot(a - c, k)) as Y }";

/// The median ratio of the bounds of one output of both, on needles: p near one of three points in a row.
double gain(BoundMode mode, std::size_t output) {
  const dsl::Program program = testing_support::program(geometries);
  const BoundedPredicate apex = bounded(program.predicates[0], mode);
  const BoundedPredicate pivot = bounded(program.predicates[1], mode);
  std::mt19937_64 random(4);
  const auto uniform = [&] { return std::ldexp(static_cast<double>(random() >> 11), -52) - 1; };
  std::vector<double> ratios;
  for (int round = 0; round < 201; ++round) {
    std::vector<double> slots(48, 0.0);
    for (std::size_t i = 0; i < 24; ++i) slots[i] = std::ldexp(uniform(), -10);
    for (std::size_t time = 0; time < 2; ++time) {  // a and p near 0, b and c near 1 and 1.01 along x
      slots[12 + 3 * time] += 1;
      slots[18 + 3 * time] += 1.01;
    }
    const auto bound = [&](const BoundedPredicate& p) {
      const auto v = dsl::evaluate<double>(p.graph, slots);
      return v[static_cast<std::size_t>(p.stages[0].outputs[output].elements[1].bound)];
    };
    ratios.push_back(bound(apex) / bound(pivot));
  }
  std::nth_element(ratios.begin(), ratios.begin() + 100, ratios.end());
  return ratios[100];
}

TEST(Alternatives, OfThePivotGeometryAreTighter) {
  for (const BoundMode mode : {BoundMode::tight, BoundMode::safe}) {
    for (const std::size_t output : {0U, 1U}) {
      const double found = gain(mode, output);
      RecordProperty(std::string(name(mode)) + (output == 0 ? "_k" : "_Y"), std::to_string(found));
      EXPECT_GT(found, mode == BoundMode::tight ? 1.3 : 2) << name(mode) << " output " << output << ": " << found;
    }
  }
}

}  // namespace
}  // namespace tightrope::codegen
