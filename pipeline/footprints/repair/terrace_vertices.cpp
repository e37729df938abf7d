#include "pipeline/footprints/repair/terrace_vertices.h"

#include <algorithm>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/segment_grid.h"

namespace blockrand::repair {

namespace {

using model::Point2;
using model::Ring;

/// m. Cells of the index of footprints beyond a cut: about an edge long.
constexpr double kCell = 16;

void fix_near(const std::vector<model::Polygon>& beyond, double reach, TerraceVertices& vertices) {
  std::vector<geometry::Segment> segments;
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      segments.push_back({ring.points[i], ring.points[(i + 1) % ring.size()]});
  };
  for (const model::Polygon& p : beyond) {
    add(p.outer);
    for (const Ring& hole : p.holes) add(hole);
  }
  const geometry::SegmentGrid grid(segments, kCell);
  std::vector<std::uint32_t> near;
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    const Point2 p = vertices.point[v];
    grid.near({p.x - reach, p.y - reach}, {p.x + reach, p.y + reach}, near);
    vertices.fixed[v] = std::any_of(near.begin(), near.end(), [&](std::uint32_t i) {
      return geometry::distance_to_segment(p, segments[i].a, segments[i].b) <= reach;
    });
  }
}

}  // namespace

TerraceVertices terrace_vertices(const TerraceRow& row, double snap_reach) {
  TerraceVertices out;
  const auto add = [&](const Ring& ring, std::size_t building, std::size_t polygon, std::size_t number) {
    out.rings.push_back({static_cast<std::uint32_t>(building), static_cast<std::uint32_t>(polygon),
                         static_cast<std::uint32_t>(number), out.size(), static_cast<std::uint32_t>(ring.size())});
    out.point.insert(out.point.end(), ring.points.begin(), ring.points.end());
    out.node.insert(out.node.end(), ring.nodes.begin(), ring.nodes.end());
    out.ring_of.insert(out.ring_of.end(), ring.size(), static_cast<std::uint32_t>(out.rings.size() - 1));
  };
  for (std::size_t b = 0; b < row.buildings.size(); ++b)
    for (std::size_t p = 0; p < row.buildings[b].polygons.size(); ++p) {
      const model::Polygon& polygon = row.buildings[b].polygons[p];
      add(polygon.outer, b, p, 0);
      for (std::size_t h = 0; h < polygon.holes.size(); ++h) add(polygon.holes[h], b, p, h + 1);
    }
  out.fixed.assign(out.size(), false);
  if (!row.beyond_cut.empty()) fix_near(row.beyond_cut, snap_reach, out);
  return out;
}

}  // namespace blockrand::repair
