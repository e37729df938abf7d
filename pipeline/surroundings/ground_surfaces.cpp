#include "pipeline/surroundings/ground_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace blockrand::surroundings {
namespace {

using model::FlatPolygon;
using model::Point2;
using model::Point3;

/// A face of the partition as it lies.
class Lifted {
 public:
  Lifted(const SquareGround& ground, const GroundLabel& label) : ground_(ground), label_(label) {}

  std::vector<Point3> ring(const model::Ring& ring) const {
    std::vector<Point3> out;
    for (const Point2 p : ring.points) out.push_back(point(p, label_));
    return out;
  }

  /// The step along an edge, which has its face on the left, down to or up from what lies beyond.
  /// \return nothing where there is none, or it belongs to the neighbour
  void add_step(Point2 a, Point2 b, const GroundLabel& beyond, std::vector<FlatPolygon>& out) const {
    // Beside a building the terrain has the foot of the wall, and the step up to it is seen from the ground.
    const GroundLabel foot;
    const GroundLabel& other = beyond.building ? foot : beyond;
    Point3 a_own = point(a, label_), b_own = point(b, label_), a_other = point(a, other), b_other = point(b, other);
    if (beyond.building) std::swap(a_own, a_other), std::swap(b_own, b_other);
    double a_up = a_own.z - a_other.z, b_up = b_own.z - b_other.z;
    if (a_up <= 0 && b_up <= 0) return;
    if (a_up < 0 || b_up < 0) {
      // Level ground cuts the terrain along the edge: each side has its own part of the step, up to where they cross.
      const double t = a_up / (a_up - b_up);
      const Point2 p = model::snap(Point2{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
      const Point3 cut{p.x, p.y, model::snap(a_own.z + t * (b_own.z - a_own.z))};
      (a_up < 0 ? a_own : b_own) = cut;
      (a_up < 0 ? a_other : b_other) = cut;
      (a_up < 0 ? a_up : b_up) = 0;
    }
    FlatPolygon face{{a_other, b_other, b_own, a_own}, {}};
    // A triangle where both heights are one at an end.
    if (b_up == 0) face.outer.erase(face.outer.begin() + 2);
    if (a_up == 0) face.outer.pop_back();
    if (beyond.building) std::ranges::reverse(face.outer);
    out.push_back(std::move(face));
  }

 private:
  Point3 point(Point2 p, const GroundLabel& label) const {
    return {p.x, p.y, model::snap(label.level.value_or(ground_.at(p)) + static_cast<double>(label.offset))};
  }
  const SquareGround& ground_;
  const GroundLabel& label_;
};

}  // namespace

std::vector<SquareSurface> ground_surfaces(SquareIndex square, const SquareGround& ground, const GroundClaims& claims,
                                           const GroundLabel& land) {
  const std::vector<geometry::DividingLine> lines = ground.lines();
  const std::vector<geometry::PartitionPiece> pieces = geometry::partition_of(box_of(square), claims.claims, lines);
  const auto last = static_cast<std::uint32_t>(claims.labels.size());
  const auto label_of = [&](std::uint32_t label) -> const GroundLabel& {
    return label == geometry::kNoLabel ? land : claims.labels[label];
  };
  std::map<std::uint32_t, SquareSurface> surfaces;
  for (const geometry::PartitionPiece& piece : pieces) {
    const GroundLabel& label = label_of(piece.label);
    if (label.building) continue;
    SquareSurface& to = surfaces[piece.label == geometry::kNoLabel ? last : piece.label];
    model::GroundSurface& surface = to.surface;
    surface.ground = label.ground, surface.object = label.object;
    surface.material = label.material, surface.offset = label.offset;
    const Lifted lifted(ground, label);
    FlatPolygon face;
    face.outer = lifted.ring(piece.polygon.outer);
    for (const model::Ring& hole : piece.polygon.holes) face.holes.push_back(lifted.ring(hole));
    surface.faces.push_back(std::move(face));
    std::size_t e = 0;
    const auto steps = [&](const model::Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i, ++e) {
        const Point2 a = ring.points[i], b = ring.points[(i + 1) % ring.size()];
        lifted.add_step(a, b, label_of(piece.beyond[e]), surface.edges);
        if (piece.beyond[e] != piece.label) to.borders.push_back({a, b});
      }
    };
    steps(piece.polygon.outer);
    for (const model::Ring& hole : piece.polygon.holes) steps(hole);
    to.plan.push_back(piece.polygon);
  }
  std::vector<SquareSurface> out;
  for (auto& [label, surface] : surfaces) {
    surface.label = label;
    out.push_back(std::move(surface));
  }
  return out;
}

bool holds(const model::Polygon& polygon, Point2 place) {
  bool inside = false;
  const auto follow = [&](const model::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      Point2 a = ring.points[i], b = ring.points[(i + 1) % ring.size()];
      if ((a.y > place.y) == (b.y > place.y)) continue;
      if (place.x < a.x + (place.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
  };
  follow(polygon.outer);
  for (const model::Ring& hole : polygon.holes) follow(hole);
  return inside;
}

double distance_to(std::span<const std::array<Point2, 2>> edges, Point2 place) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : edges) {
    const double dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
    const double t = length > 0 ? std::clamp(((place.x - a.x) * dx + (place.y - a.y) * dy) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, std::hypot(place.x - a.x - t * dx, place.y - a.y - t * dy));
  }
  return least;
}

}  // namespace blockrand::surroundings
