#include "pipeline/run/shared_areas.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "pipeline/base/error.h"
#include "pipeline/base/host.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/sha256.h"
#include "pipeline/run/area_overview.h"
#include "pipeline/run/earlier_area.h"
#include "pipeline/run/region_folder.h"

namespace blockrand::run {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using model::TileId;

namespace {

/// What a mark says.
struct HandedIn {
  std::string key;            ///< AreaParts::key: program, settings, name and data
  std::string record_sha256;  ///< of the area's build.json
  AreaOutcome outcome;
};

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw base::OutputError(path + ": cannot be made: " + error.message());
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Says that a process works on the areas; gone when it ends, unless it is killed.
class Started {
 public:
  explicit Started(const SharedAreas& shared) : path_(shared.folder() + "/started/" + base::process_name()) {
    make_folder(shared.folder() + "/started");
    write_whole(path_, "");
  }
  ~Started() {
    std::error_code error;
    fs::remove(path_, error);
  }
  Started(const Started&) = delete;
  Started& operator=(const Started&) = delete;

 private:
  std::string path_;
};

/// CPU seconds of areas, from what they took in earlier nights.
class AreaCosts {
 public:
  explicit AreaCosts(const AreaParts& parts) : parts_(parts) {
    double seconds = 0, objects = 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (const std::optional<double> known = measured(i))
        seconds += std::max(0.0, *known - read_seconds(i)), objects += static_cast<double>(parts.objects(i));
    if (objects > 0) per_object_ = seconds / objects;
  }

  double of(std::size_t i) const {
    const std::optional<double> known = measured(i);
    const double whole = known ? *known : read_seconds(i) + per_object_ * static_cast<double>(parts_.objects(i));
    if (!parts_.in_part(i)) return whole;
    const Json run = parts_.earlier_run(i);
    const Json tiles = run.is_object() ? run.value("tiles", Json::object()) : Json::object();
    const auto count = [&](const char* key) {
      return tiles.contains(key) && tiles[key].is_number() ? tiles[key].get<double>() : 0.0;
    };
    const double all = std::max(1.0, count("built") + count("kept"));
    return whole * std::clamp(static_cast<double>(parts_.looked_into(i)) / all, kLeastPart, 1.0);
  }

 private:
  /// A window is read whatever few tiles are built (own choice).
  static constexpr double kLeastPart = 0.1;
  /// Where nothing was measured, CPU seconds of a byte stored around an area and of a mapped object in it: Dortmund in areas of level 13,
  /// LoD3 (own measure, 2026).
  static constexpr double kPerStoredByte = 4e-7, kPerObject = 5e-3;

  std::optional<double> measured(std::size_t i) const {
    const Json run = parts_.earlier_run(i);
    if (!run.is_object() || !run.contains(kWholeCpuSeconds) || !run[kWholeCpuSeconds].is_number()) return std::nullopt;
    return run[kWholeCpuSeconds].get<double>();
  }
  double read_seconds(std::size_t i) const { return kPerStoredByte * static_cast<double>(parts_.stored(i)); }

