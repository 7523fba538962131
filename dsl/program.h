#pragma once
/// The checked and lowered program: what `dsl` hands to `codegen`.

#include <optional>
#include <string>
#include <vector>

#include "dsl/diagnostic.h"
#include "dsl/graph.h"

namespace tightrope::dsl {

/// A predicate's parameter. Its scalars are numbered in `slots` order: array elements outermost (row-major), then time
/// (t = 0, then t = 1, moving parameters only), then component.
struct Parameter {
  std::string name;
  bool bounded = false;         ///< comes with an error bound; its slots carry (value, bound)
  bool moving = false;          ///< linear in t, given at t = 0 and t = 1
  bool point = false;           ///< a position: what a translation translates
  int dimension = 1;            ///< 1, 2 or 3
  std::vector<int> array;       ///< extents; empty for a single one
  std::optional<double> range;  ///< |coordinate| <= range, for all of its scalars (and for its bound)
  int normalized = -1;          ///< of `normalize`: the number of the group that is scaled together
  int first_slot = 0;
  int elements() const;  ///< product of `array`
  int slots() const { return elements() * (moving ? 2 : 1) * dimension; }
};

/// What one input slot is: the inverse of the numbering above.
struct Slot {
  int parameter = 0;
  int element = 0;
  int time = 0;  ///< 0 or 1
  int component = 0;
};

struct Output {
  std::string name;          ///< unique in the predicate, a C++ identifier
  bool sign = true;          ///< `sign E` (false: `value E`)
  std::vector<int> extents;  ///< C++ array extents: the expression's array extents, then degree + 1 unless the degree
                             ///< is 0, then 2 or 3 for a vector; empty for a scalar
  int degree = 0;
  std::vector<NodeId> nodes;  ///< row-major over `extents`
  std::string text;           ///< the expression as written, white space folded
  SourceSpan span;
};

struct Stage {
  std::string name;  ///< "evaluate" for a predicate that has no `stage` block
  std::vector<Output> outputs;
};

struct Property {
  enum class Kind { antisymmetric, symmetric, cyclic, translation_invariant, scale } kind;
  std::vector<int> parameters;               ///< antisymmetric/symmetric: two; cyclic: three or more
  int exponent = 0;                          ///< scale: f(s x) = s^exponent f(x)
  std::vector<std::pair<int, int>> outputs;  ///< (stage, output) it holds for
};

/// Which exact inputs share one run-time maximum in SafeBound (codegen/input_groups.h).
struct Grouping {
  bool all = false;                     ///< all of them; else each coordinate axis, and each scalar, on its own
  bool displacements = false;           ///< differences of one input at two times apart from the others
  std::vector<std::vector<int>> lists;  ///< parameters whose inputs, and differences among them, are apart from others
};

struct Predicate {
  std::string name;
  std::string doc;
  std::uint32_t file = 0;
  std::vector<Parameter> parameters;
  std::vector<Slot> slots;  ///< one per input slot
  std::vector<Stage> stages;
  std::vector<Property> properties;
  Grouping grouping;
  Graph graph;
};

struct Program {
  std::vector<Predicate> predicates;  ///< predicates and instances of the main file, in order of appearance
  std::vector<std::uint32_t> files;   ///< the main file, then everything it imports
};

/// How coefficients of products of polynomials are computed (MATH.md 1.1).
enum class ProductScheme {
  direct,     ///< c1 = u0 v1 + u1 v0
  karatsuba,  ///< c1 = u0 v0 + u1 v1 - (u1 - u0)(v1 - v0)
};

/// How the value of a polynomial at one place, `P at t`, is computed.
enum class EvaluationScheme {
  horner,        ///< ((s_n r + s_(n-1) q) r + s_(n-2) q^2) r + ..., q = 1 - r: 2 n products and more, n sums
  de_casteljau,  ///< repeated interpolation: n (n + 1) products, n (n + 1) / 2 sums, none of them large
};

struct ElaborateOptions {
  ProductScheme products = ProductScheme::direct;
  EvaluationScheme evaluation = EvaluationScheme::horner;
  std::size_t max_nodes = 2'000'000;  ///< a predicate with a larger graph is an error
  int max_degree = 64;                ///< a polynomial of higher degree is an error
};

/// Loads `path` and all it imports into `sources`, parses, checks types and degrees, inlines functions, unrolls loops,
/// lowers polynomials in t to their Bernstein coefficients. A file that cannot be read is an error with the place of
/// the import (or of line 1 of the main file). The program is complete only if no error was added.
Program load_program(const std::string& path, SourceMap& sources, Diagnostics& diagnostics,
                     const ElaborateOptions& options = {});

}  // namespace tightrope::dsl
