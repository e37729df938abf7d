// Which aerial images a build looks at, and what it does with what they show.
#pragma once

#include <cstdint>
#include <vector>

#include "importers/imagery/aerial_image.h"
#include "pipeline/base/option_table.h"
#include "pipeline/observation/edge_refinement.h"

namespace blockrand::observation {

/// What is done with outlines that an image shows elsewhere.
enum class Correction : std::uint8_t {
  off,     ///< nobody looks for them: roofs alone are looked at
  report,  ///< they are told
  apply    ///< they are moved there
};

struct ImageryOptions {
  std::vector<importers::imagery::ImageSource> images;
  Correction correct = Correction::report;
  double refine = kRefineWithin;  ///< m: how far single walls are looked for beside where they stand; 0: they are not
};

/// How users set them: in the main section of a build's options.
base::OptionTable<ImageryOptions> imagery_options();

}  // namespace blockrand::observation
