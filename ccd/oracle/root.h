#pragma once
/// Times in [0, 1] that are roots of forms, exactly: isolation, signs of other forms there, order, enclosure by doubles
/// and by rationals.

#include <optional>
#include <vector>

#include "ccd/oracle/contact_time.h"
#include "ccd/oracle/form.h"
#include "ccd/oracle/oracle.h"

namespace tightrope::ccd::oracle {

/// An algebraic time: the dyadic `lower`, or the only root, and a simple one, of a form in the open interval
/// (lower, lower + 2^-exponent) of dyadic ends that are no roots. Sign questions narrow the interval.
class Root {
 public:
  /// Exactly `time`.
  static Root exactly(DyadicTime time) { return Root(std::move(time), Form(), true); }
  /// The root of `form`, given on [lower, lower + 2^-exponent] over that interval's own parameter.
  static Root isolated(DyadicTime lower, Form form) { return Root(std::move(lower), std::move(form), false); }

  /// The sign of `form` at this time, 0 exactly where it vanishes.
  int sign(const Form& form);
  /// The sign of `form` on the whole current interval by its hull; 0 if the hull does not tell. Narrows nothing.
  int sign_at_first_sight(const Form& form) const;
  /// Largest double <= this time and smallest double >= it.
  Contact enclosure() const;
  /// The sign of (this time - other), 0 exactly where they are the same number.
  int compare(Root& other);
  /// This time, if it is rational.
  std::optional<mpq_class> rational();
  /// Ends at most `width` > 0 apart with this time strictly between; or twice this time, if it is rational.
  TimeInterval interval(const mpq_class& width);

 private:
  Root(DyadicTime lower, Form form, bool exact) : lower_(std::move(lower)), form_(std::move(form)), exact_(exact) {}
  bool halve();                        ///< one bisection; whether the root lies in the right half (or is its lower end)
  int compare(DyadicTime time) const;  ///< sign of (this time - time), time in [0, 1]

  DyadicTime lower_;
  Form form_;  // over the interval's own parameter; opposite strict signs at its ends
  bool exact_;
};

/// The distinct roots in [0, 1] of a form that is not zero, ascending.
std::vector<Root> roots(const Form& form);

}  // namespace tightrope::ccd::oracle
