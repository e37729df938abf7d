#include "pipeline/outward/postgis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <set>
#include <type_traits>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/outward/postgis_rows.h"
#include "pipeline/outward/postgis_session.h"
#include "pipeline/outward/target.h"
#include "pipeline/run/region_state.h"

namespace blockrand::outward {
namespace {

using gdal::api;

constexpr const char* kGeoPackage = "buildings.gpkg";
constexpr const char* kTables = "blockrand_tables";  // the tables that this program made
constexpr const char* kStyles = "layer_styles";      // of QGIS, which keeps those of a database elsewhere

/// "areas/11/1093/805/buildings.gpkg" → "11/1093/805"
std::string area_of(const std::string& path) {
  constexpr std::string_view kFolder = "areas/";
  const std::size_t end = path.rfind('/');
  return path.starts_with(kFolder) && end != std::string::npos ? path.substr(kFolder.size(), end - kFolder.size())
                                                               : std::string();
}

/// A column that holds less (real instead of double precision) is of another type, too.
bool same_type(OGRFieldDefnH a, OGRFieldDefnH b) {
  return api().OGR_Fld_GetType(a) == api().OGR_Fld_GetType(b) &&
         api().OGR_Fld_GetSubType(a) == api().OGR_Fld_GetSubType(b);
}

class Database : private PostgisSession {
 public:
  Database(const PostgisPlace& place, const PostgisBuild& build, const std::map<std::string, BuildFile>& files,
           base::Progress& progress)
      : PostgisSession(place), build_(build), files_(files), progress_(progress) {}

  PostgisSummary run() {
    std::vector<const BuildFile*> packages;
    for (const auto& [path, file] : files_)
      if (path == kGeoPackage || path.ends_with(std::string("/") + kGeoPackage)) packages.push_back(&file);
    if (packages.empty())
      throw base::UsageError(build_.folder + " has no GeoPackage to load: build with --formats gpkg.");
    record_ = run::read_json(build_.folder + "/build.json");
    open();
    if (api().GDALDatasetStartTransaction(database_.get(), FALSE) != OGRERR_NONE) fail("a transaction cannot begin");
    make_notes();
    if (build_.anew)
      for (const std::string& name : tables_) load_anew(name);
    complete_tables(packages);
    progress_.begin("database", packages.size(), "GeoPackages");
    std::uint64_t done = 0;
    for (const BuildFile* package : packages) {
      load(*package);
      progress_.advance_to(++done);
    }
    remove_areas(packages);
    note_build(packages);
    if (api().GDALDatasetCommitTransaction(database_.get()) != OGRERR_NONE || scope_.failed())
      fail("the transaction cannot be ended");
    return summary_;
  }

 private:
  std::string crs() const {
    return record_.contains("crs") && record_["crs"].is_object() ? run::text_in(record_["crs"], "code") : std::string();
  }

  /// The program's own tables, and which others are its.
  void make_notes() {
    if (select("SELECT 1 FROM pg_namespace WHERE nspname = " + sql_literal(place_.schema)).empty())
      sql("CREATE SCHEMA " + sql_name(place_.schema));
    sql("CREATE TABLE IF NOT EXISTS " + table("blockrand_build") +
        " (name text, number integer, build_sha256 text, data_time text, program text, crs text, loaded timestamptz)");
    sql("CREATE TABLE IF NOT EXISTS " + table("blockrand_files") +
        " (path text PRIMARY KEY, sha256 text NOT NULL, layers text NOT NULL)");
    sql("LOCK TABLE " + table("blockrand_build") + " IN EXCLUSIVE MODE");  // readers go on; a second writer waits
    for (const auto& row : select("SELECT path, sha256, layers FROM " + table("blockrand_files")))
      loaded_[row[0]] = {row[1], row[2]};
    find_tables();
    refuse_other_build();
  }

