// Rows of a few houses for tests: coordinates in metres beside a false origin.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/footprints/repair/repair_terrace_row.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::repair::test {

/// Somewhere in a UTM zone, so that rounding is that of real coordinates.
inline constexpr model::Point2 kOrigin{390000, 5820000};

using Points = std::vector<model::Point2>;

inline model::Point2 at(double x, double y) { return model::snap(model::Point2{kOrigin.x + x, kOrigin.y + y}); }

inline model::Ring ring(const Points& points, bool outer = true) {
  model::Ring r;
  for (const model::Point2 p : points) r.points.push_back(at(p.x, p.y));
  r.nodes.assign(points.size(), 0);
  geometry::orient(r, outer);
  return r;
}

inline model::Polygon polygon(const Points& outer, const std::vector<Points>& holes = {}) {
  model::Polygon p;
  p.outer = ring(outer);
  for (const Points& hole : holes) p.holes.push_back(ring(hole, false));
  return p;
}

/// Buildings w1, w2, ... with these polygons.
inline TerraceRow row_of_polygons(const std::vector<model::Polygon>& polygons) {
  TerraceRow row;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    TerraceBuilding b;
    b.id = {model::OsmType::way, static_cast<std::int64_t>(i + 1)};
    b.polygons = {polygons[i]};
    row.buildings.push_back(std::move(b));
  }
  return row;
}

inline Points box(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

inline RepairOptions without_squaring() {
  RepairOptions options;
  options.square = false;
  return options;
}

inline double length(model::Point2 a, model::Point2 b) {
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
}

inline std::vector<model::Ring> rings(const TerraceBuilding& b) {
  std::vector<model::Ring> out;
  for (const model::Polygon& p : b.polygons) {
    out.push_back(p.outer);
    out.insert(out.end(), p.holes.begin(), p.holes.end());
  }
  return out;
}

/// m of edges that both have, run through in opposite directions.
inline double shared_length(const TerraceBuilding& a, const TerraceBuilding& b) {
  double sum = 0;
  for (const model::Ring& r : rings(a))
    for (const model::Ring& s : rings(b))
      for (std::size_t i = 0; i < r.size(); ++i)
        for (std::size_t k = 0; k < s.size(); ++k)
          if (r.points[i] == s.points[(k + 1) % s.size()] && r.points[(i + 1) % r.size()] == s.points[k])
            sum += length(r.points[i], s.points[k]);
  return sum;
}

inline bool has_point(const TerraceBuilding& b, model::Point2 p) {
  for (const model::Ring& r : rings(b))
    if (std::find(r.points.begin(), r.points.end(), p) != r.points.end()) return true;
  return false;
}

inline double area(const TerraceBuilding& b) {
  double sum = 0;
  for (const model::Polygon& p : b.polygons) sum += geometry::area(p);
  return sum;
}

inline double common_area(const TerraceBuilding& a, const TerraceBuilding& b) {
  return geometry::common_area(a.polygons, b.polygons);
}

inline bool all_valid(const TerraceRow& row) {
  for (const TerraceBuilding& b : row.buildings) {
    if (b.polygons.empty()) return false;
    for (const model::Polygon& p : b.polygons)
      if (!geometry::strictly_simple(p)) return false;
  }
  return true;
}

inline bool same_points(const TerraceBuilding& a, const TerraceBuilding& b) {
  const auto r = rings(a), s = rings(b);
  if (r.size() != s.size()) return false;
  for (std::size_t i = 0; i < r.size(); ++i)
    if (r[i].points != s[i].points) return false;
  return true;
}

inline std::vector<model::IssueCode> codes_of(const model::Report& report, std::int64_t way) {
  std::vector<model::IssueCode> out;
  for (const model::ReportRow& r : report.rows)
    if (r.object.number == way) out.push_back(r.code);
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace blockrand::repair::test
