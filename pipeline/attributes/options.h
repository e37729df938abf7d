// What generation assumes where the map is silent, and its geometric tolerances. Lengths in metres, angles in degrees.
#pragma once

#include "pipeline/base/option_table.h"

namespace blockrand::attributes {

struct GenerateOptions {
  double neighbour_reach = 100.0;  ///< m. Tagged neighbours within this speak for an untagged building.
  int neighbour_minimum = 3;       ///< fewer tagged neighbours say nothing
  double min_wall_height = 0.3;    ///< m. A roof never comes nearer to the building's underside.
  double min_roof_height = 0.1;    ///< m. A lower pitched roof is a flat one.
  double max_roof_pitch = 75.0;    ///< degrees. Steeper inferred roofs are limited; tagged ones are not.
  /// m. Of roofs that no tag measures: deep houses have flatter ones. 38 degrees over a depth of 19 m.
  double max_usual_roof_height = 7.5;
  double canopy_thickness = 0.3;      ///< m. Slab of building=roof where no roof height is tagged.
  double collinear_tolerance = 0.01;  ///< m. Plan points nearer to the line of their neighbours do not make a wall.
  double simplify_tolerance = 0.25;   ///< m. Second try for a plan whose solid fails its check.
};

/// How users set them: section [generate].
base::OptionTable<GenerateOptions> generate_options();

}  // namespace blockrand::attributes
