// The operator's own command at the end of a run.
#pragma once

#include <string>
#include <string_view>

#include "pipeline/base/progress.h"

namespace blockrand::run {

/// How a run ended.
struct RunEnd {
  std::string_view state;  ///< published, unchanged, refused, failed; for `notify` also stale
  int number = 0;          ///< of the run; 0: it had none yet
  std::string reason;      ///< one line: why it failed, was refused, or left data that are too old; else empty
};

/// Runs RegionOptions::hook or ::notify by /bin/sh and waits for it, with BLOCKRAND_STATE, BLOCKRAND_REASON, BLOCKRAND_REGION,
/// BLOCKRAND_BUILD and BLOCKRAND_CHANGES in its environment; the last two are empty where the run had no number. A command that fails is
/// told, and fails nothing. Does nothing for an empty one.
/// \param what    how messages call it: "hook"
/// \param folder  of the region
void call_hook(std::string_view what, const std::string& command, const std::string& folder, const RunEnd& end,
               base::Progress& progress);

/// `text` in one line, without control characters.
std::string one_line(std::string_view text);

}  // namespace blockrand::run
