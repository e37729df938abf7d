#include "pipeline/settings/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <limits>

#include "pipeline/base/text.h"
#include "pipeline/base/toml_file.h"

namespace blockrand::settings {
namespace {

using base::shortest;

constexpr double kMaxSeed = 9223372036854774784.0;  // the largest double below 2^63: TOML's integers end there

std::string quoted(std::string_view text) { return fmt::format("'{}'", text); }

std::string range_remedy(const Option& o, const char* kind) {
  std::string text = std::string("Write a ") + kind;
  if (o.maximum < 1e15) return text + " from " + shortest(o.minimum) + " to " + shortest(o.maximum) + ".";
  return text + " of at least " + shortest(o.minimum) + ".";
}

double parse_number(std::string_view text, const std::string& remedy) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw ValueError(quoted(text) + " is not a number", remedy);
  return value;
}

double parse_in_range(const Option& o, const std::string& text, const char* kind) {
  const std::string remedy = range_remedy(o, kind);
  const double value = parse_number(text, remedy);
  if (value < o.minimum || value > o.maximum) throw ValueError(text + " is out of range", remedy);
  return value;
}

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t end = text.find(at);
    std::string_view part = text.substr(0, end);
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    parts.emplace_back(part);
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

template <class T>
T choose(const std::string& text, const std::vector<std::pair<std::string, T>>& choices) {
  std::vector<std::string> known;
  for (const auto& [name, value] : choices) {
    if (name == text) return value;
    known.push_back(name);
  }
  const std::string near = base::nearest(text, known);
  std::string all;
  for (const std::string& name : known) all += fmt::format("{}{}", all.empty() ? "" : ", ", name);
  throw ValueError(quoted(text) + " is unknown",
                   (near.empty() ? "" : "Did you mean " + near + "? ") + "Known: " + all + ".");
}

// ---- values with a grammar of their own

std::array<double, 4> parse_bbox(const std::string& text) {
  const std::string remedy = "Write west,south,east,north in degrees, for example 12.36,51.33,12.40,51.35.";
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 4) throw ValueError(quoted(text) + " does not have four numbers", remedy);
  std::array<double, 4> box{};
  for (std::size_t i = 0; i < 4; ++i) box[i] = parse_number(parts[i], remedy);
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

std::string show_bbox(const std::optional<std::array<double, 4>>& box) {
  if (!box) return {};
  std::string text;
  for (const double v : *box) text += fmt::format("{}{}", text.empty() ? "" : ",", shortest(v));
  return text;
}

/// The formats in the order of all listings, by their names and other names people use.
struct Format {
  const char* name;
  bool run::BuildOptions::*field;
};
constexpr Format kFormats[] = {{"gltf", &run::BuildOptions::gltf},         {"citygml", &run::BuildOptions::citygml},
                               {"cityjson", &run::BuildOptions::cityjson}, {"gpkg", &run::BuildOptions::geopackage}};

const std::vector<std::pair<std::string, outputs::Instancing>> kInstancings = {
    {"ext", outputs::Instancing::ext}, {"nodes", outputs::Instancing::nodes}, {"baked", outputs::Instancing::baked}};

const std::vector<std::pair<std::string, outputs::Compression>> kCompressions = {{"none", outputs::Compression::none},
                                                                                  {"meshopt", outputs::Compression::meshopt}};

void set_formats(Settings& s, const std::string& text) {
  std::vector<std::pair<std::string, bool run::BuildOptions::*>> names;
  for (const Format& f : kFormats) names.emplace_back(f.name, f.field);
  for (const char* other : {"tileset", "3dtiles"}) names.emplace_back(other, &run::BuildOptions::gltf);
  names.emplace_back("geopackage", &run::BuildOptions::geopackage);
  std::vector<bool run::BuildOptions::*> wanted;
  for (const std::string& part : split(text, ',')) wanted.push_back(choose(part, names));
  for (const Format& f : kFormats) s.build.*f.field = false;
  for (const auto field : wanted) s.build.*field = true;
}

std::string show_formats(const Settings& s) {
  std::string text;
  for (const Format& f : kFormats)
    if (s.build.*f.field) text += (text.empty() ? "" : ",") + std::string(f.name);
  return text;
}

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const Format& f : kFormats) names.emplace_back(f.name);
  return names;
}

void set_crs(Settings& s, const std::string& text) {
  // Whether the code exists and suits the place is for georef to say; here only what cannot be one.
  std::string_view code = text;
  if (code.size() > 5 && (code.starts_with("EPSG:") || code.starts_with("epsg:"))) code.remove_prefix(5);
  if (code.size() < 4 || code.size() > 6 || code.find_first_not_of("0123456789") != std::string_view::npos)
    throw ValueError(quoted(text) + " is not an EPSG code", "Write for example EPSG:25833.");
  s.build.crs = "EPSG:" + std::string(code);
}

const std::vector<std::pair<std::string, base::ProgressStyle>> kProgressStyles = {
    {"auto", base::ProgressStyle::automatic},
    {"bar", base::ProgressStyle::bar},
    {"plain", base::ProgressStyle::plain},
    {"none", base::ProgressStyle::none}};
