// A connection to a PostGIS database: statements, their rows, and what is said where they fail.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pipeline/gdal/gdal_library.h"
#include "pipeline/gdal/gdal_scope.h"
#include "pipeline/outward/postgis.h"

namespace blockrand::outward {

using Dataset = std::unique_ptr<std::remove_pointer_t<GDALDatasetH>, gdal::CloseDataset>;
using Rows = std::vector<std::vector<std::string>>;

/// As names and texts stand in statements.
std::string sql_name(std::string_view name);
std::string sql_literal(std::string_view text);

class PostgisSession {
 public:
  explicit PostgisSession(const PostgisPlace& place);

  /// \throws base::UsageError   no driver, or no PostGIS
  /// \throws base::OutputError  it cannot be reached
  void open();
  /// \throws base::OutputError
  void sql(const std::string& statement);
  /// Rows as texts; NULL is empty. \throws base::OutputError
  Rows select(const std::string& statement);
  /// With the schema.
  std::string table(const std::string& name) const;
  /// Whether the schema has a table, a view or the like of that name.
  bool has_relation(const std::string& name);
  /// The connection, without passwords.
  std::string shown() const { return without_password(place_.connection); }
  /// \throws base::OutputError  with what GDAL says
  [[noreturn]] void fail(const std::string& what) const;

 protected:
  const PostgisPlace& place_;
  gdal::GdalScope scope_;
  Dataset database_;
};

}  // namespace blockrand::outward
