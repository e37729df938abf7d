#include "pipeline/attributes/roof_plan_corners.h"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/grid_side.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::attributes {

namespace {

using model::BuildingPart;
using model::Point2;
using model::Polygon;
using model::Ring;

/// A corner that moves may come to lie inside a third part; each move makes its own part smaller, so this ends soon.
constexpr int kRounds = 6;

template <class Plan, class Visit>
void for_each_ring(Plan& plan, Visit&& visit) {
  visit(plan.outer);
  for (auto& hole : plan.holes) visit(hole);
}

bool has_corner(const Polygon& plan, Point2 p) {
  bool found = false;
  for_each_ring(plan, [&](const Ring& ring) {
    found = found || std::find(ring.points.begin(), ring.points.end(), p) != ring.points.end();
  });
  return found;
}

/// Where a corner goes that lies on the inner side of the wall from a to b, no farther than `reach` from it; nothing
/// for all others.
std::optional<Point2> outside(Point2 corner, Point2 a, Point2 b, double reach) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double px = corner.x - a.x, py = corner.y - a.y, inside = dx * py - dy * px;
  if (!(inside > 0) || inside * inside > reach * reach * length2) return std::nullopt;
  const double along = (px * dx + py * dy) / length2;
  if (along <= 0 || along >= 1) return std::nullopt;
  return geometry::grid_point_on_left({a.x + along * dx, a.y + along * dy}, b, a);
}

using Moves = std::map<Point2, Point2>;

/// Corners of one plan inside another's walls, and where they go.
Moves find_moves(const Polygon& plan, const Polygon& other, double reach) {
  Moves moves;
  for_each_ring(plan, [&](const Ring& corners) {
    for (const Point2 corner : corners.points) {
      std::optional<Point2> to;
      for_each_ring(other, [&](const Ring& walls) {
        for (std::size_t i = 0; i < walls.size() && !to; ++i)
          to = outside(corner, walls.points[i], walls.points[(i + 1) % walls.size()], reach);
      });
      // A corner of both is not inside, though another wall may be near.
      if (to && !has_corner(other, corner)) moves.emplace(corner, *to);
    }
  });
  return moves;
}

/// Plans of parts that stand at one height share no ground.
bool one_above_the_other(const BuildingPart& a, const BuildingPart& b) {
  constexpr double kCommon = 0.1;  // m²; half of a plan that is smaller, as of a cross on a spire
  const double least = std::min({kCommon, geometry::area(a.plan) / 2, geometry::area(b.plan) / 2});
  return geometry::common_area(std::span(&a.plan, 1), std::span(&b.plan, 1)) > least;
}

}  // namespace

void keep_corners_out(std::vector<BuildingPart>& parts, double tolerance) {
  std::vector<std::size_t> with_plan;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].roof_plan.outer.size() >= 3) with_plan.push_back(i);
  if (with_plan.size() < 2) return;
  // Both walls may have been straightened.
  const double reach = 2 * tolerance + 2 / model::kGridStepsPerMetre;
  std::vector<geometry::PlanBox> boxes(parts.size());
  for (const std::size_t i : with_plan) boxes[i] = geometry::box_of(parts[i].roof_plan.outer.points);
  std::map<std::pair<std::size_t, std::size_t>, bool> stacked;  // of those that have moves
  const auto are_stacked = [&](std::size_t i, std::size_t k) {
    const auto [found, is_new] = stacked.try_emplace(std::minmax(i, k));
    if (is_new) found->second = one_above_the_other(parts[i], parts[k]);
    return found->second;
  };
  for (int round = 0; round < kRounds; ++round) {
    Moves moves;
    for (const std::size_t i : with_plan)
      for (const std::size_t k : with_plan) {
        if (i == k || !boxes[i].near(boxes[k], reach)) continue;
        Moves more = find_moves(parts[i].roof_plan, parts[k].roof_plan, reach);
        if (!more.empty() && !are_stacked(i, k)) moves.merge(std::move(more));
      }
    if (moves.empty()) return;
    bool moved = false;
    for (const std::size_t i : with_plan) {
      Polygon trial = parts[i].roof_plan;
      bool changed = false;
      for_each_ring(trial, [&](Ring& ring) {
        for (Point2& p : ring.points)
          if (const auto to = moves.find(p); to != moves.end()) {
            p = to->second;
            changed = true;
          }
      });
      if (!changed || !geometry::strictly_simple(trial) || !geometry::rings_apart(trial)) continue;
      parts[i].roof_plan = std::move(trial);
      moved = true;
    }
    if (!moved) return;
  }
}

}  // namespace blockrand::attributes
