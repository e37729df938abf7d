#include "pipeline/run/region_metrics.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <set>

#include "pipeline/base/text.h"
#include "pipeline/model/issue_codes.h"
#include "pipeline/run/metrics_text.h"
#include "pipeline/run/region_state.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

double number_in(const Json& j, std::string_view key) {
  const auto found = j.is_object() ? j.find(key) : j.end();
  return j.is_object() && found != j.end() && found->is_number() ? found->get<double>() : 0;
}
const Json& member(const Json& j, std::string_view key) {
  static const Json nothing;
  const auto found = j.is_object() ? j.find(key) : j.end();
  return j.is_object() && found != j.end() ? *found : nothing;
}

/// Each number of an object is a sample, under its name.
void samples_of(MetricsText& out, const Json& object, const char* label) {
  if (!object.is_object()) return;
  for (const auto& [name, value] : object.items())
    if (value.is_number()) out.sample(value.get<double>(), {{label, name}});
}

constexpr int kFinest = 3;  // LoD

/// What kind of statement a code of build.json makes; empty for one that this program does not know.
std::string_view class_of(std::string_view code) {
  for (const model::IssueInfo& info : model::kIssueInfo) {
    if (info.text != code) continue;
    switch (info.issue_class) {
      case model::IssueClass::reported:
        return "reported";
      case model::IssueClass::fallback:
        return "fallback";
      case model::IssueClass::notice:
        return "notice";
    }
  }
  return "";
}

/// Objects that were built with less detail than asked. \param record  build.json
double simpler_in(const Json& record) {
  const int asked = static_cast<int>(number_in(member(record, "configuration"), "lod"));
  double simpler = 0;
  for (int lod = 0; lod < asked; ++lod)
    simpler += number_in(member(record, "counts"), fmt::format("models_lod{}", lod));
  return simpler;
}

void add_build(MetricsText& out, const Json& record) {
  const Json& counts = member(record, "counts");
  if (!counts.is_object()) return;
  out.gauge("blockrand_buildings", "Buildings and building parts of the data that a build was made from.");
  out.sample(number_in(counts, "buildings_in") + number_in(counts, "parts_in"));
  out.gauge("blockrand_models", "Those with a model, by its level of detail.");
  for (int lod = 0; lod <= kFinest; ++lod)
    out.sample(number_in(counts, fmt::format("models_lod{}", lod)), {{"lod", std::to_string(lod)}});
  out.gauge("blockrand_models_simpler", "Models with less detail than region.toml asks for.");
  out.sample(simpler_in(record));
  out.gauge("blockrand_models_missing", "Buildings and parts that have no model: report.json says why.");
  out.sample(number_in(counts, "reported"));
  out.gauge("blockrand_reports", "Rows of report.json by code (docs/reading_the_results.md).");
  if (const Json& issues = member(record, "issues"); issues.is_object())
    for (const auto& [code, count] : issues.items())
      if (count.is_number()) out.sample(count.get<double>(), {{"class", std::string(class_of(code))}, {"code", code}});
}

/// \param j  run.json, or a line of log/runs.jsonl
void add_work(MetricsText& out, const Json& j, const Json& stages) {
  out.gauge("blockrand_last_run_duration_seconds", "Wall time of the last run.");
  out.sample(number_in(j, "seconds"));
  out.gauge("blockrand_last_run_stage_duration_seconds", "Wall time of the last run by stage.");
  samples_of(out, stages, "stage");
  out.gauge("blockrand_last_run_peak_memory_bytes", "Most memory that a process of the last run had at a time.");
  out.sample(number_in(j, "peak_rss_bytes"));
  const Json& tiles = member(j, "tiles");
  out.gauge("blockrand_last_run_tiles", "Tiles of the last run: worked on, or taken from earlier runs.");
  out.sample(number_in(tiles, "built"), {{"work", "built"}});
  out.sample(number_in(tiles, "kept"), {{"work", "kept"}});
  out.gauge("blockrand_last_run_tiles_built_for",
            "Tiles that the last run worked on, by what differed; a tile may count for several reasons.");
  samples_of(out, member(tiles, "built_for"), "reason");
  out.gauge("blockrand_last_run_slow_tile_seconds",
            "Time of one thread for the slowest tiles of those that the last run worked on, at most ten.");
  for (const Json& tile : member(j, "slowest_tiles"))
    out.sample(number_in(tile, "thread_seconds"), {{"tile", text_in(tile, "tile")}});
}

/// Bytes on the disk below a folder. Files with several names count once. \param seen  files that count elsewhere
double disk_bytes_below(const std::string& folder, std::set<std::pair<dev_t, ino_t>>& seen) {
  constexpr double kBlock = 512;  // stat(2)
  double bytes = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error), end;
       !error && at != end; at.increment(error)) {
    struct stat file {};
    if (::lstat(at->path().c_str(), &file) != 0) continue;
    if (file.st_nlink > 1 && !S_ISDIR(file.st_mode) && !seen.emplace(file.st_dev, file.st_ino).second) continue;
    bytes += kBlock * static_cast<double>(file.st_blocks);
  }
  return bytes;
}

