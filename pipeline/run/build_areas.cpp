#include "pipeline/run/build_areas.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/base/child_process.h"
#include "pipeline/base/error.h"
#include "pipeline/base/heap.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/publish.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/text.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/projection.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/outputs/output.h"
#include "pipeline/run/area_changes.h"
#include "pipeline/run/area_overview.h"
#include "pipeline/run/area_survey.h"
#include "pipeline/run/before_tiles.h"
#include "pipeline/run/build_inputs.h"
#include "pipeline/run/divide_extract.h"
#include "pipeline/run/earlier_area.h"
#include "pipeline/run/estimate.h"
#include "pipeline/run/output_place.h"
#include "pipeline/run/region_state.h"
#include "pipeline/run/tile_key.h"
#include "pipeline/run/work_cache.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;
using importers::osm::ExtractStore;
using Json = nlohmann::ordered_json;
using model::TileId;

/// What an area needs, for --memory-limit: an estimate on the safe side. Of areas that were measured (LoD3, 3D Tiles, two jobs;
/// docs/internal/RESULTS.md) one around which 67 MB are stored took 677 MB of the 763 that this gives; with all formats none was. Bytes.
constexpr std::uint64_t kAreaBase = 160'000'000;
constexpr double kPerStoredByte = 9;

/// Bytes stored around an area up to which it need not be careful of memory (own choice: by the estimate above such areas need less than 400 MB).
constexpr std::uint64_t kRoomy = 25'000'000;

/// What an area's process sends back beside its files.
struct AreaOutcome {
  std::uint64_t tiles_built = 0, tiles_kept = 0;
  double planned_tile_seconds = 0;
  std::map<std::string, std::uint64_t> tiles_built_for;
  std::set<std::string> kept_work;
  bool below_quality = false;
  std::vector<std::string> unaccounted;
  std::string folder;
  std::vector<outputs::PartySide> open_walls;
  bool in_part = false;    ///< only some tiles were looked into
  bool too_small = false;  ///< that was not enough: nothing was built
  std::string why_whole;   ///< why all were
};

AreaOutcome outcome_of(BuildSummary&& s) {
  return {s.tiles_built,
          s.tiles_kept,
          s.planned_tile_seconds,
          std::move(s.tiles_built_for),
          std::move(s.kept_work),
          s.below_quality,
          std::move(s.unaccounted),
          std::move(s.folder),
          std::move(s.open_walls),
          false,
          false,
          {}};
}

class AreaBuild {
 public:
  AreaBuild(const BuildOptions& options, base::Progress& progress)
      : options_(options),
        progress_(progress),
        folder_(options.output, options.force, {.foreign = foreign_files}),
        earlier_(earlier_models(folder_.target_path())),
        work_(folder_.staging_path() + "/.work") {
    base::refuse_inputs_in(options.output,
                           {options.input, options.terrain, options.overrides, options.configs, options.districts});
    tell_removed(folder_, progress);
  }

  BuildSummary run() {
    warn_of_unread(options_, progress_);
    if (!options_.crs.empty()) georef::check_crs(options_.crs);
    { const BuildInputs inputs(options_); }  // what is wrong with them is told before the extract is read
    open_cache();
    progress_.begin("divide");
    const EarlierStore earlier = earlier_store();
    peak_ = divide(options_, work_, earlier, written_because_, progress_);
    if (earlier.files.empty())
      written_because_ = options_.earlier.empty() ? "there is no build before" : no_store_because_;
    const ExtractStore store(work_ + "/store");
    if (store.figures().cleaned_texts)
      progress_.warn(told_input(options_) + ": NUL characters in its texts were replaced; reports do not repeat that");
    progress_.begin("survey");
    survey(store);
    choose(store);
    build(store);
    if (options_.plan) return finished();
    progress_.begin("documents");
    Overview overview(named_, survey_.facts, store.figures());
    for (const AreaPart& part : parts_) overview.add(part.choice.id, place_of(part.choice.id));
    overview.add(survey_.rows);
    overview.settle(std::move(open_walls_));
    overview.sum_up(summary_);
    refuse_shrunk(options_, summary_, earlier_);
    overview.write(folder_, survey_.unmatched, summary_);
    progress_.end();
    std::error_code error;
    fs::remove_all(work_, error);
    summary_.areas = parts_.size(), summary_.areas_kept = kept_;
    if (cache_)
      for (const std::string& entry : cache_->used()) summary_.kept_work.insert(entry);
    BuildSummary done = finished();
    folder_.write("run.json", run_json());
    publish(done);
    return done;
  }

