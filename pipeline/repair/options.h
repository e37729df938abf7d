// How far repair may go. All lengths in metres on the ground.
#pragma once

namespace blockrand::repair {

struct RepairOptions {
  double duplicate_distance = 0.002;  ///< m. Nearer neighbours on a ring are one point; OSM's own grid is 11 mm.
  double spike_width = 0.02;          ///< m. A tip narrower than this over its length is a slip of the mouse.
  double min_piece_area = 0.05;       ///< m². Smaller pieces of a repaired outline are dropped and reported.
  double ring_clearance = 0.03;       ///< m. Rings that touch get a wall this wide between them: nothing a mapper could see.
  double parts_free_area = 10.0;      ///< m². A larger uncovered remainder of an outline with parts is built.
  double parts_free_width = 1.0;      ///< m. Narrower remainders are drawing tolerance.
};

}  // namespace blockrand::repair
