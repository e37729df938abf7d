#include "pipeline/run/build_areas.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "pipeline/base/error.h"
#include "pipeline/base/heap.h"
#include "pipeline/base/host.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/publish.h"
#include "pipeline/georef/crs.h"
#include "pipeline/outputs/output.h"
#include "pipeline/run/area_overview.h"
#include "pipeline/run/area_parts.h"
#include "pipeline/run/area_runner.h"
#include "pipeline/run/area_surroundings.h"
#include "pipeline/run/before_tiles.h"
#include "pipeline/run/build_inputs.h"
#include "pipeline/run/divide_extract.h"
#include "pipeline/run/earlier_area.h"
#include "pipeline/run/estimate.h"
#include "pipeline/run/output_place.h"
#include "pipeline/run/region_facts.h"
#include "pipeline/run/shared_areas.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;
using importers::osm::ExtractStore;
using Json = nlohmann::ordered_json;
using model::TileId;

class AreaBuild {
 public:
  AreaBuild(const BuildOptions& options, base::Progress& progress)
      : options_(options),
        progress_(progress),
        folder_(options.output, options.force, {.foreign = foreign_files}),
        earlier_(earlier_models(folder_.target_path())) {
    base::refuse_inputs_in(options.output,
                           {options.input, options.terrain, options.overrides, options.configs, options.districts});
    tell_removed(folder_, progress);
  }

  BuildSummary run() {
    check_inputs_of_areas(options_, progress_);
    work_ = folder_.staging_path() + "/.work";
    AreaParts parts(options_, work_, progress_);
    parts.make();
    build(parts);
    return options_.plan ? finished(parts) : concluded(parts);
  }

  /// The areas that other processes built are taken from the plan.
  BuildSummary finish(const SharedAreas& shared) {
    AreaParts parts(options_, shared.work(), progress_);
    parts.open(WorkCache::Mode::work);
    shared_ = &shared;
    build(parts);
    return concluded(parts);
  }

 private:
  std::string place_of(const TileId& area) const { return folder_.staging_path() + "/" + area_path(area); }

