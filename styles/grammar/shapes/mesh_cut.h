// Cutting meshes with planes.
#pragma once

#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

/// Vertices nearer to a cutting plane than this lie in it; metres.
inline constexpr double kInPlane = 1e-7;

struct Plane {
  Vector3 normal;     ///< length one
  double offset = 0;  ///< dot(normal, p) of its points
  double distance(Vector3 p) const { return dot(normal, p) - offset; }
};

/// The part of the mesh on the side that the normal points to. Faces in the plane are dropped where the mesh is cut;
/// where all lies on the kept side the mesh is returned as it is, where nothing does an empty one.
///
/// Faces keep their first edge where it survives, else a piece of it, else the next along the outline; uv and tags
/// are kept, uv between corners interpolated. Faces may fall into several.
/// \param cap  fills the section with faces (outwards, first edge the first cut edge): for closed meshes
/// \return true when something was cut away
bool cut_mesh(Mesh& mesh, const Plane& plane, bool cap);

}  // namespace blockrand::grammar