const std::vector<std::pair<std::string, base::LogFormat>> kLogFormats = {{"text", base::LogFormat::text},
                                                                          {"json", base::LogFormat::json}};

template <class T>
std::string name_of(const std::vector<std::pair<std::string, T>>& choices, T value) {
  for (const auto& [name, v] : choices)
    if (v == value) return name;
  return {};
}

template <class T>
std::vector<std::string> names_of(const std::vector<std::pair<std::string, T>>& choices) {
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) names.push_back(name);
  return names;
}

// ---- the table

/// Adds options one by one; `field` gives the place of a value in Settings.
class Table {
 public:
  template <class Field>
  void text(Option o, Field field) {
    o.set = [field](Settings& s, const std::string& text) { field(s) = text; };
    o.show = [field](const Settings& s) { return std::string(field(s)); };
    rows_.push_back(std::move(o));
  }
  template <class Field>
  void flag(Option o, Field field) {
    o.type = OptionType::flag;
    o.set = [field](Settings& s, const std::string& text) { field(s) = text == "true"; };
    o.show = [field](const Settings& s) { return field(s) ? "true" : "false"; };
    rows_.push_back(std::move(o));
  }
  template <class Field>
  void integer(Option o, Field field) {
    o.type = OptionType::integer;
    const Option range = o;
    o.set = [field, range](Settings& s, const std::string& text) {
      using T = std::remove_reference_t<decltype(field(s))>;
      T value{};
      parse_in_range(range, text, "whole number");
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc() || end != text.data() + text.size())
        throw ValueError(quoted(text) + " is not a whole number", range_remedy(range, "whole number"));
      field(s) = value;
    };
    o.show = [field](const Settings& s) { return std::to_string(field(s)); };
    rows_.push_back(std::move(o));
  }
  template <class Field>
  void number(Option o, Field field) {
    o.type = OptionType::number;
    const Option range = o;
    o.set = [field, range](Settings& s, const std::string& text) { field(s) = parse_in_range(range, text, "number"); };
    o.show = [field](const Settings& s) -> std::string {
      const auto& value = field(s);
      if constexpr (std::same_as<std::remove_cvref_t<decltype(value)>, std::optional<double>>)
        return value ? shortest(*value) : "";
      else
        return shortest(value);
    };
    rows_.push_back(std::move(o));
  }
  void other(Option o, std::function<void(Settings&, const std::string&)> set,
             std::function<std::string(const Settings&)> show) {
    o.set = std::move(set);
    o.show = std::move(show);
    rows_.push_back(std::move(o));
  }
  std::vector<Option> take() { return std::move(rows_); }

 private:
  std::vector<Option> rows_;
};

#define FIELD(path) \
  [](auto& s) -> auto& { return s.path; }