void add_disk(MetricsText& out, const RegionFolder& region) {
  out.gauge(
      "blockrand_disk_usage_bytes",
      "Bytes on the disk by folder of the region. Files of cache/ that a build has as well count as that build's.");
  std::set<std::pair<dev_t, ino_t>> seen;
  for (const char* part : {"builds", "cache", "store", "log"})
    out.sample(disk_bytes_below(region.path() + "/" + part, seen), {{"folder", part}});
  std::error_code error;
  const fs::space_info space = fs::space(region.path(), error);
  if (error) return;
  out.gauge("blockrand_disk_free_bytes", "Bytes that are free on the disk of the region.");
  out.sample(static_cast<double>(space.available));
}

constexpr std::array kStates = {"published", "unchanged", "refused", "failed"};

/// What log/runs.jsonl tells of all runs.
struct RunsSoFar {
  std::map<std::string, double> count;  ///< by state
  double success = std::numeric_limits<double>::quiet_NaN();
};
RunsSoFar runs_of(const RegionFolder& region) {
  RunsSoFar runs;
  std::ifstream file(region.path() + "/log/runs.jsonl", std::ios::binary);
  for (std::string line; std::getline(file, line);) {
    const Json j = Json::parse(line, nullptr, false);
    if (!j.is_object()) continue;
    const std::string state = text_in(j, "state");
    ++runs.count[state];
    if (state == "published" || state == "unchanged") runs.success = seconds_of(text_in(j, "ended"));
  }
  return runs;
}

/// Of the run that published the build, where the log was cleared.
double published_at(const RegionFolder& region, int number) {
  struct stat file {};
  return ::stat(region.state(number).c_str(), &file) == 0 ? static_cast<double>(file.st_mtime)
                                                          : std::numeric_limits<double>::quiet_NaN();
}

std::optional<int> current_of(const RegionFolder& region) {
  try {
    return region.current();
  } catch (const std::exception&) {  // a damaged pointer: the run itself tells that
    return std::nullopt;
  }
}

void add_runs(MetricsText& out, const RegionFolder& region, const Json& last) {
  const RunsSoFar runs = runs_of(region);
  const std::string state = text_in(last, "state");
  out.gauge("blockrand_last_run_state", "How the last run ended: 1 for that state, 0 for the others.");
  for (const char* one : kStates) out.sample(state == one ? 1 : 0, {{"state", one}});
  out.gauge("blockrand_last_run_timestamp_seconds", "When the last run ended.");
  out.sample(seconds_of(text_in(last, "ended")));
  out.counter("blockrand_runs_total", "Runs in log/runs.jsonl by how they ended; clearing the log begins anew.");
  for (const char* one : kStates) out.sample(runs.count.contains(one) ? runs.count.at(one) : 0, {{"state", one}});
  const std::optional<int> current = current_of(region);
  const double success = std::isnan(runs.success) && current ? published_at(region, *current) : runs.success;
  if (std::isnan(success)) return;
  out.gauge("blockrand_last_success_timestamp_seconds", "When a run last published a build, or found it up to date.");
  out.sample(success);
}

/// Codes of a class, the most frequent first.
std::vector<std::pair<std::uint64_t, std::string>> counted(const Json& issues, std::string_view klass) {
  std::vector<std::pair<std::uint64_t, std::string>> codes;
  if (!issues.is_object()) return codes;
  for (const auto& [code, count] : issues.items())
    if (count.is_number_unsigned() && class_of(code) == klass) codes.emplace_back(count.get<std::uint64_t>(), code);
  std::ranges::stable_sort(codes, [](const auto& a, const auto& b) { return a.first > b.first; });
  return codes;
}

std::string words_of_seconds(double seconds) { return fmt::format("{:10.2f} s", seconds); }

}  // namespace

