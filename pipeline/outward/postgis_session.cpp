#include "pipeline/outward/postgis_session.h"

#include <fmt/format.h>

#include "pipeline/base/error.h"
#include "pipeline/outward/postgis_rows.h"

namespace blockrand::outward {

using gdal::api;

std::string sql_name(std::string_view name) {
  std::string out = "\"";
  for (const char c : name) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

std::string sql_literal(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "''" : std::string(1, c);
  return out + "'";
}

PostgisSession::PostgisSession(const PostgisPlace& place)
    : place_(place),
      // Rows go in bulk, whatever the user's environment says; values as they are, whatever the locale.
      scope_({{"PG_USE_COPY", "YES"}, {"OGR_TRUNCATE", "NO"}, {"PG_USE_BASE64", "NO"}}) {}

void PostgisSession::fail(const std::string& what) const {
  throw base::OutputError(
      clean_of_passwords(fmt::format("{}: {}: {}. The database stays as it was; publish again when that is mended",
                                     shown(), what, scope_.failure("GDAL does not say why")),
                         place_.connection));
}

void PostgisSession::open() {
  gdal::register_drivers();
  if (api().GDALGetDriverByName("PostgreSQL") == nullptr)
    throw base::UsageError(
        "--postgis: this GDAL was built without PostgreSQL. Install Debian's libgdal, or leave it out.");
  constexpr const char* kDrivers[] = {"PostgreSQL", nullptr};
  database_.reset(
      api().GDALOpenEx(place_.connection.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE, kDrivers, nullptr, nullptr));
  if (!database_) fail("cannot be opened");
  if (select("SELECT extname FROM pg_extension WHERE extname = 'postgis'").empty())
    throw base::UsageError(shown() + " has no PostGIS. Let its owner say: CREATE EXTENSION postgis;");
}

void PostgisSession::sql(const std::string& statement) {
  OGRLayerH result = api().GDALDatasetExecuteSQL(database_.get(), statement.c_str(), nullptr, nullptr);
  if (result != nullptr) api().GDALDatasetReleaseResultSet(database_.get(), result);
  if (scope_.failed()) fail(statement.substr(0, statement.find('(')));
}

Rows PostgisSession::select(const std::string& statement) {
  Rows rows;
  OGRLayerH result = api().GDALDatasetExecuteSQL(database_.get(), statement.c_str(), nullptr, nullptr);
  if (scope_.failed()) fail(statement);
  if (result == nullptr) return rows;
  const int columns = api().OGR_FD_GetFieldCount(api().OGR_L_GetLayerDefn(result));
  while (const FeaturePointer row{api().OGR_L_GetNextFeature(result)}) {
    std::vector<std::string>& values = rows.emplace_back();
    for (int i = 0; i < columns; ++i) values.emplace_back(api().OGR_F_GetFieldAsString(row.get(), i));
  }
  api().GDALDatasetReleaseResultSet(database_.get(), result);
  if (scope_.failed()) fail(statement);
  return rows;
}

std::string PostgisSession::table(const std::string& name) const {
  return sql_name(place_.schema) + "." + sql_name(name);
}

bool PostgisSession::has_relation(const std::string& name) {
  return !select("SELECT 1 FROM pg_class c JOIN pg_namespace n ON n.oid = c.relnamespace WHERE n.nspname = " +
                 sql_literal(place_.schema) + " AND c.relname = " + sql_literal(name))
              .empty();
}

}  // namespace blockrand::outward
