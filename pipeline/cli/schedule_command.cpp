#include "pipeline/cli/schedule_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "pipeline/base/error.h"
#include "pipeline/base/version.h"
#include "pipeline/cli/configs_folder.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/region_owner.h"
#include "pipeline/cli/schedule_files.h"
#include "pipeline/cli/schedule_quoting.h"
#include "pipeline/run/region_folder.h"
#include "pipeline/settings/command_line.h"
#include "pipeline/settings/config_file.h"

namespace blockrand::cli {
namespace {

namespace fs = std::filesystem;

/// Links are kept: who names a region by a link wants that.
std::string absolute(const std::string& path) {
  std::string out = fs::absolute(path).lexically_normal().string();
  while (out.size() > 1 && out.ends_with('/')) out.pop_back();
  return out;
}

void read_time(const std::string& text, Schedule& schedule) {
  const auto digit = [&](std::size_t i) { return text[i] >= '0' && text[i] <= '9'; };
  const bool shaped = text.size() == 5 && text[2] == ':' && digit(0) && digit(1) && digit(3) && digit(4);
  if (shaped) schedule.hour = std::stoi(text.substr(0, 2)), schedule.minute = std::stoi(text.substr(3));
  if (!shaped || schedule.hour > 23 || schedule.minute > 59)
    throw base::UsageError("--at " + text + " is no time of day. Write for example --at 02:30.");
}

bool lies_below_tmp(const std::string& path) {
  std::error_code error;
  const std::string whole = fs::weakly_canonical(path, error).string() + "/";
  return whole.starts_with("/tmp/") || whole.starts_with("/var/tmp/");
}

/// All paths that region.toml names.
std::vector<std::string> data_of(const settings::Settings& s) {
  std::vector<std::string> paths = {s.build.input,
                                    s.build.terrain,
                                    s.build.overrides,
                                    s.build.districts,
                                    s.build.configs,
                                    s.region_options.replication,
                                    s.region_options.polygon,
                                    s.region_options.reference};
  for (const auto& image : s.build.imagery.images) paths.push_back(image.path);
  std::erase(paths, "");
  return paths;
}

std::string read_whole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw base::InputError(path, "", "cannot be read", "Look at its rights");
  return text;
}

Schedule schedule_of(const settings::CommandLine& line, const settings::Settings& file) {
  const settings::Settings& s = line.settings;
  const auto given = [&](std::string_view option) { return std::ranges::find(line.given, option) != line.given.end(); };
  Schedule out;
  out.program = program_file().string();
  out.region = absolute(s.region), out.folder = fs::current_path().string();
  out.name = run::RegionFolder(out.region).name();
  out.version = base::kVersion;
  read_time(s.schedule_at, out);
  out.notify = s.region_options.notify, out.notify_given = given("notify");
  if (given("max-age")) out.max_age_hours = s.region_options.max_age_hours;
  out.hook = file.region_options.hook;
  out.user = s.schedule_user.empty() ? owner_of(out.region) : s.schedule_user;
  out.image = s.schedule_image.empty() ? "blockrand:" + out.version : s.schedule_image;
  out.shards = s.shards;
  out.memory_limit = static_cast<std::uint64_t>(std::max<std::int64_t>(0, s.build.memory_limit));
  std::vector<std::string> data = data_of(s);
  out.needs_network = std::ranges::any_of(data, [](const std::string& path) { return path.starts_with("/vsi"); });
  data.insert(data.end(), {out.region, out.folder, out.program});
  const outward::PublishOptions& places = s.publishing;
  for (const std::string& place :
       {places.web_root, places.archive.empty() ? "" : fs::path(absolute(places.archive)).parent_path().string()})
    if (!place.empty()) out.written.push_back(absolute(place));
  data.insert(data.end(), out.written.begin(), out.written.end());
  out.below_tmp = std::ranges::any_of(data, lies_below_tmp);
  for (const std::string& place : out.written) check_text("a folder of [publish]", place);
  out.needs_network = out.needs_network || !places.command.empty() || !places.postgis.empty();
  out.settings = read_whole(out.region + "/region.toml");
  for (const auto& [what, text] :
       std::initializer_list<std::pair<const char*, const std::string&>>{{"the program's path", out.program},
                                                                         {"the region's path", out.region},
                                                                         {"the path of this folder", out.folder},
                                                                         {"--notify", out.notify},
                                                                         {"--user", out.user},
                                                                         {"--image", out.image}})
    check_text(what, text);
  return out;
}

}  // namespace

