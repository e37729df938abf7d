#include "pipeline/repair/repair.h"

#include <cmath>
#include <string>

#include "pipeline/geometry/polygon.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/repair/clean_ring.h"

namespace blockrand::repair {

namespace {

using model::Building;
using model::BuildingPart;
using model::IssueCode;
using model::Polygon;
using model::Region;
using model::Ring;

struct Repaired {
  std::vector<Polygon> polygons;
  IssueCode failure = IssueCode::none;
};

std::string square_metres(double area) {
  const long long hundredths = std::llround(area * 100);
  std::string fraction = std::to_string(hundredths % 100);
  if (fraction.size() < 2) fraction.insert(0, "0");
  return std::to_string(hundredths / 100) + "." + fraction + " m2";
}

Repaired repair_rings(model::MappedRings rings, model::OsmId id, const RepairOptions& options, model::Report& report) {
  RingCleaning cleaning;
  bool has_ring = false;
  double mapped_area = 0;
  std::vector<Ring> kept;
  std::vector<bool> inner;
  bool outer_kept = false;
  for (std::size_t i = 0; i < rings.rings.size(); ++i) {
    Ring& ring = rings.rings[i];
    const RingCleaning c = clean_ring(ring, options);
    cleaning.duplicates += c.duplicates;
    cleaning.spikes += c.spikes;
    if (ring.size() >= 3) has_ring = has_ring || !rings.inner[i];
    if (!rings.inner[i]) outer_kept = ring.size() >= 3;
    // A hole whose outer ring has vanished would otherwise be taken for a building.
    if (ring.size() < 3 || (rings.inner[i] && !outer_kept)) continue;
    mapped_area += (rings.inner[i] ? -1 : 1) * std::fabs(geometry::signed_area(ring.points));
    kept.push_back(std::move(ring));
    inner.push_back(rings.inner[i]);
  }
  if (cleaning.duplicates > 0)
    report.add(id, IssueCode::duplicate_points, std::to_string(cleaning.duplicates) + " points");
  if (cleaning.spikes > 0) report.add(id, IssueCode::spike_removed, std::to_string(cleaning.spikes) + " points");
  if (!has_ring) return {{}, cleaning.spikes > 0 ? IssueCode::zero_area : IssueCode::too_few_points};

  geometry::ValidPolygons valid =
      geometry::make_valid(kept, inner, options.min_piece_area, options.ring_clearance);
  if (valid.polygons.empty()) return {{}, IssueCode::zero_area};
  if (valid.changed) {
    double area = 0;
    for (const Polygon& p : valid.polygons) area += geometry::area(p);
    report.add(id, IssueCode::ring_repaired, square_metres(mapped_area) + " to " + square_metres(area));
  }
  if (valid.separated) report.add(id, IssueCode::touching_rings);
  if (valid.dropped_area > 0) report.add(id, IssueCode::sliver_dropped, square_metres(valid.dropped_area));
  if (valid.polygons.size() > 1)
    report.add(id, IssueCode::split_outline, std::to_string(valid.polygons.size()) + " pieces");
  return {std::move(valid.polygons), IssueCode::none};
}

void note_edges(Building& building) {
  building.edges.clear();
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      {
      model::FacadeEdge edge;
      edge.from_node = ring.nodes[i];
      edge.to_node = ring.nodes[(i + 1) % ring.size()];
      building.edges.push_back(edge);
    }
  };
  for (const Polygon& polygon : building.outline) {
    add(polygon.outer);
    for (const Ring& hole : polygon.holes) add(hole);
  }
}

/// Parts that are pieces of one thing: the first keeps the plain id when there is but one.
void add_pieces(std::vector<BuildingPart>& parts, const BuildingPart& pattern, std::vector<Polygon> polygons) {
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    BuildingPart piece = pattern;
    if (polygons.size() > 1) piece.id += "." + std::to_string(i + 1);
    piece.plan = std::move(polygons[i]);
    parts.push_back(std::move(piece));
  }
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

void repair_building(Building& building, const RepairOptions& options, Region& region) {
  model::Report& report = region.report;
  if (!building.rings.rings.empty()) {
    Repaired outline = repair_rings(std::move(building.rings), building.osm, options, report);
    building.rings = {};
    building.outline = std::move(outline.polygons);
    building.failure = outline.failure;
    note_edges(building);
  }
  if (!building.has_mapped_parts) {
    building.parts.clear();
    add_pieces(building.parts, whole(building), building.outline);
    return;
  }

  std::vector<BuildingPart> parts;
  std::vector<Polygon> covered;
  for (BuildingPart& part : building.parts) {
    Repaired repaired = repair_rings(std::move(part.rings), part.osm, options, report);
    part.rings = {};
    if (repaired.failure != IssueCode::none) region.part_failures.push_back({part.mapped_index, repaired.failure});
    covered.insert(covered.end(), repaired.polygons.begin(), repaired.polygons.end());
    add_pieces(parts, part, std::move(repaired.polygons));
  }
  building.parts = std::move(parts);
  if (building.outline.empty()) {
    if (!building.parts.empty()) building.failure = IssueCode::none;
    return;
  }
  if (building.parts.empty()) {
    add_pieces(building.parts, whole(building), building.outline);
    building.has_mapped_parts = false;
    return;
  }
  geometry::ValidPolygons rest =
      geometry::difference(building.outline, covered, options.parts_free_area, options.ring_clearance);
  std::vector<Polygon> wide;
  double area = 0;
  for (Polygon& p : rest.polygons) {
    if (geometry::equivalent_width(p) < options.parts_free_width) continue;
    area += geometry::area(p);
    wide.push_back(std::move(p));
  }
  if (wide.empty()) return;
  BuildingPart pattern = whole(building);
  pattern.id += ".rest";
  pattern.rest = true;
  add_pieces(building.parts, pattern, std::move(wide));
  report.add(building.osm, IssueCode::parts_incomplete, square_metres(area));
}

}  // namespace

void repair(Region& region, const RepairOptions& options) {
  for (Building& building : region.buildings) repair_building(building, options, region);
}

}  // namespace blockrand::repair
