// The way of a build: read, choose the frame, cut into tiles, work on tiles in parallel, write documents, publish.
#include "pipeline/run/build.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "importers/elevation/terrain.h"
#include "pipeline/base/error.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/publish.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/text.h"
#include "pipeline/context/blocks.h"
#include "pipeline/context/tagged_neighbours.h"
#include "pipeline/attributes/defaults.h"
#include "pipeline/attributes/resolve.h"
#include "pipeline/geometry/polygon.h"
#include "pipeline/georef/projection.h"
#include "pipeline/georef/round_trip.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/footprints/area.h"
#include "pipeline/attributes/assign_extract.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/outputs/geopackage/context_layers.h"
#include "pipeline/run/documents.h"
#include "pipeline/context/ground.h"
#include "pipeline/context/height_reference.h"
#include "pipeline/footprints/load.h"
#include "pipeline/run/outcome.h"
#include "pipeline/outputs/report/pictures.h"
#include "pipeline/outputs/plan/plan_picture.h"
#include "pipeline/run/prepare_extract.h"
#include "pipeline/run/region_facts.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/run/report_facts.h"
#include "pipeline/attributes/rule_book.h"
#include "pipeline/attributes/tagged_buildings.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/outputs/statistics.h"
#include "pipeline/context/surroundings_finder.h"
#include "pipeline/run/tile_choice.h"
#include "pipeline/run/tile_output.h"
#include "pipeline/run/tile_stages.h"
#include "pipeline/footprints/repair/kept_nodes.h"

