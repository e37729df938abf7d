#include "pipeline/footprints/repair/parts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "pipeline/footprints/repair/parts_bodies.h"
#include "pipeline/footprints/repair/parts_follow.h"
#include "pipeline/footprints/repair/rings.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/slivers.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/model/vector.h"

namespace blockrand::repair {

namespace {

using model::Building;
using model::BuildingPart;
using model::IssueCode;
using model::Point2;
using model::Polygon;
using model::Ring;

constexpr double kOutsideWidth = 0.1;  // m; narrower strips outside the outline are two drawings of one wall
constexpr double kStripSlope = 0.1;    // of two walls that are one: 10 cm between their ends on a metre
constexpr double kLeastStrip = 0.05;   // m; shorter ones are where two walls meet

double area_of(std::span<const Polygon> polygons) {
  double sum = 0;
  for (const Polygon& p : polygons) sum += geometry::area(p);
  return sum;
}

BuildingPart whole(const Building& building) {
  BuildingPart part;
  part.id = building.id();
  part.osm = building.osm;
  part.mapped_index = building.mapped_index;
  part.tags = building.tags;
  part.mapped = building.mapped;
  return part;
}

std::vector<Polygon> all_polygons(const std::vector<PartBody>& bodies) {
  std::vector<Polygon> out;
  for (const PartBody& body : bodies) out.insert(out.end(), body.polygons.begin(), body.polygons.end());
  return out;
}

std::vector<Polygon> united(const std::vector<PartBody>& bodies, const RepairOptions& options) {
  const std::vector<Polygon> all = all_polygons(bodies);
  geometry::ValidPolygons outline = geometry::unite(all, options.min_piece_area, options.ring_clearance);
  restore_nodes(outline.polygons, all);
  return std::move(outline.polygons);
}

/// Mends polygons whose corners moved; false where that is not the same plan any more.
bool mended(std::vector<Polygon>& moved, double area, const RepairOptions& options) {
  if (!std::all_of(moved.begin(), moved.end(), well_wound)) return false;
  if (std::all_of(moved.begin(), moved.end(),
                  [](const Polygon& p) { return geometry::strictly_simple(p) && geometry::rings_apart(p); }))
    return true;
  std::vector<Ring> rings;
  std::vector<bool> inner;
  for (const Polygon& p : moved) {
    rings.push_back(p.outer);
    inner.push_back(false);
    for (const Ring& hole : p.holes) rings.push_back(hole), inner.push_back(true);
  }
  geometry::ValidPolygons valid = geometry::make_valid(rings, inner, options.min_piece_area, options.ring_clearance);
  const double change = area_of(valid.polygons) - area;
  if (valid.polygons.size() != moved.size() ||
      change * change > options.max_area_change * options.max_area_change * area * area)
    return false;
  moved = std::move(valid.polygons);
  return true;
}

void follow(const MovedWalls& walls, std::vector<PartBody>& bodies, const RepairOptions& options) {
  if (!walls.any()) return;
  for (PartBody& body : bodies) {
    std::vector<Polygon> moved = body.polygons;
    const auto move = [&](Ring& ring) {
      for (model::Point2& p : ring.points) p = walls(p);
    };
    for (Polygon& p : moved) {
      move(p.outer);
      for (Ring& hole : p.holes) move(hole);
    }
    if (mended(moved, area_of(moved), options)) body.polygons = std::move(moved);
  }
}

/// What the outline gave to neighbours its parts give, too.
void give_up_lost(std::span<const Polygon> before, const Building& building, std::vector<PartBody>& bodies,
                  const RepairOptions& options, model::Report& report) {
  std::vector<Polygon> lost =
      geometry::difference(before, building.outline, options.min_overlap_area, options.ring_clearance).polygons;
  // Narrower strips are where a wall moved, and the parts with it.
  std::erase_if(lost, [&](const Polygon& p) { return geometry::equivalent_width(p) < options.snap_distance; });
  if (lost.empty()) return;
  for (PartBody& body : bodies) {
    const double common = geometry::common_area(body.polygons, lost);
    if (common <= options.min_overlap_area) continue;
    std::vector<Polygon> rest = plan_without(body.polygons, lost, options);
    if (area_of(rest) < (1 - options.max_loss) * area_of(body.polygons)) {
      report.add(body.osm, IssueCode::overlap_kept, square_metres(common) + " that the outline gave to a neighbour");
      continue;
    }
    restore_nodes(rest, building.outline);
    body.polygons = std::move(rest);
  }
}

void report_outside(const Building& building, const std::vector<PartBody>& bodies, const RepairOptions& options,
                    model::Report& report) {
  for (const PartBody& body : bodies) {
    if (area_of(body.polygons) - geometry::common_area(body.polygons, building.outline) <= options.min_overlap_area)
      continue;
    double area = 0;
    for (const Polygon& p :
         geometry::difference(body.polygons, building.outline, options.min_piece_area, options.ring_clearance).polygons)
      if (geometry::equivalent_width(p) >= kOutsideWidth) area += geometry::area(p);
    if (area > options.min_overlap_area) report.add(body.osm, IssueCode::parts_outside, square_metres(area));
  }
}

/// A wall, from a to b with the inside on its left, and where it lies.
struct Wall {
  Point2 a, b;
  Point2 along;  ///< of length 1
  double length;

