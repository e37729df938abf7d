// Ways through buildings: where they enter walls, how high they are, and which two portals belong together.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "pipeline/facades/facade_segments.h"
#include "pipeline/facades/wall_frame.h"
#include "pipeline/model/building.h"
#include "pipeline/model/facade.h"

namespace blockrand::facades {

/// Why a portal leads nowhere.
enum class PortalState : std::uint8_t {
  open,        ///< a passage leads to `other`, unless the solid does not take it
  no_partner,  ///< no second portal behind it in this body
  blocked,     ///< its tunnel would meet a wall, the roof or another opening: a bent way, a court between
  not_valid,   ///< the solid with its tunnel fails its check
};
constexpr std::string_view name(PortalState state) {
  constexpr std::string_view names[] = {"open", "no second mouth", "no straight way through",
                                        "the solid with it is not valid"};
  return names[static_cast<int>(state)];
}

/// Where a passage enters a wall: a rectangle in the wall's coordinates, metres.
struct PassagePortal {
  std::uint32_t wall = 0;  ///< index into the walls given
  double left = 0, right = 0, low = 0, high = 0;
  model::WallSegmentKind front = model::WallSegmentKind::passage;  ///< kind of the front that it lies in
  PortalState state = PortalState::no_partner;
  std::uint32_t other = model::kNoOpening;  ///< index of the second portal
  std::vector<model::Point2> outline() const { return {{left, low}, {right, low}, {right, high}, {left, high}}; }
};

/// Takes wall segments of kind passage into the front beside them, so that facades are laid out over the whole of it, and
/// returns their portals. Wall segments without a street, courtyard or side beside them stay. Raised walls have no portals.
///
/// Portals are as wide as their wall segment. Carts need 2.80 m of height and have the ground floor's less 0.6 m, at most
/// 3.6 m (docs/style_measures.md, gateway); passages narrower than kCartWidth have 2.5 m; none reaches nearer to the
/// ceiling of the ground floor than kLintel. Portals that would be lower than kLeastHeadroom are left out.
/// Two portals belong together when each lies straight behind the other's wall (kStraightThrough), the nearest pair
/// first: labels do not tell which way they come from. Pairs whose common height is below kLeastHeadroom are none.
/// What wall segments know of their neighbours is not kept up: link_corners() comes after.
std::vector<PassagePortal> take_portals(const model::BuildingPart& part, std::span<const WallFrame> walls,
                                        std::vector<FacadeSegment>& segments);

inline constexpr double kCartWidth = 2.3;        ///< m
inline constexpr double kStraightThrough = 0.7;  ///< cosine between a passage and the normals of its walls: 45 degrees
inline constexpr double kLintel = 0.3;           ///< m between a passage and the floor above
inline constexpr double kLeastHeadroom = 2.0;    ///< m
inline constexpr double kPortalThreshold =
    0.03;                                    ///< m of wall that stays under a portal: openings do not touch the ground
inline constexpr double kPortalJamb = 0.05;  ///< m of wall that stays beside a portal at a corner of the building

}  // namespace blockrand::facades