double seconds_of(const std::string& time) {
  std::tm utc{};
  const char* const end = ::strptime(time.c_str(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return end != nullptr && *end == '\0' ? static_cast<double>(::timegm(&utc))
                                        : std::numeric_limits<double>::quiet_NaN();
}

std::string data_time_of(const RegionFolder& region) {
  const std::optional<int> current = current_of(region);
  if (!current) return "";
  const std::string newest = text_in(read_json(region.build(*current) + "/build.json"), "data_time");
  const std::string applied = DataState::read(region.state(*current)).time;
  return seconds_of(applied) > seconds_of(newest) || std::isnan(seconds_of(newest)) ? applied : newest;
}

std::string too_old(const RegionFolder& region, const RegionOptions& options, double now) {
  if (options.max_age_hours <= 0) return "";
  const std::optional<int> current = current_of(region);
  if (!current)
    return "no build is published, and data may be max_age_hours = " + base::shortest(options.max_age_hours) + " old";
  const std::string time = data_time_of(region);
  constexpr double kHour = 3600;
  const double hours = (now - seconds_of(time)) / kHour;
  if (std::isnan(hours))
    return fmt::format(
        "nobody knows how old the data of build {} are: their objects have no times; max_age_hours is {}", *current,
        base::shortest(options.max_age_hours));
  if (hours <= options.max_age_hours) return "";
  return fmt::format("the data of build {} are {:.1f} hours old ({}); max_age_hours is {}", *current, hours, time,
                     base::shortest(options.max_age_hours));
}

std::string build_metrics(const std::string& folder, const std::string& name) {
  const Json record = read_json(folder + "/build.json"), run = read_json(folder + "/run.json");
  MetricsText out(MetricsText::Labels{{"region", name}});
  out.gauge("blockrand_build_info", "1; the program that ran last, by its version.");
  out.sample(1, {{"version", text_in(member(record, "program"), "version")}});
  add_work(out, run, member(run, "timings"));
  if (const double time = seconds_of(text_in(record, "data_time")); !std::isnan(time)) {
    out.gauge("blockrand_data_timestamp_seconds", "Newest time of the data of the build.");
    out.sample(time);
  }
  add_build(out, record);
  return out.text();
}

std::string region_metrics(const RegionFolder& region, const RegionOptions& options, const std::string& version,
                           const Json& last) {
  MetricsText out(MetricsText::Labels{{"region", region.name()}});
  out.gauge("blockrand_build_info", "1; the program that ran last, by its version.");
  out.sample(1, {{"version", version}});
  add_runs(out, region, last);
  add_work(out, last, member(last, "stages"));
  if (const std::optional<int> current = current_of(region)) {
    out.gauge("blockrand_published_build", "Number of the published build.");
    out.sample(*current);
    if (const double time = seconds_of(data_time_of(region)); !std::isnan(time)) {
      out.gauge("blockrand_data_timestamp_seconds", "Newest time of the data of the build.");
      out.sample(time);
    }
    add_build(out, read_json(region.build(*current) + "/build.json"));
  }
  if (options.max_age_hours > 0) {
    constexpr double kHour = 3600;
    out.gauge("blockrand_data_max_age_seconds", "How old data may be: max_age_hours of region.toml.");
    out.sample(options.max_age_hours * kHour);
  }
  add_disk(out, region);
  return out.text();
}

std::string run_report(const RegionFolder& region, const std::string& build, const Json& run) {
  std::string out = fmt::format("{}, run {}: {}, {} s\n", region.name(), static_cast<int>(number_in(run, "run")),
                                text_in(run, "state"), base::shortest(number_in(run, "seconds")));
  const Json& tiles = member(run, "tiles");
  out += fmt::format("{} tiles were built, {} are those of earlier runs; peak memory {}\n",
                     base::with_thousands(static_cast<std::uint64_t>(number_in(tiles, "built"))),
                     base::with_thousands(static_cast<std::uint64_t>(number_in(tiles, "kept"))),
                     base::with_byte_unit(static_cast<std::uint64_t>(number_in(run, "peak_rss_bytes"))));
  out += "\nWhere the time went\n";
  if (const Json& stages = member(run, "stages"); stages.is_object())
    for (const auto& [stage, seconds] : stages.items())
      out += fmt::format("{}  {}\n", words_of_seconds(seconds.get<double>()), stage);
  out += "\nThe slowest tiles (time of one thread)\n";
  for (const Json& tile : member(run, "slowest_tiles"))
    out += fmt::format("{}  {}  {} buildings\n", words_of_seconds(number_in(tile, "thread_seconds")),
                       text_in(tile, "tile"),
                       base::with_thousands(static_cast<std::uint64_t>(number_in(tile, "buildings"))));
  const Json record = read_json(build + "/build.json");
  out += fmt::format("\nModels that are simpler than asked: {}; without a model: {}\n",
                     base::with_thousands(static_cast<std::uint64_t>(simpler_in(record))),
                     base::with_thousands(static_cast<std::uint64_t>(number_in(member(record, "counts"), "reported"))));
  for (const auto& [klass, title] : {std::pair{"fallback", "Fallbacks of the whole build, the most frequent first"},
                                     {"reported", "Why buildings have no model"},
                                     {"notice", "Other notices"}}) {
    const auto codes = counted(member(record, "issues"), klass);
    if (codes.empty()) continue;
    out += fmt::format("\n{}\n", title);
    for (const auto& [count, code] : codes) out += fmt::format("{:>12}  {}\n", base::with_thousands(count), code);
  }
  return out;
}

}  // namespace blockrand::run
