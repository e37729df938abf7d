// The lines that a roof's eaves follow: facades without their bays, stair towers and recesses. A carpenter lets the
// main roof run on over a recess and down over a bay; only what is deeper gets slopes of its own.
#pragma once

#include <optional>
#include <vector>

#include "styles/roofs/roof.h"

namespace blockrand::roofs {

/// A plan whose edges are whole facades.
struct EavesPlan {
  model::Polygon plan;                 ///< strictly simple, on the grid
  std::vector<model::RoofEdge> edges;  ///< one per edge; empty where none were given
};

/// m. Steps, bays and recesses of a facade up to this depth belong to it: stair towers of the nineteenth century stand
/// out by 1 to 1.5 m, bays by law by no more than that; mappers add a little.
inline constexpr double kDeepestBay = 1.8;
/// Of the width of a typical wing: what is deeper is no bay but a part of the plan.
inline constexpr double kBayShare = 0.15;

/// The plan with every facade on the line of its longest edge; edges that are part of it run within 12 degrees of that
/// line, by no more than 0.25 m off it from end to end, and lie within kDeepestBay and kBayShare, as do all corners
/// between them. Corners that turn stay: they go to where the lines of their facades meet. None when there is nothing
/// to leave out, or when what remains is no simple polygon.
std::optional<EavesPlan> eaves_plan(const model::Polygon& plan, const std::vector<model::RoofEdge>& edges);

/// A roof over an eaves plan, brought onto the plan it stands for: planes run on beyond the eaves plan's edges, walls
/// end where they meet them. None for roofs with upright pieces in them, where the planes do not fit together, and
/// where it would come down over a bay by more than 1.4 m.
std::optional<Roof> onto_plan(const Roof& roof, const EavesPlan& eaves, const model::Polygon& plan);

}  // namespace blockrand::roofs
