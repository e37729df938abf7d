#include "pipeline/outputs/geopackage/geopackage_writer.h"

#include "pipeline/layer_file/layer_file.h"
#include "pipeline/layer_file/well_known_binary.h"
#include "pipeline/outputs/geopackage/cell_writer.h"
#include "pipeline/outputs/geopackage/columns.h"
#include "pipeline/outputs/geopackage/qgis_styles.h"

namespace blockrand::outputs {
namespace {

using layer_file::GeometryKind;

constexpr std::string_view name(model::OsmType type) {
  return type == model::OsmType::node ? "node" : type == model::OsmType::way ? "way" : "relation";
}

/// In the order of layers().
enum LayerIndex : std::size_t {
  kBuildings,
  kParts,
  kFacadeEdges,
  kBlocks,
  kCourtyards,
  kCells,
  kReported,
  kTiles,
  kSurfaces,
  kFootprintBefore,
  kUnmapped
};

std::vector<layer_file::LayerSpec> layers(const GeoPackageOptions& options) {
  const auto text = [&](std::string what) {
    if (!options.height_reference.empty()) what += "; heights: " + options.height_reference;
    if (!options.attribution.empty()) what += ". " + options.attribution;
    return what;
  };
  std::vector<layer_file::LayerSpec> all = {
      {"buildings", GeometryKind::multi_polygon, building_columns(),
       text("Buildings with every attribute, its source and its confidence")},
      {"parts", GeometryKind::polygon, part_columns(), text("Bodies of the buildings")},
      {"facade_edges", GeometryKind::line, wall_segment_columns(),
       text("Outlines of the buildings, cut where what they face changes")},
      {"blocks", GeometryKind::polygon, block_columns(), text("Land between streets, railways and water")},
      {"courtyards", GeometryKind::polygon, courtyard_columns(), text("Open space that buildings surround")},
      {"cells", GeometryKind::polygon, cell_columns(), text("Squares of a fixed grid with what is mapped in them")},
      {"reported", GeometryKind::point, reported_columns(),
       text("Mapped objects that are not modelled themselves, and why")},
      {"tiles", GeometryKind::polygon, tile_columns(), text("Tiles with content")},
      {"surfaces", GeometryKind::multi_polygon_z, surface_columns(),
       text("Faces of the bodies in space, by class and colour")}};
  if (options.images) {
    all.push_back(
        {"footprint_before", GeometryKind::multi_polygon, footprint_before_columns(),
         text("Outlines that an aerial image shows, those it moved as they stood before, and what it says of them")});
    all.push_back({"unmapped", GeometryKind::polygon, unmapped_columns(),
                   text("Candidates: what looks like a building in an aerial image where none is mapped")});
  }
  if (options.surroundings)
    for (layer_file::LayerSpec& layer : surrounding_layers()) {
      layer.description = text(std::move(layer.description));
      all.push_back(std::move(layer));
    }
  return all;
}

std::vector<QgisStyle> styles(const GeoPackageOptions& options) {
  std::vector<QgisStyle> all = qgis_styles(options.images);
  if (options.surroundings)
    for (QgisStyle& style : surrounding_styles()) all.push_back(std::move(style));
  return all;
}

}  // namespace

struct GeoPackageWriter::Impl {
  layer_file::LayerFile file;
  CellTable row;                 // of add_block and its like, used again
  std::size_t surroundings = 0;  // the first of their layers; 0: there are none

  CellTable& empty_row() {
    row.cells.clear();
    row.texts.clear();
    row.geometries.clear();
    row.geometry_ends.clear();
    return row;
  }
  template <class Row>
  void put_one(std::size_t layer, const Row& what) {
    append_row(empty_row(), what);
    file.put(layer, row);
  }
};

GeoPackageWriter::GeoPackageWriter(std::string path, GeoPackageOptions options)
    : impl_(new Impl{{std::move(path), {options.crs, options.data_time}, layers(options), styles(options)}, {}}) {
  if (options.surroundings) impl_->surroundings = options.images ? kUnmapped + 1 : kFootprintBefore;
}

GeoPackageWriter::~GeoPackageWriter() = default;

void GeoPackageWriter::add(const GeoPackageRows& rows) {
  impl_->file.put(kBuildings, rows.buildings);
  impl_->file.put(kParts, rows.parts);
  impl_->file.put(kFacadeEdges, rows.wall_segments);
  impl_->file.put(kSurfaces, rows.surfaces);
}

void GeoPackageWriter::add(const SurroundingRows& rows) {
  if (impl_->surroundings == 0) return;
  impl_->file.put(impl_->surroundings, rows.ground);
  impl_->file.put(impl_->surroundings + 1, rows.bodies);
  impl_->file.put(impl_->surroundings + 2, rows.objects);
}

void GeoPackageWriter::add_block(const BlockRow& block) { impl_->put_one(kBlocks, block); }
void GeoPackageWriter::add_courtyard(const CourtyardRow& courtyard) { impl_->put_one(kCourtyards, courtyard); }
void GeoPackageWriter::add_cell(const CellRow& cell) { impl_->put_one(kCells, cell); }

void GeoPackageWriter::add_footprint_before(const FootprintBeforeRow& row) { impl_->put_one(kFootprintBefore, row); }

void GeoPackageWriter::add_unmapped(const UnmappedRow& row) { impl_->put_one(kUnmapped, row); }

void GeoPackageWriter::add_reported(const GeoPackageReported& object) {
  CellTable& table = impl_->empty_row();
  RowWriter row(table, reported_columns().size());
  row.text(object.id.text());
  row.text(name(object.id.type));
  row.integer(static_cast<std::int64_t>(object.id.number));
  row.text(object.kind == model::ObjectKind::building ? "building" : "building_part");
  row.text(model::name(object.state));
  const bool coded = object.code != model::IssueCode::none;
  row.text(coded ? info(object.code).text : std::string_view());
  row.text(coded ? info(object.code).meaning : std::string_view());
  row.text(object.detail);
  row.text(object.related ? object.related->text() : std::string());
  if (object.place) layer_file::append_point(row.geometry(), *object.place);
  row.end_row();
  impl_->file.put(kReported, table);
}

void GeoPackageWriter::add_tile(const GeoPackageTile& tile) {
  CellTable& table = impl_->empty_row();
  RowWriter row(table, tile_columns().size());
  row.text(std::to_string(tile.id.level) + '/' + std::to_string(tile.id.x) + '/' + std::to_string(tile.id.y));
  for (const std::int64_t number : {std::int64_t{tile.id.level}, std::int64_t{tile.id.x}, std::int64_t{tile.id.y}})
    row.integer(number);
  row.text(tile.uri);
  for (const std::uint64_t number : {tile.buildings, tile.parts, tile.bytes})
    row.integer(static_cast<std::int64_t>(number));
  model::Polygon outline;
  outline.outer.points = tile.outline;
  append_polygon(row.geometry(), outline);
  row.end_row();
  impl_->file.put(kTiles, table);
}

void GeoPackageWriter::close() { impl_->file.close(); }

}  // namespace blockrand::outputs
