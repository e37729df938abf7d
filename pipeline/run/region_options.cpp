#include "pipeline/run/region_options.h"

#include "pipeline/base/option.h"

namespace blockrand::run {
namespace {

using base::integer;
using base::number;
using base::OptionRecord;
using base::OptionType;
using base::text;
using enum base::Commands;
using R = RegionOptions;

constexpr base::OptionSection kRegionSection{.name = "region", .title = "A region that is rebuilt again and again"};
constexpr base::OptionSection kGatesSection{.name = "gates", .title = "What a new build of a region may lose"};

base::OptionTable<R> of_region() {
  return base::in_section<R>(
      kRegionSection,
      {integer({.name = "keep",
                .key = "keep",
                .argument = "N",
                .commands = kUpdate,
                .minimum = 1,
                .maximum = 10000,
                .help = "published builds that stay, the current one among them",
                .record = OptionRecord::none},
               &R::keep),
       text({.name = "polygon",
             .key = "polygon",
             .argument = "FILE",
             .type = OptionType::path,
             .commands = kUpdate,
             .help = "the area that data are cut to, as they come in: a .poly file, or any vector file that GDAL reads "
                     "(GeoJSON, GeoPackage). Buildings across its border stay whole",
             .record = OptionRecord::none},
            &R::polygon),
       text({.name = "replication",
             .key = "replication",
             .argument = "FOLDER",
             .type = OptionType::folder,
             .commands = kUpdate,
             .help = "folder of change files with sequence numbers, as download servers have them: state.txt, "
                     "000/001/234.osc.gz; update takes all that are new",
             .record = OptionRecord::none},
            &R::replication),
       integer({.name = "first-sequence",
                .key = "first_sequence",
                .argument = "N",
                .commands = kUpdate,
                .minimum = -1,
                .maximum = 999999999,
                .help = "number of the first change file to apply; -1: the one after that which the extract "
                        "names",
                .record = OptionRecord::none},
               &R::first_sequence),
       text({.name = "hook",
             .key = "hook",
             .argument = "COMMAND",
             .commands = kUpdate,
             .help = "run by /bin/sh when a run has ended, with BLOCKRAND_STATE (published, unchanged, refused, "
                     "failed), BLOCKRAND_REGION, BLOCKRAND_BUILD and BLOCKRAND_CHANGES in its environment",
             .record = OptionRecord::none},
            &R::hook),
       text({.name = "notify",
             .key = "notify",
             .argument = "COMMAND",
             .commands = kUpdate | kSchedule,
             .help = "run by /bin/sh when a run failed, was refused, or left data older than max_age_hours, with "
                     "BLOCKRAND_REASON (one line), BLOCKRAND_STATE (failed, refused, stale) and what the hook gets",
             .help_of = {{kSchedule,
                          "run by /bin/sh when a night failed, was refused, or left data older than --max-age, with "
                          "BLOCKRAND_REASON (one line), BLOCKRAND_STATE and BLOCKRAND_REGION in its environment"}},
             .record = OptionRecord::none},
            &R::notify),
       number({.name = "max-age",
               .key = "max_age_hours",
               .argument = "HOURS",
               .commands = kUpdate | kStatus | kSchedule,
               .minimum = 0,
               .maximum = 1e6,
               .help = "data of the published build that are older are told, and are exit code 3; 0: they may have any "
                       "age",
               .record = OptionRecord::none},
              &R::max_age_hours)});
}

base::OptionTable<R> of_gates() {
  const auto percent = [](std::string_view name, std::string_view key, std::string_view help, double R::*member) {
    return number({.name = name,
                   .key = key,
                   .argument = "NUMBER",
                   .commands = kUpdate,
                   .minimum = 0,
                   .maximum = 1e9,
                   .help = help,
                   .record = OptionRecord::none},
                  member);
  };
  return base::in_section<R>(
      kGatesSection,
      {percent("max-lost", "max_lost", "of the buildings that the published build has, so many may be gone",
               &R::max_lost),
       percent("max-added", "max_added", "new buildings, of as many as the published build has", &R::max_added),
       percent("max-simpler", "max_simpler",
               "by so many points the share of buildings that are simpler than asked, or have no model, may grow",
               &R::max_simpler),
       percent("max-height-change", "max_height_change",
               "by so much the mean height of the buildings that both builds have may change", &R::max_height_change),
       integer({.name = "gate-baseline",
                .key = "baseline",
                .argument = "N",
                .commands = kUpdate,
                .minimum = -1,
                .maximum = 999999,
                .help = "number of a published build that stays, and that new ones are held against, too: many small "
                        "steps do not lead far away unseen; -1: none",
                .record = OptionRecord::none},
               &R::baseline),
       percent("max-drift", "max_drift",
               "what may be gone, new, simpler or of another mean height against the baseline, each", &R::max_drift),
       text({.name = "gate-reference",
             .key = "reference",
             .argument = "MODELS",
             .type = OptionType::path,
             .commands = kUpdate,
             .help =
                 "hand-built models, a file or a folder, that each build is compared with as `blockrand compare` does",
             .record = OptionRecord::none},
            &R::reference),
       percent("max-worse", "max_worse",
               "by so much a measure of that comparison may be worse than that of the published build",
               &R::max_worse)});
}

}  // namespace

base::OptionTable<RegionOptions> region_options() { return base::concatenated({of_region(), of_gates()}); }

}  // namespace blockrand::run
