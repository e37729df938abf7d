// The slopes of a roof as places where elements can stand: each plane with axes of its own and what its sides border
// on.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "styles/roofs/roof.h"

namespace blockrand::roofs {

/// What a side of a roof plane borders on.
enum class BorderKind : std::uint8_t {
  eaves,    ///< a level wall top below the plane
  side,     ///< any other wall top: a verge over a gable, a party wall
  top,      ///< a level line above the plane: a ridge, the upper break of a mansard, the high wall of a lean-to
  fold,     ///< a line to another plane of the roof: hip, valley, the break below an upper slope, a gablet
  element,  ///< a dormer or cross gable that stands there already
};

/// A side of a plane, in the direction of its loop: the plane lies left of it.
struct SlopeBorder {
  BorderKind kind = BorderKind::fold;
  model::Point3 start, end;     ///< as in the roof
  std::int32_t edge = -1;       ///< the plan edge whose wall ends here; -1 within the roof
  std::int32_t neighbour = -1;  ///< the surface on the other side; -1 where a wall ends
};

/// Something that stands on a plane without being part of the envelope: a roof window, a chimney.
struct OccupiedPlace {
  std::vector<model::Point2> outline;  ///< convex, in the plane's coordinates
  double distance = 0;                 ///< m that others keep from it
};

/// A sloping surface with axes of its own. A point of the plane is a model::Point2: x is the way along the eaves, to
/// the right for who looks up the slope from outside; y is the way up the slope. Both in metres in the plane itself,
/// not on the plan, so that distances are what a tape on the roof would say.
struct RoofSlope {
  std::size_t surface = 0;  ///< index into Roof::surfaces
  /// Where (0, 0) is: x at the outer loop's leftmost point; y at the eaves (those level with each other that span most
  /// of the slope), else at the lowest point. Elements do not move it.
  model::Point3 origin;
  model::Point2 along_axis, up_axis;              ///< horizontal unit vectors
  double rise = 0;                                ///< m upwards for each m on the plan: tangent of the pitch
  double slope_length = 1;                        ///< m in the plane for each m on the plan: sqrt(1 + rise²)
  std::vector<std::vector<model::Point2>> loops;  ///< the surface's loops in the plane's coordinates
  std::vector<SlopeBorder> borders;               ///< all sides of all loops
  std::vector<OccupiedPlace> occupied;            ///< what was put on it: occupy()

  /// The point of the plane above or below `p`, which need not lie on it.
  model::Point2 in_plane(model::Point2 p) const;
  model::Point2 in_plane(const model::Point3& p) const { return in_plane(p.xy()); }
  /// The place of a point of the plane, `above` metres vertically over it. Not rounded.
  model::Point3 in_space(model::Point2 p, double above = 0) const;
  /// Height of the plane over a place on the plan.
  double height_at(model::Point2 plan) const;
  geometry::Extent along_extent() const;  ///< of the outer loop
  geometry::Extent up_extent() const;     ///< of the outer loop
};

/// The sides of all surfaces of a roof, matched; for those who ask for many planes of one roof.
class RoofBorders {
 public:
  /// \param edges  one per plan edge, or none. Level wall tops at party walls are sides, not eaves.
  RoofBorders(const Roof& roof, std::span<const model::RoofEdge> edges);
  /// The plane of a surface. Empty for surfaces that are level (under kLevelRise), upright, part of an element, or look
  /// down, and on roofs that overhang themselves (onions), where what stands on one surface might run into another.
  std::optional<RoofSlope> slope(std::size_t surface) const;

 private:
  struct Side {
    geometry::Grid3 start, end;
    std::int32_t surface = -1, edge = -1;
    friend auto operator<=>(const Side&, const Side&) = default;
  };
  const Roof* roof_;
  std::vector<model::RoofEdge> edges_;
  std::vector<Side> sides_;  ///< sorted
  bool overhangs_ = false;
};

/// As RoofBorders::slope, for one surface.
std::optional<RoofSlope> roof_slope(const Roof& roof, std::size_t surface, std::span<const model::RoofEdge> edges = {});

/// All planes of a roof, by surface.
std::vector<RoofSlope> roof_slopes(const Roof& roof, std::span<const model::RoofEdge> edges = {});

/// Height of the ridge above a surface: the highest point of it and of what goes on rising over its upper border (the
/// upper slope of a mansard).
double ridge_above(const Roof& roof, std::size_t surface);

/// True for surfaces flatter than kLevelRise that look up.
bool lies_level(const Roof::Surface& surface);

/// Marks a place of the plan (convex, counter-clockwise) as taken on a plane.
void occupy(RoofSlope& plane, std::span<const model::Point2> plan_outline, double distance);

/// Newell's normal of a loop, of unit length, and the mean of its corners: the plane that the checker of solids judges
/// by.
struct CornerPlane {
  model::Point3 normal, mean;
};
CornerPlane corner_plane(std::span<const model::Point3> loop);

inline constexpr double kLevelRise = 0.05;  ///< tangent of 3 degrees: below, a surface is level
inline constexpr double kLevelLine =
    0.02;  ///< m from end to end: rounding and merged nodes leave level lines that uneven
/// m. Corners of a surface farther off its plane than this leave too little of the checker's 0.01 m for more corners.
inline constexpr double kEvenSurface = 0.006;

}  // namespace blockrand::roofs