void add_build(Table& t) {
  constexpr auto S = Section::build;
  constexpr unsigned both = kBuild | kInfo;
  t.text({.name = "INPUT",
          .key = "input",
          .argument = "FILE",
          .type = OptionType::path,
          .section = S,
          .commands = both,
          .help = "OSM extract: .osm, .osm.pbf, .osm.gz or .osm.bz2",
          .if_missing = "no INPUT is given: name an OSM extract."},
         FIELD(build.input));
  t.text({.name = "FOLDER",
          .argument = "FOLDER",
          .type = OptionType::folder,
          .section = S,
          .commands = kExplain | kValidate,
          .help = "what 'blockrand build' wrote",
          .if_missing = "no FOLDER is given: name the output folder of a build."},
         FIELD(folder));
  t.other({.name = "ACTION",
           .argument = "ACTION",
           .section = S,
           .commands = kDistricts,
           .help = "check, show or diff",
           .if_missing = "no ACTION is given: check, show or diff.",
           .choices = {"check", "show", "diff"}},
          [](Settings& s, const std::string& text) {
            s.action = choose<std::string>(text, {{"check", "check"}, {"show", "show"}, {"diff", "diff"}});
          },
          [](const Settings& s) { return s.action; });
  t.other({.name = "FILE",
           .argument = "FILE",
           .type = OptionType::path,
           .section = S,
           .commands = kDistricts,
           .help = "check: rule sets, without any those that came with the program; show: an extract; diff: two rule sets and an extract",
           .several = true},
          [](Settings& s, const std::string& text) { s.files.push_back(text); },
          [](const Settings& s) { return s.files.empty() ? "" : fmt::format("{}", fmt::join(s.files, " ")); });
  t.other({.name = "TASK",
           .argument = "TASK",
           .section = S,
           .commands = kGrammar,
           .help = "check, run, test or import",
           .if_missing = "no TASK is given: check, run, test or import.",
           .choices = {"check", "run", "test", "import"}},
          [](Settings& s, const std::string& text) {
            s.task = choose<std::string>(
                text, {{"check", "check"}, {"run", "run"}, {"test", "test"}, {"import", "import"}});
          },
          [](const Settings& s) { return s.task; });
  t.other({.name = "RULES",
           .argument = "RULES",
           .type = OptionType::path,
           .section = S,
           .commands = kGrammar,
           .help = "check, test: rule files; run: one; import: a file of facade rules in XML",
           .several = true,
           .if_missing = "no RULES are given: name rule files."},
          [](Settings& s, const std::string& text) { s.rule_files.push_back(text); },
          [](const Settings& s) { return s.rule_files.empty() ? "" : fmt::format("{}", fmt::join(s.rule_files, " ")); });
  t.other({.name = "roots",
           .argument = "LIST",
           .type = OptionType::list,
           .section = S,
           .commands = kGrammar,
           .help = "folders, separated by commas, in which imported files are looked for besides the importing file's; "
                   "/PREFIX=FOLDER: where paths that begin with /PREFIX lie"},
          [](Settings& s, const std::string& text) {
            s.rule_roots.clear();
            for (std::size_t at = 0; at <= text.size();) {
              const std::size_t end = std::min(text.find(',', at), text.size());
              if (end > at) s.rule_roots.push_back(text.substr(at, end - at));
              at = end + 1;
            }
          },
          [](const Settings& s) { return fmt::format("{}", fmt::join(s.rule_roots, ",")); });
  t.text({.name = "lot",
          .argument = "WxD",
          .section = S,
          .commands = kGrammar,
          .help = "run: the rectangle that the rules begin with, width and depth in metres, such as 20x12"},
         FIELD(rule_lot));
  t.number({.name = "storeys",
            .argument = "N",
            .section = S,
            .commands = kGrammar,
            .minimum = 0,
            .maximum = 200,
            .help = "run: building.storeys and building__levels"},
            FIELD(rule_storeys));
  t.other({.name = "attr",
           .argument = "NAME=VALUE",
           .section = S,
           .commands = kGrammar,
           .help = "run: value of an attribute, or of what the program gives (building.height); several times",
           .several = true},
          [](Settings& s, const std::string& text) {
            const std::size_t equals = text.find('=');
            if (equals == std::string::npos || equals == 0)
              throw ValueError(fmt::format("'{}' is no NAME=VALUE", text), "For example: height=12");
            s.rule_attributes.push_back(text);
          },
          [](const Settings& s) { return fmt::format("{}", fmt::join(s.rule_attributes, " ")); });
  t.text({.name = "rule",
          .argument = "NAME",
          .section = S,
          .commands = kGrammar,
          .help = "run: where to begin; else the rule file's own start rule"},
         FIELD(start_rule));
  t.flag({.name = "tree",
          .section = S,
          .commands = kGrammar,
          .help = "run: print all shapes, not only the leaves' number"},
         FIELD(rule_tree));
  t.text({.name = "ID",
          .argument = "ID",
          .section = S,
          .commands = kExplain,
          .help = "of the building: w123 for way 123, r45 for relation 45",
          .if_missing = "no ID is given: name a building, for example w123."},
         FIELD(id));
  t.text({.name = "output",
          .letter = "o",
          .key = "output",
          .argument = "FOLDER",
          .type = OptionType::folder,
          .section = S,
          .commands = kBuild | kCompare | kDistricts | kGrammar,
          .help = "folder that is written; it appears when everything in it is complete; districts diff, grammar run, grammar import: a file",
          .if_missing = "no output folder is given: name one with --output FOLDER.",
          .optional_for = kCompare | kDistricts | kGrammar},
         FIELD(build.output));
  t.other(
      {.name = "formats",
       .key = "formats",
       .argument = "LIST",
       .type = OptionType::list,
       .section = S,
       .help = "what is written, separated by commas: gltf (3D Tiles with GLB; also called tileset, 3dtiles), citygml, cityjson, "
               "gpkg (GeoPackage; also called geopackage)",
       .choices = format_names()},
      set_formats, show_formats);
  t.integer({.name = "lod",
             .key = "lod",
             .argument = "N",
             .section = S,
             .minimum = 0,
             .maximum = 3,
             .help = "highest level of detail: 0 footprints, 1 blocks, 2 roofs, 3 facades with windows and doors"},
            FIELD(build.lod));
  t.other({.name = "instancing",
           .key = "instancing",
           .argument = "HOW",
           .type = OptionType::text,
           .section = S,
           .help = "how GLBs of level 3 hold windows and ornaments: ext stores each once and places it (EXT_mesh_gpu_instancing), nodes "
                   "makes a node of each place for programs without that, baked makes triangles of all",
           .choices = names_of(kInstancings)},
          [](Settings& s, const std::string& text) { s.build.instancing = choose(text, kInstancings); },
          [](const Settings& s) { return name_of(kInstancings, s.build.instancing); });
  t.other({.name = "compress",
           .key = "compress",
           .argument = "HOW",
           .type = OptionType::text,
           .section = S,
           .help = "how GLBs are compressed: none, or meshopt (EXT_meshopt_compression), a third of the size, for viewers that can decompress "
                   "it",
           .choices = names_of(kCompressions)},
          [](Settings& s, const std::string& text) { s.build.compression = choose(text, kCompressions); },
          [](const Settings& s) { return name_of(kCompressions, s.build.compression); });
  t.other(
      {.name = "bbox",
       .key = "bbox",
       .argument = "W,S,E,N",
       .type = OptionType::list,
       .section = S,
       .commands = both | kDistricts,
       .help = "only what lies in this box: west,south,east,north in degrees"},
      [](Settings& s, const std::string& text) { s.build.bbox = parse_bbox(text); },
      [](const Settings& s) { return show_bbox(s.build.bbox); });
  t.text({.name = "tile",
          .argument = "LEVEL/X/Y",
          .section = S,
          .help = "build this tile alone, from what lies within 3 km of it: the same as in a build of the whole; needs --pinned"},
         FIELD(build.tile));
  t.text({.name = "pinned",
          .argument = "BUILD.JSON",
          .type = OptionType::path,
          .section = S,
          .help = "with --tile: build.json of a build of the whole extract, whose CRS and coverage are taken"},
         FIELD(build.pinned));
  t.other({.name = "crs",
           .key = "crs",
           .argument = "EPSG:CODE",
           .section = S,
           .commands = both | kCompare | kDistricts,
           .help = "projected coordinate system in metres; else ETRS89/UTM in Europe and WGS 84/UTM elsewhere; compare: else "
                   "that of the reference"},
          set_crs, [](const Settings& s) { return s.build.crs; });
  t.text({.name = "districts",
          .key = "districts",
          .argument = "NAME",
          .section = S,
          .commands = kBuild | kDistricts,
          .help = "district rules for everything: the name of a rule set in configs/districts/, or a file; else each place's own"},
         FIELD(build.districts));
  t.text({.name = "overrides",
          .key = "overrides",
          .argument = "FILE",
          .type = OptionType::path,
          .section = S,
          .commands = kBuild | kDistricts,
          .help = "corrections by OSM id, stronger than every tag (docs/districts.md)"},
         FIELD(build.overrides));
  t.other({.name = "by",
           .argument = "WHAT",
           .section = S,
           .commands = kDistricts,
           .help = "districts show: what the map is coloured by, preset or rule",
           .choices = {"preset", "rule"}},
          [](Settings& s, const std::string& text) { s.map_by = choose<std::string>(text, {{"preset", "preset"}, {"rule", "rule"}}); },
          [](const Settings& s) { return s.map_by; });
  t.text({.name = "terrain",
          .key = "terrain",
          .argument = "RASTER",
          .type = OptionType::path,
          .section = S,
          .help = "ground heights: any raster that GDAL reads"},
         FIELD(build.terrain));
  t.text({.name = "terrain-height-reference",
          .key = "terrain_height_reference",
          .argument = "REFERENCE",
          .section = S,
          .help = "what the raster's heights are above, where it does not say so itself: sea-level (taken for EGM96), "
                  "ellipsoid, or a vertical coordinate system such as EPSG:7837"},
         FIELD(build.terrain_height_reference));
  t.number({.name = "ground-height",
            .key = "ground_height",
            .argument = "METRES",
            .section = S,
            .minimum = -500,
            .maximum = 9000,
            .help = "height of the ground where there is no terrain, in m: above sea level, or beside --terrain in the raster's heights"},
           FIELD(build.ground_height));
  t.flag({.name = "evidence",
          .key = "evidence",
          .section = S,
          .help = "GLB, CityGML and CityJSON also say why each attribute has its value (explain/ always does)"},
         FIELD(build.evidence));
  t.flag({.name = "gzip", .key = "gzip", .section = S, .help = "compress the CityGML and CityJSON files (.gml.gz, .city.jsonl.gz)"},
         FIELD(build.gzip));
  t.flag({.name = "single-glb",
          .key = "single_glb",
          .section = S,
          .help = "also write model.glb: the whole build in one frame"},
         FIELD(build.single_glb));
  t.flag({.name = "single-cityjson",
          .key = "single_cityjson",
          .section = S,
          .help = "also write model.city.json: the whole build as one CityJSON object"},
         FIELD(build.single_cityjson));
  t.flag({.name = "report",
          .key = "report",
          .section = S,
          .help = "write report.html: what was built, where values come from, a map and pictures",
          .without = "no report.html, the page with what was built, where values come from, a map and pictures; no plan.png"},
         FIELD(build.report));
  t.flag({.name = "explain",
          .key = "explain",
          .section = S,
          .help = "write explain/, from which 'blockrand explain' tells why a building looks as it does",
          .without = "no explain/: 'blockrand explain' cannot tell why a building of this build looks as it does"},
         FIELD(build.explain));
  t.integer({.name = "seed",
             .key = "seed",
             .argument = "N",
             .section = S,
             .commands = kBuild | kCompare | kDistricts | kGrammar,
             .minimum = 0,
             .maximum = kMaxSeed,
             .help = "of all random choices; the same seed gives the same bytes"},
            FIELD(build.seed));
  t.integer({.name = "jobs",
             .letter = "j",
             .key = "jobs",
             .argument = "N",
             .section = S,
             .commands = both | kValidate | kCompare | kDistricts,
             .minimum = 0,
             .maximum = 1024,
             .help = "worker threads; 0 is one per core"},
            FIELD(build.jobs));
  t.flag({.name = "strict",
          .key = "strict",
          .section = S,
          .help = "exit with code 3 when a building is simpler than asked or has no solid"},
         FIELD(build.strict));
  t.text({.name = "configs",
          .key = "configs",
          .argument = "DIR",
          .type = OptionType::folder,
          .section = S,
          .commands = kBuild | kDistricts,
          .help = "folder with defaults/ and materials/; else the configs/ that came with the program"},
         FIELD(build.configs));
  t.flag({.name = "force", .section = S, .commands = kBuild | kCompare | kDistricts | kGrammar, .help = "replace an existing build, comparison, map or file"},
         FIELD(build.force));
  t.text({.name = "config",
          .argument = "FILE.toml",
          .type = OptionType::path,
          .section = S,
          .help = "read options from this file; the command line is stronger"},
         FIELD(config));
  t.text({.name = "extract",
          .argument = "FILE",
          .type = OptionType::path,
          .section = S,
          .commands = kValidate,
          .help = "the extract that the build was made from, where it is no longer where build.json says"},
         FIELD(validation.extract));
  t.text({.name = "schemas",
          .argument = "FOLDER",
          .type = OptionType::folder,
          .section = S,
          .commands = kValidate,
          .help = "also check CityGML against the OGC schemas here: citygml2.xsd, and catalog.xml that says where the others are"},
         FIELD(validation.schemas));
  t.integer({.name = "sample",
             .argument = "N",
             .section = S,
             .commands = kValidate,
             .minimum = 1,
             .maximum = 1000000,
             .help = "read only every Nth tile; counts are then not compared"},
            FIELD(validation.sample));
  t.flag({.name = "edges",
          .section = S,
          .commands = kExplain,
          .help = "list the walls as well: what each faces, how long it is, where it looks"},
         FIELD(edges));
  t.flag({.name = "style",
          .section = S,
          .commands = kExplain,
          .help = "list everything that spoke for or against its style, not the weightiest alone"},
         FIELD(style));
  t.flag({.name = "json", .section = S, .commands = kInfo | kExplain | kValidate | kCompare, .help = "print JSON"}, FIELD(json));
}

