// An interrupted build leaves no half result.
#pragma once

#include "pipeline/base/progress.h"

namespace blockrand::cli {

/// From now on SIGINT, SIGTERM and SIGHUP remove the unfinished build, leave an earlier one as it is, and end the
/// process with 128 plus the signal's number; a second one ends it at once. Signals that the caller's environment
/// ignores (nohup, background jobs) stay ignored. SIGXFSZ and SIGPIPE become errors of the write that caused them. Call
/// once, before the first thread is started.
void clean_up_on_signals(base::LogFormat format);

}  // namespace blockrand::cli
