#include "pipeline/run/area_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "pipeline/base/error.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/sha256.h"
#include "pipeline/georef/crs.h"
#include "pipeline/run/area_overview.h"
#include "pipeline/run/before_tiles.h"
#include "pipeline/run/build_inputs.h"
#include "pipeline/run/earlier_area.h"
#include "pipeline/run/region_folder.h"
#include "pipeline/run/region_state.h"
#include "pipeline/run/tile_key.h"

namespace blockrand::run {

namespace fs = std::filesystem;
using importers::osm::ExtractStore;
using Json = nlohmann::ordered_json;
using model::TileId;

namespace {

constexpr std::string_view kStores = "stores";
/// Bytes stored around an area up to which it need not be careful of memory (own choice: by the estimate of area_runner.cpp such areas
/// need less than 400 MB).
constexpr std::uint64_t kRoomy = 25'000'000;

/// What `save` leaves.
struct SavedParts {
  std::string program;
  RegionSurvey survey;
  std::set<std::string> kept_work;
  std::string written_because;
  std::uint64_t peak = 0;
  double cpu_seconds = 0;
};

/// \param data  hash of the extract's file: a store knows nodes and members that no kept object tells of
/// \param surroundings  it has what only these are made of
std::string store_key(const std::string& data, bool surroundings) {
  base::Packer key;
  key << program_identity() << data << surroundings;
  return base::sha256_of(key.bytes);
}

BuildOptions with_name(BuildOptions options) {
  options.name = name_of(options);
  return options;
}

}  // namespace

AreaParts::AreaParts(const BuildOptions& options, std::string work, base::Progress& progress)
    : options_(options), named_(with_name(options)), work_(std::move(work)), progress_(progress) {}

void AreaParts::open_cache(WorkCache::Mode mode) {
  if (options_.cache.empty()) return;
  try {
    cache_ = std::make_unique<WorkCache>(options_.cache, program_identity(), progress_, mode);
  } catch (const base::OutputError& error) {
    progress_.warn(fmt::format("no work is kept, nor taken from earlier runs: {}", error.what()));
  }
  if (!cache_) named_.cache.clear();
}

void AreaParts::make() {
  open_cache(options_.plan ? WorkCache::Mode::look : WorkCache::Mode::work);
  progress_.begin("divide");
  const EarlierStore earlier = earlier_store();
  peak_ = divide(options_, work_, earlier, written_because_, progress_);
  if (earlier.files.empty())
    written_because_ = options_.earlier.empty() ? "there is no build before" : no_store_because_;
  store_.emplace(work_ + "/store");
  if (store_->figures().cleaned_texts)
    progress_.warn(told_input(options_) + ": NUL characters in its texts were replaced; reports do not repeat that");
  progress_.begin("survey");
  make_survey();
  tell_survey();
  keep_store();
  choose();
}

void AreaParts::make_survey() {
  const WorkCache::Mode child_mode = options_.plan ? WorkCache::Mode::look : WorkCache::Mode::part;
  base::ChildResult result = base::run_in_child(options_.input, [&](base::Progress& child) {
    std::optional<WorkCache> cache;
    std::optional<base::Memo> memo;
    if (!named_.cache.empty()) {
      cache.emplace(named_.cache, program_identity(), child, child_mode, "survey");
      memo = memo_in(*cache, program_identity());
    }
    const RegionSurvey survey = survey_region(*store_, options_, child, memo ? &*memo : nullptr);
    return base::packed(std::pair(survey, cache ? cache->used() : std::set<std::string>()));
  });
  note(result);
  std::tie(survey_, kept_work_) = base::unpacked<std::pair<RegionSurvey, std::set<std::string>>>(result.bytes);
}

void AreaParts::tell_survey() {
  for (const std::string& what : survey_.unanswered) progress_.warn(what);
  if (!survey_.unmatched.empty())
    progress_.warn(fmt::format("{}: {} entries match nothing in the extract, the first is {}; report.json lists them",
                               options_.overrides, survey_.unmatched.size(), survey_.unmatched.front()));
}

void AreaParts::save() const {
  write_whole(work_ + "/survey", base::packed(SavedParts{program_identity(), survey_, kept_work(), written_because_,
                                                         peak_, cpu_seconds_}));
}

void AreaParts::open(WorkCache::Mode mode) {
  const std::string place = work_ + "/survey";
  std::ifstream file(place, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  SavedParts saved;
  try {
    saved = base::unpacked<SavedParts>(bytes);
  } catch (const base::UnpackError&) {
    saved.program.clear();
  }
  if (saved.program != program_identity())
    throw base::InputError(place, "", "is damaged, or was written by another version of the program",
                           "Drop the plan and make a new one, by one program on all hosts");
  survey_ = std::move(saved.survey), kept_work_ = std::move(saved.kept_work);
  written_because_ = std::move(saved.written_because);
  note_peak(saved.peak, saved.cpu_seconds);
  store_.emplace(work_ + "/store");
  open_cache(mode);
  choose();
}

std::set<std::string> AreaParts::kept_work() const {
  std::set<std::string> all = kept_work_;
  if (cache_) all.merge(cache_->used());
  return all;
}

/// Which areas there are, and what each is made from.
void AreaParts::choose() {
  std::set<TileId> tiles;
  for (const auto& [tile, objects] : survey_.objects) tiles.insert(tile);
  tiles.insert(survey_.only_surroundings.begin(), survey_.only_surroundings.end());
  // What has no place needs one that tells of it.
  if (tiles.empty()) {
    const std::vector<importers::osm::StoredArea> areas = areas_of(*store_, options_.areas);
    tiles.insert(areas.empty() ? TileId{options_.areas, 0, 0} : areas.front().tile);
  }
  const georef::Crs crs = georef::open_crs(survey_.facts.crs, survey_.facts.box);
  const georef::Projection projection(crs, survey_.facts.box);
  for (const TileId& tile : tiles) {
    AreaPart& part = parts_.emplace_back(AreaPart{*store_, choose_area(tile, survey_.facts)});
    const importers::osm::StoredPart stored = store_->part(part.choice.window);
    part.roomy = stored.bytes <= kRoomy;
    stored_.push_back(stored.bytes);
    part.choice.placeless = parts_.size() == 1 && store_->has_placeless();
    base::Packer key;
    key << program_identity() << options_.settings << named_.name << tile;
    pack_facts(key, part.choice, projection);
    facts_keys_.push_back(base::sha256_of(key.bytes));
    key << stored.sha256;
    // Objects without a place have no hash of their own.
    if (part.choice.placeless) key << store_->figures().sha256;
    keys_.push_back(base::sha256_of(key.bytes));
    if (!named_.cache.empty()) part.record_key = keys_.back();
  }
  find_changes(projection);
}

void AreaParts::because(const std::string& why) {
  for (std::size_t i = 0; i < parts_.size(); ++i) why_whole_[i] = why;
}

/// The kept store of the data of the earlier build.
std::optional<WorkCache::Found> AreaParts::kept_store() {
  const Json run = json_of(options_.earlier + "/run.json");
  const Json inputs = run.is_object() ? run.value("inputs", Json()) : Json();
  if (!inputs.is_array() || inputs.empty()) return std::nullopt;
  std::optional<WorkCache::Found> before =
      cache_->find(kStores, store_key(text_in(inputs.front(), "sha256"), options_.surroundings.any()));
  return before && before->places.size() == importers::osm::kStoreFiles.size() ? std::move(before) : std::nullopt;
}

EarlierStore AreaParts::earlier_store() {
  no_store_because_ = "the data came as a whole";
  if (!options_.changes || !cache_ || options_.earlier.empty() || options_.settings.empty()) return {};
  no_store_because_ = "the data of the earlier build are not kept";
  const std::optional<WorkCache::Found> before = kept_store();
  if (!before) return {};
  return {before->places, before->files.back().sha256, options_.changes};
}

/// The store stays for the next run.
void AreaParts::keep_store() {
  if (!cache_ || options_.settings.empty()) return;
  std::vector<base::PublishedFile> files;
  for (const char* name : importers::osm::kStoreFiles) {
    std::error_code error;
    const std::string path = work_ + "/store/" + name;
    files.push_back({name, fs::file_size(path, error), base::sha256_file(path)});
  }
  cache_->keep(kStores, store_key(extract_file(options_).sha256, options_.surroundings.any()), {}, files,
               work_ + "/store");
}

/// What differs from the data of the earlier build, and which tiles it concerns.
void AreaParts::find_changes(const georef::Projection& projection) {
  if (!cache_ || options_.settings.empty() || options_.earlier.empty()) return;
  const std::optional<WorkCache::Found> before = kept_store();
  if (!before) return because("the data of the earlier build are not kept");
  std::vector<importers::osm::ChangedObject> changes;
  try {
    changes = store_->changes_since(ExtractStore(before->places[0], before->places[1]));
  } catch (const base::InputError&) {
    return because("the data of the earlier build are damaged");
  }
  const BuildInputs inputs(options_);
  const RulesReach rules{rules_reach(inputs.rules.book), rules_ask_look(inputs.rules.book)};
  for (std::size_t i = 0; i < parts_.size(); ++i) look_at_changes(i, changes, rules, projection);
}

/// Which tiles of an area the changes concern, where work on the others is kept.
void AreaParts::look_at_changes(std::size_t i, std::span<const importers::osm::ChangedObject> changes,
                                const RulesReach& rules, const georef::Projection& projection) {
  AreaPart& part = parts_[i];
  const Json run = earlier_run(i);
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
  AreaChanges concerned =
      concerned_tiles(part.choice, reaches, changes, rules, options_.surroundings.any(), projection);
  why_whole_[i] = std::move(concerned.why_whole);
  if (concerned.tiles.empty() && why_whole_[i].empty())
    unconcerned_.insert(i);
  else if (why_whole_[i].empty())
    looks_[i] = {std::move(concerned), made_from};
}

std::uint64_t AreaParts::largest() const { return stored_.empty() ? 0 : std::ranges::max(stored_); }

AreaPart AreaParts::part(std::size_t i) const {
  AreaPart part = parts_[i];
  if (const auto look = looks_.find(i); look != looks_.end())
    part.choice.only = look->second.changes.tiles, part.choice.window = look->second.changes.window,
    part.choice.parts = look->second.changes.parts, part.choice.other_network = look->second.changes.other_network,
    part.before_key = look->second.before;
  return part;
}

void AreaParts::look_into_all(std::size_t i, std::string why) {
  looks_.erase(i);
  why_whole_[i] = std::move(why);
}

std::string AreaParts::why_whole(std::size_t i) const {
  const auto why = why_whole_.find(i);
  return why == why_whole_.end() ? std::string() : why->second;
}

std::uint64_t AreaParts::objects(std::size_t i) const {
  const auto found = survey_.objects.find(id(i));
  return found == survey_.objects.end() ? 0 : found->second;
}

std::uint64_t AreaParts::objects() const {
  std::uint64_t all = 0;
  for (const auto& [tile, objects] : survey_.objects) all += objects;
  return all;
}

std::string AreaParts::earlier_place(std::size_t i) const { return options_.earlier + "/" + area_path(id(i)); }

Json AreaParts::earlier_run(std::size_t i) const {
  return options_.earlier.empty() ? Json() : json_of(earlier_place(i) + "/run.json");
}

std::optional<std::vector<std::string>> AreaParts::earlier_files(std::size_t i) {
  if (options_.earlier.empty() || options_.settings.empty()) return std::nullopt;
  const std::string from = earlier_place(i);
  const Json run = earlier_run(i);
  if (!run.is_object() || (text_in(run, "made_from") != keys_[i] && !unconcerned_.contains(i))) return std::nullopt;
  std::vector<std::string> paths = {"build.json", "run.json"};
  try {
    if (!earlier_record_) earlier_record_ = json_of(options_.earlier + "/build.json");
    const Json& named = earlier_record_->at("areas").at(text_of(id(i)));
    if (area_is_whole(from, named.at("build_sha256").get<std::string>(), paths)) return paths;
  } catch (const nlohmann::json::exception&) {
    // Its record is damaged: so is the area.
  }
  progress_.warn(fmt::format("{} is damaged: the area is built anew", from));
  return std::nullopt;
}

void AreaParts::note(const base::ChildResult& result) {
  note_peak(result.peak_rss_bytes, result.cpu_seconds);
  for (const std::string& warning : result.warnings)
    if (told_.insert(warning).second) progress_.warn(warning);
}

void AreaParts::note_peak(std::uint64_t bytes, double cpu_seconds) {
  peak_ = std::max(peak_, bytes);
  cpu_seconds_ += cpu_seconds;
}

}  // namespace blockrand::run
