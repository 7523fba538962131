#include "scenes/cloth_fold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "scenes/broad_phase.h"
#include "scenes/families.h"

namespace tightrope::ccd {
namespace {

using Index = std::uint32_t;

constexpr Index side = 33;                  ///< vertices along a side of a sheet of size 1 x 1
constexpr std::size_t frames = 2000;        ///< time steps of one take
constexpr std::size_t least_per_step = 64;  ///< queries: fewer make the scene skip frames

/// sin(2 pi x) to about 1e-7, by + - * / alone: the same on every machine.
double sine_of_turns(double x) {
  double r = x - std::floor(x);  // [0, 1)
  double sign = 1;
  if (r >= 0.5) {
    r -= 0.5;
    sign = -1;
  }
  if (r > 0.25) r = 0.5 - r;
  const double a = 6.283185307179586 * r;  // [0, pi/2]
  const double s = a * a;
  const double series = 1 - s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110))));
  return sign * a * series;
}
double cosine_of_turns(double x) { return sine_of_turns(x + 0.25); }

struct Wave {
  double along_u;
  double along_v;
  double phase;
  double speed;
  double amplitude;
};

/// A sheet bent about a line by an angle that grows with time, rippled by waves, and drifting.
struct Sheet {
  double fold = 0.5;     ///< where the bend begins, 0 .. 1
  double radius = 0.05;  ///< of the bend
  double turns = 0.5;    ///< angle of the bend at the end of the take, in turns
  std::array<Wave, 4> waves{};
  Point origin;
  Point drift;  ///< over the whole take
  std::array<Point, 3> axes{};

  Point position(double u, double v, double time) const;
};

Point Sheet::position(double u, double v, double time) const {
  constexpr double two_pi = 6.283185307179586;
  const double angle = turns * time;  // in turns
  const double beyond = std::max(0.0, u - fold);
  const double bent = std::min(beyond / (two_pi * radius), angle);
  const double straight = beyond - two_pi * radius * bent;
  const double sine = sine_of_turns(bent);
  const double cosine = cosine_of_turns(bent);
  double height = 0;
  for (const Wave& wave : waves) {
    height += wave.amplitude * sine_of_turns(wave.along_u * u + wave.along_v * v + wave.phase + wave.speed * time);
  }
  const double x = std::min(u, fold) + radius * sine + straight * cosine - height * sine;
  const double z = radius * (1 - cosine) + straight * sine + height * cosine;
  return origin + time * drift + x * axes[0] + v * axes[1] + z * axes[2];
}

/// The triangles and edges of both sheets, vertices numbered sheet by sheet, row by row.
struct Mesh {
  std::vector<std::array<Index, 3>> faces;
  std::vector<std::array<Index, 2>> edges;
};

Mesh two_grids() {
  Mesh mesh;
  for (Index sheet = 0; sheet < 2; ++sheet) {
    for (Index i = 0; i < side; ++i) {
      for (Index j = 0; j < side; ++j) {
        const Index at = sheet * side * side + i * side + j;
        const bool right = j + 1 < side;
        const bool down = i + 1 < side;
        if (right) mesh.edges.push_back({at, at + 1});
        if (down) mesh.edges.push_back({at, at + side});
        if (!right || !down) continue;
        const bool falling = (i + j) % 2 == 0;
        const Index a = falling ? at : at + 1;
        const Index b = falling ? at + side + 1 : at + side;
        mesh.edges.push_back({a, b});
        mesh.faces.push_back({a, b, falling ? at + 1 : at});
        mesh.faces.push_back({a, falling ? at + side : at + side + 1, b});
      }
    }
  }
  return mesh;
}

Sheet random_sheet(Random& random) {
  Sheet sheet;
  sheet.fold = random.between(0.4, 0.6);
  sheet.radius = random.between(0.02, 0.06);
  sheet.turns = random.between(0.5, 0.6);
  for (Wave& wave : sheet.waves) {
    wave.along_u = random.between(-3, 3);
    wave.along_v = random.between(-3, 3);
    wave.phase = random.uniform();
    wave.speed = random.between(-1, 1);
    wave.amplitude = random.between(0.005, 0.015);
  }
  return sheet;
}

