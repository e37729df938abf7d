#include "pipeline/run/area_runner.h"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/base/heap.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/text.h"

namespace blockrand::run {

namespace {

/// What an area needs, for --memory-limit: an estimate on the safe side. Of areas that were measured (LoD3, 3D Tiles, two jobs;
/// docs/internal/RESULTS.md) one around which 67 MB are stored took 677 MB of the 763 that this gives; with all formats none was. Bytes.
constexpr std::uint64_t kAreaBase = 160'000'000;
constexpr double kPerStoredByte = 9;

AreaOutcome outcome_of(BuildSummary&& s) {
  AreaOutcome outcome;
  outcome.tiles_built = s.tiles_built, outcome.tiles_kept = s.tiles_kept;
  outcome.planned_tile_seconds = s.planned_tile_seconds;
  outcome.tiles_built_for = std::move(s.tiles_built_for);
  outcome.kept_work = std::move(s.kept_work);
  outcome.below_quality = s.below_quality;
  outcome.unaccounted = std::move(s.unaccounted);
  outcome.folder = std::move(s.folder);
  outcome.open_walls = std::move(s.open_walls);
  outcome.shared_surroundings = std::move(s.shared_surroundings);
  outcome.slowest_tiles = std::move(s.slowest_tiles);
  return outcome;
}

}  // namespace

AreaRunner::AreaRunner(const BuildOptions& options, AreaParts& parts, base::Progress& progress)
    : options_(options), parts_(parts) {
  const std::uint64_t each =
      kAreaBase + static_cast<std::uint64_t>(kPerStoredByte * static_cast<double>(parts.largest()));
  const int workers = base::worker_count(options.jobs);
  if (options.memory_limit > 0) {
    at_once_ = std::clamp<std::size_t>(static_cast<std::size_t>(options.memory_limit) / each, 1,
                                       static_cast<std::size_t>(workers));
    if (static_cast<std::uint64_t>(options.memory_limit) < each)
      progress.warn(fmt::format("--memory-limit: one area needs about {}. {}", base::with_byte_unit(each),
                                options.areas < kFinestAreas
                                    ? fmt::format("Choose smaller ones, --areas {}", options.areas + 1)
                                    : std::string("Smaller ones would hardly need less")));
  }
  jobs_ = std::max(1, workers / static_cast<int>(at_once_));
  // Of an area that is looked into in part at most kMostOfAll (area_changes.cpp) is read, and few tiles are built.
  constexpr std::size_t kPartsAtOnce = 2;
  parts_at_once_ =
      options.memory_limit > 0 ? at_once_ : std::min<std::size_t>(static_cast<std::size_t>(workers), kPartsAtOnce);
}

void AreaRunner::run(const std::vector<std::size_t>& todo,
                     const std::function<std::string(const model::TileId&)>& place,
                     const std::function<void(std::size_t, AreaOutcome)>& done) {
  std::vector<std::size_t> whole, in_part;
  for (const std::size_t i : todo) (parts_.in_part(i) ? in_part : whole).push_back(i);
  const std::vector<std::size_t> too_small = run_some(in_part, parts_at_once_, place, done);
  whole.insert(whole.end(), too_small.begin(), too_small.end());
  std::ranges::sort(whole);
  run_some(whole, at_once_, place, done);
}

/// \returns  those whose looks found that they must be looked into as a whole
std::vector<std::size_t> AreaRunner::run_some(const std::vector<std::size_t>& todo, std::size_t at_once,
                                              const std::function<std::string(const model::TileId&)>& place,
                                              const std::function<void(std::size_t, AreaOutcome)>& done) {
  at_once = std::clamp<std::size_t>(at_once, 1, std::max<std::size_t>(1, todo.size()));
  BuildOptions of_area = parts_.named();
  of_area.force = false;
  of_area.jobs = std::max(1, base::worker_count(options_.jobs) / static_cast<int>(at_once));
  std::vector<std::size_t> too_small;
  base::run_in_children(
      todo.size(), at_once,
      [&](std::size_t t, base::Progress& child) {
        const AreaPart part = parts_.part(todo[t]);
        if (!part.roomy) base::keep_memory_low();
        of_area.output = place(part.choice.id);
        AreaOutcome outcome;
        try {
          outcome = outcome_of(build_area(of_area, part, child));
          outcome.in_part = part.choice.only.has_value();
          if (outcome.in_part) outcome.looked_into = part.choice.only->size();
        } catch (const WindowTooSmall& reason) {
          outcome.too_small = true, outcome.why_whole = reason.what();
        }
        return base::packed(outcome);
      },
      [&](std::size_t t, base::ChildResult result) {
        parts_.note(result);
        AreaOutcome outcome = base::unpacked<AreaOutcome>(result.bytes);
        if (outcome.too_small) {
          parts_.look_into_all(todo[t], std::move(outcome.why_whole));
          too_small.push_back(todo[t]);
          return;
        }
        outcome.why_whole = parts_.why_whole(todo[t]);
        outcome.peak_bytes = result.peak_rss_bytes, outcome.cpu_seconds = result.cpu_seconds;
        done(todo[t], std::move(outcome));
      },
      [&](std::size_t t) { return "area " + text_of(parts_.id(todo[t])); });
  return too_small;
}

}  // namespace blockrand::run
