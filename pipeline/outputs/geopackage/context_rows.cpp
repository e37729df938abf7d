#include "pipeline/outputs/geopackage/context_rows.h"

#include "pipeline/outputs/geopackage/cell_writer.h"
#include "pipeline/outputs/geopackage/columns.h"

namespace blockrand::outputs {
namespace {

model::Polygon square(model::Point2 corner, double size) {
  model::Polygon p;
  p.outer.points = {
      corner, {corner.x + size, corner.y}, {corner.x + size, corner.y + size}, {corner.x, corner.y + size}};
  p.outer.nodes.assign(4, 0);
  return p;
}

/// Shares to a ten-thousandth.
double share(double value) { return std::nearbyint(value * 10000) / 10000; }
std::optional<double> share(const std::optional<double>& value) {
  return value ? std::optional(share(*value)) : std::nullopt;
}

}  // namespace

void append_row(CellTable& table, const BlockRow& b) {
  static const std::size_t width = block_columns().size();
  RowWriter row(table, width);
  row.text(b.id);
  row.text(b.kind);
  row.real(rounded(b.area));
  row.flag(b.cut_by_extract_edge);
  row.flag(b.too_large);
  row.integer(b.buildings);
  for (const auto& value : {b.built_share, b.tagged_share, b.floor_area_ratio, b.closure}) row.real(share(value));
  row.real(rounded(b.front_length));
  row.real(rounded(b.courtyard_area));
  row.integer(b.courtyards);
  std::string streets;
  for (const std::string& street : b.streets) streets += (streets.empty() ? "" : "; ") + street;
  row.text(streets);
  append_polygon(row.geometry(), b.polygon);
  row.end_row();
}

void append_row(CellTable& table, const FootprintBeforeRow& f) {
  static const std::size_t width = footprint_before_columns().size();
  const observation::OutlineReceipt& r = f.seen.receipt;
  const importers::imagery::ImageSource& source = f.seen.image.description.source;
  RowWriter row(table, width);
  row.text(f.id.text());
  row.text(f.seen.state());
  row.text(r.reason);
  row.real(rounded(std::sqrt(r.shift.x * r.shift.x + r.shift.y * r.shift.y)));
  for (const double value : {r.shift.x, r.shift.y, r.turn}) row.real(rounded(value));
  for (const double value : {r.before, r.after, r.after - r.before, r.confidence}) row.real(share(value));
  row.integer(r.refined.walls);
  row.real(rounded(r.refined.largest));
  row.text(r.refined.reason);
  for (const double value : {r.refined.before, r.refined.after, r.refined.confidence, r.gone}) row.real(share(value));
  row.real(rounded(std::sqrt(r.lean.x * r.lean.x + r.lean.y * r.lean.y)));
  row.text(source.path.substr(source.path.find_last_of('/') + 1));
  row.text(source.date);
  row.text(source.licence);
  append_header(row.geometry(), kMultiPolygon, f.polygons.size());
  for (const model::Polygon& p : f.polygons) append_polygon(row.geometry(), p);
  row.end_row();
}

void append_row(CellTable& table, const UnmappedRow& u) {
  static const std::size_t width = unmapped_columns().size();
  const observation::UnmappedBuilding& c = u.candidate;
  const importers::imagery::ImageSource& source = u.image.description.source;
  RowWriter row(table, width);
  row.text(c.id);
  row.real(share(c.probability));
  row.real(rounded(c.area));
  row.text(c.of_roof ? "roof" : "ground");
  row.real(rounded(std::sqrt(c.lean.x * c.lean.x + c.lean.y * c.lean.y)));
  row.text(source.path.substr(source.path.find_last_of('/') + 1));
  row.text(source.date);
  row.text(source.licence);
  model::Polygon polygon;
  polygon.outer.points = c.outline;
  polygon.outer.nodes.assign(c.outline.size(), 0);
  append_polygon(row.geometry(), polygon);
  row.end_row();
}

void append_row(CellTable& table, const CourtyardRow& c) {
  static const std::size_t width = courtyard_columns().size();
  RowWriter row(table, width);
  row.text(c.id);
  row.text(c.block);
  row.real(rounded(c.area));
  row.flag(c.closed);
  row.real(rounded(c.opening));
  row.integer(static_cast<std::int64_t>(c.buildings.size()));
  std::string ids;
  for (const model::OsmId id : c.buildings) ids += (ids.empty() ? "" : " ") + id.text();
  row.text(ids);
  append_polygon(row.geometry(), c.polygon);
  row.end_row();
}

void append_row(CellTable& table, const CellRow& c) {
  static const std::size_t width = cell_columns().size();
  RowWriter row(table, width);
  row.text(c.id);
  row.real(c.size);
  row.integer(c.buildings);
  row.real(share(c.covered_share));
  row.real(share(c.density));
  row.real(share(c.built_share));
  row.real(share(c.tagged_share));
  row.real(share(c.storeys_mean));
  row.real(share(c.storeys_spread));
  row.real(share(c.floor_area_ratio));
  row.real(share(c.party_wall_share));
  row.real(share(c.dated_share));
  row.real(share(c.year_mean));
  row.real(share(c.year_spread));
  for (const auto& area : {c.footprint_quartile, c.footprint_median, c.footprint_upper_quartile})
    row.real(rounded(area));
  append_polygon(row.geometry(), square(c.corner, c.size));
  row.end_row();
}

}  // namespace blockrand::outputs
