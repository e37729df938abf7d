// compare.gpkg: footprints with what was measured, for a GIS.
#include <span>
#include <vector>

#include "pipeline/compare/comparison_report.h"
#include "pipeline/compare/report_numbers.h"
#include "pipeline/compare/report_places.h"
#include "pipeline/layer_file/layer_file.h"
#include "pipeline/layer_file/well_known_binary.h"

namespace blockrand::compare {
namespace {

using layer_file::CellTable;
using layer_file::Column;
using layer_file::ColumnKind;
using layer_file::GeometryKind;
using layer_file::RowWriter;

std::vector<Column> match_columns() {
  std::vector<Column> columns{
      {"id", ColumnKind::text, "", "Of the match: its first building's in the reference"},
      {"reference_buildings", ColumnKind::text, "", "Ids of the reference's buildings"},
      {"model_buildings", ColumnKind::text, "", "Ids of the model's buildings"},
      {"reference_roof", ColumnKind::text, "", "Form of the reference's roof as its planes show it"},
      {"model_roof", ColumnKind::text, "", "Form of the model's roof as its planes show it"},
      {"left_out_surface", ColumnKind::real, "",
       "Share of the reference's surface that is left out of what is counted"}};
  for (const MeasureInfo& measure : kMeasures) {
    const std::string id(measure.id), unit(measure.unit == "1" ? "" : measure.unit == "deg" ? "degree" : measure.unit);
    columns.push_back({id, ColumnKind::real, unit,
                       std::string(measure.title) + ", without what is left out: " + std::string(measure.text)});
    columns.push_back({id + "_all", ColumnKind::real, unit, std::string(measure.title) + ", with what is left out"});
  }
  return columns;
}

std::vector<Column> building_columns() {
  return {{"id", ColumnKind::text, "", "As the file has it"},
          {"state", ColumnKind::text, "", "matched, missing (from the model) or extra (only in the model)"},
          {"match", ColumnKind::text, "", "Id of the match"},
          {"file", ColumnKind::text, "", "Where it was read"},
          {"lod", ColumnKind::integer, "", "Level of detail that was taken"},
          {"footprint_area", ColumnKind::real, "m²", "Area of the footprint"}};
}

/// In the CRS, outer rings counter-clockwise. NULL where there is no footprint.
void append_footprints(std::string& out, const City& city, std::span<const std::uint32_t> buildings) {
  std::vector<model::Polygon> polygons;
  for (const std::uint32_t b : buildings)
    for (model::Polygon polygon : city.buildings[b].footprint) {
      if (polygon.outer.points.size() < 3) continue;
      const auto place = [&](model::Ring& ring) {
        for (Point2& p : ring.points) p = {p.x + city.origin.x, p.y + city.origin.y};
      };
      place(polygon.outer);
      for (model::Ring& hole : polygon.holes) place(hole);
      polygons.push_back(std::move(polygon));
    }
  if (!polygons.empty()) layer_file::append_multi_polygon(out, polygons);
}

CellTable match_rows(const Comparison& c, std::size_t width) {
  CellTable table;
  RowWriter row(table, width);
  for (const MatchResult& match : c.matches) {
    row.text(match.id);
    row.text(ids_of(c.reference, match.reference.buildings));
    row.text(ids_of(c.model, match.model.buildings));
    row.text(name_of(match.reference.roof_form));
    row.text(name_of(match.model.roof_form));
    row.real(finite(value_of(match.values, Measure::distance_rms).left_out));
    for (const MeasureValue& value : match.values) {
      row.real(finite(value.counted));
      row.real(finite(value.all));
    }
    append_footprints(row.geometry(), c.reference, match.reference.buildings);
    row.end_row();
  }
  return table;
}

/// \param left  the buildings without a match, \param state  what they are called
CellTable building_rows(const Comparison& c, bool model, const std::vector<std::uint32_t>& left, std::string_view state,
                        std::size_t width) {
  const City& city = model ? c.model : c.reference;
  std::vector<const MatchResult*> match_of(city.buildings.size(), nullptr);
  for (const MatchResult& match : c.matches)
    for (const std::uint32_t b : (model ? match.model : match.reference).buildings) match_of.at(b) = &match;
  std::vector<bool> is_left(city.buildings.size(), false);
  for (const std::uint32_t b : left) is_left.at(b) = true;
  CellTable table;
  RowWriter row(table, width);
  for (std::uint32_t b = 0; b < city.buildings.size(); ++b) {
    const Building& building = city.buildings[b];
    row.text(building.id);
    row.text(match_of[b] != nullptr ? "matched" : is_left[b] ? state : "");
    row.text(match_of[b] != nullptr ? match_of[b]->id : "");
    row.text(building.file < city.files.size() ? city.files[building.file].path : "");
    row.integer(building.lod);
    row.real(finite(building.footprint_area));
    append_footprints(row.geometry(), city, std::span(&b, 1));
    row.end_row();
  }
  return table;
}

}  // namespace

void write_geopackage(const Comparison& c, const std::string& path) {
  const std::vector<Column> match = match_columns(), building = building_columns();
  const std::string heights = ". Heights compared " + std::string(heights_text(c));
  const auto by = [](const City& city) { return city.attribution.empty() ? "" : ". " + city.attribution; };
  const std::string both = by(c.reference) == by(c.model) ? by(c.model) : by(c.reference) + by(c.model);
  layer_file::LayerFile file(
      path, {c.reference.crs.empty() ? c.model.crs : c.reference.crs, ""},
      {{"matches", GeometryKind::multi_polygon, match,
        "Buildings that stand for each other: the reference's footprints with every measure" + heights + both},
       {"model", GeometryKind::multi_polygon, building, "The model's footprints and what became of them" + by(c.model)},
       {"reference", GeometryKind::multi_polygon, building,
        "The reference's footprints and what became of them" + by(c.reference)}});
  file.put(0, match_rows(c, match.size()));
  file.put(1, building_rows(c, true, c.extra, "extra", building.size()));
  file.put(2, building_rows(c, false, c.missing, "missing", building.size()));
  file.close();
}

}  // namespace blockrand::compare
