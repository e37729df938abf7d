#include "pipeline/run/update_region.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>

#include "importers/osm/apply_changes.h"
#include "importers/polygons/read_polygons.h"
#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/text.h"
#include "pipeline/georef/crs.h"
#include "pipeline/run/area_record.h"
#include "pipeline/run/build_inputs.h"
#include "pipeline/run/changes_map.h"
#include "pipeline/run/link_unchanged.h"
#include "pipeline/run/region_end.h"
#include "pipeline/run/region_folder.h"
#include "pipeline/run/region_hook.h"
#include "pipeline/run/region_metrics.h"
#include "pipeline/run/region_plan.h"
#include "pipeline/run/region_shards.h"
#include "pipeline/run/region_state.h"
#include "pipeline/run/tile_key.h"
#include "pipeline/run/work_cache.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using importers::osm::AppliedChanges;

/// A file that is gone with the object, unless it is kept.
struct Scratch {
  explicit Scratch(std::string p) : path(std::move(p)) {}
  ~Scratch() {
    std::error_code error;
    if (!path.empty()) fs::remove(path, error);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::string path;
};

std::string_view word(UpdateState state) {
  switch (state) {
    case UpdateState::published:
      return "published";
    case UpdateState::unchanged:
      return "unchanged";
    case UpdateState::refused:
      return "refused";
    case UpdateState::planned:
      return "planned";
    case UpdateState::shared:
      return "shared";
  }
  return "";
}

class Updater {
 public:
  Updater(const UpdateOptions& options, const RegionFolder& region, base::Progress& progress)
      : options_(options), region_(region), progress_(progress) {}

  UpdateSummary run() {
    const std::optional<int> current = region_.current();
    summary_.before = current;
    if (current) {
      before_ = DataState::read(region_.state(*current));
    }
    check_baseline(current);
    const Plan plan = plan_of(options_, region_, current, before_);
    summary_.why = plan.why;
    summary_.sequence = plan.sequence;
    DataState fresh = before_;
    fresh.settings = settings_sha256(options_), fresh.sequence = plan.sequence, fresh.replaced = current;
    fresh.time = plan.time;
    fresh.crs_chosen = options_.build.crs.empty();
    if (!plan.extract.empty() && plan.extract == options_.build.input) fresh.input = stamp_of(plan.extract);
    const bool new_settings = current && fresh.settings != before_.settings;
    if (new_settings) summary_.why.emplace_back("region.toml, rules or the program differ from the published build's");
    if (current) warn_of_level(*current);
    summary_.number = region_.next();

    const bool nothing_came = current && plan.extract.empty() && plan.changes.empty();
    if (nothing_came && !new_settings) return stay(*current, fresh);
    if (options_.dry_run && !region_.exists()) return ended(UpdateState::planned);
    // A dry run holds no lock: it writes where no other run does.
    Scratch data(options_.dry_run
                     ? (fs::temp_directory_path() / fmt::format("blockrand-{}.osm.pbf", ::getpid())).string()
                     : region_.data(summary_.number) + ".part");
    const AppliedChanges applied = make_data(plan, current, data.path);
    fresh.sha256 = base::sha256_file(data.path);
    fresh.areas = areas_for(options_, data.path, current, before_);
    const bool same_data = current && (fresh.sha256 == before_.sha256 || (plan.extract.empty() && !applied.any()));
    if (same_data && !new_settings) {
      if (!options_.dry_run && !plan.extract.empty()) restore_data(*current, data);
      return stay(*current, fresh);
    }
    if (options_.dry_run) {
      look_ahead(current, data.path, fresh.areas);
      return ended(UpdateState::planned);
    }

    const std::string place = region_.data(summary_.number);
    if (std::rename(data.path.c_str(), place.c_str()) != 0)
      throw base::OutputError(place + ": cannot be written: " + std::strerror(errno));
    data.path = place;
    UpdateSummary done = shards_ > 0 ? plan_shards(current, fresh) : build_and_publish(current, fresh);
    data.path.clear();
    return done;
  }

  /// As `run`, up to the areas, which others build. \param shards  how many share them
  UpdateSummary plan(int shards) {
    shards_ = shards;
    return run();
  }

