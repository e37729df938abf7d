// GeoPackage: buildings.gpkg, one for the whole build.
#pragma once

#include "pipeline/outputs/output.h"

namespace blockrand::outputs {

OutputFormat geopackage_output();

}  // namespace blockrand::outputs
