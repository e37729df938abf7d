// Which objects are kept for which tag, and as what: the rows that Interest and docs/osm_keys.md read.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "pipeline/model/extract.h"
#include "pipeline/model/osm_keys.h"

namespace blockrand::importers::osm {

/// What a closed way with a tag is unless area=* says otherwise.
enum class ClosedWay : std::uint8_t { untold, area, line };

/// What a tag makes of an object besides the kinds of features.
enum class ObjectMark : std::uint8_t { none, building, building_part, covered_way };

struct InterestRule {
  std::string_view key;                         ///< one that ends in ':' stands for all keys that begin so
  std::array<std::string_view, 6> values = {};  ///< empty: any. `no` never counts
  std::uint32_t kinds = 0;                      ///< model::FeatureKind bits
  ClosedWay closed = ClosedWay::untold;
  ObjectMark mark = ObjectMark::none;
  bool nodes = true;  ///< counts on nodes too
  bool ways = true;   ///< counts on ways and relations too; otherwise rows behind it may
};

namespace interest_rules {

using enum model::FeatureKind;
using namespace model::osm_key;

constexpr std::uint32_t bit(model::FeatureKind kind) { return static_cast<std::uint32_t>(kind); }

/// In the order of the keys' first letters. Rows of `surrounding` alone count where that is asked for. Of the rows of one key the first counts whose value fits.
// clang-format off
inline constexpr InterestRule kInterestRules[] = {
    {.key = kAdvertising, .kinds = bit(surrounding)},
    {.key = kAerialway, .kinds = bit(surrounding)},
    {.key = kAeroway, .kinds = bit(surrounding)},
    {.key = kAmenity, .kinds = bit(amenity), .closed = ClosedWay::area},
    {.key = kAddrInterpolation, .kinds = bit(address), .closed = ClosedWay::line},
    {.key = "addr:", .kinds = bit(address), .closed = ClosedWay::area},
    {.key = kAreaHighway, .kinds = bit(surrounding), .closed = ClosedWay::area, .nodes = false},
    {.key = kBuilding, .values = {"entrance"}, .kinds = bit(entrance), .mark = ObjectMark::building},
    {.key = kBuilding, .mark = ObjectMark::building},
    {.key = kBuildingPart, .mark = ObjectMark::building_part},
    {.key = kBarrier, .values = {"wall", "fence", "retaining_wall", "city_wall", "hedge"}, .kinds = bit(barrier), .closed = ClosedWay::line, .nodes = false},
    {.key = kBarrier, .kinds = bit(surrounding)},
    {.key = kBoundary, .kinds = bit(boundary), .closed = ClosedWay::area, .nodes = false},
    {.key = kCovered, .mark = ObjectMark::covered_way},
    {.key = kDoor, .kinds = bit(entrance)},
    {.key = kEntrance, .kinds = bit(entrance)},
    {.key = kEmergency, .kinds = bit(surrounding)},
    {.key = kGolf, .kinds = bit(surrounding)},
    {.key = kHighway, .kinds = bit(surrounding), .ways = false},
    {.key = kHistoric, .kinds = bit(surrounding), .ways = false},
    {.key = kHighway, .kinds = bit(street), .closed = ClosedWay::line, .nodes = false},
    {.key = kLanduse, .values = {"reservoir", "basin"}, .kinds = bit(land_use) | bit(water), .closed = ClosedWay::area, .nodes = false},
    {.key = kLanduse, .kinds = bit(land_use), .closed = ClosedWay::area, .nodes = false},
    {.key = kLeisure, .kinds = bit(surrounding), .ways = false},
    {.key = kLeisure, .values = {"track", "slipway"}, .kinds = bit(land_use), .closed = ClosedWay::line, .nodes = false},
    {.key = kLeisure, .kinds = bit(land_use), .closed = ClosedWay::area, .nodes = false},
    {.key = kManMade, .kinds = bit(surrounding)},
    {.key = kNatural, .values = {"tree", "tree_row"}, .kinds = bit(tree), .closed = ClosedWay::line},
    {.key = kNatural, .kinds = bit(surrounding), .ways = false},
    {.key = kNatural, .values = {"water"}, .kinds = bit(water), .closed = ClosedWay::area, .nodes = false},
    {.key = kNatural, .values = {"coastline"}, .kinds = bit(water), .closed = ClosedWay::line, .nodes = false},
    {.key = kNatural, .values = {"cliff", "ridge", "arete", "valley", "earth_bank", "gully"}, .kinds = bit(land_use), .closed = ClosedWay::line, .nodes = false},
    {.key = kNatural, .kinds = bit(land_use), .closed = ClosedWay::area, .nodes = false},
    {.key = kPlayground, .kinds = bit(surrounding)},
    {.key = kPower, .kinds = bit(surrounding)},
    {.key = kPublicTransport, .kinds = bit(surrounding)},
    {.key = kPlace, .kinds = bit(place), .closed = ClosedWay::area},
    {.key = kRailway, .kinds = bit(surrounding), .ways = false},
    {.key = kRailway, .values = {"station", "platform", "turntable", "traverser", "roundhouse", "yard"}, .kinds = bit(railway), .closed = ClosedWay::area, .nodes = false},
    {.key = kRailway, .kinds = bit(railway), .closed = ClosedWay::line, .nodes = false},
    {.key = kRoofRidge, .kinds = bit(roof_line), .closed = ClosedWay::line},
    {.key = kRoofEdge, .kinds = bit(roof_line), .closed = ClosedWay::line},
    {.key = kRoofApex, .kinds = bit(roof_apex)},
    {.key = kShop, .kinds = bit(shop), .closed = ClosedWay::area},
    {.key = kTrafficSign, .kinds = bit(surrounding)},
    {.key = kTourism, .values = {"artwork", "information"}, .kinds = bit(surrounding)},
    {.key = kTunnel, .values = {"building_passage"}, .mark = ObjectMark::covered_way},
    {.key = kWaterway, .values = {"riverbank", "dock", "boatyard"}, .kinds = bit(water), .closed = ClosedWay::area, .nodes = false},
    {.key = kWaterway, .kinds = bit(water), .closed = ClosedWay::line, .nodes = false},
};
// clang-format on

}  // namespace interest_rules

using interest_rules::kInterestRules;

/// Tags that say nothing about the thing itself, beside source:*, note:* and test:*.
inline constexpr std::string_view kRemarkKeys[] = {
    model::osm_key::kType, "created_by", "source", "note", "fixme", "FIXME", "comment", "attribution", "odbl",
    model::osm_key::kArea};

}  // namespace blockrand::importers::osm