  void build(AreaParts& parts) {
    AreaRunner runner(options_, parts, progress_);
    at_once_ = runner.at_once(), jobs_ = runner.jobs();
    std::uint64_t done = 0;
    progress_.begin("areas", parts.objects(), "buildings");
    std::vector<std::size_t> todo;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (take_over(parts, i) || take_shared(parts, i))
        done += parts.objects(i);
      else
        todo.push_back(i);
    }
    progress_.advance_to(done);
    if (!options_.plan)
      check_free_space(options_, disk_bytes(usual_size(parts.objects() - done), options_),
                       folder_.free_bytes());  // now, not when half of the areas are done
    runner.run(
        todo, [&](const TileId& area) { return place_of(area); },
        [&](std::size_t i, AreaOutcome outcome) {
          take(parts, std::move(outcome), i);
          done += parts.objects(i);
          progress_.advance_to(done);
        });
    summary_.store_bytes = parts.store().figures().bytes;
  }

  /// The same area of the earlier build, where nothing that changed concerns it.
  bool take_over(AreaParts& parts, std::size_t i) {
    const Json run = parts.earlier_run(i);
    std::vector<surroundings::SharedOutcome> shared;
    if (options_.surroundings.any() &&
        !(run.is_object() && read_shared(run.value("shared_surroundings", Json()), shared)))
      return false;
    const std::optional<std::vector<std::string>> paths = parts.earlier_files(i);
    if (!paths) return false;
    const std::string from = parts.earlier_place(i);
    if (!options_.plan)
      for (const std::string& path : *paths) {
        base::PublishedFile file;
        file.path = area_path(parts.id(i)) + "/" + path;
        folder_.link(file, from + "/" + path);
      }
    const auto count = [&](const char* key) {
      const Json tiles = run.value("tiles", Json::object());
      return tiles.contains(key) && tiles[key].is_number_unsigned() ? tiles[key].get<std::uint64_t>() : 0;
    };
    summary_.tiles_kept += count("built") + count("kept");
    summary_.below_quality = summary_.below_quality || run.value("below_quality", Json(false)) == true;
    if (const Json open = run.value("open_walls", Json()); open.is_array())
      for (const Json& side : open)
        if (side.is_array() && side.size() == 4 && side[0].is_number_unsigned() && side[1].is_number() &&
            side[2].is_number() && side[3].is_number())
          open_walls_.push_back(
              {side[0].get<std::uint64_t>(), side[1].get<double>(), side[2].get<double>(), side[3].get<double>()});
    shared_surroundings_.insert(shared_surroundings_.end(), shared.begin(), shared.end());
    summary_.areas_taken_over.insert(text_of(parts.id(i)));
    ++kept_;
    return true;
  }

  /// What another process built. \throws base::InputError  it is damaged
  bool take_shared(AreaParts& parts, std::size_t i) {
    if (shared_ == nullptr) return false;
    std::optional<AreaOutcome> outcome = shared_->outcome(parts.id(i), parts.key(i));
    if (!outcome) return false;
    if (!outcome->in_part) parts.look_into_all(i, outcome->why_whole);
    parts.note_peak(outcome->peak_bytes, outcome->cpu_seconds);
    link_tree(shared_->place(parts.id(i)), place_of(parts.id(i)));
    outcome->folder = place_of(parts.id(i));
    take(parts, std::move(*outcome), i);
    return true;
  }

  void take(const AreaParts& parts, AreaOutcome&& outcome, std::size_t i) {
    summary_.tiles_built += outcome.tiles_built, summary_.tiles_kept += outcome.tiles_kept;
    summary_.planned_tile_seconds += outcome.planned_tile_seconds;
    for (const auto& [why, n] : outcome.tiles_built_for) summary_.tiles_built_for[why] += n;
    const std::string area = text_of(parts.id(i));
    for (const std::string& entry : outcome.kept_work) summary_.kept_work_of_areas.insert(area + " " + entry);
    summary_.below_quality = summary_.below_quality || outcome.below_quality;
    if (outcome.in_part) summary_.areas_in_part.insert(area);
    for (TileTime& tile : outcome.slowest_tiles) note_slow_tile(summary_.slowest_tiles, std::move(tile));
    summary_.unaccounted.insert(summary_.unaccounted.end(), outcome.unaccounted.begin(), outcome.unaccounted.end());
    if (options_.plan) return;
    const std::string place = place_of(parts.id(i));
    if (outcome.folder != place) {  // objects that no stage decided on
      std::error_code error;
      fs::rename(outcome.folder, place, error);
      if (error) throw base::OutputError(place + ": cannot be written: " + error.message());
    }
    Json run = json_of(place + "/run.json");
    run["made_from"] = parts.key(i);
    run["facts"] = parts.facts_key(i);
    if (outcome.in_part)
      run["looked_into"] = outcome.looked_into;
    else
      run["looked_into_all_because"] = outcome.why_whole;
    run[kWholeCpuSeconds] = whole_cpu_seconds(parts, i, outcome);
    run["below_quality"] = outcome.below_quality;
    run["open_walls"] = Json::array();
    for (const outputs::PartySide& side : outcome.open_walls)
      run["open_walls"].push_back({side.wall, side.length, side.base, side.top});
    open_walls_.insert(open_walls_.end(), outcome.open_walls.begin(), outcome.open_walls.end());
    if (options_.surroundings.any()) run["shared_surroundings"] = shared_json(outcome.shared_surroundings);
    shared_surroundings_.insert(shared_surroundings_.end(), outcome.shared_surroundings.begin(),
                                outcome.shared_surroundings.end());
    folder_.write(area_path(parts.id(i)) + "/run.json.new", run.dump(1) + "\n");
    std::error_code error;
    fs::rename(place + "/run.json.new", place + "/run.json", error);
    if (error) throw base::OutputError(place + "/run.json: cannot be written: " + error.message());
  }

  /// What the area took when all of its tiles were worked on: a later plan is balanced by it. Null: nobody knows.
  static Json whole_cpu_seconds(const AreaParts& parts, std::size_t i, const AreaOutcome& outcome) {
    if (outcome.tiles_kept == 0) return std::nearbyint(outcome.cpu_seconds * 1000) / 1000;
    const Json before = parts.earlier_run(i);
    return before.is_object() ? before.value(kWholeCpuSeconds, Json()) : Json();
  }

  /// Documents of all areas; the build is published.
  BuildSummary concluded(AreaParts& parts) {
    progress_.begin("documents");
    Overview overview(parts.named(), parts.survey().facts, parts.store().figures());
    for (std::size_t i = 0; i < parts.size(); ++i) overview.add(parts.id(i), place_of(parts.id(i)));
    overview.add(parts.survey().rows);
    overview.settle(std::move(open_walls_));
    const RegionSurvey& survey = parts.survey();
    shared_surroundings_.insert(shared_surroundings_.end(), survey.shared_surroundings.begin(),
                                survey.shared_surroundings.end());
    if (options_.surroundings.any()) overview.settle_around(shared_surroundings_, survey.surroundings);
    overview.sum_up(summary_);
    refuse_shrunk(options_, summary_, earlier_);
    overview.write(folder_, parts.survey().unmatched, summary_);
    progress_.end();
    std::error_code error;
    if (!work_.empty()) fs::remove_all(work_, error);
    summary_.areas = parts.size(), summary_.areas_kept = kept_;
    summary_.kept_work.merge(parts.kept_work());
    BuildSummary done = finished(parts);
    folder_.write("run.json", run_json(parts));
    publish(done);
    return done;
  }

  BuildSummary finished(const AreaParts& parts) {
    progress_.end();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    own_peak_ = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    summary_.peak_rss_bytes = std::max(parts.peak(), own_peak_);
    summary_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    summary_.tiles_in_flight = at_once_ * (static_cast<std::size_t>(jobs_) + 2);
    summary_.folder = options_.output;
    return summary_;
  }

  std::string run_json(const AreaParts& parts) const {
    Json j;
    j["timings"] = Json::object();
    for (const auto& t : progress_.times()) j["timings"][t.name] = std::nearbyint(t.seconds * 1000) / 1000;
    j["seconds"] = std::nearbyint(summary_.seconds * 1000) / 1000;
    j["cpu_seconds_of_processes"] = std::nearbyint(parts.cpu_seconds() * 1000) / 1000;
    j["peak_rss_bytes"] = summary_.peak_rss_bytes;
    j["peak_rss_bytes_of_the_first_process"] = own_peak_;
    j["store_bytes"] = summary_.store_bytes;
    if (parts.store_written_because().empty())
      j["store"] = "brought up to date";
    else
      j["store_written_because"] = parts.store_written_because();
    j["areas"] = {{"all", parts.size()}, {"taken_over", kept_}, {"at_once", at_once_}};
    j["tiles"] = {
        {"built", summary_.tiles_built}, {"kept", summary_.tiles_kept}, {"built_for", summary_.tiles_built_for}};
    j["slowest_tiles"] = slowest_tiles_json(summary_.slowest_tiles);
    j["jobs"] = base::worker_count(options_.jobs);
    j["host"] = base::host_name();
    const InputFile file = extract_file(options_);
    j["inputs"] = {{{"role", file.role}, {"path", file.path}, {"bytes", file.bytes}, {"sha256", file.sha256}}};
    return j.dump(1) + "\n";
  }

  void publish(BuildSummary& summary) {
    if (!summary.unaccounted.empty()) {
      const std::string asked = folder_.target_path(), place = folder_.publish_beside("unaccounted");
      if (place != asked) summary.folder = place;
    } else if (const std::string left = folder_.publish(); !left.empty()) {
      progress_.warn("the old build could not be removed: " + left);
    }
  }

  const BuildOptions& options_;
  base::Progress& progress_;
  base::StagedFolder folder_;
  std::optional<std::uint64_t> earlier_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::string work_;                     ///< below the folder; empty: elsewhere
  const SharedAreas* shared_ = nullptr;  ///< areas of other processes
  std::size_t at_once_ = 1, kept_ = 0;
  int jobs_ = 1;
  std::uint64_t own_peak_ = 0;
  std::vector<outputs::PartySide> open_walls_;                    ///< of all areas
  std::vector<surroundings::SharedOutcome> shared_surroundings_;  ///< as well
  BuildSummary summary_;
};

}  // namespace

