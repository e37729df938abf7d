// What points of streets tell of their traffic: crossings, and where vehicles stop.
#pragma once

#include <cstdint>

#include "pipeline/surroundings/catalogue.h"

namespace blockrand::surroundings {

/// How a crossing is painted.
enum class CrossingMarking : std::uint8_t { none, lines, zebra };
CrossingMarking crossing_of(const TagOf& tag);

/// What makes vehicles stop: highway=give_way, stop, traffic_signals.
enum class ControlKind : std::uint8_t { none, give_way, stop, signals };

struct StreetControl {
  ControlKind kind = ControlKind::none;
  bool forward = false, backward = false;  ///< the direction of travel along its way; neither: not told
  bool crossing = false;                   ///< signals of a crossing, whose node is in the middle of it
};
StreetControl control_of(const TagOf& tag);

}  // namespace blockrand::surroundings
