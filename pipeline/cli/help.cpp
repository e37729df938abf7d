#include "pipeline/cli/help.h"

#include <fmt/format.h>

#include <cstdio>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"
#include "pipeline/base/version.h"
#include "pipeline/cli/build.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/info.h"
#include "pipeline/model/issue_codes.h"
#include "pipeline/settings/config_file.h"
#include "pipeline/settings/reference.h"

namespace blockrand::cli {
namespace {

std::string codes_text() {
  std::string text;
  for (const auto& [issue_class, title] : {std::pair{model::IssueClass::reported, "Not modelled, because"},
                                           std::pair{model::IssueClass::fallback, "Simpler than asked"},
                                           std::pair{model::IssueClass::notice, "Notices"}}) {
    text += fmt::format("{}{}\n", text.empty() ? "" : "\n", title);
    for (const model::IssueInfo& info : model::kIssueInfo)
      if (info.issue_class == issue_class && info.text != "NONE")
        text += fmt::format("  {:<24}{}\n", info.text, info.meaning);
  }
  return text;
}

std::string help_help() {
  return "Usage: blockrand help [COMMAND | options [--markdown | --toml] | codes]\n"
         "\n"
         "  COMMAND              the same as blockrand COMMAND --help\n"
         "  options              the reference of all options\n"
         "  options --toml       a config file with every option and its default\n"
         "  codes                the reasons that reports give, and what they mean\n"
         "\n"
         "Examples:\n"
         "  blockrand help build\n"
         "  blockrand help options --toml > town.toml\n";
}

}  // namespace

std::vector<std::string> command_names() { return {"build", "info", "help"}; }

std::string version_text() {
  return fmt::format("blockrand {}\nLicence GPL-3.0-or-later. Map data: OpenStreetMap contributors, ODbL.\n",
                     base::kVersion);
}

std::string general_help() {
  return "Usage: blockrand COMMAND [arguments]\n"
         "\n"
         "Rebuilds a real neighbourhood in 3D from an OpenStreetMap extract.\n"
         "\n"
         "Commands:\n"
         "  build    an extract in; georeferenced 3D Tiles and CityGML out\n"
         "  info     what is in an extract, and what a build of it would take\n"
         "  help     help on a command, all options, all report codes\n"
         "\n"
         "  blockrand COMMAND --help   options and examples of a command\n"
         "  blockrand --version        version and licence\n"
         "\n"
         "Examples:\n"
         "  blockrand info leipzig.osm.pbf\n"
         "  blockrand build leipzig.osm.pbf -o out/leipzig\n"
         "\n"
         "Exit codes: 0 all well, 1 wrong usage, 2 unreadable or invalid input, 3 buildings below the asked\n"
         "quality (only with --strict), 4 output could not be written or internal error, 128 + signal.\n";
}

int run_help(const std::vector<std::string>& arguments) {
  const std::string topic = arguments.empty() ? "" : arguments[0];
  const std::string form = arguments.size() > 1 ? arguments[1] : "";
  if (arguments.size() > 2 || (!form.empty() && topic != "options"))
    throw base::UsageError("unexpected argument " + arguments.back() + ".");
  std::string text;
  if (topic.empty()) {
    text = general_help();
  } else if (topic == "build") {
    text = build_help();
  } else if (topic == "info") {
    text = info_help();
  } else if (topic == "help" || topic == "--help" || topic == "-h") {
    text = help_help();
  } else if (topic == "codes") {
    text = codes_text();
  } else if (topic == "options") {
    if (form.empty() || form == "--markdown")
      text = settings::options_markdown();
    else if (form == "--toml")
      text = settings::config_template();
    else
      throw base::UsageError("unknown form " + form + ". Known: --markdown, --toml.");
  } else {
    const std::string near = base::nearest(topic, {"build", "info", "help", "options", "codes"});
    throw base::UsageError("no help on " + topic + "." + (near.empty() ? "" : " Did you mean " + near + "?"));
  }
  std::fputs(text.c_str(), stdout);
  return kSuccess;
}

}  // namespace blockrand::cli
