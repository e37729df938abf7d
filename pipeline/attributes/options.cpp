#include "pipeline/attributes/options.h"

#include "pipeline/base/option.h"

namespace blockrand::attributes {
namespace {

using base::integer;
using base::number;

constexpr base::OptionSection kGenerate{.name = "generate", .title = "What generation assumes", .tuning = true};

base::Option<GenerateOptions> metres(std::string_view name, std::string_view key, double minimum, double maximum,
                                     std::string_view help, double GenerateOptions::*member) {
  return number({.name = name, .key = key, .argument = "METRES", .minimum = minimum, .maximum = maximum, .help = help},
                member);
}

}  // namespace

base::OptionTable<GenerateOptions> generate_options() {
  using G = GenerateOptions;
  return base::in_section<G>(
      kGenerate,
      {metres("generate-neighbour-reach", "neighbour_reach", 0, 1000,
              "tagged neighbours within this speak for an untagged building, in m", &G::neighbour_reach),
       integer({.name = "generate-neighbour-minimum",
                .key = "neighbour_minimum",
                .argument = "N",
                .minimum = 1,
                .maximum = 1000,
                .help = "fewer tagged neighbours say nothing"},
               &G::neighbour_minimum),
       metres("generate-min-wall-height", "min_wall_height", 0.05, 10,
              "a roof never comes nearer to the building's underside, in m", &G::min_wall_height),
       metres("generate-max-usual-roof-height", "max_usual_roof_height", 1, 50,
              "roofs that no tag measures are no higher, in m", &G::max_usual_roof_height),
       metres("generate-min-roof-height", "min_roof_height", 0.01, 10, "a lower pitched roof is a flat one, in m",
              &G::min_roof_height),
       number({.name = "generate-max-roof-pitch",
               .key = "max_roof_pitch",
               .argument = "DEGREES",
               .minimum = 5,
               .maximum = 89,
               .help = "steeper inferred roofs are limited to this, in degrees"},
              &G::max_roof_pitch),
       metres("generate-canopy-thickness", "canopy_thickness", 0.05, 5,
              "slab of building=roof where no roof height is tagged, in m", &G::canopy_thickness),
       metres("generate-collinear-tolerance", "collinear_tolerance", 0, 0.5,
              "plan points nearer to the line of their neighbours do not make a wall, in m", &G::collinear_tolerance),
       metres("generate-simplify-tolerance", "simplify_tolerance", 0, 2,
              "second try for a plan whose solid fails its check, in m", &G::simplify_tolerance)});
}

}  // namespace blockrand::attributes