void add_repair(Table& t) {
  constexpr auto S = Section::repair;
  const auto metres = [&t](std::string_view name, std::string_view key, double minimum, double maximum,
                           std::string_view help, auto field) {
    t.number({.name = name,
              .key = key,
              .argument = "METRES",
              .section = S,
              .minimum = minimum,
              .maximum = maximum,
              .help = help},
             field);
  };
  t.flag({.name = "repair-simplify",
          .key = "simplify",
          .section = S,
          .help = "remove points on straight walls",
          .without = "points on straight walls stay"},
         FIELD(build.repair.simplify));
  t.flag({.name = "repair-share-walls",
          .key = "share_walls",
          .section = S,
          .help = "join walls of neighbours that almost meet",
          .without = "gaps between neighbours stay as mapped"},
         FIELD(build.repair.share_walls));
  t.flag({.name = "repair-resolve-overlaps",
          .key = "resolve_overlaps",
          .section = S,
          .help = "buildings that overlap at one level give way to each other",
          .without = "overlaps of neighbours stay"},
         FIELD(build.repair.resolve_overlaps));
  t.flag({.name = "repair-settle-coverings",
          .key = "settle_coverings",
          .section = S,
          .help = "settle houses mapped twice, and outlines around mapped houses",
          .without = "houses mapped twice are built twice"},
         FIELD(build.repair.settle_coverings));
  t.flag({.name = "repair-square",
          .key = "square",
          .section = S,
          .help = "make almost right corners right",
          .without = "almost right corners stay as mapped"},
         FIELD(build.repair.square));
  t.flag({.name = "repair-fit-parts",
          .key = "fit_parts",
          .section = S,
          .help = "fit parts to their repaired outline; build what they leave of it",
          .without = "parts stay as mapped, what they leave of an outline is not built"},
         FIELD(build.repair.fit_parts));
  t.flag({.name = "repair-arcs",
          .key = "arcs",
          .section = S,
          .help = "record rounded walls as arcs",
          .without = "rounded walls are not recorded; what repair does to them stays the same"},
         FIELD(build.repair.arcs));
  metres("repair-duplicate-distance", "duplicate_distance", 0, 0.5, "nearer neighbours on a ring are one point, in m",
         FIELD(build.repair.duplicate_distance));
  metres("repair-spike-width", "spike_width", 0, 1, "a tip narrower than this is removed, in m",
         FIELD(build.repair.spike_width));
  t.number({.name = "repair-min-piece-area",
            .key = "min_piece_area",
            .argument = "M2",
            .section = S,
            .minimum = 0,
            .maximum = 100,
            .help = "smaller pieces of a repaired outline are dropped and reported, in m2"},
           FIELD(build.repair.min_piece_area));
  t.number({.name = "repair-max-ring-area-change",
            .key = "max_ring_area_change",
            .argument = "SHARE",
            .section = S,
            .minimum = 0,
            .maximum = 1,
            .help = "of the area, by mending invalid rings; more is reported"},
           FIELD(build.repair.max_ring_area_change));
  metres("repair-ring-clearance", "ring_clearance", 0.002, 0.5, "rings that touch are moved apart by this, in m",
         FIELD(build.repair.ring_clearance));
  metres("repair-collinear-distance", "collinear_distance", 0, 0.5,
         "a point nearer to the wall through its neighbours is no corner, in m", FIELD(build.repair.collinear_distance));
  metres("repair-snap-distance", "snap_distance", 0, 2, "walls of neighbours at this mean distance are one, in m",
         FIELD(build.repair.snap_distance));
  metres("repair-snap-reach", "snap_reach", 0, 3, "... and at this distance at their ends, in m", FIELD(build.repair.snap_reach));
  t.number({.name = "repair-snap-angle",
            .key = "snap_angle",
            .argument = "RADIANS",
            .section = S,
            .minimum = 0,
            .maximum = 0.5,
            .help = "steeper pairs of walls are corners, not one wall"},
           FIELD(build.repair.snap_angle));
  metres("repair-min-overlap", "min_overlap", 0, 10, "shorter contacts stay two walls, in m", FIELD(build.repair.min_overlap));
  metres("repair-max-shift", "max_shift", 0, 2, "no corner moves farther by sharing and squaring, in m",
         FIELD(build.repair.max_shift));
  t.number({.name = "repair-max-area-change",
            .key = "max_area_change",
            .argument = "SHARE",
            .section = S,
            .minimum = 0,
            .maximum = 1,
            .help = "of the area, by sharing and squaring; more is undone"},
           FIELD(build.repair.max_area_change));
  t.number({.name = "repair-min-overlap-area",
            .key = "min_overlap_area",
            .argument = "M2",
            .section = S,
            .minimum = 0,
            .maximum = 100,
            .help = "larger overlaps of neighbours are resolved or reported, in m2"},
           FIELD(build.repair.min_overlap_area));
  t.number({.name = "repair-max-loss",
            .key = "max_loss",
            .argument = "SHARE",
            .section = S,
            .minimum = 0,
            .maximum = 1,
            .help = "of its area that a building may lose to a neighbour it overlaps"},
           FIELD(build.repair.max_loss));
  t.number({.name = "repair-parts-free-area",
            .key = "parts_free_area",
            .argument = "M2",
            .section = S,
            .minimum = 0,
            .maximum = 100000,
            .help = "what parts leave of an outline is built when it is larger than this, in m2"},
           FIELD(build.repair.parts_free_area));
  metres("repair-parts-free-width", "parts_free_width", 0, 100, "... and wider than this, in m",
         FIELD(build.repair.parts_free_width));
}

