// The one list of what classification measures of a building: every table, weight file and explanation speaks of these.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

#include "pipeline/base/pack.h"

namespace blockrand::classify {

/// X(name, unit, group, meaning). Groups: `footprint` the building's own plan, `situation` how it stands, `around` houses
/// of 40 m² and more with their middle within kNearReach, `row` houses that touch, directly or through others, within
/// kNearReach, `block`, `town`. Lengths in metres on the ground. "House" below means a footprint of kHouseArea and more.
/// `tag` what the mapper noted of the building itself. The others read no tag but that of the street's class.
#define BLOCKRAND_FEATURES(X)                                                                                    \
  X(area, "m2", "footprint", "footprint area")                                                                   \
  X(length, "m", "footprint", "longer side of the smallest rectangle around it")                                 \
  X(breadth, "m", "footprint", "shorter side of the smallest rectangle around it")                               \
  X(elongation, "", "footprint", "longer side over shorter side")                                                \
  X(rectangularity, "", "footprint", "area over that of the smallest rectangle around it")                       \
  X(compactness, "", "footprint", "area over that of the circle of the same perimeter")                          \
  X(corners, "", "footprint", "corners that turn by more than 20 degrees")                                       \
  X(yards, "", "footprint", "courtyards enclosed by the building itself")                                        \
  X(frontage, "m", "situation", "width of the main front")                                                       \
  X(front_depth, "m", "situation", "depth of the house behind the front")                                        \
  X(depth_ratio, "", "situation", "greatest depth over depth behind the front: 1.5 and more with wings")         \
  X(party_share, "", "situation", "share of the outline that touches other buildings")                           \
  X(neighbours, "", "situation", "houses that touch it")                                                         \
  X(front_share, "", "situation", "share of the outline along streets")                                          \
  X(court_share, "", "situation", "share of the outline along courtyards")                                       \
  X(position, "", "situation", "1 free standing, 2 end of row, 3 mid row, 4 corner house, 5 rear, 6 wing")       \
  X(setback, "m", "situation", "main front behind the building line")                                            \
  X(street_distance, "m", "situation", "main front to the middle of its street")                                 \
  X(street_angle, "degree", "situation", "between the main front and its street")                                \
  X(street_class, "", "situation", "1 motorway to 5 tertiary, 6 residential, 7 living street, 8 pedestrian")     \
  X(front_gap, "m", "situation", "from a house without front to the nearest house with one")                     \
  X(around_count, "", "around", "houses within 100 m")                                                           \
  X(around_area, "m2", "around", "median footprint area of the houses within 100 m")                             \
  X(around_spread, "", "around", "spread of footprint areas within 100 m, standard deviation over mean")         \
  X(around_frontage, "m", "around", "median width of fronts within 100 m")                                       \
  X(around_depth, "m", "around", "median depth behind the front within 100 m")                                   \
  X(around_depth_ratio, "", "around", "share of houses with wings within 100 m (depth ratio of 1.5 and more)")   \
  X(around_party_share, "", "around", "mean share of outlines that touch within 100 m")                          \
  X(around_elongation, "", "around", "median of longer over shorter side within 100 m")                          \
  X(around_corners, "", "around", "mean number of corners within 100 m")                                         \
  X(around_built, "", "around", "built share of the land within 100 m")                                          \
  X(around_rear, "", "around", "share of rear buildings and wings within 100 m")                                 \
  X(around_small, "", "around", "small buildings (below 40 m2) per house within 100 m")                          \
  X(row_count, "", "row", "houses in the row")                                                                   \
  X(row_area, "m2", "row", "area of all houses of the row")                                                      \
  X(row_breadth, "m", "row", "shorter side of the smallest rectangle around the row")                            \
  X(row_length, "m", "row", "longer side of the smallest rectangle around the row")                              \
  X(row_fill, "", "row", "area of the row over that of the smallest rectangle around it")                        \
  X(row_alike, "", "row", "share of touching houses with the same frontage and area within a tenth")             \
  X(block_area, "ha", "block", "area of the block")                                                              \
  X(block_built, "", "block", "built share of the block")                                                        \
  X(block_closure, "", "block", "share of the block's street front that is built")                               \
  X(block_court, "", "block", "courtyards' share of the block")                                                  \
  X(block_rear, "", "block", "share of rear buildings and wings in the block")                                   \
  X(street_width, "m", "block", "between the fronts of its street: twice their median distance from its middle") \
  X(town_built, "", "town", "built share of the town around (5 x 5 cells of 250 m)")                             \
  X(town_party_share, "", "town", "share of walls that touch in the town around")                                \
  X(town_density, "1/ha", "town", "buildings per hectare in the town around")                                    \
  X(tag_storeys, "", "tag", "storeys, as tagged")                                                                \
  X(tag_roof, "", "tag",                                                                                         \
    "roof: 1 flat, 2 gabled, 3 hipped, 4 mansard, 5 saltbox (Berlin roof), 6 lean-to, 7 pyramid, 8 other")       \
  X(tag_roof_storeys, "", "tag", "storeys in the roof, as tagged")                                               \
  X(tag_use, "", "tag",                                                                                          \
    "use: 0 untold, 1 flats, 2 residential, 3 house, 4 detached, terraced, 5 outbuilding, 6 offices, 7 shop, 8 " \
    "industry, 9 church, 10 public, 11 hotel, 12 other")                                                         \
  X(tag_year, "", "tag", "year of construction, of start_date or building:architecture")                         \
  X(tag_heritage, "", "tag", "1 known by an article or its architect, 2 listed or historic")                     \
  X(tag_shop, "", "tag", "1 where a shop, office or amenity is noted")                                           \
  X(tag_number, "", "tag", "1 with, 0 without a house number")

enum class Feature : std::uint8_t {
#define BLOCKRAND_FEATURE(name, unit, group, meaning) name,
  BLOCKRAND_FEATURES(BLOCKRAND_FEATURE)
#undef BLOCKRAND_FEATURE
};

struct FeatureInfo {
  std::string_view name, unit, group, meaning;
};

inline constexpr std::array kFeatures = {
#define BLOCKRAND_FEATURE(name, unit, group, meaning) FeatureInfo{#name, unit, group, meaning},
    BLOCKRAND_FEATURES(BLOCKRAND_FEATURE)
#undef BLOCKRAND_FEATURE
};
inline constexpr std::size_t kFeatureCount = kFeatures.size();

/// The features that tags give: left out when classification is to see geometry and context alone.
inline constexpr bool is_tag(Feature f) { return f >= Feature::tag_storeys; }

/// m². Smaller footprints are garages, sheds and kiosks: they say nothing of the houses around
/// (docs/style_measures.md 3.3).
inline constexpr double kHouseArea = 40;
/// m. How far houses speak of the quarter; the age of neighbours is alike up to 128 m (docs/style_measures.md 5.1).
inline constexpr double kNearReach = 100;

/// Steps per unit to which measurements are rounded: 4 mm, 0.4 percent.
inline constexpr float kFeatureSteps = 256;

/// One building's measurements; NaN where one is not known. Unknown ones give no evidence.
class FeatureVector {
 public:
  FeatureVector() { values_.fill(std::numeric_limits<float>::quiet_NaN()); }
  float& operator[](Feature f) { return values_[static_cast<std::size_t>(f)]; }
  float operator[](Feature f) const { return values_[static_cast<std::size_t>(f)]; }
  float at(std::size_t f) const { return values_[f]; }
  bool has(Feature f) const { return (*this)[f] == (*this)[f]; }

 private:
  friend struct base::PackTraits<FeatureVector>;
  std::array<float, kFeatureCount> values_;
};

}  // namespace blockrand::classify

template <>
struct blockrand::base::PackTraits<blockrand::classify::FeatureVector> {
  static void pack(Packer& out, const classify::FeatureVector& f) { out << f.values_; }
  static void unpack(Unpacker& in, classify::FeatureVector& f) { in >> f.values_; }
};
