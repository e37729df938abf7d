#include "pipeline/context/ground.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "importers/elevation/terrain.h"
#include "pipeline/geometry/wall_segment.h"

namespace blockrand::context {

namespace {

using georef::LonLat;
using importers::elevation::GroundRange;
using importers::elevation::Terrain;
using model::Point2;

/// m. What is straight in the build CRS is bent in the raster's; over this length by less than a millimetre: half a
/// millimetre between UTM and a raster in degrees at 60 degrees north.
constexpr double kStraight = 100;

/// How far terrain is trusted: a measured surface, smoothed by its pixels.
constexpr float kTerrainConfidence = 0.9f;

void append(std::vector<LonLat>& line, Point2 a, Point2 b, const georef::Projection& projection) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const int pieces = std::max(1, static_cast<int>(std::ceil(std::sqrt(dx * dx + dy * dy) / kStraight)));
  for (int i = 0; i < pieces; ++i) {
    const double t = static_cast<double>(i) / pieces;
    line.push_back(projection.inverse({a.x + t * dx, a.y + t * dy}));
  }
}

std::vector<LonLat> closed_line(const model::Ring& ring, const georef::Projection& projection) {
  std::vector<LonLat> line;
  for (std::size_t i = 0; i < ring.size(); ++i)
    append(line, ring.points[i], ring.points[(i + 1) % ring.size()], projection);
  return line;
}

std::optional<GroundRange> under_polygon(const Terrain& terrain, const model::Polygon& polygon,
                                         const georef::Projection& projection) {
  std::vector<std::vector<LonLat>> rings{closed_line(polygon.outer, projection)};
  for (const model::Ring& hole : polygon.holes) rings.push_back(closed_line(hole, projection));
  return terrain.range_under(rings);
}

void widen(std::optional<GroundRange>& range, const std::optional<GroundRange>& more) {
  if (!more) return;
  if (!range) {
    range = more;
    return;
  }
  range->lowest = std::min(range->lowest, more->lowest);
  range->highest = std::max(range->highest, more->highest);
}

/// Where a building is entered: height and reason.
struct Entrance {
  double height = 0;
  std::string why;
};

std::optional<Entrance> entrance(const model::Building& building, const Terrain& terrain,
                                 const georef::Projection& projection) {
  std::optional<GroundRange> doors, front, around;
  for (const std::uint32_t index : building.situation.fronts) {
    const model::WallSegment& edge = building.edges[index];
    for (const model::WallPoint& point : edge.points)
      if (point.entrance) widen(doors, terrain.range_along(std::vector{projection.inverse(point.place)}));
    const auto ends = geometry::ends_of(building, edge);
    if (!ends) continue;
    std::vector<LonLat> line;
    append(line, ends->from, ends->to, projection);
    line.push_back(projection.inverse(ends->to));
    widen(front, terrain.range_along(line));
  }
  if (doors) return Entrance{doors->highest, "ground at the mapped entrance"};
  if (front) return Entrance{front->highest, "highest ground along the main front"};
  for (const model::Polygon& polygon : building.outline) {
    std::vector<LonLat> line = closed_line(polygon.outer, projection);
    if (!line.empty()) line.push_back(line.front());
    widen(around, terrain.range_along(line));
  }
  if (around) return Entrance{around->highest, "highest ground along the outline"};
  return std::nullopt;
}

}  // namespace

bool stands_on_ground(const model::MappedAttributes& tags) {
  return tags.min_height.value_or(0) <= 0 && tags.min_storey.value_or(0) <= 0;
}

BuildingGround Ground::under(const model::Building& building) const {
  BuildingGround out;
  std::optional<GroundRange> all;
  std::vector<std::optional<GroundRange>> parts(building.parts.size());
  if (terrain_ != nullptr) {
    for (const model::Polygon& polygon : building.outline) widen(all, under_polygon(*terrain_, polygon, projection_));
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const model::BuildingPart& part = building.parts[i];
      // The only body of a building without mapped parts has its outline as plan.
      if (parts.size() == 1 && !building.has_mapped_parts) {
        parts[i] = all;
        continue;
      }
      if (part.plan.outer.size() < 3) continue;
      parts[i] = under_polygon(*terrain_, part.plan, projection_);
      if (stands_on_ground(part.mapped)) widen(all, parts[i]);
    }
  }
  if (!all) {
    if (height_)
      out.lowest = {model::snap(*height_), model::Source::override_, 0.5f, 0};
    else
      out.lowest = {0, model::Source::default_, 0.1f, 0};
    return out;
  }
  out.lowest = {all->lowest, model::Source::terrain, kTerrainConfidence, 0};
  out.rise = all->highest - all->lowest;
  for (const std::optional<GroundRange>& part : parts)
    out.part_rise.push_back(part ? std::clamp(part->highest - all->lowest, 0.0, out.rise) : out.rise);
  Entrance door =
      entrance(building, *terrain_, projection_).value_or(Entrance{all->highest, "highest ground under the outline"});
  out.entrance = std::clamp(door.height - all->lowest, 0.0, out.rise);
  out.entrance_reason = std::move(door.why);
  return out;
}

}  // namespace blockrand::context
