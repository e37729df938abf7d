// What `blockrand validate` can find wrong with a build. One list for the program, the documentation and the tests.
#pragma once

#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>

namespace blockrand::validate {

/// X(enumerator, CODE, what it means). Codes are stable: scripts may filter by them.
#define BLOCKRAND_CHECKS(X)                                                                                     \
  X(file_missing, "FILE_MISSING", "a file that build.json lists is not there")                                  \
  X(file_unlisted, "FILE_UNLISTED", "a file that build.json does not list lies in the build")                   \
  X(gzip_differs, "GZIP_DIFFERS", "a .gz beside a file does not hold that file")                                \
  X(file_changed, "FILE_CHANGED", "size or SHA-256 differ from build.json")                                     \
  X(file_unreadable, "FILE_UNREADABLE", "the file cannot be parsed")                                            \
  X(build_json, "BUILD_JSON", "build.json lacks a field, or a field contradicts another")                       \
  X(counts_differ, "COUNTS_DIFFER", "two files disagree on how much the build holds")                           \
  X(object_missing, "OBJECT_MISSING", "a building or body stands in one format and not in another")             \
  X(object_doubled, "OBJECT_DOUBLED", "a building or body stands twice in one format")                          \
  X(attribute_differs, "ATTRIBUTE_DIFFERS", "a body's attribute has different values in two formats")           \
  X(source_wrong, "SOURCE_WRONG", "an attribute's source or confidence is missing or out of range")             \
  X(solid_invalid, "SOLID_INVALID", "a solid is not closed, oriented and free of self-intersections")           \
  X(solids_overlap, "SOLIDS_OVERLAP",                                                                           \
    "601: parts of a building, or what stands on them, overlap, and the report does not say so")                \
  X(validators_disagree, "JUDGES_DISAGREE", "the two judges of solids contradict each other")                   \
  X(off_grid, "OFF_GRID", "a coordinate is not on the 1/1024 m grid")                                           \
  X(geometry_differs, "GEOMETRY_DIFFERS", "a body has different geometry in two formats")                       \
  X(colour_differs, "COLOUR_DIFFERS", "a face has different colours in two formats")                            \
  X(tileset_rule, "TILESET_RULE", "tileset.json breaks a rule of 3D Tiles 1.1")                                 \
  X(tile_missing, "TILE_MISSING", "the tileset names content that is not there, or a tile is in no tileset")    \
  X(tile_bounds, "TILE_BOUNDS", "content lies outside of its tile's bounding volume")                           \
  X(glb_rule, "GLB_RULE", "a GLB breaks a rule of glTF 2.0")                                                    \
  X(metadata_rule, "METADATA_RULE", "feature ids or property tables break their extension's rules")             \
  X(georeference, "GEOREFERENCE", "a GLB's georeference and its tile's transform contradict each other")        \
  X(position, "POSITION", "a vertex is farther from its OpenStreetMap position than 1 mm and what repair says") \
  X(citygml_rule, "CITYGML_RULE", "a CityGML file breaks a rule of the standard")                               \
  X(citygml_schema, "CITYGML_SCHEMA", "a CityGML file does not validate against the OGC schemas")               \
  X(cityjson_rule, "CITYJSON_RULE", "a CityJSON file breaks a rule of the specification")                       \
  X(geopackage_rule, "GEOPACKAGE_RULE", "the GeoPackage breaks a rule of the standard")                         \
  X(qgis_project, "QGIS_PROJECT", "the QGIS project names what the GeoPackage does not have")                   \
  X(explanation_wrong, "EXPLANATION_WRONG", "an explanation is missing, unreadable or contradicts the model")   \
  X(report_wrong, "REPORT_WRONG", "report.html or report.json contradict the model")

enum class Check : std::uint8_t {
#define X(id, text, meaning) id,
  BLOCKRAND_CHECKS(X)
#undef X
};

struct CheckInfo {
  std::string_view text, meaning;
};
inline constexpr CheckInfo kChecks[] = {
#define X(id, text, meaning) {text, meaning},
    BLOCKRAND_CHECKS(X)
#undef X
};
inline constexpr int kCheckCount = static_cast<int>(std::size(kChecks));
constexpr const CheckInfo& info(Check check) { return kChecks[static_cast<int>(check)]; }

struct Finding {
  Check check = Check::file_unreadable;
  std::string file;    ///< relative to the build
  std::string object;  ///< id of the building, body, tile or element concerned; may be empty
  std::string detail;  ///< what is wrong, with numbers
  int number = 0;      ///< of geometry: val3dity's for the defect (docs/validate.md); 0 where it has none
};

}  // namespace blockrand::validate
