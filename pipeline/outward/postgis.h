// The GeoPackages of a build as tables of a PostGIS database, of which only changed rows are written.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "pipeline/base/progress.h"
#include "pipeline/outward/build_files.h"

namespace blockrand::outward {

struct PostgisPlace {
  std::string connection;  ///< as GDAL names it: "PG:dbname=city", or "postgresql://…"
  std::string schema;
};

struct PostgisBuild {
  std::string folder, name;
  std::optional<int> number;
  bool anew = false;  ///< write all rows, whatever is noted of them
};

struct PostgisSummary {
  std::uint64_t read = 0, unchanged = 0;  ///< GeoPackages
  std::uint64_t tables_made = 0, columns_added = 0;
  std::uint64_t inserted = 0, deleted = 0, kept = 0;  ///< rows; of files that were read
};

/// A connection without its password: for messages.
std::string without_password(const std::string& connection);

/// `text` with the passwords of a connection taken out: what a library says may repeat it.
std::string clean_of_passwords(std::string text, const std::string& connection);

/// \throws base::InputError  the connection in a settings file holds a password, which copies and logs of that file would show
void refuse_password_in(const std::string& settings_file, const std::string& connection);

/// Brings the tables to the build in one transaction: readers see the old build or the new one. Each layer of the GeoPackages is a table of
/// the schema, of all areas together, with two columns more: blockrand_area (as "11/1093/805", empty for a build at once) and blockrand_row
/// (a hash of the row). Rows of a layer belong together by the area and the layer's key, `id`, or `osm_id` where it has none: where the hashes of
/// a key's rows are not those of the build, all rows of that key are deleted and written. A GeoPackage whose hash is that which was written last
/// is not read. A table that is missing is made, with spatial and key index and the columns' meanings; a column that is missing is
/// added, and all rows of the table are then written anew. `blockrand_build` has one row, the build that is in; `blockrand_files` its
/// GeoPackages; `blockrand_tables` the tables that were made: none but those is written.
/// \throws base::UsageError   no GeoPackage in the build; no PostGIS; a table or view of that name that this program did not make; a build
///                            of another name, or in another CRS, lies there
/// \throws base::OutputError  the database cannot be reached or written: it stays as it was
PostgisSummary publish_to_postgis(const PostgisPlace& place, const PostgisBuild& build,
                                  const std::map<std::string, BuildFile>& files, bool dry_run,
                                  base::Progress& progress);

}  // namespace blockrand::outward
