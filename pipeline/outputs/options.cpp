#include "pipeline/outputs/options.h"

#include <algorithm>

#include "pipeline/base/option.h"
#include "pipeline/outputs/output.h"

namespace blockrand::outputs {
namespace {

using base::choice;
using base::custom;
using base::flag;
using base::integer;
using base::OptionRecord;
using base::OptionType;
using base::RecordValue;
using O = OutputOptions;

/// Every word for a format and the name it stands for; other words stand behind all names.
base::Choices<std::string> format_words() {
  base::Choices<std::string> words;
  for (const std::string& name : format_names()) words.emplace_back(name, name);
  for (const OutputFormat& format : all_outputs())
    for (const std::string_view other : format.other_names) words.emplace_back(other, format.name);
  return words;
}

void set_formats(O& o, const std::string& text) {
  const base::Choices<std::string> words = format_words();
  std::vector<std::string> wanted;
  for (const std::string& part : base::split(text, ',')) wanted.push_back(base::choose(part, words));
  o.formats = format_names();
  std::erase_if(o.formats, [&](const std::string& name) { return std::ranges::find(wanted, name) == wanted.end(); });
}

/// "gltf (3D Tiles with GLB; also called tileset, 3dtiles), citygml"
std::string listed_formats() {
  std::vector<std::string> listed;
  for (const OutputFormat& format : all_outputs()) {
    if (!format.in_formats) continue;
    std::vector<std::string> about;
    if (!format.title.empty()) about.emplace_back(format.title);
    const std::vector<std::string> others(format.other_names.begin(), format.other_names.end());
    if (!others.empty()) about.push_back("also called " + base::joined(others, ", "));
    listed.push_back(std::string(format.name) + (about.empty() ? "" : " (" + base::joined(about, "; ") + ")"));
  }
  return base::joined(listed, ", ");
}

const base::Choices<Instancing> kInstancings = {
    {"ext", Instancing::ext}, {"nodes", Instancing::nodes}, {"baked", Instancing::baked}};

const base::Choices<Objects> kObjects = {{"building", Objects::building}, {"tile", Objects::tile}};

const base::Choices<AttributeProfile> kProfiles = {{"people", AttributeProfile::people},
                                                   {"all", AttributeProfile::all}};

const base::Choices<Compression> kCompressions = {
    {"tiles", Compression::tiles}, {"none", Compression::none}, {"meshopt", Compression::meshopt}};

const base::Choices<CityGmlDetail> kDetails = {{"lean", CityGmlDetail::lean}, {"full", CityGmlDetail::full}};

const base::Choices<TextureChoice> kTextures = {
    {"none", TextureChoice::none}, {"small", TextureChoice::small}, {"shared", TextureChoice::shared}};

const base::Choices<GroundChoice> kGrounds = {{"none", GroundChoice::none}, {"imagery", GroundChoice::imagery}};

// Places in the record: build.json keeps the order of its first versions.

base::OptionTable<O> which_files() {
  static const std::string formats_help = "what is written, separated by commas: " + listed_formats();
  return {
      custom<O>(
          {.name = "formats",
           .key = "formats",
           .argument = "LIST",
           .type = OptionType::list,
           .help = formats_help,
           .choices = format_names(),
           .after = "output",
           .record = OptionRecord::yes,
           .record_place = 2},
          set_formats, [](const O& o) { return base::joined(o.formats, ","); },
          [](const O& o) { return RecordValue(o.formats); }),
      choice({.name = "instancing",
              .key = "instancing",
              .argument = "HOW",
              .help = "how GLBs of level 3 hold windows and ornaments: ext stores each once and places it "
                      "(EXT_mesh_gpu_instancing), nodes makes a node of each place for programs without that, "
                      "baked makes triangles of all",
              .after = "lod",
              .record = OptionRecord::yes,
              .record_place = 7},
             kInstancings, &O::instancing),
      choice({.name = "compress",
              .key = "compress",
              .argument = "HOW",
              .help = "which GLBs are compressed by meshopt (EXT_meshopt_compression), to a fourth of their size: "
                      "tiles, but not model.glb; none, for programs that cannot read it (Blender, QGIS); meshopt, all",
              .record = OptionRecord::yes,
              .record_place = 8},
             kCompressions, &O::compression),
      integer(
          {.name = "max-glb-bytes",
           .key = "max_glb_bytes",
           .argument = "BYTES",
           .minimum = 0,
           .maximum = 4'000'000'000,
           .help = "a tile's GLB that would be larger is cut into quarters, and those again, each a file of its own "
                   "(not the coarser levels of LoD 3, which are small); 0: none is cut",
           .record = OptionRecord::yes,
           .record_place = 17},
          &O::max_glb_bytes),
      choice({.name = "citygml-detail",
              .key = "citygml_detail",
              .argument = "WHAT",
              .help = "what CityGML of level 3 holds: lean has windows and doors as surfaces in the plane of their "
                      "walls, with the depth of reveals as an attribute, and ornaments without pieces under 0.5 m; "
                      "full has reveals as faces and every window, door and ornament as the GLBs have it, three "
                      "times the size",
              .record = OptionRecord::yes,
              .record_place = 15},
             kDetails, &O::citygml_detail)};
}

base::Option<O> ground_pixel_option() {
  base::Option<O> option =
      base::number<O>({.name = "ground-pixel",
                       .key = "ground_pixel",
                       .argument = "METRES",
                       .minimum = 0.05,
                       .maximum = 5,
                       .help = "size of the pixels of --ground imagery; never finer than the finest image, nor "
                               "more than 4096 along a side of a tile's picture",
                       .record = OptionRecord::yes},
                      &O::ground_pixel);
  option.recorded = [recorded = option.recorded](const O& o) {
    return o.ground_pixel == O().ground_pixel ? std::nullopt : recorded(o);
  };
  return option;
}

base::OptionTable<O> what_files_hold() {
  return {
      custom<O>(
          {.name = "textures",
           .key = "textures",
           .argument = "WHICH",
           .help = "what surfaces in GLBs look like from near by: none is their plain colour; shared lays textures of "
                   "plaster, brick, tiles, asphalt and the like on them, in textures/ for all tiles; small has "
                   "half the pixels on each side (docs/textures.md)",
           .choices = {"none", "small", "shared"},
           .record = OptionRecord::yes},
          [](O& o, const std::string& text) { o.textures = base::choose(text, kTextures); },
          [](const O& o) { return base::word_of(kTextures, o.textures); },
          [](const O& o) {
            return o.textures == TextureChoice::none ? std::nullopt
                                                     : std::optional(RecordValue(base::word_of(kTextures, o.textures)));
          }),
      custom<O>(
          {.name = "ground",
           .key = "ground",
           .argument = "WHAT",
           .help = "what the ground is in GLBs: imagery lays the aerial images (--imagery) on it, over the terrain "
                   "where there "
                   "is one, as a picture for each tile, and replaces the ground of --surroundings; none leaves it to "
                   "--surroundings (docs/imagery.md)",
           .choices = {"none", "imagery"},
           .record = OptionRecord::yes},
          [](O& o, const std::string& text) { o.ground = base::choose(text, kGrounds); },
          [](const O& o) { return base::word_of(kGrounds, o.ground); },
          [](const O& o) {
            return o.ground == GroundChoice::none ? std::nullopt
                                                  : std::optional(RecordValue(base::word_of(kGrounds, o.ground)));
          }),
      ground_pixel_option(),
      choice({.name = "attributes",
              .key = "attributes",
              .argument = "WHICH",
              .help = "what GLBs tell of a building: people has rounded values in the order in which people read them, "
                      "with their sources in one line; all has every value with its source and confidence, and the OSM "
                      "tags, as the other formats and explain/ always do",
              .after = "ground-height",
              .record = OptionRecord::yes,
              .record_place = 16},
             kProfiles, &O::profile),
      flag({.name = "evidence",
            .key = "evidence",
            .help = "GLB, CityGML and CityJSON also say why each attribute has its value (explain/ always does)",
            .record = OptionRecord::yes,
            .record_place = 5},
           &O::evidence),
      flag({.name = "gzip",
            .key = "gzip",
            .help = "compress the CityGML and CityJSON files (.gml.gz, .city.jsonl.gz)",
            .record = OptionRecord::yes,
            .record_place = 6},
           &O::gzip),
      flag({.name = "precompress",
            .key = "precompress",
            .help = "tilesets and the GLBs of tiles have a NAME.gz beside them, a third to a half of their size, which "
                    "a web server sends instead where the browser takes it (nginx: gzip_static on; Caddy: "
                    "precompressed gzip)",
            .record = OptionRecord::yes,
            .record_place = 18},
           &O::precompress),
      flag({.name = "single-glb",
            .key = "single_glb",
            .help = "also write model.glb: the whole build in one frame",
            .record = OptionRecord::yes,
            .record_place = 9},
           &O::single_glb),
      choice(
          {.name = "objects",
           .key = "objects",
           .argument = "WHAT",
           .help = "what model.glb is made of: building makes an object of each house, called by its address, with its "
                   "parts below it and windows merged in (with --instancing nodes they are shared meshes); tile puts "
                   "all houses in one mesh, as tiles have them",
           .record = OptionRecord::yes,
           .record_place = 14},
          kObjects, &O::objects),
      flag({.name = "single-cityjson",
            .key = "single_cityjson",
            .help = "also write model.city.json: the whole build as one CityJSON object",
            .record = OptionRecord::yes,
            .record_place = 10},
           &O::single_cityjson),
      flag({.name = "report",
            .key = "report",
            .help = "write report.html: what was built, where values come from, a map and pictures",
            .without = "no report.html, the page with what was built, where values come from, a map and pictures; no "
                       "plan.png, no buildings.csv",
            .record = OptionRecord::yes,
            .record_place = 3},
           &O::report),
      flag({.name = "explain",
            .key = "explain",
            .help = "write explain/, from which 'blockrand explain' tells why a building looks as it does",
            .without = "no explain/: 'blockrand explain' cannot tell why a building of this build looks as it does",
            .record = OptionRecord::yes,
            .record_place = 4},
           &O::explain)};
}

}  // namespace

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const OutputFormat& format : all_outputs())
    if (format.in_formats) names.emplace_back(format.name);
  return names;
}

