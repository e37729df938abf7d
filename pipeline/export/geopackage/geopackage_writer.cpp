#include "pipeline/export/geopackage/geopackage_writer.h"

#include <fcntl.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>

#include "pipeline/base/error.h"
#include "pipeline/export/geopackage/columns.h"
#include "pipeline/export/geopackage/gdal_scope.h"
#include "pipeline/export/geopackage/qgis_styles.h"
#include "pipeline/export/text.h"

namespace blockrand::export_ {
namespace {

/// "2024-05-01T00:00:00Z" as GeoPackage wants it, with milliseconds; the epoch where the data does not say.
std::string geopackage_time(const std::string& data_time) {
  constexpr std::string_view form = "dddd-dd-ddTdd:dd:ddZ";
  bool fits = data_time.size() == form.size();
  for (std::size_t i = 0; fits && i < form.size(); ++i)
    fits = form[i] == 'd' ? data_time[i] >= '0' && data_time[i] <= '9' : data_time[i] == form[i];
  return fits ? data_time.substr(0, 19) + ".000Z" : "1970-01-01T00:00:00.000Z";
}

/// What the system says to more bytes in `path`; SQLite only says "disk I/O error". 0 when they can be written.
int error_of_writing(const std::string& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
  if (file < 0) return errno;
  const std::vector<char> bytes(1 << 16);
  std::size_t written = 0;
  int error = 0;
  while (written < bytes.size() && error == 0) {
    const ssize_t n = ::write(file, bytes.data() + written, bytes.size() - written);
    if (n > 0)
      written += static_cast<std::size_t>(n);
    else if (errno != EINTR)
      error = errno;
  }
  if (error == 0 && ::fsync(file) != 0) error = errno;
  ::close(file);
  return error;
}

std::string remedy(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "The disk is full: free some space, or choose an output folder on another disk.";
    case EFBIG:
      return "The file is larger than the limit allows: raise it (ulimit -f), or choose another file system.";
    case EACCES:
    case EPERM:
    case EROFS:
      return "You may not write there: change the folder's permissions, or choose an output folder elsewhere.";
    default:
      return "Check the disk and the path, or choose an output folder on another disk.";
  }
}

std::string sql_text(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += c;
  }
  return out + "'";
}

constexpr std::string_view name(model::OsmType type) {
  return type == model::OsmType::node ? "node" : type == model::OsmType::way ? "way" : "relation";
}

struct DatasetCloser {
  void operator()(GDALDataset* dataset) const { GDALClose(GDALDataset::ToHandle(dataset)); }
};

}  // namespace

struct GeoPackageWriter::Impl {
  struct Layer {
    OGRLayer* layer = nullptr;
    std::unique_ptr<OGRFeature, OGRFeatureUniquePtrDeleter> feature;  // used again for every row
    std::vector<Column> columns;
  };

  std::string path;
  GeoPackageOptions options;
  std::unique_ptr<GDALDataset, DatasetCloser> dataset;
  Layer buildings, parts, reported, tiles, facade_edges, blocks, courtyards, cells;
  CellTable row;  // of add_block and its like, used again
  bool made = false, closed = false;

  /// In the order of the file.
  std::array<std::pair<const char*, Layer*>, 8> layers() {
    return {{{"buildings", &buildings},
             {"parts", &parts},
             {"facade_edges", &facade_edges},
             {"blocks", &blocks},
             {"courtyards", &courtyards},
             {"cells", &cells},
             {"reported", &reported},
             {"tiles", &tiles}}};
  }

  ~Impl() {
    if (closed) return;
    // What is left of a file that failed is of no use to anyone.
    const GdalScope scope(settings());
    for (const auto& [table, layer] : layers()) layer->feature.reset();
    if (dataset) dataset->RollbackTransaction();
    dataset.reset();
    if (made) std::remove(path.c_str());
  }

  [[noreturn]] void fail(const GdalScope& scope) const {
    const int error = error_of_writing(path);
    throw base::OutputError(
        path + ": cannot write: " + (scope.failed() ? scope.failure() : std::string("GDAL does not say why")) +
        (error != 0 ? " (" + std::string(std::strerror(error)) + ")" : "") + ". " + remedy(error));
  }
  void check(const GdalScope& scope, bool good) const {
    if (!good || scope.failed()) fail(scope);
  }

