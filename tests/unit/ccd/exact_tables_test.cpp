/// The tables for exact signs, exhaustively: all cubics with roots at eighths of [-3/8, 11/8], and those with fewer
/// roots, with all small linear and quadratic functions. Every answer must be the truth; every change of a table be
/// noticed.

#include "ccd/methods/exact_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

namespace tightrope::ccd::exact {
namespace {

__extension__ typedef __int128 Integer;
using Coefficients = std::vector<Integer>;

constexpr auto negative = DefiniteSign::negative, zero = DefiniteSign::zero, positive = DefiniteSign::positive;

DefiniteSign sign_of(Integer x) { return x < 0 ? negative : x > 0 ? positive : zero; }

/// Homogeneous value at weights s, t of the polynomial with Bernstein coefficients c.
template <std::size_t N>
Integer form(std::array<Integer, N> c, Integer s, Integer t) {
  for (std::size_t n = N; n > 1; --n) {
    for (std::size_t i = 0; i + 1 < n; ++i) c[i] = c[i] * s + c[i + 1] * t;
  }
  return c[0];
}

/// The tables under test, so that a test can replace one by a broken variant.
struct Tables {
  std::function<Course(DefiniteSign, DefiniteSign)> course = course_of_monotone_slope;
  std::function<bool(Course, DefiniteSign, DefiniteSign)> open = extremum_is_open;
  std::function<Branches<bool>(Course, DefiniteSign, DefiniteSign, DefiniteSign)> existing = existing_roots;
  std::function<DefiniteSign(Course, DefiniteSign, DefiniteSign, DefiniteSign, DefiniteSign)> extremum =
      sign_at_extremum;
  std::function<Branches<DefiniteSign>(Course, DefiniteSign, DefiniteSign, DefiniteSign, DefiniteSign)> linear =
      linear_at_roots;
  std::function<std::optional<DefiniteSign>(DefiniteSign, DefiniteSign)> quadratic = quadratic_at_root;
};

/// A cubic with all its roots in [0, 1] known, in eighths.
struct Cubic {
  std::array<Integer, 4> k;
  std::array<Integer, 3> q;
  std::array<Integer, 2> c;
  std::vector<int> roots;  ///< different ones, ascending

  /// Coefficients of one sign: no roots.
  explicit Cubic(const std::array<Integer, 4>& coefficients) : k(coefficients) { set_differences(); }

  /// The product of linear functions and, if there is room, a quadratic without roots or with none in [0, 1].
  Cubic(const std::vector<int>& at, const Coefficients& rest, Integer factor) : roots(at) {
    Coefficients scaled{factor};  // binomial coefficients multiplied in: products are convolutions
    const auto multiply = [&](const Coefficients& by) {
      Coefficients product(scaled.size() + by.size() - 1);
      for (std::size_t i = 0; i < scaled.size(); ++i) {
        for (std::size_t j = 0; j < by.size(); ++j) product[i + j] += scaled[i] * by[j];
      }
      scaled = product;
    };
    for (const int r : at) multiply({-r, 8 - r});
    multiply(rest);
    while (scaled.size() < 4) multiply({1, 1});
    k = {3 * scaled[0], scaled[1], scaled[2], 3 * scaled[3]};
    set_differences();
    std::sort(roots.begin(), roots.end());
    roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
    std::erase_if(roots, [](int r) { return r < 0 || r > 8; });
  }

