#include "pipeline/footprints/repair/terrace_records.h"

#include <algorithm>
#include <string>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::repair {

namespace {

using model::Point2;
using model::Polygon;
using model::Ring;

/// m. A corner this near to a wall was mapped on it: OSM's grid (11 mm) and its rounding on both sides.
constexpr double kTouching = 0.02;

struct Edge {
  Point2 least, most;
  std::uint32_t building;
  friend auto operator<=>(const Edge&, const Edge&) = default;
};

Edge edge_of(Point2 a, Point2 b, std::uint32_t building) { return {std::min(a, b), std::max(a, b), building}; }

template <class Visit>
void for_each_ring(const std::vector<Polygon>& polygons, Visit&& visit) {
  for (const Polygon& p : polygons) {
    visit(p.outer);
    for (const Ring& hole : p.holes) visit(hole);
  }
}

bool touches(const std::vector<Polygon>& polygons, Point2 p) {
  bool found = false;
  for_each_ring(polygons, [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size() && !found; ++i)
      found = geometry::distance_to_segment(p, ring.points[i], ring.points[(i + 1) % ring.size()]) <= kTouching;
  });
  return found;
}

}  // namespace

void record_walls(TerraceRow& row, const std::vector<std::vector<Polygon>>& mapped,
                  const std::vector<std::vector<SaidPoint>>& said, model::Report& report) {
  std::vector<Edge> edges;
  for (std::uint32_t b = 0; b < row.buildings.size(); ++b) {
    TerraceBuilding& building = row.buildings[b];
    building.record.vertices = 0;
    building.record.area = 0;
    building.record.shared_walls = building.record.gaps_closed = 0;
    for (const Polygon& p : building.polygons) building.record.area += geometry::area(p);
    for_each_ring(building.polygons, [&](const Ring& ring) {
      building.record.vertices += static_cast<std::uint32_t>(ring.size());
      if (row.buildings.size() > 1)
        for (std::size_t i = 0; i < ring.size(); ++i)
          edges.push_back(edge_of(ring.points[i], ring.points[(i + 1) % ring.size()], b));
    });
  }
  if (row.buildings.size() < 2) return;
  std::sort(edges.begin(), edges.end());

  const auto neighbour_at = [&](Point2 a, Point2 b, std::uint32_t building) {
    for (auto e = std::lower_bound(edges.begin(), edges.end(), edge_of(a, b, 0));
         e != edges.end() && e->least == std::min(a, b) && e->most == std::max(a, b); ++e)
      if (e->building != building && same_level(row.buildings[e->building].level, row.buildings[building].level))
        return e->building;
    return model::kNoIndex;
  };
  const auto off = [&](std::uint32_t building, std::uint32_t other, Point2 at) {
    const std::vector<SaidPoint>& points = said[building];
    for (auto s = std::lower_bound(points.begin(), points.end(), SaidPoint{at, {-1e300, -1e300}});
         s != points.end() && s->at == at; ++s)
      if (!touches(mapped[other], s->said)) return true;
    return false;
  };

  for (std::uint32_t b = 0; b < row.buildings.size(); ++b) {
    TerraceBuilding& building = row.buildings[b];
    std::vector<std::uint32_t> closed;  // neighbours of closed gaps
    for_each_ring(building.polygons, [&](const Ring& ring) {
      const std::size_t n = ring.size();
      std::vector<std::uint32_t> with(n);
      for (std::size_t i = 0; i < n; ++i) with[i] = neighbour_at(ring.points[i], ring.points[(i + 1) % n], b);
      // Chains begin where the neighbour changes; a ring within one neighbour is one chain.
      std::size_t start = 0;
      while (start < n && with[start] == with[(start + n - 1) % n]) ++start;
      if (start == n) start = 0;
      for (std::size_t i = 0; i < n;) {
        const std::uint32_t other = with[(start + i) % n];
        const std::size_t first = i;
        while (i < n && with[(start + i) % n] == other) ++i;
        if (other == model::kNoIndex) continue;
        ++building.record.shared_walls;
        bool gap = false;
        for (std::size_t k = first; k <= i && !gap; ++k) {
          const Point2 p = ring.points[(start + k) % n];
          gap = off(b, other, p) || off(other, b, p);
        }
        if (!gap) continue;
        ++building.record.gaps_closed;
        closed.push_back(other);
      }
    });
    if (closed.empty()) continue;
    std::sort(closed.begin(), closed.end());
    closed.erase(std::unique(closed.begin(), closed.end()), closed.end());
    std::string detail = std::to_string(building.record.gaps_closed) + " with";
    for (const std::uint32_t other : closed) detail += " " + row.buildings[other].id.text();
    report.add(building.id, model::IssueCode::shared_wall_made, std::move(detail));
  }
}

}  // namespace blockrand::repair