  /// What GDAL reads while it works for us.
  GdalScope::Options settings() const {
    return {
        // No clock in the file (last_change of gpkg_contents).
        {"OGR_CURRENT_DATE", geopackage_time(options.data_time)},
        // The file is new and is thrown away when anything fails: nothing to roll back to, nothing to wait for.
        {"OGR_SQLITE_SYNCHRONOUS", "OFF"},
        {"OGR_SQLITE_JOURNAL", "OFF"},
        {"OGR_SQLITE_PRAGMA", "cache_size=-32768,locking_mode=EXCLUSIVE"},
        // A second connection and a thread race with ours: the index is made at the end instead.
        {"OGR_GPKG_ALLOW_THREADED_RTREE", "NO"},
        // Settings of the user's environment that would change the bytes.
        {"SQLITE_USE_OGR_VFS", "NO"},
        {"GPKG_ADD_DEFINITION_12_063", "NO"},
        {"OSR_ADD_TOWGS84_ON_EXPORT_TO_WKT1", "NO"},
        {"OSR_ADD_TOWGS84_ON_IMPORT_FROM_EPSG", "NO"},
        {"OSR_STRIP_TOWGS84", "YES"},
        {"OSR_USE_NON_DEPRECATED", "YES"},
        {"OSR_WKT_FORMAT", "DEFAULT"},
    };
  }

  void sql(const GdalScope& scope, const std::string& statement) {
    OGRLayer* const result = dataset->ExecuteSQL(statement.c_str(), nullptr, nullptr);
    if (result != nullptr) dataset->ReleaseResultSet(result);
    check(scope, true);
  }

  Layer make_layer(const GdalScope& scope, const char* table, OGRwkbGeometryType type, std::vector<Column> columns,
                   const std::string& description, OGRSpatialReference& srs) {
    const std::string option = "DESCRIPTION=" + description;
    const std::array<const char*, 5> creation{"FID=fid", "GEOMETRY_NAME=geom", "SPATIAL_INDEX=NO", option.c_str(),
                                              nullptr};
    Layer l;
    l.layer = dataset->CreateLayer(table, &srs, type, const_cast<char**>(creation.data()));
    check(scope, l.layer != nullptr);
    for (const Column& c : columns) {
      OGRFieldDefn field(c.name.c_str(), c.kind == ColumnKind::integer ? OFTInteger64
                                         : c.kind == ColumnKind::real  ? OFTReal
                                                                       : OFTString);
      if (c.name == "tags") field.SetSubType(OFSTJSON);
      check(scope, l.layer->CreateField(&field) == OGRERR_NONE);
    }
    l.feature.reset(OGRFeature::CreateFeature(l.layer->GetLayerDefn()));
    check(scope, l.feature != nullptr);
    l.columns = std::move(columns);
    return l;
  }

  void describe_columns(const GdalScope& scope) {
    // GDAL made the table for the JSON columns; names stay NULL, since it declares them unique over all layers.
    sql(scope, "DELETE FROM gpkg_data_columns");
    for (const auto& [table, layer] : layers()) {
      std::string values;
      for (const Column& c : layer->columns) {
        values += (values.empty() ? "(" : ",(") + sql_text(table) + ',' + sql_text(c.name) + ",NULL," +
                  sql_text(c.unit.empty() ? c.name : c.name + " [" + c.unit + "]") + ',' +
                  sql_text(c.unit.empty() ? c.description : c.description + ". Unit: " + c.unit) + ',' +
                  (c.name == "tags" ? "'application/json'" : "NULL") + ",NULL)";
      }
      sql(scope,
          "INSERT INTO gpkg_data_columns (table_name, column_name, name, title, description, mime_type, "
          "constraint_name) VALUES " +
              values);
    }
  }

  template <class Row>
  void put_one(Layer& to, const Row& what) {
    const GdalScope scope(settings());
    row.cells.clear();
    row.texts.clear();
    row.geometries.clear();
    row.geometry_ends.clear();
    append_row(row, what);
    put(scope, to, row);
  }

