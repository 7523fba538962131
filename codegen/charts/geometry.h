#pragma once
/// Places on the page, in pixels from its upper left corner.

#include <algorithm>

namespace tightrope::charts {

struct Place {
  double x = 0;
  double y = 0;
};

struct Box {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;

  double width() const { return right - left; }
  double height() const { return bottom - top; }
  Place centre() const { return {(left + right) / 2, (top + bottom) / 2}; }
  bool contains(const Box& other) const {
    return other.left >= left && other.right <= right && other.top >= top && other.bottom <= bottom;
  }
};

inline Box box_around(Place centre, double width, double height) {
  return {centre.x - width / 2, centre.y - height / 2, centre.x + width / 2, centre.y + height / 2};
}

/// Whether they have inner points in common.
inline bool overlap(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

struct Segment {
  Place from;
  Place to;
};

/// Whether the segment has points inside of the box (Liang and Barsky's clipping, 1984).
inline bool meets(const Segment& s, const Box& box) {
  double first = 0;
  double last = 1;
  const auto clip = [&](double step, double room) {  // step * t <= room
    if (step == 0) return room > 0;
    const double t = room / step;
    if (step > 0) last = std::min(last, t);
    if (step < 0) first = std::max(first, t);
    return first < last;
  };
  const double dx = s.to.x - s.from.x;
  const double dy = s.to.y - s.from.y;
  return clip(-dx, s.from.x - box.left) && clip(dx, box.right - s.from.x) && clip(-dy, s.from.y - box.top) &&
         clip(dy, box.bottom - s.from.y);
}

/// Whether two segments cross, ends not counted.
inline bool cross(const Segment& a, const Segment& b) {
  const auto side = [](const Segment& s, Place p) {
    return (s.to.x - s.from.x) * (p.y - s.from.y) - (s.to.y - s.from.y) * (p.x - s.from.x);
  };
  return side(a, b.from) * side(a, b.to) < 0 && side(b, a.from) * side(b, a.to) < 0;
}

}  // namespace tightrope::charts
