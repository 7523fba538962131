#include "stability/sweep.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "oracle/oracle.h"
#include "query.h"
#include "stability/base_queries.h"
#include "stability/exact_stage.h"

namespace tightrope::ccd::stability {
namespace {

constexpr std::size_t most_broken_promises = 100;

/// Multiplies by 2^exponent. False: rounding, underflow or overflow made another query of it.
template <class T>
bool scale(std::span<const T, 24> points, int exponent, std::span<T, 24> scaled) {
  bool exact = true;
  for (std::size_t i = 0; i < 24; ++i) {
    scaled[i] = std::ldexp(points[i], exponent);
    exact &= std::ldexp(scaled[i], -exponent) == points[i];
  }
  return exact;
}

template <class T>
bool finite(std::span<const T, 24> points) {
  return std::all_of(points.begin(), points.end(), [](T x) { return std::isfinite(x); });
}

template <class T>
bool oracle_contact(Kind kind, std::span<const T, 24> points) {
  std::array<double, 24> wide{};
  std::copy(points.begin(), points.end(), wide.begin());
  return oracle::contact(kind, wide);
}

class Sweep {
 public:
  Sweep(const SweepRequest& request, const Proceed& proceed) : request_(request), proceed_(proceed) {
    Atlas& atlas = result_.atlas;
    atlas = {.seed = request.seed,
             .queries = request.queries,
             .axes = request.axes,
             .families = {},
             .methods = {},
             .maps = {}};
    for (const SceneInfo& info : scenes()) {
      const bool wanted =
          std::find(request.families.begin(), request.families.end(), info.scene) != request.families.end();
      if (wanted) atlas.families.push_back({std::string(info.name), std::string(info.what)});
    }
    for (const Method method : request.methods) {
      const auto info = std::find_if(methods().begin(), methods().end(),
                                     [&](const MethodInfo& candidate) { return candidate.method == method; });
      infos_.push_back(*info);
      atlas.methods.push_back({std::string(info->name), info->conservative, info->exact});
    }
    all_ = static_cast<std::uint64_t>(request.families.size() * request.kinds.size() * request.reals.size() *
                                      request.axes.cells()) *
           request.queries;
  }

  std::optional<SweepResult> run() {
    for (const Real real : request_.reals) {
      for (const Kind kind : request_.kinds) {
        for (const Scene family : request_.families) {
          const bool whole = real == Real::in_double ? add_map<double>(family, kind) : add_map<float>(family, kind);
          if (!whole) return std::nullopt;
        }
      }
    }
    return std::move(result_);
  }

 private:
  template <class T>
  bool add_map(Scene family, Kind kind) {
    const std::size_t cells = request_.axes.cells();
    Map map{.family = std::string(name(family)),
            .kind = kind,
            .real = sizeof(T) == sizeof(double) ? Real::in_double : Real::in_float,
            .queries = Counts(cells),
            .contacts = Counts(cells),
            .methods = {}};
    for (const MethodInfo& info : infos_) {
      const Counts none(cells);
      map.methods.push_back(
          {std::string(info.name), none, none, none, none, none, has_exact_stage(info.method) ? none : Counts()});
    }
    const auto bases = base_queries(family, kind, request_.queries, request_.seed);
    for (std::size_t offset = 0; offset < request_.axes.offsets.size(); ++offset) {
      for (std::size_t distance = 0; distance < request_.axes.distances.size(); ++distance) {
        for (const BaseQuery& base : bases) {
          std::array<T, 24> points{};
          const auto wide = placed(base, request_.axes.distances[distance], request_.axes.offsets[offset]);
          std::transform(wide.begin(), wide.end(), points.begin(), [](double x) { return static_cast<T>(x); });
          add_scales<T>(map, points, offset, distance);
          done_ += request_.axes.scales.size();
          if (!proceed_(done_, all_)) return false;
        }
      }
    }
    result_.atlas.maps.push_back(std::move(map));
    return true;
  }

  /// One query at all scales. Contact does not change with the scale, so the oracle decides once where scaling is
  /// exact.
  template <class T>
  void add_scales(Map& map, std::span<const T, 24> points, std::size_t offset, std::size_t distance) {
    std::optional<bool> contact;
    for (std::size_t i = 0; i < request_.axes.scales.size(); ++i) {
      std::array<T, 24> scaled{};
      const bool exact = scale<T>(points, scale_exponent(request_.axes.scales[i], map.real), scaled);
      if (!finite<T>(scaled)) continue;
      if (exact && !contact) contact = oracle_contact<T>(map.kind, scaled);
      add_query<T>(map, scaled, exact ? *contact : oracle_contact<T>(map.kind, scaled),
                   request_.axes.cell(offset, distance, i));
    }
  }

  template <class T>
  void add_query(Map& map, std::span<const T, 24> points, bool contact, std::size_t cell) {
    map.queries[cell] += 1;
    map.contacts[cell] += contact ? 1 : 0;
    for (std::size_t m = 0; m < infos_.size(); ++m) {
      const MethodInfo& info = infos_[m];
      MethodCounts& counts = map.methods[m];
      SignCounts signs;
      const bool answer = collides(map.kind, points.data(), info.method, signs);
      counts.misses[cell] += contact && !answer ? 1 : 0;
      counts.false_alarms[cell] += answer && !contact ? 1 : 0;
      counts.uncertain[cell] += signs.uncertain > 0 ? 1 : 0;
      counts.signs[cell] += static_cast<std::uint32_t>(signs.read);
      counts.uncertain_signs[cell] += static_cast<std::uint32_t>(signs.uncertain);
      if (!counts.exact.empty()) counts.exact[cell] += reaches_exact_stage(info.method, map.kind, points) ? 1 : 0;
      const bool broken = answer != contact && (contact ? info.conservative : info.exact);
      if (broken && result_.broken.size() < most_broken_promises) {
        result_.broken.push_back({info.method, map.kind, map.real, contact, {points.begin(), points.end()}});
      }
    }
  }

  const SweepRequest& request_;
  const Proceed& proceed_;
  std::vector<MethodInfo> infos_;
  SweepResult result_;
  std::uint64_t done_ = 0;
  std::uint64_t all_ = 0;
};

}  // namespace

std::optional<SweepResult> sweep(const SweepRequest& request, const Proceed& proceed) {
  return Sweep(request, proceed).run();
}

}  // namespace tightrope::ccd::stability