  /// The rest of it.
  UpdateSummary finish(const RegionShards& plan) {
    const std::optional<int> current = region_.current();
    summary_.before = current;
    if (current) before_ = DataState::read(region_.state(*current));
    check_baseline(current);
    plan.restore(summary_);
    BuildOptions build = build_options_for(options_, region_, plan.number, current, before_, plan.state.areas);
    return publish_built(current, plan.state, finish_areas(build, plan.shared(region_), progress_));
  }

  /// What is known of a run that throws.
  const UpdateSummary& so_far() const { return summary_; }
  /// What it wrote to log/runs.jsonl.
  const Json& line() const { return line_; }

 private:
  UpdateSummary ended(UpdateState state) {
    summary_.state = state;
    summary_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    if (options_.dry_run) return summary_;
    line_ = run_line(summary_, progress_);
    append_run(region_, line_, progress_);
    if (state != UpdateState::unchanged && state != UpdateState::shared) try {
        write_whole(region_.log(summary_.number).substr(0, region_.log(summary_.number).rfind('.')) + ".report.txt",
                    run_report(region_, summary_.folder, line_));
      } catch (const base::OutputError& error) {
        progress_.warn(fmt::format("the report of the run is not written: {}", error.what()));
      }
    return summary_;
  }

  UpdateSummary plan_shards(std::optional<int> current, const DataState& fresh) {
    if (fresh.areas == 0)
      throw base::UsageError(fmt::format(
          "{} is built as a whole, which is one piece of work: blockrand update builds it. To share the work write "
          "areas = {} below [build] in {}",
          region_.path(), kUsualAreas, region_.settings()));
    BuildOptions build = build_options_for(options_, region_, summary_.number, current, before_, fresh.areas);
    build.changes = changes_;
    RegionShards plan;
    plan.number = summary_.number, plan.shards = shards_, plan.before = current, plan.state = fresh;
    plan.note(summary_);
    remove_plan(region_);  // what is left of one that was broken off
    try {
      plan.areas = plan_areas(build, plan.shared(region_), shards_, progress_);
      plan.write(region_);
    } catch (...) {
      remove_plan(region_);
      throw;
    }
    summary_.planned_areas = plan.areas.size();
    return ended(UpdateState::shared);
  }

  /// Which tiles a run would build, and how long it should take.
  void look_ahead(std::optional<int> current, const std::string& data, int areas) {
    BuildOptions build = build_options_for(options_, region_, summary_.number, current, before_, areas);
    build.input = data;
    build.output = (fs::temp_directory_path() / fmt::format("blockrand-{}.plan", ::getpid())).string();
    build.plan = true;
    build.changes = changes_;
    const auto start = std::chrono::steady_clock::now();
    const BuildSummary planned = blockrand::run::build(build, progress_);
    summary_.tiles_built = planned.tiles_built, summary_.tiles_kept = planned.tiles_kept;
    summary_.tiles_built_for = planned.tiles_built_for;
    if (!current) return;
    // What comes before the tiles was just done; what comes after them takes what it took.
    const Json last = read_json(region_.build(*current) + "/run.json");
    double after = 0;
    if (last.contains("timings") && last["timings"].is_object() && last["timings"].contains("documents") &&
        last["timings"]["documents"].is_number())
      after = last["timings"]["documents"].get<double>();
    if (planned.tiles_built == 0 || planned.planned_tile_seconds > 0)
      summary_.expected_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() +
                                  planned.planned_tile_seconds + after;
  }

  AppliedChanges make_data(const Plan& plan, std::optional<int> current, const std::string& path) {
    // What is wrong with settings and inputs is told before long data are read.
    if (!options_.build.crs.empty()) georef::check_crs(options_.build.crs);
    { const BuildInputs inputs(options_.build); }
    progress_.begin("apply changes");
    std::string base = plan.extract;
    if (base.empty()) {
      base = region_.data(*current);
      std::error_code error;
      if (!fs::is_regular_file(base, error) || base::sha256_file(base) != before_.sha256)
        throw base::InputError(base, "",
                               "is missing or damaged: the published build is whole, but changes need its data",
                               "Update from a full extract: blockrand update " + region_.path() + " EXTRACT.osm.pbf");
    }
    const std::optional<importers::osm::ClipPolygon> polygon = polygon_of(options_.region);
    if (plan.extract.empty() && before_.areas > 0) changes_ = importers::osm::no_changed_objects();
    const AppliedChanges applied =
        importers::osm::apply_changes(base, plan.changes, path, polygon ? &*polygon : nullptr, changes_.get());
    if (applied.cleaned_texts)
      progress_.warn(base + ": NUL characters in its texts were replaced; reports of builds do not repeat that");
    summary_.created = applied.created, summary_.modified = applied.modified, summary_.deleted = applied.deleted;
    summary_.known = applied.known, summary_.outside = applied.outside;
    return applied;
  }

