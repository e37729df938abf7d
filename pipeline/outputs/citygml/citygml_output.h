// CityGML: citygml/, a file per tile.
#pragma once

#include "pipeline/outputs/output.h"

namespace blockrand::outputs {

OutputFormat citygml_output();

}  // namespace blockrand::outputs
