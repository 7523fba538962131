/// The decision tables against exact cubics with known rational roots: every definite entry must hold for every exact
/// situation that leaves its arguments open, and every change of an entry must be noticed.

#include "ccd/tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace tightrope::ccd {
namespace {

__extension__ typedef __int128 Integer;

constexpr std::array<Sign, 3> all_signs{Sign::negative, Sign::uncertain, Sign::positive};

Sign exact_sign(Integer x) { return x < 0 ? Sign::negative : x > 0 ? Sign::positive : Sign::uncertain; }

/// The functions under test, so that a test can replace one of them by a broken variant.
struct Tables {
  std::function<Sign(Sign, Sign, Sign, Sign)> crossing = single_crossing;
  std::function<Course(Sign, Sign, Sign)> course = course_of_monotone_slope;
  std::function<Branches<bool>(Course, Sign, Sign)> possible = possible_roots;
  std::function<Sign(Course, Sign, Sign, Sign, Sign, Sign)> extremum = sign_at_extremum;
  std::function<bool(Course, Sign, Sign, Sign, Sign)> decides = extremum_decides;
  std::function<Branches<Sign>(Course, Sign, Sign, Sign, Sign, Sign)> linear = linear_at_roots;
  std::function<Sign(Sign, Sign)> quadratic = quadratic_at_root;
};

/// Homogeneous value of a form with the given Bernstein coefficients at weights s, t.
Integer form(std::vector<Integer> c, Integer s, Integer t) {
  for (; c.size() > 1; c.pop_back()) {
    for (std::size_t i = 0; i + 1 < c.size(); ++i) c[i] = c[i] * s + c[i + 1] * t;
  }
  return c[0];
}

/// An exact cubic, three times its Bernstein coefficients k, with roots at eighths.
struct ExactCubic {
  std::array<Integer, 4> k;
  std::array<Integer, 3> q;
  std::array<Integer, 2> c;
  std::vector<Integer> roots;  ///< in eighths, those in [0, 1]
  bool slope_is_monotone() const { return (c[0] >= 0 && c[1] >= 0) || (c[0] <= 0 && c[1] <= 0); }
  Integer slope_at(Integer eighths) const { return form({q[0], q[1], q[2]}, 8 - eighths, eighths); }
};

class Generator {
 public:
  explicit Generator(unsigned seed) : random_(seed) {}
  Integer number(Integer low, Integer high) {
    return low + static_cast<Integer>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(int percent) { return number(0, 99) < percent; }

  /// (8 t - r0) times a second factor: two more roots, a double root, or none.
  ExactCubic cubic() {
    const Integer r = number(-3, 11);
    std::array<Integer, 3> j{number(-9, 9), number(-9, 9), number(-9, 9)};  // any quadratic
    std::vector<Integer> roots{r};
    if (chance(70)) {
      const Integer r1 = chance(20) ? r : number(-3, 11);
      const Integer a = number(-3, 3), b = chance(30) ? a : number(-3, 3);
      j = {-r1 * a * 2, -r1 * b + (8 - r1) * a, (8 - r1) * b * 2};  // (8 t - r1) (a (1-t) + b t), doubled
      roots.push_back(r1);
      if (a != b && 8 * a % (a - b) == 0) roots.push_back(8 * a / (a - b));
    }
    ExactCubic y;
    const Integer a = -r, b = 8 - r;
    y.k = {3 * a * j[0], b * j[0] + 2 * a * j[1], 2 * b * j[1] + a * j[2], 3 * b * j[2]};
    for (std::size_t i = 0; i < 3; ++i) y.q[i] = y.k[i + 1] - y.k[i];
    for (std::size_t i = 0; i < 2; ++i) y.c[i] = y.q[i + 1] - y.q[i];
    for (const Integer root : roots) {
      if (root >= 0 && root <= 8) y.roots.push_back(root);
    }
    return y;
  }

  /// The sign, or with the given probability nothing.
  Sign erode(Integer x, int percent) { return chance(percent) ? Sign::uncertain : exact_sign(x); }

 private:
  std::mt19937_64 random_;
};

struct Findings {
  int wrong = 0;     ///< a definite answer that is false at a root, or a root removed
  int definite = 0;  ///< definite answers at roots
  int removed = 0;   ///< pieces without roots that were recognised
  int known = 0;     ///< pieces whose course is known
};

/// One cubic, one erosion: what the tables make of it.
class Trial {
 public:
  Trial(const Tables& tables, Generator& generator, Findings& findings)
      : tables_(tables),
        generator_(generator),
        findings_(findings),
        percent_(static_cast<int>(generator.number(0, 60))) {}

