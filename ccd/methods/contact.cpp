#include "tightrope/contact.h"

namespace tightrope::ccd {

template <class Real>
std::optional<Contact<Real>> safe_contact(Kind kind, const Real* points);
template <class Real>
std::optional<Contact<Real>> safe_tight_contact(Kind kind, const Real* points);

std::optional<Contact<double>> first_contact(Kind kind, const double* points, Method method) {
  return method == Method::safe ? safe_contact(kind, points) : safe_tight_contact(kind, points);
}

std::optional<Contact<float>> first_contact(Kind kind, const float* points, Method method) {
  return method == Method::safe ? safe_contact(kind, points) : safe_tight_contact(kind, points);
}

}  // namespace tightrope::ccd
