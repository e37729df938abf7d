// report.html, and plan.png beside it.
#pragma once

#include "pipeline/outputs/output.h"

namespace blockrand::outputs {

OutputFormat report_output();

}  // namespace blockrand::outputs