  void run() {
    y_ = generator_.cubic();
    classify();
    findings_.known += course_ != Course::unknown;
    check_possible();
    check_extremum();
    const Integer a = generator_.number(-9, 9), b = generator_.number(-9, 9);
    check(linear(a, b), [&](Integer t) { return a * (8 - t) + b * t; });
    check_quadratic();
  }

 private:
  void classify() {
    for (std::size_t i = 0; i < 4; ++i) k_[i] = generator_.erode(y_.k[i], percent_);
    for (std::size_t i = 0; i < 3; ++i) q_[i] = generator_.erode(y_.q[i], percent_);
    Sign direction = tables_.crossing(k_[0], k_[1], k_[2], k_[3]);
    if (direction == Sign::uncertain) direction = common(q_);
    switch (direction) {
      case Sign::positive:
        course_ = Course::rising;
        break;
      case Sign::negative:
        course_ = Course::falling;
        break;
      case Sign::uncertain: {
        const Sign bend = generator_.erode(y_.c[0] != 0 ? y_.c[0] : y_.c[1], percent_);
        course_ = y_.slope_is_monotone() ? tables_.course(q_[0], q_[2], bend) : Course::unknown;
      }
    }
  }

  /// Is the root on the branch? One where Y' does not change sign from + to - before it, or after it.
  Branches<bool> branches(Integer root) const {
    const Sign up = course_ == Course::hill ? Sign::negative : Sign::positive;
    if (course_ != Course::valley && course_ != Course::hill) return {false, true};
    const Sign at_root = exact_sign(y_.slope_at(root));  // Y' is monotone: its sign at the ends and here tells all
    return {exact_sign(y_.q[0]) != up && at_root != up, exact_sign(y_.q[2]) != -up && at_root != -up};
  }

  void check_possible() {
    const Branches<bool> possible = tables_.possible(course_, k_[0], k_[3]);
    for (const Integer root : y_.roots) {
      const Branches<bool> on = branches(root);
      findings_.wrong += (on.first && !possible.first) || (on.second && !possible.second) || (!on.first && !on.second);
    }
    both_possible_ = possible.first && possible.second;
  }

  void check_extremum() {
    if (!both_possible_ || !tables_.decides(course_, q_[0], q_[2], k_[0], k_[3])) return;
    const Integer delta = y_.c[1] - y_.c[0];
    const Integer rest0 = y_.k[0] * delta - y_.q[0] * y_.c[0], rest1 = y_.k[3] * delta - y_.q[2] * y_.c[1];
    const Sign at_extremum =
        tables_.extremum(course_, generator_.erode(delta, percent_ / 2), generator_.erode(rest0, percent_ / 2),
                         generator_.erode(rest1, percent_ / 2), generator_.erode(rest0 - rest1, percent_ / 2),
                         generator_.erode(form({y_.q[0], y_.q[1], y_.q[2]}, -rest1, rest0), percent_ / 2));
    if (at_extremum != (course_ == Course::valley ? Sign::positive : Sign::negative)) return;
    findings_.removed += 1;
    findings_.wrong += !y_.roots.empty();
  }

  Branches<Sign> linear(Integer a, Integer b) {
    const Integer y = form({y_.k[0], y_.k[1], y_.k[2], y_.k[3]}, -b, a);
    const Integer g = form({y_.q[0], y_.q[1], y_.q[2]}, -b, a);
    return tables_.linear(course_, generator_.erode(a, percent_), generator_.erode(b, percent_),
                          generator_.erode(a - b, percent_ / 2), generator_.erode(y, percent_ / 2),
                          generator_.erode(g, percent_ / 2));
  }

  void check_quadratic() {
    std::array<Integer, 3> j{generator_.number(-2, 2), generator_.number(-2, 2), generator_.number(-2, 2)};
    const auto& k = y_.k;
    const Integer a = 2 * (j[1] - j[2]), b = j[0] - j[2], f = 2 * (j[1] - j[0]);
    const Integer c = 3 * k[2] - 2 * k[3] - k[0], d = 3 * k[1] - 2 * k[0] - k[3];
    const Integer square = (j[0] - 2 * j[1] + j[2]) * (j[0] - 2 * j[1] + j[2]);
    const std::array<Integer, 2> m{a * d - b * c, f * c + b * d};
    const std::array<Integer, 2> n{k[0] * square - m[0] * j[0], k[3] * square - m[1] * j[2]};
    const Branches<Sign> at_m = linear(m[0], m[1]), at_n = linear(n[0], n[1]);
    check({tables_.quadratic(at_m.first, at_n.first), tables_.quadratic(at_m.second, at_n.second)}, [&](Integer t) {
      return form({j[0], j[1], j[2]}, 8 - t, t);
    });
  }

