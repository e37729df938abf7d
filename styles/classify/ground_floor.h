// What the ground floor is used for: mapped shops and amenities, else a rule for shops.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/sourced.h"
#include "styles/classify/catalogue.h"
#include "styles/classify/tag_lookup.h"

namespace blockrand::classify {

/// A category of uses: shop, gastronomy, office, ...
struct GroundFloorCategory {
  std::string name;
  std::vector<std::string> uses;                          ///< values of building=*
  std::vector<std::pair<std::string, std::string>> tags;  ///< key and value, `*` for any
  double on_ground_floor = 0.5;  ///< share of such points inside a building that are on its ground floor
};

/// configs/styles/ground_floor.toml.
struct GroundFloorRules {
  std::vector<GroundFloorCategory> categories;  ///< in their order of precedence
  std::vector<model::Morphology> shop_morphologies;
  std::vector<std::string> shop_uses;  ///< ascending
  double least_storeys = 2;
  double corner = 0.3, highest = 0.95, elsewhere = 0.02;
  std::map<std::string, double, std::less<>> shop_by_street;
  double shop_by_other_street = 0.15;

  /// Index of the category that tags of one object (the building, or a point in it) mean; empty for none. Values that
  /// are named go before `*`.
  std::optional<std::size_t> category(const TagLookup& tag) const;
};

/// \throws base::InputError with file, line and column for anything unknown, missing, out of range or said twice
GroundFloorRules read_ground_floor(const std::string& configs);

/// What the rule is told of a building.
struct GroundFloorFacts {
  std::string_view use;           ///< value of building=*
  TagLookup tag;                  ///< may be empty: no other tags known
  std::span<const int> points;    ///< mapped inside the footprint, by index of category; may be empty
  const Style* style = nullptr;   ///< its likeliest style; nullptr: not known
  bool faces_street = false;      ///< a front house, not a wing or rear building
  bool corner_house = false;      ///< fronts on two streets that meet
  std::string_view street_class;  ///< of the street it fronts on, as WallSegment::street_class
  std::optional<double> storeys;  ///< resolved
};

struct GroundFloorUse {
  std::string value;  ///< name of a category; else the use of the whole building, `residential` where unknown
  model::Source source = model::Source::default_;
  float confidence = 0;  ///< in [0, 1]
  std::string evidence;  ///< a sentence for laymen
};

/// In this order: a shop, amenity, office or craft tag on the building (`tag`); building=* names one (`implied`);
/// points in it, where it is more likely than not that one of their category is on the ground floor (`geometry`); the
/// shop rule by style, street, corner and storeys (`preset`); the use of the whole building (`default`).
GroundFloorUse ground_floor_use(const GroundFloorFacts& facts, const GroundFloorRules& rules);

}  // namespace blockrand::classify
