// What a place on a wall looks at.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/context/edge_contacts.h"

namespace blockrand::context {

/// What can matter for one building, gathered once.
struct BuildingView {
  const SurroundingsIndex* index = nullptr;
  std::vector<std::uint32_t> yards;    ///< into SurroundingsIndex::yards
  std::vector<std::uint32_t> squares;  ///< into SurroundingsIndex::squares
};
BuildingView view_of(const model::Building& building, const SurroundingsIndex& index);

/// What is seen from one place.
struct EdgeSample {
  double at = 0;                       ///< m along the edge
  std::array<Sight, kFanRays> fan;     ///< from right to left, as fan_around
  model::EdgeKind kind = model::EdgeKind::unknown;
  double certainty = 0;                ///< [0, 1] of `kind`
  double ahead = 0;                    ///< [0, 1]: how much of the view straight ahead ends in a street
  double enclosed = 0;                 ///< [0, 1]: how much of the view ends at walls
  double street_share = 0;             ///< [0, 1]: how much of the whole view ends in a street
  std::uint32_t square = kNothing;     ///< stands on it: index into SurroundingsIndex::squares
  std::uint32_t yard = kNothing;       ///< stands at it: index into SurroundingsIndex::yards
  std::uint32_t inside = kNothing;     ///< lies within this footprint
};

/// \param at  m along the edge
EdgeSample look_out(const OutlineEdge& edge, double at, const BuildingView& view, const EdgeOptions& options);

}  // namespace blockrand::context