void refuse_contradictions_of_areas(const BuildOptions& options) {
  if (options.areas == 0 && options.area.empty()) return;
  if (options.outputs.single_glb || options.outputs.single_cityjson)
    throw base::UsageError(
        fmt::format("{} is a file of the whole model, which a build in areas never has in memory: build without {}",
                    options.outputs.single_glb ? "--single-glb" : "--single-cityjson",
                    options.areas > 0 ? "--areas (areas = 1 in region.toml)" : "--area"));
  const char* what = options.bbox                      ? "--bbox"
                     : !options.tile.empty()           ? "--tile"
                     : !options.imagery.images.empty() ? "--imagery"
                     : options.outputs.imagery         ? "--imagery"
                                                       : nullptr;
  if (options.areas > 0 && !options.area.empty()) throw base::UsageError("--area and --areas contradict each other");
  if (what)
    throw base::UsageError(
        fmt::format("{} cannot be used with --{}: build without areas (areas = 1 in region.toml), or cut the "
                    "extract first",
                    what, options.areas > 0 ? "areas" : "area"));
}

void check_inputs_of_areas(const BuildOptions& options, base::Progress& progress) {
  warn_of_unread(options, progress);
  if (!options.crs.empty()) georef::check_crs(options.crs);
  const BuildInputs inputs(options);  // what is wrong with them is told before the extract is read
}

