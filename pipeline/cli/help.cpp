#include "pipeline/cli/help.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"
#include "pipeline/base/version.h"
#include "pipeline/cli/command.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/model/issue_codes.h"
#include "pipeline/outputs/output.h"
#include "pipeline/settings/completion.h"
#include "pipeline/settings/config_file.h"
#include "pipeline/settings/manual.h"
#include "pipeline/settings/reference.h"

namespace blockrand::cli {
namespace {

/// What one code means; empty where there is none of that name.
std::string code_text(const std::string& code) {
  for (const model::IssueInfo& info : model::kIssueInfo)
    if (info.text == code && code != "NONE") return fmt::format("{}: {}\n", info.text, info.meaning);
  return {};
}

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

/// What stands in a build's folder, for the manual.
std::vector<std::pair<std::string, std::string>> output_rows() {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const outputs::OutputFormat& format : outputs::all_outputs())
    rows.insert(rows.end(), format.manual.begin(), format.manual.end());
  rows.emplace_back("model.glb, model.city.json",
                    "the whole build in one file, with --single-glb and --single-cityjson");
  rows.emplace_back(
      "build.json",
      "inputs and hashes, configuration, coordinate system, counts, hashes of all files: the same bytes each time");
  rows.emplace_back("run.json", "time, memory and threads of this run");
  return rows;
}

/// What the program reads by itself, for the manual.
const std::vector<std::pair<std::string, std::string>> kFiles = {
    {"../share/blockrand/configs",
     "from the program's folder: defaults and materials, where --configs names no others; "
     "in a build tree the source tree's configs"},
};

std::string manual_text() {
  return settings::manual(
      {.version = std::string(base::kVersion),
       .summary = "rebuild a real neighbourhood in 3D from an OpenStreetMap extract",
       .description =
           "Blockrand reads an OpenStreetMap extract and writes every building in it as a closed, georeferenced solid, "
           "with a roof: as 3D Tiles for globes and browsers, as CityGML, CityJSON and GeoPackage for GIS. What the "
           "map "
           "does not say is inferred from other tags, from tagged neighbours, from the shape of the plan and from the "
           "building's use, and every value says where it came from.\n"
           "Each building of the extract ends in exactly one state: modelled, represented by its parts or by the "
           "object it "
           "duplicates, or reported with a coded reason; 'blockrand help codes' lists the reasons. The same input "
           "gives "
           "the same bytes, whatever the number of threads.",
       .outputs = output_rows(),
       .files = kFiles},
      command_texts());
}

}  // namespace

settings::CommandText help_text() {
  return {
      .name = "help",
      .summary = "help on a command, all options, all report codes",
      .usage = "[COMMAND | TOPIC]",
      .description = "Prints help on a command or a topic; without either, the list of commands.",
      .topics = {{"options",
                  "the reference of all options; --toml: a config file with all of them and their defaults",
                  {"--markdown", "--toml"}},
                 {"codes", "the reasons that reports give, and what they mean; help CODE: one of them"},
                 {"man", "this program's manual page; to read it: blockrand help man | man -l -"},
                 {"completion", "a script that completes commands and options in a shell",
                  settings::completion_shells(), true}},
      .takes_command = true,
      .examples = {{"blockrand help build", ""},
                   {"blockrand help options --toml > town.toml", "a config file to start from"},
                   {"source <(blockrand help completion bash)", "completion in the bash that runs now"}},
      .exit_codes = {{"0", "all well"}, {"1", "wrong usage"}, {"4", "output could not be written or internal error"}}};
}

std::string version_text() {
  return fmt::format("blockrand {}\nLicence GPL-3.0-or-later. Map data: OpenStreetMap contributors, ODbL.\n",
                     base::kVersion);
}

std::string general_help() {
  std::string text =
      "Usage: blockrand COMMAND [arguments]\n"
      "\n"
      "Rebuilds a real neighbourhood in 3D from an OpenStreetMap extract.\n"
      "\n"
      "Commands:\n";
  for (const settings::CommandText& command : command_texts())
    text += fmt::format("  {:<10}{}\n", command.name, command.summary);
  return text +
         "\n"
         "  blockrand COMMAND --help   options and examples of a command\n"
         "  blockrand help TOPIC       options, codes, man, completion\n"
         "  blockrand --version        version and licence\n"
         "\n"
         "Examples:\n"
         "  blockrand info leipzig.osm.pbf\n"
         "  blockrand build leipzig.osm.pbf -o out/leipzig\n"
         "\n" +
         settings::exit_code_help(settings::merged_exit_codes(command_texts()));
}

int run_help(const std::vector<std::string>& arguments) {
  std::string topic = arguments.empty() ? "" : arguments[0];
  const std::string form = arguments.size() > 1 ? arguments[1] : "";
  if (topic == "--help" || topic == "-h") topic = "help";
  const settings::CommandText self = help_text();
  const auto entry = std::ranges::find(self.topics, topic, &settings::Topic::name);
  const std::vector<std::string> forms = entry == self.topics.end() ? std::vector<std::string>{} : entry->forms;
  if (arguments.size() > 2 || (!form.empty() && forms.empty()))
    throw base::UsageError("unexpected argument " + arguments.back() + ".");
  if (!forms.empty() && (form.empty() ? entry->form_needed : std::ranges::find(forms, form) == forms.end())) {
    std::string known;
    for (const std::string& f : forms) known += (known.empty() ? "" : ", ") + f;
    const std::string near = base::nearest(form, forms);
    throw base::UsageError(form.empty() ? fmt::format("help {}: of which? Known: {}.", topic, known)
                                        : fmt::format("help {}: unknown {}.{} Known: {}.", topic, form,
                                                      near.empty() ? "" : " Did you mean " + near + "?", known));
  }
  std::string text;
  if (topic.empty()) {
    text = general_help();
  } else if (const Command* command = find_command(topic)) {
    text = settings::command_help(command->text);
  } else if (topic == "codes") {
    text = codes_text();
  } else if (topic == "options") {
    text = form == "--toml" ? settings::config_template() : settings::options_markdown();
  } else if (topic == "man") {
    text = manual_text();
  } else if (topic == "completion") {
    text = settings::completion(form, command_texts());
  } else if (text = code_text(topic); text.empty()) {
    std::vector<std::string> known;
    for (const model::IssueInfo& info : model::kIssueInfo) known.emplace_back(info.text);
    for (const settings::CommandText& command : command_texts()) known.push_back(command.name);
    for (const settings::Topic& t : self.topics) known.push_back(t.name);
    const std::string near = base::nearest(topic, known);
    throw base::UsageError("no help on " + topic + "." +
                           (near.empty() ? " Topics: the commands, options, codes, man, completion, and each code."
                                         : " Did you mean " + near + "?"));
  }
  std::fputs(text.c_str(), stdout);
  return kSuccess;
}

}  // namespace blockrand::cli