void add_generate(Table& t) {
  constexpr auto S = Section::generate;
  const auto metres = [&t](std::string_view name, std::string_view key, double minimum, double maximum,
                           std::string_view help, auto field) {
    t.number({.name = name,
              .key = key,
              .argument = "METRES",
              .section = S,
              .minimum = minimum,
              .maximum = maximum,
              .help = help},
             field);
  };
  metres("generate-neighbour-reach", "neighbour_reach", 0, 1000,
         "tagged neighbours within this speak for an untagged building, in m", FIELD(build.generate.neighbour_reach));
  t.integer({.name = "generate-neighbour-minimum",
             .key = "neighbour_minimum",
             .argument = "N",
             .section = S,
             .minimum = 1,
             .maximum = 1000,
             .help = "fewer tagged neighbours say nothing"},
            FIELD(build.generate.neighbour_minimum));
  metres("generate-min-wall-height", "min_wall_height", 0.05, 10,
         "a roof never comes nearer to the building's underside, in m", FIELD(build.generate.min_wall_height));
  metres("generate-max-usual-roof-height", "max_usual_roof_height", 1, 50, "roofs that no tag measures are no higher, in m",
         FIELD(build.generate.max_usual_roof_height));
  metres("generate-min-roof-height", "min_roof_height", 0.01, 10, "a lower pitched roof is a flat one, in m",
         FIELD(build.generate.min_roof_height));
  t.number({.name = "generate-max-roof-pitch",
            .key = "max_roof_pitch",
            .argument = "DEGREES",
            .section = S,
            .minimum = 5,
            .maximum = 89,
            .help = "steeper inferred roofs are limited to this, in degrees"},
           FIELD(build.generate.max_roof_pitch));
  metres("generate-canopy-thickness", "canopy_thickness", 0.05, 5,
         "slab of building=roof where no roof height is tagged, in m", FIELD(build.generate.canopy_thickness));
  metres("generate-collinear-tolerance", "collinear_tolerance", 0, 0.5,
         "plan points nearer to the line of their neighbours do not make a wall, in m",
         FIELD(build.generate.collinear_tolerance));
  metres("generate-simplify-tolerance", "simplify_tolerance", 0, 2,
         "second try for a plan whose solid fails its check, in m", FIELD(build.generate.simplify_tolerance));
}

