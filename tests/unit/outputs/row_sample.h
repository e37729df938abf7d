// A row of three houses at a street with a rear building, as repair and context leave them.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "tests/unit/outputs/sample_region.h"

namespace blockrand::outputs::test {

inline constexpr double kRowX = 391000, kRowY = 5819000;

/// A stretch of the outer ring of the building's first outline.
/// \param start, end  m along the edge; end 0: the whole edge
inline model::WallSegment& add_stretch(model::Building& b, std::uint32_t edge, model::WallSegmentKind kind,
                                       double start = 0, double end = 0) {
  const model::Ring& ring = b.outline.at(0).outer;
  const model::Point2 p = ring.points[edge], q = ring.points[(edge + 1) % ring.size()];
  model::WallSegment e;
  e.edge = edge;
  e.from_node = ring.nodes[edge];
  e.to_node = ring.nodes[(edge + 1) % ring.size()];
  e.start = start;
  e.end = end > 0 ? end : std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y));
  e.kind = kind;
  e.confidence = 0.9f;
  b.edges.push_back(e);
  return b.edges.back();
}

inline void face(model::WallSegment& e) {
  e.street = {model::OsmType::way, 900};
  e.street_name = "Kastanienallee";
  e.street_class = "residential";
  e.street_distance = 11.5f;
  e.street_angle = 0.25f;
  e.visibility = 1;
}

inline model::Building& add_row_house(SampleRegion& sample, std::int64_t id, double x, double y, double width,
                                      double depth) {
  model::Building& b = sample.add_building(id, {{"building", "apartments"}});
  model::BuildingPart& part = sample.add_box(b, b.id(), kRowX + x, kRowY + y, width, depth, 0, 18);
  for (std::size_t i = 0; i < part.plan.outer.size(); ++i) part.plan.outer.nodes[i] = id * 10 + static_cast<int>(i);
  b.attributes = part.attributes;
  b.outline = {part.plan};
  b.repaired.vertices = 4;
  b.repaired.mapped_area = b.repaired.area = width * depth;
  return b;
}

/// w1, w2 and w3 stand wall to wall, with fronts to the south; w2 has a passage in its front; w4 stands behind w3 in a
/// courtyard that w1, w2 and w3 close to the south. Context has found it all.
inline SampleRegion row_sample() {
  using model::BuildingPosition;
  using model::WallSegmentKind;
  SampleRegion sample;
  sample.region().buildings.reserve(4);
  model::Building& a = add_row_house(sample, 1, 0, 8, 12, 14);
  face(add_stretch(a, 0, WallSegmentKind::street));
  a.edges.back().corner_start = true;
  a.edges.back().entrances = 1;
  a.edges.back().points = {{{model::OsmType::node, 71}, {kRowX + 2, kRowY + 8}, true, "7", {}},
                           {{model::OsmType::node, 72}, {kRowX + 4, kRowY + 9}, false, "7a", {}},
                           {{model::OsmType::node, 73}, {kRowX + 5, kRowY + 9}, false, "7", {}}};
  add_stretch(a, 1, WallSegmentKind::party_wall).neighbour = {model::OsmType::way, 2};
  a.edges.back().covered_height = 16.5f;
  add_stretch(a, 2, WallSegmentKind::courtyard);
  face(add_stretch(a, 3, WallSegmentKind::street));
  a.edges.back().street = {model::OsmType::way, 901};
  a.edges.back().street_name = "Oderberger Straße";
  a.situation.position = BuildingPosition::corner_house;
  a.situation.fronts = {3, 0};

  model::Building& b = add_row_house(sample, 2, 12, 8, 18, 14);
  face(add_stretch(b, 0, WallSegmentKind::street, 0, 7));
  face(add_stretch(b, 0, WallSegmentKind::passage, 7, 10.3));
  face(add_stretch(b, 0, WallSegmentKind::street, 10.3, 18));
  add_stretch(b, 1, WallSegmentKind::party_wall).neighbour = {model::OsmType::way, 3};
  add_stretch(b, 2, WallSegmentKind::courtyard);
  add_stretch(b, 3, WallSegmentKind::party_wall).neighbour = {model::OsmType::way, 1};
  b.situation.position = BuildingPosition::mid_row;
  b.situation.fronts = {2, 0};
  b.situation.setback = 0.4;
  b.repaired.moved = 3;
  b.repaired.mean_shift = 0.0825;
  b.repaired.max_shift = 0.31;
  b.repaired.mapped_area = 251.4;
  b.repaired.shared_walls = 2;
  b.repaired.gaps_closed = 1;
  b.repaired.direction = 90;

  model::Building& c = add_row_house(sample, 3, 30, 8, 15, 14);
  face(add_stretch(c, 0, WallSegmentKind::street));
  add_stretch(c, 1, WallSegmentKind::side);
  add_stretch(c, 2, WallSegmentKind::courtyard);
  add_stretch(c, 3, WallSegmentKind::party_wall).neighbour = {model::OsmType::way, 2};
  c.situation.position = BuildingPosition::end_of_row;
  c.situation.fronts = {0};
  c.trees = {{{model::OsmType::node, 81}, {kRowX + 35, kRowY + 3}, 0, 5.0f},
             {{model::OsmType::node, 82}, {kRowX + 40, kRowY + 3}, 0, 5.0f}};

  model::Building& d = add_row_house(sample, 4, 30, 30, 12, 9);
  for (std::uint32_t i = 0; i < 4; ++i) add_stretch(d, i, WallSegmentKind::courtyard);
  d.arcs.push_back({0, 0, 2, 1, {kRowX + 36, kRowY + 39}, 6.25, true});
  d.edges[2].arc = 0;
  d.situation.position = BuildingPosition::rear_building;

  for (model::Building& each : sample.region().buildings) {
    each.situation.block = "w900.n5.l";
    each.situation.courtyards = {"w1.y7_8"};
    each.situation.depth = each.osm.number == 4 ? 9 : 14;
    each.situation.width = each.osm.number == 1 ? 12 : each.osm.number == 2 ? 18 : each.osm.number == 3 ? 15 : 12;
    if (!each.situation.fronts.empty()) each.situation.orientation = 180;
    for (const model::WallSegment& e : each.edges)
      if (e.kind == WallSegmentKind::party_wall) each.situation.party_wall_length += e.length();
  }
  return sample;
}

}  // namespace blockrand::outputs::test