/// An orthonormal frame, turned at random.
std::array<Point, 3> random_axes(Random& random) {
  const Query directions = random_query(random);
  const Point first = normalized(directions.start[0] + Point{2, 0, 0});
  const Point third = normalized(cross(first, directions.start[1] + Point{0, 2, 0}));
  return {first, cross(third, first), third};
}

std::array<Sheet, 2> random_sheets(Random& random) {
  std::array<Sheet, 2> sheets = {random_sheet(random), random_sheet(random)};
  const std::array<Point, 3> axes = random_axes(random);
  sheets[0].axes = axes;
  // The second sheet lies above, turned upside down by half a turn about the axis of the first one's bend, its flap
  // coming from the other side, and sinks through the first.
  sheets[1].axes = {-1 * axes[0], axes[1], -1 * axes[2]};
  const double above = random.between(0.12, 0.2);
  const double aside = random.between(0.7, 1.1);
  const double askew = random.between(-0.2, 0.2);
  sheets[1].origin = aside * axes[0] + askew * axes[1] + above * axes[2];
  sheets[1].drift = random.between(-0.25, -0.15) * axes[2];
  return sheets;
}

class ClothFold final : public SceneGenerator {
 public:
  ClothFold(Kind kind, std::size_t queries, std::uint64_t seed, const ClothVariant& variant)
      : kind_(kind),
        variant_(variant),
        steps_(std::clamp<std::size_t>(queries / least_per_step, 1, frames)),
        per_step_((queries + steps_ - 1) / steps_),
        random_(seed),
        mesh_(two_grids()) {}

  void fill(std::span<double> points) override {
    for (auto out = points.begin(); out != points.end(); out += 24) {
      while (chosen_.empty()) next_step();
      write(chosen_.back(), out);
      chosen_.pop_back();
    }
  }

 private:
  using Pair = std::pair<Index, Index>;
  using Out = std::span<double>::iterator;

  void next_step();
  void place(double time, std::vector<Point>& positions) const;
  template <std::size_t N>
  std::vector<Box> swept_boxes(std::span<const std::array<Index, N>> features) const;
  std::vector<Pair> surviving_pairs() const;
  void write(const Pair& pair, Out out) const;

  Kind kind_;
  ClothVariant variant_;
  std::size_t steps_;     ///< frames of a take that are looked at, evenly spread over it
  std::size_t per_step_;  ///< most queries taken from one of them
  Random random_;
  Mesh mesh_;
  std::array<Sheet, 2> sheets_;
  std::size_t step_ = steps_;  ///< the take is over: begin a new one
  std::vector<Point> start_;   ///< positions at the beginning of the time step
  std::vector<Point> end_;     ///< and at its end
  std::vector<Pair> chosen_;   ///< queries of this step, taken from the back
};

void ClothFold::place(double time, std::vector<Point>& positions) const {
  positions.clear();
  const Point place = variant_.distance * Point{1, 1.5, 0.25};
  for (const Sheet& sheet : sheets_) {
    constexpr double time_at_rest = 0.5;
    const double moment = variant_.obstacle && &sheet == &sheets_[1] ? time_at_rest : time;
    for (Index i = 0; i < side; ++i) {
      for (Index j = 0; j < side; ++j) {
        const double u = static_cast<double>(i) / (side - 1);
        const double v = static_cast<double>(j) / (side - 1);
        positions.push_back(place + variant_.size * sheet.position(u, v, moment));
      }
    }
  }
}

template <std::size_t N>
std::vector<Box> ClothFold::swept_boxes(std::span<const std::array<Index, N>> features) const {
  std::vector<Box> boxes;
  for (const auto& feature : features) {
    Box box{start_[feature[0]], start_[feature[0]]};
    for (const Index vertex : feature) {
      for (const Point& point : {start_[vertex], end_[vertex]}) {
        box.low = {std::min(box.low.x, point.x), std::min(box.low.y, point.y), std::min(box.low.z, point.z)};
        box.high = {std::max(box.high.x, point.x), std::max(box.high.y, point.y), std::max(box.high.z, point.z)};
      }
    }
    boxes.push_back(box);
  }
  return boxes;
}

