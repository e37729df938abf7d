#include "pipeline/surroundings/kinds.h"

#include <algorithm>
#include <array>

#include "pipeline/model/osm_keys.h"

namespace blockrand::surroundings {
namespace {

using model::FeatureKind;
namespace osm_key = model::osm_key;

template <std::size_t N>
bool is_of(std::string_view value, const std::array<std::string_view, N>& values) {
  return std::ranges::find(values, value) != values.end();
}

constexpr std::array<std::string_view, 11> kNotThere{"proposed",   "construction", "abandoned", "razed",
                                                     "dismantled", "disused",      "no",        "corridor",
                                                     "elevator",   "planned",      "demolished"};

}  // namespace

bool is_track(std::string_view railway) {
  constexpr std::array<std::string_view, 7> kTracks{"rail",      "light_rail", "narrow_gauge", "subway",
                                                    "funicular", "preserved",  "tram"};
  return is_of(railway, kTracks);
}

bool is_bridge(const TagOf& tag) {
  const std::string_view value = tag(osm_key::kBridge);
  return !value.empty() && value != "no" && value != "abandoned" && value != "proposed";
}

std::optional<model::SurroundingState> hidden_state(const model::Feature& feature, const TagOf& tag) {
  using enum model::SurroundingState;
  const std::string_view indoor = tag(osm_key::kIndoor);
  if (!indoor.empty() && indoor != "no") return indoors;
  if (const std::string_view highway = tag(osm_key::kHighway); highway == "corridor" || highway == "elevator")
    return indoors;
  const std::string_view tunnel = tag(osm_key::kTunnel), location = tag(osm_key::kLocation);
  if (location == "underground" || location == "underwater" || location == "indoor") return below_ground;
  if (!tunnel.empty() && tunnel != "no" && !feature.is(FeatureKind::passage)) return below_ground;
  const std::string_view layer = tag(osm_key::kLayer);
  if (layer.starts_with('-') && layer != "-0" && !is_bridge(tag) && !feature.is(FeatureKind::water) &&
      !feature.is(FeatureKind::passage) && tunnel != "no" && (feature.area || !tunnel.empty()))
    return below_ground;
  return std::nullopt;
}

std::optional<SurroundingKind> kind_of(const model::Feature& feature, const TagOf& tag, const Catalogue& catalogue) {
  using enum SurroundingKind;
  const bool point = !feature.area && feature.rings.count == 1 && feature.is(FeatureKind::surrounding);
  const std::string_view highway = tag(osm_key::kHighway), rail = tag(osm_key::kRailway),
                         amenity = tag(osm_key::kAmenity);
  if (is_of(highway, kNotThere) && highway != "corridor" && highway != "elevator") return std::nullopt;
  // A street on the bed of an abandoned railway is a street.
  if (highway.empty() && (is_of(rail, kNotThere) || rail == "station" || rail == "halt" || rail == "stop"))
    return std::nullopt;
  if (feature.is(FeatureKind::street) && !highway.empty()) {
    if (is_bridge(tag)) return bridge;
    const std::string_view tunnel_value = tag(osm_key::kTunnel);
    if (!tunnel_value.empty() && tunnel_value != "no" && !feature.is(FeatureKind::passage)) return tunnel;
    return road;
  }
  if (!tag(osm_key::kAreaHighway).empty()) return road;
  if (highway == "traffic_signals" || highway == "stop" || highway == "give_way" || !tag(osm_key::kTrafficSign).empty())
    return traffic_sign;
  if (highway == "street_lamp" || highway == "bus_stop" || highway == "milestone") return street_furniture;
  const bool shaped = catalogue.object_of(tag, feature.area) != nullptr;
  // Crossings and turning circles are part of their street.
  if (!highway.empty() && point) return shaped ? std::optional(street_furniture) : std::nullopt;
  if (feature.is(FeatureKind::railway) && !rail.empty()) return is_bridge(tag) ? bridge : railway;
  if (rail == "signal" || rail == "buffer_stop") return traffic_sign;
  if (rail == "tram_stop") return street_furniture;
  if (!rail.empty() && point) return shaped ? std::optional(street_furniture) : std::nullopt;
  if (!tag(osm_key::kAeroway).empty()) return aeroway;
  if (!tag(osm_key::kAerialway).empty()) return aerialway;
  if (feature.is(FeatureKind::tree)) return tree;
  if (amenity == "parking" || amenity == "parking_space") return feature.area ? std::optional(parking) : std::nullopt;
  if (amenity == "bicycle_parking") return bicycle_parking;
  if (tag(osm_key::kLeisure) == "swimming_pool") return pool;
  if (feature.is(FeatureKind::water)) return water;
  if (!tag(osm_key::kGolf).empty()) return golf;
  if (const std::string_view leisure = tag(osm_key::kLeisure); leisure == "pitch" || leisure == "track") return pitch;
  if (const std::string_view natural = tag(osm_key::kNatural); natural == "cliff" || natural == "earth_bank")
    return cliff;
  const std::string_view barrier_value = tag(osm_key::kBarrier);
  if (!barrier_value.empty() && barrier_value != "entrance" && barrier_value != "no") {
    if (feature.is(FeatureKind::barrier) || !point) return barrier;
    return shaped ? std::optional(barrier) : std::nullopt;
  }
  const std::string_view power_value = tag(osm_key::kPower);
  if (!power_value.empty()) {
    if (power_value == "generator" && tag(osm_key::kGeneratorSource) == "wind") return wind_turbine;
    return point || power_value == "line" || power_value == "minor_line" ? std::optional(power) : std::nullopt;
  }
  const std::string_view made = tag(osm_key::kManMade);
  if (made == "mast" || made == "tower" || made == "antenna" || made == "communications_tower" || made == "flagpole")
    return mast;
  if (made == "bridge") return bridge;
  if (feature.area && catalogue.ground_of(tag) != nullptr) return surface_area;
  if (shaped) return street_furniture;
  if (!made.empty()) return other;
  return std::nullopt;
}

}  // namespace blockrand::surroundings
