#include "codegen/charts/labels.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

namespace tightrope::charts {
namespace {

constexpr double forbidden = 1e6;           // the cost of labels that overlap
constexpr double through_label_cost = 300;  // of a leader
constexpr double leader_cost = 12;          // as much as 12 pixels of distance
constexpr double crossing_cost = 25;        // of two leaders
constexpr double upon_line_cost = 20;       // a label upon a line of the chart, a leader across it
constexpr double through_marker_cost = 60;
constexpr double ambiguous_cost = 35;  // a label without leader that is nearer to another marker
constexpr double first_gap = 2;        // pixels between marker and label
constexpr double leader_from_gap = 7;  // from here on a leader is drawn
constexpr int directions = 32;
constexpr int starts = 12;        // of the local search
constexpr int more_starts = 100;  // while some label has no place
constexpr int passes = 40;

struct Candidate {
  LabelPlace place;
  double cost = 0;  ///< on its own
};

/// The point of the box that is nearest to `p`.
Place nearest(const Box& box, Place p) {
  return {std::clamp(p.x, box.left, box.right), std::clamp(p.y, box.top, box.bottom)};
}

double distance(const Box& box, Place p) {
  const Place q = nearest(box, p);
  return std::hypot(q.x - p.x, q.y - p.y);
}

Segment leader_of(const LabelRequest& request, const Box& box) {
  const Place end = nearest(box, request.marker);
  const double length = std::hypot(end.x - request.marker.x, end.y - request.marker.y);
  const double part = length > 0 ? std::min(1.0, request.radius / length) : 0;
  return {{request.marker.x + part * (end.x - request.marker.x), request.marker.y + part * (end.y - request.marker.y)},
          end};
}

class Placer {
 public:
  Placer(std::span<const LabelRequest> requests, const Box& frame, std::span<const Box> obstacles,
         std::span<const Segment> lines)
      : requests_(requests), frame_(frame), obstacles_(obstacles), lines_(lines) {
    for (const LabelRequest& request : requests) candidates_.push_back(candidates_of(request));
  }

  std::vector<LabelPlace> run() {
    std::mt19937_64 random(1);
    double best_cost = std::numeric_limits<double>::infinity();
    std::vector<std::size_t> best;
    for (int start = 0; start < starts || (start < more_starts && best_cost >= forbidden / 2); ++start) {
      std::vector<std::size_t> chosen = initial();
      const double cost = improve(order(start, random), chosen);
      if (cost < best_cost) {
        best_cost = cost;
        best = std::move(chosen);
      }
    }
    return without_conflicts(best);
  }

 private:
  /// Places on rings around the marker, the last candidate being none at all.
  std::vector<Candidate> candidates_of(const LabelRequest& request) const {
    std::vector<Candidate> result;
    for (double gap = first_gap; gap < frame_.width(); gap = gap * 1.3 + 4) {
      for (int d = 0; d < directions; ++d) {
        const double angle = 2 * std::numbers::pi * d / directions;
        const Place towards{std::cos(angle), -std::sin(angle)};
        const double reach = request.radius + gap;
        const Place centre{request.marker.x + towards.x * reach + sign(towards.x) * request.width / 2,
                           request.marker.y + towards.y * reach + sign(towards.y) * request.height / 2};
        add(request, box_around(centre, request.width, request.height), gap, d, result);
      }
    }
    result.push_back({.place = {}, .cost = forbidden / 2});
    return result;
  }

  static double sign(double x) { return x > 1e-9 ? 1 : x < -1e-9 ? -1 : 0; }

  void add(const LabelRequest& request, const Box& box, double gap, int direction,
           std::vector<Candidate>& candidates) const {
    if (!frame_.contains(box)) return;
    for (const Box& obstacle : obstacles_) {
      if (overlap(box, obstacle)) return;
    }
    // To the right is best, then to the left, then above and below.
    constexpr std::array<double, 16> preference = {0, 1, 2, 3, 2, 4, 3, 2, 1, 3, 4, 5, 3, 4, 3, 2};
    const double dislike = preference[static_cast<std::size_t>(direction * 16 / directions)];
    Candidate candidate{.place = {.placed = true, .box = box, .has_leader = gap >= leader_from_gap, .leader = {}},
                        .cost = gap + dislike / 2};
    const Box around{box.left - 2, box.top, box.right + 2, box.bottom};  // letters need room beside upright lines
    for (const Segment& line : lines_) candidate.cost += meets(line, around) ? upon_line_cost : 0;
    if (candidate.place.has_leader) {
      candidate.place.leader = leader_of(request, box);
      candidate.cost += leader_cost;
      for (const Segment& line : lines_) candidate.cost += cross(candidate.place.leader, line) ? upon_line_cost : 0;
    }
    for (const Box& obstacle : obstacles_) {
      if (overlap(obstacle, box_around(request.marker, 1, 1))) continue;  // its own
      if (candidate.place.has_leader) {
        candidate.cost += meets(candidate.place.leader, obstacle) ? through_marker_cost : 0;
      } else if (distance(box, obstacle.centre()) < distance(box, request.marker)) {
        candidate.cost += ambiguous_cost;
      }
    }
    candidates.push_back(candidate);
  }

