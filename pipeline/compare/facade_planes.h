// Walls gathered by the plane they stand in, whatever pieces they were drawn in. Internal to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/compare/city.h"
#include "pipeline/compare/facade_agreement.h"

namespace blockrand::compare {

/// Walls in one plane whose ends are farther apart along it are different facades. m: wider than the joint between two
/// houses or a rainwater pipe's niche, narrower than the narrowest passage (Traufgasse, Bauwich) between two houses.
inline constexpr double kFacadeGap = 1.5;

/// Area, centre and normal of a plane polygon with holes. Sums of area times normal and of area times centre do not
/// change when a polygon is cut into pieces: what rests on them does not depend on tessellation.
struct Flat {
  double area = 0;  ///< m², holes taken off; 0 also for rings of fewer than three points or with NaN
  Point3 normal;    ///< unit vector as the outer ring's order says
  Point3 centre;
};
Flat flat_of(const Rings3& rings);

/// A wall polygon with the direction it looks to.
struct WallPiece {
  std::uint32_t building = 0, face = 0;  ///< indices into City::buildings and Building::faces
  Point2 normal;                         ///< outwards, unit
  double area = 0;
  Point3 centre;
};

/// Walls that make one facade.
struct WallGroup {
  Point2 normal;                  ///< of its largest wall, outwards, unit
  double offset = 0;              ///< normal * p for the points of that wall
  double left = 0, right = 0;     ///< extent along (-normal.y, normal.x): from left to right as seen from outside
  double bottom = 0, top = 0;     ///< z
  std::vector<WallPiece> pieces;  ///< sorted by building and face
  Point2 along() const { return {-normal.y, normal.x}; }
};

/// Gathers the walls of `buildings` by plane.
///
/// Outside is the side on which the building's footprint is not, 0.3 m (or, where that does not tell, 1 m) from the
/// wall; where neither tells, the ring's order does, turned round in buildings whose other walls turn out to be drawn
/// inside out. Walls in one plane (20 mm) are cut where nothing of them lies for more than kFacadeGap; then the largest
/// such stretch gathers all others within plane_angle and plane_distance of it that lie no farther than that gap from
/// what it has gathered, then the largest of the rest, and so on. Groups that are narrower than min_width or lower than
/// min_height are dropped. In no particular order, but always the same.
std::vector<WallGroup> wall_groups(const City& city, std::span<const std::uint32_t> buildings,
                                   const FacadeOptions& options);

}  // namespace blockrand::compare
