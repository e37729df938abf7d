#include "pipeline/region/statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/polygon.h"

namespace blockrand::region {

namespace {

double edge_length(const model::Ring& ring, std::size_t i) {
  const model::Point2 a = ring.points[i], b = ring.points[(i + 1) % ring.size()];
  return std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
}

}  // namespace

TileStatistics count_statistics(const model::Region& region, const context::SharedEdges& shared) {
  TileStatistics out;
  Statistics& s = out.sums;
  for (const model::Building& building : region.buildings) {
    const auto& a = building.attributes;
    const double wall_height = std::max(0.0, a.height.value - a.roof_height.value - a.min_height.value);
    std::size_t edge = 0;
    const auto count_ring = [&](const model::Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i, ++edge) {
        const double length = edge_length(ring, i);
        const model::FacadeEdge& e = building.edges[edge];
        if (e.kind == model::EdgeKind::party_wall)
          out.party_sides.push_back({shared.find(e.from_node, e.to_node), length, wall_height});
        else
          s.outer_wall_area += length * wall_height;
      }
    };
    for (const model::Polygon& p : building.outline) {
      s.footprint_area += geometry::area(p);
      count_ring(p.outer);
      for (const model::Ring& hole : p.holes) count_ring(hole);
    }
    s.buildings += !building.parts.empty();
    s.bodies += building.parts.size();
    for (const model::BuildingPart& part : building.parts) {
      if (part.lod >= 2) {
        s.volume += geometry::volume(part.lod2, part.lod2_triangles);
        ++s.solids_lod2;
      } else if (part.lod == 1) {
        s.volume += geometry::volume(part.lod1, part.lod1_triangles);
      }
      s.solids_lod1 += !part.lod1.empty();
      ++s.roofs[std::string(model::name(part.built_roof))];
      model::for_each_attribute(
          part.attributes,
          [&](const char* name, const char*, const auto& value) { ++s.sources[name][std::string(model::name(value.source))]; },
          [](const char*, const char*) {});
    }
  }
  return out;
}

void add(Statistics& sum, const Statistics& s) {
  sum.footprint_area += s.footprint_area;
  sum.outer_wall_area += s.outer_wall_area;
  sum.volume += s.volume;
  sum.buildings += s.buildings;
  sum.bodies += s.bodies;
  sum.solids_lod1 += s.solids_lod1;
  sum.solids_lod2 += s.solids_lod2;
  for (const auto& [attribute, sources] : s.sources)
    for (const auto& [source, count] : sources) sum.sources[attribute][source] += count;
  for (const auto& [shape, count] : s.roofs) sum.roofs[shape] += count;
}

void settle_party_walls(std::vector<PartySide> sides, Statistics& sum) {
  std::sort(sides.begin(), sides.end(), [](const PartySide& a, const PartySide& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.height < b.height;
  });
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i;
    while (j < sides.size() && sides[j].edge == sides[i].edge) ++j;
    if (j - i < 2) {
      // The neighbour was not built: the wall stands free.
      sum.outer_wall_area += sides[i].length * sides[i].height;
    } else {
      const double covered = sides[j - 2].height;  // the second highest meets the highest
      sum.party_wall_area += sides[i].length * covered;
      sum.party_wall_length += sides[i].length;
      sum.outer_wall_area += sides[i].length * (sides[j - 1].height - covered);
      ++sum.party_walls;
    }
    i = j;
  }
}

}  // namespace blockrand::region
