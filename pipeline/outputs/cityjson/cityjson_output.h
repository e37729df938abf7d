// CityJSON: cityjson/, a text sequence per tile, with --single-cityjson model.city.json.
#pragma once

#include "pipeline/outputs/output.h"

namespace blockrand::outputs {

OutputFormat cityjson_output();

}  // namespace blockrand::outputs