  /// The table as QGIS makes it when it saves a style itself.
  void write_styles(const GdalScope& scope) {
    const std::array<const char*, 2> creation{"FID=id", nullptr};
    OGRLayer* const layer = dataset->CreateLayer("layer_styles", nullptr, wkbNone, const_cast<char**>(creation.data()));
    check(scope, layer != nullptr);
    const auto add = [&](const char* column, OGRFieldType type, int width = 0, OGRFieldSubType sub = OFSTNone) {
      OGRFieldDefn field(column, type);
      field.SetWidth(width);
      field.SetSubType(sub);
      check(scope, layer->CreateField(&field) == OGRERR_NONE);
    };
    add("f_table_catalog", OFTString, 256);
    add("f_table_schema", OFTString, 256);
    add("f_table_name", OFTString, 256);
    add("f_geometry_column", OFTString, 256);
    add("styleName", OFTString, 30);
    add("styleQML", OFTString);
    add("styleSLD", OFTString);
    add("useAsDefault", OFTInteger, 0, OFSTBoolean);
    add("description", OFTString);
    add("owner", OFTString, 30);
    add("ui", OFTString, 30);
    add("update_time", OFTDateTime);
    for (const QgisStyle& style : qgis_styles()) {
      OGRFeature feature(layer->GetLayerDefn());
      // QGIS looks for empty texts here, not for NULL.
      feature.SetField("f_table_catalog", "");
      feature.SetField("f_table_schema", "");
      feature.SetField("f_table_name", style.layer.c_str());
      feature.SetField("f_geometry_column", "geom");
      feature.SetField("styleName", style.name.c_str());
      feature.SetField("styleQML", style.qml.c_str());
      feature.SetField("styleSLD", "");
      feature.SetField("useAsDefault", style.is_default ? 1 : 0);
      feature.SetField("description", style.description.c_str());
      feature.SetField("owner", "");
      feature.SetField("update_time", geopackage_time(options.data_time).c_str());
      check(scope, layer->CreateFeature(&feature) == OGRERR_NONE);
    }
  }

  void create() {
    static std::once_flag registered;
    std::call_once(registered, [] { GDALAllRegister(); });
    const GdalScope scope(settings());
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored))
      throw base::OutputError(path + ": cannot write: the file is there already. Choose another output folder.");
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    if (driver == nullptr)
      throw base::OutputError(path +
                              ": cannot write: GDAL was built without GeoPackage. Install GDAL with SQLite, or leave "
                              "gpkg out of --formats.");
    made = true;
    const std::array<const char*, 2> creation{"VERSION=1.3", nullptr};
    dataset.reset(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, const_cast<char**>(creation.data())));
    check(scope, dataset != nullptr);
    OGRSpatialReference srs;
    check(scope, srs.SetFromUserInput(options.crs.c_str()) == OGRERR_NONE);
    srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    check(scope, dataset->StartTransaction() == OGRERR_NONE);
    const auto text = [&](std::string what) {
      if (!options.height_reference.empty()) what += "; heights: " + options.height_reference;
      if (!options.attribution.empty()) what += ". " + options.attribution;
      return what;
    };
    buildings = make_layer(scope, "buildings", wkbMultiPolygon, building_columns(),
                           text("Buildings with every attribute, its source and its confidence"), srs);
    parts = make_layer(scope, "parts", wkbPolygon, part_columns(), text("Bodies of the buildings"), srs);
    facade_edges = make_layer(scope, "facade_edges", wkbLineString, facade_edge_columns(),
                              text("Outlines of the buildings, cut where what they face changes"), srs);
    blocks = make_layer(scope, "blocks", wkbPolygon, block_columns(),
                        text("Land between streets, railways and water"), srs);
    courtyards = make_layer(scope, "courtyards", wkbPolygon, courtyard_columns(),
                            text("Open space that buildings surround"), srs);
    cells = make_layer(scope, "cells", wkbPolygon, cell_columns(),
                       text("Squares of a fixed grid with what is mapped in them"), srs);
    reported = make_layer(scope, "reported", wkbPoint, reported_columns(),
                          text("Mapped objects that are not modelled themselves, and why"), srs);
    tiles = make_layer(scope, "tiles", wkbPolygon, tile_columns(), text("Tiles with content"), srs);
    describe_columns(scope);
    write_styles(scope);
    check(scope, true);
  }

  void put(const GdalScope& scope, Layer& to, const CellTable& rows) {
    OGRFeature& feature = *to.feature;
    const Cell* cell = rows.cells.data();
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      feature.SetFID(OGRNullFID);
      for (int i = 0; i < static_cast<int>(rows.width); ++i, ++cell) {
        switch (cell->kind) {
          case Cell::Kind::null:
            feature.SetFieldNull(i);
            break;
          case Cell::Kind::integer:
            feature.SetField(i, static_cast<GIntBig>(cell->integer));
            break;
          case Cell::Kind::real:
            feature.SetField(i, cell->real);
            break;
          case Cell::Kind::text:
            feature.SetField(i, rows.texts.c_str() + cell->text);
            break;
        }
      }
      const std::string_view wkb = rows.geometry(row);
      OGRGeometry* geometry = nullptr;
      const OGRErr read = OGRGeometryFactory::createFromWkb(wkb.data(), nullptr, &geometry, wkb.size());
      feature.SetGeometryDirectly(geometry);
      check(scope, read == OGRERR_NONE && to.layer->CreateFeature(&feature) == OGRERR_NONE);
    }
  }
};