const std::vector<std::pair<std::string, importers::reference::AxisOrder>> kAxisOrders = {
    {"auto", importers::reference::AxisOrder::automatic},
    {"east-first", importers::reference::AxisOrder::east_first},
    {"north-first", importers::reference::AxisOrder::north_first}};
const std::vector<std::pair<std::string, compare::Align>> kAligns = {{"none", compare::Align::none},
                                                                     {"horizontal", compare::Align::horizontal},
                                                                     {"vertical", compare::Align::vertical},
                                                                     {"both", compare::Align::both}};
const std::vector<std::pair<std::string, compare::Heights>> kHeights = {{"auto", compare::Heights::automatic},
                                                                        {"own-ground", compare::Heights::own_ground},
                                                                        {"absolute", compare::Heights::absolute}};

georef::Geodetic parse_origin(const std::string& text) {
  const std::string remedy = "Write longitude,latitude in degrees and height in m above the ellipsoid: 13.404,52.536,80.";
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 3) throw ValueError(quoted(text) + " does not have three numbers", remedy);
  const georef::Geodetic origin{parse_number(parts[0], remedy), parse_number(parts[1], remedy),
                                parse_number(parts[2], remedy)};
  if (std::abs(origin.lon) > 180 || std::abs(origin.lat) > 90) throw ValueError(quoted(text) + " is no place", remedy);
  return origin;
}

