// Faces cut into an inner part and strips along their edges.
#pragma once

#include <span>
#include <vector>

#include "styles/grammar/shapes/plan_skeleton.h"

namespace blockrand::grammar {

/// Inner faces first, then the strips along the edges in order; each strip starts with its outline edge.
struct OffsetFaces {
  Mesh mesh;  ///< in the coordinates of the mesh given; neighbours share vertices
  std::vector<std::int32_t>
      edges;          ///< by face: the corner of the old face (ring by ring) whose edge it lies along; -1: inside
  bool done = false;  ///< false: the face is not simple, or no distance is above 0
};

/// \param distances  m, inwards, by corner of the face (the edge that starts there); 0 or less: the edge stays
OffsetFaces inset_faces(const Mesh& mesh, std::size_t face, std::span<const double> distances);

}  // namespace blockrand::grammar
