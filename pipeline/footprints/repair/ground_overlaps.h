// Ground that two footprints claim is given to one of them.
#pragma once

#include "pipeline/footprints/repair/options.h"
#include "pipeline/footprints/repair/terrace_row.h"
#include "pipeline/model/report.h"

namespace blockrand::repair {

/// Resolves what overlaps are left between the buildings of a row at the same level. Found exactly (no area is too
/// small, no common wall counts); the largest first, ties by id. Who keeps the ground:
///
/// 1. A building that lies (to 90 %) within the other keeps all of it, the other gets a hole or notch: the other way
///    round it would vanish, and who maps a house inside another means both (NESTED_BUILDING).
/// 2. One with mapped parts beats one without: its outline only sums up what was drawn with more care.
/// 3. More tags beat fewer: what was looked at more closely is drawn better.
/// 4. The smaller beats the larger: it would lose the greater share.
/// 5. The lower id: drawn first, the other one was laid over it.
///
/// The loser must keep `1 - max_loss` of what it had when it came, and lose no pieces but drawing noise; else the other
/// one yields; else the loser may lose 80 % if what is left is larger than `parts_free_area` and wider than
/// `parts_free_width` (a house drawn twice); else both stay and OVERLAP_KEPT tells it with the area. One that has another
/// within itself may lose even more, as an outline does to its parts, on the same condition. What the cut adds on the winner's walls (at most a
/// grid step beside them) becomes points of the winner, and of others that have the wall. All polygons stay strictly
/// simple. New corners a grid step beside a corner of the winner are that corner. Slivers narrower than `spike_width`,
/// which cuts along almost common walls leave, and those that came, are cut off. Overlaps below `min_overlap_area` are treated alike, but make no rows in the report.
///
/// Fills overlaps_resolved (of the loser) and overlap_left of the records. Requires buildings by id.
void resolve_overlaps(TerraceRow& row, const RepairOptions& options, model::Report& report);

}  // namespace blockrand::repair
