// What must be sent to a place and removed from it so that it has a build, and in which order.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pipeline/outward/build_files.h"
#include "pipeline/outward/target_state.h"

namespace blockrand::outward {

/// Files that may become visible in any order among each other.
struct SendStep {
  Step step = Step::contents;
  int level = 0;
  std::vector<BuildFile> files;  ///< by path
};

struct SendPlan {
  std::vector<SendStep> steps;         ///< in the order in which they are sent; none is empty
  std::vector<std::string> remove;     ///< after all steps: what may go, tilesets before tiles
  std::vector<std::string> leave;      ///< what the build does not name any more, as of now
  std::vector<std::string> stay;       ///< what was to leave and is named again
  std::vector<std::string> later;      ///< what will be removed by a later publishing
  std::uint64_t files = 0, bytes = 0;  ///< to be sent
  std::uint64_t unchanged = 0;         ///< files that are there already
  bool empty() const { return steps.empty() && remove.empty() && leave.empty() && stay.empty(); }
};

struct SendRules {
  std::int64_t now = 0;           ///< seconds of Unix time
  std::int64_t keep_deleted = 0;  ///< seconds that a file stays after no tileset leads to it
  bool variants = false;          ///< FILE.gz may lie beside FILE
};

/// Of a file that is compressed beside its plain one: that one's path, else empty.
std::string plain_path(const std::string& path);

/// A file is sent when its hash is not that which lies there. What is there, or may be, and is not named by `files` leaves: it
/// stays for `keep_deleted` and is then removed. Variants without their plain file go with it; those of a file that stays, but
/// that has none any more, at once: servers would hand them out instead of it.
SendPlan plan_to_send(const std::map<std::string, BuildFile>& files, const TargetState& there, const SendRules& rules);

}  // namespace blockrand::outward
