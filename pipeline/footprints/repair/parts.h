// Parts fitted to their repaired outline, and the rule of outline and parts.
#pragma once

#include <span>
#include <vector>

#include "pipeline/footprints/repair/kept_nodes.h"
#include "pipeline/footprints/repair/options.h"
#include "pipeline/model/building.h"
#include "pipeline/model/region.h"
#include "pipeline/model/report.h"

namespace blockrand::repair {

/// The outline of a building that is mapped in parts alone: the union of its parts' repaired rings. The building is not
/// changed, and nothing is reported: fit_parts does, which makes the same outline where it finds none.
std::vector<model::Polygon> outline_of_parts(const model::Building& building, const KeptNodes& kept,
                                             const RepairOptions& options);

/// Turns a building with a repaired outline into bodies (`parts`, each with a `plan`).
///
/// Without mapped parts a building gets one body per polygon of its outline. With mapped parts the outline is not built
/// (Simple 3D Buildings: parts describe the whole), and, in this order:
/// 1. The parts' rings are made valid (repair_rings). A part that fails is a PartFailure; when none is left, the
///    outline is built. A building without outline gets the union of its parts (OUTLINE_MADE).
/// 2. Parts follow their outline (MovedWalls): a corner on a wall or corner that moved goes along, what lies inside
///    moves smoothly in between. Where the outline gave more than a strip of a wall's width (`snap_distance`) to a
///    neighbour its parts give it as well, unless little would be left of them (`max_loss`, OVERLAP_KEPT).
/// 3. Parts at one height that almost meet share their walls exactly (share_part_walls).
/// 4. What sticks out of the outline stays as mapped, since nothing mapped is lost and overhanging storeys are real,
///    and is reported (PARTS_OUTSIDE).
/// 5. Parts that overlap at overlapping heights: the smaller part, of equal ones that of the lower id, keeps the common
///    area, the other gives way (PARTS_OVERLAP).
/// 6. What the parts leave of the outline is built as part "….rest" when it is larger than `parts_free_area` and wider
///    than `parts_free_width` (PARTS_INCOMPLETE).
/// 7. What still overlaps or almost meets is cut apart on the grid (separate_parts). A part that smaller ones cover to the
///    last is represented by one of them.
///
/// Without RepairOptions::fit_parts only 1 and 4 are done.
///
/// Guarantees: plans are strictly simple; no part vanishes but by 1 and 7; points that two parts have in common stay so, and
/// where the outline did not move step 2 moves nothing; the result does not depend on where rings start.
/// \param outline_before  the outline after repair_rings, before shared walls and squaring; equal to the building's
///                        `outline` where these moved nothing. Ignored where the building has no outline
/// \param building        parts with their `rings` as mapped; `canopy` may be set for building:part=roof. A building
///                        whose outline failed has its `failure` set, which is taken back when its parts stand
/// \param settled  gets parts that others stand for
void fit_parts(model::Building& building, std::span<const model::Polygon> outline_before, const KeptNodes& kept,
               const RepairOptions& options, std::vector<model::PartFailure>& failures,
               std::vector<model::SettledPart>& settled, model::Report& report);

}  // namespace blockrand::repair
