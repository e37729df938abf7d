// imagery.json: each aerial image against the map, and the receipt of every building.
#pragma once

#include "pipeline/outputs/output.h"

namespace blockrand::outputs {

OutputFormat imagery_output();

}  // namespace blockrand::outputs