 private:
  std::string place_of(const TileId& area) const { return folder_.staging_path() + "/" + area_path(area); }

  void open_cache() {
    if (options_.cache.empty()) return;
    try {
      cache_ = std::make_unique<WorkCache>(options_.cache, program_identity(), progress_,
                                           options_.plan ? WorkCache::Mode::look : WorkCache::Mode::work);
    } catch (const base::OutputError& error) {
      progress_.warn(fmt::format("no work is kept, nor taken from earlier runs: {}", error.what()));
    }
    if (!cache_) named_.cache.clear();
  }

  void survey(const ExtractStore& store) {
    base::ChildResult result = base::run_in_child(options_.input, [&](base::Progress& child) {
      std::optional<WorkCache> cache;
      std::optional<base::Memo> memo;
      if (!named_.cache.empty()) {
        cache.emplace(named_.cache, program_identity(), child, child_mode(), "survey");
        memo = memo_in(*cache, program_identity());
      }
      const RegionSurvey survey = survey_region(store, options_, child, memo ? &*memo : nullptr);
      return base::packed(std::pair(survey, cache ? cache->used() : std::set<std::string>()));
    });
    note(result);
    auto [survey, used] = base::unpacked<std::pair<RegionSurvey, std::set<std::string>>>(result.bytes);
    survey_ = std::move(survey);
    for (const std::string& entry : used) summary_.kept_work.insert(entry);
    for (const std::string& what : survey_.unanswered) progress_.warn(what);
    if (!survey_.unmatched.empty())
      progress_.warn(fmt::format("{}: {} entries match nothing in the extract, the first is {}; report.json lists them",
                                 options_.overrides, survey_.unmatched.size(), survey_.unmatched.front()));
  }
  WorkCache::Mode child_mode() const { return options_.plan ? WorkCache::Mode::look : WorkCache::Mode::part; }

  /// Which areas there are, and what each is made from.
  void choose(const ExtractStore& store) {
    std::set<TileId> tiles;
    for (const auto& [tile, objects] : survey_.objects) tiles.insert(tile);
    // What has no place needs one that tells of it.
    if (tiles.empty()) {
      const std::vector<importers::osm::StoredArea> areas = areas_of(store, options_.areas);
      tiles.insert(areas.empty() ? TileId{options_.areas, 0, 0} : areas.front().tile);
    }
    std::uint64_t largest = 0;
    const georef::Crs crs = georef::open_crs(survey_.facts.crs, survey_.facts.box);
    const georef::Projection projection(crs, survey_.facts.box);
    for (const TileId& tile : tiles) {
      AreaPart& part = parts_.emplace_back(AreaPart{store, choose_area(tile, survey_.facts)});
      const importers::osm::StoredPart stored = store.part(part.choice.window);
      part.roomy = stored.bytes <= kRoomy;
      largest = std::max(largest, stored.bytes);
      part.choice.placeless = parts_.size() == 1 && store.has_placeless();
      base::Packer key;
      key << program_identity() << options_.settings << named_.name << tile;
      pack_facts(key, part.choice, projection);
      facts_keys_.push_back(base::sha256_of(key.bytes));
      key << stored.sha256;
      // Objects without a place have no hash of their own.
      if (part.choice.placeless) key << store.figures().sha256;
      keys_.push_back(base::sha256_of(key.bytes));
      if (cache_) part.record_key = keys_.back();
    }
    find_changes(store, projection);
    const std::uint64_t each = kAreaBase + static_cast<std::uint64_t>(kPerStoredByte * static_cast<double>(largest));
    const int workers = base::worker_count(options_.jobs);
    at_once_ = 1;
    if (options_.memory_limit > 0) {
      at_once_ = std::clamp<std::size_t>(static_cast<std::size_t>(options_.memory_limit) / each, 1,
                                         static_cast<std::size_t>(workers));
      if (static_cast<std::uint64_t>(options_.memory_limit) < each)
        progress_.warn(fmt::format("--memory-limit: one area needs about {}. {}", base::with_byte_unit(each),
                                   options_.areas < kFinestAreas
                                       ? fmt::format("Choose smaller ones, --areas {}", options_.areas + 1)
                                       : std::string("Smaller ones would hardly need less")));
    }
    jobs_ = std::max(1, workers / static_cast<int>(at_once_));
    // Of an area that is looked into in part at most kMostOfAll (area_changes.cpp) is read, and few tiles are built.
    constexpr std::size_t kPartsAtOnce = 2;
    parts_at_once_ =
        options_.memory_limit > 0 ? at_once_ : std::min<std::size_t>(static_cast<std::size_t>(workers), kPartsAtOnce);
  }