  /// The tables that this program made and nobody made into something else: a view shows rows of tables that are not its own.
  void find_tables() {
    const std::string list = table(kTables);
    if (!has_relation(kTables)) {
      // Made by a program that had no list.
      sql("CREATE TABLE " + list + " (name text PRIMARY KEY)");
      for (const auto& [path, file] : loaded_)
        for (const std::string& name : layers_of(file.second)) list_table(name);
    }
    for (const auto& row :
         select(fmt::format("SELECT c.relname FROM pg_class c JOIN pg_namespace n ON n.oid = c.relnamespace JOIN {} t "
                            "ON t.name = c.relname "
                            "WHERE n.nspname = {} AND c.relkind IN ('r', 'p') AND (SELECT count(*) FROM pg_attribute a "
                            "WHERE a.attrelid = "
                            "c.oid AND NOT a.attisdropped AND a.attname IN ({}, {})) = 2",
                            list, sql_literal(place_.schema), sql_literal(kAreaColumn), sql_literal(kRowColumn))))
      tables_.insert(row[0]);
  }

  void list_table(const std::string& name) {
    sql("INSERT INTO " + table(kTables) + " VALUES (" + sql_literal(name) + ") ON CONFLICT DO NOTHING");
  }

  /// Rows of a schema are of one region: what another one's build does not have would be removed.
  void refuse_other_build() {
    if (tables_.empty()) return;
    for (const auto& row : select("SELECT crs, name FROM " + table("blockrand_build"))) {
      const std::string remove = "remove it: DROP SCHEMA " + sql_name(place_.schema) + " CASCADE;";
      if (row[1] != build_.name)
        throw base::UsageError(fmt::format(
            "{}: schema {} holds {}, and this is {}, which would replace it. Name another schema (--schema), "
            "or {} or, if {} has only a new name: UPDATE {} SET name = {};",
            shown(), place_.schema, row[1], build_.name, remove, row[1], table("blockrand_build"),
            sql_literal(build_.name)));
      if (row[0] != crs())
        throw base::UsageError(
            fmt::format("{}: schema {} holds {} in {}, and this build is in {}. Name another schema (--schema), or {}",
                        shown(), place_.schema, row[1], row[0], crs(), remove));
    }
  }

  static std::vector<std::string> layers_of(const std::string& list) {
    std::vector<std::string> layers;
    for (std::size_t at = 0; at < list.size();) {
      const std::size_t end = std::min(list.find(' ', at), list.size());
      layers.push_back(list.substr(at, end - at));
      at = end + 1;
    }
    return layers;
  }

  bool is_loaded(const BuildFile& package) const {
    const auto found = loaded_.find(package.path);
    if (found == loaded_.end() || found->second.first != package.sha256) return false;
    // A table may have been removed, or emptied to be loaded anew.
    return std::ranges::all_of(layers_of(found->second.second), [&](const std::string& name) {
      return tables_.contains(name) && !anew_.contains(name);
    });
  }

  /// All rows go, and all packages that have some are read.
  void load_anew(const std::string& name) {
    if (anew_.insert(name).second) remove_rows(name, "true");
  }

  Dataset open_package(const BuildFile& package) {
    check_there(build_.folder, package);
    const std::string place = build_.folder + "/" + package.path;
    constexpr const char* kDrivers[] = {"GPKG", nullptr};
    Dataset file(api().GDALOpenEx(place.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, kDrivers, nullptr, nullptr));
    if (!file)
      throw base::InputError(place, "", "cannot be read: " + scope_.failure("GDAL does not say why"), "Build again");
    return file;
  }

  /// Adds columns that tables have not, or not any more. It comes before all packages, for rows of each one have values for them.
  void complete_tables(const std::vector<const BuildFile*>& packages) {
    std::set<std::string> complete;
    for (const BuildFile* package : packages) {
      const bool loaded = is_loaded(*package);
      if (loaded && std::ranges::all_of(layers_of(loaded_.at(package->path).second),
                                        [&](const std::string& name) { return complete.contains(name); }))
        continue;
      const Dataset file = open_package(*package);
      for (int i = 0; i < api().GDALDatasetGetLayerCount(file.get()); ++i) {
        OGRLayerH layer = api().GDALDatasetGetLayer(file.get(), i);
        const std::string name = api().OGR_L_GetName(layer);
        if (tables_.contains(name)) table_for(file.get(), layer, name);
        complete.insert(name);
      }
    }
  }

