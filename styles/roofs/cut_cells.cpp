#include "styles/roofs/cut_cells.h"

#include <algorithm>

#include "pipeline/geometry/planar_faces.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::roofs {

using model::Point2;
using model::Polygon;

namespace {

geometry::DividingLine closed(std::vector<Point2> points, std::uint64_t id) {
  for (Point2& p : points) p = model::snap(p);
  points.push_back(points.front());
  return {id, std::move(points), {}};
}

struct Box {
  Point2 low{1e18, 1e18}, high{-1e18, -1e18};
  void add(Point2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  bool meets(const Box& o) const {
    return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y;
  }
};

Polygon plan_of(const Roof::Surface& surface) {
  Polygon out;
  for (std::size_t l = 0; l < surface.loops.size(); ++l) {
    model::Ring ring;
    for (const auto& p : surface.loops[l]) ring.points.push_back(p.xy());
    ring.nodes.assign(ring.points.size(), 0);
    if (l == 0)
      out.outer = std::move(ring);
    else
      out.holes.push_back(std::move(ring));
  }
  return out;
}

}  // namespace

std::vector<RoofPiece> pieces_under(const Roof& roof, std::span<const std::vector<Point2>> regions) {
  Box all;
  for (const auto& region : regions)
    for (const Point2 p : region) all.add(p);
  std::vector<std::pair<std::int32_t, Polygon>> surfaces;
  std::vector<geometry::DividingLine> lines;
  for (std::size_t s = 0; s < roof.surfaces.size(); ++s) {
    if (roof.surfaces[s].upright) continue;
    Box box;
    for (const auto& p : roof.surfaces[s].loops[0]) box.add(p.xy());
    if (!box.meets(all)) continue;
    surfaces.push_back({static_cast<std::int32_t>(s), plan_of(roof.surfaces[s])});
    lines.push_back(closed(surfaces.back().second.outer.points, 0));
    for (const auto& hole : surfaces.back().second.holes) lines.push_back(closed(hole.points, 0));
  }
  for (const auto& region : regions) lines.push_back(closed(region, 1));
  std::vector<RoofPiece> out;
  for (geometry::Face& face : geometry::faces_of_lines(lines)) {
    const Point2 inside = geometry::inner_point(face.polygon);
    std::uint32_t region = 0;
    while (region < regions.size() && !geometry::contains(regions[region], inside)) ++region;
    if (region == regions.size()) continue;
    for (const auto& [surface, plan] : surfaces)
      if (geometry::contains(plan, inside)) {
        out.push_back({std::move(face.polygon), surface, region});
        break;
      }
  }
  return out;
}

std::vector<RoofPiece> pieces_of(std::span<const Polygon> polygons, std::span<const std::vector<Point2>> cuts) {
  std::vector<geometry::DividingLine> lines;
  for (const Polygon& p : polygons) {
    lines.push_back(closed(p.outer.points, 0));
    for (const auto& hole : p.holes) lines.push_back(closed(hole.points, 0));
  }
  for (const auto& cut : cuts) {
    lines.push_back({1, cut, {}});
    for (Point2& p : lines.back().points) p = model::snap(p);
  }
  std::vector<RoofPiece> out;
  for (geometry::Face& face : geometry::faces_of_lines(lines)) {
    const Point2 inside = geometry::inner_point(face.polygon);
    for (std::size_t p = 0; p < polygons.size(); ++p)
      if (geometry::contains(polygons[p], inside)) {
        out.push_back({std::move(face.polygon), static_cast<std::int32_t>(p), 0});
        break;
      }
  }
  return out;
}

}  // namespace blockrand::roofs
