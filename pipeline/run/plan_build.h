// `build --dry-run`: everything that can be checked before a build is, and nothing is written.
#pragma once

#include <cstdint>
#include <string>

#include "pipeline/georef/crs.h"
#include "pipeline/run/estimate.h"
#include "pipeline/run/options.h"

namespace blockrand::base {
class Progress;
}

namespace blockrand::run {

/// What a build would do.
struct BuildPlan {
  std::uint64_t buildings = 0, parts = 0;  ///< in the extract, or in what of it is built
  TownSize size;
  std::uint64_t areas = 0;  ///< of a build in areas
  georef::Crs crs;
  std::string heights;           ///< what z will mean
  std::string folder;            ///< where the build would lie
  bool replaces = false;         ///< an earlier build lies there
  std::uint64_t free_bytes = 0;  ///< there
  BuildEstimate estimate;
};

/// Reads options, inputs, rules and the extract as build() does, and looks at the output's place without touching it. Warns of what
/// build() would warn of before its tiles.
/// \throws what build() would throw, where that can be known before the tiles
BuildPlan plan_build(const BuildOptions& options, base::Progress& progress);

}  // namespace blockrand::run