  /// A full extract gave the data that the published build was made of: they take the place of damaged ones.
  void restore_data(int current, Scratch& fresh) {
    const std::string place = region_.data(current);
    std::error_code error;
    if (fs::is_regular_file(place, error) && base::sha256_file(place) == before_.sha256) return;
    if (base::sha256_file(fresh.path) != before_.sha256) return;
    if (std::rename(fresh.path.c_str(), place.c_str()) != 0)
      throw base::OutputError(place + ": cannot be written: " + std::strerror(errno));
    fresh.path.clear();
    summary_.why.push_back("the data of build " + std::to_string(current) + " were damaged and are whole again");
  }

  /// The published build stays; what is known of its data may go on.
  UpdateSummary stay(int current, const DataState& fresh) {
    summary_.number = current;
    summary_.folder = region_.build(current);
    if (!options_.dry_run &&
        (fresh.sequence != before_.sequence || fresh.input != before_.input || fresh.time != before_.time)) {
      before_.sequence = fresh.sequence, before_.input = fresh.input, before_.time = fresh.time;
      before_.write(region_.state(current));
    }
    return ended(UpdateState::unchanged);
  }

  /// Against the published build; where that is damaged, by its counts alone.
  void compare(std::optional<int> current, const base::Memo* memo) {
    progress_.begin("compare builds");
    const std::string fresh = region_.build(summary_.number);
    if (current) try {
        summary_.changes = compare_builds(region_.build(*current), fresh, memo);
        summary_.gates = gates_of(summary_.changes, options_.region, false);
        compare_baseline(*current, fresh, memo);
        return;
      } catch (const base::InputError& error) {
        progress_.warn(fmt::format("{}. The new build is compared by its number of models alone", error.what()));
      }
    summary_.changes = compare_builds("", fresh, memo);
    summary_.gates = gates_of(summary_.changes, options_.region, true);
    if (!current) return;
    const auto models = [](const Json& record) {
      return record.contains("counts") && record["counts"].contains("models") &&
                     record["counts"]["models"].is_number_unsigned()
                 ? record["counts"]["models"].get<double>()
                 : 0.0;
    };
    const double before = models(read_json(region_.build(*current) + "/build.json")),
                 after = models(read_json(fresh + "/build.json"));
    if (before > 0)
      summary_.gates.push_back(
          {"max_lost", "models that are gone", 100 * std::max(0.0, before - after) / before, options_.region.max_lost});
  }

  /// Before anything is done.
  void check_baseline(std::optional<int> current) const {
    const int baseline = options_.region.baseline;
    const std::vector<int> there = region_.passed();
    std::error_code error;
    if (baseline < 0 || !current ||
        (std::ranges::find(there, baseline) != there.end() && fs::is_directory(region_.build(baseline), error)))
      return;
    throw base::InputError(region_.settings(), "[gates] baseline", fmt::format("there is no build {}", baseline),
                           "Name one of those that blockrand status lists, or -1");
  }

  /// Against slow drift.
  void compare_baseline(int current, const std::string& fresh, const base::Memo* memo) {
    const int baseline = options_.region.baseline;
    if (baseline < 0 || baseline == current) return;
    const std::vector<Gate> drift = drift_gates(compare_builds(region_.build(baseline), fresh, memo), options_.region);
    summary_.gates.insert(summary_.gates.end(), drift.begin(), drift.end());
  }

