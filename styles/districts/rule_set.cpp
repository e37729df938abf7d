#include "styles/districts/rule_set.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace blockrand::districts {

std::string PlaceQuery::text() const {
  switch (kind) {
    case Kind::polygon:
      return "in the rule's polygon";
    case Kind::file: {
      std::string of = file.substr(file.find_last_of('/') + 1);
      if (!layer.empty()) of += " layer " + layer;
      for (const TagTest& a : attributes) of += " with " + a.text();
      return "in a polygon of " + of;
    }
    case Kind::place:
      return distance > 0 ? fmt::format("in {} (within {:g} m of its node)", name, distance) : "in the place " + name;
    case Kind::boundary:
      return "within the boundary " + name;
    case Kind::land_use:
      return fmt::format("in landuse {}", fmt::join(values, " or "));
    case Kind::near:
      return fmt::format("within {:g} m of {}", distance, feature.text());
  }
  return {};
}

bool Rule::unconditional() const {
  return where.queries.empty() && !where.bbox && where.cell.empty() && !which.style && which.eras.empty() &&
         !which.years && which.substyles.empty() && which.uses.empty() && !which.area && !which.storeys &&
         !which.front && which.positions.empty() && which.tags.empty() && which.any_tags.empty() && !which.house;
}

bool holds(std::span<const model::Location> ring, model::Location p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const model::Location a = ring[i], b = ring[(i + 1) % ring.size()];
    // Products of differences below 2^33 fit into 64 bits when halved; 128 bits keep them whole.
    __extension__ typedef __int128 Wide;
    const Wide side = Wide{std::int64_t{b.lon} - a.lon} * (std::int64_t{p.lat} - a.lat) -
                      Wide{std::int64_t{b.lat} - a.lat} * (std::int64_t{p.lon} - a.lon);
    if (side == 0 && std::min(a.lon, b.lon) <= p.lon && p.lon <= std::max(a.lon, b.lon) &&
        std::min(a.lat, b.lat) <= p.lat && p.lat <= std::max(a.lat, b.lat))
      return true;
    if ((a.lat > p.lat) != (b.lat > p.lat)) inside ^= (side > 0) == (b.lat > a.lat);
  }
  return inside;
}

RingArea double_area(std::span<const model::Location> ring) {
  __extension__ typedef __int128 Wide;
  Wide sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const model::Location a = ring[i], b = ring[(i + 1) % ring.size()];
    sum += Wide{a.lon} * b.lat - Wide{b.lon} * a.lat;
  }
  return static_cast<RingArea>(sum < 0 ? -sum : sum);
}

std::uint32_t RuleSets::choose(model::Location place) const {
  std::uint32_t best = kNoSet;
  RingArea smallest = 0;
  for (std::uint32_t i = 0; i < sets.size(); ++i) {
    const RuleSet& set = sets[i];
    if (set.polygon.empty()) {
      if (best == kNoSet) best = i;
      continue;
    }
    if (!holds(set.polygon, place)) continue;
    const RingArea area = double_area(set.polygon);
    if (best == kNoSet || sets[best].polygon.empty() || area < smallest) {
      best = i;
      smallest = area;
    }
  }
  return best;
}

}  // namespace blockrand::districts
