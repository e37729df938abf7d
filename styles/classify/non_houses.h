// What is mapped as a building and is no house: monuments, garages, tanks, stelae. A stated rule, no guess of a model.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/model/point.h"
#include "styles/classify/catalogue.h"
#include "styles/classify/tag_lookup.h"

namespace blockrand::classify {

/// What the rule is told of a building.
struct NonHouseFacts {
  std::string_view use;             ///< value of building=*
  TagLookup tag;                    ///< may be empty: no other tags known
  double area = 0;                  ///< m², footprint
  bool has_address = false;         ///< a house number of its own, or a node with one inside
  std::optional<double> storeys;    ///< as tagged
  int equal_neighbours = 0;         ///< by equal_neighbours()
  bool on_memorial_ground = false;  ///< lies on an area tagged historic=*, tourism=* or landuse=cemetery
};

struct NonHouse {
  std::string kind;   ///< a table [kind.…] of the file, or `field_of_equals`, `tiny`, `outbuilding`
  std::string style;  ///< id in the catalogue
  std::string why;    ///< a sentence for laymen
  /// Whether no tag but house number and storeys was asked: kinds that are not in the file.
  bool by_geometry() const { return kind == "field_of_equals" || kind == "tiny" || kind == "outbuilding"; }
};

/// A kind of the file.
struct NonHouseKind {
  std::string name, what, style = "ancillary";
  bool any_use = false;          ///< its tags count whatever building=* says
  bool without_address = false;  ///< its tags do not count where there is an address
  double largest_area = 1e9;     ///< m²
};

/// configs/styles/non_houses.toml, where each number has its reason.
struct NonHouseRules {
  double tiny_area = 10;   ///< m²
  double small_area = 40;  ///< m²
  int equal_count = 12;
  double equal_radius = 15;            ///< m, between centres: the reach of the rule
  double equal_area_tolerance = 0.25;  ///< of the larger area
  double equal_largest_area = 40;      ///< m²
  int equal_count_on_memorial_ground = 4;
  std::vector<std::string> dwellings, generic_uses;        ///< ascending
  std::vector<NonHouseKind> kinds;                         ///< by name
  std::map<std::string, std::size_t, std::less<>> by_use;  ///< value of building=* → index into kinds
  struct TagRule {
    std::string key, value;  ///< value `*`: any but `no`
    std::size_t kind = 0;
  };
  std::vector<TagRule> tags;
};

/// Reads `<configs>/styles/non_houses.toml`.
/// \param catalogue  for the ids of styles
/// \throws base::InputError with file, line and column for anything unknown, missing, out of range or said twice
NonHouseRules read_non_houses(const std::string& configs, const Catalogue& catalogue);

/// A rectangle that may be one of many: centre (m), area (m²), corners of its ring.
struct SmallPlan {
  model::Point2 place;
  double area = 0;
  int corners = 0;
};

/// How many others like it each plan has around it: four corners, no larger than `equal_largest_area`, areas that
/// differ by `equal_area_tolerance` of the larger at most, centres within `equal_radius`. Does not depend on the order
/// of plans.
std::vector<int> equal_neighbours(std::span<const SmallPlan> plans, const NonHouseRules& rules);

/// What the building is instead of a house, or nothing. In this order:
/// 1. building=* names a kind (and it is not larger than the kind allows);
/// 2. another tag does, where building=* is generic or the kind holds for any;
/// 3. it stands in a field of equal small rectangles, without address, storeys or dwelling;
/// 4. it is tiny, without address and without a second storey;
/// 5. it is small, without address, storeys, shop and dwelling.
std::optional<NonHouse> non_house(const NonHouseFacts& facts, const NonHouseRules& rules);

}  // namespace blockrand::classify