settings::CommandText schedule_text() {
  return {
      .name = "schedule",
      .summary = "files for systemd, cron, Slurm or Kubernetes that update a region every night",
      .usage = "REGION --print KIND [--at HH:MM] [options]",
      .description =
          "Writes what a scheduler wants to be given, for this program and this region, with absolute paths; hook and "
          "notify "
          "commands are run in the folder that this is called in. Nothing is installed. Where there are several files, "
          "each "
          "begins with a line '# FILE name'; --into writes them into a folder instead.\n"
          "systemd: a service in a sandbox that may write the region alone, and a timer that makes up for missed "
          "nights; with --notify a second service that tells of nights with a problem. slurm and kubernetes: blockrand "
          "region plan, work in --shards pieces at the same time, finish.",
      .options = settings::kSchedule,
      .examples = {{"blockrand schedule leipzig --print systemd --into /etc/systemd/system",
                    "then systemctl enable "
                    "--now "
                    "blockrand-leipzig.timer"},
                   {"blockrand schedule leipzig --print cron --at 03:15 --max-age 30", ""},
                   {"blockrand schedule leipzig --print slurm --shards 16 > night.sh", ""},
                   {"blockrand schedule leipzig --print kubernetes | kubectl apply -f -", ""}},
      .exit_codes = {{"0", "all well"},
                     {"1", "wrong usage"},
                     {"2", "unreadable or invalid input"},
                     {"4", "output could not be written or internal error"}}};
}

int run_schedule(const std::vector<std::string>& arguments) {
  settings::CommandLine line = settings::read_command_line(settings::kSchedule, arguments);
  if (line.help) {
    std::fputs(settings::command_help(schedule_text()).c_str(), stdout);
    return kSuccess;
  }
  const run::RegionFolder region(line.settings.region);
  std::error_code error;
  if (!fs::is_regular_file(region.settings(), error))
    throw base::UsageError(region.path() + " is no region yet. Begin with an extract: blockrand update " +
                           region.path() + " EXTRACT.osm.pbf");
  settings::Settings file;
  settings::read_config(region.settings(), file, settings::kBuild | settings::kUpdate | settings::kPublish);
  const settings::Settings of_file = file;
  line = settings::read_command_line(settings::kSchedule, arguments, std::move(file));
  settings::refuse_unread(line, settings::kSchedule, line.settings.schedule,
                          {{"shards", {"slurm", "kubernetes"}}, {"user", {"systemd"}}, {"image", {"kubernetes"}}});
  const Schedule schedule = schedule_of(line, of_file);
  const std::string& kind = line.settings.schedule;
  for (const std::string& place : schedule.written)
    if (kind == "systemd" && !fs::is_directory(place, error))
      throw base::UsageError(place +
                             ", where [publish] of region.toml writes, is not there: the service could not begin. Make "
                             "the folder first, so that " +
                             schedule.user + " may write there.");
  if (line.settings.build.areas == 0 && (kind == "slurm" || (kind == "kubernetes" && schedule.shards > 1)))
    std::fputs(("blockrand: warning: " + region.path() +
                " is built as a whole, which is one piece of work: no night can be shared. Write "
                "areas = 11 below [build] of region.toml first; `region plan` tells how many areas there are\n")
                   .c_str(),
               stderr);
  const std::vector<ScheduleFile> files = kind == "systemd" ? systemd_files(schedule)
                                          : kind == "cron"  ? cron_files(schedule)
                                          : kind == "slurm" ? slurm_files(schedule)
                                                            : kubernetes_files(schedule);
  for (const ScheduleFile& f : files) {
    if (!line.settings.schedule_into.empty()) {
      run::write_whole(line.settings.schedule_into + "/" + f.name, f.text);
      std::fputs((line.settings.schedule_into + "/" + f.name + "\n").c_str(), stdout);
      continue;
    }
    if (files.size() > 1) std::fputs(("# FILE " + f.name + "\n").c_str(), stdout);
    std::fputs(f.text.c_str(), stdout);
  }
  return kSuccess;
}

}  // namespace blockrand::cli
