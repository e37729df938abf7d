// What stands in single nodes and short ways and belongs to a wall: entrances, addresses, trees, passages.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/context/street_network.h"
#include "pipeline/model/extract.h"
#include "pipeline/model/osm_id.h"
#include "pipeline/model/point.h"

namespace blockrand::context {

/// A way through or under a building: tunnel=building_passage, or covered.
struct PassageWay {
  model::OsmId id;
  std::string name;                   ///< of the way, mostly empty
  double width = 0;                   ///< m, of its portals: as tagged, else assumed by the kind of way
  bool covered_only = false;          ///< covered=*: may run along a building as well as through one
  std::vector<model::Point2> points;  ///< m, on the grid
  std::vector<std::int64_t> nodes;    ///< parallel to `points`
};

// m. Widths of portals where no tag tells.
inline constexpr double kFootPassageWidth = 2.5;     ///< footways, paths, steps: a door for a cart
inline constexpr double kServicePassageWidth = 3.5;  ///< service ways: a gateway for a lorry
inline constexpr double kStreetPassageWidth = 5.5;   ///< streets: two cars pass
/// m. `width` beyond these is a slip.
inline constexpr double kMinPassageWidth = 0.8, kMaxPassageWidth = 15;

/// The passages of an extract, in the order of Extract::features.
std::vector<PassageWay> passage_ways(const model::Extract& extract, const Project& project);

enum class SitePointKind : std::uint8_t { entrance, address, tree, shop };

/// A node that may belong to a wall.
struct SitePoint {
  model::OsmId id;
  SitePointKind kind = SitePointKind::entrance;  ///< an entrance with an address is an entrance; shop: neither
  model::Point2 place;                           ///< m, on the grid
  std::string street;                            ///< addr:street, or empty
  std::string house_number;                      ///< addr:housenumber, or empty
  std::string use;                               ///< by UseOfTags, of whatever kind but trees; or empty
};

/// What a mapped point is used for, by its tags: a category such as `shop`; empty for nothing that is known.
using UseOfTags = std::function<std::string_view(const std::function<std::string_view(std::string_view)>& tag)>;

/// Entrances, address nodes and trees of an extract, and shops and amenities that have a use (nodes only), in the order
/// of Extract::features. \param use_of  may be empty: no use is known, and shops without an address are no points
std::vector<SitePoint> site_points(const model::Extract& extract, const Project& project, const UseOfTags& use_of = {});

/// What a building's own tags say of its address: addr:street and addr:housenumber, either may be empty.
struct BuildingAddress {
  model::OsmId id;
  std::string_view street, house_number;
};

/// The address in the tags of a building; the views live as long as the extract.
BuildingAddress building_address(const model::Extract& extract, model::OsmId id, model::Range tags);

/// The street in a building's own address, or empty.
std::string_view address_street(const model::Extract& extract, model::Range tags);

}  // namespace blockrand::context
