// Tiles over ridges and hips.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/model/polygon.h"
#include "styles/roofs/overhangs.h"
#include "styles/roofs/plan_cells.h"
#include "styles/roofs/roof.h"

namespace blockrand::roofs {

enum class CapProfile : std::uint8_t {
  triangular,  ///< two planes
  half_round,  ///< an arc from foot to foot
};

/// Measures of ridge and hip caps. The references name none: [P], after ridge tiles of plain-tile roofs, which cover
/// 0.18 to 0.22 m.
struct CapOptions {
  CapProfile profile = CapProfile::half_round;
  double width = 0.24;         ///< m, in plan, both feet together [P]
  double height = 0.09;        ///< m, of the crown above the ridge line [P]
  int segments = 3;            ///< pieces of the arc on each side of the ridge
  double least_bend = 0.35;    ///< rad (20 degrees) between both planes; flatter ones are facets of a curve
  double least_length = 0.30;  ///< m. Shorter lines have none: one tile [P].
};

/// Puts caps on lines of the roof from which both surfaces fall: ridges (level) and hips. Where several meet, they are
/// mitred; at verges and eaves they are cut along the edge, or go on to the overhang's, at valleys along the valley.
/// Lines on which a cap would not have room on both surfaces get none. Bodies sit on the roof and touch each other
/// along their ends. \param corners  of the roof's overhangs; empty for none \param keep_clear  convex pieces of the
/// plan (counter-clockwise) where other things stand: firewalls, gables, chimneys. Caps end before them.
BuiltElements ridge_and_hip_caps(const Roof& roof, std::span<const OverhangCorner> corners,
                                 std::span<const std::vector<model::Point2>> keep_clear,
                                 const CapOptions& options = {});

}  // namespace blockrand::roofs
