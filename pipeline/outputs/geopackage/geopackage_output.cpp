#include "pipeline/outputs/geopackage/geopackage_output.h"

#include <cmath>
#include <map>

#include "pipeline/footprints/area.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/outputs/geopackage/context_layers.h"
#include "pipeline/outputs/geopackage/geopackage_writer.h"
#include "pipeline/outputs/geopackage/qgis_project.h"
#include "pipeline/outputs/zip_file.h"

namespace blockrand::outputs {
namespace {

constexpr const char* kFile = "buildings.gpkg";
constexpr const char* kProject = "buildings.qgz";

struct TileProduct {
  GeoPackageRows rows;
  geometry::PlanBox box;  ///< of the buildings
  SurroundingRows surroundings;
};

geometry::PlanBox box_of(const model::Region& region) {
  geometry::PlanBox box;
  for (const model::Building& b : region.buildings) {
    if (!b.owned) continue;
    for (const model::Polygon& p : b.outline) box.include(geometry::box_of(p.outer.points));
    for (const model::BuildingPart& part : b.parts) box.include(geometry::box_of(part.plan.outer.points));
  }
  return box;
}

std::string words_about_data(const OutputContext& context) {
  std::string words = attribution(context);
  if (!context.data_time.empty()) words += ", data of " + std::string(context.data_time);
  if (!context.heights.words.empty()) words += ". Heights: " + context.heights.words;
  return words;
}

/// A tile as a row; its outline follows the tile's meridians and parallels.
GeoPackageTile tile_row(model::TileId id, const GeoPackageRows& rows, std::span<const base::PublishedFile> files,
                        const georef::Projection& projection) {
  GeoPackageTile tile;
  tile.id = id;
  tile.buildings = rows.buildings.rows();
  tile.parts = rows.parts.rows();
  // Of a tile in pieces the first one, and the bytes of all.
  const std::string glb = tile_glb_path(id), piece = glb.substr(0, glb.size() - std::string_view(".glb").size()) + "_q";
  for (const base::PublishedFile& file : files)
    if (file.path == glb || file.path.starts_with(piece)) {
      if (tile.uri.empty()) tile.uri = file.path;
      tile.bytes += file.bytes;
    }
  const georef::GeoBox box = georef::bounds(id);
  // Straight lines between the corners of a tile lie within millimetres of its meridians and parallels.
  for (const georef::LonLat corner : {georef::LonLat{box.west, box.south}, georef::LonLat{box.east, box.south},
                                      georef::LonLat{box.east, box.north}, georef::LonLat{box.west, box.north}})
    tile.outline.push_back(model::snap(projection.forward(corner.lon, corner.lat)));
  return tile;
}

std::optional<model::Point2> place_of(const model::Extract& extract, const model::MappedBuilding& b,
                                      const georef::Projection& projection) {
  const std::optional<model::Location> place = b.rings.count > 0 ? footprints::box_centre(extract, b) : b.place;
  if (!place) return std::nullopt;
  const model::Point2 p = projection.forward(*place);
  if (!std::isfinite(p.x) || !std::isfinite(p.y)) return std::nullopt;
  return model::snap(p);
}

/// What the importer or the tiles said about objects that end as reported.
using ReportedDetails = std::map<std::pair<model::OsmId, model::IssueCode>, std::string>;
ReportedDetails reported_details(const std::vector<model::ReportRow>& rows) {
  ReportedDetails details;
  for (const model::ReportRow& row : rows)
    if (info(row.code).issue_class == model::IssueClass::reported)
      details.emplace(std::pair(row.object, row.code), row.detail);
  return details;
}

void add_reported(GeoPackageWriter& out, const model::Extract& extract, const std::vector<model::ReportRow>& rows,
                  const georef::Projection& projection) {
  const ReportedDetails details = reported_details(rows);
  for (const model::MappedBuilding& b : extract.buildings) {
    if (b.state == model::ObjectState::modelled) continue;
    GeoPackageReported object;
    object.id = b.id;
    object.kind = b.kind;
    object.state = b.state;
    object.code = b.code;
    if (const auto found = details.find({b.id, b.code}); found != details.end()) object.detail = found->second;
    if (b.state != model::ObjectState::reported) object.related = b.related;
    object.place = place_of(extract, b, projection);
    out.add_reported(object);
  }
}

class GeoPackageOutput : public OutputOf<TileProduct> {
 public:
  explicit GeoPackageOutput(const OutputContext& context)
      : context_(context),
        writer_(
            context.folder.staging_path() + "/" + kFile,
            {context.crs.authority_code, std::string(context.data_time), context.heights.words, attribution(context),
             context.imagery && !context.imagery->outlines.empty(), context.surroundings != nullptr}) {}

  std::any write_tile(FinishedTile& tile) const override {
    return TileProduct{geopackage_rows(tile.region, context_.lod), box_of(tile.region),
                       has_surroundings(tile, context_) ? surrounding_rows(*tile.surroundings, *context_.surroundings)
                                                        : SurroundingRows()};
  }
  void take(const FinishedTile& tile, std::any product) override {
    const auto& [rows, box, surroundings] = *std::any_cast<TileProduct>(&product);
    if (!surroundings.empty()) writer_.add(surroundings);
    if (rows.buildings.rows() == 0) return;
    extent_.include(box);
    writer_.add(rows);
    writer_.add_tile(tile_row(context_.shards[tile.shard].tile, rows, tile.files, context_.projection));
  }
  void finish(const FinishedBuild& build) override {
    add_reported(writer_, context_.extract, build.rows, context_.projection);
    write_context_layers(writer_, context_.context, context_.repaired, context_.shards, context_.alone,
                         context_.projection);
    if (context_.imagery)
      write_image_layer(writer_, *context_.imagery, context_.repaired, context_.shards, context_.alone);
    writer_.close();
    build.files.push_back(context_.folder.adopt(kFile));
    const std::string project =
        qgis_project({context_.crs.authority_code, context_.crs.name, extent_, words_about_data(context_)});
    build.files.push_back(context_.folder.write(kProject, zip_file("buildings.qgs", project)));
  }

 private:
  const OutputContext& context_;
  GeoPackageWriter writer_;
  geometry::PlanBox extent_;  ///< of all buildings so far
};

}  // namespace

OutputFormat geopackage_output() {
  return {
      .name = "gpkg",
      .title = "GeoPackage",
      .other_names = {"geopackage"},
      .places = {{kFile, "footprints with every value and its source, for any GIS"},
                 {kProject, "the same as a map: open it in QGIS"}},
      .manual = {{kFile, "GeoPackage: footprints with every attribute, its source and its confidence"},
                 {kProject, "QGIS project of the GeoPackage: its layers in order, coloured and labelled"}},
      .asked = [](const OutputOptions& o) { return o.writes("gpkg"); },
      .size = [](const OutputOptions&,
                 std::size_t) { return OutputSize{.once = 600'000, .per_building = 6800, .memory = 15e6}; },
      .open = [](const OutputContext& c) -> std::unique_ptr<Output> { return std::make_unique<GeoPackageOutput>(c); }};
}

}  // namespace blockrand::outputs