  /// x along the wall, y to its left. m
  Point2 place(Point2 p) const { return {model::dot(p - a, along), model::cross(along, p - a)}; }
  Point2 back(Point2 p) const {
    return model::snap(Point2{a.x + p.x * along.x - p.y * along.y, a.y + p.x * along.y + p.y * along.x});
  }
};

std::vector<Wall> walls_of(std::span<const Polygon> polygons) {
  std::vector<Wall> out;
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring.points[i], b = ring.points[(i + 1) % ring.size()];
      const double length = model::distance(a, b);
      out.push_back({a, b, {(b.x - a.x) / length, (b.y - a.y) / length}, length});
    }
  };
  for (const Polygon& p : polygons) {
    add(p.outer);
    for (const Ring& hole : p.holes) add(hole);
  }
  return out;
}

/// The ground between a wall of a part and a wall of the outline that is almost the same, as far as they lie within
/// kOutsideWidth of each other; nothing where they are two walls.
std::optional<Polygon> strip_between(const Wall& wall, const Wall& outer) {
  const Point2 from = wall.place(outer.a), to = wall.place(outer.b);
  const double slope = (to.y - from.y) / (to.x - from.x);
  if (!(to.x > from.x) || std::fabs(slope) > kStripSlope) return std::nullopt;
  double first = std::max(from.x, 0.0), last = std::min(to.x, wall.length);
  if (slope != 0) {
    const double middle = from.x - from.y / slope, half = kOutsideWidth / std::fabs(slope);
    first = std::max(first, middle - half);
    last = std::min(last, middle + half);
  } else if (std::fabs(from.y) > kOutsideWidth) {
    return std::nullopt;
  }
  if (last - first < kLeastStrip) return std::nullopt;
  // At the wall's own corners to the point; else a little into the part, so that rounding leaves nothing between.
  constexpr double kInto = 0.01;  // m
  Polygon strip;
  strip.outer.points = {wall.back({first, -kOutsideWidth}), wall.back({last, -kOutsideWidth}),
                        last == wall.length ? wall.b : wall.back({last, kInto}),
                        first == 0 ? wall.a : wall.back({first, kInto})};
  strip.outer.nodes.assign(strip.outer.points.size(), 0);
  return strip;
}

/// What parts leave free of an outline, without what is too little to be built.
std::vector<Polygon> rest_of(std::span<const Polygon> outline, std::vector<Polygon> covered,
                             const RepairOptions& options) {
  const auto left = [&] {
    geometry::ValidPolygons rest =
        geometry::difference(outline, covered, options.parts_free_area, options.ring_clearance);
    std::erase_if(rest.polygons,
                  [&](const Polygon& p) { return geometry::equivalent_width(p) < options.parts_free_width; });
    return rest;
  };
  geometry::ValidPolygons rest = left();
  if (!rest.separated) return std::move(rest.polygons);
  // Where a wall of a part runs beside one of the outline, a strip between the two touches itself at many places.
  const std::vector<Wall> outer = walls_of(outline);
  std::vector<Polygon> strips;
  for (const Wall& wall : walls_of(covered))
    for (const Wall& other : outer)
      if (std::optional<Polygon> strip = strip_between(wall, other)) strips.push_back(std::move(*strip));
  if (strips.empty()) return std::move(rest.polygons);
  covered.insert(covered.end(), std::make_move_iterator(strips.begin()), std::make_move_iterator(strips.end()));
  return left().polygons;
}