std::string show_origin(const std::optional<georef::Geodetic>& o) {
  return o ? fmt::format("{},{},{}", shortest(o->lon), shortest(o->lat), shortest(o->height)) : "";
}

/// "2%", "2 %" or "2" → 0.02.
double parse_percent(const std::string& text) {
  const std::string remedy = "Write for example 2%.";
  std::string_view number = text;
  if (number.ends_with('%')) number.remove_suffix(1);
  while (number.ends_with(' ')) number.remove_suffix(1);
  const double percent = parse_number(number, remedy);
  if (percent < 0 || percent > 1000) throw ValueError(quoted(text) + " is out of range", remedy);
  return percent / 100;
}

/// What a user may know about either model beyond what its files say.
template <class Field>
void add_reading(Table& t, std::string_view crs, std::string_view axes, std::string_view origin,
                 std::string_view crs_help, std::string_view axes_help, std::string_view origin_help, Field field) {
  constexpr auto S = Section::compare;
  t.text({.name = crs, .argument = "EPSG:CODE", .section = S, .commands = kCompare, .help = crs_help},
         [field](auto& s) -> auto& { return field(s).reference_crs; });
  t.other({.name = axes,
           .argument = "ORDER",
           .section = S,
           .commands = kCompare,
           .help = axes_help,
           .choices = names_of(kAxisOrders)},
          [field](Settings& s, const std::string& text) { field(s).axis_order = choose(text, kAxisOrders); },
          [field](const Settings& s) { return name_of(kAxisOrders, field(s).axis_order); });
  t.other({.name = origin,
           .argument = "LON,LAT,H",
           .type = OptionType::list,
           .section = S,
           .commands = kCompare,
           .help = origin_help},
          [field](Settings& s, const std::string& text) { field(s).gltf_origin = parse_origin(text); },
          [field](const Settings& s) { return show_origin(field(s).gltf_origin); });
}

void add_compare(Table& t) {
  constexpr auto S = Section::compare;
  t.text({.name = "MODEL",
          .argument = "PATH",
          .type = OptionType::path,
          .section = S,
          .commands = kCompare,
          .help = "what is judged: a build's folder, or any file or folder as REFERENCE",
          .if_missing = "no MODEL is given: name a build or model files."},
         FIELD(comparison.model));
  t.other({.name = "REFERENCE",
           .argument = "PATH",
           .type = OptionType::path,
           .section = S,
           .commands = kCompare,
           .help = "what it is judged by, one or more: CityGML, CityJSON, glTF, a tileset, or a folder with any of them",
           .several = true,
           .if_missing = "no REFERENCE is given: name at least one file or folder to compare with."},
          [](Settings& s, const std::string& text) { s.comparison.reference.push_back(text); },
          [](const Settings& s) {
            return s.comparison.reference.empty() ? "" : fmt::format("{}", fmt::join(s.comparison.reference, " "));
          });
  t.other({.name = "align",
           .argument = "WHAT",
           .section = S,
           .commands = kCompare,
           .help = "which offset between the models is taken off before measuring: none (it is reported only), horizontal, "
                   "vertical or both",
           .choices = names_of(kAligns)},
          [](Settings& s, const std::string& text) { s.comparison.align = choose(text, kAligns); },
          [](const Settings& s) { return name_of(kAligns, s.comparison.align); });
  t.other({.name = "heights",
           .argument = "WHICH",
           .section = S,
           .commands = kCompare,
           .help = "own-ground: above each building's own ground; absolute: as they stand in the files; auto: absolute where "
                   "both models say that theirs are above the same sea level or ellipsoid",
           .choices = names_of(kHeights)},
          [](Settings& s, const std::string& text) { s.comparison.heights = choose(text, kHeights); },
          [](const Settings& s) { return name_of(kHeights, s.comparison.heights); });
  t.integer({.name = "max-lod",
             .argument = "N",
             .section = S,
             .commands = kCompare,
             .minimum = 1,
             .maximum = 4,
             .help = "of each building the highest level of detail up to this one is compared"},
            FIELD(comparison.max_lod));
  t.number({.name = "reach",
            .argument = "METRES",
            .section = S,
            .commands = kCompare,
            .minimum = 0,
            .maximum = 100000,
            .help = "buildings farther than this from all of the other model's are no part of the comparison, in m"},
           FIELD(comparison.reach));
  t.integer({.name = "samples",
             .argument = "N",
             .section = S,
             .commands = kCompare,
             .minimum = 100,
             .maximum = 10000000,
             .help = "places on the surface of each side of a match from which distances are measured, about"},
            FIELD(comparison.surface.samples));
  add_reading(t, "model-crs", "model-axis-order", "model-origin",
              "the model's coordinate system, where its files state none or a wrong one",
              "which coordinate comes first in the model's files: auto, east-first or north-first",
              "where a model as glTF has its origin, if the file does not say: degrees, m above the ellipsoid",
              [](auto& s) -> auto& { return s.comparison.model_read; });
  add_reading(t, "reference-crs", "reference-axis-order", "reference-origin",
              "the reference's coordinate system, where its files state none or a wrong one",
              "which coordinate comes first in the reference's files: auto, east-first or north-first",
              "where a reference as glTF has its origin, if the file does not say: degrees, m above the ellipsoid",
              [](auto& s) -> auto& { return s.comparison.reference_read; });
  t.integer({.name = "pictures",
             .argument = "N",
             .section = S,
             .commands = kCompare,
             .minimum = 0,
             .maximum = 100000,
             .help = "so many matches get pictures in compare.html, those that differ most first"},
            FIELD(comparison_report.pictures));
  t.text({.name = "baseline",
          .argument = "COMPARE.JSON",
          .type = OptionType::path,
          .section = S,
          .commands = kCompare,
          .help = "an earlier comparison's compare.json: every measure is set against it"},
         FIELD(baseline));
  t.other({.name = "fail-if-worse",
           .argument = "PERCENT",
           .section = S,
           .commands = kCompare,
           .help = "exit with code 3 when a measure is worse than in --baseline by more than this: 2%"},
          [](Settings& s, const std::string& text) { s.fail_if_worse = parse_percent(text); },
          [](const Settings& s) { return s.fail_if_worse ? shortest(*s.fail_if_worse * 100) + "%" : ""; });
}