template <std::size_t M, std::size_t N>
bool share_vertex(const std::array<Index, M>& a, const std::array<Index, N>& b) {
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

std::vector<ClothFold::Pair> ClothFold::surviving_pairs() const {
  std::vector<Pair> pairs;
  if (kind_ == Kind::vertex_face) {
    std::vector<std::array<Index, 1>> vertices;
    for (Index i = 0; i < start_.size(); ++i) vertices.push_back({i});
    pairs = overlapping_pairs(swept_boxes<1>(vertices), swept_boxes<3>(mesh_.faces));
    std::erase_if(pairs,
                  [&](const Pair& pair) { return share_vertex(vertices[pair.first], mesh_.faces[pair.second]); });
  } else {
    const std::vector<Box> boxes = swept_boxes<2>(mesh_.edges);
    pairs = overlapping_pairs(boxes, boxes);
    std::erase_if(pairs, [&](const Pair& pair) {
      return pair.first >= pair.second || share_vertex(mesh_.edges[pair.first], mesh_.edges[pair.second]);
    });
  }
  if (variant_.obstacle) {  // the second feature is the obstacle's, the first is not
    const auto sheet_of = [](Index vertex) { return vertex / (side * side); };
    std::erase_if(pairs, [&](const Pair& pair) {
      if (kind_ == Kind::vertex_face) {
        return sheet_of(pair.first) == 1 || sheet_of(mesh_.faces[pair.second][0]) == 0;
      }
      return sheet_of(mesh_.edges[pair.first][0]) == 1 || sheet_of(mesh_.edges[pair.second][0]) == 0;
    });
  }
  return pairs;
}

/// To the next time step that is looked at; a random choice of at most per_step_ of its pairs.
void ClothFold::next_step() {
  if (step_ == steps_) {
    sheets_ = random_sheets(random_);
    if (variant_.obstacle) {  // the first sheet takes over the second one's drift
      sheets_[0].drift = -1 * sheets_[1].drift;
      sheets_[1].drift = {};
    }
    step_ = 0;
  }
  const std::size_t frame = (2 * step_ + 1) * frames / (2 * steps_);
  ++step_;
  place(static_cast<double>(frame) / frames, start_);
  place(static_cast<double>(frame + 1) / frames, end_);
  std::vector<Pair> pairs = surviving_pairs();
  const std::size_t count = std::min(per_step_, pairs.size());
  for (std::size_t i = 0; i < count; ++i) {
    const auto other = random_.integer(static_cast<int>(i), static_cast<int>(pairs.size()) - 1);
    std::swap(pairs[i], pairs[static_cast<std::size_t>(other)]);
  }
  chosen_.assign(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(count));
}

void ClothFold::write(const Pair& pair, Out out) const {
  std::array<Index, 4> vertices{};
  if (kind_ == Kind::vertex_face) {
    const auto& face = mesh_.faces[pair.second];
    vertices = {pair.first, face[0], face[1], face[2]};
  } else {
    const auto& first = mesh_.edges[pair.first];
    const auto& second = mesh_.edges[pair.second];
    vertices = {first[0], first[1], second[0], second[1]};
  }
  for (const auto* positions : {&start_, &end_}) {
    for (const Index vertex : vertices) {
      const Point& point = (*positions)[vertex];
      *out++ = point.x;
      *out++ = point.y;
      *out++ = point.z;
    }
  }
}

}  // namespace

std::unique_ptr<SceneGenerator> generate_cloth_fold(Kind kind, std::size_t queries, std::uint64_t seed,
                                                    const ClothVariant& variant) {
  return std::make_unique<ClothFold>(kind, queries, seed, variant);
}

}  // namespace tightrope::ccd