  static constexpr std::string_view kStores = "stores";
  /// \param data  hash of the extract's file: a store knows nodes and members that no kept object tells of
  static std::string store_key(const std::string& data) {
    base::Packer key;
    key << program_identity() << data;
    return base::sha256_of(key.bytes);
  }

  void because(const std::string& why) {
    for (std::size_t i = 0; i < parts_.size(); ++i) why_whole_[i] = why;
  }

  /// The kept store of the data of the earlier build.
  std::optional<WorkCache::Found> kept_store() {
    const Json run = json_of(options_.earlier + "/run.json");
    const Json inputs = run.is_object() ? run.value("inputs", Json()) : Json();
    if (!inputs.is_array() || inputs.empty()) return std::nullopt;
    std::optional<WorkCache::Found> before = cache_->find(kStores, store_key(text_in(inputs.front(), "sha256")));
    return before && before->places.size() == importers::osm::kStoreFiles.size() ? std::move(before) : std::nullopt;
  }

  EarlierStore earlier_store() {
    no_store_because_ = "the data came as a whole";
    if (!options_.changes || !cache_ || options_.earlier.empty() || options_.settings.empty()) return {};
    no_store_because_ = "the data of the earlier build are not kept";
    const std::optional<WorkCache::Found> before = kept_store();
    if (!before) return {};
    return {before->places, before->files.back().sha256, options_.changes};
  }

  /// What differs from the data of the earlier build, and which tiles it concerns. The store is kept for the next run.
  void find_changes(const ExtractStore& store, const georef::Projection& projection) {
    if (!cache_ || options_.settings.empty()) return;
    std::vector<base::PublishedFile> files;
    for (const char* name : importers::osm::kStoreFiles) {
      std::error_code error;
      const std::string path = work_ + "/store/" + name;
      files.push_back({name, fs::file_size(path, error), base::sha256_file(path)});
    }
    cache_->keep(kStores, store_key(extract_file(options_).sha256), {}, files, work_ + "/store");
    if (options_.earlier.empty()) return;
    const std::optional<WorkCache::Found> before = kept_store();
    if (!before) return because("the data of the earlier build are not kept");
    std::vector<importers::osm::ChangedObject> changes;
    try {
      changes = store.changes_since(ExtractStore(before->places[0], before->places[1]));
    } catch (const base::InputError&) {
      return because("the data of the earlier build are damaged");
    }
    const BuildInputs inputs(options_);
    const RulesReach rules{rules_reach(inputs.rules.book), rules_ask_look(inputs.rules.book)};
    for (std::size_t i = 0; i < parts_.size(); ++i) look_at_changes(i, changes, rules, projection);
  }

