// Whether two formats say the same about a tile, body by body.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/validate/contents.h"
#include "pipeline/validate/glb.h"

namespace blockrand::validate {

/// A format's contents of a tile, and the file that they come from.
struct Side {
  const Contents& contents;
  const std::string& file;
};

/// OBJECT_DOUBLED for each building or body that stands twice. Here and below, those without an id are passed over:
/// that was found by the reader.
void find_doubles(const Side& side, std::vector<Finding>& findings);

/// OBJECT_MISSING for each building or body that only one side has.
void compare_objects(const Side& a, const Side& b, std::vector<Finding>& findings);

/// How the less exact one of two sides says its values.
enum class Precision : std::uint8_t {
  exact,
  table,  ///< a property table: confidences in steps of 1/255
  people  ///< a property table with the profile `people`: fewer attributes, rounded (people_column)
};

/// ATTRIBUTE_DIFFERS for attributes of bodies that both sides have, beyond what rounding explains.
void compare_attributes(const Side& a, const Side& b, Precision precision, std::vector<Finding>& findings);

/// SOURCE_WRONG where a value has no source, or one that does not exist, or no confidence in [0, 1]; METADATA_RULE where a
/// table is not one of its profile.
/// \param people  the side has the profile `people`: of confidences that of the style alone
void check_sources(const Side& side, bool people, std::vector<Finding>& findings);

/// Exactly the same polygons on the grid, in any order, with any first point: GEOMETRY_DIFFERS, COLOUR_DIFFERS.
void compare_polygons(const Side& a, const Side& b, std::vector<Finding>& findings);

/// Points of the build CRS to the tile's frame, by other ways than the writer's; both spans have the same length.
using ToLocal = std::function<void(std::span<const model::Point3> in, std::span<model::Point3> out)>;

/// A mesh has the corners, the area, the volume and the colours of the body's best solid (or, without one, its
/// footprint). Of LoD3 it has what no placed element stands for, and the bodies on walls and roofs. Where every body of a
/// tile is off by much the same, that is one finding.
/// \param tolerance       m, that a vertex may be off
/// \param elements_baked  elements are part of the mesh: LoD3 bodies are not compared
void compare_meshes(const Side& reference, const Glb& glb, const std::string& glb_file, const ToLocal& to_local,
                    double tolerance, bool elements_baked, std::vector<Finding>& findings);

/// A body in few bytes, to be compared with the same body in a file of the whole build.
struct BodyDigest {
  std::uint64_t geometry = 0;    ///< of footprint and solids with kinds and colours, whatever the order of faces
  DrawnArea drawn;               ///< of GLB alone
  std::uint64_t attributes = 0;  ///< of values, sources and confidences
};
BodyDigest digest(const ReadBody& body);
using BodyDigests = std::vector<std::pair<std::string, BodyDigest>>;  ///< with the body's id

/// A file of the whole build against the tiles of its format: OBJECT_MISSING, OBJECT_DOUBLED, GEOMETRY_DIFFERS,
/// ATTRIBUTE_DIFFERS.
void compare_digests(const BodyDigests& tiles, const std::string& format, const BodyDigests& whole,
                     const std::string& file, std::vector<Finding>& findings);

}  // namespace blockrand::validate