  void load(const BuildFile& package) {
    if (is_loaded(package)) return void(++summary_.unchanged);
    ++summary_.read;
    const Dataset file = open_package(package);
    std::set<std::string> layers;
    std::string list;
    for (int i = 0; i < api().GDALDatasetGetLayerCount(file.get()); ++i) {
      OGRLayerH layer = api().GDALDatasetGetLayer(file.get(), i);
      const std::string name = api().OGR_L_GetName(layer);
      if (name == kStyles) continue;
      load_layer(file.get(), layer, name, area_of(package.path));
      layers.insert(name);
      list += (list.empty() ? "" : " ") + name;
    }
    for (const std::string& name : tables_)
      if (!layers.contains(name)) remove_rows(name, "blockrand_area = " + sql_literal(area_of(package.path)));
    sql(fmt::format(
        "INSERT INTO {0} VALUES ({1}, {2}, {3}) ON CONFLICT (path) DO UPDATE SET sha256 = {2}, layers = {3}",
        table("blockrand_files"), sql_literal(package.path), sql_literal(package.sha256), sql_literal(list)));
  }

  void remove_rows(const std::string& name, const std::string& where) {
    const Rows gone = select("WITH gone AS (DELETE FROM " + table(name) + " WHERE " + where +
                             " RETURNING 1) SELECT count(*) FROM gone");
    if (!gone.empty()) summary_.deleted += std::stoull(gone.front().front());
  }

  OGRLayerH make_table(GDALDatasetH file, OGRLayerH from, const std::string& name) {
    const std::string schema = "SCHEMA=" + place_.schema;
    const char* const creation[] = {schema.c_str(), "GEOMETRY_NAME=geom", "FID=fid", "LAUNDER=NO",
                                    "PRECISION=NO", "SPATIAL_INDEX=GIST", nullptr};
    OGRLayerH to = api().GDALDatasetCreateLayer(database_.get(), name.c_str(), api().OGR_L_GetSpatialRef(from),
                                                api().OGR_L_GetGeomType(from), const_cast<char**>(creation));
    if (to == nullptr || scope_.failed()) fail("table " + name + " cannot be made");
    add_column(to, kAreaColumn, OFTString);
    add_column(to, kRowColumn, OFTInteger64);
    OGRFeatureDefnH fields = api().OGR_L_GetLayerDefn(from);
    for (int i = 0; i < api().OGR_FD_GetFieldCount(fields); ++i) add_column(to, api().OGR_FD_GetFieldDefn(fields, i));
    if (api().OGR_L_SyncToDisk(to) != OGRERR_NONE || scope_.failed()) fail("table " + name + " cannot be made");
    sql(fmt::format("CREATE INDEX ON {} ({}, {})", table(name), kAreaColumn, sql_name(key_of(from))));
    describe(file, name, {});
    list_table(name);
    tables_.insert(name), anew_.insert(name);
    ++summary_.tables_made;
    return to;
  }

  void add_column(OGRLayerH to, OGRFieldDefnH field) {
    if (api().OGR_L_CreateField(to, field, FALSE) != OGRERR_NONE || scope_.failed())
      fail(std::string("column ") + api().OGR_Fld_GetNameRef(field) + " cannot be added");
  }
  void add_column(OGRLayerH to, const char* name, OGRFieldType type) {
    OGRFieldDefnH field = api().OGR_Fld_Create(name, type);
    const bool made = api().OGR_L_CreateField(to, field, FALSE) == OGRERR_NONE;
    api().OGR_Fld_Destroy(field);
    if (!made || scope_.failed()) fail(std::string("column ") + name + " cannot be added");
  }

