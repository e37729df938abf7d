#include "pipeline/run/tile_key.h"

#include <fmt/format.h>
#include <link.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <utility>

#include "importers/imagery/image_files.h"
#include "pipeline/base/error.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/version.h"
#include "pipeline/gdal/gdal_library.h"
#include "pipeline/georef/proj_library.h"
#include "pipeline/model/osm_keys.h"
#include "pipeline/run/configuration.h"

namespace blockrand::run {
namespace {

using base::Packer;
using model::MappedBuilding;

/// m. Walls of neighbours that are party walls lie nearer (WallSegmentOptions::touching).
constexpr double kTouching = 1;
/// m. How far plans may lie outside the box of a repaired outline: repair moves no corner by more (RepairOptions::max_shift).
constexpr double kBoxSlack = 5;

void pack_tags(const model::Extract& extract, model::Range range, Packer& out) {
  out << range.count;
  for (const model::Tag& tag : extract.tags_of(range))
    out << extract.strings.view(tag.key) << extract.strings.view(tag.value);
}

/// An object as it was mapped. \param kept  nodes that stay on straight walls
void pack_mapped(const model::Extract& extract, const MappedBuilding& object, const repair::KeptNodes& kept,
                 Packer& out) {
  // Not `state`, `code` and `related`: what becomes of objects is noted while tiles run. Those of a tile are pending when it
  // begins.
  static_assert(base::field_count<MappedBuilding>() == 11, "a new field belongs here");
  model::MappedAttributes attributes = object.attributes;
  attributes.wall_material = attributes.roof_material = attributes.use = 0;
  out << object.id << object.kind << object.geometry_from << object.place << object.edited << attributes;
  for (const base::StringId text :
       {object.attributes.wall_material, object.attributes.roof_material, object.attributes.use})
    out << extract.strings.view(text);
  pack_tags(extract, object.tags, out);
  out << object.rings.count;
  for (const model::MappedRing& ring : extract.rings_of(object.rings)) {
    out << ring.inner << extract.vertices_of(ring) << extract.nodes_of(ring);
    if (!extract.mapped_vertices.empty()) out << extract.mapped_vertices_of(ring);
    for (const std::int64_t node : extract.nodes_of(ring)) out << kept.contains(node);
  }
}

void pack_rows(std::span<const model::ReportRow> rows, model::OsmId id, Packer& out) {
  const auto [first, last] = std::equal_range(rows.begin(), rows.end(), model::ReportRow{id, {}, {}},
                                              [](const auto& a, const auto& b) { return a.object < b.object; });
  out << std::span<const model::ReportRow>(first, last);
}

void pack_requirements(const districts::Preset& preset, Packer& out) {
  out << preset.requirements.has_value();
  if (!preset.requirements) return;
  const districts::PresetRequirements& r = *preset.requirements;
  out << r.upper_storeys << r.upper_windows_from << r.door_height << r.window_ratio << r.ground_window_ratio
      << r.gable_window_ratio << r.windows_in_line << r.gable_windows_smaller << r.ornamental_gable << r.gable_overtop
      << r.roof_shapes << r.roof_element_width << r.roof_element_distance << r.roof_eaves_distance
      << r.roof_side_distance;
}

}  // namespace

struct TileKeys::Impl {
  const TileInputs& in;
  std::string shared;
  std::span<const model::ReportRow> earlier;
  std::span<const std::unique_ptr<outputs::Output>> outputs;
  std::map<std::string, std::string, std::less<>> grammars;  ///< hash of the rule files, by preset
  const facades::GrammarLibrary* library = nullptr;          ///< null: there are no facades
  const surroundings::SurroundingsFinder* around_houses = nullptr;

  void pack_rules(std::string_view preset, Packer& out) const {
    const auto rules = grammars.find(preset);
    out << (rules != grammars.end());
    if (rules != grammars.end()) out << rules->second;
  }

