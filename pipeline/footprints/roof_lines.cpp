#include "pipeline/footprints/roof_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/osm_keys.h"
#include "pipeline/model/vector.h"

namespace blockrand::footprints {

using model::BuildingPart;
using model::FeatureKind;
using model::Point2;
using model::Polygon;
using model::RoofLine;
using model::RoofLineKind;

namespace {

/// The plan's boundary as segments.
template <class Visit>
void for_each_edge(const Polygon& plan, Visit&& visit) {
  const auto ring = [&](const model::Ring& r) {
    for (std::size_t i = 0; i < r.size(); ++i) visit(r, i, r.points[i], r.points[(i + 1) % r.size()]);
  };
  ring(plan.outer);
  for (const model::Ring& hole : plan.holes) ring(hole);
}

struct OnBoundary {
  Point2 point;
  double distance = 0;
};

/// The nearest point of the boundary; a corner where that is within `corner_reach` of it.
OnBoundary nearest_on_boundary(const Polygon& plan, Point2 p, double corner_reach) {
  OnBoundary best{p, 1e300};
  Point2 from, to;
  for_each_edge(plan, [&](const model::Ring&, std::size_t, Point2 a, Point2 b) {
    const double d = geometry::distance_to_segment(p, a, b);
    if (d >= best.distance) return;
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    best = {model::snap(Point2{a.x + t * dx, a.y + t * dy}), d};
    from = a;
    to = b;
  });
  for (const Point2 corner : {from, to})
    if (best.distance < 1e300 && distance(best.point, corner) <= corner_reach) {
      best.point = corner;
      break;
    }
  return best;
}

std::optional<Point2> place_of_node(const Polygon& plan, std::int64_t node) {
  std::optional<Point2> found;
  if (node == 0) return found;
  for_each_edge(plan, [&](const model::Ring& r, std::size_t i, Point2 a, Point2) {
    if (!found && i < r.nodes.size() && r.nodes[i] == node) found = a;
  });
  return found;
}

/// m. Nearer points lie on the boundary.
constexpr double kOnBoundary = 0.02;

}  // namespace

std::optional<RoofLine> fit_roof_line(const RoofLine& line, const Polygon& plan, bool& inside) {
  RoofLine out = line;
  inside = false;
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    Point2& p = out.points[i];
    if (const auto place = place_of_node(plan, out.nodes[i])) {
      p = *place;
      continue;
    }
    const OnBoundary nearest = nearest_on_boundary(plan, p, kRoofLineReach / 2);
    const bool within = geometry::contains(plan, p);
    if (!within && nearest.distance > kRoofLineReach) return std::nullopt;
    const bool end = out.points.size() > 1 && (i == 0 || i + 1 == out.points.size());
    if (nearest.distance <= (!within || end ? kRoofLineReach : kOnBoundary)) p = nearest.point;
  }
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    const Point2 next = out.points[std::min(i + 1, out.points.size() - 1)];
    for (const Point2 p : {out.points[i], Point2{(out.points[i].x + next.x) / 2, (out.points[i].y + next.y) / 2}})
      inside = inside || (geometry::contains(plan, p) && nearest_on_boundary(plan, p, 0).distance > kOnBoundary);
  }
  return out;
}

void fit_roof_lines(model::Building& building, const std::vector<RoofLine>& near) {
  std::vector<std::vector<RoofLine>> along(building.parts.size());  // boundaries
  std::vector<bool> ridged(building.parts.size(), false);
  for (const RoofLine& line : near) {
    std::size_t owner = building.parts.size();
    std::optional<RoofLine> fitted;
    for (std::size_t i = 0; i < building.parts.size(); ++i) {
      const Polygon& plan = building.parts[i].plan;
      if (plan.outer.size() < 3) continue;
      bool inside = false;
      auto here = fit_roof_line(line, plan, inside);
      if (!here) continue;
      if (!inside) {
        along[i].push_back(std::move(*here));
      } else if (owner == building.parts.size() || geometry::area(plan) < geometry::area(building.parts[owner].plan)) {
        owner = i;
        fitted = std::move(here);
      }
    }
    if (!fitted && line.kind == RoofLineKind::ridge) {
      // A ridge that begins well inside a part and fits none stays as it is: no roof comes of it, which is told.
      for (std::size_t i = 0; i < building.parts.size(); ++i) {
        const Polygon& plan = building.parts[i].plan;
        const bool begins_here =
            plan.outer.size() >= 3 && std::any_of(line.points.begin(), line.points.end(), [&](Point2 p) {
              return geometry::contains(plan, p) && nearest_on_boundary(plan, p, 0).distance > kRoofLineReach;
            });
        if (!begins_here || (fitted && geometry::area(plan) >= geometry::area(building.parts[owner].plan))) continue;
        owner = i;
        fitted = line;
      }
    }
    if (!fitted) continue;
    ridged[owner] = ridged[owner] || fitted->kind == RoofLineKind::ridge;
    building.parts[owner].roof_lines.push_back(std::move(*fitted));
  }
  for (std::size_t i = 0; i < building.parts.size(); ++i) {
    BuildingPart& part = building.parts[i];
    if (!ridged[i]) {
      part.roof_lines.clear();
      continue;
    }
    std::move(along[i].begin(), along[i].end(), std::back_inserter(part.roof_lines));
    std::stable_sort(part.roof_lines.begin(), part.roof_lines.end(),
                     [](const RoofLine& a, const RoofLine& b) { return a.id < b.id; });
  }
}

RoofLineFinder::RoofLineFinder(const model::Extract& extract, const georef::Projection& projection) {
  for (const model::Feature& feature : extract.features) {
    if (feature.area) continue;
    const bool way = feature.is(FeatureKind::roof_line) && feature.id.type == model::OsmType::way;
    const bool node = feature.is(FeatureKind::roof_apex) && feature.id.type == model::OsmType::node;
    if (!way && !node) continue;
    RoofLine line;
    line.id = feature.id;
    const std::string_view ridge = extract.tag(feature.tags, model::osm_key::kRoofRidge);
    line.kind = node ? RoofLineKind::apex : !ridge.empty() && ridge != "no" ? RoofLineKind::ridge : RoofLineKind::edge;
    for (const model::MappedRing& ring : extract.rings_of(feature.rings)) {
      line.points.clear();
      for (const model::Location v : extract.vertices_of(ring))
        line.points.push_back(model::snap(projection.forward(v)));
      const auto nodes = extract.nodes_of(ring);
      line.nodes.assign(nodes.begin(), nodes.end());
      if (line.points.size() >= (node ? 1u : 2u)) lines_.push_back(line);
    }
  }
  std::vector<PlanBox> boxes;
  for (const RoofLine& line : lines_) boxes.push_back(box_of(line.points));
  boxes_ = BoxIndex(std::move(boxes));
}

void RoofLineFinder::fit(model::Region& region) const {
  if (lines_.empty()) return;
  for (model::Building& building : region.buildings) {
    PlanBox box;
    for (const BuildingPart& part : building.parts) box.include(box_of(part.plan.outer.points));
    if (box.empty()) continue;
    std::vector<RoofLine> near;
    for (const std::uint32_t i : boxes_.near(box, kRoofLineReach)) near.push_back(lines_[i]);
    if (!near.empty()) fit_roof_lines(building, near);
  }
}

std::vector<RoofLine> RoofLineFinder::near(const PlanBox& box) const {
  std::vector<RoofLine> out;
  for (const std::uint32_t i : boxes_.near(box, kRoofLineReach)) out.push_back(lines_[i]);
  return out;
}

}  // namespace blockrand::footprints
