#include "pipeline/surroundings/water_level.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "pipeline/model/osm_keys.h"

namespace blockrand::surroundings {

using model::Point2;
namespace osm_key = model::osm_key;

namespace {
/// m between places of the outline where the terrain is asked: sides of its triangles.
constexpr double kSample = 12.5;
/// How many places are asked at most: of larger waters fewer, evenly.
constexpr double kMostSamples = 2000;
/// m: how much higher the middle of the sorted heights of an outline lies than its lowest decile, at most: banks of lakes and
/// rasters of 5 m differ by less, a river falls by more.
constexpr double kMostSpread = 3;
}  // namespace

bool is_still_water(const TagOf& tag) {
  if (tag(osm_key::kLeisure) == "swimming_pool") return true;
  const std::string_view waterway = tag(osm_key::kWaterway);
  if (!waterway.empty()) return waterway == "dock";
  constexpr std::array<std::string_view, 8> kFlowing{"river", "canal",     "stream", "ditch",
                                                     "drain", "fish_pass", "rapids", "wastewater"};
  return std::ranges::find(kFlowing, tag(osm_key::kWater)) == kFlowing.end();
}

std::optional<double> bank_level(const ClaimFinder& claims, const Thing& thing, bool area, const HeightAt& terrain) {
  if (!terrain || !area || !is_still_water(claims.tags_of(thing.feature))) return std::nullopt;
  const std::vector<std::vector<Point2>> rings = claims.lines_of(thing);
  double length = 0;
  const auto side = [](const std::vector<Point2>& ring, std::size_t i) {
    const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
    return std::pair(a, Point2{b.x - a.x, b.y - a.y});
  };
  for (const std::vector<Point2>& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 d = side(ring, i).second;
      length += std::hypot(d.x, d.y);
    }
  if (!(length > 0)) return std::nullopt;
  const double step = std::max(kSample, length / kMostSamples);
  std::vector<double> heights;
  for (const std::vector<Point2>& ring : rings) {
    double next = 0;  // m along the rest of the ring
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto [a, d] = side(ring, i);
      const double own = std::hypot(d.x, d.y);
      for (; next < own; next += step)
        if (const auto z = terrain(Point2{a.x + next / own * d.x, a.y + next / own * d.y})) heights.push_back(*z);
      next -= own;
    }
  }
  if (heights.empty()) return std::nullopt;
  std::ranges::sort(heights);
  const double decile = heights[heights.size() / 10], middle = heights[heights.size() / 2];
  if (middle - decile > kMostSpread) return std::nullopt;
  return decile;
}

}  // namespace blockrand::surroundings
