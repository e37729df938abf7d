#include "pipeline/outward/send_plan.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace blockrand::outward {

std::string plain_path(const std::string& path) {
  constexpr std::string_view kEnd = ".gz";
  return path.ends_with(kEnd) ? path.substr(0, path.size() - kEnd.size()) : std::string();
}

SendPlan plan_to_send(const std::map<std::string, BuildFile>& files, const TargetState& there, const SendRules& rules) {
  SendPlan plan;
  std::map<std::pair<Step, int>, SendStep> steps;
  for (const auto& [path, file] : files) {
    if (there.leaving().contains(path)) plan.stay.push_back(path);
    if (const auto found = there.here().find(path); found != there.here().end() && found->second == file.sha256) {
      ++plan.unchanged;
      continue;
    }
    SendStep& step = steps[{file.step, file.level}];
    step.step = file.step, step.level = file.level;
    step.files.push_back(file);
    ++plan.files, plan.bytes += file.bytes;
  }
  for (auto& [key, step] : steps) plan.steps.push_back(std::move(step));

  std::set<std::string> known = there.in_doubt();
  for (const auto& [path, hash] : there.here()) known.insert(path);
  for (const std::string& path : known) {
    if (files.contains(path)) continue;
    if (const auto plain = files.find(plain_path(path)); plain != files.end()) {
      // A variant comes with its file. One in doubt beside a file that came is of an earlier one, which had a variant.
      const auto lies = there.here().find(plain->first);
      const bool came = lies != there.here().end() && lies->second == plain->second.sha256;
      if (!rules.variants || (came && there.in_doubt().contains(path)))
        plan.remove.push_back(path);
      else if (there.leaving().contains(path))
        plan.stay.push_back(path);  // its file is named again
      continue;
    }
    const auto found = there.leaving().find(path);
    if (found == there.leaving().end() && rules.keep_deleted > 0) plan.leave.push_back(path);
    const std::int64_t since = found == there.leaving().end() ? rules.now : found->second;
    (since + rules.keep_deleted <= rules.now ? plan.remove : plan.later).push_back(path);
  }
  std::ranges::stable_sort(plan.remove, std::greater<>(), [](const std::string& path) {
    const std::string plain = plain_path(path);
    return step_of(plain.empty() ? path : plain);
  });
  return plan;
}

}  // namespace blockrand::outward