bool OutputOptions::writes(std::string_view format) const {
  return std::ranges::find(formats, format) != formats.end();
}

std::vector<std::string> unread_options(const OutputOptions& o, int lod) {
  const OutputOptions usual;
  const bool citygml = o.writes("citygml"), cityjson = o.writes("cityjson") || o.single_cityjson;
  const bool gltf = o.writes("gltf"), glb = gltf || o.single_glb, facades = lod >= 3;
  const struct {
    const char* name;
    bool is_asked, is_read;
    const char* where;
  } all[] = {
      {"gzip", o.gzip, citygml || o.writes("cityjson"), "citygml and cityjson"},
      {"precompress", o.precompress, gltf, "gltf"},
      {"evidence", o.evidence, glb || citygml || cityjson, "gltf, citygml and cityjson"},
      {"attributes", o.profile != usual.profile, glb, "gltf"},
      {"compress", o.compression != usual.compression, glb, "gltf"},
      {"textures", o.textures != usual.textures, glb, "gltf"},
      {"ground", o.ground != usual.ground, glb, "gltf"},
      {"instancing", o.instancing != usual.instancing, glb && facades, "gltf, of level 3"},
      {"max-glb-bytes", o.max_glb_bytes != usual.max_glb_bytes, gltf, "gltf"},
      {"citygml-detail", o.citygml_detail != usual.citygml_detail, citygml && facades, "citygml, of level 3"},
      {"objects", o.objects != usual.objects, o.single_glb, "gltf with --single-glb"},
  };
  std::vector<std::string> sentences;
  for (const auto& option : all)
    if (option.is_asked && !option.is_read)
      sentences.push_back("--" + std::string(option.name) + " changes nothing here: it is about the format " +
                          option.where);
  return sentences;
}

base::OptionTable<OutputOptions> output_options() {
  base::OptionTable<OutputOptions> table = base::concatenated({which_files(), what_files_hold()});
  for (base::Option<OutputOptions>& option : table) option.commands |= base::kInfo;  // it tells what they cost
  return table;
}

}  // namespace blockrand::outputs