  /// Lines of region.toml that say something.
  static std::vector<std::string> told_lines(const std::string& path) {
    std::vector<std::string> lines;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);)
      if (const std::size_t at = line.find_first_not_of(" \t"); at != std::string::npos && line[at] != '#')
        lines.push_back(line.substr(at));
    return lines;
  }
  static std::string read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// A newer program may have another level of detail where region.toml says none: nobody asked for the change that it makes.
  void warn_of_level(int current) {
    const auto configuration =
        read_json(region_.build(current) + "/build.json").value("configuration", nlohmann::json());
    if (!configuration.is_object() || !configuration.contains("lod") || configuration["lod"] == options_.build.lod)
      return;
    std::error_code error;
    if (!fs::is_regular_file(region_.settings_of(current), error) ||
        told_lines(region_.settings_of(current)) != told_lines(region_.settings()))
      return;
    progress_.warn(
        fmt::format("the published build has LoD {}, and this program builds LoD {} where {} says nothing: write lod = "
                    "{} there, below "
                    "[build], to keep it",
                    configuration["lod"].dump(), options_.build.lod, region_.settings(), configuration["lod"].dump()));
  }

  void diff_settings(std::optional<int> current) {
    std::error_code error;
    if (!current || !fs::is_regular_file(region_.settings_of(*current), error)) return;
    const std::vector<std::string> before = told_lines(region_.settings_of(*current)),
                                   now = told_lines(region_.settings());
    const auto only = [](const std::vector<std::string>& in, const std::vector<std::string>& other) {
      std::vector<std::string> out;
      for (const std::string& line : in)
        if (std::ranges::find(other, line) == other.end()) out.push_back(line);
      return out;
    };
    summary_.changes.settings_before = only(before, now), summary_.changes.settings_after = only(now, before);
  }

  /// Measures against hand-built models: against those of the published build.
  void ask_reference(std::optional<int> current) {
    if (options_.region.reference.empty() || !options_.compare_with_reference) return;
    progress_.begin("compare with the reference");
    const ReferenceVerdict verdict = options_.compare_with_reference(
        region_.build(summary_.number), current ? read_text(region_.comparison(*current)) : std::string());
    comparison_ = verdict.json;
    std::string worse;
    for (const std::string& measure : verdict.worse) worse += (worse.empty() ? "" : ", ") + measure;
    summary_.gates.push_back({"reference",
                              "measures against the reference that are worse by more than max_worse" +
                                  (worse.empty() ? std::string() : ": " + worse),
                              static_cast<double>(verdict.worse.size()), 0});
  }

  UpdateSummary build_and_publish(std::optional<int> current, const DataState& fresh) {
    const int number = summary_.number;
    BuildOptions build = build_options_for(options_, region_, number, current, before_, fresh.areas);
    build.changes = changes_;
    const BuildSummary built = blockrand::run::build(build, progress_);
    build.changes = nullptr, changes_ = nullptr;
    return publish_built(current, fresh, built);
  }

  /// Gates, and the switch.
  UpdateSummary publish_built(std::optional<int> current, const DataState& fresh, const BuildSummary& built) {
    const int number = summary_.number;
    summary_.folder = region_.build(number);
    summary_.tiles_built = built.tiles_built, summary_.tiles_kept = built.tiles_kept;
    summary_.tiles_built_for = built.tiles_built_for;
    summary_.areas = built.areas, summary_.areas_kept = built.areas_kept;
    summary_.slowest_tiles = built.slowest_tiles, summary_.peak_rss_bytes = built.peak_rss_bytes;
    std::set<std::string> kept_work = built.kept_work;
    kept_work.insert(built.kept_work_of_areas.begin(), built.kept_work_of_areas.end());
    if (current)  // what areas used that were taken over stays of use, and of those in part what comes before their tiles
      for (const std::string& entry : work_of(region_.cache(), RegionFolder::digits(*current))) {
        const std::size_t space = entry.find(' ');
        if (space == std::string::npos) continue;
        const std::string area = entry.substr(0, space),
                          kind = entry.substr(space + 1, entry.find('/', space) - space - 1);
        if (built.areas_taken_over.contains(area) ||
            (built.areas_in_part.contains(area) && kind != "tiles" && kind != kRecords && kind != kReaches))
          kept_work.insert(entry);
      }
    std::optional<WorkCache> cache;
    try {
      cache.emplace(region_.cache(), program_identity(), progress_);
    } catch (const std::exception& error) {
      progress_.warn(fmt::format("kept work is not looked after: {}", error.what()));
    }
    const std::optional<base::Memo> memo = cache ? std::optional(memo_in(*cache, program_identity())) : std::nullopt;
    compare(current, memo ? &*memo : nullptr);
    if (!built.unaccounted.empty())
      summary_.gates.push_back(
          {"unaccounted", "objects that no stage decided on", static_cast<double>(built.unaccounted.size()), 0});
    diff_settings(current);
    ask_reference(current);
    write_changes(region_, number, summary_);
    if (std::ranges::any_of(summary_.gates, &Gate::exceeded)) {
      summary_.folder = region_.set_aside(number);
      return ended(UpdateState::refused);
    }
    if (current) {
      const LinkedFiles linked = link_unchanged(region_.build(*current), region_.build(number), built.areas_taken_over);
      summary_.linked = linked.files, summary_.linked_bytes = linked.bytes;
    }
    write_whole(region_.settings_of(number), read_text(region_.settings()));
    if (!comparison_.empty()) write_whole(region_.comparison(number), comparison_);
    fresh.write(region_.state(number));
    region_.publish(number);
    // It is published: what fails now is told, and no more.
    UpdateSummary done = ended(UpdateState::published);
    try {
      write_whole(region_.log(number), dumped(line_, 1));
      std::vector<int> also;
      if (current) also.push_back(*current);
      if (options_.region.baseline >= 0) also.push_back(options_.region.baseline);
      std::vector<std::string> failed;
      const std::vector<int> old = region_.unmark(options_.region.keep, also, failed);
      std::set<std::string> builds;
      for (const int passed : region_.passed()) builds.insert(RegionFolder::digits(passed));
      // Old builds and old work are tens of thousands of files each.
      std::future<void> removed = std::async(std::launch::async, [&] { region_.remove(old, failed); });
      if (cache) {
        kept_work.merge(cache->used());
        keep_work_of(region_.cache(), RegionFolder::digits(number), kept_work, builds);
      }
      removed.get();
      for (const std::string& path : failed) progress_.warn("could not be removed: " + path);
    } catch (const std::exception& error) {
      progress_.warn(fmt::format("build {} is published, but: {}", number, error.what()));
    }
    return done;
  }

  const UpdateOptions& options_;
  const RegionFolder& region_;
  base::Progress& progress_;
  int shards_ = 0;  ///< by which the areas are to be built; 0: here
  /// From the data of the published build to the new ones; null where these come as a whole.
  std::shared_ptr<importers::osm::ChangedObjects> changes_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  UpdateSummary summary_;
  DataState before_;
  std::string comparison_;  ///< compare.json of the new build
  Json line_;
};