  /// Which tiles of an area the changes concern, where work on the others is kept.
  void look_at_changes(std::size_t i, std::span<const importers::osm::ChangedObject> changes, const RulesReach& rules,
                       const georef::Projection& projection) {
    AreaPart& part = parts_[i];
    const Json run = json_of(options_.earlier + "/" + area_path(part.choice.id) + "/run.json");
    why_whole_[i] = "it is new";
    if (!run.is_object()) return;
    why_whole_[i] = "what is true of the region, or settings";
    if (text_in(run, "facts") != facts_keys_[i] || text_in(run, "made_from") == keys_[i]) return;
    why_whole_[i] = "records are not kept";
    const std::string made_from = text_in(run, "made_from");
    const std::optional<WorkCache::Found> found = cache_->find(kReaches, made_from);
    if (!found || !cache_->has(kRecords, made_from)) return;
    AreaReach reaches;
    try {
      reaches = base::unpacked<AreaReach>(found->bytes);
    } catch (const base::UnpackError&) {
      return;
    }
    part.roomy = true;  // work on most of its tiles is kept
    AreaChanges concerned = concerned_tiles(part.choice, reaches, changes, rules, projection);
    why_whole_[i] = std::move(concerned.why_whole);
    if (concerned.tiles.empty() && why_whole_[i].empty())
      unconcerned_.insert(i);
    else if (why_whole_[i].empty())
      looks_[i] = {std::move(concerned), made_from};
  }

  /// The area, of which only some tiles are looked into.
  AreaPart part_of(std::size_t i) const {
    AreaPart part = parts_[i];
    if (const auto look = looks_.find(i); look != looks_.end())
      part.choice.only = look->second.changes.tiles, part.choice.window = look->second.changes.window,
      part.choice.parts = look->second.changes.parts, part.choice.other_network = look->second.changes.other_network,
      part.before_key = look->second.before;
    return part;
  }

  /// The same area of the earlier build, where it was made from the same, or nothing that changed concerns it, and is whole.
  bool take_over(std::size_t i) {
    if (options_.earlier.empty() || options_.settings.empty()) return false;
    const std::string from = options_.earlier + "/" + area_path(parts_[i].choice.id);
    const Json run = json_of(from + "/run.json");
    if (!run.is_object() || (text_in(run, "made_from") != keys_[i] && !unconcerned_.contains(i))) return false;
    std::vector<std::string> paths = {"build.json", "run.json"};
    try {
      if (earlier_record_.is_null()) earlier_record_ = json_of(options_.earlier + "/build.json");
      const Json& named = earlier_record_.at("areas").at(text_of(parts_[i].choice.id));
      if (!area_is_whole(from, named.at("build_sha256").get<std::string>(), paths)) {
        progress_.warn(fmt::format("{} is damaged: the area is built anew", from));
        return false;
      }
    } catch (const nlohmann::json::exception&) {
      progress_.warn(fmt::format("{} is damaged: the area is built anew", from));
      return false;
    }
    if (!options_.plan)
      for (const std::string& path : paths) {
        base::PublishedFile file;
        file.path = area_path(parts_[i].choice.id) + "/" + path;
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
    summary_.areas_taken_over.insert(text_of(parts_[i].choice.id));
    ++kept_;
    return true;
  }

  void build(const ExtractStore& store) {
    std::uint64_t all = 0, done = 0;
    for (const auto& [tile, objects] : survey_.objects) all += objects;
    progress_.begin("areas", all, "buildings");
    std::vector<std::size_t> todo;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const auto objects = survey_.objects.find(parts_[i].choice.id);
      if (!take_over(i))
        todo.push_back(i);
      else if (objects != survey_.objects.end())
        done += objects->second;
    }
    progress_.advance_to(done);
    if (!options_.plan)
      check_free_space(options_, disk_bytes(usual_size(all - done), options_),
                       folder_.free_bytes());  // now, not when half of the areas are done
    std::vector<std::size_t> whole, in_part;
    for (const std::size_t i : todo) (looks_.contains(i) ? in_part : whole).push_back(i);
    // Those of which little is looked into first: what is too little for them is looked into as a whole.
    build_areas(in_part, parts_at_once_, done, whole);
    std::ranges::sort(whole);
    build_areas(whole, at_once_, done, whole);
    summary_.store_bytes = store.figures().bytes;
  }

