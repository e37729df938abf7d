// How far repair may go. All lengths in metres on the ground.
#pragma once

#include "pipeline/base/option_table.h"

namespace blockrand::repair {

struct RepairOptions {
  // Which steps run. Validity always does: everything after it stands on valid polygons.
  bool simplify = true;          ///< collinear points are removed
  bool settle_coverings = true;  ///< houses mapped twice and outlines around mapped houses are settled
  bool share_walls = true;       ///< walls of neighbours become one
  bool resolve_overlaps = true;  ///< buildings at one level that still overlap give way
  bool square = true;            ///< almost right corners become right
  bool fit_parts = true;  ///< parts follow their outline, share walls, do not overlap; large rests of it are built
  bool arcs = true;       ///< rounded walls are recorded; no step makes them straight either way

  // Validity.
  double duplicate_distance = 0.002;  ///< m. Nearer neighbours on a ring are one point; OSM's own grid is 11 mm.
  double spike_width = 0.02;          ///< m. A tip narrower than this over its length is a slip of the mouse.
  double collinear_distance = 0.02;   ///< m. A point nearer to the wall through its neighbours is none of its corners.
  double min_piece_area = 0.05;       ///< m². Smaller pieces of a repaired outline are dropped and reported.
  double max_ring_area_change =
      0.1;                       ///< of the area of the rings as mapped, loops of a figure eight counted. A slip of the
                                 ///< mouse changes less; more is mended all the same, but the report says so.
  double ring_clearance = 0.03;  ///< m. Rings that touch get a wall this wide between them: nothing a mapper could see.

  // Shared walls.
  double snap_distance = 0.40;   ///< m. Mean distance of two walls that are one; wider gaps are alleys.
  double snap_reach = 0.75;      ///< m. At their ends, walls that are one may be this far apart.
  double snap_angle = 0.09;      ///< rad (about 5 degrees), for walls longer than the noise of mapping explains.
  double min_overlap = 1.0;      ///< m. Shorter contacts stay two walls.
  double max_shift = 0.5;        ///< m. No corner moves farther by sharing and squaring together.
  double max_area_change = 0.1;  ///< of the area, by sharing and squaring together (overlaps given away not counted).
  double min_overlap_area =
      0.1;                ///< m². Smaller overlaps are the noise of rounding, but are resolved all the same where
                          ///< that costs no corner.
  double max_loss = 0.5;  ///< of a building's area that it may lose to neighbours it overlaps.

  // Outline and parts.
  double parts_free_area = 10.0;  ///< m². A larger uncovered remainder of an outline with parts is built.
  double parts_free_width = 1.0;  ///< m. Narrower remainders are drawing tolerance.
};

/// How users set them: section [repair].
base::OptionTable<RepairOptions> repair_options();

}  // namespace blockrand::repair
