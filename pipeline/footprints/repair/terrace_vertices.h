// The rings of a row as one flat list of vertices, as mapped: what contacts and corners are made of.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/footprints/repair/terrace_row.h"

namespace blockrand::repair {

/// Vertices by building, polygon, ring and place in the ring. The edge from a vertex to the next one has the vertex's index.
struct TerraceVertices {
  struct RingPlace {
    std::uint32_t building = 0, polygon = 0, ring = 0;  ///< as in TerraceRing
    std::uint32_t first = 0, count = 0;                 ///< its vertices
  };
  std::vector<model::Point2> point;  ///< m
  std::vector<std::int64_t> node;
  std::vector<std::uint32_t> ring_of;  ///< index into `rings`
  std::vector<bool> fixed;             ///< must stay where it is
  std::vector<RingPlace> rings;

  std::uint32_t size() const { return static_cast<std::uint32_t>(point.size()); }
  const RingPlace& ring(std::uint32_t vertex) const { return rings[ring_of[vertex]]; }
  std::uint32_t building(std::uint32_t vertex) const { return ring(vertex).building; }
  std::uint32_t next(std::uint32_t vertex) const {
    const RingPlace& r = ring(vertex);
    return vertex + 1 < r.first + r.count ? vertex + 1 : r.first;
  }
};

TerraceVertices terrace_vertices(const TerraceRow& row, double snap_reach);

}  // namespace blockrand::repair
