// report.json: every object that is not modelled, every fallback and every notice.
#pragma once

#include "pipeline/outputs/output.h"

namespace blockrand::outputs {

OutputFormat report_json_output();

}  // namespace blockrand::outputs
