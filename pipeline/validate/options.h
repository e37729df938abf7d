// What `blockrand validate` is asked for.
#pragma once

#include <string>

#include "pipeline/base/option_table.h"

namespace blockrand::validate {

struct ValidateOptions {
  std::string folder;   ///< the build
  std::string extract;  ///< where it was made from; empty: the path in build.json, where it leads to the same file
  bool extract_is_known = false;  ///< of an area: it is that of the whole, which was looked at
  std::string schemas;  ///< folder with citygml2.xsd and catalog.xml; empty: CityGML is not validated against schemas
  int sample = 1;       ///< only every n-th tile; counts are not compared then
  int jobs = 0;         ///< worker threads; 0: one per core
};

/// How users set them: main section. Folder and jobs are other commands' options, too.
base::OptionTable<ValidateOptions> validate_options();

}  // namespace blockrand::validate
