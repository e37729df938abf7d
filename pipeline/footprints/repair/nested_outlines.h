// Buildings drawn over others: the same house twice, an outline around houses that are mapped one by one.
#pragma once

#include "pipeline/footprints/repair/options.h"
#include "pipeline/footprints/repair/terrace_row.h"
#include "pipeline/model/report.h"

namespace blockrand::repair {

/// Decides about footprints that lie on top of each other at the same level, before walls are shared. Smaller overlaps
/// are left to resolve_overlaps.
///
/// 1. Two outlines of which each covers nearly all of the other (kSameShare) are one house: the weaker one becomes a
///    duplicate of the other (NEAR_DUPLICATE, TerraceBuilding::settled). Stronger is who has mapped parts, more tags, the
///    lower id. An outline with parts is nobody's duplicate: its parts would be lost with it. From the strongest to the
///    weakest each is compared with those that stay, so that nobody is a duplicate of a duplicate.
/// 2. An outline without parts that others, each of them (by kWithinShare) within it, cover by more than `max_loss` sums
///    up what they are (COVERED_OUTLINE): it keeps what they leave free, pieces larger than `parts_free_area` and wider
///    than `parts_free_width`, as an outline with mapped parts would; where nothing is left it is represented by the
///    largest of them. Smaller outlines are decided before larger ones.
///
/// A settled building has no polygons left. Requires strictly simple polygons; they stay so. The result does not depend on
/// the order of buildings.
void settle_coverings(TerraceRow& row, const RepairOptions& options, model::Report& report);

inline constexpr double kSameShare = 0.9;  ///< of the area; two drawings of one house differ by their walls' thickness
inline constexpr double kWithinShare =
    0.8;  ///< of the area; outlines of houses stick out of the outline of their group

}  // namespace blockrand::repair
