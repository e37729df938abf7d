#include "pipeline/cli/region_commands.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "pipeline/base/error.h"
#include "pipeline/base/progress.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/text.h"
#include "pipeline/base/version.h"
#include "pipeline/cli/configs_folder.h"
#include "pipeline/cli/errors.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/publish_command.h"
#include "pipeline/cli/region_owner.h"
#include "pipeline/cli/signals.h"
#include "pipeline/compare/compare.h"
#include "pipeline/compare/comparison_report.h"
#include "pipeline/outward/postgis.h"
#include "pipeline/outward/publish.h"
#include "pipeline/run/region_folder.h"
#include "pipeline/run/region_hook.h"
#include "pipeline/run/update_region.h"
#include "pipeline/settings/command_line.h"
#include "pipeline/settings/config_file.h"

namespace blockrand::cli {
namespace {

/// Options of a region: those of its region.toml, and the arguments, which are stronger.
/// \param sha256  becomes that of region.toml
settings::CommandLine region_line(settings::Commands command, const std::vector<std::string>& arguments,
                                  std::string& sha256) {
  settings::CommandLine line = settings::read_command_line(command, arguments);
  if (line.help) return line;
  const run::RegionFolder region(line.settings.region);
  std::error_code error;
  // Data that are cut one night and not the next would be built whole again.
  const auto refuse_polygon = [&](const settings::CommandLine& given, const std::string& in_file) {
    if (given.settings.region_options.polygon != in_file)
      throw base::UsageError(fmt::format("--polygon holds for all nights: write polygon = \"{}\" below [region] in {}",
                                         given.settings.region_options.polygon, region.settings()));
  };
  if (!std::filesystem::exists(region.settings(), error)) {
    refuse_polygon(line, "");
    return line;
  }
  settings::Settings file;
  sha256 = base::sha256_file(region.settings());
  settings::read_config(region.settings(), file, settings::kBuild | settings::kUpdate | settings::kPublish);
  outward::refuse_password_in(region.settings(), file.publishing.postgis);
  const auto refuse = [&](const char* key, const char* remedy) {
    throw base::InputError(region.settings(), std::string("[build] ") + key, "has no place in a region", remedy);
  };
  if (!file.build.output.empty()) refuse("output", "Take it out: builds lie in the region's folder builds/");
  if (!file.build.outputs.explain) refuse("explain", "Take it out: builds of a region are compared by explanations");
  const run::BuildOptions fresh;
  const char* const by_gates = "Take it out: [gates] say when a build is not published";
  if (file.build.strict) refuse("strict", by_gates);
  if (file.build.allow_empty) refuse("allow_empty", by_gates);
  if (file.build.allow_shrink != fresh.allow_shrink) refuse("allow_shrink", by_gates);
  const std::string polygon = file.region_options.polygon;
  settings::CommandLine whole = settings::read_command_line(command, arguments, std::move(file));
  refuse_polygon(whole, polygon);
  return whole;
}

std::string seconds_text(double seconds) {
  if (seconds < 90) return fmt::format("{:.1f} s", seconds);
  return seconds < 5400 ? fmt::format("{:.0f} min", seconds / 60) : fmt::format("{:.1f} h", seconds / 3600);
}

/// ". What differed: mapped in 3, surroundings in 12"
std::string reasons(const std::map<std::string, std::uint64_t>& counts) {
  std::string out;
  for (const auto& [what, count] : counts)
    out += fmt::format("{}{} in {}", out.empty() ? ". What differed: " : ", ", what, base::with_thousands(count));
  return out;
}

std::string update_report(const run::UpdateOptions& options, const run::UpdateSummary& s) {
  std::string out;
  for (const std::string& why : s.why) out += "  " + why + "\n";
  if (s.created + s.modified + s.deleted + s.known + s.outside > 0)
    out += fmt::format(
        "  {} OSM objects new, {} changed, {} deleted, {} known already{}\n", base::with_thousands(s.created),
        base::with_thousands(s.modified), base::with_thousands(s.deleted), base::with_thousands(s.known),
        s.outside > 0 ? fmt::format(", {} outside of the polygon", base::with_thousands(s.outside)) : "");
  const run::BuildChanges& c = s.changes;
  const auto gates = [&] {
    for (const run::Gate& g : s.gates)
      if (g.exceeded() && g.key.starts_with("max_"))
        out += fmt::format("  refused: {}: {:.2f} %, {} in region.toml is {:g}\n", g.words, g.value, g.key, g.limit);
      else if (g.exceeded())
        out += fmt::format("  refused: {} ({})\n", g.words, g.key);
  };
  switch (s.state) {
    case run::UpdateState::shared:
      out +=
          fmt::format("run {} is planned: {} areas are to be built\n", s.number, base::with_thousands(s.planned_areas));
      break;
    case run::UpdateState::unchanged:
      out += s.before ? fmt::format("nothing to build: build {} is up to date\n", s.number) : "nothing to build\n";
      break;
    case run::UpdateState::planned:
      out += fmt::format("run {} would build {}", s.number, options.folder);
      if (s.tiles_built + s.tiles_kept > 0)
        out += fmt::format(": {} tiles, and take {} from earlier runs{}", base::with_thousands(s.tiles_built),
                           base::with_thousands(s.tiles_kept), reasons(s.tiles_built_for));
      out += s.expected_seconds > 0 ? "\nit should take about " + seconds_text(s.expected_seconds) + "\n" : "\n";
      break;
    case run::UpdateState::published:
      out +=
          fmt::format("build {} is published, {}: {} buildings; {} new, {} gone; {} footprints and {} values differ\n",
                      s.number, seconds_text(s.seconds), base::with_thousands(c.after),
                      base::with_thousands(c.added.size()), base::with_thousands(c.removed.size()),
                      base::with_thousands(c.outlines.size()), base::with_thousands(c.attributes.size()));
      if (s.tiles_built + s.tiles_kept > 0)
        out +=
            fmt::format("  {} tiles were built, {} are those of earlier runs{}\n", base::with_thousands(s.tiles_built),
                        base::with_thousands(s.tiles_kept), reasons(s.tiles_built_for));
      if (s.areas > 0)
        out += fmt::format("  {} of {} areas were worked on\n", base::with_thousands(s.areas - s.areas_kept),
                           base::with_thousands(s.areas));
      if (s.linked > 0)
        out += fmt::format("  {} files ({}) are those of build {}: one on disk\n", base::with_thousands(s.linked),
                           base::with_byte_unit(s.linked_bytes), s.before.value_or(0));
      out += "  " + options.folder + "/current        what is published\n";
      out += fmt::format("  {}/log/{}.changes.html   what differs, and why\n", options.folder,
                         run::RegionFolder::digits(s.number));
      out += fmt::format("  {}/log/{}.report.txt     where the time went, what came out simpler\n", options.folder,
                         run::RegionFolder::digits(s.number));
      break;
    case run::UpdateState::refused:
      out += fmt::format("build {} is not published{}\n", s.number,
                         s.before ? fmt::format("; build {} stays", *s.before) : std::string());
      gates();
      out += "  " + s.folder + "   the build, to look at\n";
      out +=
          fmt::format("  {}/log/{}.changes.html   what differs\n", options.folder, run::RegionFolder::digits(s.number));
      break;
  }
  return out;
}

std::string update_json(const run::UpdateSummary& s) {
  constexpr const char* kStates[] = {"published", "unchanged", "refused", "planned", "shared"};
  nlohmann::ordered_json j = {{"state", kStates[static_cast<int>(s.state)]}, {"run", s.number}, {"folder", s.folder}};
  j["why"] = s.why;
  j["osm_objects"] = {{"created", s.created}, {"modified", s.modified}, {"deleted", s.deleted}, {"known", s.known}};
  j["buildings"] = {{"before", s.changes.before},
                    {"after", s.changes.after},
                    {"added", s.changes.added.size()},
                    {"removed", s.changes.removed.size()}};
  j["tiles"] = {{"built", s.tiles_built}, {"kept", s.tiles_kept}, {"built_for", s.tiles_built_for}};
  j["gates"] = nlohmann::ordered_json::array();
  for (const run::Gate& g : s.gates)
    j["gates"].push_back({{"gate", g.key}, {"value", g.value}, {"limit", g.limit}, {"exceeded", g.exceeded()}});
  j["expected_seconds"] = s.expected_seconds, j["seconds"] = s.seconds;
  return j.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

settings::CommandText update_text() {
  return {
      .name = "update",
      .summary = "new data into a region; a build is published when gates let it",
      .usage = "REGION [DATA ...] [options]",
      .description =
          "Brings a region up to date: an extract or change files in, a new build beside the published one, a report "
          "of "
          "what differs, and the switch. REGION/current leads to the published build at any moment; a run that fails, "
          "is killed, or is refused by a limit of region.toml leaves it as it was; so does one that finds another run "
          "at work (exit code 1).\n"
          "The first update with an extract makes the region, with a region.toml to edit. Without DATA, what "
          "region.toml "
          "names is taken: the change files of a replication folder that are new, or its input.",
      .options = settings::kUpdate,
      .examples = {{"blockrand update leipzig leipzig.osm.pbf", "makes the region, or takes a newer extract"},
                   {"blockrand update leipzig monday.osc.gz tuesday.osc.gz", "applies change files"},
                   {"blockrand update leipzig", "every night, by cron or a timer"},
                   {"blockrand update leipzig --dry-run", "what would be done"}},
      .exit_codes = {{"0", "all well"},
                     {"1", "wrong usage"},
                     {"2", "unreadable or invalid input"},
                     {"3", "all well, but the published data are older than max_age_hours"},
                     {"4", "output could not be written or internal error"},
                     {"5", "built, but refused by a gate of the region"},
                     {"6", "built and published here, but not where [publish] sends it: to do"},
                     {"128 + N", "ended by signal N"}}};
}

namespace {

/// As `blockrand compare` does it, without a report.
run::ReferenceVerdict compare_with_reference(const settings::Settings& s, const std::string& build,
                                             const std::string& baseline, base::Progress& progress) {
  compare::CompareOptions options = s.comparison;
  options.model = build;
  options.reference = {s.region_options.reference};
  options.jobs = s.build.jobs;
  options.surface.seed = s.build.seed;
  const compare::Comparison comparison = compare::compare_models(options, progress);
  run::ReferenceVerdict verdict;
  verdict.json = compare::comparison_json(comparison, {});
  if (baseline.empty()) return verdict;
  const compare::BaselineResult against = compare::compare_with_baseline(
      comparison, baseline, "the published build's comparison", s.region_options.max_worse / 100, {});
  for (const auto& line : against.lines)
    if (line.fails) verdict.worse.push_back(line.measure);
  for (const std::string& measure : against.lost) verdict.worse.push_back(measure + " (lost)");
  for (const std::string& id : against.lost_buildings) verdict.worse.push_back("building " + id + " (lost)");
  return verdict;
}

run::UpdateOptions update_options(const settings::Settings& s, std::string sha256, base::Progress& progress) {
  warn_of_root(s.region, progress);
  run::UpdateOptions options;
  options.folder = run::RegionFolder(s.region).path();
  options.inputs = s.data;
  options.build = s.build;
  options.build.configs = configs_folder(s.build.configs, program_file());
  options.build.outputs.imagery = !s.build.imagery.images.empty();
  options.region = s.region_options;
  options.dry_run = s.dry_run, options.break_lock = s.break_lock;
  options.version = base::kVersion;
  options.settings_sha256 = std::move(sha256);
  options.compare_with_reference = [&s, &progress](const std::string& build, const std::string& baseline) {
    return compare_with_reference(s, build, baseline, progress);
  };
  return options;
}

/// The first run makes the region, with a region.toml to edit.
void make_region(run::UpdateOptions& options, const settings::Settings& s) {
  const run::RegionFolder region(options.folder);
  std::error_code error;
  if (!std::filesystem::exists(region.settings(), error) && !s.dry_run) {
    if (s.data.empty())
      throw base::UsageError(options.folder + " is no region yet. Begin with an extract: blockrand update " +
                             options.folder + " EXTRACT.osm.pbf");
    std::filesystem::create_directories(options.folder, error);
    run::write_whole(region.settings(),
                     settings::config_template(settings::kBuild | settings::kUpdate | settings::kPublish));
    options.settings_sha256 = base::sha256_file(region.settings());
  }
}

int ended(const run::UpdateOptions& options, const run::UpdateSummary& summary, const settings::Settings& s,
          base::Progress& progress) {
  if (s.log_format == base::LogFormat::json)
    std::fputs(update_json(summary).c_str(), stdout);
  else if (!s.quiet || summary.state == run::UpdateState::refused)
    std::fputs(update_report(options, summary).c_str(), stdout);
  if (!summary.too_old.empty()) progress.warn(summary.too_old);
  if (summary.state == run::UpdateState::refused) return kRefused;
  if (s.dry_run || summary.state == run::UpdateState::shared) return kSuccess;
  std::fflush(stdout);
  if (!publish_after_update(s, progress)) return kNotOutward;
  return summary.too_old.empty() ? kSuccess : kTooOld;
}

/// \param line  of `update`, or of `region repair` with its extract
int update(settings::CommandLine& line, std::string sha256) {
  settings::Settings& s = line.settings;
  clean_up_on_signals(s.log_format);
  base::Progress progress(s.progress, s.log_format, s.quiet);
  run::UpdateOptions options = update_options(s, std::move(sha256), progress);
  make_region(options, s);
  const run::UpdateSummary summary = run::update_region(options, progress);
  progress.end();
  return ended(options, summary, s, progress);
}

}  // namespace

/// A region.toml that cannot be read is a night that failed as well: what the command line says of it is all that is known.
settings::CommandLine line_or_notice(settings::Commands command, const std::vector<std::string>& arguments,
                                     std::string& sha256) {
  try {
    return region_line(command, arguments, sha256);
  } catch (const std::exception& error) {
    settings::CommandLine line;
    try {
      line = settings::read_command_line(command, arguments);
    } catch (const std::exception&) {  // told below, as the first one
    }
    base::Progress progress(base::ProgressStyle::none, line.settings.log_format);
    if (!line.help && !line.settings.dry_run)
      run::call_hook("notify command", line.settings.region_options.notify, line.settings.region,
                     {"failed", 0, run::one_line(error.what())}, progress);
    throw;
  }
}

int run_update(const std::vector<std::string>& arguments) {
  std::string sha256;
  settings::CommandLine line = line_or_notice(settings::kUpdate, arguments, sha256);
  if (line.help) {
    std::fputs(settings::command_help(update_text()).c_str(), stdout);
    return kSuccess;
  }
  return update(line, std::move(sha256));
}

settings::CommandText region_text() {
  return {.name = "region",
          .summary = "repairs a region; shares a night's work among processes and hosts",
          .usage = "STEP REGION [DATA ...] [options]",
          .description =
              "repair: reads the kept work and removes what is damaged, then the data of the published build. Where "
              "those are damaged they are made anew from the extract given, or from the input of region.toml, and "
              "built. What is published stays until the new build is.\n"
              "plan, work, finish: what update does, in three steps, for regions that are built in areas. plan takes "
              "new data in and gives each area that is to be built to one of N shards, balanced by what it took in "
              "earlier nights. work builds those of one shard: any number at once, on any host that sees the folder; "
              "one that was killed is run again. finish gates and publishes. The result is that of update, byte by "
              "byte. drop gives a plan up.",
          .options = settings::kRegion,
          .examples = {{"blockrand region repair leipzig leipzig.osm.pbf", ""},
                       {"blockrand region plan saxony --shards 8", "as update would begin"},
                       {"blockrand region work saxony --shard 3/8", "eight of them, anywhere"},
                       {"blockrand region finish saxony", "when all are done"}},
          .exit_codes = {{"0", "all well"},
                         {"1", "wrong usage"},
                         {"2", "unreadable or invalid input"},
                         {"4", "output could not be written or internal error"},
                         {"5", "built, but refused by a gate of the region"},
                         {"6", "built and published here, but not where [publish] sends it: to do"}}};
}

namespace {

int repair(settings::CommandLine& line, std::string sha256) {
  settings::Settings& s = line.settings;
  base::Progress progress(s.progress, s.log_format, s.quiet);
  const run::RegionHealth health = run::check_region(s.region, s.break_lock, progress);
  progress.end();
  if (!s.quiet) std::fputs(health.words.c_str(), stdout);
  if (health.published && health.data_whole) {
    if (!s.data.empty() && !s.quiet) std::fputs("the extract is not needed: blockrand update takes it in\n", stdout);
    return kSuccess;
  }
  if (s.data.empty() && !s.build.input.empty()) s.data = {s.build.input};
  if (s.data.empty())
    throw base::InputError(s.region + "/store", "",
                           health.published ? "the data of the published build are damaged" : "there are no data yet",
                           "Give a full extract: blockrand region repair " + s.region + " EXTRACT.osm.pbf");
  return update(line, std::move(sha256));
}

/// What each shard is to do, and how long that should take.
std::string plan_report(const run::RegionShards& plan, const std::string& region) {
  std::string out;
  for (int shard = 1; shard <= plan.shards; ++shard) {
    std::uint64_t areas = 0, buildings = 0;
    double seconds = 0;
    for (const run::PlannedArea& area : plan.areas)
      if (area.shard == shard) ++areas, buildings += area.objects, seconds += area.cpu_seconds;
    out += fmt::format("  shard {}/{}: {} areas, {} buildings, about {} of one processor\n", shard, plan.shards, areas,
                       base::with_thousands(buildings), seconds_text(seconds));
  }
  out += fmt::format("work on each: blockrand region work {} --shard I/{}; then: blockrand region finish {}\n", region,
                     plan.shards, region);
  return out;
}

/// Where a plan that had nothing to build leaves word for `work` and `finish` of the same night.
std::string nothing_mark(const run::RegionFolder& region) { return region.path() + "/log/nothing_to_build"; }

int plan(settings::Settings& s, run::UpdateOptions& options, base::Progress& progress) {
  make_region(options, s);
  const run::RegionFolder region(options.folder);
  std::error_code error;
  std::filesystem::remove(nothing_mark(region), error);
  const run::UpdateSummary summary = run::plan_region(options, s.shards, progress);
  progress.end();
  if (summary.state == run::UpdateState::unchanged) run::write_whole(nothing_mark(region), "\n");
  const int code = ended(options, summary, s, progress);
  if (summary.state == run::UpdateState::shared && !s.quiet && s.log_format != base::LogFormat::json)
    std::fputs(plan_report(run::RegionShards::read(run::RegionFolder(options.folder)), options.folder).c_str(), stdout);
  return code;
}

std::string told_as_json(const nlohmann::ordered_json& j) {
  return j.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// Whether the last plan of a region had nothing to build. Said, and no error.
bool has_nothing_to_do(const settings::Settings& s) {
  const run::RegionFolder region(s.region);
  std::error_code error;
  if (!std::filesystem::exists(nothing_mark(region), error) || run::plan_status(region)) return false;
  if (s.log_format == base::LogFormat::json)
    std::fputs(told_as_json({{"state", "nothing"}}).c_str(), stdout);
  else if (!s.quiet)
    std::fputs(fmt::format("nothing to do: the last plan of {} had nothing to build\n", s.region).c_str(), stdout);
  return true;
}

int work(const settings::Settings& s, const run::UpdateOptions& options, base::Progress& progress) {
  const run::SharedWork done = run::work_on_region(options, run::parse_shard(s.shard), progress);
  progress.end();
  if (s.log_format == base::LogFormat::json)
    std::fputs(told_as_json({{"shard", s.shard},
                             {"areas", {{"built", done.built}, {"were_done", done.were_done}}},
                             {"cpu_seconds", done.cpu_seconds}})
                   .c_str(),
               stdout);
  else if (!s.quiet)
    std::fputs(fmt::format("shard {}: {} areas were built, {} were done already; {} of one processor\n", s.shard,
                           done.built, done.were_done, seconds_text(done.cpu_seconds))
                   .c_str(),
               stdout);
  return kSuccess;
}

/// Options and data that an action does not read are told.
void refuse_unread(const settings::Settings& s) {
  const bool plans = s.region_work == "plan", takes_data = plans || s.region_work == "repair";
  const auto refuse = [&](const std::string& what) {
    throw base::UsageError(fmt::format("region {} takes no {}.", s.region_work, what));
  };
  if (!plans && s.shards != 1) refuse("--shards");
  if (s.region_work != "work" && !s.shard.empty()) refuse("--shard");
  if (s.region_work == "work" && s.break_lock) refuse("--break-lock: it holds no lock");
  if (!takes_data && !s.data.empty()) refuse("data: region plan takes them in");
}

}  // namespace

int run_region(const std::vector<std::string>& arguments) {
  std::string sha256;
  settings::CommandLine line = line_or_notice(settings::kRegion, arguments, sha256);
  if (line.help) {
    std::fputs(settings::command_help(region_text()).c_str(), stdout);
    return kSuccess;
  }
  settings::Settings& s = line.settings;
  refuse_unread(s);
  if (s.region_work == "repair") return repair(line, std::move(sha256));
  clean_up_on_signals(s.log_format);
  base::Progress progress(s.progress, s.log_format, s.quiet);
  if (s.region_work == "drop") {
    const int number = run::drop_region_plan(s.region, s.break_lock, progress);
    progress.end();
    if (s.log_format == base::LogFormat::json)
      std::fputs(told_as_json({{"state", "dropped"}, {"run", number}}).c_str(), stdout);
    else if (!s.quiet)
      std::fputs(fmt::format("the plan of run {} is given up\n", number).c_str(), stdout);
    return kSuccess;
  }
  run::UpdateOptions options = update_options(s, std::move(sha256), progress);
  if (s.region_work == "plan") return plan(s, options, progress);
  if (s.region_work == "work" && s.shard.empty())
    throw base::UsageError("region work needs --shard I/N: one of those that the plan has");
  if (s.region_work == "work") run::parse_shard(s.shard);
  if (has_nothing_to_do(s)) return kSuccess;
  if (s.region_work == "work") return work(s, options, progress);
  const run::UpdateSummary summary = run::finish_region(options, progress);
  progress.end();
  return ended(options, summary, s, progress);
}

settings::CommandText status_text() {
  return {.name = "status",
          .summary = "which build of a region is published, and what the next run will do",
          .usage = "REGION [options]",
          .description =
              "Tells the published build of a region, how old its data are, which builds are kept, how the "
              "last run ended, and which change files wait. Nothing is changed.",
          .options = settings::kStatus,
          .examples = {{"blockrand status leipzig", ""},
                       {"blockrand status leipzig --max-age 30", "one more line and exit code 3 where they are older"},
                       {"blockrand status leipzig --json | jq .data_time", ""}},
          .exit_codes = {{"0", "all well"},
                         {"1", "wrong usage"},
                         {"2", "unreadable or invalid input"},
                         {"3", "the published data are older than --max-age"}}};
}

namespace {

/// "run 3, failed, 2026-11-26T03:00:00Z, 5.8 s: why"
std::string last_run_words(const std::string& line) {
  const auto j = nlohmann::ordered_json::parse(line, nullptr, false);
  if (!j.is_object()) return line;
  const auto text = [&](const char* key) {
    return j.contains(key) && j[key].is_string() ? j[key].get<std::string>() : std::string();
  };
  std::string out = fmt::format("run {}, {}, {}", j.value("run", 0), text("state"), text("ended"));
  if (j.contains("seconds") && j["seconds"].is_number()) out += ", " + seconds_text(j["seconds"].get<double>());
  if (!text("error").empty()) out += ": " + run::one_line(text("error"));
  if (j.contains("refused_by") && j["refused_by"].is_array()) {
    std::string keys;
    for (const auto& key : j["refused_by"])
      if (key.is_string()) keys += (keys.empty() ? "" : ", ") + key.get<std::string>();
    out += ": refused by " + keys;
  }
  return out;
}

}  // namespace

int run_status(const std::vector<std::string>& arguments) {
  std::string sha256;
  const settings::CommandLine line = region_line(settings::kStatus, arguments, sha256);
  if (line.help) {
    std::fputs(settings::command_help(status_text()).c_str(), stdout);
    return kSuccess;
  }
  const settings::Settings& s = line.settings;
  const run::RegionStatus status = run::region_status(s.region, s.region_options);
  if (s.json) {
    nlohmann::ordered_json j;
    j["current"] = status.current ? nlohmann::ordered_json(*status.current) : nlohmann::ordered_json();
    j["published"] = status.published;
    j["data_time"] = status.data_time;
    j["sequence"] = status.sequence ? nlohmann::ordered_json(*status.sequence) : nlohmann::ordered_json();
    j["models"] = status.models, j["build_seconds"] = status.seconds;
    j["last_run"] = nlohmann::ordered_json::parse(status.last_run, nullptr, false);
    if (j["last_run"].is_discarded()) j["last_run"] = nullptr;
    j["plan"] = status.plan ? nlohmann::ordered_json({{"run", status.plan->number},
                                                      {"shards", status.plan->shards},
                                                      {"areas", status.plan->areas},
                                                      {"done", status.plan->done}})
                            : nlohmann::ordered_json();
    j["outward_to_do"] = outward::outward_to_do(s.region, status.current);
    j["waiting"] = status.waiting, j["waiting_problem"] = status.waiting_problem;
    j["too_old"] = status.too_old;
    std::fputs((j.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n").c_str(), stdout);
    return status.too_old.empty() ? kSuccess : kTooOld;
  }
  std::string out;
  if (!status.current) {
    out += "no build is published\n";
  } else {
    out += fmt::format(
        "build {} is published: {} models, data of {}{}; it took {}\n", *status.current,
        base::with_thousands(status.models), status.data_time.empty() ? "unknown time" : status.data_time,
        status.sequence ? fmt::format(", sequence {}", *status.sequence) : std::string(), seconds_text(status.seconds));
    std::string kept;
    for (const int number : status.published) kept += (kept.empty() ? "" : ", ") + std::to_string(number);
    out += "builds that are kept: " + kept + "\n";
  }
  if (status.plan)
    out += fmt::format("run {} is under way in {} shards: {} of {} areas are done\n", status.plan->number,
                       status.plan->shards, status.plan->done, status.plan->areas);
  for (const std::string& line : outward::outward_to_do(s.region, status.current)) out += line + "\n";
  if (!status.last_run.empty()) out += "last run: " + last_run_words(status.last_run) + "\n";
  if (!status.waiting_problem.empty())
    out += "the next run will fail: " + status.waiting_problem + "\n";
  else if (!s.region_options.replication.empty())
    out += fmt::format("change files that wait: {}\n", status.waiting.size());
  if (!status.too_old.empty()) out += "too old: " + status.too_old + "\n";
  std::fputs(out.c_str(), stdout);
  return status.too_old.empty() ? kSuccess : kTooOld;
}

settings::CommandText rollback_text() {
  return {
      .name = "rollback",
      .summary = "publishes an earlier build of a region again",
      .usage = "REGION [--to N] [options]",
      .description =
          "Points REGION/current to an earlier build, in one step. The next update goes on from that "
          "build's data.",
      .options = settings::kRollback,
      .examples = {{"blockrand rollback leipzig", "to the build before"}, {"blockrand rollback leipzig --to 12", ""}},
      .exit_codes = {{"0", "all well"}, {"1", "wrong usage"}, {"4", "output could not be written or internal error"}}};
}

int run_rollback(const std::vector<std::string>& arguments) {
  const settings::CommandLine line = settings::read_command_line(settings::kRollback, arguments);
  if (line.help) {
    std::fputs(settings::command_help(rollback_text()).c_str(), stdout);
    return kSuccess;
  }
  const settings::Settings& s = line.settings;
  base::Progress progress(s.progress, s.log_format, s.quiet);
  const int number =
      run::roll_back(s.region, s.to < 0 ? std::nullopt : std::optional(static_cast<int>(s.to)), s.break_lock, progress);
  if (!s.quiet) std::fputs(fmt::format("build {} is published\n", number).c_str(), stdout);
  return kSuccess;
}

}  // namespace blockrand::cli
