// The weighted straight skeleton: roofs of any plan with a pitch for every edge, and pitches that change with height.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

/// Slope of an upright face, a gable: the edge does not move.
inline constexpr double kUpright = std::numeric_limits<double>::infinity();

/// From `height` on, the roof rises with `slope`.
struct SlopeChange {
  double height =
      0;  ///< m above the eaves, rounded to the grid: at least one step, and one above the change before; to 2 km
  double slope = 1;  ///< rise over run, or kUpright
};

/// How steeply the roof rises from an edge. Changes in rising order of height.
struct EdgeProfile {
  double slope = 1;  ///< rise over run: the tangent of the pitch; kUpright for a gable
  std::vector<SlopeChange> changes;
};

/// Eaves without length in a corner between two upright edges, one along each of them: from there two slopes rise, with
/// a valley between them. So the roof of a corner house falls to the yard that touches its plan in one point.
struct CornerEaves {
  std::uint32_t corner = 0;  ///< convex; the edges that end and start here are upright and stay so
  EdgeProfile profile;       ///< of both slopes
};

struct WeightedSkeletonNode {
  model::Point2 point;  ///< m, not rounded
  double height = 0;    ///< m above the eaves
};

/// One plane's region of the roof.
struct WeightedSkeletonFace {
  static constexpr std::uint32_t kDeck = 0xffffffff;
  static constexpr std::uint32_t kCorner = 0xfffffffe;
  std::uint32_t edge =
      0;  ///< the edge it rises from (of several on one line the first one); kDeck; kCorner (CornerEaves)
  std::uint32_t level = 0;  ///< how many changes of slope lie below it
  bool upright = false;     ///< stands on its edge's line; no area seen from above
  /// Counter-clockwise from above (upright ones: from outside), into WeightedSkeleton::nodes. The first loop is the
  /// outer ring; holes follow in decks, and in faces that have flowed around something and met behind it. Where a
  /// plane's region is in pieces, each is a face; some have almost no area, as roof_surfaces() knows.
  std::vector<std::vector<std::uint32_t>> loops;
};

struct WeightedSkeleton {
  std::vector<WeightedSkeletonNode> nodes;  ///< the polygon's corners first, in ring order
  std::vector<WeightedSkeletonFace> faces;  ///< in order of edge and level, decks last
  std::vector<std::uint32_t> merged;        ///< for each edge the one that it continues on one line, itself for most
  double height() const;                    ///< m, the highest node
};

enum class SkeletonFailure : std::uint8_t {
  too_large,  ///< farther than kWidestSkeleton from the first corner, more corners than kMostWeightedCorners, or no
              ///< ring of three corners
  bad_slope,  ///< beyond kLeastSlope and kSteepestSlope, changes out of order, changes or a deck below one grid step,
              ///< CornerEaves at a corner that does not take them
  unbounded,  ///< upright edges leave a part that no slope ever closes
  inconsistent,  ///< the polygon is not strictly simple, or a mistake of ours
};
std::string_view name(SkeletonFailure failure);

inline constexpr double kLeastSlope = 0.005;     ///< rise over run; flatter roofs are flat
inline constexpr double kSteepestSlope = 1000;   ///< rise over run; steeper ones are upright
inline constexpr double kWidestSkeleton = 8000;  ///< m from the first corner; 24 bits of grid steps between corners
inline constexpr std::size_t kMostWeightedCorners = 5000;  ///< events are looked for in O(corners x reflex corners)

/// Weighted straight skeleton of a strictly simple polygon with holes on the grid.
///
/// Every edge's line moves inwards at the speed of its slope's inverse (an upright one not at all), its slope changing
/// at the heights of its profile; faces are what the moving edges sweep over. Edge, split and vertex events, any number
/// of them at one time and place, are one case: all that meets in a point is cut there and joined anew, sector by
/// sector. Guarantees: every event's order and place is decided exactly, in integers, behind a filter of doubles (a
/// slope is rounded once to a rational number, by less than 1e-6 of itself, then nothing is); so what meets when never
/// depends on rounding; only coordinates of nodes are rounded, to double precision, and with them how a face that
/// touches itself in a node is told into loops. Faces cover the polygon without overlap, and the roof is continuous.
///
/// Rules for edges on one line: with the same profile they have one plane, and where their faces meet they are one
/// face. Of edges with different slopes that come to lie on one line side by side, the steeper one takes the plane of
/// the gentler from that height on (a gable wall met by eaves is a gable up to there). Edges that continue each other
/// in the polygon are one from the beginning, with the profile that is gentler where the two first differ.
///
/// \param profiles  one per edge, ring by ring, outer ring first; edge i starts at corner i
/// \param deck      m: at this height the roof ends in a flat deck; none by default
/// \param corners   eaves without length, no two in one corner
/// O(n r log n) for n corners, r of them reflex; plans of ten corners take some ten microseconds.
tl::expected<WeightedSkeleton, SkeletonFailure> weighted_skeleton(const model::Polygon& polygon,
                                                                  std::span<const EdgeProfile> profiles,
                                                                  std::optional<double> deck = {},
                                                                  std::span<const CornerEaves> corners = {});

}  // namespace blockrand::geometry
