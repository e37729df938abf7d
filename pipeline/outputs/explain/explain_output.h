// explain/: what `blockrand explain` reads.
#pragma once

#include "pipeline/outputs/output.h"

namespace blockrand::outputs {

OutputFormat explain_output();

}  // namespace blockrand::outputs
