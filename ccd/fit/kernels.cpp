/// The looks of fit/look.h, compiled: eight of each kind and precision.

#include <array>
#include <limits>
#include <type_traits>
#include <utility>

#include "fit/look.h"
#include "look.safe.double.h"
#include "look.safe.float.h"
#include "tightrope/fitted.h"
#include "unit_look.static.double.h"
#include "unit_look.static.float.h"

namespace tightrope::ccd {
namespace {

template <Kind kind, class Number, bool with_range, bool at_rest, bool ends>
struct UnitModel {
  static constexpr bool faces = kind == Kind::vertex_face;
  using Real = Number;
  using Plane = std::conditional_t<with_range,
                                   std::conditional_t<faces, generated::unit_look_plane_of_face<bound::fixed, Real>,
                                                      generated::unit_look_plane_of_edges<bound::fixed, Real>>,
                                   std::conditional_t<faces, generated::look_plane_of_face<bound::safe, Real>,
                                                      generated::look_plane_of_edges<bound::safe, Real>>>;
  using Resting = std::conditional_t<with_range,
                                     std::conditional_t<faces, generated::unit_look_face_at_rest<bound::fixed, Real>,
                                                        generated::unit_look_edge_at_rest<bound::fixed, Real>>,
                                     std::conditional_t<faces, generated::look_face_at_rest<bound::safe, Real>,
                                                        generated::look_edge_at_rest<bound::safe, Real>>>;
  using AtRest = std::conditional_t<at_rest, Resting, void>;
  static constexpr Real range = with_range ? Real{1} : std::numeric_limits<Real>::infinity();
  static constexpr bool both_ends = ends;
};

template <Kind kind, class Model>
void decide(const typename Model::Real* points, std::size_t count, unsigned char* results) {
  fitted::contacts<kind, Model>(points, count, results, Method::tightrope);
}

template <Kind kind, class Model>
void look_only(const typename Model::Real* points, std::size_t count, unsigned char* results) {
  for (std::size_t i = 0; i < count; ++i) results[i] = fitted::apart<kind, Model>(points + 24 * i) ? 0 : 1;
}

constexpr std::size_t models = 8;

template <Kind kind, class Real, std::size_t bits>
using ModelOf = UnitModel<kind, Real, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0>;

std::size_t bits_of(const Look& look) {
  return (look.range ? 1U : 0U) | (look.at_rest ? 2U : 0U) | (look.both_ends ? 4U : 0U);
}

template <Kind kind, class Real, std::size_t... bits>
Contacts<Real> deciding(std::size_t which, std::index_sequence<bits...>) {
  constexpr std::array<Contacts<Real>, models> table{decide<kind, ModelOf<kind, Real, bits>>...};
  return table[which];
}
template <Kind kind, class Real, std::size_t... bits>
Contacts<Real> looking(std::size_t which, std::index_sequence<bits...>) {
  constexpr std::array<Contacts<Real>, models> table{look_only<kind, ModelOf<kind, Real, bits>>...};
  return table[which];
}

}  // namespace

template <class Real>
Contacts<Real> unit_contacts(Kind kind, const Look& look) {
  constexpr auto all = std::make_index_sequence<models>();
  return kind == Kind::vertex_face ? deciding<Kind::vertex_face, Real>(bits_of(look), all)
                                   : deciding<Kind::edge_edge, Real>(bits_of(look), all);
}
template <class Real>
Contacts<Real> unit_open(Kind kind, const Look& look) {
  constexpr auto all = std::make_index_sequence<models>();
  return kind == Kind::vertex_face ? looking<Kind::vertex_face, Real>(bits_of(look), all)
                                   : looking<Kind::edge_edge, Real>(bits_of(look), all);
}
template Contacts<double> unit_contacts(Kind, const Look&);
template Contacts<float> unit_contacts(Kind, const Look&);
template Contacts<double> unit_open(Kind, const Look&);
template Contacts<float> unit_open(Kind, const Look&);

}  // namespace tightrope::ccd