  void pack_mapped_objects(const footprints::Seed& seed, Packer& out) const {
    const model::Extract& extract = in.extract;
    const auto object = [&](std::uint32_t index) {
      const MappedBuilding& mapped = extract.buildings[index];
      pack_mapped(extract, mapped, in.kept, out);
      pack_rows(earlier, mapped.id, out);
      const attributes::OverrideEntry* order = in.overrides.find(mapped.id);
      if (order) out << *order;
      // Presets that tags and orders name, of buildings and parts.
      const std::string* ordered = order ? order->text("preset") : nullptr;
      for (const std::string_view name : {extract.tag(mapped.tags, model::osm_key::kPreset),
                                          ordered ? std::string_view(*ordered) : std::string_view()})
        if (!name.empty()) pack_rules(name, out);
    };
    out << (seed.outline != model::kNoIndex);
    if (seed.outline != model::kNoIndex) object(seed.outline);
    out << static_cast<std::uint64_t>(seed.parts.size());
    for (const std::uint32_t part : seed.parts) object(part);
  }

  void pack_outline(std::uint32_t number, Packer& out) const {
    footprints::StoredFootprint stored = in.repaired.footprints[number];
    stored.lead = 0, stored.rings = {}, stored.arcs = {};
    out << stored << in.repaired.footprints.polygons(number) << in.repaired.footprints.arcs(number);
    pack_rows(in.repaired.rows, stored.id, out);
  }

  void pack_class(std::uint32_t number, Packer& out) const {
    const evidence::StyleInputs& s = in.styles;
    // Of features the answers are packed below; explanations of the style show what it asked.
    const classify::FeatureVector& features = s.facts.features[number];
    out << features.has(classify::Feature::area);
    for (std::size_t f = 0; f < classify::kFeatureCount; ++f)
      if (s.tables.style.asks(f)) out << features.at(f);
    out << s.tags.dates[number] << s.tags.years[number] << s.tags.roofs[number] << s.tags.points_of(number);
    if (const std::int32_t why = s.tags.non_house[number]; why >= 0) {
      const classify::NonHouse& reason = s.tags.reasons[static_cast<std::size_t>(why)];
      out << reason.why;
    }
    out << s.styles.styles[number] << s.styles.storeys[number] << s.styles.roofs[number] << s.styles.dates[number]
        << s.styles.elsewhere[number] << s.styles.region[number];
  }

  /// For the position that was measured: a tile that finds another one is not kept (positions_as_measured).
  void pack_preset(std::uint32_t number, Packer& out) const {
    const model::BuildingPosition position = in.styles.facts.places[number].position;
    districts::Assignment a = in.assigner.assign(number, position);
    const std::uint32_t preset = a.decision.preset;
    // Numbers of sets, rules and presets are those of this run's files.
    a.decision.set = a.decision.preset = a.decision.rule = 0;
    a.fired.clear();
    for (districts::Parameter& parameter : a.parameters) parameter.rule = 0;
    out << position << a;
    // What no rule file reads is told.
    for (const districts::Parameter& parameter : a.parameters) out << (library && library->any_reads(parameter.key));
    if (preset == districts::Decision::kNone) return;
    const std::string& name = in.assigner.book().presets[preset].name;
    out << name;
    pack_measures(number, out);
    if (const auto rules = grammars.find(name); rules != grammars.end()) out << rules->second;
  }

  /// Of the preset, what attributes read of it.
  void pack_measures(std::uint32_t number, Packer& out) const {
    const districts::Decision d = in.assigner.decide(number, in.styles.facts.places[number].position);
    const districts::Preset* preset =
        d.preset == districts::Decision::kNone ? nullptr : &in.assigner.book().presets[d.preset];
    out << (preset && preset->measures);
    if (!preset || !preset->measures) return;
    const districts::PresetMeasures& m = *preset->measures;
    out << preset->name << m.ground_floor_height << m.storey_height << m.plinth << m.roof_pitch << m.side_pitches
        << m.gable_to_street;
    out << static_cast<std::uint64_t>(m.roof_shapes.size());
    for (const auto& [shape, share] : m.roof_shapes) out << shape << share;
  }