  /// \param todo       indices of parts
  /// \param too_small  gets those whose looks found that they must be looked into as a whole
  void build_areas(const std::vector<std::size_t> todo, std::size_t at_once, std::uint64_t& done,
                   std::vector<std::size_t>& too_small) {
    at_once = std::clamp<std::size_t>(at_once, 1, std::max<std::size_t>(1, todo.size()));
    BuildOptions of_area = named_;
    of_area.force = false;
    of_area.jobs = std::max(1, base::worker_count(options_.jobs) / static_cast<int>(at_once));
    base::run_in_children(
        todo.size(), at_once,
        [&](std::size_t t, base::Progress& child) {
          const std::size_t i = todo[t];
          const AreaPart part = part_of(i);
          if (!part.roomy) base::keep_memory_low();
          of_area.output = place_of(part.choice.id);
          AreaOutcome outcome;
          try {
            outcome = outcome_of(build_area(of_area, part, child));
            outcome.in_part = part.choice.only.has_value();
          } catch (const WindowTooSmall& reason) {
            outcome.too_small = true, outcome.why_whole = reason.what();
          }
          return base::packed(outcome);
        },
        [&](std::size_t t, base::ChildResult result) {
          note(result);
          const std::size_t i = todo[t];
          AreaOutcome outcome = base::unpacked<AreaOutcome>(result.bytes);
          if (outcome.too_small) {
            looks_.erase(i);
            why_whole_[i] = std::move(outcome.why_whole);
            too_small.push_back(i);
            return;
          }
          outcome.why_whole = why_whole_[i];
          const TileId area = parts_[i].choice.id;
          take(std::move(outcome), i);
          if (const auto objects = survey_.objects.find(area); objects != survey_.objects.end())
            done += objects->second;
          progress_.advance_to(done);
        },
        [&](std::size_t t) { return "area " + text_of(parts_[todo[t]].choice.id); });
  }

  void take(AreaOutcome&& outcome, std::size_t i) {
    summary_.tiles_built += outcome.tiles_built, summary_.tiles_kept += outcome.tiles_kept;
    summary_.planned_tile_seconds += outcome.planned_tile_seconds;
    for (const auto& [why, n] : outcome.tiles_built_for) summary_.tiles_built_for[why] += n;
    const std::string area = text_of(parts_[i].choice.id);
    for (const std::string& entry : outcome.kept_work) summary_.kept_work_of_areas.insert(area + " " + entry);
    summary_.below_quality = summary_.below_quality || outcome.below_quality;
    if (outcome.in_part) summary_.areas_in_part.insert(area);
    summary_.unaccounted.insert(summary_.unaccounted.end(), outcome.unaccounted.begin(), outcome.unaccounted.end());
    if (options_.plan) return;
    const std::string place = place_of(parts_[i].choice.id);
    if (outcome.folder != place) {  // objects that no stage decided on
      std::error_code error;
      fs::rename(outcome.folder, place, error);
      if (error) throw base::OutputError(place + ": cannot be written: " + error.message());
    }
    Json run = json_of(place + "/run.json");
    run["made_from"] = keys_[i];
    run["facts"] = facts_keys_[i];
    if (outcome.in_part)
      run["looked_into"] = looks_.at(i).changes.tiles.size();
    else
      run["looked_into_all_because"] = outcome.why_whole;
    run["below_quality"] = outcome.below_quality;
    run["open_walls"] = Json::array();
    for (const outputs::PartySide& side : outcome.open_walls)
      run["open_walls"].push_back({side.wall, side.length, side.base, side.top});
    open_walls_.insert(open_walls_.end(), outcome.open_walls.begin(), outcome.open_walls.end());
    folder_.write(area_path(parts_[i].choice.id) + "/run.json.new", run.dump(1) + "\n");
    std::error_code error;
    fs::rename(place + "/run.json.new", place + "/run.json", error);
    if (error) throw base::OutputError(place + "/run.json: cannot be written: " + error.message());
  }

