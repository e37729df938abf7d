#include "pipeline/cli/cache_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "pipeline/base/error.h"
#include "pipeline/base/progress.h"
#include "pipeline/base/text.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/run/work_cache.h"
#include "pipeline/settings/command_line.h"

namespace blockrand::cli {
namespace {

/// A region stands for its cache/.
std::string cache_folder(const std::string& given) {
  std::error_code error;
  const std::string inside = given + "/cache";
  return std::filesystem::exists(given + "/region.toml", error) ? inside : given;
}

std::string report(const run::CacheFigures& f) {
  return fmt::format("{} pieces of work in {} files, {}, of which {} are files of builds as well\nkept by {}\n",
                     base::with_thousands(f.entries), base::with_thousands(f.files), base::with_byte_unit(f.bytes),
                     base::with_byte_unit(f.shared_bytes), f.program.substr(0, f.program.find(' ')));
}

std::string report_json(const run::CacheFigures& f) {
  const nlohmann::ordered_json j = {
      {"entries", f.entries}, {"files", f.files},     {"bytes", f.bytes},    {"shared_bytes", f.shared_bytes},
      {"damaged", f.damaged}, {"removed", f.removed}, {"program", f.program}};
  return j.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

settings::CommandText cache_text() {
  return {
      .name = "cache",
      .summary = "looks at the work that builds keep for later ones, checks it, makes room",
      .usage = "WORK CACHE [--keep-bytes N] [options]",
      .description =
          "stat counts what is kept, and how much of it takes no room of its own, since builds have the same files. "
          "verify reads all of it and removes what is damaged. prune removes what was of use the longest ago, until "
          "the "
          "rest has at most --keep-bytes. Nothing that is removed is lost: the next build works it out anew.",
      .options = settings::kCache,
      .examples = {{"blockrand cache stat leipzig", "of a region"},
                   {"blockrand cache verify leipzig/cache", ""},
                   {"blockrand cache prune leipzig --keep-bytes 20000000000", "at most 20 GB stay"}},
      .exit_codes = {{"0", "all well"},
                     {"1", "wrong usage"},
                     {"2", "unreadable or invalid input"},
                     {"3", "verify: something was damaged, and is removed"},
                     {"4", "output could not be written or internal error"}}};
}

int run_cache(const std::vector<std::string>& arguments) {
  const settings::CommandLine line = settings::read_command_line(settings::kCache, arguments);
  if (line.help) {
    std::fputs(settings::command_help(cache_text()).c_str(), stdout);
    return kSuccess;
  }
  const settings::Settings& s = line.settings;
  base::Progress progress(s.progress, s.log_format, s.quiet);
  const std::string folder = cache_folder(s.cache);
  if (s.cache_work == "prune" && s.keep_bytes < 0)
    throw base::UsageError("prune needs --keep-bytes N: how much may stay. 0 removes all.");
  if (s.cache_work != "prune" && s.keep_bytes >= 0) throw base::UsageError("--keep-bytes is of use with prune only.");
  const run::CacheFigures figures = s.cache_work == "verify" ? run::verify_cache(folder, progress)
                                    : s.cache_work == "prune"
                                        ? run::prune_cache(folder, static_cast<std::uint64_t>(s.keep_bytes), progress)
                                        : run::cache_figures(folder);
  std::string out = s.json ? report_json(figures) : report(figures);
  if (!s.json && s.cache_work != "stat")
    out += fmt::format("{} {}\n", base::with_thousands(figures.removed),
                       s.cache_work == "verify" ? "were damaged, and are removed" : "are removed");
  std::fputs(out.c_str(), stdout);
  return figures.damaged > 0 ? kBelowQuality : kSuccess;
}

}  // namespace blockrand::cli
