// Rows and columns of a facade's openings. Internal to this folder.
#pragma once

#include "pipeline/compare/facade_agreement.h"

namespace blockrand::compare {

/// Rows of openings are storeys only where they lie at least so far apart. m: building codes ask for rooms of 2.2
/// to 2.5 m clear height plus a floor; cellars and mezzanines have a little less. Transoms, cellar windows and windows
/// on half-landings of stairs lie nearer to the row of a storey.
inline constexpr double kLeastStoreyPitch = 2.0;
/// A row without doors is a cellar's where all its openings end at or below this height above the ground, m.
inline constexpr double kCellarTop = 1.3;

/// Sets row and column of all openings, and storeys, axes, storey_pitch and axis_pitch of the facade.
///
/// Rows. Windows whose centres lie nearer than row_gap times the height of the lower one of two to the centre of a
/// window make its row: the window that gathers the greatest area of windows comes first and takes them, then the next
/// of the rest. (No chains: windows of a stair that climbs from storey to storey do not join the storeys to one row.)
/// Rows are storeys in the order of their area, unless a greater one lies nearer than kLeastStoreyPitch or they are a
/// cellar's and there are others. Windows of rows that are no storey go to the storey's row that covers more than half
/// of their height (a small window beside large ones), or have row -1 (transoms, half-landings, cellars). Doors go to
/// the storey's row whose range of heights (from its windows' median sill to their median head) has most in common with
/// theirs. Doors that have none beside them go by the same rule as windows, after these: to the storey's row nearer
/// than kLeastStoreyPitch (centres), or rows of their own.
///
/// Columns. They are looked for in the rows that tell: of the storeys above the lowest one those with the greatest
/// number of openings that at least half of these storeys reach. (Neither shop windows and gates below nor attic
/// windows between the axes make axes.) Where there is one storey, it tells; of two the upper one, unless it has less
/// than half as many openings as the lower (a window in a gable): then the one with more. Openings of these rows are
/// clustered by their centres and widths like those of a row, each counting alike; a column is an axis when half of the
/// telling rows have an opening in it, unless another with more openings (or as many narrower ones) has more than half
/// of the narrower one's width in common with it. All other openings go to the axis that they have most width in common
/// with, or have column -1.
///
/// Pitches are medians of the distances between neighbouring storeys' and axes' centres (median of the centres of the
/// openings that made them). The order of the openings does not matter.
void find_rows_and_columns(Facade& facade, const FacadeOptions& options);

}  // namespace blockrand::compare
