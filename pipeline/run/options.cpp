#include "pipeline/run/options.h"

#include <cmath>

#include "pipeline/base/option.h"

namespace blockrand::run {
namespace {

using base::custom;
using base::flag;
using base::integer;
using base::number;
using base::OptionRecord;
using base::OptionType;
using base::RecordValue;
using base::text;
using base::ValueError;
using enum base::Commands;
using B = BuildOptions;

// ---- Values with a grammar of their own.

std::array<double, 4> parse_bbox(const std::string& text) {
  const std::string remedy = "Write west,south,east,north in degrees, for example 12.36,51.33,12.40,51.35.";
  const std::vector<std::string> parts = base::split(text, ',');
  if (parts.size() != 4) throw ValueError(base::in_quotes(text) + " does not have four numbers", remedy);
  std::array<double, 4> box{};
  for (std::size_t i = 0; i < 4; ++i) box[i] = base::parse_number(parts[i], remedy);
  const auto [west, south, east, north] = box;
  if (std::abs(west) > 180 || std::abs(east) > 180) throw ValueError("a longitude lies outside of -180 to 180", remedy);
  if (std::abs(south) > 90 || std::abs(north) > 90)
    throw ValueError("a latitude lies outside of -90 to 90", "Longitude comes first. " + remedy);
  if (south >= north) throw ValueError("south is not below north", remedy);
  if (west >= east)
    throw ValueError("west is not left of east",
                     remedy + " A box across 180 degrees cannot be given: build its two sides one after the other.");
  return box;
}

std::string show_bbox(const B& b) {
  std::vector<std::string> numbers;
  if (b.bbox)
    for (const double v : *b.bbox) numbers.push_back(base::shortest(v));
  return base::joined(numbers, ",");
}

std::optional<RecordValue> record_bbox(const B& b) {
  return b.bbox ? RecordValue(std::vector<double>(b.bbox->begin(), b.bbox->end())) : RecordValue();
}

void set_crs(B& b, const std::string& text) {
  // Whether the code exists and suits the place is for georef to say; here only what cannot be one.
  std::string_view code = text;
  if (code.size() > 5 && (code.starts_with("EPSG:") || code.starts_with("epsg:"))) code.remove_prefix(5);
  if (code.size() < 4 || code.size() > 6 || code.find_first_not_of("0123456789") != std::string_view::npos)
    throw ValueError(base::in_quotes(text) + " is not an EPSG code", "Write for example EPSG:25833.");
  b.crs = "EPSG:" + std::string(code);
}

// ---- The table. Places in the record: build.json keeps the order of its first versions.

base::OptionTable<B> places_and_detail() {
  return {text({.name = "INPUT",
                .key = "input",
                .argument = "FILE",
                .type = OptionType::path,
                .commands = kBuild | kInfo,
                .help = "OSM extract: .osm, .osm.pbf, .osm.gz or .osm.bz2; - reads it from standard input",
                .if_missing = "no INPUT is given: name an OSM extract.",
                .record = OptionRecord::none},
               &B::input),
          text({.name = "name",
                .argument = "NAME",
                .help = "what report and documents call the build; else it is called as the extract",
                .record = OptionRecord::none},
               &B::name),
          text({.name = "output",
                .letter = "o",
                .key = "output",
                .argument = "FOLDER",
                .type = OptionType::folder,
                .commands = kBuild | kCompare | kDistricts | kGrammar,
                .help = "folder that is written; it appears when everything in it is complete; districts diff, grammar "
                        "run, grammar import: a file",
                .help_of = {{kBuild | kCompare, "folder that is written; it appears when everything in it is complete"},
                            {kDistricts, "show: folder that is written; diff: file that is written"},
                            {kGrammar, "run, import: file that is written"}},
                .if_missing = "no output folder is given: name one with --output FOLDER.",
                .optional_for = kCompare | kDistricts | kGrammar,
                .record = OptionRecord::none},
               &B::output),
          integer({.name = "lod",
                   .key = "lod",
                   .argument = "N",
                   .commands = kBuild | kInfo,
                   .minimum = 0,
                   .maximum = 3,
                   .help = "highest level of detail: 0 footprints, 1 blocks, 2 roofs, 3 facades with windows and doors",
                   .help_of = {{kInfo,
                                "highest level of detail of the build whose cost is told: 0 footprints, 1 blocks, "
                                "2 roofs, 3 facades"}},
                   .record_place = 1},
                  &B::lod)};
}

base::OptionTable<B> place_and_ground() {
  return {
      custom<B>(
          {.name = "bbox",
           .key = "bbox",
           .argument = "W,S,E,N",
           .type = OptionType::list,
           .commands = kBuild | kInfo | kDistricts,
           .help = "only what lies in this box: west,south,east,north in degrees",
           .help_of = {{kDistricts, "show, diff: only what lies in this box: west,south,east,north in degrees"}},
           .record = OptionRecord::yes,
           .record_place = 13},
          [](B& b, const std::string& text) { b.bbox = parse_bbox(text); }, show_bbox, record_bbox),
      custom<B>(
          {.name = "tile",
           .argument = "LEVEL/X/Y",
           .help = "build this tile alone, from what lies within 3 km of it: the same as in a build of the "
                   "whole; needs --pinned",
           .record = OptionRecord::yes,
           .record_place = 12},
          [](B& b, const std::string& text) { b.tile = text; }, [](const B& b) { return b.tile; },
          [](const B& b) { return b.tile.empty() ? std::nullopt : std::optional(RecordValue(b.tile)); }),
      text({.name = "pinned",
            .argument = "BUILD.JSON",
            .type = OptionType::path,
            .help = "with --tile and --area: build.json of a build of the whole extract, whose CRS and coverage are "
                    "taken",
            .record = OptionRecord::none},
           &B::pinned),
      integer(
          {.name = "areas",
           .key = "areas",
           .argument = "LEVEL",
           .minimum = 0,
           .maximum = 14,
           .help = "build one area after the other, each tile of this level of the quadtree (11: about 6 by 10 km at "
                   "51 degrees; cut in four where a town is dense), so that memory does not grow with the extract; 0: "
                   "all at once; update: as the size asks, 1 is at once",
           .record = OptionRecord::none},
          &B::areas),
      text({.name = "area",
            .argument = "LEVEL/X/Y",
            .help = "build this one area alone: as it lies below areas/ in a build with --areas; needs --pinned",
            .record = OptionRecord::none},
           &B::area),
      // The record has the CRS that was used beside what PROJ says of it.
      custom<B>(
          {.name = "crs",
           .key = "crs",
           .argument = "EPSG:CODE",
           .commands = kBuild | kInfo | kCompare | kDistricts,
           .help = "projected coordinate system in metres; else ETRS89/UTM in Europe and WGS 84/UTM elsewhere; "
                   "compare: else that of the reference",
           .help_of = {{kBuild,
                        "projected coordinate system in metres; else ETRS89/UTM in Europe and WGS 84/UTM "
                        "elsewhere"},
                       {kInfo, "coordinate system that the build would have, in place of the one that it would choose"},
                       {kCompare, "projected coordinate system in metres; else that of the reference"},
                       {kDistricts,
                        "show, diff: projected coordinate system in metres; else ETRS89/UTM in Europe "
                        "and WGS 84/UTM elsewhere"}},
           .record = OptionRecord::none},
          set_crs, [](const B& b) { return b.crs; }),
      text({.name = "districts",
            .key = "districts",
            .argument = "NAME",
            .commands = kBuild | kDistricts,
            .help = "district rules for everything: the name of a rule set in configs/districts/, or a file; else "
                    "each place's own"},
           &B::districts),
      text({.name = "overrides",
            .key = "overrides",
            .argument = "FILE",
            .type = OptionType::path,
            .commands = kBuild | kDistricts,
            .help = "corrections by OSM id, stronger than every tag (docs/districts.md)"},
           &B::overrides),
      text({.name = "terrain",
            .key = "terrain",
            .argument = "RASTER",
            .type = OptionType::path,
            .help = "ground heights: any raster that GDAL reads",
            .record = OptionRecord::yes},
           &B::terrain),
      text({.name = "terrain-height-reference",
            .key = "terrain_height_reference",
            .argument = "REFERENCE",
            .help = "what the raster's heights are above, where it does not say so itself: sea-level (taken for "
                    "EGM96), ellipsoid, or a vertical coordinate system such as EPSG:7837"},
           &B::terrain_height_reference),
      custom<B>(
          {.name = "surroundings",
           .key = "surroundings",
           .argument = "LAYERS",
           .help = "what stands and lies around the houses: on, off, some of ground, bodies, objects with commas "
                   "between them, or auto: on at LoD3, off below (docs/surroundings.md)",
           .choices = {"auto", "on", "off", "ground", "bodies", "objects"},
           .record = OptionRecord::yes},
          [](B& b, const std::string& text) { b.surroundings = surroundings::parse_surroundings(text); },
          [](const B& b) { return surroundings::show_surroundings(b.surroundings); },
          [](const B& b) {
            const surroundings::SurroundingOptions layers = b.surroundings.settled(b.lod);
            return layers.any() ? std::optional(RecordValue(surroundings::show_surroundings(layers))) : std::nullopt;
          }),
      number({.name = "ground-height",
              .key = "ground_height",
              .argument = "METRES",
              .minimum = -500,
              .maximum = 9000,
              .help = "height of the ground where there is no terrain, in m: above sea level, or beside --terrain in "
                      "the raster's heights"},
             &B::ground_height)};
}

base::OptionTable<B> how_it_runs() {
  constexpr double most = 9223372036854774784.0;  // the largest double below 2^63: TOML's integers end there
  return {
      integer({.name = "seed",
               .key = "seed",
               .argument = "N",
               .commands = kBuild | kCompare | kDistricts | kGrammar,
               .minimum = 0,
               .maximum = most,
               .help = "of all random choices; the same seed gives the same bytes",
               .help_of = {{kCompare, "of the places from which distances are measured"},
                           {kDistricts, "show, diff: of all random choices, as build has it"},
                           {kGrammar, "run: of all random choices"}},
               .record_place = 11},
              &B::seed),
      integer({.name = "jobs",
               .letter = "j",
               .key = "jobs",
               .argument = "N",
               .commands = kBuild | kInfo | kValidate | kCompare | kDistricts | kUpdate | kRegion,
               .minimum = 0,
               .maximum = 1024,
               .help = "worker threads; 0 is one per core",
               .help_of = {{kInfo, "worker threads of the build whose cost is told; 0 is one per core"},
                           {kDistricts, "show, diff: worker threads; 0 is one per core"}},
               .record = OptionRecord::none},
              &B::jobs),
      integer({.name = "memory-limit",
               .key = "memory_limit",
               .argument = "BYTES",
               .minimum = 0,
               .maximum = most,
               .help = "with --areas: as many at once as fit into it, the workers shared among them; 0: one at a time",
               .record = OptionRecord::none},
              &B::memory_limit),
      text({.name = "cache",
            .argument = "FOLDER",
            .type = OptionType::folder,
            .help = "keep work there for later runs, and take from there what an earlier run, ended or not, has left; "
                    "update has a folder of its own",
            .record = OptionRecord::none},
           &B::cache),
      flag({.name = "strict",
            .key = "strict",
            .help = "exit with code 3 when a building is simpler than asked or has no solid",
            .record = OptionRecord::none},
           &B::strict),
      // The record has the files that were read, each with its hash.
      text({.name = "configs",
            .key = "configs",
            .argument = "DIR",
            .type = OptionType::folder,
            .commands = kBuild | kInfo | kDistricts | kUpdate | kRegion | kGrammar,
            .help = "folder with defaults/ and materials/; else the configs/ that came with the program",
            .record = OptionRecord::none},
           &B::configs),
      flag({.name = "force",
            .commands = kBuild | kCompare | kDistricts | kGrammar | kView,
            .help = "replace an existing build, comparison, map, site or file",
            .help_of = {{kBuild, "replace an existing build"},
                        {kCompare, "replace an existing comparison"},
                        {kDistricts, "show, diff: replace an existing map or file"},
                        {kGrammar, "run, import: replace an existing file"},
                        {kView, "replace an existing site"}},
            .record = OptionRecord::none},
           &B::force),
      flag({.name = "allow-empty",
            .key = "allow_empty",
            .help = "with --force: a build without any model may replace one that has some",
            .record = OptionRecord::none},
           &B::allow_empty),
      number({.name = "allow-shrink",
              .key = "allow_shrink",
              .argument = "NUMBER",
              .minimum = 0,
              .maximum = 100,
              .help = "with --force: how many percent fewer models than the build that is replaced the new one may "
                      "have",
              .record = OptionRecord::none},
             &B::allow_shrink)};
}

}  // namespace

base::OptionTable<BuildOptions> build_options() {
  return base::concatenated({places_and_detail(), place_and_ground(),
                             base::of_member(observation::imagery_options(), &B::imagery), how_it_runs(),
                             base::of_member(outputs::output_options(), &B::outputs),
                             base::of_member(repair::repair_options(), &B::repair),
                             base::of_member(attributes::generate_options(), &B::generate)});
}

}  // namespace blockrand::run
