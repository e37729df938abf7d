// The unweighted straight skeleton of a polygon with holes by CGAL, as plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

/// A node: either a corner of the polygon (time 0) or a meeting point of the inward-moving edges.
struct SkeletonNode {
  model::Point2 point;  ///< m
  double time = 0;      ///< m: distance to the edges that meet here
  bool contour = false;
};

/// The region that one polygon edge sweeps over: `nodes` counter-clockwise, starting with the edge's two ends.
struct SkeletonFace {
  std::uint32_t edge = 0;            ///< edges are numbered ring by ring, outer first; edge i starts at corner i
  std::vector<std::uint32_t> nodes;  ///< into StraightSkeleton::nodes; the first two are corners
};

struct StraightSkeleton {
  std::vector<SkeletonNode> nodes;  ///< the corners first, in ring order
  std::vector<SkeletonFace> faces;  ///< one per edge, in edge order
  double height() const;            ///< the largest time
};

/// CGAL's events grow with the square of the corners: beyond this number a plan has no skeleton here, so that one
/// footprint of 20,000 points cannot fill the memory (measured: 4 GB). Callers simplify the plan or build it flat.
inline constexpr std::size_t kMostSkeletonCorners = 700;

/// Straight skeleton of a valid polygon (outer counter-clockwise, holes clockwise, coordinates on the grid), all edges
/// moving at unit speed, by CGAL (Create_straight_skeleton_2, exact constructions). It is the oracle that
/// weighted_skeleton() is tested against, and the fallback where that gives up. Node positions are not rounded.
/// Empty beyond kMostSkeletonCorners, and when CGAL gives up or its faces do not match the edges one to one.
std::optional<StraightSkeleton> straight_skeleton(const model::Polygon& polygon);

}  // namespace blockrand::geometry
