#include "pipeline/cli/publish_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "pipeline/base/error.h"
#include "pipeline/base/text.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/signals.h"
#include "pipeline/outward/postgis.h"
#include "pipeline/outward/publish.h"
#include "pipeline/settings/command_line.h"
#include "pipeline/settings/config_file.h"

namespace blockrand::cli {
namespace {

/// Of a region: what its region.toml says, and the arguments, which are stronger.
settings::CommandLine publish_line(const std::vector<std::string>& arguments) {
  settings::CommandLine line = settings::read_command_line(settings::kPublish, arguments);
  if (line.help) return line;
  const std::string file = line.settings.source + "/region.toml";
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return line;
  settings::Settings of_region;
  settings::read_config(file, of_region, settings::kBuild | settings::kUpdate | settings::kPublish);
  outward::refuse_password_in(file, of_region.publishing.postgis);
  return settings::read_command_line(settings::kPublish, arguments, std::move(of_region));
}

std::string part_text(const outward::PublishedPart& part) {
  std::string out = part.what + " " + part.place + ": ";
  if (!part.failure.empty()) return out + "to do\n";
  std::string figures;
  for (const auto& [what, count] : part.figures)
    figures += (figures.empty() ? "" : ", ") +
               (what == "bytes" ? base::with_byte_unit(count) : base::with_thousands(count) + " " + what);
  return out + (figures.empty() ? "nothing is looked at in a dry run" : figures) + "\n";
}

std::string report_json(const outward::PublishSource& source, const outward::PublishReport& report) {
  nlohmann::ordered_json j = {{"build", source.build}};
  if (source.number) j["number"] = *source.number;
  j["parts"] = nlohmann::ordered_json::array();
  for (const outward::PublishedPart& part : report.parts) {
    nlohmann::ordered_json entry = {{"what", part.what}, {"place", part.place}};
    for (const auto& [what, count] : part.figures) entry["figures"][what] = count;
    if (!part.failure.empty()) entry["failure"] = part.failure;
    j["parts"].push_back(std::move(entry));
  }
  return j.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

settings::CommandText publish_text() {
  return {
      .name = "publish",
      .summary = "sends a build to buckets, web roots, archives and databases",
      .usage = "SOURCE [--command C] [--web-root DIR] [--archive FILE] [--postgis PG:...]",
      .description =
          "Sends what differs from what was sent last, in an order in which no reader is led to a missing file: "
          "contents, "
          "tiles, tilesets from the leaves up to tileset.json, build.json; what the build does not name any more goes "
          "last, "
          "after --keep-deleted hours. A transfer that breaks off is taken up by the next call.\n"
          "Of a region the published build is sent, and what stands below [publish] in its region.toml holds; "
          "`blockrand update` then does the same after each published build.",
      .options = settings::kPublish,
      .examples = {{"blockrand publish leipzig --web-root /srv/www/leipzig", "a web root on this machine"},
                   {"blockrand publish leipzig --command 'sh to_bucket.sh'", "docs/publishing.md has such commands"},
                   {"blockrand publish leipzig --postgis PG:dbname=city", "tables of a PostGIS database"},
                   {"blockrand publish out --archive leipzig.3tz", "the tiles in one file"}},
      .exit_codes = {{"0", "all well"},
                     {"1", "wrong usage"},
                     {"2", "unreadable or invalid input"},
                     {"4", "output could not be written or internal error"},
                     {"128 + N", "ended by signal N"}}};
}

int run_publish(const std::vector<std::string>& arguments) {
  const settings::CommandLine line = publish_line(arguments);
  if (line.help) {
    std::fputs(settings::command_help(publish_text()).c_str(), stdout);
    return kSuccess;
  }
  const settings::Settings& s = line.settings;
  clean_up_on_signals(s.log_format);
  base::Progress progress(s.progress, s.log_format, s.quiet);
  const outward::PublishSource source = outward::publish_source(s.source);
  if (!s.publishing.any())
    throw base::UsageError(
        "nowhere to send to. Add --command, --web-root, --archive or --postgis, or name one below [publish] in "
        "region.toml.");
  const outward::PublishReport report = outward::publish(s.publishing, source, s.dry_run, progress);
  progress.end();
  if (s.log_format == base::LogFormat::json) {
    std::fputs(report_json(source, report).c_str(), stdout);
  } else if (!s.quiet) {
    std::string out = source.number ? fmt::format("build {} of {}\n", *source.number, source.name) : std::string();
    for (const outward::PublishedPart& part : report.parts) out += "  " + part_text(part);
    std::fputs(out.c_str(), stdout);
  }
  std::fflush(stdout);
  // The first is told as the command's error; others would be lost.
  bool first = true;
  for (const outward::PublishedPart& part : report.parts) {
    if (part.failure.empty()) continue;
    if (!first) progress.warn(part.what + ": " + part.failure);
    first = false;
  }
  if (report.first_failure) std::rethrow_exception(report.first_failure);
  return kSuccess;
}

bool publish_after_update(const settings::Settings& settings, base::Progress& progress) {
  if (!settings.publishing.any()) return true;
  const auto to_do = [&](const std::string& why) {
    progress.warn(fmt::format("not published outward: {}. To do: blockrand publish {}", why, settings.region));
  };
  try {
    const outward::PublishReport report =
        outward::publish(settings.publishing, outward::publish_source(settings.region), false, progress, true);
    progress.end();
    std::string out;
    for (const outward::PublishedPart& part : report.parts) {
      if (!part.failure.empty()) to_do(part.what + ": " + part.failure);
      out += "  published outward: " + part_text(part);
    }
    if (!settings.quiet && settings.log_format == base::LogFormat::text) std::fputs(out.c_str(), stdout);
    return !report.first_failure;
  } catch (const std::exception& error) {
    to_do(error.what());
    return false;
  }
}

}  // namespace blockrand::cli