  void set_differences() {
    for (std::size_t i = 0; i < 3; ++i) q[i] = k[i + 1] - k[i];
    for (std::size_t i = 0; i < 2; ++i) c[i] = q[i + 1] - q[i];
  }
  DefiniteSign slope_at(int root) const { return sign_of(form(q, 8 - root, root)); }
};

std::vector<Cubic> all_cubics() {
  std::vector<Cubic> cubics;
  for (const Integer factor : {1, -1}) {
    const auto add_with_rootless_quadratics = [&](const std::vector<int>& roots, int size) {
      for (int j0 = 1; j0 <= size; ++j0) {
        for (int j1 = -size; j1 <= size; ++j1) {
          for (int j2 = 1; j2 <= size; ++j2) {
            if (j0 * j2 > j1 * j1) cubics.push_back({roots, {j0, 2 * j1, j2}, factor});
          }
        }
      }
    };
    add_with_rootless_quadratics({}, 8);
    for (int code = 0; code < 10'000; ++code) {
      const std::array<int, 4> k{code % 10 + 1, code / 10 % 10 + 1, code / 100 % 10 + 1, code / 1000 + 1};
      cubics.emplace_back(std::array{factor * k[0], factor * k[1], factor * k[2], factor * k[3]});
    }
    for (int a = -3; a <= 11; ++a) {
      cubics.push_back({{a}, {1}, factor});
      add_with_rootless_quadratics({a}, a < 0 || a > 8 ? 12 : 4);
      for (int b = a; b <= 11; ++b) {
        cubics.push_back({{a, b}, {1}, factor});
        for (int c = b; c <= 11; ++c) cubics.push_back({{a, b, c}, {1}, factor});
      }
    }
  }
  return cubics;
}

/// What the tables make of one cubic.
class Trial {
 public:
  Trial(const Tables& tables, const Cubic& cubic) : tables_(tables), y_(cubic) {}

  /// False if the cubic has to be split first.
  bool classify() {
    std::array<DefiniteSign, 4> k;
    for (std::size_t i = 0; i < 4; ++i) k[i] = sign_of(y_.k[i]);
    if (sign_changes(k) == 1 && opposite(k[0], k[3])) {
      course_ = k[0] == negative ? Course::rising : Course::falling;
      exists_ = {false, true};
      return true;
    }
    if (opposite(sign_of(y_.c[0]), sign_of(y_.c[1])) || y_.q == std::array<Integer, 3>{}) return false;
    course_ = tables_.course(sign_of(y_.q[0]), sign_of(y_.q[2]));
    const DefiniteSign inside = course_ == Course::valley ? negative : positive;
    const DefiniteSign extremum = tables_.open(course_, k[0], k[3]) ? sign_at_extremum_of_cubic() : inside;
    exists_ = tables_.existing(course_, k[0], k[3], extremum);
    return true;
  }

  /// The branches' roots as the cubic has them: one where Y' leads down (of a hill: up) or vanishes, and the other.
  int wrong_roots() {
    first_.clear();
    second_.clear();
    const DefiniteSign up = course_ == Course::hill ? negative : positive;
    for (const int root : y_.roots) {
      const bool one_root = course_ == Course::rising || course_ == Course::falling;
      if (one_root || y_.slope_at(root) != -up) second_.push_back(root);
      if (!one_root && y_.slope_at(root) != up) first_.push_back(root);
    }
    return (first_.size() != (exists_.first ? 1 : 0)) + (second_.size() != (exists_.second ? 1 : 0));
  }

  int wrong_linear_signs() {
    int wrong = 0;
    for (int a = -9; a <= 9; ++a) {
      for (int b = -9; b <= 9; ++b) {
        const auto value_at = [&](int t) { return Integer{a} * (8 - t) + Integer{b} * t; };
        wrong += different(linear({a, b}), value_at);
      }
    }
    return wrong;
  }

  int wrong_quadratic_signs() {
    int wrong = 0;
    for (int code = 0; code < 343; ++code) {
      const std::array<Integer, 3> j{code % 7 - 3, code / 7 % 7 - 3, code / 49 - 3};
      wrong += different(quadratic(j), [&](int t) { return form(j, 8 - t, t); });
    }
    return wrong;
  }

