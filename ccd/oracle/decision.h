#pragma once
/// The oracle's decision with a switch for the tests: answers with one known defect show that the tests would notice
/// it.

#include <optional>
#include <span>

#include "ccd/oracle/contact_time.h"
#include "ccd/oracle/oracle.h"

namespace tightrope::ccd::oracle {

/// Test hook: leaves one case of the decision out or gets it wrong.
enum class Defect {
  none,
  collapsed_never_touches,       ///< n(t) = 0 counts as no contact
  collapsed_always_touches,      ///< n(t) = 0 counts as contact, as the published G-form says
  coplanar_motion_only_at_ends,  ///< Y = 0 for all t is looked at for t = 0 and t = 1 only
  open_features,                 ///< a zero barycentric weight counts as no contact
  sign_change_expected,          ///< Y of one sign at t = 0 and t = 1 counts as no contact
};

/// As first_contact() and contact(), in oracle.h, but for the defect.
std::optional<Contact> first_contact(Kind kind, std::span<const double, 24> points, Defect defect);
bool contact(Kind kind, std::span<const double, 24> points, Defect defect);
/// As the function in contact_time.h.
std::optional<TimeInterval> first_contact(Kind kind, std::span<const double, 24> points, const mpq_class& width,
                                          Defect defect);

}  // namespace tightrope::ccd::oracle
