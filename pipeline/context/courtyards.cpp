#include "pipeline/context/courtyards.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/planar_faces.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/segment_grid.h"
#include "pipeline/model/vector.h"

namespace blockrand::context {

namespace {

using geometry::DividingLine;
using geometry::Face;
using geometry::Segment;
using model::Point2;

/// Ids of gates begin here, above all building indices: where a gate lies on a wall, the wall has the lower id.
constexpr std::uint64_t kFirstGate = std::uint64_t{1} << 40;
/// m. Cells of the index of walls: about the length of a wall.
constexpr double kWallCell = 16;
constexpr double kStreetCell = 64;  ///< m. Cells of the index of streets
/// m. Nearer walls touch: there is no gap to close.
constexpr double kTouching = 0.01;

struct Wall {
  std::uint32_t building = 0;
  std::uint32_t previous = 0, next = 0;  ///< indices of the walls before and after it in its ring
};

double square(double x) { return x * x; }

/// m², without the rounding of nearest_on.
double square_distance(const Segment& s, Point2 p) {
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y, px = p.x - s.a.x, py = p.y - s.a.y;
  const double along = px * dx + py * dy, length2 = dx * dx + dy * dy;
  if (along <= 0) return px * px + py * py;
  if (along >= length2) return square(p.x - s.b.x) + square(p.y - s.b.y);
  return square(px * dy - py * dx) / length2;
}

Point2 nearest_on(const Segment& s, Point2 p) {
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y, length2 = dx * dx + dy * dy;
  const double t = length2 > 0 ? std::clamp(((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / length2, 0.0, 1.0) : 0;
  return model::snap(Point2{s.a.x + t * dx, s.a.y + t * dy});
}

/// Walls of all buildings, the inside on their left.
class Walls {
 public:
  Walls(std::span<const Footprint> buildings, std::span<const Polyline> streets) {
    for (std::uint32_t b = 0; b < buildings.size(); ++b) {
      add(buildings[b].polygon.outer, b, true);
      for (const model::Ring& hole : buildings[b].polygon.holes) add(hole, b, false);
    }
    grid_.emplace(segments_, kWallCell);
    for (const Polyline& street : streets)
      for (std::size_t i = 1; i < street.size(); ++i) streets_.push_back({street[i - 1], street[i]});
    street_grid_.emplace(streets_, kStreetCell);
  }

  /// The shortest lines over gaps of at most `reach`.
  std::vector<Segment> gates(double reach) const {
    std::vector<Segment> out;
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = 0; i < segments_.size(); ++i) {
      const Point2 corner = segments_[i].a;
      // Gaps are narrowest at convex corners, or between parallel walls, which end in such.
      if (geometry::orientation(grid2(segments_[walls_[i].previous].a), grid2(corner), grid2(segments_[i].b)) <= 0)
        continue;
      grid_->near({corner.x - reach, corner.y - reach}, {corner.x + reach, corner.y + reach}, near);
      std::vector<Place> same, others;
      for (const std::uint32_t w : near) {
        if (w == i || w == walls_[i].previous || square_distance(segments_[w], corner) > square(reach + kTouching))
          continue;
        const Point2 place = nearest_on(segments_[w], corner);
        const double gap = distance(corner, place);
        if (gap <= reach) (walls_[w].building == walls_[i].building ? same : others).push_back({gap, place});
      }
      add_gate(i, near, std::move(others), false, out);
      add_gate(i, near, std::move(same), true, out);
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  std::vector<DividingLine> lines() const {
    std::vector<DividingLine> out;
    for (std::uint32_t i = 0; i < segments_.size(); ++i)
      out.push_back({walls_[i].building, {segments_[i].a, segments_[i].b}, {}});
    return out;
  }

 private:
  static geometry::Grid2 grid2(Point2 p) { return geometry::to_grid(p); }

  void add(const model::Ring& ring, std::uint32_t building, bool counter_clockwise) {
    std::vector<Point2> points;
    for (const Point2 p : ring.points)
      if (const Point2 q = model::snap(p); points.empty() || points.back() != q) points.push_back(q);
    while (points.size() > 1 && points.back() == points.front()) points.pop_back();
    if (points.size() < 3) return;
    if ((geometry::signed_area(points) > 0) != counter_clockwise) std::reverse(points.begin(), points.end());
    const auto first = static_cast<std::uint32_t>(segments_.size()), n = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      segments_.push_back({points[i], points[(i + 1) % n]});
      walls_.push_back({building, first + (i + n - 1) % n, first + (i + 1) % n});
    }
  }

  /// Where a gate from a corner may end.
  struct Place {
    double gap = 0;  ///< m
    Point2 at;
    auto operator<=>(const Place&) const = default;
  };

  /// From the corner where wall `i` begins to the nearest of some places on walls, of the same building or of others.
  void add_gate(std::uint32_t i, const std::vector<std::uint32_t>& near, std::vector<Place> places, bool same,
                std::vector<Segment>& out) const {
    const Point2 corner = segments_[i].a;
    std::sort(places.begin(), places.end());
    for (const auto& [gap, place] : places) {
      if (gap < kTouching) {
        if (!same) return;  // stands wall to wall there
        continue;
      }
      if (is_open(i, place, near)) {
        out.push_back({corner, place});
        return;
      }
    }
  }

  static bool cross(geometry::Grid2 a, geometry::Grid2 b, geometry::Grid2 c, geometry::Grid2 d) {
    return geometry::orientation(a, b, c) * geometry::orientation(a, b, d) < 0 &&
           geometry::orientation(c, d, a) * geometry::orientation(c, d, b) < 0;
  }

  /// Whether the line from the corner where wall `i` begins runs outside all buildings and over no street.
  bool is_open(std::uint32_t i, Point2 to, const std::vector<std::uint32_t>& near) const {
    const geometry::Grid2 before = grid2(segments_[walls_[i].previous].a), a = grid2(segments_[i].a),
                          after = grid2(segments_[i].b), b = grid2(to);
    // The corner is convex: what is left of both its walls begins inside.
    if (geometry::orientation(before, a, b) > 0 && geometry::orientation(a, after, b) > 0) return false;
    const Point2 low{std::min(segments_[i].a.x, to.x), std::min(segments_[i].a.y, to.y)},
        high{std::max(segments_[i].a.x, to.x), std::max(segments_[i].a.y, to.y)};
    for (const std::uint32_t w : near) {
      const Segment& wall = segments_[w];
      if (std::max(wall.a.x, wall.b.x) < low.x || std::min(wall.a.x, wall.b.x) > high.x ||
          std::max(wall.a.y, wall.b.y) < low.y || std::min(wall.a.y, wall.b.y) > high.y)
        continue;
      // The end on a wall may stick into it by half a grid step; only what crosses well within is blocked.
      if (cross(a, b, grid2(segments_[w].a), grid2(segments_[w].b)) &&
          geometry::distance_to_segment(to, segments_[w].a, segments_[w].b) > kTouching)
        return false;
    }
    const Point2 from = segments_[i].a;
    std::vector<std::uint32_t> streets;
    street_grid_->near({std::min(from.x, to.x), std::min(from.y, to.y)},
                       {std::max(from.x, to.x), std::max(from.y, to.y)}, streets);
    return std::none_of(streets.begin(), streets.end(),
                        [&](std::uint32_t s) { return cross(a, b, grid2(streets_[s].a), grid2(streets_[s].b)); });
  }

  std::vector<Segment> segments_;
  std::vector<Wall> walls_;
  std::optional<geometry::SegmentGrid> grid_;
  std::vector<Segment> streets_;
  std::optional<geometry::SegmentGrid> street_grid_;
};

/// Inside a building: its walls run with the inside on their left.
bool is_built(const Face& face) {
  return std::any_of(face.lines.begin(), face.lines.end(),
                     [](const geometry::BorderLine& l) { return l.id < kFirstGate && l.left > 0; });
}

template <class Visit>
void for_each_edge(const Face& face, Visit&& visit) {
  std::size_t k = 0;
  const auto follow = [&](const model::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i, ++k)
      visit(ring.points[i], ring.points[(i + 1) % ring.size()], face.edges[k]);
  };
  follow(face.polygon.outer);
  for (const model::Ring& hole : face.polygon.holes) follow(hole);
}

/// The pieces of gates that lead out of everything enclosed; `inner` tells whether there are others.
std::vector<Segment> outer_gates(const std::vector<Face>& faces, bool& inner) {
  std::map<Segment, int> sides;
  for (const Face& face : faces)
    for_each_edge(face, [&](Point2 p, Point2 q, const geometry::FaceEdge& edge) {
      if (edge.line != geometry::kNoLine && edge.line >= kFirstGate) ++sides[{std::min(p, q), std::max(p, q)}];
    });
  std::vector<Segment> out;
  inner = false;
  for (const auto& [piece, count] : sides) {
    if (count == 1)
      out.push_back(piece);
    else
      inner = true;
  }
  return out;
}

std::string id_of(const Courtyard& yard, std::span<const Footprint> buildings) {
  model::OsmId least = buildings[yard.buildings.front()].id;
  for (const std::uint32_t b : yard.buildings) least = std::min(least, buildings[b].id);
  const std::vector<Point2>& ring = yard.polygon.outer.points;
  const auto first = std::min_element(ring.begin(), ring.end());
  const geometry::Grid2 a = geometry::to_grid(*first),
                        b = geometry::to_grid(first + 1 != ring.end() ? *(first + 1) : ring.front());
  return least.text() + ".y" + std::to_string(a.x + b.x) + "_" + std::to_string(a.y + b.y);
}

bool counts(const Courtyard& yard, const CourtyardOptions& options) {
  const double around = geometry::perimeter(yard.polygon), width = 2 * yard.area / around;
  if (yard.closed) return yard.area >= options.min_closed_area && width >= options.min_closed_width;
  return yard.area >= options.min_open_area && width >= options.min_open_width &&
         yard.opening <= (1 - options.min_enclosure) * around;
}

}  // namespace

std::vector<Courtyard> find_courtyards(std::span<const Footprint> buildings, std::span<const Polyline> streets,
                                       const CourtyardOptions& options) {
  std::vector<Courtyard> out;
  if (buildings.empty()) return out;
  const Walls walls(buildings, streets);
  const std::vector<DividingLine> wall_lines = walls.lines();
  const auto faces_with = [&](const std::vector<Segment>& gates) {
    std::vector<DividingLine> lines = wall_lines;
    for (std::size_t g = 0; g < gates.size(); ++g) lines.push_back({kFirstGate + g, {gates[g].a, gates[g].b}, {}});
    return geometry::faces_of_lines(lines);
  };
  std::vector<Face> faces = faces_with(walls.gates(options.max_opening));
  bool inner = false;
  if (const std::vector<Segment> outer = outer_gates(faces, inner); inner) faces = faces_with(outer);

  for (Face& face : faces) {
    if (is_built(face)) continue;
    Courtyard yard;
    yard.area = geometry::area(face.polygon);
    for_each_edge(face, [&](Point2 p, Point2 q, const geometry::FaceEdge& edge) {
      if (edge.line != geometry::kNoLine && edge.line >= kFirstGate) yard.opening += distance(p, q);
    });
    yard.closed = yard.opening == 0;
    yard.polygon = std::move(face.polygon);
    if (!counts(yard, options)) continue;
    for (const geometry::BorderLine& line : face.lines)
      if (line.id < kFirstGate) yard.buildings.push_back(static_cast<std::uint32_t>(line.id));
    yard.id = id_of(yard, buildings);
    out.push_back(std::move(yard));
  }
  return out;
}

}  // namespace blockrand::context
