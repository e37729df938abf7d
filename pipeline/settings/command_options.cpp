// Options that belong to a command rather than to a stage: members of Settings itself.
#include <algorithm>

#include "pipeline/settings/options.h"

namespace blockrand::settings {
namespace {

using base::choice;
using base::custom;
using base::flag;
using base::integer;
using base::number;
using base::OptionRecord;
using base::text;
using base::texts;
using base::word;
using S = Settings;
using Table = base::OptionTable<Settings>;

Table of_finished_builds() {
  return {text({.name = "FOLDER",
                .argument = "FOLDER",
                .type = OptionType::folder,
                .commands = kExplain | kValidate | kView,
                .help = "what 'blockrand build' wrote",
                .if_missing = "no FOLDER is given: name the output folder of a build.",
                .after = "INPUT"},
               &S::folder)};
}

Table of_regions() {
  constexpr unsigned regions = kUpdate | kStatus | kRollback | kRegion | kSchedule;
  return {
      word({.name = "STEP",
            .argument = "STEP",
            .commands = kRegion,
            .help = "repair, plan, work, finish or drop",
            .if_missing = "nothing to do is given: repair, plan, work, finish or drop.",
            .choices = {"repair", "plan", "work", "finish", "drop"},
            .after = "FOLDER"},
           &S::region_work),
      text({.name = "REGION",
            .argument = "REGION",
            .type = OptionType::folder,
            .commands = regions,
            .help = "folder of a region that is rebuilt again and again",
            .if_missing = "no REGION is given: name the folder of a region.",
            .after = "STEP"},
           &S::region),
      texts({.name = "DATA",
             .argument = "DATA",
             .type = OptionType::path,
             .commands = kUpdate | kRegion,
             .help = "an extract, change files (.osc, .osc.gz, .osc.bz2), or an extract and then change files; "
                     "without any, what region.toml names; region repair: an extract",
             .help_of = {{kRegion, "repair: an extract. plan: as update takes them"}}},
            &S::data),
      flag({.name = "dry-run",
            .commands = kUpdate | kBuild | kPublish,
            .help = "tell what would be done and how long that may take; nothing is built; build: check all that "
                    "can be checked before, and write nothing; publish: which files would be sent",
            .help_of = {{kUpdate, "tell what would be done and how long that may take; nothing is built"},
                        {kBuild,
                         "check options, inputs and place, tell what would be built and what that would "
                         "take; nothing is written"},
                        {kPublish, "tell which files would be sent and removed; nothing is"}},
            .after = "force"},
           &S::dry_run),
      flag({.name = "break-lock",
            .commands = kUpdate | kRollback | kRegion,
            .help = "go on although a run on another host seems to hold the region; only if it is gone for sure"},
           &S::break_lock),
      integer(
          {.name = "shards",
           .argument = "N",
           .commands = kRegion | kSchedule,
           .minimum = 1,
           .maximum = 10000,
           .help = "region plan: by so many processes the areas are to be built; each gets about the same work; "
                   "schedule: slurm, kubernetes: pieces that are worked on at the same time",
           .help_of = {{kRegion, "plan: by so many processes the areas are to be built; each gets about the same work"},
                       {kSchedule,
                        "slurm, kubernetes: pieces that are worked on at the same time; kubernetes: 1: one pod "
                        "runs blockrand update"}}},
          &S::shards),
      text({.name = "shard",
            .argument = "I/N",
            .commands = kRegion,
            .help = "work: the shard to work on, from 1/N to N/N; it may be run again, and builds what is missing"},
           &S::shard),
      integer({.name = "to",
               .argument = "N",
               .commands = kRollback,
               .minimum = -1,
               .maximum = 999999,
               .help = "number of the build to go back to; -1: the one before the current one"},
              &S::to)};
}

Table of_publishing() {
  return {text({.name = "SOURCE",
                .argument = "SOURCE",
                .type = OptionType::folder,
                .commands = kPublish,
                .help = "a region, whose published build is sent, or the output folder of a build",
                .if_missing = "no SOURCE is given: name a region, or the output folder of a build.",
                .after = "REGION"},
               &S::source)};
}

Table of_schedules() {
  return {
      word({.name = "print",
            .argument = "KIND",
            .commands = kSchedule,
            .help = "for whom: systemd (a service and a timer), cron, slurm (a script that submits jobs), kubernetes "
                    "(YAML)",
            .if_missing = "no --print is given: systemd, cron, slurm or kubernetes.",
            .choices = {"systemd", "cron", "slurm", "kubernetes"},
            .after = "to"},
           &S::schedule),
      text(
          {.name = "at", .argument = "HH:MM", .commands = kSchedule, .help = "time of day, of the machine's own clock"},
          &S::schedule_at),
      text({.name = "user",
            .argument = "NAME",
            .commands = kSchedule,
            .help = "systemd: under whom it runs; without, the owner of the region's folder"},
           &S::schedule_user),
      text({.name = "image",
            .argument = "IMAGE",
            .commands = kSchedule,
            .help = "kubernetes: container image with the program; without, blockrand: and the program's version"},
           &S::schedule_image),
      text({.name = "into",
            .argument = "FOLDER",
            .type = OptionType::folder,
            .commands = kSchedule,
            .help = "write each file there, by its name; without, all go to standard output"},
           &S::schedule_into)};
}

Table of_caches() {
  return {word({.name = "WORK",
                .argument = "WORK",
                .commands = kCache,
                .help = "stat, verify or prune",
                .if_missing = "no WORK is given: stat, verify or prune.",
                .choices = {"stat", "verify", "prune"},
                .after = "FOLDER"},
               &S::cache_work),
          text({.name = "CACHE",
                .argument = "CACHE",
                .type = OptionType::folder,
                .commands = kCache,
                .help = "folder of kept work: cache/ of a region, or the region, or that of build --cache",
                .if_missing = "no CACHE is given: name a region, or the folder of build --cache.",
                .after = "WORK"},
               &S::cache),
          integer({.name = "keep-bytes",
                   .argument = "N",
                   .commands = kCache,
                   .minimum = -1,
                   .maximum = 1e18,
                   .help = "prune: how many bytes may stay"},
                  &S::keep_bytes)};
}

Table of_districts() {
  return {word({.name = "ACTION",
                .argument = "ACTION",
                .commands = kDistricts,
                .help = "check, show or diff",
                .if_missing = "no ACTION is given: check, show or diff.",
                .choices = {"check", "show", "diff"},
                .after = "FOLDER"},
               &S::action),
          texts({.name = "FILE",
                 .argument = "FILE",
                 .type = OptionType::path,
                 .commands = kDistricts,
                 .help = "check: rule sets, without any those that came with the program; show: an extract; diff: two "
                         "rule sets and an extract"},
                &S::files),
          word({.name = "by",
                .argument = "WHAT",
                .commands = kDistricts,
                .help = "districts show: what the map is coloured by, preset or rule",
                .choices = {"preset", "rule"},
                .after = "overrides"},
               &S::map_by)};
}

/// Folders separated by commas, without empty ones. Spaces belong to their names.
std::vector<std::string> parse_roots(const std::string& text) {
  std::vector<std::string> roots;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    if (end > at) roots.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return roots;
}

void add_attribute(S& s, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw ValueError(base::in_quotes(text) + " is no NAME=VALUE", "For example: height=12");
  s.rule_attributes.push_back(text);
}

Table of_grammar() {
  return {
      word({.name = "TASK",
            .argument = "TASK",
            .commands = kGrammar,
            .help = "check, run, test or import",
            .if_missing = "no TASK is given: check, run, test or import.",
            .choices = {"check", "run", "test", "import"},
            .after = "FILE"},
           &S::task),
      texts({.name = "RULES",
             .argument = "RULES",
             .type = OptionType::path,
             .commands = kGrammar,
             .help = "check, test: rule files; run: one; import: a file of facade rules in XML",
             .if_missing = "no RULES are given: name rule files."},
            &S::rule_files),
      custom<S>(
          {.name = "roots",
           .argument = "LIST",
           .type = OptionType::list,
           .commands = kGrammar,
           .help = "folders, separated by commas, in which imported files are looked for besides the importing "
                   "file's; /PREFIX=FOLDER: where paths that begin with /PREFIX lie"},
          [](S& s, const std::string& text) { s.rule_roots = parse_roots(text); },
          [](const S& s) { return base::joined(s.rule_roots, ","); }),
      text({.name = "lot",
            .argument = "WxD",
            .commands = kGrammar,
            .help = "run: the rectangle that the rules begin with, width and depth in metres, such as 20x12"},
           &S::rule_lot),
      number({.name = "storeys",
              .argument = "N",
              .commands = kGrammar,
              .minimum = 0,
              .maximum = 200,
              .help = "run: building.storeys and building__levels"},
             &S::rule_storeys),
      custom<S>({.name = "attr",
                 .argument = "NAME=VALUE",
                 .commands = kGrammar,
                 .help = "run: value of an attribute, or of what the program gives (building.height); several times",
                 .several = true},
                add_attribute, [](const S& s) { return base::joined(s.rule_attributes, " "); }),
      text({.name = "edge",
            .argument = "KIND",
            .commands = kGrammar,
            .help = "run: on a wall instead of a lot: street, courtyard, side or passage; as wide as --lot, with "
                    "--storeys (else 4) of "
                    "3.2 m. What rules can ask of house and wall has values, and elements are shown"},
           &S::rule_edge),
      flag({.name = "block",
            .commands = kGrammar,
            .help = "run: as --edge street, on the street front and the yard front of a house of that lot"},
           &S::rule_block),
      text({.name = "rule",
            .argument = "NAME",
            .commands = kGrammar,
            .help = "run: where to begin; else the rule file's own start rule"},
           &S::start_rule),
      flag({.name = "tree", .commands = kGrammar, .help = "run: print all shapes, not only the leaves' number"},
           &S::rule_tree)};
}

Table of_build() {
  return {text({.name = "config",
                .argument = "FILE.toml",
                .type = OptionType::path,
                .help = "read options from this file; the command line is stronger",
                .after = "force"},
               &S::config),
          text({.name = "metrics",
                .argument = "FILE",
                .type = OptionType::path,
                .help = "write figures of the build to this file as well, for Prometheus (docs/operations.md)"},
               &S::metrics)};
}

Table of_explain() {
  return {text({.name = "ID",
                .argument = "ID",
                .commands = kExplain,
                .help = "of the building: w123 for way 123, r45 for relation 45; or address, or name",
                .if_missing = "no building is named: give its id or address, for example w123 or \"Arkonaplatz 5\".",
                .after = "tree"},
               &S::id),
          flag({.name = "all",
                .commands = kExplain,
                .help = "tell everything: each value, its source, what lost against it; each stage; files",
                .after = "sample"},
               &S::all),
          flag({.name = "edges",
                .commands = kExplain,
                .help = "--all, and list the walls: what each faces, how long it is, where it looks"},
               &S::edges),
          flag({.name = "style",
                .commands = kExplain,
                .help = "--all, and list everything that spoke for or against its style, not the weightiest alone"},
               &S::style),
          text({.name = "chip",
                .argument = "FILE.png",
                .type = OptionType::path,
                .commands = kExplain,
                .help = "write the piece of the aerial image that shows it, with the outlines, to this file"},
               &S::chip)};
}

Table of_view() {
  return {integer({.name = "port",
                   .argument = "N",
                   .commands = kView,
                   .minimum = 0,
                   .maximum = 65535,
                   .help = "port on 127.0.0.1; 0: 8712, or another one if that is taken",
                   .after = "chip"},
                  &S::port),
          flag({.name = "open", .commands = kView, .help = "show it in the browser of this desktop"}, &S::open),
          text({.name = "export",
                .argument = "SITE",
                .type = OptionType::folder,
                .commands = kView,
                .help = "write the page and what it shows as files for any web server, instead of serving it"},
               &S::site)};
}

/// "2%", "2 %" or "2" → 0.02.
double parse_percent(const std::string& text) {
  const std::string remedy = "Write for example 2%.";
  std::string_view number = text;
  if (number.ends_with('%')) number.remove_suffix(1);
  while (number.ends_with(' ')) number.remove_suffix(1);
  const double percent = base::parse_number(number, remedy);
  if (percent < 0 || percent > 1000) throw ValueError(base::in_quotes(text) + " is out of range", remedy);
  return percent / 100;
}

Table of_compare() {
  return base::in_section<S>(
      compare::kCompareSection,
      {text({.name = "baseline",
             .argument = "COMPARE.JSON",
             .type = OptionType::path,
             .commands = kCompare,
             .help = "an earlier comparison's compare.json: every measure is set against it",
             .record = OptionRecord::none},
            &S::baseline),
       custom<S>(
           {.name = "fail-if-worse",
            .argument = "PERCENT",
            .commands = kCompare,
            .help = "exit with code 3 when a measure is worse than in --baseline by more than this: 2%",
            .record = OptionRecord::none},
           [](S& s, const std::string& text) { s.fail_if_worse = parse_percent(text); },
           [](const S& s) { return s.fail_if_worse ? base::shortest(*s.fail_if_worse * 100) + "%" : ""; })});
}

Table of_several() {
  return {flag(
      {.name = "json", .commands = kInfo | kExplain | kValidate | kCompare | kStatus | kCache, .help = "print JSON"},
      &S::json)};
}

const base::Choices<base::ProgressStyle> kProgressStyles = {{"auto", base::ProgressStyle::automatic},
                                                            {"bar", base::ProgressStyle::bar},
                                                            {"plain", base::ProgressStyle::plain},
                                                            {"none", base::ProgressStyle::none}};
const base::Choices<base::LogFormat> kLogFormats = {{"text", base::LogFormat::text}, {"json", base::LogFormat::json}};

Table of_messages() {
  constexpr unsigned all = kBuild | kInfo | kValidate | kCompare | kDistricts | kGrammar | kUpdate | kRollback |
                           kRegion | kCache | kView | kPublish;
  constexpr base::OptionSection messages{.name = "messages", .title = "Messages"};
  return base::in_section<S>(
      messages,
      {choice({.name = "progress",
               .argument = "STYLE",
               .commands = all & ~kView,
               .help = "auto (bar on a terminal, else plain), bar, plain (lines) or none"},
              kProgressStyles, &S::progress),
       choice({.name = "log-format",
               .argument = "FORMAT",
               .commands = all,
               .help = "messages, progress and the summary as text or as json lines"},
              kLogFormats, &S::log_format),
       flag({.name = "verbose",
             .letter = "v",
             .commands = kBuild,
             .help = "end with figures for developers as well: memory, how roofs stand in their rows"},
            &S::verbose),
       flag({.name = "quiet", .letter = "q", .commands = all, .help = "warnings and errors only"}, &S::quiet)});
}

}  // namespace

std::vector<base::OptionTable<Settings>> command_options() {
  return {of_finished_builds(), of_regions(), of_publishing(), of_schedules(), of_caches(),
          of_districts(),       of_grammar(), of_build(),      of_explain(),   of_view(),
          of_several(),         of_compare(), of_messages()};
}

}  // namespace blockrand::settings