  template <class Value>
  void check(const Branches<Sign>& claim, const Value& value_at) {
    for (const Integer root : y_.roots) {
      const Branches<bool> on = branches(root);
      const Sign truth = exact_sign(value_at(root));
      for (const auto& [here, sign] : {std::pair{on.first, claim.first}, std::pair{on.second, claim.second}}) {
        if (!here || sign == Sign::uncertain) continue;
        findings_.definite += 1;
        findings_.wrong += sign != truth;
      }
    }
  }

  const Tables& tables_;
  Generator& generator_;
  Findings& findings_;
  int percent_;
  ExactCubic y_;
  std::array<Sign, 4> k_{};
  std::array<Sign, 3> q_{};
  Course course_ = Course::unknown;
  bool both_possible_ = false;
};

Findings examine(const Tables& tables, int trials, bool until_wrong = false) {
  Findings findings;
  Generator generator(20240607);
  for (int i = 0; i < trials && !(until_wrong && findings.wrong > 0); ++i) Trial(tables, generator, findings).run();
  return findings;
}

bool noticed(const Tables& broken) { return examine(broken, 2'000'000, true).wrong > 0; }

TEST(DecisionTables, DefiniteEntriesHoldForExactCubicsUnderErosion) {
  const Findings findings = examine({}, 1'000'000);
  EXPECT_EQ(findings.wrong, 0);
  EXPECT_GT(findings.definite, 200'000);  // the tables do answer
  EXPECT_GT(findings.removed, 100);
  EXPECT_GT(findings.known, 200'000);
}

TEST(DecisionTables, CommonProductAndOppositeAgreeWithArithmetic) {
  for (const Sign a : all_signs) {
    for (const Sign b : all_signs) {
      const int x = static_cast<int>(a), y = static_cast<int>(b);
      EXPECT_EQ(static_cast<int>(product(a, b)), x * y);
      EXPECT_EQ(opposite(a, b), x * y < 0);
      EXPECT_EQ(static_cast<int>(common(a, b)), x == y ? x : 0);
      EXPECT_EQ(static_cast<int>(pair(a, b)), 3 * (x + 1) + y + 1);
      EXPECT_EQ(static_cast<int>(quadratic_at_root(a, b)), -x * y);
    }
  }
}

TEST(DecisionTables, SingleCrossingAgreesWithCountingSignChanges) {
  // Exactly the sequences of which every completion of the inner signs has one change (a zero counts as either).
  const auto changes = [](std::array<int, 4> s) {
    int count = 0;
    for (std::size_t i = 1; i < 4; ++i) count += s[i] != s[i - 1];
    return count;
  };
  for (const Sign s0 : all_signs) {
    for (const Sign s1 : all_signs) {
      for (const Sign s2 : all_signs) {
        for (const Sign s3 : all_signs) {
          bool one = s0 != Sign::uncertain && s3 != Sign::uncertain;
          for (int a = -1; a <= 1; a += 2) {
            for (int b = -1; b <= 1; b += 2) {
              if (static_cast<int>(s1) == -a || static_cast<int>(s2) == -b) continue;
              one = one && changes({static_cast<int>(s0), a, b, static_cast<int>(s3)}) == 1;
            }
          }
          EXPECT_EQ(single_crossing(s0, s1, s2, s3), one ? s3 : Sign::uncertain);
        }
      }
    }
  }
}

TEST(DecisionTables, HillsMirrorValleys) {
  const auto mirror = [](Course course) {
    switch (course) {
      case Course::rising:
        return Course::falling;
      case Course::falling:
        return Course::rising;
      case Course::valley:
        return Course::hill;
      case Course::hill:
        return Course::valley;
      case Course::unknown:
        return Course::unknown;
    }
    return Course::unknown;
  };
  for (const Sign a : all_signs) {
    for (const Sign b : all_signs) {
      for (const Sign c : all_signs) {
        EXPECT_EQ(course_of_monotone_slope(-a, -b, -c), mirror(course_of_monotone_slope(a, b, c)));
        for (const Course course : {Course::rising, Course::falling, Course::valley, Course::hill, Course::unknown}) {
          EXPECT_EQ(possible_roots(mirror(course), -a, -b), possible_roots(course, a, b));
          for (const Sign d : all_signs) {
            EXPECT_EQ(extremum_decides(mirror(course), -a, -b, -c, -d), extremum_decides(course, a, b, c, d));
            for (const Sign e : all_signs) {
              EXPECT_EQ(linear_at_roots(mirror(course), a, b, c, -d, -e), linear_at_roots(course, a, b, c, d, e));
              EXPECT_EQ(sign_at_extremum(mirror(course), -a, b, c, d, -e), -sign_at_extremum(course, a, b, c, d, e));
            }
          }
        }
      }
    }
  }
}

// Every entry of table B for valleys is the strongest that holds: any other is noticed.
TEST(DecisionTables, EveryChangeOfTheLinearTableForValleysIsNoticed) {
  for (const Sign y : all_signs) {
    for (const Sign g : all_signs) {
      for (const bool first : {true, false}) {
        for (const bool take_a : {true, false}) {
          const auto strongest = linear_at_roots(Course::valley, Sign::negative, Sign::positive, Sign::negative, -y, g);
          const Sign replacement = take_a ? Sign::negative : Sign::positive;  // a's sign or b's
          if ((first ? strongest.first : strongest.second) == replacement) continue;
          Tables broken;
          broken.linear = [&](Course course, Sign a, Sign b, Sign fall, Sign sign_y, Sign sign_g) {
            Branches<Sign> result = linear_at_roots(course, a, b, fall, sign_y, sign_g);
            if (course != Course::valley || fall == Sign::uncertain || product(sign_y, fall) != y || sign_g != g) {
              return result;
            }
            (first ? result.first : result.second) = take_a ? a : b;
            return result;
          };
          EXPECT_TRUE(noticed(broken)) << static_cast<int>(y) << ' ' << static_cast<int>(g) << ' ' << first << take_a;
        }
      }
    }
  }
}

TEST(DecisionTables, EveryChangeOfTableAIsNoticed) {
  for (const Sign q0 : all_signs) {
    for (const Sign q2 : all_signs) {
      for (const Course other : {Course::rising, Course::falling, Course::valley, Course::hill}) {
        const bool monotone = q0 == q2 && q0 != Sign::uncertain;  // a rising Y is also a (degenerate) valley and hill
        const Course entry = course_of_monotone_slope(q0, q2, Sign::uncertain);
        if (other == entry || (monotone && (other == Course::valley || other == Course::hill))) continue;
        if (monotone) continue;  // never asked: common(q) has decided already
        Tables broken;
        broken.course = [&](Sign a, Sign b, Sign bend) {
          return a == q0 && b == q2 ? other : course_of_monotone_slope(a, b, bend);
        };
        EXPECT_TRUE(noticed(broken)) << static_cast<int>(q0) << ' ' << static_cast<int>(q2) << ' '
                                     << static_cast<int>(other);
      }
    }
  }
}

TEST(DecisionTables, BrokenVariantsAreNoticed) {
  Tables published_linear;  // Y and Y' both uncertain at the root of the linear function: claims the signs of its ends
  published_linear.linear = [](Course course, Sign a, Sign b, Sign fall, Sign y, Sign g) {
    if (course == Course::valley && y == Sign::uncertain && g == Sign::uncertain) return Branches<Sign>{a, b};
    return linear_at_roots(course, a, b, fall, y, g);
  };
  EXPECT_TRUE(noticed(published_linear));

  Tables no_fall;  // y not multiplied by the sign of a - b
  no_fall.linear = [](Course course, Sign a, Sign b, Sign, Sign y, Sign g) {
    return linear_at_roots(course, a, b, Sign::positive, y, g);
  };
  EXPECT_TRUE(noticed(no_fall));

  Tables no_minus;  // the minus sign that the paper's Algorithm 2 lacks
  no_minus.quadratic = [](Sign m, Sign n) { return product(m, n); };
  EXPECT_TRUE(noticed(no_minus));

  Tables no_delta;
  no_delta.extremum = [](Course course, Sign, Sign rest0, Sign rest1, Sign fall, Sign g) {
    return sign_at_extremum(course, Sign::positive, rest0, rest1, fall, g);
  };
  EXPECT_TRUE(noticed(no_delta));

  Tables no_guard;  // removes roots by an extremum that may lie outside the piece
  no_guard.decides = [](Course course, Sign, Sign, Sign, Sign) {
    return course == Course::valley || course == Course::hill;
  };
  EXPECT_TRUE(noticed(no_guard));

  Tables root_of_rest_swapped;
  root_of_rest_swapped.extremum = [](Course course, Sign delta, Sign rest0, Sign rest1, Sign fall, Sign g) {
    return sign_at_extremum(course, delta, rest0, rest1, fall, -g);
  };
  EXPECT_TRUE(noticed(root_of_rest_swapped));

  Tables strict_ends;  // an uncertain end sign excludes a root there
  strict_ends.possible = [](Course course, Sign k0, Sign k3) {
    Branches<bool> result = possible_roots(course, k0, k3);
    if (course == Course::rising) result.second = k0 == Sign::negative && k3 == Sign::positive;
    return result;
  };
  EXPECT_TRUE(noticed(strict_ends));

  Tables careless_descartes;  // takes -, ?, -, + for one change
  careless_descartes.crossing = [](Sign k0, Sign k1, Sign k2, Sign k3) {
    if (k0 == Sign::negative && k3 == Sign::positive && k1 == Sign::uncertain) return Sign::positive;
    return single_crossing(k0, k1, k2, k3);
  };
  EXPECT_TRUE(noticed(careless_descartes));
}

}  // namespace
}  // namespace tightrope::ccd
