// How far things on a roof keep from its borders and from each other, and where on a slope they go.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "styles/roofs/roof_slopes.h"

namespace blockrand::roofs {

// ---- the rules, in metres. docs/sources.md, Holtmeier 5.3, from the design guide of Lübeck's Gründungsviertel, unless
// another source stands there.

inline constexpr double kEavesDistance = 1.00;    ///< dormers and roof windows from the eaves
inline constexpr double kBetweenElements = 1.50;  ///< dormers, roof windows and cross gables from each other
inline constexpr double kSideDistance = 1.00;     ///< all of them from the outer side: verge or party wall
inline constexpr double kWidestElement = 3.00;    ///< dormers and cross gables
/// From hips, valleys and the lower border of an upper slope (own choice): half of kBetweenElements, so that elements
/// on both sides of a fold keep that distance over the fold.
inline constexpr double kFoldDistance = kBetweenElements / 2;
/// From a ridge or break above (own choice): a course of tiles, so that the element's roof dies into its own slope.
inline constexpr double kTopDistance = 0.30;
/// What is smaller is no part of a building but a trap for the grid.
inline constexpr double kLeastPart = 0.10;
/// Distances that fall short by no more are kept: corners on the 1/1024 m grid move by up to 0.85 mm, those of both.
inline constexpr double kDistanceSlack = 0.002;
/// Roofs that take dormers and roof windows: flatter, tiles do not keep the rain out; steeper is a wall
/// (docs/style_measures.md §2.7 has mansards of up to 80 degrees).
inline constexpr double kFlattestSlope = 15, kSteepestSlope = 80;  ///< degrees

/// The distances that one element keeps, all in metres and in the plane of the roof.
struct ElementDistances {
  double eaves = kEavesDistance;
  double between = kBetweenElements;
  double side = kSideDistance;
  double fold = kFoldDistance;
  double top = kTopDistance;
  double from(BorderKind kind) const;
};

/// True when the plane's pitch lies within kFlattestSlope to kSteepestSlope.
bool takes_elements(const RoofSlope& plane);

/// True when `outline` (in the plane's coordinates, counter-clockwise) lies in the plane with its distances from all
/// borders, holes and occupied places.
/// \param flush  the outline stands on eaves with its lowest side, which lies within one of them, kLeastPart from its
///               ends: the place of a cross gable. No distance is kept from eaves level with it.
bool fits(const RoofSlope& plane, std::span<const model::Point2> outline, const ElementDistances& distances,
          bool flush = false);

/// True for eaves that run along their plane, up the slope by `up` m: where a front can stand flush.
bool is_level_eaves(const RoofSlope& plane, const SlopeBorder& border, double up);

/// What is wanted on a slope.
struct LayoutRequest {
  std::vector<model::Point2>
      outline;                 ///< convex, counter-clockwise, in the plane, about the middle of its lower edge: (0, 0)
  double up = kEavesDistance;  ///< m up the slope to the lower edge
  bool flush = false;          ///< as in fits(); `up` is that of the eaves, 0 for most
  std::optional<int> count;    ///< how many; none: one for each axis or step, else as many as fit
  std::vector<double> axes;    ///< window axes, places along the plane: elements stand on them only
  double step = 0;             ///< m between axes where none are given: axes about the slope's middle; 0: none
};

struct Layout {
  std::vector<double> along;  ///< middles of those that fit, rising
  int did_not_fit = 0;        ///< how many of those wanted
};

/// Puts as many of the wanted elements on a slope as fit, evenly: with axes on every first, second ... one (where the
/// count falls short, on what leaves the most), else in equal fields, moved only where a border asks for it. Depends on
/// nothing else.
Layout lay_out(const RoofSlope& plane, const LayoutRequest& wanted_layout, const ElementDistances& distances = {});

/// Stretches along a slope where the middle of one element may stand, rising; a stretch may be a point.
std::vector<std::pair<double, double>> free_intervals(const RoofSlope& plane, const LayoutRequest& wanted_layout,
                                                      const ElementDistances& distances = {});

}  // namespace blockrand::roofs