  /// What the file says of its columns, for people who look at the database.
  /// \param only  columns that are meant; empty: all of the table
  void describe(GDALDatasetH file, const std::string& name, const std::set<std::string>& only) {
    OGRLayerH rows = api().GDALDatasetExecuteSQL(
        file,
        ("SELECT column_name, description FROM gpkg_data_columns WHERE table_name = " + sql_literal(name)).c_str(),
        nullptr, nullptr);
    if (rows == nullptr) return;
    std::string statements;
    while (const FeaturePointer row{api().OGR_L_GetNextFeature(rows)}) {
      const std::string column = api().OGR_F_GetFieldAsString(row.get(), 0);
      if (only.empty() || only.contains(column))
        statements += fmt::format("COMMENT ON COLUMN {}.{} IS {};", table(name), sql_name(column),
                                  sql_literal(api().OGR_F_GetFieldAsString(row.get(), 1)));
    }
    api().GDALDatasetReleaseResultSet(file, rows);
    if (!statements.empty()) sql(statements);
  }

  /// The table of a layer, with all of its columns.
  OGRLayerH table_for(GDALDatasetH file, OGRLayerH from, const std::string& name) {
    if (!tables_.contains(name)) {
      if (has_relation(name))
        throw base::UsageError(
            fmt::format("{}: {} is there already, and this program did not make it. Name another schema: --schema",
                        shown(), table(name)));
      return make_table(file, from, name);
    }
    OGRLayerH to = api().GDALDatasetGetLayerByName(database_.get(), (place_.schema + "." + name).c_str());
    if (to == nullptr) fail("table " + name + " cannot be opened");
    OGRFeatureDefnH fields = api().OGR_L_GetLayerDefn(from), has = api().OGR_L_GetLayerDefn(to);
    std::set<std::string> fresh, known{kAreaColumn, kRowColumn};
    for (int i = 0; i < api().OGR_FD_GetFieldCount(fields); ++i) {
      OGRFieldDefnH field = api().OGR_FD_GetFieldDefn(fields, i);
      const char* const column = api().OGR_Fld_GetNameRef(field);
      known.insert(column);
      const int there = api().OGR_FD_GetFieldIndex(has, column);
      if (there < 0) {
        add_column(to, field);
        fresh.insert(column);
        ++summary_.columns_added;
      } else if (!same_type(field, api().OGR_FD_GetFieldDefn(has, there))) {
        throw base::UsageError(
            fmt::format("{}: column {} of {} is of another type than this build's. Remove the table, and it is made "
                        "anew: DROP TABLE {};",
                        shown(), column, table(name), table(name)));
      }
    }
    if (!fresh.empty()) {
      describe(file, name, fresh);
      load_anew(name);
    }
    for (int i = 0; i < api().OGR_FD_GetFieldCount(has); ++i)
      if (const std::string column = api().OGR_Fld_GetNameRef(api().OGR_FD_GetFieldDefn(has, i));
          !known.contains(column))
        warn_once(fmt::format(
            "{}: this build has no column {} any more, which stays empty in rows that change. To remove it: "
            "ALTER TABLE {} DROP COLUMN {};",
            table(name), column, table(name), sql_name(column)));
    return to;
  }

  void warn_once(const std::string& text) {
    if (warned_.insert(text).second) progress_.warn(text);
  }

