#include "pipeline/footprints/area.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "pipeline/footprints/shard.h"

namespace blockrand::footprints {

using model::Extract;
using model::MappedBuilding;
using model::ObjectState;

std::vector<model::Location> building_centres(const Extract& extract) {
  std::vector<model::Location> centres;
  for (const MappedBuilding& b : extract.buildings)
    if (b.rings.count > 0 && b.state == ObjectState::pending) centres.push_back(box_centre(extract, b));
  return centres;
}

std::optional<Area> area_of(const Extract& extract) { return area_of(building_centres(extract)); }

std::optional<Area> area_of(std::span<const model::Location> centres) {
  std::vector<std::int64_t> xs, ys;
  constexpr std::int64_t kTurn = 3'600'000'000;
  for (const model::Location c : centres) {
    std::int64_t x = c.lon;
    if (!xs.empty() && x - xs[0] > kTurn / 2) x -= kTurn;
    if (!xs.empty() && xs[0] - x > kTurn / 2) x += kTurn;
    xs.push_back(x);
    ys.push_back(c.lat);
  }
  if (xs.empty()) return std::nullopt;
  const auto median = [](std::vector<std::int64_t> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  const std::int64_t mx = median(xs), my = median(ys);
  constexpr std::int64_t kNear = 50'000'000;  // 5 degrees
  std::int64_t west = mx, east = mx, south = my, north = my;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    if (std::llabs(xs[i] - mx) > kNear || std::llabs(ys[i] - my) > kNear) continue;
    west = std::min(west, xs[i]);
    east = std::max(east, xs[i]);
    south = std::min(south, ys[i]);
    north = std::max(north, ys[i]);
  }
  const auto degrees = [](std::int64_t v) { return static_cast<double>(v) * 1e-7; };
  const auto wrapped = [&](std::int64_t v) {
    if (v > kTurn / 2) v -= kTurn;
    if (v < -kTurn / 2) v += kTurn;
    return degrees(v);
  };
  Area area;
  area.box = {wrapped(west), degrees(south), wrapped(east), degrees(north)};
  area.centre = {wrapped(mx), degrees(my)};
  return area;
}

}  // namespace blockrand::footprints
