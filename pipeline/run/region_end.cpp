#include "pipeline/run/region_end.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>

#include "pipeline/base/error.h"
#include "pipeline/base/text.h"
#include "pipeline/run/changes_map.h"
#include "pipeline/run/estimate.h"
#include "pipeline/run/region_metrics.h"
#include "pipeline/run/region_state.h"

namespace blockrand::run {
namespace {

using Json = nlohmann::ordered_json;

double tenths(double value) { return std::round(value * 10) / 10; }
double thousandths(double value) { return std::round(value * 1000) / 1000; }

std::string problem_file(const RegionFolder& region) { return region.path() + "/log/last_problem.env"; }

/// KEY="text" as sh and systemd read it.
std::string assignment(std::string_view key, std::string_view text) {
  std::string out = std::string(key) + "=\"";
  for (const char c : text) {
    if (c == '"' || c == '\\' || c == '$' || c == '`') out += '\\';
    out += c;
  }
  return out + "\"\n";
}

}  // namespace

Json run_line(const UpdateSummary& s, const base::Progress& progress) {
  constexpr const char* kStates[] = {"published", "unchanged", "refused", "planned", "shared"};
  Json j = {{"run", s.number},
            {"ended", now_utc()},
            {"state", kStates[static_cast<int>(s.state)]},
            {"seconds", tenths(s.seconds)}};
  j["why"] = s.why;
  if (s.sequence) j["sequence"] = *s.sequence;
  if (s.tiles_built + s.tiles_kept > 0)
    j["tiles"] = {{"built", s.tiles_built}, {"kept", s.tiles_kept}, {"built_for", s.tiles_built_for}};
  if (s.areas > 0) j["areas"] = {{"all", s.areas}, {"taken_over", s.areas_kept}};
  j["osm_objects"] = {{"created", s.created}, {"modified", s.modified}, {"deleted", s.deleted}, {"outside", s.outside}};
  j["buildings"] = {{"before", s.changes.before},
                    {"after", s.changes.after},
                    {"added", s.changes.added.size()},
                    {"removed", s.changes.removed.size()}};
  for (const Gate& g : s.gates)
    if (g.exceeded()) j["refused_by"].push_back(g.key);
  std::map<std::string, double> stages;
  for (const base::Progress::PhaseTime& t : progress.times()) stages[t.name] += t.seconds;
  j["stages"] = Json::object();
  for (const base::Progress::PhaseTime& t : progress.times()) j["stages"][t.name] = thousandths(stages[t.name]);
  j["peak_rss_bytes"] = std::max(s.peak_rss_bytes, peak_memory());
  j["slowest_tiles"] = slowest_tiles_json(s.slowest_tiles);
  return j;
}

std::string refusal(const std::vector<Gate>& gates) {
  std::string out;
  for (const Gate& g : gates) {
    if (!g.exceeded()) continue;
    out += out.empty() ? "" : "; ";
    out += g.key.starts_with("max_")
               ? fmt::format("{}: {:.2f} %, {} is {}", g.words, g.value, g.key, base::shortest(g.limit))
               : fmt::format("{} ({})", g.words, g.key);
  }
  return one_line(out);
}

void begin_run(const RegionFolder& region) {
  std::error_code error;
  std::filesystem::remove(problem_file(region), error);
}

std::string end_run(const UpdateOptions& options, const RegionFolder& region, RunEnd end, const Json& line,
                    base::Progress& progress) {
  call_hook("hook", options.region.hook, region.path(), end, progress);
  std::string stale;
  try {
    stale = too_old(region, options.region, static_cast<double>(std::time(nullptr)));
    if (end.reason.empty() && !stale.empty()) end.state = "stale", end.reason = stale;
    if (!end.reason.empty())
      write_whole(problem_file(region),
                  assignment("BLOCKRAND_STATE", end.state) + assignment("BLOCKRAND_REASON", end.reason));
    write_whole(region.path() + "/log/metrics.prom", region_metrics(region, options.region, options.version, line));
  } catch (const std::exception& error) {
    progress.warn(fmt::format("figures of the run are not written: {}", error.what()));
  }
  if (!end.reason.empty()) call_hook("notify command", options.region.notify, region.path(), end, progress);
  return stale;
}

void write_changes(const RegionFolder& region, int number, const UpdateSummary& summary) {
  write_whole(region.changes(number) + ".json", changes_json(summary.changes, summary.gates));
  write_changes_layers(summary.changes, region.changes(number) + ".gpkg.part");
  if (std::rename((region.changes(number) + ".gpkg.part").c_str(), (region.changes(number) + ".gpkg").c_str()) != 0)
    throw base::OutputError(region.changes(number) + ".gpkg: cannot be written: " + std::strerror(errno));
  write_whole(region.changes(number) + ".html",
              changes_page(region.name() + ", run " + std::to_string(number), summary.changes, summary.gates));
}

}  // namespace blockrand::run
