/// The lowering to Bernstein coefficients against the meaning of the expressions: the values of the inputs at a time t,
/// combined directly, are the value of the polynomial at t. Exactly, on random rational inputs and times.

#include <algorithm>
#include <functional>

#include "tests/unit/dsl/compile.h"

namespace tightrope::dsl::testing {
namespace {

using Q = mpq_class;
using Vec = std::vector<Q>;  // a scalar has one component
using Function = std::function<Q(const Q&)>;
using Outputs = std::vector<Vec>;  // a predicate's outputs, their elements

/// The inputs' values at one time.
struct At {
  Vec p, a, b, q;  // p, a, b moving points, q a static one
  Vec e, f;        // moving vec2
  Q m, n;          // moving scalars
  Q r, s;          // static ones
  Vec k;           // array of four static scalars
  Vec p0, p1;      // p at t = 0 and t = 1
  Q t;
};

const char* const parameters =
    "moving point p, a, b, static point q, moving vec2 e, f, moving scalar m, n, scalar r, s, bounded scalar k[4]";

Vec sub(const Vec& u, const Vec& v) {
  Vec w;
  for (std::size_t i = 0; i < u.size(); ++i) w.push_back(u[i] - v[i]);
  return w;
}
Vec times(const Q& x, const Vec& v) {
  Vec w;
  for (const Q& c : v) w.push_back(x * c);
  return w;
}
Q dot(const Vec& u, const Vec& v) {
  Q d = 0;
  for (std::size_t i = 0; i < u.size(); ++i) d += u[i] * v[i];
  return d;
}
Vec cross(const Vec& u, const Vec& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}
Q power(const Q& x, int n) {
  Q y = 1;
  for (int i = 0; i < n; ++i) y *= x;
  return y;
}
/// The Bernstein polynomial with these coefficients, by its defining sum.
Q bernstein(const Vec& b, const Q& t) {
  const int n = static_cast<int>(b.size()) - 1;
  Q total = 0;
  Q choose = 1;
  for (int i = 0; i <= n; ++i) {
    total += choose * b[static_cast<std::size_t>(i)] * power(t, i) * power(1 - t, n - i);
    choose = choose * (n - i) / (i + 1);
  }
  return total;
}
/// The derivative of `f` at t: f is a polynomial of degree at most 6, so a difference quotient of enough points is
/// exact.
Q derivative(const Function& f, const Q& t) {
  // Lagrange interpolation on t, t + 1, ..., t + 6, differentiated at t.
  Q result = 0;
  for (int j = 0; j <= 6; ++j) {
    Q weight = 0;
    if (j == 0) {
      for (int i = 1; i <= 6; ++i) weight -= Q(1, static_cast<unsigned long>(i));
    } else {
      weight = 1;
      for (int i = 0; i <= 6; ++i) {
        if (i == j) continue;
        if (i != 0) weight *= Q(-i);
        weight /= Q(j - i);
      }
    }
    result += weight * f(t + j);
  }
  return result;
}
Q y_of(const At& x) { return dot(cross(sub(x.a, x.p), sub(x.b, x.p)), sub(x.p, x.q)); }

using Meaning = std::function<Vec(const At&)>;
struct Row {
  const char* expression;
  int degree;
  Meaning meaning;
};

const std::vector<Row>& rows() {
  static const std::vector<Row> table = {
      {"m + n", 1, [](const At& x) { return Vec{x.m + x.n}; }},
      {"m - s", 1, [](const At& x) { return Vec{x.m - x.s}; }},
      {"s - m", 1, [](const At& x) { return Vec{x.s - x.m}; }},
      {"m * n + s", 2, [](const At& x) { return Vec{x.m * x.n + x.s}; }},
      {"m * n + r * m - 2 * n", 2, [](const At& x) { return Vec{x.m * x.n + x.r * x.m - 2 * x.n}; }},
      {"m * n * (m - n) + m * n + m + 1/3", 3,
       [](const At& x) { return Vec{x.m * x.n * (x.m - x.n) + x.m * x.n + x.m + Q(1, 3)}; }},
      {"(m * n + s) * (m + r) * (n - 1/7)", 4,
       [](const At& x) { return Vec{(x.m * x.n + x.s) * (x.m + x.r) * (x.n - Q(1, 7))}; }},
      {"m ^ 6", 6, [](const At& x) { return Vec{power(x.m, 6)}; }},
      {"(m * n) ^ 3 - n ^ 5", 6, [](const At& x) { return Vec{power(x.m * x.n, 3) - power(x.n, 5)}; }},
      {"m * n * (m + n) * (m - n) * (2 * m - n) * (m - 3 * n)", 6,
       [](const At& x) { return Vec{x.m * x.n * (x.m + x.n) * (x.m - x.n) * (2 * x.m - x.n) * (x.m - 3 * x.n)}; }},
      {"-m * n", 2, [](const At& x) { return Vec{-x.m * x.n}; }},
      {"m / 3 + n / 7", 1, [](const At& x) { return Vec{x.m / 3 + x.n / 7}; }},
      {"5/3 * m - 7/5 * n", 1, [](const At& x) { return Vec{Q(5, 3) * x.m - Q(7, 5) * x.n}; }},
      {"m * n / (r * r + 1)", 2, [](const At& x) { return Vec{x.m * x.n / (x.r * x.r + 1)}; }},
      {"0 * m + 0", 1, [](const At&) { return Vec{0}; }},
      {"m + m + m - n - n", 1, [](const At& x) { return Vec{3 * x.m - 2 * x.n}; }},
      {"m - m", 1, [](const At&) { return Vec{0}; }},
      {"p - a", 1, [](const At& x) { return sub(x.p, x.a); }},
      {"q - a", 1, [](const At& x) { return sub(x.q, x.a); }},
      {"m * (p - q)", 2, [](const At& x) { return times(x.m, sub(x.p, x.q)); }},
      {"(p - q) * m / 3", 2, [](const At& x) { return times(x.m / 3, sub(x.p, x.q)); }},
      {"cross(p - a, b - a)", 2, [](const At& x) { return cross(sub(x.p, x.a), sub(x.b, x.a)); }},
      {"cross(q, b - a)", 1, [](const At& x) { return cross(x.q, sub(x.b, x.a)); }},
      {"cross(cross(p, a), cross(a, b))", 4, [](const At& x) { return cross(cross(x.p, x.a), cross(x.a, x.b)); }},
      {"cross(vec3(1, 0, m), vec3(s, n, 1/2))", 2,
       [](const At& x) {
         return cross({1, 0, x.m}, {x.s, x.n, Q(1, 2)});
       }},
      {"dot(p - a, p - a)", 2, [](const At& x) { return Vec{dot(sub(x.p, x.a), sub(x.p, x.a))}; }},
      {"dot(cross(a - p, b - p), p - q)", 3, [](const At& x) { return Vec{y_of(x)}; }},
      {"3 * dot(cross(a - p, b - p), p - q)", 3, [](const At& x) { return Vec{3 * y_of(x)}; }},
      {"det(p, a, b)", 3, [](const At& x) { return Vec{dot(x.p, cross(x.a, x.b))}; }},
      {"det(p - q, a - p, b - a) * dot(p, a - b)", 5,
       [](const At& x) {
         return Vec{dot(sub(x.p, x.q), cross(sub(x.a, x.p), sub(x.b, x.a))) * dot(x.p, sub(x.a, x.b))};
       }},
      {"dot(cross(p, a), cross(p - b, a - q)) + dot(p, q)", 4,
       [](const At& x) { return Vec{dot(cross(x.p, x.a), cross(sub(x.p, x.b), sub(x.a, x.q))) + dot(x.p, x.q)}; }},
      {"dot(p, a) * dot(a, b) * dot(b, p)", 6,
       [](const At& x) { return Vec{dot(x.p, x.a) * dot(x.a, x.b) * dot(x.b, x.p)}; }},
      {"det(e, f)", 2, [](const At& x) { return Vec{x.e[0] * x.f[1] - x.e[1] * x.f[0]}; }},
      {"cross(e - f, e + f) + dot(e, f)", 2,
       [](const At& x) {
         const Vec u = sub(x.e, x.f);
         const Vec v = sub(x.e, times(-1, x.f));
         return Vec{u[0] * v[1] - u[1] * v[0] + dot(x.e, x.f)};
       }},
      {"vec3(e.x, f[1], m * n)", 2,
       [](const At& x) {
         return Vec{x.e[0], x.f[1], x.m * x.n};
       }},
      {"bernstein(k)", 3, [](const At& x) { return Vec{bernstein(x.k, x.t)}; }},
      {"bernstein(k) * m - bernstein([s, r, k[0]])", 4,
       [](const At& x) {
         return Vec{bernstein(x.k, x.t) * x.m - bernstein({x.s, x.r, x.k[0]}, x.t)};
       }},
      {"bernstein([0, 1]) * p", 2, [](const At& x) { return times(x.t, x.p); }},
      {"bernstein([0, 1/2, 1/3, 1]) * bernstein([p at 0, q, p at 1])", 5,
       [](const At& x) {
         Vec v;
         for (std::size_t i = 0; i < 3; ++i) {
           v.push_back(bernstein({0, Q(1, 2), Q(1, 3), 1}, x.t) * bernstein({x.p0[i], x.q[i], x.p1[i]}, x.t));
         }
         return v;
       }},
      {"elevate(m, 6)", 6, [](const At& x) { return Vec{x.m}; }},
      {"elevate(m * n, 3)", 3, [](const At& x) { return Vec{x.m * x.n}; }},
      {"elevate(bernstein(k), 5)", 5, [](const At& x) { return Vec{bernstein(x.k, x.t)}; }},
      {"elevate(q, 2)", 2, [](const At& x) { return x.q; }},
      {"elevate(dot(cross(a - p, b - p), p - q), 6)", 6, [](const At& x) { return Vec{y_of(x)}; }},
      {"bernstein(coefficients(m * n * m))", 3, [](const At& x) { return Vec{x.m * x.n * x.m}; }},
      {"bernstein(coefficients(cross(p, a)))", 2, [](const At& x) { return cross(x.p, x.a); }},
      {"sum([m * n, s, k[1] * m])", 2, [](const At& x) { return Vec{x.m * x.n + x.s + x.k[1] * x.m}; }},
      {"sum([i * m for i in 1..4]) + sum(k)", 1,
       [](const At& x) { return Vec{6 * x.m + x.k[0] + x.k[1] + x.k[2] + x.k[3]}; }},
      {"[m, n * n, s][1]", 2, [](const At& x) { return Vec{x.n * x.n}; }},
  };
  return table;
}

/// Random inputs, and their values at any time.
struct Inputs {
  std::vector<Exact> slots;
  std::vector<Slot> places;
  Inputs(const Predicate& predicate, std::mt19937_64& random) : places(predicate.slots) {
    for (std::size_t i = 0; i < places.size(); ++i) slots.emplace_back(random_rational(random));
  }
  Vec at(const Predicate& predicate, int parameter, const Q& t) const {
    const Parameter& p = predicate.parameters[static_cast<std::size_t>(parameter)];
    Vec result;
    const auto slot = [&](int i) { return slots[static_cast<std::size_t>(p.first_slot + i)].value; };
    if (!p.moving) {
      for (int i = 0; i < p.slots(); ++i) result.push_back(slot(i));
    } else {
      for (int i = 0; i < p.dimension; ++i) result.push_back((1 - t) * slot(i) + t * slot(p.dimension + i));
    }
    return result;
  }
};

At inputs_at(const Predicate& predicate, const Inputs& inputs, const Q& t) {
  const auto get = [&](int parameter) { return inputs.at(predicate, parameter, t); };
  return {.p = get(0),
          .a = get(1),
          .b = get(2),
          .q = get(3),
          .e = get(4),
          .f = get(5),
          .m = get(6)[0],
          .n = get(7)[0],
          .r = get(8)[0],
          .s = get(9)[0],
          .k = get(10),
          .p0 = inputs.at(predicate, 0, 0),
          .p1 = inputs.at(predicate, 0, 1),
          .t = t};
}

/// The output's polynomial at t: a value a component.
Vec output_at(const Output& output, const std::vector<Exact>& values, const Q& t) {
  const std::size_t dimension = output.nodes.size() / static_cast<std::size_t>(output.degree + 1);
  Vec result;
  for (std::size_t c = 0; c < dimension; ++c) {
    Vec coefficients;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(output.degree); ++i) {
      coefficients.push_back(values[static_cast<std::size_t>(output.nodes[i * dimension + c])].value);
    }
    result.push_back(bernstein(coefficients, t));
  }
  return result;
}

std::string predicate_text(const std::string& expression) {
  return std::string("predicate f(") + parameters + ") { sign " + expression + " as result }";
}

/// Whether `graph`, in place of the predicate's own, gives the meaning at random inputs and times.
bool agrees(const Predicate& predicate, const Graph& graph, const Meaning& meaning, int rounds) {
  std::mt19937_64 random(20240607);
  const Output& output = predicate.stages.front().outputs.front();
  for (int round = 0; round < rounds; ++round) {
    const Inputs inputs(predicate, random);
    const std::vector<Exact> values = evaluate<Exact>(graph, inputs.slots);
    for (int i = 0; i < 4; ++i) {
      const Q t = i == 0 ? Q(0) : i == 1 ? Q(1) : random_rational(random);
      if (meaning(inputs_at(predicate, inputs, t)) != output_at(output, values, t)) return false;
    }
  }
  return true;
}

class Lowering_GivesTheMeaning : public ::testing::TestWithParam<ProductScheme> {};

TEST_P(Lowering_GivesTheMeaning, OfEveryExpressionAtEveryTime) {
  for (const Row& row : rows()) {
    const Compiled c = compile(predicate_text(row.expression), {.products = GetParam()});
    ASSERT_EQ(c.errors(), "") << row.expression;
    const Predicate& predicate = c.program.predicates.front();
    const Output& output = predicate.stages.front().outputs.front();
    EXPECT_EQ(output.degree, row.degree) << row.expression;
    EXPECT_TRUE(agrees(predicate, predicate.graph, row.meaning, 12)) << row.expression;
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, Lowering_GivesTheMeaning,
                         ::testing::Values(ProductScheme::direct, ProductScheme::karatsuba),
                         [](const auto& test) { return test.param == ProductScheme::direct ? "direct" : "karatsuba"; });

/// `graph` with the operation of one node changed.
Graph mutated(const Graph& graph, NodeId victim) {
  Graph result;
  std::vector<NodeId> image;
  for (NodeId id = 0; id < graph.size(); ++id) {
    Node node = graph[id];
    for (NodeId* operand : {&node.a, &node.b, &node.c}) {
      if (*operand != no_node) *operand = image[static_cast<std::size_t>(*operand)];
    }
    if (id == victim) {
      switch (node.op) {
        case Op::add:
          node.op = Op::sub;
          break;
        case Op::sub:
          node.op = Op::add;
          break;
        case Op::mul:
          node.op = Op::add;
          break;
        case Op::div:
          node.op = Op::mul;
          break;
        case Op::mul_pow2:
          ++node.index;
          break;
        case Op::constant:
          node.value += 1;
          break;
        case Op::neg:
          node.op = Op::abs;
          break;
        case Op::input:
        case Op::sqrt:
        case Op::abs:
        case Op::min:
        case Op::max:
        case Op::fma:
        case Op::select:
        case Op::max_magnitude:
        case Op::certain_nonzero:
        case Op::certain_nonnegative:
        case Op::normalizer:
          break;
      }
    }
    // Interning may merge nodes; the outputs below are mapped along.
    image.push_back(result.intern(node));
  }
  return result;
}

TEST(Lowering, IsSeenToBeWrongWhenAnyOneOperationIsChanged) {
  for (const char* expression : {"dot(cross(a - p, b - p), p - q)", "m * n * (m - n) + m * n + m + 1/3",
                                 "elevate(bernstein(k), 5)", "bernstein(k) * m - bernstein([s, r, k[0]])"}) {
    const auto row = std::find_if(rows().begin(), rows().end(),
                                  [&](const Row& r) { return r.expression == std::string(expression); });
    ASSERT_NE(row, rows().end());
    for (const ProductScheme scheme : {ProductScheme::direct, ProductScheme::karatsuba}) {
      Compiled c = compile(predicate_text(expression), {.products = scheme});
      Predicate& predicate = c.program.predicates.front();
      for (NodeId id = 0; id < predicate.graph.size(); ++id) {
        if (predicate.graph[id].op == Op::input) continue;
        const Graph wrong = mutated(predicate.graph, id);
        if (wrong.size() != predicate.graph.size()) continue;  // merged: node numbers differ
        EXPECT_FALSE(agrees(predicate, wrong, row->meaning, 3)) << expression << ", node " << id;
      }
    }
  }
}

// Operations whose result is not the operand at the same t.

Q cubic(const At& x) { return x.m * x.n * (x.m - x.r) + bernstein(x.k, x.t); }
const char* const cubic_text = "(m * n * (m - r) + bernstein(k))";

/// Compiles `expression` (with P for the cubic) and calls check(output values, polynomial) on random inputs.
void check_operation(const std::string& expression, const std::string& output_text,
                     const std::function<void(const Outputs&, const Function&, const At&)>& check) {
  const std::string text = std::string("predicate f(") + parameters + ") { let P = " + cubic_text +
                           " let R = " + expression + " sign " + output_text + " }";
  for (const ProductScheme scheme : {ProductScheme::direct, ProductScheme::karatsuba}) {
    const Compiled c = compile(text, {.products = scheme});
    ASSERT_EQ(c.errors(), "") << expression;
    const Predicate& predicate = c.program.predicates.front();
    std::mt19937_64 random(7);
    for (int round = 0; round < 20; ++round) {
      const Inputs inputs(predicate, random);
      const At x = inputs_at(predicate, inputs, 0);
      if (x.s == 0) continue;  // a ratio r/s is evaluated
      const std::vector<Exact> values = evaluate<Exact>(predicate.graph, inputs.slots);
      Outputs outputs;
      for (const Output& o : predicate.stages.front().outputs) {
        Vec& v = outputs.emplace_back();
        for (const NodeId node : o.nodes) v.push_back(values[static_cast<std::size_t>(node)].value);
      }
      check(
          outputs, [&](const Q& t) { return cubic(inputs_at(predicate, inputs, t)); }, x);
    }
  }
}

TEST(Lowering, DifferentiatesExactly) {
  check_operation("diff(P)", "R, diff(R) as second, diff(q) as zero, diff(diff(m)) as also_zero",
                  [](const Outputs& out, const Function& p, const At&) {
                    for (const Q& t : {Q(0), Q(1), Q(2, 7)}) {
                      EXPECT_EQ(bernstein(out[0], t), derivative(p, t));
                      const Function slope = [&](const Q& s) { return derivative(p, s); };
                      EXPECT_EQ(bernstein(out[1], t), derivative(slope, t));
                    }
                    EXPECT_EQ(out[2], (Vec{0, 0, 0}));
                    EXPECT_EQ(out[3], Vec{0});
                  });
}

TEST(Lowering, EvaluatesAtNumbersScalarsAndRatios) {
  check_operation("P", "P at 0 as zero, P at 1 as one, P at (1/3) as third, P at s as at_s, P at -2 as outside",
                  [](const Outputs& out, const Function& p, const At& x) {
                    EXPECT_EQ(out[0][0], p(0));
                    EXPECT_EQ(out[1][0], p(1));
                    EXPECT_EQ(out[2][0], p(Q(1, 3)));
                    EXPECT_EQ(out[3][0], p(x.s));
                    EXPECT_EQ(out[4][0], p(-2));
                  });
  check_operation("P at r/s",
                  "R, P at s/(s - r) as root, P at (3 * s)/(3 * s + r) as sum, P at 2/3 as number, q at r/s as fixed",
                  [](const Outputs& out, const Function& p, const At& x) {
                    EXPECT_EQ(out[0][0], power(x.s, 3) * p(x.r / x.s));
                    if (x.s != x.r) {
                      EXPECT_EQ(out[1][0], power(x.s - x.r, 3) * p(x.s / (x.s - x.r)));
                    }
                    const Q sum = 3 * x.s + x.r;
                    if (sum != 0) {
                      EXPECT_EQ(out[2][0], power(sum, 3) * p(3 * x.s / sum));
                    }
                    EXPECT_EQ(out[3][0], 27 * p(Q(2, 3)));
                    EXPECT_EQ(out[4], x.q);
                  });
}

TEST(Lowering, SplitsIntoThePolynomialOnBothSides) {
  check_operation("split(P, s)", "R[0] as before, R[1] as after",
                  [](const Outputs& out, const Function& p, const At& x) {
                    for (const Q& t : {Q(0), Q(1), Q(3, 5)}) {
                      EXPECT_EQ(bernstein(out[0], t), p(x.s * t));
                      EXPECT_EQ(bernstein(out[1], t), p(x.s + (1 - x.s) * t));
                    }
                  });
  check_operation("split(P, (1/3))", "R[0] as before, R[1] as after",
                  [](const Outputs& out, const Function& p, const At&) {
                    for (const Q& t : {Q(0), Q(1), Q(3, 5)}) {
                      EXPECT_EQ(bernstein(out[0], t), p(t / 3));
                      EXPECT_EQ(bernstein(out[1], t), p(Q(1, 3) + Q(2, 3) * t));
                    }
                  });
  check_operation("split(P, r/s)", "R[0] as before, R[1] as after",
                  [](const Outputs& out, const Function& p, const At& x) {
                    const Q place = x.r / x.s;
                    for (const Q& t : {Q(0), Q(1), Q(3, 5)}) {
                      EXPECT_EQ(bernstein(out[0], t), power(x.s, 3) * p(place * t));
                      EXPECT_EQ(bernstein(out[1], t), power(x.s, 3) * p(place + (1 - place) * t));
                    }
                  });
}

TEST(Lowering, ComputesScalarFunctionsExactly) {
  check_operation("P",
                  "abs(s) as a, abs(-3 * s) as b, min(s, r, 1/3) as c, max(k) as d, max(s / 3, r / 3) as e, "
                  "sqrt(s * s * 4) as f, min(2 * s, 3 * r) as g, abs(0 - 5) as h, max(-s, 1/10) as i",
                  [](const Outputs& out, const Function&, const At& x) {
                    EXPECT_EQ(out[0][0], abs(x.s));
                    EXPECT_EQ(out[1][0], 3 * abs(x.s));
                    EXPECT_EQ(out[2][0], std::min({x.s, x.r, Q(1, 3)}));
                    EXPECT_EQ(out[3][0], *std::max_element(x.k.begin(), x.k.end()));
                    EXPECT_EQ(out[4][0], std::max(x.s, x.r) / 3);
                    EXPECT_EQ(out[5][0], 2 * abs(x.s));
                    EXPECT_EQ(out[6][0], std::min<Q>(2 * x.s, 3 * x.r));
                    EXPECT_EQ(out[7][0], 5);
                    EXPECT_EQ(out[8][0], std::max<Q>(-x.s, Q(1, 10)));
                  });
  check_operation("P",
                  "1 / s as a, 3 / s as b, 1/10 / s as c, r / s as d, (1/3) / (s * s) as e, 0.1 * s as f, s ^ 5 as g",
                  [](const Outputs& out, const Function&, const At& x) {
                    EXPECT_EQ(out[0][0], 1 / x.s);
                    EXPECT_EQ(out[1][0], 3 / x.s);
                    EXPECT_EQ(out[2][0], Q(1, 10) / x.s);
                    EXPECT_EQ(out[3][0], x.r / x.s);
                    EXPECT_EQ(out[4][0], Q(1, 3) / (x.s * x.s));
                    EXPECT_EQ(out[5][0], x.s / 10);
                    EXPECT_EQ(out[6][0], power(x.s, 5));
                  });
}

}  // namespace
}  // namespace tightrope::dsl::testing