 private:
  DefiniteSign sign_at_extremum_of_cubic() const {
    const auto& [k, q, c, roots] = y_;
    const Integer delta = c[1] - c[0];
    if (delta == 0) {
      const Integer extreme = 4 * k[0] * k[3] - (3 * k[1] - k[0]) * (3 * k[1] - k[0]);
      return course_ == Course::valley ? sign_of(extreme) : -sign_of(extreme);
    }
    const Integer rest0 = k[0] * delta - q[0] * c[0], rest1 = k[3] * delta - q[2] * c[1];
    return tables_.extremum(course_, sign_of(delta), sign_of(rest0), sign_of(rest1), sign_of(form(q, -rest1, rest0)));
  }

  Branches<DefiniteSign> linear(std::array<Integer, 2> l) const {
    const DefiniteSign a = sign_of(l[0]), b = sign_of(l[1]);
    const DefiniteSign y = sign_of(form(y_.k, -l[1], l[0])) * fall(a, b);
    return tables_.linear(course_, a, b, y, sign_of(form(y_.q, -l[1], l[0])));
  }

  Branches<DefiniteSign> quadratic(const std::array<Integer, 3>& j) const {
    const auto& k = y_.k;
    const Integer bend = j[0] - 2 * j[1] + j[2];
    if (bend == 0) return linear({j[0], j[2]});
    const Integer a = 2 * (j[1] - j[2]), b = j[0] - j[2], f = 2 * (j[1] - j[0]);
    const Integer c = 3 * k[2] - 2 * k[3] - k[0], d = 3 * k[1] - 2 * k[0] - k[3];
    const std::array<Integer, 2> m{a * d - b * c, f * c + b * d};
    const auto on_m = linear(m), on_n = linear({k[0] * bend * bend - m[0] * j[0], k[3] * bend * bend - m[1] * j[2]});
    const std::array<Integer, 2> line = m == std::array<Integer, 2>{} ? std::array<Integer, 2>{k[0], k[3]} : m;
    const DefiniteSign rational = sign_of(form(j, -line[1], line[0]));
    return {tables_.quadratic(on_m.first, on_n.first).value_or(rational),
            tables_.quadratic(on_m.second, on_n.second).value_or(rational)};
  }

  template <class Value>
  int different(const Branches<DefiniteSign>& claim, const Value& value_at) const {
    int wrong = 0;
    for (const int root : first_) wrong += claim.first != sign_of(value_at(root));
    for (const int root : second_) wrong += claim.second != sign_of(value_at(root));
    return wrong;
  }

