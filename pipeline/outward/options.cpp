#include "pipeline/outward/options.h"

#include "pipeline/base/option.h"

namespace blockrand::outward {

base::OptionTable<PublishOptions> publish_options() {
  using base::OptionRecord;
  using base::OptionType;
  using enum base::Commands;
  using P = PublishOptions;
  constexpr base::OptionSection kPublishSection{.name = "publish", .title = "Where a build is sent to"};
  return base::in_section<P>(
      kPublishSection,
      {base::text(
           {.name = "command",
            .key = "command",
            .argument = "COMMAND",
            .commands = kPublish,
            .help = "run by /bin/sh for each list of files to send or remove, which comes by standard input and as "
                    "files (docs/publishing.md): for buckets and servers",
            .record = OptionRecord::none},
           &P::command),
       base::text({.name = "web-root",
                   .key = "web_root",
                   .argument = "FOLDER",
                   .type = OptionType::folder,
                   .commands = kPublish,
                   .help = "web root that the program writes itself, each file beside its place and then renamed",
                   .record = OptionRecord::none},
                  &P::web_root),
       base::text({.name = "target",
                   .key = "target",
                   .argument = "NAME",
                   .commands = kPublish,
                   .help = "name of the bucket or web root, under which it is noted what is there: one for each place",
                   .record = OptionRecord::none},
                  &P::target),
       base::number({.name = "keep-deleted",
                     .key = "keep_deleted",
                     .argument = "HOURS",
                     .commands = kPublish,
                     .minimum = 0,
                     .maximum = 1e6,
                     .help = "how long files stay that the build does not name any more: readers may still have the "
                             "tileset that does",
                     .record = OptionRecord::none},
                    &P::keep_deleted),
       base::integer({.name = "batch",
                      .key = "batch",
                      .argument = "N",
                      .commands = kPublish,
                      .minimum = 1,
                      .maximum = 1000000,
                      .help = "files of one call of --command at most: a transfer that breaks off is taken up there",
                      .record = OptionRecord::none},
                     &P::batch),
       base::word(
           {.name = "variants",
            .key = "variants",
            .argument = "KIND",
            .commands = kPublish,
            .help = "gzip: FILE.gz beside each text, GLB and GeoPackage that becomes a tenth smaller by it; none",
            .choices = {"none", "gzip"},
            .record = OptionRecord::none},
           &P::variants),
       base::flag(
           {.name = "resend",
            .commands = kPublish,
            .help = "send every file, whatever is noted of the target: after it was emptied or changed by others",
            .record = OptionRecord::none},
           &P::resend),
       base::text({.name = "archive",
                   .key = "archive",
                   .argument = "FILE.3tz",
                   .type = OptionType::path,
                   .commands = kPublish,
                   .help = "pack the 3D Tiles into one file, a 3D Tiles archive",
                   .record = OptionRecord::none},
                  &P::archive),
       base::text({.name = "postgis",
                   .key = "postgis",
                   .argument = "PG:...",
                   .commands = kPublish,
                   .help = "bring the tables of a PostGIS database to the build's GeoPackages, as GDAL names it: "
                           "\"PG:dbname=city host=db\"; passwords belong into ~/.pgpass",
                   .record = OptionRecord::none},
                  &P::postgis),
       base::text({.name = "schema",
                   .key = "schema",
                   .argument = "NAME",
                   .commands = kPublish,
                   .help = "schema of the database that the tables lie in; it is made where it is missing",
                   .record = OptionRecord::none},
                  &P::schema)});
}

}  // namespace blockrand::outward