GeoPackageWriter::GeoPackageWriter(std::string path, GeoPackageOptions options) : impl_(std::make_unique<Impl>()) {
  impl_->path = std::move(path);
  impl_->options = std::move(options);
  impl_->create();
}

GeoPackageWriter::~GeoPackageWriter() = default;

void GeoPackageWriter::add(const GeoPackageRows& rows) {
  const GdalScope scope(impl_->settings());
  impl_->put(scope, impl_->buildings, rows.buildings);
  impl_->put(scope, impl_->parts, rows.parts);
  impl_->put(scope, impl_->facade_edges, rows.facade_edges);
}

void GeoPackageWriter::add_block(const BlockRow& block) { impl_->put_one(impl_->blocks, block); }
void GeoPackageWriter::add_courtyard(const CourtyardRow& courtyard) { impl_->put_one(impl_->courtyards, courtyard); }
void GeoPackageWriter::add_cell(const CellRow& cell) { impl_->put_one(impl_->cells, cell); }

void GeoPackageWriter::add_reported(const GeoPackageReported& object) {
  const GdalScope scope(impl_->settings());
  OGRFeature& f = *impl_->reported.feature;
  f.SetFID(OGRNullFID);
  int i = 0;
  std::string clean;
  const auto text = [&](std::string_view value) {
    clean.clear();
    append_clean(clean, value);
    if (clean.empty())
      f.SetFieldNull(i++);
    else
      f.SetField(i++, clean.c_str());
  };
  text(object.id.text());
  text(name(object.id.type));
  f.SetField(i++, static_cast<GIntBig>(object.id.number));
  text(object.kind == model::ObjectKind::building ? "building" : "building_part");
  text(model::name(object.state));
  const bool coded = object.code != model::IssueCode::none;
  text(coded ? info(object.code).text : std::string_view());
  text(coded ? info(object.code).meaning : std::string_view());
  text(object.detail);
  text(object.related ? object.related->text() : std::string());
  f.SetGeometryDirectly(object.place ? new OGRPoint(object.place->x, object.place->y) : nullptr);
  impl_->check(scope, impl_->reported.layer->CreateFeature(&f) == OGRERR_NONE);
}

void GeoPackageWriter::add_tile(const GeoPackageTile& tile) {
  const GdalScope scope(impl_->settings());
  OGRFeature& f = *impl_->tiles.feature;
  f.SetFID(OGRNullFID);
  int i = 0;
  const std::string id =
      std::to_string(tile.id.level) + '/' + std::to_string(tile.id.x) + '/' + std::to_string(tile.id.y);
  f.SetField(i++, id.c_str());
  for (const std::int64_t number : {std::int64_t{tile.id.level}, std::int64_t{tile.id.x}, std::int64_t{tile.id.y}})
    f.SetField(i++, static_cast<GIntBig>(number));
  if (tile.uri.empty())
    f.SetFieldNull(i++);
  else
    f.SetField(i++, tile.uri.c_str());
  for (const std::uint64_t number : {tile.buildings, tile.parts, tile.bytes})
    f.SetField(i++, static_cast<GIntBig>(number));
  auto ring = std::make_unique<OGRLinearRing>();
  for (const model::Point2 p : tile.outline) ring->addPoint(p.x, p.y);
  ring->closeRings();
  auto polygon = std::make_unique<OGRPolygon>();
  polygon->addRingDirectly(ring.release());
  f.SetGeometryDirectly(polygon.release());
  impl_->check(scope, impl_->tiles.layer->CreateFeature(&f) == OGRERR_NONE);
}

void GeoPackageWriter::close() {
  Impl& impl = *impl_;
  const GdalScope scope(impl.settings());
  for (const auto& [name, l] : impl.layers()) {
    l->feature.reset();
    impl.check(scope, l->layer->SyncToDisk() == OGRERR_NONE);
    // The index in one go over finished rows: its pages lie together, and no trigger runs for each insert.
    const std::string table = sql_text(name);
    impl.sql(scope, "SELECT CreateSpatialIndex(" + table + ", 'geom')");
    // What readers take for the number of rows; GDAL leaves it open for layers that were filled beside others.
    impl.sql(scope, "UPDATE gpkg_ogr_contents SET feature_count = (SELECT count(*) FROM \"" +
                        std::string(name) + "\") WHERE table_name = " + table);
  }
  impl.check(scope, impl.dataset->CommitTransaction() == OGRERR_NONE);
  impl.dataset.reset();
  impl.check(scope, true);
  impl.closed = true;
}

}  // namespace blockrand::export_