void add_messages(Table& t) {
  constexpr auto S = Section::messages;
  constexpr unsigned all = kBuild | kInfo | kValidate | kCompare | kDistricts | kGrammar;
  t.other(
      {.name = "progress",
       .argument = "STYLE",
       .section = S,
       .commands = all,
       .help = "auto (bar on a terminal, else plain), bar, plain (lines) or none",
       .choices = names_of(kProgressStyles)},
      [](Settings& s, const std::string& text) { s.progress = choose(text, kProgressStyles); },
      [](const Settings& s) { return name_of(kProgressStyles, s.progress); });
  t.other(
      {.name = "log-format",
       .argument = "FORMAT",
       .section = S,
       .commands = all,
       .help = "messages, progress and the summary as text or as json lines",
       .choices = names_of(kLogFormats)},
      [](Settings& s, const std::string& text) { s.log_format = choose(text, kLogFormats); },
      [](const Settings& s) { return name_of(kLogFormats, s.log_format); });
  t.flag({.name = "quiet", .letter = "q", .section = S, .commands = all, .help = "warnings and errors only"},
         FIELD(quiet));
}

#undef FIELD

}  // namespace

std::string_view name(Section section) {
  constexpr std::string_view names[] = {"build", "repair", "generate", "compare", "messages"};
  return names[static_cast<int>(section)];
}

std::string_view title(Section section) {
  constexpr std::string_view titles[] = {"What is built", "How far repair may go", "What generation assumes",
                                         "How models are compared", "Messages"};
  return titles[static_cast<int>(section)];
}

const std::vector<Option>& options() {
  static const std::vector<Option> all = [] {
    Table table;
    add_build(table);
    add_repair(table);
    add_generate(table);
    add_compare(table);
    add_messages(table);
    return table.take();
  }();
  return all;
}

std::string_view name(Commands command) {
  switch (command) {
    case kBuild: return "build";
    case kInfo: return "info";
    case kExplain: return "explain";
    case kValidate: return "validate";
    case kCompare: return "compare";
    case kDistricts: return "districts";
    case kGrammar: return "grammar";
  }
  return "";
}

std::string default_text(const Option& option) {
  static const Settings fresh;
  return option.type == OptionType::flag ? "" : option.show(fresh);
}

std::string range_text(const Option& option) {
  if (option.type != OptionType::integer && option.type != OptionType::number) return "";
  if (option.maximum >= 1e15) return fmt::format("from {}", option.minimum);
  return fmt::format("{} to {}", option.minimum, option.maximum);
}

bool on_by_default(const Option& option) {
  static const Settings fresh;
  return option.type == OptionType::flag && option.show(fresh) == "true";
}

std::string shown_name(const Option& option) {
  if (option.positional()) return std::string(option.name);
  return (on_by_default(option) ? "--no-" : "--") + std::string(option.name);
}

std::string_view shown_help(const Option& option) { return on_by_default(option) ? option.without : option.help; }

}  // namespace blockrand::settings
