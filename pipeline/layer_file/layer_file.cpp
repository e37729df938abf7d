#include "pipeline/layer_file/layer_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <type_traits>

#include "pipeline/base/error.h"
#include "pipeline/gdal/gdal_scope.h"

namespace blockrand::layer_file {
namespace {

using gdal::api;
using gdal::GdalScope;

struct DestroyFeature {
  void operator()(OGRFeatureH feature) const { api().OGR_F_Destroy(feature); }
};
struct DestroyField {
  void operator()(OGRFieldDefnH field) const { api().OGR_Fld_Destroy(field); }
};
struct DestroyReference {
  void operator()(OGRSpatialReferenceH reference) const { api().OSRDestroySpatialReference(reference); }
};
using Feature = std::unique_ptr<std::remove_pointer_t<OGRFeatureH>, DestroyFeature>;
using Field = std::unique_ptr<std::remove_pointer_t<OGRFieldDefnH>, DestroyField>;

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

constexpr std::array<OGRwkbGeometryType, 5> kTypes{wkbPoint, wkbLineString, wkbPolygon, wkbMultiPolygon,
                                                   wkbMultiPolygon25D};

/// Text that holds a JSON object.
bool is_json(const Column& column) { return column.name == "tags"; }

}  // namespace

struct LayerFile::Impl {
  struct Layer {
    std::string table;
    OGRLayerH layer = nullptr;
    Feature feature;  // used again for every row
    std::vector<Column> columns;
  };

  std::string path;
  FileOptions options;
  std::unique_ptr<std::remove_pointer_t<GDALDatasetH>, gdal::CloseDataset> dataset;
  std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, DestroyReference> srs;
  std::vector<std::unique_ptr<Layer>> layers;  // in the order of the file
  bool made = false, closed = false;

  ~Impl() {
    if (closed) return;
    // What is left of a file that failed is of no use to anyone.
    const GdalScope scope(settings());
    for (const auto& layer : layers) layer->feature.reset();
    if (dataset) api().GDALDatasetRollbackTransaction(dataset.get());
    dataset.reset();
    if (made) std::remove(path.c_str());
  }

