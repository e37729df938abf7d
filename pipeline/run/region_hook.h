// The operator's own command at the end of a run.
#pragma once

#include <string>
#include <string_view>

#include "pipeline/base/progress.h"
#include "pipeline/run/region_folder.h"

namespace blockrand::run {

/// Runs RegionOptions::hook by /bin/sh and waits for it, with BLOCKRAND_STATE, BLOCKRAND_REGION, BLOCKRAND_BUILD and
/// BLOCKRAND_CHANGES in its environment. A hook that fails is told, and fails nothing. Does nothing for an empty one, nor after a
/// dry run, which has no end.
/// \param state   published, unchanged, refused, failed
/// \param number  of the run
void call_hook(const std::string& hook, bool dry_run, const RegionFolder& region, std::string_view state, int number,
               base::Progress& progress);

}  // namespace blockrand::run
