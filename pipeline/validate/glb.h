// A GLB read back: who is in it, what is drawn for whom, where it stands, and whether it keeps the rules.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/validate/contents.h"
#include "pipeline/validate/earth.h"

namespace blockrand::validate {

struct GlbTriangle {
  std::array<model::Point3, 3> corners;  ///< dequantised; m in the tile's frame, z up; counter-clockwise from outside
  std::array<std::uint8_t, 3> colour{};  ///< sRGB
};

/// A mesh that is placed, in its own axes and units.
struct GlbElement {
  std::string name;
  std::vector<GlbTriangle> triangles;  ///< y up, as stored
  model::Point3 min, max;              ///< of the triangles
};

/// Where an element stands.
struct GlbPlace {
  std::size_t element = 0;    ///< into Glb::elements
  std::size_t row = 0;        ///< of the property table
  Matrix matrix = kIdentity;  ///< from the element's axes to the tile's frame with y up
};

/// m in the tile's frame, z up, of a point in the axes of the placed element.
inline model::Point3 placed(const GlbPlace& place, const model::Point3& p) {
  const model::Point3 q = apply(place.matrix, p);
  return {q.x, 0.0 - q.z, q.y};
}

/// asset.extras.georeference.
struct GlbGeoreference {
  bool present = false;
  std::string crs, height_reference;
  double longitude = 0, latitude = 0, height = 0;  ///< of the origin: degrees, m above the ellipsoid
  Matrix local_to_ecef = kIdentity;
};

struct Glb {
  bool readable = false;  ///< false: there is one finding, and nothing else
  /// Bodies are the rows of the property table, without geometry. A row with its building's id beside other rows of the
  /// building has "<id>.1" as its id, as in CityGML. Findings: GLB_RULE, METADATA_RULE, GEOREFERENCE.
  Contents contents;
  std::vector<std::vector<GlbTriangle>> triangles;  ///< parallel to contents.bodies
  /// The same of elements that are part of the tile's mesh: below a node called "elements".
  std::vector<std::vector<GlbTriangle>> element_triangles;
  std::vector<GlbElement> elements;
  bool pieces = false;           ///< places are those of pieces, of which an element has several
  std::vector<GlbPlace> places;  ///< of elements: by EXT_mesh_gpu_instancing, or nodes with extras.feature
  /// The scene is made of objects: nodes with a building's id in `extras`, below them those of its parts.
  bool objects = false;
  GlbGeoreference georeference;
  double position_step = 0;             ///< m: positions are multiples of it; 0 where they are floats
  std::vector<model::Point3> vertices;  ///< of all triangles of bodies, z up, repeated ones included
};

/// Reads a GLB and checks what it can without other files: glTF 2.0, EXT_mesh_features, EXT_structural_metadata,
/// EXT_mesh_gpu_instancing, EXT_instance_features, KHR_mesh_quantization, EXT_meshopt_compression, and that the
/// georeference is the frame of its origin. Never throws on account of the bytes. \param name  of the file, for
/// findings
Glb read_glb(std::string_view bytes, const std::string& name);

/// Adds what another GLB of the same frame holds: a tile in pieces.
void append(Glb& glb, Glb&& piece);

/// m², of what is drawn of a body.
struct DrawnArea {
  double all = 0;     ///< its triangles and those of its elements
  double placed = 0;  ///< those of the elements that are placed: of tiles, pieces of others that are scaled
};
/// Parallel to contents.bodies.
std::vector<DrawnArea> drawn_areas(const Glb& glb);

}  // namespace blockrand::validate
