#include "pipeline/repair/repair.h"

#include "pipeline/geometry/polygon.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/repair/rings.h"

namespace blockrand::repair {

namespace {

using model::Building;
using model::BuildingPart;
using model::IssueCode;
using model::Polygon;
using model::Region;
using model::Ring;

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
    RepairedRings outline = repair_rings(std::move(building.rings), building.osm, {}, options, report);
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
    RepairedRings repaired = repair_rings(std::move(part.rings), part.osm, {}, options, report);
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

void repair(Region& region, const RepairOptions& given) {
  // Which nodes neighbours share is not known here; without that no point of a wall may go.
  RepairOptions options = given;
  options.simplify = false;
  for (Building& building : region.buildings) repair_building(building, options, region);
}

}  // namespace blockrand::repair