  const AreaParts& parts_;
  double per_object_ = kPerObject;
};

}  // namespace

std::string SharedAreas::place(const TileId& area) const { return folder_ + "/" + area_path(area); }

std::string SharedAreas::parts() const { return folder_ + "/parts/" + base::process_name(); }

std::string SharedAreas::mark(const TileId& area) const {
  return fmt::format("{}/done/{}-{}-{}", folder_, area.level, area.x, area.y);
}

bool SharedAreas::is_done(const TileId& area, const std::string& key) const {
  try {
    return base::unpacked<HandedIn>(bytes_of(mark(area))).key == key;
  } catch (const base::UnpackError&) {
    return false;
  }
}

std::optional<AreaOutcome> SharedAreas::outcome(const TileId& area, const std::string& key) const {
  if (!is_done(area, key)) return std::nullopt;
  auto told = base::unpacked<HandedIn>(bytes_of(mark(area)));
  if (is_whole(area, told.record_sha256)) return std::move(told.outcome);
  std::error_code error;
  fs::remove(mark(area), error);
  throw base::InputError(place(area), "", "is damaged", "Run the shard again that has it: it builds this area alone");
}

bool SharedAreas::is_whole(const TileId& area, const std::string& record_sha256) const {
  try {
    std::vector<std::string> paths;
    return area_is_whole(place(area), record_sha256, paths);
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

void SharedAreas::hand_in(const TileId& area, const std::string& key, AreaOutcome outcome) const {
  const std::string from = outcome.folder, to = place(area), record = base::sha256_file(from + "/build.json");
  std::error_code error;
  make_folder(fs::path(to).parent_path().string());
  make_folder(folder_ + "/done");
  make_folder(parts());  // a folder that was staged takes its empty parents along
  sync_disk(from);
  // A folder is renamed onto nothing, or onto an empty one: what another process handed in is never taken away while it is read.
  fs::rename(from, to, error);
  if (error && fs::exists(to)) {
    if (is_whole(area, record)) {  // it was faster
      fs::remove_all(from, error);
    } else {  // of other data, or what a disk that lost power left
      fs::rename(to, parts() + "/replaced-" + std::to_string(area.x) + "-" + std::to_string(area.y), error);
      fs::rename(from, to, error);
      if (error) throw base::OutputError(to + ": cannot be written: " + error.message());
    }
  } else if (error) {
    throw base::OutputError(to + ": cannot be written: " + error.message());
  }
  outcome.folder = to;
  const std::string written = parts() + "/mark";
  write_whole(written, base::packed(HandedIn{key, record, std::move(outcome)}));
  fs::rename(written, mark(area), error);
  if (error) throw base::OutputError(mark(area) + ": cannot be written: " + error.message());
}

std::vector<std::string> SharedAreas::unended() const {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder_ + "/started", error), end; !error && entry != end; entry.increment(error))
    names.push_back(entry->path().filename().string());
  std::ranges::sort(names);
  return names;
}

void balance(std::vector<PlannedArea>& areas, int shards) {
  std::vector<PlannedArea*> longest;
  for (PlannedArea& area : areas) longest.push_back(&area);
  std::ranges::stable_sort(longest, std::ranges::greater(), &PlannedArea::cpu_seconds);
  std::vector<double> sums(static_cast<std::size_t>(shards));
  for (PlannedArea* area : longest) {
    const auto least = std::ranges::min_element(sums);
    *least += area->cpu_seconds;
    area->shard = static_cast<int>(least - sums.begin()) + 1;
  }
}

std::vector<PlannedArea> plan_areas(const BuildOptions& options, const SharedAreas& shared, int shards,
                                    base::Progress& progress) {
  refuse_contradictions_of_areas(options);
  check_inputs_of_areas(options, progress);
  AreaParts parts(options, shared.work(), progress);
  parts.make();
  parts.save();
  const AreaCosts costs(parts);
  std::vector<PlannedArea> areas;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (!parts.earlier_files(i))
      areas.push_back({parts.id(i), parts.objects(i), parts.in_part(i), parts.key(i), costs.of(i)});
  balance(areas, shards);
  return areas;
}

SharedWork work_on_areas(const BuildOptions& options, const SharedAreas& shared, const std::set<TileId>& areas,
                         base::Progress& progress) {
  SharedWork work;
  const Started started(shared);
  AreaParts parts(options, shared.work(), progress);
  parts.open(WorkCache::Mode::look);
  std::vector<std::size_t> todo;
  std::uint64_t objects = 0, done = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!areas.contains(parts.id(i))) continue;
    if (shared.is_done(parts.id(i), parts.key(i))) {
      ++work.were_done;
      continue;
    }
    todo.push_back(i);
    objects += parts.objects(i);
  }
  progress.begin("areas", objects, "buildings");
  AreaRunner runner(options, parts, progress);
  runner.run(
      todo, [&](const TileId& area) { return shared.parts() + "/" + area_path(area); },
      [&](std::size_t i, AreaOutcome outcome) {
        ++work.built, work.cpu_seconds += outcome.cpu_seconds;
        shared.hand_in(parts.id(i), parts.key(i), std::move(outcome));
        done += parts.objects(i);
        progress.advance_to(done);
      });
  std::error_code error;
  fs::remove_all(shared.parts(), error);
  return work;
}

void link_tree(const std::string& from, const std::string& to) {
  make_folder(to);
  std::error_code error;
  const auto check = [&](const std::string& path) {
    if (error) throw base::OutputError(path + ": cannot be written: " + error.message());
  };
  for (fs::recursive_directory_iterator entry(from, error), end; !error && entry != end; entry.increment(error)) {
    const std::string at = to + entry->path().string().substr(from.size());
    if (entry->is_directory()) {
      make_folder(at);
    } else if (::link(entry->path().c_str(), at.c_str()) != 0) {  // another disk, too many links
      fs::copy_file(entry->path(), at, error);
      check(at);
    }
  }
  check(to);
}

}  // namespace blockrand::run