void check_explained(const UpdateOptions& options) {
  if (!options.build.outputs.explain)
    throw base::UsageError(
        "a region needs explanations, which its builds are compared by: take explain = false out of "
        "region.toml.");
}

using RunWork = std::function<UpdateSummary(Updater&)>;

/// A run of a region that is locked, however it ends. The hook and all that is told of it come last.
UpdateSummary run_to_its_end(const UpdateOptions& options, const RegionFolder& region, base::Progress& progress,
                             const RunWork& work) {
  Updater updater(options, region, progress);
  try {
    begin_run(region);
    UpdateSummary summary = work(updater);
    if (summary.state == UpdateState::shared) return summary;  // its end is to come
    summary.too_old = end_run(options, region, {word(summary.state), summary.number, refusal(summary.gates)},
                              updater.line(), progress);
    return summary;
  } catch (const std::exception& error) {
    Json line = run_line(updater.so_far(), progress);
    line["state"] = "failed", line["error"] = error.what();
    append_run(region, line, progress);
    end_run(options, region, {"failed", updater.so_far().number, one_line(error.what())}, line, progress);
    throw;
  }
}

/// What a run that was broken off left is removed.
void tidy(const RegionFolder& region, base::Progress& progress) {
  for (const std::string& path : region.remove_unfinished())
    progress.warn("removed " + path + ": left by a run that was broken off");
  if (remove_broken_plan(region)) progress.warn("removed " + region.plan() + ": left by a plan that was broken off");
  // A run that died between its gates and the switch left the region's first build without a pointer.
  std::error_code error;
  const std::string pointer = region.path() + "/current";
  if (const std::vector<int> builds = region.passed();
      builds.size() == 1 && !fs::is_symlink(pointer, error) && !fs::exists(pointer, error)) {
    region.publish(builds.front());
    progress.warn(fmt::format("{} was missing; it leads to the only build now, {}", pointer, builds.front()));
  }
}