  [[noreturn]] void fail(const GdalScope& scope) const {
    const int error = error_of_writing(path);
    throw base::OutputError(path + ": cannot write: " +
                            (scope.failed() ? scope.failure("unknown failure") : std::string("GDAL does not say why")) +
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
        {"OGR_SQLITE_PRAGMA", "cache_size=-8192,locking_mode=EXCLUSIVE"},
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
    OGRLayerH result = api().GDALDatasetExecuteSQL(dataset.get(), statement.c_str(), nullptr, nullptr);
    if (result != nullptr) api().GDALDatasetReleaseResultSet(dataset.get(), result);
    check(scope, true);
  }

  void make_layer(const GdalScope& scope, const LayerSpec& spec) {
    const std::string option = "DESCRIPTION=" + spec.description;
    const std::array<const char*, 5> creation{"FID=fid", "GEOMETRY_NAME=geom", "SPATIAL_INDEX=NO", option.c_str(),
                                              nullptr};
    Layer& l = *layers.emplace_back(std::make_unique<Layer>());
    l.table = spec.table;
    l.layer = api().GDALDatasetCreateLayer(dataset.get(), spec.table.c_str(), srs.get(),
                                           kTypes[static_cast<std::size_t>(spec.geometry)],
                                           const_cast<char**>(creation.data()));
    check(scope, l.layer != nullptr);
    for (const Column& c : spec.columns) {
      const Field field(api().OGR_Fld_Create(c.name.c_str(), c.kind == ColumnKind::integer ? OFTInteger64
                                                             : c.kind == ColumnKind::real  ? OFTReal
                                                                                           : OFTString));
      if (is_json(c)) api().OGR_Fld_SetSubType(field.get(), OFSTJSON);
      check(scope, api().OGR_L_CreateField(l.layer, field.get(), TRUE) == OGRERR_NONE);
    }
    l.feature.reset(api().OGR_F_Create(api().OGR_L_GetLayerDefn(l.layer)));
    check(scope, l.feature != nullptr);
    l.columns = spec.columns;
  }

  void describe_columns(const GdalScope& scope) {
    // As OGC 12-128r17, F.9 and C.7 have them; GDAL makes them itself where a column is JSON.
    sql(scope,
        "CREATE TABLE IF NOT EXISTS gpkg_data_columns (table_name TEXT NOT NULL, column_name TEXT NOT NULL, name TEXT, "
        "title TEXT, description TEXT, mime_type TEXT, constraint_name TEXT, CONSTRAINT pk_gdc PRIMARY KEY "
        "(table_name, column_name), CONSTRAINT gdc_tn UNIQUE (table_name, name))");
    sql(scope,
        "CREATE TABLE IF NOT EXISTS gpkg_extensions (table_name TEXT, column_name TEXT, extension_name TEXT NOT NULL, "
        "definition TEXT NOT NULL, scope TEXT NOT NULL, CONSTRAINT ge_tce UNIQUE (table_name, column_name, "
        "extension_name))");
    sql(scope,
        "INSERT INTO gpkg_extensions SELECT 'gpkg_data_columns', NULL, 'gpkg_schema', "
        "'http://www.geopackage.org/spec121/#extension_schema', 'read-write' WHERE NOT EXISTS (SELECT 1 FROM "
        "gpkg_extensions WHERE table_name = 'gpkg_data_columns')");
    // Names stay NULL, since it declares them unique over all layers.
    sql(scope, "DELETE FROM gpkg_data_columns");
    for (const auto& layer : layers) {
      std::string values;
      for (const Column& c : layer->columns) {
        values += (values.empty() ? "(" : ",(") + sql_text(layer->table) + ',' + sql_text(c.name) + ",NULL," +
                  sql_text(c.unit.empty() ? c.name : c.name + " [" + c.unit + "]") + ',' +
                  sql_text(c.unit.empty() ? c.description : c.description + ". Unit: " + c.unit) + ',' +
                  (is_json(c) ? "'application/json'" : "NULL") + ",NULL)";
      }
      sql(scope,
          "INSERT INTO gpkg_data_columns (table_name, column_name, name, title, description, mime_type, "
          "constraint_name) VALUES " +
              values);
    }
  }

  /// The table as QGIS makes it when it saves a style itself.
  void write_styles(const GdalScope& scope, const std::vector<QgisStyle>& list) {
    const std::array<const char*, 2> creation{"FID=id", nullptr};
    OGRLayerH layer = api().GDALDatasetCreateLayer(dataset.get(), "layer_styles", nullptr, wkbNone,
                                                   const_cast<char**>(creation.data()));
    check(scope, layer != nullptr);
    const auto add = [&](const char* column, OGRFieldType type, int width = 0, OGRFieldSubType sub = OFSTNone) {
      const Field field(api().OGR_Fld_Create(column, type));
      api().OGR_Fld_SetWidth(field.get(), width);
      api().OGR_Fld_SetSubType(field.get(), sub);
      check(scope, api().OGR_L_CreateField(layer, field.get(), TRUE) == OGRERR_NONE);
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
    for (const QgisStyle& style : list) {
      const Feature feature(api().OGR_F_Create(api().OGR_L_GetLayerDefn(layer)));
      int column = 0;  // in the order of creation
      const auto set = [&](const char* text) { api().OGR_F_SetFieldString(feature.get(), column++, text); };
      // QGIS looks for empty texts here, not for NULL.
      set(""), set(""), set(style.layer.c_str()), set("geom");
      set(style.name.c_str()), set(style.qml.c_str()), set("");
      api().OGR_F_SetFieldInteger(feature.get(), column++, style.is_default ? 1 : 0);
      set(style.description.c_str()), set("");
      ++column;  // `ui` stays NULL
      set(geopackage_time(options.data_time).c_str());
      check(scope, api().OGR_L_CreateFeature(layer, feature.get()) == OGRERR_NONE);
    }
  }

  void create(const std::vector<LayerSpec>& specs, const std::vector<QgisStyle>& styles) {
    gdal::register_drivers();
    const GdalScope scope(settings());
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored))
      throw base::OutputError(path + ": cannot write: the file is there already. Choose another output folder.");
    GDALDriverH driver = api().GDALGetDriverByName("GPKG");
    if (driver == nullptr)
      throw base::OutputError(path +
                              ": cannot write: GDAL was built without GeoPackage. Install GDAL with SQLite, or leave "
                              "gpkg out of --formats.");
    made = true;
    const std::array<const char*, 2> creation{"VERSION=1.3", nullptr};
    dataset.reset(api().GDALCreate(driver, path.c_str(), 0, 0, 0, GDT_Unknown, const_cast<char**>(creation.data())));
    check(scope, dataset != nullptr);
    srs.reset(api().OSRNewSpatialReference(nullptr));
    check(scope, api().OSRSetFromUserInput(srs.get(), options.crs.c_str()) == OGRERR_NONE);
    api().OSRSetAxisMappingStrategy(srs.get(), OAMS_TRADITIONAL_GIS_ORDER);
    check(scope, api().GDALDatasetStartTransaction(dataset.get(), FALSE) == OGRERR_NONE);
    for (const LayerSpec& spec : specs) make_layer(scope, spec);
    describe_columns(scope);
    if (!styles.empty()) write_styles(scope, styles);
    check(scope, true);
  }