void add_rest(Building& building, const std::vector<PartBody>& bodies, const RepairOptions& options,
              model::Report& report) {
  const std::vector<Polygon> covered = all_polygons(bodies);
  std::vector<Polygon> rest = rest_of(building.outline, covered, options);
  if (rest.empty()) return;
  geometry::cut_slivers(rest, options.spike_width);
  restore_nodes(rest, building.outline);
  restore_nodes(rest, covered);
  report.add(building.osm, IssueCode::parts_incomplete, square_metres(area_of(rest)));
  BuildingPart pattern = whole(building);
  pattern.id += ".rest";
  pattern.rest = true;
  add_pieces(building.parts, pattern, std::move(rest));
}

std::vector<PartBody> repaired_bodies(const Building& building, const KeptNodes& kept, const RepairOptions& options,
                                      std::vector<model::PartFailure>& failures, model::Report& report) {
  std::vector<PartBody> bodies;
  for (std::size_t i = 0; i < building.parts.size(); ++i) {
    const BuildingPart& part = building.parts[i];
    RepairedRings repaired = repair_rings(part.rings, part.osm, kept, options, report);
    if (repaired.failure != IssueCode::none) {
      failures.push_back({part.mapped_index, repaired.failure});
      continue;
    }
    bodies.push_back(
        {i, part.osm, height_span(part.mapped, part.canopy, building.mapped), std::move(repaired.polygons)});
  }
  return bodies;
}

}  // namespace

void add_pieces(std::vector<BuildingPart>& parts, const BuildingPart& pattern, std::vector<Polygon> polygons) {
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    BuildingPart piece = pattern;
    if (polygons.size() > 1) piece.id += "." + std::to_string(i + 1);
    piece.plan = std::move(polygons[i]);
    parts.push_back(std::move(piece));
  }
}

std::vector<Polygon> outline_of_parts(const Building& building, const KeptNodes& kept, const RepairOptions& options) {
  std::vector<model::PartFailure> failures;
  model::Report report;
  return united(repaired_bodies(building, kept, options, failures, report), options);
}

void fit_parts(Building& building, std::span<const Polygon> outline_before, const KeptNodes& kept,
               const RepairOptions& options, std::vector<model::PartFailure>& failures,
               std::vector<model::SettledPart>& settled, model::Report& report) {
  if (!building.has_mapped_parts) {
    building.parts.clear();
    add_pieces(building.parts, whole(building), building.outline);
    return;
  }
  std::vector<model::PartFailure> failed;
  std::vector<PartBody> bodies = repaired_bodies(building, kept, options, failed, report);
  for (const model::PartFailure& failure : failed) {
    // The first part of a building without outline gave the building its name: the object has one state, the
    // building's.
    if (failure.mapped_index == building.mapped_index)
      building.failure = failure.code;
    else
      failures.push_back(failure);
  }
  if (bodies.empty()) {
    building.parts.clear();
    add_pieces(building.parts, whole(building), building.outline);
    building.has_mapped_parts = false;
    return;
  }
  building.failure = IssueCode::none;
  if (building.outline.empty()) {
    building.outline = united(bodies, options);
    report.add(building.osm, IssueCode::outline_made,
               std::to_string(bodies.size()) + (bodies.size() == 1 ? " part" : " parts"));
  } else if (options.fit_parts && !outline_before.empty()) {
    const auto same = [](const Polygon& a, const Polygon& b) {
      return a.outer.points == b.outer.points &&
             std::equal(a.holes.begin(), a.holes.end(), b.holes.begin(), b.holes.end(),
                        [](const Ring& g, const Ring& h) { return g.points == h.points; });
    };
    if (!std::equal(outline_before.begin(), outline_before.end(), building.outline.begin(), building.outline.end(),
                    same)) {
      follow(MovedWalls(outline_before, building.outline, options), bodies, options);
      give_up_lost(outline_before, building, bodies, options, report);
    }
  }
  if (options.fit_parts && options.share_walls) {
    if (const int joined = share_part_walls(bodies, building.outline, options); joined > 0)
      report.add(building.osm, IssueCode::shared_wall_made,
                 std::to_string(joined) + (joined == 1 ? " corner of its parts" : " corners of its parts"));
  }
  report_outside(building, bodies, options, report);
  if (options.fit_parts) resolve_part_overlaps(bodies, options, report);

  std::vector<BuildingPart> parts;
  for (PartBody& body : bodies) {
    BuildingPart& part = building.parts[body.part];
    part.rings = {};
    add_pieces(parts, part, body.polygons);
  }
  building.parts = std::move(parts);
  if (!options.fit_parts) return;
  add_rest(building, bodies, options, report);
  separate_parts(building, options, settled, report);
}

}  // namespace blockrand::repair