/// The region's lock, and what `check` throws, or a word to the operator.
template <class Check>
void lock_or_notice(const UpdateOptions& options, const RegionFolder& region, std::optional<RegionLock>& lock,
                    base::Progress& progress, Check&& check) {
  try {
    region.make();
    lock.emplace(region, options.break_lock, progress);
    check();
  } catch (const std::exception& error) {
    // Another run may be at work: what it writes is its own.
    call_hook("notify command", options.region.notify, region.path(), {"failed", 0, one_line(error.what())}, progress);
    throw;
  }
}

UpdateSummary run_from_its_begin(const UpdateOptions& options, base::Progress& progress, const RunWork& work) {
  check_explained(options);
  const RegionFolder region(options.folder);
  std::optional<RegionLock> lock;
  lock_or_notice(options, region, lock, progress, [&] { refuse_while_planned(region); });
  return run_to_its_end(options, region, progress, [&](Updater& updater) {
    tidy(region, progress);
    return work(updater);
  });
}

}  // namespace

UpdateSummary update_region(const UpdateOptions& options, base::Progress& progress) {
  if (options.dry_run) {
    check_explained(options);
    const RegionFolder region(options.folder);
    return Updater(options, region, progress).run();
  }
  return run_from_its_begin(options, progress, [](Updater& updater) { return updater.run(); });
}

UpdateSummary plan_region(const UpdateOptions& options, int shards, base::Progress& progress) {
  return run_from_its_begin(options, progress, [&](Updater& updater) { return updater.plan(shards); });
}

namespace {

bool is_finished(const RegionFolder& region, const RegionShards& plan) {
  std::error_code error;
  return fs::exists(region.state(plan.number), error) && region.current() == plan.number;
}

}  // namespace

UpdateSummary finish_region(const UpdateOptions& options, base::Progress& progress) {
  check_explained(options);
  const RegionFolder region(options.folder);
  std::optional<RegionLock> lock;
  RegionShards plan;
  lock_or_notice(options, region, lock, progress, [&] {
    plan = RegionShards::read(region);
    if (is_finished(region, plan)) return;
    plan.check_same(region, settings_sha256(options));
    plan.check_done(region);
  });
  if (is_finished(region, plan)) {  // by a run that was killed just after
    remove_plan(region);
    progress.warn(fmt::format("run {} was published already", plan.number));
    UpdateSummary done;
    done.number = plan.number, done.before = plan.before, done.folder = region.build(plan.number);
    return done;
  }
  // A run that was broken off between building and publishing left a build that nobody published.
  std::error_code error;
  fs::remove_all(region.build(plan.number), error);
  if (plan.tell_unended(region, progress)) WorkCache::mark_open(region.cache());
  const UpdateSummary summary =
      run_to_its_end(options, region, progress, [&](Updater& updater) { return updater.finish(plan); });
  remove_plan(region);
  return summary;
}

SharedWork work_on_region(const UpdateOptions& options, const Shard& shard, base::Progress& progress) {
  const RegionFolder region(options.folder);
  const RegionShards plan = RegionShards::read(region);
  plan.check_same(region, settings_sha256(options));
  plan.check_shard(shard);
  std::set<model::TileId> areas;
  for (const PlannedArea& area : plan.areas)
    if (area.shard == shard.number) areas.insert(area.id);
  if (areas.empty()) return {};
  const DataState before = plan.before ? DataState::read(region.state(*plan.before)) : DataState();
  const BuildOptions build = build_options_for(options, region, plan.number, plan.before, before, plan.state.areas);
  return work_on_areas(build, plan.shared(region), areas, progress);
}

}  // namespace blockrand::run