  static double cost_of_pair(const LabelPlace& a, const LabelPlace& b) {
    if (!a.placed || !b.placed) return 0;
    double cost = overlap(a.box, b.box) ? forbidden : 0;
    if (a.has_leader && meets(a.leader, b.box)) cost += through_label_cost;
    if (b.has_leader && meets(b.leader, a.box)) cost += through_label_cost;
    if (a.has_leader && b.has_leader && cross(a.leader, b.leader)) cost += crossing_cost;
    return cost;
  }

  /// All labels left out: so they take their places one after the other.
  std::vector<std::size_t> initial() const {
    std::vector<std::size_t> chosen;
    for (const auto& candidates : candidates_) chosen.push_back(candidates.size() - 1);
    return chosen;
  }

  /// As they are, then in random orders.
  std::vector<std::size_t> order(int start, std::mt19937_64& random) const {
    std::vector<std::size_t> order(candidates_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = order.size() - 1; start > 0 && i > 0; --i) {
      std::swap(order[i], order[static_cast<std::size_t>(random() % (i + 1))]);
    }
    return order;
  }

  double cost_of(std::size_t label, std::size_t choice, const std::vector<std::size_t>& chosen) const {
    const Candidate& candidate = candidates_[label][choice];
    double cost = candidate.cost;
    for (std::size_t other = 0; other < chosen.size(); ++other) {
      if (other != label) cost += cost_of_pair(candidate.place, candidates_[other][chosen[other]].place);
    }
    return cost;
  }

  /// Each label in turn takes its cheapest place, until none moves. The sum of all costs never rises.
  double improve(const std::vector<std::size_t>& order, std::vector<std::size_t>& chosen) const {
    bool moved = true;
    for (int pass = 0; pass < passes && moved; ++pass) {
      moved = false;
      for (const std::size_t label : order) {
        double least = cost_of(label, chosen[label], chosen);
        for (std::size_t choice = 0; choice < candidates_[label].size(); ++choice) {
          if (candidates_[label][choice].cost >= least) continue;
          const double cost = cost_of(label, choice, chosen);
          if (cost < least) {
            least = cost;
            chosen[label] = choice;
            moved = true;
          }
        }
      }
    }
    double sum = 0;
    for (std::size_t a = 0; a < chosen.size(); ++a) {
      sum += candidates_[a][chosen[a]].cost;
      for (std::size_t b = 0; b < a; ++b) {
        sum += cost_of_pair(candidates_[a][chosen[a]].place, candidates_[b][chosen[b]].place);
      }
    }
    return sum;
  }

  /// Labels that still collide with one before them are left out: the promise is that nothing overlaps.
  std::vector<LabelPlace> without_conflicts(const std::vector<std::size_t>& chosen) const {
    std::vector<LabelPlace> places;
    for (std::size_t label = 0; label < chosen.size(); ++label) {
      LabelPlace place = candidates_[label][chosen[label]].place;
      for (const LabelPlace& before : places) {
        if (cost_of_pair(place, before) >= forbidden) place = {};
      }
      places.push_back(place);
    }
    return places;
  }

  std::span<const LabelRequest> requests_;
  Box frame_;
  std::span<const Box> obstacles_;
  std::span<const Segment> lines_;
  std::vector<std::vector<Candidate>> candidates_;
};

}  // namespace

std::vector<LabelPlace> place_labels(std::span<const LabelRequest> requests, const Box& frame,
                                     std::span<const Box> obstacles, std::span<const Segment> lines) {
  if (requests.empty()) return {};
  return Placer(requests, frame, obstacles, lines).run();
}

}  // namespace tightrope::charts
