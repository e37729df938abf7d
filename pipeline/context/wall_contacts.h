// Where neighbours and passages meet an outline.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/context/wall_segments.h"

namespace blockrand::context {

/// A straight edge of an outline, the building on its left.
struct OutlineEdge {
  std::uint32_t polygon = 0, ring = 0, edge = 0;  ///< as in model::WallSegment
  std::int64_t from_node = 0, to_node = 0;
  model::Point2 a, b;
  model::Point2 along = {}, outward = {};  ///< unit vectors
  double length = 0;                       ///< m
  model::Point2 at(double metres) const { return {a.x + along.x * metres, a.y + along.y * metres}; }
};

/// All edges of an outline, in the order of polygons, rings and points. Edges without length have no directions.
std::vector<OutlineEdge> edges_of(const std::vector<model::Polygon>& outline);

/// A wall segment of an edge with a neighbour's wall against it.
struct Contact {
  double start = 0, end = 0;  ///< m along the edge
  model::OsmId neighbour;
};

/// The contacts of an edge in order, without overlaps: where several neighbours compete, the longest contact wins, then
/// the least id.
std::vector<Contact> contacts_of(const OutlineEdge& edge, model::OsmId own, bool canopy, const VicinityIndex& index,
                                 const WallSegmentOptions& options);

/// A wall segment of an edge that is the portal of a passage.
struct Portal {
  double start = 0, end = 0;  ///< m along the edge
  std::uint32_t passage = 0;  ///< index into Vicinity::passages
};

/// The portals in all edges, parallel to `edges`, each in order and without overlaps. The portal of an arcade reaches to the
/// corner of the front along which it runs.
std::vector<std::vector<Portal>> portals_of(const model::Building& building, const std::vector<OutlineEdge>& edges,
                                            const VicinityIndex& index, const WallSegmentOptions& options);

}  // namespace blockrand::context