BuildSummary build_in_areas(const BuildOptions& options, base::Progress& progress) {
  refuse_contradictions_of_areas(options);
  return AreaBuild(options, progress).run();
}

BuildSummary finish_areas(const BuildOptions& options, const SharedAreas& shared, base::Progress& progress) {
  return AreaBuild(options, progress).finish(shared);
}

BuildSummary build_one_area(const BuildOptions& options, base::Progress& progress) {
  refuse_contradictions_of_areas(options);
  if (options.pinned.empty())
    throw base::UsageError(
        "--area needs --pinned build.json of a build with --areas: an area alone cannot choose the CRS");
  if (!options.crs.empty()) throw base::UsageError("--area takes the CRS of --pinned: leave out --crs");
  BuildOptions of_area = options;
  of_area.name = name_of(options);
  of_area.areas = parse_tile(options.area, "--area", kLowestArea).level;
  TileChoice choice =
      choose_area(parse_tile(options.area, "--area", kLowestArea), read_region_facts(options.pinned, options));
  of_area.area.clear(), of_area.pinned.clear();
  base::StagedFolder place(options.output + ".store", false, {.name = "store", .marker = "index"});
  std::string because;
  divide(options, place.staging_path(), {}, because, progress);
  const ExtractStore store(place.staging_path() + "/store");
  std::ifstream file(options.pinned, std::ios::binary);
  const Json pinned = Json::parse(file, nullptr, false);
  if (!pinned.is_object() || !pinned.contains("areas") || !pinned["areas"].contains(options.area))
    throw base::InputError(options.pinned, "areas", "has no area " + options.area,
                           "Name one of those that it lists, and the record of a build with --areas");
  choice.placeless = store.has_placeless() && pinned["areas"].begin().key() == options.area;
  base::keep_memory_low();
  return build_area(of_area, {store, choice}, progress);
}

}  // namespace blockrand::run
