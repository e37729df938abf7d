#include "pipeline/cli/command.h"

#include <algorithm>

#include "pipeline/cli/build_command.h"
#include "pipeline/cli/cache_command.h"
#include "pipeline/cli/compare_command.h"
#include "pipeline/cli/districts_command.h"
#include "pipeline/cli/explain_command.h"
#include "pipeline/cli/grammar_command.h"
#include "pipeline/cli/help.h"
#include "pipeline/cli/info_command.h"
#include "pipeline/cli/publish_command.h"
#include "pipeline/cli/region_commands.h"
#include "pipeline/cli/schedule_command.h"
#include "pipeline/cli/validate_command.h"
#include "pipeline/cli/view_command.h"

namespace blockrand::cli {

const std::vector<Command>& commands() {
  static const std::vector<Command> all = {
      {build_text(), run_build},     {view_text(), run_view},         {update_text(), run_update},
      {status_text(), run_status},   {rollback_text(), run_rollback}, {region_text(), run_region},
      {publish_text(), run_publish}, {schedule_text(), run_schedule}, {cache_text(), run_cache},
      {explain_text(), run_explain}, {compare_text(), run_compare},   {districts_text(), run_districts},
      {grammar_text(), run_grammar}, {validate_text(), run_validate}, {info_text(), run_info},
      {help_text(), run_help},
  };
  return all;
}

const Command* find_command(const std::string& name) {
  const auto found = std::ranges::find(commands(), name, [](const Command& c) { return c.text.name; });
  return found == commands().end() ? nullptr : &*found;
}

const std::vector<settings::CommandText>& command_texts() {
  static const std::vector<settings::CommandText> all = [] {
    std::vector<settings::CommandText> texts;
    for (const Command& command : commands()) texts.push_back(command.text);
    return texts;
  }();
  return all;
}

}  // namespace blockrand::cli
