#include "pipeline/outputs/statistics.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"
#include "pipeline/outputs/placed_element.h"

namespace blockrand::outputs {

namespace {

std::uint64_t mixed(std::uint64_t h) {  // the finaliser of MurmurHash3
  h ^= h >> 33;
  h *= 0xff51afd7ed558ccdULL;
  h ^= h >> 33;
  h *= 0xc4ceb9fe1a85ec53ULL;
  return h ^ (h >> 33);
}

/// The same for both directions of a wall.
std::uint64_t wall_key(model::Point2 a, model::Point2 b) {
  if (b < a) std::swap(a, b);
  std::uint64_t h = 0;
  for (const double v : {a.x, a.y, b.x, b.y}) h = mixed(h ^ static_cast<std::uint64_t>(geometry::to_grid(v)));
  return h;
}

/// m. A stretch this near to the whole edge is the whole edge: its ends were computed in another order.
constexpr double kWholeEdge = 0.002;

}  // namespace

TileStatistics count_statistics(const model::Region& region) {
  TileStatistics out;
  Statistics& s = out.sums;
  const std::vector<bool> shown = with_shape(region);
  for (const model::Building& building : region.buildings) {
    const auto& a = building.attributes;
    const double wall_height = std::max(0.0, a.height.value - a.roof_height.value - a.min_height.value);
    const double base = a.ground_height.value;
    if (!building.parts.empty()) ++s.positions[static_cast<std::size_t>(building.situation.position)];
    for (const model::WallSegment& e : building.edges) {
      ++s.edges[static_cast<std::size_t>(e.kind)];
      s.edge_length[static_cast<std::size_t>(e.kind)] += e.length();
      const model::Polygon& polygon = building.outline[e.polygon];
      const model::Ring& ring = e.ring == 0 ? polygon.outer : polygon.holes[e.ring - 1];
      const model::Point2 a = ring.points[e.edge], b = ring.points[(e.edge + 1) % ring.size()];
      const double whole = distance(b, a);
      if (e.kind == model::WallSegmentKind::party_wall && e.start <= kWholeEdge && e.end >= whole - kWholeEdge)
        out.party_sides.push_back({wall_key(a, b), whole, base, base + wall_height});
      else
        s.outer_wall_area += e.length() * wall_height;
    }
    for (const model::Polygon& p : building.outline) s.footprint_area += geometry::area(p);
    s.buildings += !building.parts.empty();
    s.bodies += building.parts.size();
    for (const model::BuildingPart& part : building.parts) {
      if (part.lod >= 2 && part.lod2.closed) {
        s.volume += geometry::volume(part.lod2, part.lod2_triangles);
        ++s.solids_lod2;
      } else if (part.lod >= 1) {  // surfaces have no volume: that of the block
        s.volume += geometry::volume(part.lod1, part.lod1_triangles);
      }
      s.solids_lod1 += !part.lod1.empty();
      if (part.lod >= 3 && !part.lod3.solid.empty()) {
        s.solids_lod3 += part.lod3.solid.closed;
        for (const model::Opening& opening : part.lod3.openings) {
          s.windows += opening.kind == model::OpeningKind::window;
          s.doors += opening.kind == model::OpeningKind::door;
        }
        for (const model::RoofElementKind kind : part.lod3.roof_elements)
          ++(kind == model::RoofElementKind::dormer ? s.dormers : s.cross_gables);
        for (const model::Placement& p : part.lod3.placements) s.placements += shown.at(p.element);
        s.installations += part.lod3.installations.size() + part.lod3.roof_installations.size();
      }
      ++s.roofs[std::string(model::name(part.built_roof))];
      model::for_each_attribute(
          part.attributes,
          [&](const char* name, const char*, const auto& value) {
            ++s.sources[name][std::string(model::name(value.source))];
          },
          [](const char*, const char*) {});
    }
  }
  masses::RoofscapeCount roofs = masses::count_roofscape(region);
  s.roofscape = roofs.sums;
  out.slope_ends = std::move(roofs.open);
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
  sum.solids_lod3 += s.solids_lod3;
  sum.windows += s.windows;
  sum.doors += s.doors;
  sum.dormers += s.dormers;
  sum.cross_gables += s.cross_gables;
  sum.placements += s.placements;
  sum.installations += s.installations;
  for (std::size_t k = 0; k < s.edges.size(); ++k) {
    sum.edges[k] += s.edges[k];
    sum.edge_length[k] += s.edge_length[k];
  }
  for (std::size_t k = 0; k < s.positions.size(); ++k) sum.positions[k] += s.positions[k];
  for (const auto& [attribute, sources] : s.sources)
    for (const auto& [source, count] : sources) sum.sources[attribute][source] += count;
  for (const auto& [shape, count] : s.roofs) sum.roofs[shape] += count;
  masses::add(sum.roofscape, s.roofscape);
}

void settle_party_walls(std::vector<PartySide> sides, Statistics& sum, std::vector<PartySide>* alone) {
  std::sort(sides.begin(), sides.end(), [](const PartySide& a, const PartySide& b) {
    return a.wall != b.wall ? a.wall < b.wall : std::tie(a.top, a.base) < std::tie(b.top, b.base);
  });
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i;
    while (j < sides.size() && sides[j].wall == sides[i].wall) ++j;
    if (j - i < 2) {
      // The neighbour was not built: the wall stands free.
      sum.outer_wall_area += sides[i].length * (sides[i].top - sides[i].base);
      if (alone) alone->push_back(sides[i]);
    } else {
      const PartySide& lower = sides[j - 2];  // the second highest meets the highest
      const PartySide& upper = sides[j - 1];
      const double covered = std::max(0.0, lower.top - std::max(lower.base, upper.base));
      sum.party_wall_area += sides[i].length * covered;
      sum.party_wall_length += sides[i].length;
      sum.outer_wall_area += sides[i].length * (upper.top - upper.base + lower.top - lower.base - 2 * covered);
      ++sum.party_walls;
    }
    i = j;
  }
}

}  // namespace blockrand::outputs
