#include "pipeline/outputs/geopackage/wall_segment_rows.h"

#include <algorithm>

#include "pipeline/outputs/wall_segment_ids.h"

namespace blockrand::outputs {
namespace {

/// 0 stands for "not known" in ids of the model.
void write_id(RowWriter& row, model::OsmId id) { row.text(id.number != 0 ? id.text() : std::string()); }

void write_points(RowWriter& row, const std::vector<model::WallPoint>& points) {
  std::vector<std::string> numbers;
  std::string ids;
  for (const model::WallPoint& point : points) {
    ids += (ids.empty() ? "" : " ") + point.id.text();
    if (!point.house_number.empty() && std::find(numbers.begin(), numbers.end(), point.house_number) == numbers.end())
      numbers.push_back(point.house_number);
  }
  std::string text;
  for (const std::string& number : numbers) text += (text.empty() ? "" : "; ") + number;
  row.text(text);
  row.text(ids);
}

void write_node(RowWriter& row, std::int64_t node) {
  if (node != 0)
    row.integer(node);
  else
    row.null();
}

}  // namespace

void append_edges(RowWriter& row, const model::Building& building) {
  const std::string id = building.id();
  const std::vector<std::uint32_t>& fronts = building.situation.fronts;
  for (const IdentifiedWallSegment& wall_segment : wall_segments(building)) {
    const model::WallSegment& e = building.edges[wall_segment.index];
    const bool has_street = e.street.number != 0;
    const bool has_arc = e.arc >= 0 && static_cast<std::size_t>(e.arc) < building.arcs.size();
    row.text(wall_segment.id);
    row.text(id);
    row.text(model::name(e.kind));
    row.real(as_written(e.confidence));
    row.real(rounded(e.length()));
    row.real(rounded_direction(outward(wall_segment.from, wall_segment.to)));
    row.flag(std::find(fronts.begin(), fronts.end(), wall_segment.index) != fronts.end());
    write_id(row, e.neighbour);
    row.real(e.covered_height > 0 ? std::optional(rounded(e.covered_height)) : std::nullopt);
    write_id(row, e.street);
    row.text(e.street_name);
    row.text(e.street_class);
    row.real(has_street ? std::optional(rounded(e.street_distance)) : std::nullopt);
    row.real(has_street ? std::optional(rounded_degrees(e.street_angle)) : std::nullopt);
    row.real(rounded(e.visibility));
    row.flag(e.corner_start);
    row.flag(e.corner_end);
    row.flag(e.chamfer);
    row.integer(e.entrances);
    write_points(row, e.points);
    row.integer(std::count_if(building.trees.begin(), building.trees.end(),
                              [&](const model::NearTree& tree) { return tree.edge == wall_segment.index; }));
    if (has_arc) {
      const model::Arc& arc = building.arcs[static_cast<std::size_t>(e.arc)];
      row.real(rounded(arc.radius));
      row.text(arc.convex ? "outward" : "inward");
    } else {
      row.null();
      row.null();
    }
    write_node(row, e.from_node);
    write_node(row, e.to_node);
    append_line(row.geometry(), wall_segment.from, wall_segment.to);
    row.end_row();
  }
}

void write_situation(RowWriter& row, const model::Building& building) {
  const model::BuildingSituation& s = building.situation;
  const bool known = s.position != model::BuildingPosition::unknown;
  row.text(model::name(s.position));
  row.real(s.orientation ? std::optional(rounded_direction(*s.orientation)) : std::nullopt);
  for (const std::optional<double>& length : {s.depth, s.width, s.setback}) row.real(rounded(length));
  row.real(known ? std::optional(rounded(s.party_wall_length)) : std::nullopt);
  row.text(s.block);
  std::string courtyards;
  for (const std::string& id : s.courtyards) courtyards += (courtyards.empty() ? "" : " ") + id;
  row.text(courtyards);
}

void write_repair(RowWriter& row, const model::RepairRecord& r) {
  if (r.vertices == 0) {
    for (int i = 0; i < 9; ++i) row.null();
    return;
  }
  row.integer(r.moved);
  row.real(rounded(r.mean_shift));
  row.real(rounded(r.max_shift));
  row.real(rounded(r.mapped_area));
  row.integer(r.shared_walls);
  row.integer(r.gaps_closed);
  row.integer(r.overlaps_resolved);
  row.real(rounded(r.overlap_left));
  row.real(r.direction >= 0 ? std::optional(rounded_direction(r.direction)) : std::nullopt);
}

}  // namespace blockrand::outputs
