// The main job: one extract in, a published build out.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "pipeline/base/progress.h"
#include "pipeline/masses/roofscape.h"
#include "pipeline/run/options.h"

namespace blockrand::run {

/// What a build ended with.
struct BuildSummary {
  std::uint64_t buildings_in = 0, parts_in = 0;
  std::uint64_t models = 0, represented = 0, duplicates = 0, reported = 0;
  std::array<std::uint64_t, 4> models_by_lod{};   ///< objects whose best solid is LoD 0, 1, 2, 3
  std::map<std::string, std::uint64_t> issues;    ///< rows by code
  masses::Roofscape roofscape;                  ///< how roofs stand in their rows
  std::uint64_t files = 0, bytes = 0;             ///< written
  double seconds = 0;
  std::uint64_t peak_rss_bytes = 0;
  std::uint64_t store_bytes = 0;                  ///< of it: the extract and its indices before the first tile
  std::uint64_t tiles_in_flight = 0;              ///< at most this many tiles share the rest
  bool below_quality = false;                     ///< a building is simpler than asked, or has no solid
};

/// Builds and publishes. An existing output folder stays untouched until the new one is complete.
/// \throws base::InputError   unreadable or invalid input
/// \throws base::UsageError   options that contradict each other; an output place that cannot be used
/// \throws base::OutputError  the disk is full or cannot be written
BuildSummary build(const BuildOptions& options, base::Progress& progress);

}  // namespace blockrand::run
