// The QGIS project beside the GeoPackage: whether what it names is there.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "pipeline/validate/finding_log.h"

namespace blockrand::validate {

/// Columns by table.
using TableColumns = std::map<std::string, std::set<std::string>, std::less<>>;

/// The project of a .qgz file: the first file in that ZIP archive (PKWARE APPNOTE 6.3.3) whose name ends in ".qgs". Nothing
/// where the archive is damaged, has none, or one of more than 64 MB. `why` says what is wrong.
std::optional<std::string> qgs_of(std::string_view qgz, std::string& why);

/// Checks that a project reads `geopackage` in its own folder, that every layer of its panel exists, that layers, columns
/// in styles, labels and expressions, and reference systems are those of the GeoPackage. FILE_UNREADABLE, QGIS_PROJECT.
/// \param qgs         content of the project
/// \param name        of the project's file in findings
/// \param geopackage  name of its file
/// \param crs         "EPSG:25833"
/// \return  number of layers
std::size_t check_qgis_project(std::string_view qgs, const std::string& name, const std::string& geopackage,
                               const TableColumns& tables, const std::string& crs, FindingLog& log);

}  // namespace blockrand::validate
