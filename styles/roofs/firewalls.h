// Walls between houses that stand out of the roof.
#pragma once

#include <span>
#include <vector>

#include "pipeline/model/polygon.h"
#include "styles/roofs/plan_cells.h"
#include "styles/roofs/roof.h"

namespace blockrand::roofs {

/// Measures of firewalls.
struct FirewallOptions {
  double height = 0.30;  ///< m, upright, above the roof. Bavaria 1910 (docs/style_measures.md 2.1, S15).
  double thickness =
      0.25;  ///< m, inwards from the party wall. At least 0.25 m, the same law; a brick length of 0.24 to 0.25.
  double lower_by =
      0.05;  ///< m. A neighbour is lower when its top is lower by more than this; equal roofs run through [P].
  double least_length = 0.30;  ///< m. Shorter stretches have none [P].
};

/// A point of the line in which a neighbour's roof meets our wall.
struct NeighbourTop {
  double along = 0;   ///< m from the edge's start
  double height = 0;  ///< m, z
};

/// What stands at a plan edge.
struct FirewallSide {
  bool party_wall = false;
  std::vector<NeighbourTop>
      neighbour;  ///< rising along; level beyond its ends; empty for nothing: the wall stands bare
};

struct BuiltFirewalls {
  BuiltElements elements;  ///< `asked` counts plan edges that have a stretch with a lower neighbour
  std::vector<std::vector<model::Point2>> places;  ///< convex pieces of the plan that they stand on, counter-clockwise
};

/// Firewalls along party walls, on those stretches where the neighbour's top is lower than our roof: from the roof's
/// surface up to `height` above it, following the roof. Walls of neighbouring edges are one body.
/// \param sides  one per plan edge, ring by ring
/// \param keep_clear  convex pieces of the plan (counter-clockwise) where other things stand: gables. Walls end before
/// them.
BuiltFirewalls firewalls(const model::Polygon& plan, const Roof& roof, std::span<const FirewallSide> sides,
                         std::span<const std::vector<model::Point2>> keep_clear, const FirewallOptions& options = {});

}  // namespace blockrand::roofs