  void note(const base::ChildResult& result) {
    peak_ = std::max(peak_, result.peak_rss_bytes);
    cpu_seconds_ += result.cpu_seconds;
    for (const std::string& warning : result.warnings)
      if (told_.insert(warning).second) progress_.warn(warning);
  }

  BuildSummary finished() {
    progress_.end();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    own_peak_ = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    summary_.peak_rss_bytes = std::max(peak_, own_peak_);
    summary_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    summary_.tiles_in_flight = at_once_ * (static_cast<std::size_t>(jobs_) + 2);
    summary_.folder = options_.output;
    return summary_;
  }

  std::string run_json() const {
    Json j;
    j["timings"] = Json::object();
    for (const auto& t : progress_.times()) j["timings"][t.name] = std::nearbyint(t.seconds * 1000) / 1000;
    j["seconds"] = std::nearbyint(summary_.seconds * 1000) / 1000;
    j["cpu_seconds_of_processes"] = std::nearbyint(cpu_seconds_ * 1000) / 1000;
    j["peak_rss_bytes"] = summary_.peak_rss_bytes;
    j["peak_rss_bytes_of_the_first_process"] = own_peak_;
    j["store_bytes"] = summary_.store_bytes;
    if (written_because_.empty())
      j["store"] = "brought up to date";
    else
      j["store_written_because"] = written_because_;
    j["areas"] = {{"all", parts_.size()}, {"taken_over", kept_}, {"at_once", at_once_}};
    j["tiles"] = {
        {"built", summary_.tiles_built}, {"kept", summary_.tiles_kept}, {"built_for", summary_.tiles_built_for}};
    j["jobs"] = base::worker_count(options_.jobs);
    char host[256] = "";
    ::gethostname(host, sizeof host - 1);
    j["host"] = host;
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
  BuildOptions named_ = with_name(options_);
  base::Progress& progress_;
  base::StagedFolder folder_;
  std::optional<std::uint64_t> earlier_;
  std::string work_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::unique_ptr<WorkCache> cache_;
  RegionSurvey survey_;
  std::vector<AreaPart> parts_;
  std::vector<std::string> keys_, facts_keys_;  ///< parallel to parts_
  /// An area of which only some tiles are looked into.
  struct Look {
    AreaChanges changes;
    std::string before;  ///< key of the records
  };
  std::map<std::size_t, Look> looks_;  ///< by index of the part
  std::map<std::size_t, std::string> why_whole_;
  std::set<std::size_t> unconcerned_;  ///< parts in which nothing differs
  std::size_t at_once_ = 1, parts_at_once_ = 1, kept_ = 0;
  int jobs_ = 1;
  std::uint64_t peak_ = 0, own_peak_ = 0;
  double cpu_seconds_ = 0;
  std::string written_because_, no_store_because_;  ///< the store, whole; see divide()
  std::set<std::string> told_;
  Json earlier_record_;
  std::vector<outputs::PartySide> open_walls_;  ///< of all areas
  BuildSummary summary_;

  static BuildOptions with_name(BuildOptions options) {
    options.name = name_of(options);
    return options;
  }
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

BuildSummary build_in_areas(const BuildOptions& options, base::Progress& progress) {
  refuse_contradictions_of_areas(options);
  return AreaBuild(options, progress).run();
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
