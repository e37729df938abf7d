// Ways through buildings: where they enter walls, how high they are, and which two mouths belong together.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "pipeline/facades/facade_stretches.h"
#include "pipeline/facades/wall_frame.h"
#include "pipeline/model/building.h"
#include "pipeline/model/facade.h"

namespace blockrand::facades {

/// Why a mouth leads nowhere.
enum class MouthState : std::uint8_t {
  open,        ///< a passage leads to `other`, unless the solid does not take it
  no_partner,  ///< no second mouth behind it in this body
  blocked,     ///< its tunnel would meet a wall, the roof or another opening: a bent way, a court between
  not_valid,   ///< the solid with its tunnel fails its check
};
constexpr std::string_view name(MouthState state) {
  constexpr std::string_view names[] = {"open", "no second mouth", "no straight way through",
                                        "the solid with it is not valid"};
  return names[static_cast<int>(state)];
}

/// Where a passage enters a wall: a rectangle in the wall's coordinates, metres.
struct PassageMouth {
  std::uint32_t wall = 0;  ///< index into the walls given
  double left = 0, right = 0, low = 0, high = 0;
  model::EdgeKind front = model::EdgeKind::passage;  ///< kind of the front that it lies in
  MouthState state = MouthState::no_partner;
  std::uint32_t other = model::kNoOpening;  ///< index of the second mouth
  std::vector<model::Point2> outline() const { return {{left, low}, {right, low}, {right, high}, {left, high}}; }
};

/// Takes stretches of kind passage into the front beside them, so that facades are laid out over the whole of it, and
/// returns their mouths. Stretches without a street, courtyard or side beside them stay. Raised walls have no mouths.
///
/// Mouths are as wide as their stretch. Carts need 2.80 m of height and have the ground floor's less 0.6 m, at most
/// 3.6 m (references/styles.md, gateway); passages narrower than kCartWidth have 2.5 m; none reaches nearer to the
/// ceiling of the ground floor than kLintel. Mouths that would be lower than kLeastHeadroom are left out.
/// Two mouths belong together when each lies straight behind the other's wall (kStraightThrough), the nearest pair
/// first: labels do not tell which way they come from. Pairs whose common height is below kLeastHeadroom are none.
/// What stretches know of their neighbours is not kept up: link_corners() comes after.
std::vector<PassageMouth> take_mouths(const model::BuildingPart& part, std::span<const WallFrame> walls,
                                      std::vector<FacadeStretch>& stretches);

inline constexpr double kCartWidth = 2.3;        ///< m
inline constexpr double kStraightThrough = 0.7;  ///< cosine between a passage and the normals of its walls: 45 degrees
inline constexpr double kLintel = 0.3;           ///< m between a passage and the floor above
inline constexpr double kLeastHeadroom = 2.0;    ///< m
inline constexpr double kMouthThreshold =
    0.03;                                   ///< m of wall that stays under a mouth: openings do not touch the ground
inline constexpr double kMouthJamb = 0.05;  ///< m of wall that stays beside a mouth at a corner of the building

}  // namespace blockrand::facades
