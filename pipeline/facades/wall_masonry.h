// Stones on a wall as elements: fitted to its openings, before the solid.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/facades/masonry_orders.h"
#include "pipeline/facades/wall_frame.h"
#include "pipeline/model/element.h"

namespace blockrand::facades {

inline constexpr std::string_view kMasonry = "masonry";

/// A run of a wall that gets stones.
struct MasonryRun {
  std::uint32_t wall = 0;                ///< index into the walls
  double from = 0, to = 0;               ///< m along the wall
  double ground = 0;                     ///< v of the ground under the house
  double turn_left = 0, turn_right = 0;  ///< degrees, where stones go round the corner; 0: they do not
  std::uint64_t seed = 0;
};

/// Looks of stones.
struct MasonryLook {
  model::PartMaterial stones, mortar, dressings;
};

struct MasonryBody {
  model::Element element;  ///< of kind kMasonry; all faces are of the part `wall`
  model::PartMaterial look;
};

struct WallMasonry {
  std::vector<MasonryBody> bodies;  ///< mortar first; all have their origin at (run.from, 0)
  std::vector<std::string> told;    ///< what is simpler than asked, one sentence each
};

/// \param openings  outlines in the wall's coordinates
/// \param covered   the same: what other bodies on the wall hide
WallMasonry wall_masonry(const MasonryRun& run, const WallFrame& wall, const masonry::Masonry& masonry,
                         std::size_t most_triangles, const MasonryLook& look,
                         std::span<const std::vector<model::Point2>> openings,
                         std::span<const std::vector<model::Point2>> covered);

}  // namespace blockrand::facades