  const Tables& tables_;
  const Cubic& y_;
  Course course_ = Course::unknown;
  Branches<bool> exists_{};
  std::vector<int> first_, second_;
};

struct Findings {
  int wrong = 0, classified = 0, roots = 0;
};

Findings examine(const Tables& tables) {
  static const std::vector<Cubic> cubics = all_cubics();
  Findings findings;
  for (const Cubic& cubic : cubics) {
    Trial trial(tables, cubic);
    if (!trial.classify()) continue;
    findings.classified += 1;
    findings.roots += static_cast<int>(cubic.roots.size());
    findings.wrong += trial.wrong_roots();
    if (!cubic.roots.empty()) findings.wrong += trial.wrong_linear_signs() + trial.wrong_quadratic_signs();
  }
  return findings;
}

TEST(ExactTables, EveryAnswerIsTheTruth) {
  const Findings findings = examine({});
  EXPECT_EQ(findings.wrong, 0);
  EXPECT_GT(findings.classified, 5000);
  EXPECT_GT(findings.roots, 1000);
}

TEST(ExactTables, ChangedEntriesAreNoticed) {
  const auto expect_noticed = [](const char* change, const std::function<void(Tables&)>& apply) {
    Tables broken;
    apply(broken);
    EXPECT_GT(examine(broken).wrong, 0) << change;
  };
  expect_noticed("slope zero at an end", [](Tables& t) {
    t.course = [](DefiniteSign q0, DefiniteSign q2) {
      return q0 == zero || q2 == zero ? Course::valley : course_of_monotone_slope(q0, q2);
    };
  });
  expect_noticed("extremum of hills not asked for", [](Tables& t) {
    t.open = [](Course course, DefiniteSign k0, DefiniteSign k3) {
      return course == Course::valley && k0 == positive && k3 == positive;
    };
  });
  expect_noticed("double root forgotten", [](Tables& t) {
    t.existing = [](Course course, DefiniteSign k0, DefiniteSign k3, DefiniteSign e) {
      const DefiniteSign outside = course == Course::hill ? negative : positive;
      return existing_roots(course, k0, k3, e == zero ? outside : e);
    };
  });
  expect_noticed("root at the end forgotten", [](Tables& t) {
    t.existing = [](Course course, DefiniteSign k0, DefiniteSign k3, DefiniteSign e) {
      const auto exists = existing_roots(course, k0, k3, e);
      return k3 == zero ? Branches<bool>{exists.first, false} : exists;
    };
  });
  expect_noticed("lemma, rest zero at the extremum", [](Tables& t) {
    t.extremum = [](Course course, DefiniteSign d, DefiniteSign r0, DefiniteSign r1, DefiniteSign g) {
      return sign_at_extremum(course, d, r0, r1, g == zero ? positive : g);
    };
  });
  expect_noticed("lemma, zero at an end of rest", [](Tables& t) {
    t.extremum = [](Course course, DefiniteSign d, DefiniteSign r0, DefiniteSign r1, DefiniteSign g) {
      return r0 == zero || r1 == zero ? zero : sign_at_extremum(course, d, r0, r1, g);
    };
  });
  for (const DefiniteSign to : {negative, positive}) {
    expect_noticed("linear, common root", [to](Tables& t) {
      t.linear = [to](Course course, DefiniteSign a, DefiniteSign b, DefiniteSign y, DefiniteSign g) {
        return linear_at_roots(course, a, b, y == zero ? to : y, g);
      };
    });
    expect_noticed("linear, root at the extremum", [to](Tables& t) {
      t.linear = [to](Course course, DefiniteSign a, DefiniteSign b, DefiniteSign y, DefiniteSign g) {
        return linear_at_roots(course, a, b, y, y == zero && g == zero ? to : g);
      };
    });
  }
  expect_noticed("linear, zero at an end", [](Tables& t) {
    t.linear = [](Course course, DefiniteSign a, DefiniteSign b, DefiniteSign y, DefiniteSign g) {
      return a == zero ? Branches<DefiniteSign>{zero, zero} : linear_at_roots(course, a, b, y, g);
    };
  });
  expect_noticed("quadratic, common root", [](Tables& t) {
    t.quadratic = [](DefiniteSign m, DefiniteSign n) { return std::optional(-(m * n)); };
  });
}

TEST(ExactTables, SignChangesLeaveZerosOut) {
  EXPECT_EQ(sign_changes(std::array{positive, zero, negative, zero}), 1);
  EXPECT_EQ(sign_changes(std::array{zero, positive, zero, positive}), 0);
  EXPECT_EQ(sign_changes(std::array{positive, negative, zero, positive}), 2);
  EXPECT_EQ(sign_changes(std::array{negative, positive, negative, positive}), 3);
  EXPECT_EQ(sign_changes(std::array{zero, zero, zero, zero}), 0);
}

TEST(ExactTables, VerdictOfEveryCombination) {
  for (int code = 0; code < 81; ++code) {
    std::array<DefiniteSign, 4> signs;
    bool below = false, above = false;
    for (int i = 0, rest = code; i < 4; ++i, rest /= 3) {
      signs[static_cast<std::size_t>(i)] = static_cast<DefiniteSign>(rest % 3 - 1);
      below = below || rest % 3 == 0;
      above = above || rest % 3 == 2;
    }
    const Verdict expected = below && above ? Verdict::no_contact : below || above ? Verdict::contact : Verdict::open;
    EXPECT_EQ(verdict(signs), expected);
  }
}

}  // namespace
}  // namespace tightrope::ccd::exact