  void put(const GdalScope& scope, Layer& to, const CellTable& rows) {
    OGRFeatureH feature = to.feature.get();
    const Cell* cell = rows.cells.data();
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      api().OGR_F_SetFID(feature, OGRNullFID);
      for (int i = 0; i < static_cast<int>(rows.width); ++i, ++cell) {
        switch (cell->kind) {
          case Cell::Kind::null:
            api().OGR_F_SetFieldNull(feature, i);
            break;
          case Cell::Kind::integer:
            api().OGR_F_SetFieldInteger64(feature, i, static_cast<GIntBig>(cell->integer));
            break;
          case Cell::Kind::real:
            api().OGR_F_SetFieldDouble(feature, i, cell->real);
            break;
          case Cell::Kind::text:
            api().OGR_F_SetFieldString(feature, i, rows.texts.c_str() + cell->text);
            break;
        }
      }
      const std::string_view wkb = rows.geometry(row);
      OGRGeometryH geometry = nullptr;
      const OGRErr read =
          wkb.empty() ? OGRERR_NONE : api().OGR_G_CreateFromWkbEx(wkb.data(), nullptr, &geometry, wkb.size());
      api().OGR_F_SetGeometryDirectly(feature, geometry);
      check(scope, read == OGRERR_NONE && api().OGR_L_CreateFeature(to.layer, feature) == OGRERR_NONE);
    }
  }
};

LayerFile::LayerFile(std::string path, FileOptions options, const std::vector<LayerSpec>& layers,
                     const std::vector<QgisStyle>& styles)
    : impl_(std::make_unique<Impl>()) {
  impl_->path = std::move(path);
  impl_->options = std::move(options);
  impl_->create(layers, styles);
}

LayerFile::~LayerFile() = default;

void LayerFile::put(std::size_t layer, const CellTable& rows) {
  const GdalScope scope(impl_->settings());
  impl_->put(scope, *impl_->layers.at(layer), rows);
}

void LayerFile::close() {
  Impl& impl = *impl_;
  const GdalScope scope(impl.settings());
  for (const auto& l : impl.layers) {
    l->feature.reset();
    impl.check(scope, api().OGR_L_SyncToDisk(l->layer) == OGRERR_NONE);
    // The index in one go over finished rows: its pages lie together, and no trigger runs for each insert.
    const std::string table = sql_text(l->table);
    impl.sql(scope, "SELECT CreateSpatialIndex(" + table + ", 'geom')");
    // What readers take for the number of rows; GDAL leaves it open for layers that were filled beside others.
    impl.sql(scope, "UPDATE gpkg_ogr_contents SET feature_count = (SELECT count(*) FROM \"" + l->table +
                        "\") WHERE table_name = " + table);
  }
  impl.check(scope, api().GDALDatasetCommitTransaction(impl.dataset.get()) == OGRERR_NONE);
  impl.dataset.reset();
  impl.check(scope, true);
  impl.closed = true;
}

}  // namespace blockrand::layer_file
