#include "pipeline/surroundings/kinds.h"

#include <algorithm>
#include <array>

#include "pipeline/model/osm_keys.h"

namespace blockrand::surroundings {
namespace {

using model::FeatureKind;
namespace key = model::osm_key;

template <std::size_t N>
bool is_of(std::string_view value, const std::array<std::string_view, N>& values) {
  return std::ranges::find(values, value) != values.end();
}

constexpr std::array<std::string_view, 11> kNotThere{"proposed",   "construction", "abandoned", "razed",
                                                     "dismantled", "disused",      "no",        "corridor",
                                                     "elevator",   "planned",      "demolished"};

}  // namespace

bool is_bridge(const TagOf& tag) {
  const std::string_view value = tag(key::kBridge);
  return !value.empty() && value != "no" && value != "abandoned" && value != "proposed";
}

std::optional<model::SurroundingState> hidden_state(const model::Feature& feature, const TagOf& tag) {
  using enum model::SurroundingState;
  const std::string_view indoor = tag(key::kIndoor);
  if (!indoor.empty() && indoor != "no") return indoors;
  if (const std::string_view highway = tag(key::kHighway); highway == "corridor" || highway == "elevator")
    return indoors;
  const std::string_view tunnel = tag(key::kTunnel), location = tag(key::kLocation);
  if (location == "underground" || location == "underwater" || location == "indoor") return below_ground;
  if (!tunnel.empty() && tunnel != "no" && !feature.is(FeatureKind::passage)) return below_ground;
  const std::string_view layer = tag(key::kLayer);
  if (layer.starts_with('-') && layer != "-0" && !is_bridge(tag) && !feature.is(FeatureKind::water) &&
      !feature.is(FeatureKind::passage) && tunnel != "no" && (feature.area || !tunnel.empty()))
    return below_ground;
  return std::nullopt;
}

std::optional<SurroundingKind> kind_of(const model::Feature& feature, const TagOf& tag, const Catalogue& catalogue) {
  using enum SurroundingKind;
  const bool point = !feature.area && feature.rings.count == 1 && feature.is(FeatureKind::surrounding);
  const std::string_view highway = tag(key::kHighway), rail = tag(key::kRailway), amenity = tag(key::kAmenity);
  if (is_of(highway, kNotThere) && highway != "corridor" && highway != "elevator") return std::nullopt;
  if (is_of(rail, kNotThere) || rail == "station" || rail == "halt" || rail == "stop") return std::nullopt;
  if (feature.is(FeatureKind::street) && !highway.empty()) {
    if (is_bridge(tag)) return bridge;
    const std::string_view tunnel_value = tag(key::kTunnel);
    if (!tunnel_value.empty() && tunnel_value != "no" && !feature.is(FeatureKind::passage)) return tunnel;
    return road;
  }
  if (!tag(key::kAreaHighway).empty()) return road;
  if (highway == "traffic_signals" || highway == "stop" || highway == "give_way" || !tag(key::kTrafficSign).empty())
    return traffic_sign;
  if (highway == "street_lamp" || highway == "bus_stop" || highway == "milestone") return street_furniture;
  if (!highway.empty() && point) return std::nullopt;  // crossings, turning circles: part of their street
  if (feature.is(FeatureKind::railway) && !rail.empty()) return is_bridge(tag) ? bridge : railway;
  if (rail == "signal" || rail == "buffer_stop") return traffic_sign;
  if (rail == "tram_stop") return street_furniture;
  if (!rail.empty() && point) return std::nullopt;
  if (!tag(key::kAeroway).empty()) return aeroway;
  if (!tag(key::kAerialway).empty()) return aerialway;
  if (feature.is(FeatureKind::tree)) return tree;
  if (amenity == "parking" || amenity == "parking_space") return feature.area ? std::optional(parking) : std::nullopt;
  if (amenity == "bicycle_parking") return bicycle_parking;
  if (tag(key::kLeisure) == "swimming_pool") return pool;
  if (feature.is(FeatureKind::water)) return water;
  if (!tag(key::kGolf).empty()) return golf;
  if (const std::string_view leisure = tag(key::kLeisure); leisure == "pitch" || leisure == "track") return pitch;
  if (const std::string_view natural = tag(key::kNatural); natural == "cliff" || natural == "earth_bank") return cliff;
  const std::string_view barrier_value = tag(key::kBarrier);
  if (!barrier_value.empty() && barrier_value != "entrance" && barrier_value != "no") {
    if (feature.is(FeatureKind::barrier) || !point) return barrier;
    if (const ObjectRule* rule = catalogue.object_of(tag, false); rule != nullptr) return barrier;
    return std::nullopt;
  }
  const std::string_view power_value = tag(key::kPower);
  if (!power_value.empty()) {
    if (power_value == "generator" && tag(key::kGeneratorSource) == "wind") return wind_turbine;
    return point || power_value == "line" || power_value == "minor_line" ? std::optional(power) : std::nullopt;
  }
  const std::string_view made = tag(key::kManMade);
  if (made == "mast" || made == "tower" || made == "antenna" || made == "communications_tower" || made == "flagpole")
    return mast;
  if (made == "bridge") return bridge;
  if (feature.area && catalogue.ground_of(tag) != nullptr) return surface_area;
  if (const ObjectRule* rule = catalogue.object_of(tag, feature.area); rule != nullptr) return street_furniture;
  if (!made.empty()) return other;
  return std::nullopt;
}

}  // namespace blockrand::surroundings
