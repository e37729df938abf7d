// The options of all commands, collected from the tables beside their structs, and the place for their values.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/option.h"
#include "pipeline/base/progress.h"
#include "pipeline/compare/options.h"
#include "pipeline/outward/options.h"
#include "pipeline/run/options.h"
#include "pipeline/run/region_options.h"
#include "pipeline/validate/options.h"

namespace blockrand::settings {

/// Everything that a user can set.
struct Settings {
  run::BuildOptions build;
  std::string config;  ///< the config file, for the record; its values are in the other fields
  std::string folder;  ///< a finished build, for the commands that read one
  std::string region;  ///< folder of a region, for the commands that are about one
  run::RegionOptions region_options;
  std::string source;                               ///< of `publish`: a region, or a build
  outward::PublishOptions publishing;               ///< where `publish` sends a build, and how
  std::vector<std::string> data;                    ///< of `update`: an extract, change files
  bool dry_run = false;                             ///< `build` and `update` tell what they would do
  bool break_lock = false;                          ///< the lock of another host is taken over
  std::int64_t to = -1;                             ///< build that `rollback` goes to; -1: the one before
  std::string region_work;                          ///< of `region`: repair, plan, work, finish or drop
  int shards = 1;                                   ///< of `region plan` and `schedule`
  std::string shard;                                ///< of `region work`: "2/8"
  std::string cache_work, cache;                    ///< of `cache`: stat, verify or prune, and the folder
  std::int64_t keep_bytes = -1;                     ///< of `cache prune`; -1: not said
  blockrand::validate::ValidateOptions validation;  ///< but for its folder and jobs, which other commands have too
  blockrand::compare::CompareOptions comparison;    ///< but for its jobs, seed and CRS, which other commands have too
  blockrand::compare::ReportOptions comparison_report;
  std::string baseline;                 ///< compare.json of an earlier comparison
  std::optional<double> fail_if_worse;  ///< share: 0.02 is 2 %
  std::string action;                   ///< of `districts`: check, show, diff
  std::vector<std::string> files;       ///< of `districts`: what its action is about
  std::string task;                     ///< of `grammar`: check, run, test, import
  std::vector<std::string> rule_files;  ///< of `grammar`: what its task is about
  /// of `grammar`: where imports are looked for; "/PREFIX=DIR" is one place for one prefix
  std::vector<std::string> rule_roots;
  std::string rule_lot = "10x10";            ///< of `grammar run`: width and depth in metres
  std::optional<double> rule_storeys;        ///< of `grammar run`: building.storeys
  std::vector<std::string> rule_attributes;  ///< of `grammar run`: NAME=VALUE
  std::string rule_edge;          ///< of `grammar run`: kind of the wall that the rules work on; empty: a lot
  bool rule_block = false;        ///< of `grammar run`: on the street front and the yard front of a house
  std::string start_rule;         ///< of `grammar run`; empty: the rule file's own
  bool rule_tree = false;         ///< `grammar run` prints all shapes, not only leaves
  std::string map_by = "preset";  ///< of `districts show`: what the map is coloured by
  std::string id;                 ///< or address of the building that `explain` is asked about
  bool json = false;              ///< print JSON
  bool all = false;               ///< `explain` tells everything
  bool edges = false;             ///< `explain` lists the wall segments of the outline
  bool style = false;             ///< `explain` lists all evidence for the style
  std::string chip;               ///< PNG that `explain` writes: the building in its aerial image
  int port = 0;                   ///< of `view`; 0: not said
  bool open = false;              ///< `view` starts the browser
  std::string site;               ///< folder that `view` writes; empty: it serves
  base::ProgressStyle progress = base::ProgressStyle::automatic;
  base::LogFormat log_format = base::LogFormat::text;
  std::string schedule;               ///< of `schedule`: systemd, slurm, kubernetes, cron
  std::string schedule_at = "02:30";  ///< local time of day
  std::string schedule_user;          ///< under whom; empty: the region's owner
  std::string schedule_image;         ///< container with the program
  std::string schedule_into;          ///< folder that the files are written to; empty: standard output
  std::string metrics;                ///< Prometheus text file that `build` writes; empty: none
  bool verbose = false;               ///< `build` ends with figures for developers, too
  bool quiet = false;                 ///< warnings and errors only
};

using Option = base::Option<Settings>;
using base::Commands;
using base::kAllCommands;
using base::OptionType;
using base::ValueError;
using enum base::Commands;

/// All options in the order of help and reference: section by section. Collected from the tables beside the structs.
const std::vector<Option>& options();

/// Where `options` has them, in its order.
const std::vector<base::OptionSection>& sections();

/// A table of the config file: one of its options has a key.
bool in_config(const base::OptionSection& section);

/// The options of Settings itself: those of single commands, each table in the order of help.
std::vector<base::OptionTable<Settings>> command_options();

/// The value that holds when nobody sets one, as people read it; empty for flags, whose names say it (shown_name).
std::string default_text(const Option& option);

/// A flag that is set unless --no-… takes it back.
bool on_by_default(const Option& option);

/// The long name under which people meet an option: "--lod", of a flag that is on by default "--no-report", of a
/// positional argument "INPUT".
std::string shown_name(const Option& option);

/// "0 to 2", "from 0"; empty where any value will do.
std::string range_text(const Option& option);

/// What that name does, without the default. \param commands  bits: to whom; all that say the same, or nobody in particular
std::string_view shown_help(const Option& option, unsigned commands = 0);

}  // namespace blockrand::settings
