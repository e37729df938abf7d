#include "pipeline/attributes/roof_plan_corners.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "pipeline/attributes/roof_edges.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/grid_side.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/model/vector.h"

namespace blockrand::attributes {

namespace {

using model::BuildingPart;
using model::Point2;
using model::Polygon;
using model::Ring;

/// A corner that moves may come to lie inside a third part; each move makes its own part smaller, so this ends soon.
constexpr int kRounds = 6;
constexpr double kLeastLength = 2 / model::kGridStepsPerMetre;  // m; a body with shorter edges is not valid

template <class Plan, class Visit>
void for_each_ring(Plan& plan, Visit&& visit) {
  visit(plan.outer);
  for (auto& hole : plan.holes) visit(hole);
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

/// Corners of one plan inside another's walls, and where they go. \return whether there are any
bool find_moves(const Polygon& plan, const Polygon& other, double reach, std::map<Point2, Point2>& moves) {
  bool any = false;
  for_each_ring(plan, [&](const Ring& corners) {
    for (const Point2 corner : corners.points)
      for_each_ring(other, [&](const Ring& walls) {
        for (std::size_t i = 0; i < walls.size(); ++i) {
          const Point2 a = walls.points[i], b = walls.points[(i + 1) % walls.size()];
          if (corner == a || corner == b) continue;
          if (const auto to = outside(corner, a, b, reach)) {
            moves.emplace(corner, *to);
            any = true;
          }
        }
      });
  });
  return any;
}

double shortest_edge(const Polygon& plan) {
  double least = std::numeric_limits<double>::infinity();
  for_each_ring(plan, [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      least = std::min(least, distance(ring.points[i], ring.points[(i + 1) % ring.size()]));
  });
  return least;
}

/// Plans of parts at one height share no ground.
bool one_above_the_other(const BuildingPart& a, const BuildingPart& b) {
  constexpr double kCommon = 0.1;  // m²
  return geometry::common_area(std::span(&a.plan, 1), std::span(&b.plan, 1)) > kCommon;
}

}  // namespace

std::vector<std::size_t> keep_corners_out(std::vector<BuildingPart>& parts, double tolerance) {
  std::vector<std::size_t> with_plan;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].roof_plan.outer.size() >= 3) with_plan.push_back(i);
  if (with_plan.size() < 2) return {};
  // Both walls may have been straightened.
  const double reach = 2 * tolerance + kLeastLength;
  std::vector<geometry::PlanBox> boxes(parts.size());
  for (const std::size_t i : with_plan) boxes[i] = geometry::box_of(parts[i].roof_plan.outer.points);
  std::set<std::pair<std::size_t, std::size_t>> in_the_way;
  for (int round = 0; round < kRounds; ++round) {
    std::map<Point2, Point2> moves;
    in_the_way.clear();
    for (const std::size_t i : with_plan)
      for (const std::size_t k : with_plan) {
        if (i == k || !boxes[i].near(boxes[k], reach)) continue;
        if (find_moves(parts[i].roof_plan, parts[k].roof_plan, reach, moves)) in_the_way.emplace(std::min(i, k), std::max(i, k));
      }
    if (moves.empty()) return {};
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
    if (!moved) break;
  }
  std::set<std::size_t> out;
  for (const auto& [i, k] : in_the_way)
    if (!one_above_the_other(parts[i], parts[k])) out.insert({i, k});
  return {out.begin(), out.end()};
}

void make_roof_plans(std::vector<BuildingPart>& parts, double tolerance) {
  std::vector<double> tolerances(parts.size(), tolerance);
  for (;;) {
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (parts[i].plan.outer.size() >= 3)
        parts[i].roof_plan = tolerances[i] > 0 ? simpler_plan(parts[i].plan, tolerances[i]).value_or(parts[i].plan)
                                               : parts[i].plan;
    bool again = false;
    for (const std::size_t i : keep_corners_out(parts, tolerance)) {
      const double finer = tolerances[i] > kLeastLength ? std::max(tolerances[i] / 4, kLeastLength) : 0;
      if (finer == tolerances[i] || (finer == 0 && shortest_edge(parts[i].plan) < kLeastLength)) continue;
      tolerances[i] = finer;
      again = true;
    }
    if (!again) return;
  }
}

}  // namespace blockrand::attributes