namespace blockrand::run {

namespace {

using model::Extract;
using model::IssueCode;
using model::MappedBuilding;
using model::ObjectKind;
using model::ObjectState;
using model::Region;

std::uint64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::uint64_t current_rss_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t total = 0, resident = 0;
  statm >> total >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

bool is_building(const MappedBuilding& b) { return b.kind == ObjectKind::building; }

// ---- one tile -------------------------------------------------------------------------------------------------------

/// After its table of evidence became the end of a larger one.
void move_evidence(model::Building& building, model::EvidenceId offset) {
  const auto move = [offset](model::Attributes& a) {
    model::for_each_attribute(
        a,
        [offset](std::string_view, std::string_view, auto& value) {
          if (value.evidence != 0) value.evidence += offset;
        },
        [](std::string_view, std::string_view) {});
  };
  move(building.attributes);
  for (model::BuildingPart& part : building.parts) move(part.attributes);
}

/// Where the line stands that explains an object.
struct ExplainedObject {
  model::OsmId object, building;
  model::TileId tile;
  friend auto operator<=>(const ExplainedObject&, const ExplainedObject&) = default;
};

std::optional<model::Point2> place_of(const Extract& extract, const MappedBuilding& b, const georef::Projection& projection) {
  const std::optional<model::Location> place = b.rings.count > 0 ? footprints::box_centre(extract, b) : b.place;
  if (!place) return std::nullopt;
  const model::Point2 p = projection.forward(*place);
  if (!std::isfinite(p.x) || !std::isfinite(p.y)) return std::nullopt;
  return model::snap(p);
}

/// What the importer or the tiles said about objects that end as reported.
using ReportedDetails = std::map<std::pair<model::OsmId, IssueCode>, std::string>;
ReportedDetails reported_details(const std::vector<model::ReportRow>& rows) {
  ReportedDetails details;
  for (const model::ReportRow& row : rows)
    if (info(row.code).issue_class == model::IssueClass::reported) details.emplace(std::pair(row.object, row.code), row.detail);
  return details;
}

void add_reported(outputs::GeoPackageWriter& out, const Extract& extract, const std::vector<model::ReportRow>& rows,
                  const georef::Projection& projection) {
  const ReportedDetails details = reported_details(rows);
  for (const MappedBuilding& b : extract.buildings) {
    if (b.state == ObjectState::modelled) continue;
    outputs::GeoPackageReported object;
    object.id = b.id;
    object.kind = b.kind;
    object.state = b.state;
    object.code = b.code;
    if (const auto found = details.find({b.id, b.code}); found != details.end()) object.detail = found->second;
    if (b.state != ObjectState::reported) object.related = b.related;
    object.place = place_of(extract, b, projection);
    out.add_reported(object);
  }
}

std::string explain_index(std::vector<ExplainedObject> objects) {
  std::sort(objects.begin(), objects.end());
  std::string text;
  for (const ExplainedObject& o : objects)
    text += outputs::index_line(o.object, fmt::format("{}_{}_{}", o.tile.level, o.tile.x, o.tile.y), o.building);
  return text;
}

struct TileResult {
  Outcomes outcomes;
  std::vector<model::ReportRow> rows;
  TileOutput output;
  outputs::TileStatistics statistics;
  outputs::ReportTile report;
  outputs::PictureTile picture;
  picture::PlanTile plan;
  Region region;  ///< kept only for files of the whole build
};

/// Rough size of the output, from builds of whole cities; with a reserve of a quarter.
std::uint64_t estimated_bytes(const BuildOptions& options, std::uint64_t buildings) {
  constexpr double kGmlBytes[] = {2500, 5500, 12500, 120000};  // per building and level of detail
  constexpr double kGlbBytes = 3000;
  const auto lod = static_cast<std::size_t>(std::clamp(options.lod, 0, 3));
  constexpr double kJsonBytes[] = {1500, 2000, 3500, 3500};
  constexpr double kGeoPackageBytes = 4800, kExplainBytes = 2100, kReportBytes = 150;
  double each = 300;
  if (options.citygml) each += options.gzip ? kGmlBytes[lod] / 7 : kGmlBytes[lod];
  if (options.cityjson) each += options.gzip ? kJsonBytes[lod] / 5 : kJsonBytes[lod];
  if (options.single_cityjson) each += kJsonBytes[lod];
  if (options.geopackage) each += kGeoPackageBytes;
  if (options.explain) each += kExplainBytes;
  if (options.report) each += kReportBytes;
  if (options.gltf) each += kGlbBytes;
  if (options.single_glb) each += kGlbBytes;
  return static_cast<std::uint64_t>(1.25 * each * static_cast<double>(buildings)) + 1'000'000;
}

InputFile input_file(std::string role, const std::string& path) {
  InputFile f{std::move(role), path, 0, base::sha256_file(path)};
  f.bytes = std::filesystem::file_size(path);
  return f;
}

}  // namespace

BuildSummary build(const BuildOptions& options, base::Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  BuildRecord record;
  BuildSummary& summary = record.summary;

  // Everything that can be refused without reading the extract is refused first.
  base::StagedFolder folder(options.output, options.force);
  const attributes::Defaults defaults = attributes::read_defaults(options.configs);
  std::optional<importers::elevation::Terrain> terrain;
  const context::AskedReference asked = context::read_height_reference(options.terrain_height_reference);
  if (!options.terrain.empty()) terrain.emplace(options.terrain, asked.metres_per_unit);
  if (terrain) record.terrain = terrain->describe();
  record.heights = context::choose_height_reference(terrain ? &terrain->describe() : nullptr, asked, options.ground_height.has_value());
  const std::optional<TileChoice> tile = choose_tile(options);

  const classify::Tables tables = classify::Tables::read(options.configs);
  attributes::ReadRuleBook rules = attributes::read_rule_book(options.configs, options.districts);
  std::optional<facades::GrammarBook> grammars;
  if (options.lod >= 3) grammars.emplace(facades::read_grammars(options.configs, rules.book.presets));
  attributes::Overrides overrides;
  if (!options.overrides.empty()) {
    attributes::OverrideNames names{{}, rules.book.substyles};
    for (const districts::Preset& p : rules.book.presets) names.presets.push_back(p.name);
    overrides = attributes::read_overrides(options.overrides, defaults, names);
  }

  LocatedExtract located = locate_extract(options, tile, progress);
  Extract& extract = located.extract;
  const std::optional<footprints::Area>& area = located.area;
  const georef::Projection& projection = located.projection;
  record.inputs.push_back(input_file("extract", options.input));
  if (terrain) record.inputs.push_back(input_file("terrain", options.terrain));
  // Where configs lie differs between installations; what they say does not.
  std::vector<std::pair<std::string, std::string>> configs = {
      {"defaults/uses.toml", options.configs + "/defaults/uses.toml"},
      {"materials/materials.toml", options.configs + "/materials/materials.toml"}};
  for (const char* name : classify::kTableFiles) configs.emplace_back(std::string("styles/") + name, options.configs + "/styles/" + name);
  configs.insert(configs.end(), rules.files.begin(), rules.files.end());
  if (grammars)
    for (const std::string& path : grammars->files()) configs.emplace_back("grammars/" + std::filesystem::path(path).filename().string(), path);
  for (const auto& [name, path] : configs) {
    record.inputs.push_back(input_file("config", path));
    record.inputs.back().path = name;
  }
  if (!options.overrides.empty()) record.inputs.push_back(input_file("overrides", options.overrides));
  record.data_time = extract.data_time;
  record.counts = extract.counts;
  record.crs = located.crs;
  record.portable = projection.portable();
  record.round_trip = located.round_trip;
  const georef::LonLat centre = located.facts.centre;

  if (area && !terrain && !options.ground_height)
    progress.warn("no --terrain and no --ground-height: the model lies at ellipsoid height 0");
  if (area)
    for (const std::string& warning : record.heights.warnings) progress.warn(warning);

  const int workers = base::worker_count(options.jobs);
  model::Report region_report;
  attributes::apply_overrides(overrides, extract, region_report);
  // A tile alone does not see what lies elsewhere: the build of the whole tells what matches nothing.
  if (tile) region_report.rows.clear();
  if (!region_report.rows.empty())
    progress.warn(fmt::format("{}: {} of {} entries match nothing in the extract, the first in {}; report.json lists them",
                              options.overrides, region_report.rows.size(), overrides.entries.size(), region_report.rows.front().detail));
  PreparedExtract prepared = prepare_extract(located, options, tile, tables, rules.book, progress);
  const std::vector<footprints::Shard>& shards = prepared.shards;
  region_report.append(std::move(prepared.report));
  const repair::KeptNodes& kept = prepared.kept;
  const footprints::RepairedExtract& repaired = prepared.repaired;
  const context::ContextExtract& context = prepared.context;
  record.repair = repaired.totals;
  record.facts = located.facts;
  const context::SurroundingsFinder surroundings(extract, repaired.footprints, context);
  const footprints::RoofLineFinder roof_lines(extract, projection);
  const footprints::BuildingNumbers numbers(repaired.footprints);
  const context::TaggedNeighbours neighbours(attributes::tagged_buildings(extract, defaults, projection), options.generate.neighbour_reach);
  const attributes::DistrictAssigner assigner(rules.book, {extract, repaired.footprints, context, prepared.styles, projection, defaults, neighbours,
                                               options.generate.neighbour_minimum, &overrides, located.facts.areas, options.seed});
  if (!tile) {  // a tile alone does not see what lies elsewhere
    record.facts.areas = assigner.to_pin();
    for (const std::string& what : assigner.unanswered()) progress.warn(what);
  }
  const std::vector<std::size_t> todo = shards_to_build(shards, tile);

  std::uint64_t to_build = 0;
  for (const std::size_t shard : todo) to_build += shards[shard].seeds.size();
  const std::uint64_t wanted = estimated_bytes(options, to_build), free = folder.free_bytes();
  if (wanted > free)
    throw base::OutputError(fmt::format("{}: about {} needed, {} free. Free some space, choose another disk with -o, fewer --formats or --gzip",
                                        options.output, base::with_byte_unit(wanted), base::with_byte_unit(free)));

  summary.store_bytes = current_rss_bytes();
  const std::size_t in_flight = static_cast<std::size_t>(workers) * 2 + 2;
  const OutputContext output{options, projection, record, defaults};

  std::optional<outputs::GeoPackageWriter> geopackage;
  if (options.geopackage) geopackage.emplace(folder.staging_path() + "/buildings.gpkg", geopackage_options(output));
  std::optional<base::StagedFile> cityjson_file;
  std::optional<outputs::SingleCityJson> single_cityjson;
  if (options.single_cityjson) {
    cityjson_file.emplace(folder.create("model.city.json"));
    single_cityjson.emplace(cityjson_options(output, "Blockrand"), [&](std::string_view bytes) { cityjson_file->append(bytes); });
  }

  const outputs::PicturePlan picture_plan = options.report ? outputs::plan_pictures(shards, projection) : outputs::PicturePlan{};
  outputs::Pictures pictures(picture_plan);
  const outputs::PlanChoice plan_choice = options.report ? outputs::choose_plan(shards, projection, picture_plan) : outputs::PlanChoice{};
  std::vector<picture::PlanTile> plans;
  outputs::ReportBuilder page;

  progress.begin("tiles", to_build, "buildings");
  std::vector<TileResult> slots(in_flight);
  std::vector<model::ReportRow> rows = std::move(region_report.rows);
  rows.insert(rows.end(), std::make_move_iterator(extract.report.rows.begin()), std::make_move_iterator(extract.report.rows.end()));
  // Objects whose outline lacks members: where the rest encloses nothing, that is the reason.
  std::set<model::OsmId> incomplete;
  for (const model::ReportRow& row : rows)
    if (row.code == IssueCode::members_missing) incomplete.insert(row.object);
  std::sort(rows.begin(), rows.end());
  const std::vector<model::ReportRow> earlier = rows;
  std::vector<outputs::TileEntry> tiles;
  std::vector<ExplainedObject> explained;
  std::vector<outputs::PartySide> party_sides;
  std::vector<masses::SlopeEnd> slope_ends;
  Region whole;  // for --single-glb
  std::uint64_t done = 0;

  const context::Ground ground(terrain ? &*terrain : nullptr, options.ground_height, projection);
  const auto ground_under = [&](const model::Building& building) { return ground.under(building); };

  const auto fate_of = [&](const Outcome& o) {
    // Where members of a relation are missing, that is why nothing is enclosed.
    const bool no_area = o.code == IssueCode::zero_area || o.code == IssueCode::too_few_points;
    const bool lacks_members = no_area && incomplete.contains(extract.buildings[o.index].id);
    return outputs::Fate{o.state, lacks_members ? IssueCode::missing_members : o.code, o.related};
  };
  const auto explain_options = [&](const std::vector<Outcome>& outcomes) {
    outputs::ExplainOptions explain;
    explain.lod = options.lod;
    explain.earlier = earlier;
    if (grammars)
      explain.rule_file = [&grammars](std::string_view preset) -> std::string {
        const facades::GrammarBook::Entry* entry = grammars->find(preset);
        return entry ? entry->file : std::string();
      };
    explain.courtyard = [&context](std::string_view id) -> std::optional<outputs::CourtyardFacts> {
      const auto found = std::lower_bound(context.courtyards.begin(), context.courtyards.end(), id,
                                          [](const context::ExtractCourtyard& y, std::string_view i) { return y.courtyard.id < i; });
      if (found == context.courtyards.end() || found->courtyard.id != id) return std::nullopt;
      return outputs::CourtyardFacts{found->courtyard.area, found->courtyard.closed};
    };
    std::map<std::uint32_t, outputs::Fate> fates;
    for (const Outcome& o : outcomes) fates[o.index] = fate_of(o);
    explain.fate = [fates = std::move(fates)](std::uint32_t index) {
      const auto found = fates.find(index);
      return found == fates.end() ? outputs::Fate{} : found->second;
    };
    return explain;
  };

  std::atomic<std::int64_t> context_time = 0;
  const evidence::StyleInputs style_inputs{prepared.facts, prepared.tags, prepared.styles, tables};
  const TileInputs inputs{extract,      shards,         projection, defaults,      kept,
                          repaired,     context,        surroundings, roof_lines,  numbers, neighbours, assigner, overrides, style_inputs, options.explain,
                          options.repair, options.generate, options.seed, options.lod, grammars ? &*grammars : nullptr, terrain.has_value(), ground_under,
                          context_time};
  const auto work = [&](std::size_t i) {
    TileResult result;
    const std::size_t shard = todo[i];
    Region region = run_tile(shard, inputs);
    result.outcomes = decide_outcomes(region, options.lod);
    result.statistics = outputs::count_statistics(region);
    result.output = write_tile(region, output, explain_options(result.outcomes.list), folder);
    if (options.report) {
      result.report = outputs::report_tile(region);
      result.picture = outputs::picture_tile(region, picture_plan, shard);
      if (plan_choice.chosen[shard]) result.plan = picture::plan_tile(region);
    }
    result.rows = std::move(region.report.rows);
    if (options.single_glb || options.single_cityjson) result.region = std::move(region);
    slots[i % in_flight] = std::move(result);
  };
  const auto consume = [&](std::size_t i) {
    TileResult result = std::move(slots[i % in_flight]);
    for (const Outcome& o : result.outcomes.list) {
      MappedBuilding& object = extract.buildings[o.index];
      const outputs::Fate fate = fate_of(o);
      object.state = fate.state;
      object.code = fate.code;
      object.related = fate.related;
      if (o.state == ObjectState::modelled) ++summary.models_by_lod[static_cast<std::size_t>(std::clamp(o.lod, 0, 3))];
    }
    std::move(result.rows.begin(), result.rows.end(), std::back_inserter(rows));
    if (result.output.tile) tiles.push_back(*result.output.tile);
    if (geopackage && result.output.rows.buildings.rows() > 0) {
      geopackage->add(result.output.rows);
      geopackage->add_tile(geopackage_tile(shards[todo[i]].tile, result.output, output));
    }
    std::move(result.output.files.begin(), result.output.files.end(), std::back_inserter(record.files));
    if (single_cityjson) single_cityjson->add(result.region);
    if (options.report) {
      page.add(std::move(result.report));
      pictures.add(std::move(result.picture));
      if (!result.plan.buildings.empty()) plans.push_back(std::move(result.plan));
    }
    for (const auto& [object, building] : result.output.explained) explained.push_back({object, building, shards[todo[i]].tile});
    const std::vector<outputs::PartySide>& sides = result.statistics.party_sides;
    party_sides.insert(party_sides.end(), sides.begin(), sides.end());
    slope_ends.insert(slope_ends.end(), result.statistics.slope_ends.begin(), result.statistics.slope_ends.end());
    outputs::add(record.statistics, result.statistics.sums);
    summary.below_quality = summary.below_quality || result.outcomes.below_quality;
    if (options.single_glb) {
      whole.extract = &extract;
      whole.materials = std::move(result.region.materials);
      if (options.evidence) {
        const model::EvidenceId offset = whole.evidence.append(std::move(result.region.evidence));
        for (model::Building& b : result.region.buildings) move_evidence(b, offset);
      }
      // Placements count the elements of their tile.
      const auto elements = static_cast<std::uint32_t>(whole.elements.size());
      std::move(result.region.elements.begin(), result.region.elements.end(), std::back_inserter(whole.elements));
      for (model::Building& b : result.region.buildings)
        for (model::BuildingPart& part : b.parts)
          for (model::Placement& p : part.lod3.placements) p.element += elements;
      std::move(result.region.buildings.begin(), result.region.buildings.end(), std::back_inserter(whole.buildings));
    }
    done += shards[todo[i]].seeds.size();
    progress.advance_to(done);
  };
  base::ordered_parallel(todo.size(), workers, in_flight, work, consume);
  outputs::settle_party_walls(std::move(party_sides), record.statistics);
  masses::settle_slope_ends(slope_ends, record.statistics.roofscape);
  summary.roofscape = record.statistics.roofscape;
  if (tile) forget_others(extract, tile->id, rows);
  summary.buildings_in = static_cast<std::uint64_t>(std::count_if(extract.buildings.begin(), extract.buildings.end(), is_building));
  summary.parts_in = extract.buildings.size() - summary.buildings_in;

  progress.begin("documents");
  if (const double reach = write_whole(whole, tiles, centre, output, folder, record.files); reach > kFineModelRadius)
    progress.warn(fmt::format("model.glb reaches {:.0f} km from its origin: far from there its vertices are more than 4 mm coarse. "
                              "Use tileset.json, or a --bbox",
                              reach / 1000));
  if (options.explain) record.files.push_back(folder.write("explain/index.txt", explain_index(std::move(explained))));
  for (const MappedBuilding& b : extract.buildings) {
    switch (b.state) {
      case ObjectState::modelled: ++summary.models; break;
      case ObjectState::duplicate: ++summary.duplicates; break;
      case ObjectState::represented: ++summary.represented; break;
      case ObjectState::pending:
      case ObjectState::reported: ++summary.reported;
    }
    if (b.state == ObjectState::reported) ++summary.issues[std::string(info(b.code).text)];
  }
  std::sort(rows.begin(), rows.end());
  for (const model::ReportRow& row : rows)
    if (info(row.code).issue_class != model::IssueClass::reported) ++summary.issues[std::string(info(row.code).text)];
  record.files.push_back(folder.write("report.json", report_json(extract, rows)));
  if (geopackage) {
    add_reported(*geopackage, extract, rows, projection);
    outputs::write_context_layers(*geopackage, context, repaired, shards, tile ? std::optional(tile->id) : std::nullopt);
    geopackage->close();
    record.files.push_back(folder.adopt("buildings.gpkg"));
  }
  if (single_cityjson) {
    single_cityjson->finish();
    record.files.push_back(cityjson_file->close());
  }
  const auto sort_files = [&] {
    std::sort(record.files.begin(), record.files.end(),
              [](const base::PublishedFile& a, const base::PublishedFile& b) { return a.path < b.path; });
  };
  sort_files();
  if (options.report) {
    outputs::PlanSheet plan = outputs::draw_plan(std::move(plans), context, plan_choice);
    if (!plan.png.empty()) record.files.push_back(folder.write("plan.png", plan.png));
    sort_files();
    outputs::ReportFacts facts = report_facts(options, record, extract, rows, page, centre);
    if (!plan.png.empty()) facts.context.plan = std::move(plan.in_report);
    facts.context.plan_note = std::move(plan.note);
    facts.pictures_note = pictures.note();
    facts.pictures = pictures.take(workers);
    record.files.push_back(folder.write("report.html", page.html(facts)));
    sort_files();
  }
  folder.write("build.json", build_json(options, record));
  for (const base::PublishedFile& f : record.files) summary.bytes += f.bytes;
  summary.files = record.files.size() + 2;
  progress.end();

  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  summary.peak_rss_bytes = peak_rss_bytes();
  RunRecord run;
  run.timings = progress.times();
  run.seconds = summary.seconds;
  run.peak_rss_bytes = summary.peak_rss_bytes;
  run.store_bytes = summary.store_bytes;
  run.tiles_in_flight = summary.tiles_in_flight = std::min<std::uint64_t>(in_flight, todo.size());
  run.tile_context_seconds = 1e-9 * static_cast<double>(context_time.load());
  run.jobs = workers;
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  run.host = host;
  folder.write("run.json", run_json(run, summary));
  if (const std::string left = folder.publish(); !left.empty()) progress.warn("the old build could not be removed: " + left);
  return summary;
}

}  // namespace blockrand::run
