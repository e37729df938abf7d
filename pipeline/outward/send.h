// Brings a place to a build: sends what differs, step by step, and notes what it did.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/outward/send_plan.h"
#include "pipeline/outward/target.h"
#include "pipeline/outward/target_state.h"

namespace blockrand::outward {

struct SendOptions {
  double keep_deleted_hours = 24;
  int batch = 1000;   ///< files of one call
  bool gzip = false;  ///< with variants
};

struct SendSummary {
  std::uint64_t files = 0, bytes = 0, variants = 0, unchanged = 0;
  std::uint64_t found = 0;  ///< of a run that was broken off: whole already
  std::uint64_t removed = 0;
  std::uint64_t later = 0;  ///< not named any more, removed by a later publishing
};

/// \param files  of the build, which the target sends from
/// \throws base::OutputError  the target failed: it leads to no missing file, and the next call goes on there
SendSummary send_build(const std::string& build, const std::map<std::string, BuildFile>& files, const Target& target,
                       TargetState& state, const SendOptions& options, base::Progress& progress);

/// Files that lie there without the variants that are asked for now are not there as they should be: nothing is known of them then.
/// Part of send_build; before look_ahead it makes that tell the truth.
void settle_variants(TargetState& state, const SendOptions& options);

/// What it would do. \param now  seconds of Unix time
SendPlan look_ahead(const std::map<std::string, BuildFile>& files, const TargetState& state, const SendOptions& options,
                    std::int64_t now);

/// Seconds of Unix time.
std::int64_t unix_time();

}  // namespace blockrand::outward