  /// What the stages up to the attributes see around buildings.
  void pack_around(geometry::PlanBox box, Packer& out) const {
    context::pack(in.vicinity.vicinity_of(box), out);
    box.minimum = {box.minimum.x - kBoxSlack, box.minimum.y - kBoxSlack};
    box.maximum = {box.maximum.x + kBoxSlack, box.maximum.y + kBoxSlack};
    out << in.neighbours.near(box) << in.roof_lines.near(box);
  }
};

TileKeys::TileKeys(const TileInputs& inputs, const BuildInputs& files, const surroundings::SurroundingsFinder* around,
                   std::string shared, std::span<const model::ReportRow> earlier,
                   std::span<const std::unique_ptr<outputs::Output>> outputs)
    : impl_(new Impl{
          inputs, std::move(shared), earlier, outputs, {}, files.grammars ? &*files.grammars : nullptr, around}) {
  std::map<std::string, std::string> hashes;  // by path
  for (const districts::Preset& preset : files.rules.book.presets) {
    if (!files.grammars) break;
    const facades::GrammarLibrary::Entry* entry = files.grammars->find(preset.name);
    if (!entry) continue;
    Packer rules;
    rules << entry->file << preset.attributes;
    pack_requirements(preset, rules);
    for (const std::string& path : files.grammars->files_of(preset.name)) {
      std::string& hash = hashes[path];
      if (hash.empty()) hash = base::sha256_file(path);
      rules << hash;
    }
    impl_->grammars.emplace(preset.name, base::sha256_of(rules.bytes));
  }
}

TileKeys::~TileKeys() = default;

bool positions_as_measured(const model::Region& region, std::uint32_t first, const evidence::FactsExtract& facts) {
  for (std::size_t i = 0; i < region.buildings.size(); ++i) {
    const model::Building& building = region.buildings[i];
    if (building.settled == model::ObjectState::pending &&
        building.situation.position != facts.places[first + i].position)
      return false;
  }
  return true;
}

TileKey TileKeys::key(std::size_t shard, std::size_t place) const {
  const Impl& in = *impl_;
  const TileInputs& tiles = in.in;
  const std::vector<footprints::Seed>& seeds = tiles.shards[shard].seeds;
  const std::uint32_t first = tiles.repaired.first[shard];
  std::array<Packer, kTilePartCount> parts;
  const auto part = [&](TilePart p) -> Packer& { return parts[static_cast<std::size_t>(p)]; };
  part(TilePart::settings) << in.shared << tiles.shards[shard].tile;
  for (const auto& output : in.outputs) part(TilePart::settings) << output->reads_of_tile(place);

  geometry::PlanBox box;
  std::set<std::uint32_t> beside;  // of other tiles, that may share a wall
  for (std::uint32_t i = 0; i < seeds.size(); ++i) {
    in.pack_mapped_objects(seeds[i], part(TilePart::mapped));
    in.pack_outline(first + i, part(TilePart::outlines));
    in.pack_class(first + i, part(TilePart::classification));
    in.pack_preset(first + i, part(TilePart::presets));
    const geometry::PlanBox& own = tiles.repaired.footprints[first + i].box;
    if (own.empty()) continue;
    box.include(own);
    for (const std::uint32_t other : tiles.vicinity.buildings_near(own, kTouching))
      if (other < first || other >= first + seeds.size()) beside.insert(other);
  }
  Packer& around = part(TilePart::surroundings);
  around << static_cast<std::uint64_t>(beside.size());
  for (const std::uint32_t other : beside) {
    const auto after = std::upper_bound(tiles.repaired.first.begin(), tiles.repaired.first.end(), other);
    const auto its = static_cast<std::size_t>(after - tiles.repaired.first.begin()) - 1;
    in.pack_mapped_objects(tiles.shards[its].seeds[other - tiles.repaired.first[its]], around);
    in.pack_outline(other, around);
    in.pack_class(other, around);
    in.pack_measures(other, around);
    box.include(tiles.repaired.footprints[other].box);
  }
  // Mapped parts may stand outside of their outline.
  for (const footprints::Seed& seed : seeds)
    for (const std::uint32_t p : seed.parts)
      for (const model::MappedRing& ring : tiles.extract.rings_of(tiles.extract.buildings[p].rings))
        for (const model::Location v : tiles.extract.vertices_of(ring)) {
          const model::Point2 place = tiles.projection.forward(v);
          if (place.x == place.x && place.y == place.y) box.include(place);
        }
  if (!box.empty()) in.pack_around(box, around);

  if (in.around_houses) in.around_houses->pack(tiles.shards[shard].tile, around);

  TileKey key;
  std::string hashes;
  for (std::size_t i = 0; i < kTilePartCount; ++i) {
    const std::string hash = base::sha256_of(parts[i].bytes);
    key.parts[i] = std::stoull(hash.substr(0, 16), nullptr, 16);
    hashes += hash;
  }
  key.key = base::sha256_of(hashes);
  return key;
}

std::string shared_key(const BuildOptions& options, const BuildInputs& inputs, const BuildRecord& record) {
  Packer out;
  out << program_identity();
  nlohmann::ordered_json settings = configuration(options);
  settings.erase("bbox");  // says which data there are, not what becomes of them
  out << settings.dump();
  // Presets and rules, with the files that rules name, come with what they decide for each building; their grammars and orders by
  // building, too. The catalogue of styles is read by more than rules.
  std::set<std::string> by_building;
  for (const auto& [name, path] : inputs.rules.files)
    if (!name.starts_with("styles/") || name == "styles/presets.toml") by_building.insert(name);
  for (const InputFile& file : record.inputs)
    if (file.role != "overrides" && file.role != "model" && !by_building.contains(file.path) &&
        !file.path.starts_with("grammars/"))
      out << file.role << file.path << file.sha256;
  // Of a terrain all files: a VRT names others, and some lie beside the one that is named.
  if (inputs.terrain)
    for (const importers::imagery::ImageFile& file : importers::imagery::files_of_image(options.terrain))
      out << file.sha256;
  out << inputs.overrides.name << record.crs << record.portable;
  out << record.heights.words << record.heights.vertical_crs << record.heights.in_tiles << record.heights.raised_from
      << record.heights.raised_by.has_value();
  if (record.heights.raised_by)
    out << record.heights.raised_by->undulation(record.facts.centre.lon, record.facts.centre.lat);
  return std::move(out.bytes);
}

const std::string& program_identity() {
  static const std::string identity = [] {
    base::Sha256 hash;
    const auto add = [&](const std::filesystem::path& path) {
      struct stat s {};
      if (::stat(path.c_str(), &s) == 0)
        hash.add(fmt::format("{} {} {}.{}\n", path.string(), s.st_size, s.st_mtim.tv_sec, s.st_mtim.tv_nsec));
    };
    try {
      hash.add(base::sha256_file("/proc/self/exe"));
    } catch (const base::InputError&) {
      add("/proc/self/exe");
    }
    // Libraries that it runs with, and PROJ's tables, by size and time of their files. Those that are loaded when they are needed
    // count as well: all runs must say the same.
    gdal::api(), georef::detail::proj();
    std::set<std::string> libraries;  // sorted: which of them was loaded first differs between runs
    ::dl_iterate_phdr(
        [](dl_phdr_info* info, std::size_t, void* data) {
          if (info->dlpi_name != nullptr && *info->dlpi_name != '\0')
            static_cast<std::set<std::string>*>(data)->insert(info->dlpi_name);
          return 0;
        },
        &libraries);
    for (const std::string& library : libraries) add(library);
    const std::array<const char*, 3> places = {std::getenv("PROJ_DATA"), std::getenv("PROJ_LIB"), "/usr/share/proj"};
    for (const char* place : places) {
      std::error_code error;
      std::set<std::filesystem::path> files;
      if (place != nullptr)
        for (std::filesystem::directory_iterator file(place, error), end; !error && file != end; file.increment(error))
          files.insert(file->path());
      for (const std::filesystem::path& file : files) add(file);
    }
    return std::string(base::kVersion) + " " + hash.finish();
  }();
  return identity;
}

}  // namespace blockrand::run