  void load_layer(GDALDatasetH file, OGRLayerH from, const std::string& name, const std::string& area) {
    OGRLayerH to = table_for(file, from, name);
    const std::string key = key_of(from), where = std::string(kAreaColumn) + " = " + sql_literal(area);
    std::map<std::string, std::uint64_t> before, now;
    for (const auto& row : select(fmt::format("SELECT coalesce({}, ''), {} FROM {} WHERE {}", sql_name(key), kRowColumn,
                                              table(name), where)))
      before[row[0]] += static_cast<std::uint64_t>(std::stoll(row[1]));
    RowReader reader(from, key);
    if (!before.empty())
      while (reader.next()) now[reader.key()] += reader.hash();
    const auto differs = [&](const std::string& k) {
      const auto a = before.find(k), b = now.find(k);
      return a == before.end() || b == now.end() || a->second != b->second;
    };
    remove_keys(name, key, where, before, differs);
    reader.again();
    RowInserter inserter(from, to, area);
    while (reader.next()) {
      if (!before.empty() && !differs(reader.key())) {
        ++summary_.kept;
        continue;
      }
      if (!inserter.insert(reader) || scope_.failed()) fail("rows of " + name + " cannot be written");
      ++summary_.inserted;
    }
    if (api().OGR_L_SyncToDisk(to) != OGRERR_NONE || scope_.failed()) fail("rows of " + name + " cannot be written");
  }

  template <class Differs>
  void remove_keys(const std::string& name, const std::string& key, const std::string& where,
                   const std::map<std::string, std::uint64_t>& before, const Differs& differs) {
    constexpr std::size_t kAtOnce = 1000;  // names in one statement
    std::vector<std::string> gone;
    for (const auto& [k, hash] : before)
      if (differs(k)) gone.push_back(sql_literal(k));
    for (std::size_t first = 0; first < gone.size(); first += kAtOnce)
      remove_rows(
          name,
          fmt::format(
              "{} AND coalesce({}, '') IN ({})", where, sql_name(key),
              fmt::join(gone.begin() + static_cast<std::ptrdiff_t>(first),
                        gone.begin() + static_cast<std::ptrdiff_t>(std::min(first + kAtOnce, gone.size())), ",")));
  }

  /// Rows of areas that the build does not have any more.
  void remove_areas(const std::vector<const BuildFile*>& packages) {
    std::string areas, paths;
    for (const BuildFile* package : packages) {
      areas += (areas.empty() ? "" : ",") + sql_literal(area_of(package->path));
      paths += (paths.empty() ? "" : ",") + sql_literal(package->path);
    }
    const bool left = std::ranges::any_of(loaded_, [&](const auto& file) { return !files_.contains(file.first); });
    if (!left) return;
    for (const std::string& name : tables_) remove_rows(name, std::string(kAreaColumn) + " NOT IN (" + areas + ")");
    sql("DELETE FROM " + table("blockrand_files") + " WHERE path NOT IN (" + paths + ")");
  }

  void note_build(const std::vector<const BuildFile*>&) {
    sql("DELETE FROM " + table("blockrand_build"));
    sql(fmt::format("INSERT INTO {} VALUES ({}, {}, {}, {}, {}, {}, now())", table("blockrand_build"),
                    sql_literal(build_.name), build_.number ? std::to_string(*build_.number) : "NULL",
                    sql_literal(files_.at("build.json").sha256), sql_literal(run::text_in(record_, "data_time")),
                    sql_literal(record_.contains("program") && record_["program"].is_object()
                                    ? run::text_in(record_["program"], "version")
                                    : std::string()),
                    sql_literal(crs())));
  }

  const PostgisBuild& build_;
  const std::map<std::string, BuildFile>& files_;
  base::Progress& progress_;
  nlohmann::ordered_json record_;
  std::set<std::string> tables_;                                       ///< of this program's rows
  std::map<std::string, std::pair<std::string, std::string>> loaded_;  ///< path → hash, layers
  std::set<std::string> anew_;                                         ///< tables whose rows are all written
  std::set<std::string> warned_;
  PostgisSummary summary_;
};

}  // namespace

PostgisSummary publish_to_postgis(const PostgisPlace& place, const PostgisBuild& build,
                                  const std::map<std::string, BuildFile>& files, bool dry_run,
                                  base::Progress& progress) {
  if (dry_run) return {};
  return Database(place, build, files, progress).run();
}

}  // namespace blockrand::outward
