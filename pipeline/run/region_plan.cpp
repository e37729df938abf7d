#include "pipeline/run/region_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "importers/imagery/image_files.h"
#include "importers/osm/apply_changes.h"
#include "importers/polygons/read_polygons.h"
#include "pipeline/attributes/overrides.h"
#include "pipeline/attributes/rule_sets.h"
#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/run/replication.h"

namespace blockrand::run {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string stamp_of(const std::string& path) {
  std::error_code error;
  if (path.empty() || !fs::is_regular_file(path, error)) return "";
  return fmt::format("{}, {} bytes, {}", path, fs::file_size(path, error),
                     fs::last_write_time(path, error).time_since_epoch().count());
}

std::string settings_sha256(const UpdateOptions& options) {
  base::Sha256 hash;
  const auto add = [&](std::string_view text) { hash.add(std::to_string(text.size()) + ":" + std::string(text)); };
  add(options.version), add(options.settings_sha256);
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator entry(options.build.configs, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->is_regular_file(error)) files.push_back(entry->path());
  std::sort(files.begin(), files.end());
  for (const fs::path& path : files)
    add(path.lexically_relative(options.build.configs).string()), add(base::sha256_file(path.string()));
  for (const std::string& path : {options.build.overrides, options.region.polygon})
    if (!path.empty() && fs::is_regular_file(path, error)) add(base::sha256_file(path));
  for (const std::string& path : attributes::models_of(options.build.overrides)) add(base::sha256_file(path));
  if (!options.build.districts.empty()) {
    // With what it builds on, the files that its rules name, and rule files beside it.
    const attributes::ReadRuleSets sets = attributes::read_rule_sets(options.build.configs, options.build.districts);
    for (const auto& [name, path] : sets.files) add(name), add(base::sha256_file(path));
    std::set<fs::path> beside;
    for (const districts::Preset& preset : sets.book.presets)
      if (!preset.declared_in.empty()) beside.insert(fs::absolute(preset.declared_in).parent_path());
    for (const fs::path& folder : beside) {
      std::set<fs::path> rules;
      for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->path().extension() == ".cga") rules.insert(entry->path());
      // Element files, the models that they name, and profiles.
      for (const char* data : {"elements", "profiles"})
        for (fs::directory_iterator entry(folder / data, error), end; !error && entry != end; entry.increment(error))
          if (entry->is_regular_file(error)) rules.insert(entry->path());
      error.clear();
      for (const fs::path& path : rules) add(path.filename().string()), add(base::sha256_file(path.string()));
    }
  }
  std::vector<std::string> rasters;
  if (!options.build.terrain.empty()) rasters.push_back(options.build.terrain);
  for (const importers::imagery::ImageSource& image : options.build.imagery.images) rasters.push_back(image.path);
  for (const std::string& path : rasters)
    for (const importers::imagery::FileStamp& file : importers::imagery::stamps_of_raster(path))
      add(file.path), add(std::to_string(file.bytes)), add(std::to_string(file.changed));
  return hash.finish();
}

std::uint64_t next_sequence(const RegionOptions& options, std::optional<std::uint64_t> applied,
                            const RegionFolder& region) {
  if (applied) return *applied + 1;
  if (options.first_sequence >= 0) return static_cast<std::uint64_t>(options.first_sequence);
  throw base::InputError(region.settings(), "[region]", "the extract does not say after which change file it was made",
                         "Set first_sequence to the number of the first one to apply");
}

Plan plan_of(const UpdateOptions& options, const RegionFolder& region, std::optional<int> current,
             const DataState& state) {
  Plan plan;
  for (const std::string& input : options.inputs) {
    if (importers::osm::is_change_file(input)) {
      plan.changes.push_back(input);
    } else if (!plan.extract.empty() || !plan.changes.empty()) {
      throw base::UsageError(input + ": one extract can be given, before all change files (.osc, .osc.gz, .osc.bz2).");
    } else {
      plan.extract = input;
    }
  }
  // The input of region.toml, when it is another file than when it was last taken: change files came since.
  const std::string& input = options.build.input;
  if (plan.extract.empty() && !input.empty() &&
      (!current || (options.inputs.empty() && stamp_of(input) != state.input)))
    plan.extract = input;
  if (!current && plan.extract.empty())
    throw base::UsageError(region.path() + " has no data yet. Begin with an extract: blockrand update " +
                           region.path() + " EXTRACT.osm.pbf");
  plan.sequence = state.sequence;
  if (plan.extract.empty()) plan.time = state.time;
  if (!plan.extract.empty()) {
    // One that does not say where it ends is newer than what is there, or applying again does no harm.
    if (const auto own = importers::osm::replication_sequence(plan.extract)) plan.sequence = own;
    plan.why.push_back("a full extract: " + plan.extract);
  }
  if (options.inputs.empty() && !options.region.replication.empty())
    for (const ReplicationFile& file :
         replication_files(options.region.replication, next_sequence(options.region, plan.sequence, region))) {
      plan.changes.push_back(file.path);
      plan.sequence = file.sequence;
      plan.time = file.time;
    }
  if (!plan.changes.empty())
    plan.why.push_back(plan.changes.size() == 1
                           ? "a change file: " + plan.changes.front()
                           : fmt::format("{} change files, the last one {}", plan.changes.size(), plan.changes.back()));
  return plan;
}

namespace {

/// Above this size of its data a region is built in areas, where its settings say nothing else. Bytes: about 100,000 buildings, which
/// take 400 MB of memory at once.
constexpr std::uint64_t kLargeRegion = 10'000'000;

}  // namespace

int areas_for(const UpdateOptions& options, const std::string& data, std::optional<int> current,
              const DataState& before) {
  constexpr int kAtOnce = 1;  // half of the globe as one area
  if (options.build.areas > 0) return options.build.areas == kAtOnce ? 0 : options.build.areas;
  if (current) return before.areas;
  std::error_code error;
  const bool large = fs::file_size(data, error) > kLargeRegion && !error;
  const bool as_a_whole = options.build.outputs.single_glb || options.build.outputs.single_cityjson ||
                          !options.build.imagery.images.empty() || options.build.bbox;
  return large && !as_a_whole ? kUsualAreas : 0;
}

BuildOptions build_options_for(const UpdateOptions& options, const RegionFolder& region, int number,
                               std::optional<int> current, const DataState& before, int areas) {
  BuildOptions build = options.build;
  build.surroundings = build.surroundings.settled(build.lod);
  build.name = region.name();
  build.input = region.data(number);
  build.output = region.build(number);
  build.force = false;
  build.cache = region.cache();
  build.settings = settings_sha256(options);
  build.areas = areas;
  if (current) build.earlier = region.build(*current);
  // The first build chose; what comes in later must not choose anew.
  if (build.crs.empty() && current && before.crs_chosen) {
    const Json record = read_json(region.build(*current) + "/build.json");
    if (record.contains("crs")) build.crs = text_in(record["crs"], "code");
  }
  return build;
}

std::optional<importers::osm::ClipPolygon> polygon_of(const RegionOptions& options) {
  const std::string& path = options.polygon;
  if (path.empty()) return std::nullopt;
  if (path.ends_with(".poly")) return importers::osm::read_poly_file(path);
  std::vector<importers::osm::ClipPolygon::Rings> polygons;
  for (importers::polygons::PolygonFeature& feature : importers::polygons::read_polygons(path))
    std::ranges::move(feature.polygons, std::back_inserter(polygons));
  return importers::osm::ClipPolygon(polygons);
}

}  // namespace blockrand::run
