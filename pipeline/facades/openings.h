// Cuts windows, doors and passages into the walls of a solid.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/facades/wall_frame.h"
#include "pipeline/model/facade.h"
#include "pipeline/model/solid.h"

namespace blockrand::facades {

/// What shall be cut into one wall.
struct WallOpening {
  std::uint32_t wall = 0;  ///< index into the walls that are given
  model::OpeningKind kind = model::OpeningKind::window;
  std::vector<model::Point2> outline;  ///< in the wall's coordinates, counter-clockwise, simple, straight pieces
  double reveal = 0;                   ///< m into the wall; less than kLeastReveal is flush
  std::int32_t storey = 0;             ///< 0: ground floor
  std::uint32_t through =
      model::kNoOpening;  ///< passages: the other portal, an opening in another wall with as many points
};

/// Why an opening is not cut.
enum class OpeningRefusal : std::uint8_t {
  none,
  bad_outline,      ///< not simple by kLeastFeature, not counter-clockwise, smaller than kLeastOpening, not finite
  beyond_wall,      ///< nearer than kOpeningClearance to the wall's border, or beyond it
  meets_opening,    ///< nearer than that to an opening before it, in its wall or around a corner
  wall_too_thin,    ///< its reveal would come out of another wall, the roof or the ground; or it looks into a slit
  passage_blocked,  ///< its tunnel would, or its portals do not fit together
};
inline constexpr int kOpeningRefusalCount = 6;
constexpr std::string_view name(OpeningRefusal refusal) {
  constexpr std::string_view names[] = {"none",          "bad_outline",   "beyond_wall",
                                        "meets_opening", "wall_too_thin", "passage_blocked"};
  return names[static_cast<int>(refusal)];
}

inline constexpr double kOpeningClearance = 0.02;  ///< m of wall that stays around openings; 20 steps of the grid
inline constexpr double kLeastReveal = 0.01;       ///< m; thinner reveals would be slivers
inline constexpr double kLeastOpening = 0.05;      ///< m, width and height
/// m from a corner of an outline to any edge that does not end there. Rounding moves corners by less than 0.001 m, and
/// geometry::check_solid wants 0.002 m.
inline constexpr double kLeastFeature = 0.005;
inline constexpr double kLeastPassage = 0.6;  ///< m across a tunnel, at both portals: a person's width
inline constexpr double kLeastBehind = 0.05;  ///< m between a reveal's end and what stands behind it

/// Which grid point a corner of an opening becomes.
enum class CornerRounding : std::uint8_t {
  nearest,
  behind_wall,  ///< the nearest in the wall's plane or behind: another part of the building may stand before the wall
};

/// A solid with openings.
struct OpenedSolid {
  model::Solid solid;                    ///< faces of the closed one first, in their order; walls have holes
  std::vector<model::Opening> openings;  ///< those that were cut, in the order given
  std::vector<std::uint32_t> given;      ///< for each of them its index among those given
  std::vector<OpeningRefusal> refusals;  ///< for each one given; `none` for those that were cut
  /// Walls that would fold by rounding (geometry::normal_deviation) got points on their border next to openings, and so
  /// did the faces that they share it with: all of these, ascending. The points are the last of solid.vertices.
  std::vector<std::uint32_t> changed_borders;
  std::uint32_t first_border_point = 0;
  /// Walls with holes whose border stayed, measured as they are: they do not fold by more than geometry::kBuilt allows.
  /// Ascending.
  std::vector<std::uint32_t> unfolded;
  /// Triangles of walls with holes whose border stayed, by geometry::triangulate; ascending by face.
  std::vector<std::pair<std::uint32_t, std::vector<std::array<std::uint32_t, 3>>>> triangles;
};

/// Cuts openings in the order given: one that does not fit is left out, and never harms those before it.
///
/// Each opening becomes a hole in its wall; reveal faces (kind wall) that lead straight into the building; at their end
/// a polygon of kind window or door, the outline's exact copy moved by the reveal. Reveals are exact parallelograms,
/// since their depth is rounded to the grid once. A passage leads from one portal to the other: floor (outer_floor),
/// sides (wall) and ceiling (outer_ceiling), each quadrangle cut in two where it is not plane. That openings lie in
/// their walls and apart is tested in the drawing of each wall, with distances that rounding cannot use up; what stands
/// behind them by boxes that are never too small. The result is closed where `solid` is, and valid where proved_valid()
/// says so (opening_proof.h).
///
/// \param solid  valid (geometry::check_solid)
/// \param walls  some of its walls, as wall_frame() makes them
/// \param rounding  of the corners of openings
OpenedSolid cut_openings(const model::Solid& solid, std::span<const WallFrame> walls,
                         std::span<const WallOpening> openings, CornerRounding rounding = CornerRounding::nearest);

}  // namespace blockrand::facades
