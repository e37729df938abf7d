// Which mapped objects the surroundings are asked for, by the kinds that accounts are kept of.
#pragma once

#include <cstdint>
#include <iterator>
#include <optional>
#include <string_view>

#include "pipeline/model/extract.h"
#include "pipeline/surroundings/catalogue.h"

namespace blockrand::surroundings {

/// X(constant, name in documents)
// clang-format off
#define BLOCKRAND_SURROUNDING_KINDS(X)          \
  X(road, "road")                               \
  X(railway, "railway")                         \
  X(aeroway, "aeroway")                         \
  X(aerialway, "aerialway")                     \
  X(parking, "parking")                         \
  X(bicycle_parking, "bicycle_parking")         \
  X(water, "water")                             \
  X(pool, "pool")                               \
  X(golf, "golf")                               \
  X(pitch, "sports_pitch")                      \
  X(cliff, "cliff")                             \
  X(barrier, "barrier")                         \
  X(power, "power")                             \
  X(wind_turbine, "wind_turbine")               \
  X(mast, "mast")                               \
  X(bridge, "bridge")                           \
  X(tunnel, "tunnel")                           \
  X(surface_area, "surface_area")               \
  X(tree, "tree")                               \
  X(street_furniture, "street_furniture")       \
  X(traffic_sign, "traffic_sign")               \
  X(other, "other")
// clang-format on

enum class SurroundingKind : std::uint8_t {
#define X(constant, text) constant,
  BLOCKRAND_SURROUNDING_KINDS(X)
#undef X
};
inline constexpr std::string_view kSurroundingKindNames[] = {
#define X(constant, text) text,
    BLOCKRAND_SURROUNDING_KINDS(X)
#undef X
};
inline constexpr std::size_t kSurroundingKindCount = std::size(kSurroundingKindNames);
constexpr std::string_view name(SurroundingKind kind) { return kSurroundingKindNames[static_cast<std::size_t>(kind)]; }

/// The kind of a feature; nothing for what is no thing around houses: addresses, shops, boundaries, places, what lies indoors
/// or is not there any more. Land use that says who uses land, not what covers it (residential, commercial …), is none either.
std::optional<SurroundingKind> kind_of(const model::Feature& feature, const TagOf& tag, const Catalogue& catalogue);

/// Below ground or inside: tunnels, culverts, layers below 0 that are no bridges, indoor ways.
std::optional<model::SurroundingState> hidden_state(const model::Feature& feature, const TagOf& tag);

/// Whether a value of `railway` is a track with two rails.
bool is_track(std::string_view railway);

/// bridge=* but not `no`.
bool is_bridge(const TagOf& tag);

}  // namespace blockrand::surroundings
