// The way of a build: read, choose the frame, cut into tiles, work on tiles in parallel, finish the outputs, publish.
#include "pipeline/run/build.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "pipeline/attributes/assign_extract.h"
#include "pipeline/attributes/tagged_buildings.h"
#include "pipeline/base/error.h"
#include "pipeline/base/heap.h"
#include "pipeline/base/host.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/publish.h"
#include "pipeline/base/text.h"
#include "pipeline/context/ground.h"
#include "pipeline/context/tagged_neighbours.h"
#include "pipeline/context/vicinity_finder.h"
#include "pipeline/footprints/roof_lines.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/outputs/gzip.h"
#include "pipeline/outputs/output.h"
#include "pipeline/outputs/statistics.h"
#include "pipeline/run/account.h"
#include "pipeline/run/area_surroundings.h"
#include "pipeline/run/area_tiles.h"
#include "pipeline/run/before_tiles.h"
#include "pipeline/run/build_areas.h"
#include "pipeline/run/build_inputs.h"
#include "pipeline/run/data_identity.h"
#include "pipeline/run/documents.h"
#include "pipeline/run/estimate.h"
#include "pipeline/run/ground_heights.h"
#include "pipeline/run/imagery_stage.h"
#include "pipeline/run/outcome.h"
#include "pipeline/run/output_place.h"
#include "pipeline/run/prepare_extract.h"
#include "pipeline/run/tile_choice.h"
#include "pipeline/run/tile_key.h"
#include "pipeline/run/tile_stages.h"
#include "pipeline/run/tile_work.h"
#include "pipeline/run/whole_model.h"

namespace blockrand::run {

namespace {

using model::Extract;
using model::Region;

// ---- before the tiles

/// The folder in the making, and how many models the build has that it would replace.
struct Place {
  Place(const BuildOptions& options, base::Progress& progress)
      : folder(checked_output(options), options.force, {.foreign = foreign_files, .counts_only = options.measure}),
        earlier(earlier_models(folder.target_path())) {
    tell_removed(folder, progress);
  }
  base::StagedFolder folder;
  std::optional<std::uint64_t> earlier;
};

/// What reading found, for build.json.
void record_extract(const BuildOptions& options, const BuildInputs& inputs, const LocatedExtract& located,
                    BuildRecord& record) {
  record.inputs = input_files(options, inputs);
  if (inputs.grammars)
    record.element_credits.assign(inputs.grammars->elements().credits().begin(),
                                  inputs.grammars->elements().credits().end());
  if (!record.area) record.data_sha256 = data_sha256(located.extract);
  if (inputs.terrain) record.terrain = inputs.terrain->describe();
  record.heights = inputs.heights;
  record.data_time = located.extract.data_time;
  record.counts = located.extract.counts;
  record.crs = located.crs;
  record.portable = located.projection.portable();
  record.round_trip = located.round_trip;
}

/// What district rules may ask for. \param inputs, located, prepared, neighbours  outlive the result
attributes::AssignInputs assign_inputs(const BuildOptions& options, const BuildInputs& inputs,
                                       const LocatedExtract& located, const PreparedExtract& prepared,
                                       const context::TaggedNeighbours& neighbours) {
  return {.extract = located.extract,
          .footprints = prepared.repaired.footprints,
          .context = prepared.context,
          .styles = prepared.styles,
          .projection = located.projection,
          .defaults = inputs.defaults,
          .neighbours = neighbours,
          .neighbour_minimum = options.generate.neighbour_minimum,
          .overrides = &inputs.overrides,
          .pinned = located.facts.areas,
          .seed = options.seed,
          .facts = &prepared.facts};
}

// ---- the tiles
/// What the tiles add up to, taken in their order.
struct Sums {
  std::vector<outputs::PartySide> party_sides;
  std::vector<masses::SlopeEnd> slope_ends;
  Region whole;  ///< for outputs that keep it

  void take(TileResult&& tile, std::size_t shard, const BuildOptions& options, const OpenOutputs& open,
            Account& account, BuildRecord& record) {
    account.take(tile.outcomes, std::move(tile.rows), record.summary);
    const outputs::FinishedTile taken{.region = tile.region,
                                      .shard = shard,
                                      .name = {},
                                      .has_parts = false,
                                      .final_state = {},
                                      .files = std::move(tile.files)};
    for (std::size_t i = 0; i < open.list.size(); ++i) open.list[i]->take(taken, std::move(tile.products[i]));
    record.files.insert(record.files.end(), taken.files.begin(), taken.files.end());
    party_sides.insert(party_sides.end(), tile.statistics.party_sides.begin(), tile.statistics.party_sides.end());
    slope_ends.insert(slope_ends.end(), tile.statistics.slope_ends.begin(), tile.statistics.slope_ends.end());
    outputs::add(record.statistics, tile.statistics.sums);
    record.surroundings.take(tile.statistics.surroundings);
    if (open.keeps_whole) append_region(whole, std::move(tile.region), options.outputs.evidence);
  }
  void settle(BuildRecord& record) {
    outputs::settle_party_walls(std::move(party_sides), record.statistics,
                                record.area ? &record.summary.open_walls : nullptr);
    masses::settle_slope_ends(slope_ends, record.statistics.roofscape);
    record.summary.roofscape = record.statistics.roofscape;
  }
};

// ---- work of earlier runs
/// Null where none is kept.
std::unique_ptr<WorkCache> open_cache(const BuildOptions& options, const std::optional<TileChoice>& tile, bool part,
                                      base::Progress& progress) {
  if (options.cache.empty()) return nullptr;
  if (tile && !tile->is_area())
    throw base::UsageError("--cache is of no use with --tile: a tile that is built alone keeps no work");
  try {
    return std::make_unique<WorkCache>(options.cache, program_identity(), progress,
                                       options.plan ? WorkCache::Mode::look
                                       : part       ? WorkCache::Mode::part
                                                    : WorkCache::Mode::work,
                                       tile ? outputs::tile_name(tile->id) : std::string());
  } catch (const base::OutputError& error) {
    progress.warn(fmt::format("no work is kept, nor taken from earlier runs: {}", error.what()));
    return nullptr;
  }
}

/// How the stages before the tiles see it.
std::optional<base::Memo> memo_of(WorkCache* cache, const BuildOptions& options, const BuildRecord& record) {
  if (!cache) return std::nullopt;
  base::Packer shared;
  shared << program_identity() << record.crs << record.portable << options.repair;
  return memo_in(*cache, std::move(shared.bytes));
}

/// Whether tiles may be taken from earlier runs, and are kept for later ones.
bool tiles_are_kept(const WorkCache* cache, const BuildInputs& inputs, const OpenOutputs& open,
                    base::Progress& progress) {
  if (!cache) return false;
  const char* why = !inputs.images.empty()                   ? "aerial images are looked at as a whole"
                    : open.takes_regions || open.keeps_whole ? "a file of the whole model needs every tile anew"
                                                             : nullptr;
  if (why) progress.warn(std::string("work on tiles is not kept, nor taken from earlier runs: ") + why);
  return !why;
}

/// What differs from the run before, in words of TilePart; "new" where that had no such tile.
std::vector<std::string_view> why_built(const WorkCache& cache, const std::string& tile, const TileKey& key) {
  const std::optional<std::vector<std::uint64_t>> before = cache.parts_before(tile);
  if (!before || before->size() != kTilePartCount + 1) return {"new"};
  std::vector<std::string_view> why;
  for (std::size_t i = 0; i < kTilePartCount; ++i)
    if ((*before)[i] != key.parts[i]) why.push_back(name(static_cast<TilePart>(i)));
  if (why.empty()) why.emplace_back("not kept");
  return why;
}

/// Parts, and last how long the work took.
void note_tile(WorkCache& cache, const std::string& tile, const TileKey& key, std::uint64_t microseconds) {
  std::vector<std::uint64_t> parts(key.parts.begin(), key.parts.end());
  parts.push_back(microseconds);
  cache.note_parts(tile, parts);
}

/// Buildings that an area works on at a time at LoD3: two of the largest tiles of a dense city. One after the other they take half as long
/// again, and 50 MB less.
constexpr std::size_t kMostBuildingsAtATime = 700;

/// What working on `todo` would do: nothing is worked on.
void plan_tiles(std::span<const TileToTell> todo, const TileKeys* keys, WorkCache* cache, int workers,
                BuildSummary& summary) {
  std::uint64_t known = 0, microseconds = 0;
  for (const TileToTell& tile : todo) {
    const TileKey key = keys && tile.shard ? keys->key(*tile.shard, tile.place) : TileKey();
    if (!tile.shard || (keys && tile_is_kept(key.key, *cache))) {
      ++summary.tiles_kept;
      continue;
    }
    ++summary.tiles_built;
    if (!keys) continue;
    const std::string name = outputs::tile_name(tile.tile);
    for (const std::string_view why : why_built(*cache, name, key)) ++summary.tiles_built_for[std::string(why)];
    if (const auto before = cache->parts_before(name); before && before->size() > kTilePartCount)
      ++known, microseconds += before->back();
  }
  // Tiles that are new take what the others took.
  if (known > 0)
    summary.planned_tile_seconds = 1e-6 * static_cast<double>(microseconds) / static_cast<double>(known) *
                                   static_cast<double>(summary.tiles_built) / workers;
}

void tell_cache(const WorkCache& cache, const BuildOptions& options, BuildSummary& summary, base::Progress& progress) {
  summary.kept_work = cache.used();
  if (cache.damaged() > 0)
    progress.warn(fmt::format("{}: {} pieces of kept work were damaged there and are worked out anew", options.cache,
                              base::with_thousands(cache.damaged())));
  if (const std::string trouble = cache.trouble(); !trouble.empty())
    progress.warn("work could not be kept for the next run: " + trouble);
}

// ---- after the tiles

void warn_of_terrain(const BuildInputs& inputs, base::Progress& progress) {
  if (!inputs.terrain) return;
  if (const auto pixel = inputs.terrain->implausible())
    progress.warn(fmt::format(
        "{}: pixel {},{} holds {:g} m, which is no height on Earth: such pixels count as missing. Declare them with "
        "gdal_edit.py -a_nodata VALUE",
        inputs.terrain->describe().path, pixel->column, pixel->row, pixel->metres));
}

void finish_outputs(const OpenOutputs& open, const Region& whole, const Account& account, BuildRecord& record,
                    base::Progress& progress) {
  const outputs::FinishedBuild finished{
      .counts = record.summary,
      .statistics = record.statistics,
      .whole = whole,
      .rows = account.rows(),
      .files = record.files,
      .warn = [&](const std::string& text) { progress.warn(text); },
      .tell = [&](std::string_view path,
                  std::string figures) { record.summary.figures[std::string(path)] = std::move(figures); }};
  std::uint64_t ready = 0;
  for (const auto& output : open.list) output->begin_finish(finished);
  for (const auto& output : open.list) {
    output->finish(finished);
    progress.advance_to(++ready);
  }
  for (const auto& output : open.list) output->conclude(finished);
  std::ranges::sort(record.files, {}, &base::PublishedFile::path);
  for (const base::PublishedFile& f : record.files) record.summary.bytes += f.bytes;
  record.summary.files = record.files.size() + 2;  // build.json and run.json come last
}

/// Completes the summary; the rest of what differs from run to run.
RunRecord run_record(const BuildOptions& options, std::chrono::steady_clock::time_point start, double context_seconds,
                     int workers, const base::Progress& progress, BuildSummary& summary) {
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  summary.peak_rss_bytes = peak_memory();
  RunRecord run;
  run.timings = progress.times();
  run.seconds = summary.seconds;
  run.peak_rss_bytes = summary.peak_rss_bytes;
  run.store_bytes = summary.store_bytes;
  run.tiles_in_flight = summary.tiles_in_flight;
  run.tile_context_seconds = context_seconds;
  run.jobs = workers;
  if (options.areas == 0) run.inputs = {extract_file(options)};
  run.host = base::host_name();
  return run;
}

void publish(base::StagedFolder& folder, const BuildOptions& options, BuildSummary& summary, base::Progress& progress) {
  summary.folder = options.output;
  if (!summary.unaccounted.empty()) {
    const std::string asked = folder.target_path(), place = folder.publish_beside("unaccounted");
    if (place != asked) summary.folder = place;
  } else if (const std::string left = folder.publish(); !left.empty()) {
    progress.warn("the old build could not be removed: " + left);
  }
}

/// \param part  of a build in areas; null: everything, or what the options choose
BuildSummary build_all_or_part(const BuildOptions& options, const AreaPart* part, base::Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  BuildRecord record;
  BuildSummary& summary = record.summary;

  // Everything that can be refused without reading the extract is refused first.
  progress.begin("check");
  if (!part) warn_of_unread(options, progress);
  if (!options.crs.empty()) georef::check_crs(options.crs);
  Place place(options, progress);
  base::StagedFolder& folder = place.folder;
  BuildInputs inputs(options);
  if (part) inputs.tile = part->choice;
  const std::optional<TileChoice>& tile = inputs.tile;
  const std::unique_ptr<WorkCache> cache = open_cache(options, tile, part != nullptr, progress);
  LocatedExtract located = locate_extract(options, tile, progress, part ? &part->store : nullptr);
  Extract& extract = located.extract;
  const georef::Projection& projection = located.projection;
  if (located.area) warn_of_heights(options, inputs, located.facts.centre, progress);
  ImageryStage imagery(options, inputs, located, progress);

  // The whole extract: footprints, context, evidence.
  if (tile && tile->is_area()) record.area = tile->id;
  record_extract(options, inputs, located, record);
  model::Report report = override_extract(options, inputs, extract, progress);
  const std::optional<base::Memo> memo = memo_of(cache.get(), options, record);
  PreparedExtract prepared = prepare_extract(
      located, options, tile, inputs.tables, inputs.rules.book, progress,
      [&](std::span<const footprints::Shard> shards, const footprints::RepairedExtract& repaired) {
        return imagery.correct(shards, repaired);
      },
      memo ? &*memo : nullptr);
  const std::vector<footprints::Shard>& shards = prepared.shards;
  const footprints::RepairedExtract& repaired = prepared.repaired;
  const context::ContextExtract& context = prepared.context;
  report.append(std::move(prepared.report));
  const context::VicinityFinder vicinity(extract, repaired.footprints, context, prepared.labels.get());
  std::optional<surroundings::SurroundingsFinder> finder;
  if (inputs.surroundings)
    finder.emplace(surroundings::SurroundingInputs{.extract = extract,
                                                   .footprints = repaired.footprints,
                                                   .context = context,
                                                   .vicinity = vicinity,
                                                   .projection = projection,
                                                   .catalogue = *inputs.surroundings},
                   options.surroundings, terrain_height(inputs, projection), options.ground_height.value_or(0),
                   options.seed);
  const surroundings::SurroundingsFinder* around = finder ? &*finder : nullptr;
  // What documents tell: of an area what lies in it, whatever was read around it.
  AreaRecord tiles_here;
  std::optional<AreaAsTold> area;
  if (record.area) {
    report.append(std::move(extract.report));
    tiles_here = record_tiles({.extract = extract,
                               .shards = shards,
                               .repaired = repaired,
                               .context = context,
                               .projection = projection,
                               .rows = report.rows,
                               .area = *tile,
                               .thing_of = inputs.surroundings ? thing_recorder(extract, *inputs.surroundings,
                                                                                options.surroundings, *record.area)
                                                               : nullptr},
                              tile->only ? records_before(*part, cache.get()) : AreaRecord());
    if (cache)
      note_reaches(
          *tile, {located, prepared, inputs.tables, inputs.rules.book, *tile, options.generate.neighbour_reach, around},
          tiles_here);
    area = told_area(tiles_here, located.facts.coverage);
    report.rows = std::move(area->rows);
    record.data_sha256 = area->data_sha256, record.data_time = area->data_time, record.counts = area->counts;
  }
  Extract& told = area ? area->extract : extract;
  const std::vector<footprints::Shard>& told_shards = area ? area->shards : shards;
  record.repair = area ? area->repaired.totals : repaired.totals;
  record.facts = located.facts;
  imagery.tell(record);
  const footprints::RoofLineFinder roof_lines(extract, projection);
  const footprints::BuildingNumbers numbers(repaired.footprints);
  const context::TaggedNeighbours neighbours(attributes::tagged_buildings(extract, inputs.defaults, projection),
                                             options.generate.neighbour_reach);
  const attributes::DistrictAssigner assigner(inputs.rules.book,
                                              assign_inputs(options, inputs, located, prepared, neighbours));
  if (!tile) {  // a tile alone does not see what lies elsewhere
    record.facts.areas = assigner.to_pin();
    for (const std::string& what : assigner.unanswered()) progress.warn(what);
    if (inputs.grammars)
      for (const std::string& what : facades::unread_parameters(inputs.rules.book, *inputs.grammars))
        progress.warn("PARAMETER_UNREAD: " + what);
  }

  const std::vector<std::size_t> looked_into = shards_to_build(shards, tile);
  const std::vector<TileToTell> todo = tiles_to_tell(shards, looked_into, area ? &*area : nullptr, tiles_here);
  std::uint64_t to_build = 0;
  for (const TileToTell& t : todo) to_build += told_shards[t.place].seeds.size();
  if (!options.plan && !options.measure) {
    std::vector<footprints::Shard> here;
    for (const std::size_t shard : looked_into) here.push_back(shards[shard]);
    check_free_space(options, disk_bytes(town_size(extract, here).all, options), folder.free_bytes());
  }
  summary.store_bytes = current_memory();

  // The tiles: every stage, then every output.
  const int workers = base::worker_count(options.jobs);
  const std::size_t in_flight = static_cast<std::size_t>(workers) * (record.area ? 1 : 2) + 2;
  Account account(told, std::move(report.rows));
  outputs::OutputOptions output_options = options.outputs;
  output_options.surroundings = options.surroundings.any();
  output_options.imagery = imagery.observations() != nullptr;
  output_options.imagery_pictures = output_options.imagery && options.outputs.report && !inputs.images.empty() && !tile;
  const outputs::OutputContext output_context{
      .options = output_options,
      .lod = options.lod,
      .name = name_of(options) + (record.area ? ", area " + text_of(*record.area) : ""),
      .folder = folder,
      .projection = projection,
      .crs = record.crs,
      .heights = record.heights,
      .data_time = record.data_time,
      .centre = located.facts.centre,
      .extract = told,
      .shards = told_shards,
      .repaired = area ? area->repaired : repaired,
      .context = area ? area->context : context,
      .imagery = imagery.observations(),
      .images = inputs.images,
      .seen = outputs::seen_outlines(imagery.observations(), repaired.footprints),
      .alone = tile ? std::optional(tile->id) : std::nullopt,
      .earlier = account.earlier(),
      .rule_file = [&](std::string_view preset) { return inputs.rule_file(preset); },
      .surroundings = inputs.surroundings ? &inputs.surroundings->shown() : nullptr,
      .textures = inputs.textures ? &*inputs.textures : nullptr,
      .ground_mesh = ground_mesh_of(options, inputs, projection),
      .workers = workers,
      .memo = memo ? &*memo : nullptr};
  const OpenOutputs open(output_context);
  if (area) note_shown(todo, open, tiles_here);
  // Records are asked for again when the tiles are done; until then they take an eighth of the room. Few tiles need less of it.
  std::string resting;
  if (area && !tile->only) {
    resting = outputs::gzip(base::packed(std::exchange(tiles_here, {})), 1);
    base::give_memory_back();
  }
  const context::Ground ground(inputs.terrain ? &*inputs.terrain : nullptr, options.ground_height, projection);
  std::atomic<std::int64_t> context_time = 0;
  const evidence::StyleInputs style_inputs{prepared.facts, prepared.tags, prepared.styles, inputs.tables};
  const masses::LandmarkModels landmarks = place_landmarks(inputs.landmarks, projection, inputs.defaults);
  const TileInputs tile_inputs{.extract = extract,
                               .shards = shards,
                               .projection = projection,
                               .defaults = inputs.defaults,
                               .kept = prepared.kept,
                               .repaired = repaired,
                               .context = context,
                               .vicinity = vicinity,
                               .roof_lines = roof_lines,
                               .numbers = numbers,
                               .neighbours = neighbours,
                               .assigner = assigner,
                               .overrides = inputs.overrides,
                               .landmarks = landmarks,
                               .styles = style_inputs,
                               .imagery = imagery.observations(),
                               .explain = options.outputs.explain,
                               .repair = options.repair,
                               .generate = options.generate,
                               .seed = options.seed,
                               .lod = options.lod,
                               .grammars = inputs.grammars ? &*inputs.grammars : nullptr,
                               .has_terrain = inputs.terrain.has_value(),
                               .ground = [&](const model::Building& building) { return ground.under(building); },
                               .context_time = context_time};
  std::optional<TileKeys> keys;
  if (tiles_are_kept(cache.get(), inputs, open, progress))
    keys.emplace(tile_inputs, inputs, around, shared_key(options, inputs, record), account.earlier(), open.list);
  if (options.plan) {
    progress.begin("look for kept tiles");
    plan_tiles(todo, keys ? &*keys : nullptr, cache.get(), workers, summary);
    progress.end();
    return summary;
  }
  progress.begin("tiles", to_build, "buildings");
  std::vector<TileResult> slots(in_flight);
  std::map<model::TileId, std::string> keys_here;  ///< of an area, as its records will have them
  Sums sums;
  std::uint64_t done = 0;
  const auto work = [&](std::size_t i) {
    TileResult& slot = slots[i % in_flight];
    const TileToTell& t = todo[i];
    if (!t.shard) {
      std::optional<TileResult> kept = cache ? kept_tile(t.key, open, told, folder, *cache) : std::nullopt;
      if (!kept) throw WindowTooSmall("work on tile " + text_of(t.tile) + " is not kept");
      slot = std::move(*kept);
      cache->keep_note(outputs::tile_name(t.tile));
      return;
    }
    if (!keys) {
      slot = work_on_tile(*t.shard, t.place, tile_inputs, around, open, account, told);
      return;
    }
    const TileKey key = keys->key(*t.shard, t.place);
    const std::string name = outputs::tile_name(t.tile);
    std::optional<TileResult> kept = kept_tile(key.key, open, told, folder, *cache);
    if (kept) {
      slot = std::move(*kept);
    } else {
      slot = work_on_tile(*t.shard, t.place, tile_inputs, around, open, account, told);
      slot.why = why_built(*cache, name, key);
      if (slot.may_be_kept) keep_tile(key.key, slot, open, told, folder.staging_path(), *cache);
    }
    if (slot.may_be_kept) slot.key = key.key;
    note_tile(*cache, name, key, slot.microseconds);
  };
  const auto consume = [&](std::size_t i) {
    TileResult result = std::move(slots[i % in_flight]);
    ++(result.kept ? summary.tiles_kept : summary.tiles_built);
    for (const std::string_view why : result.why) ++summary.tiles_built_for[std::string(why)];
    if (!result.kept)
      note_slow_tile(summary.slowest_tiles,
                     {outputs::tile_name(todo[i].tile), result.microseconds, told_shards[todo[i].place].seeds.size()});
    if (area && todo[i].shard) keys_here[todo[i].tile] = result.key;
    sums.take(std::move(result), todo[i].place, options, open, account, record);
    done += told_shards[todo[i].place].seeds.size();
    progress.advance_to(done);
  };
  // In an area memory is bounded, whatever the number of jobs.
  base::ItemLoad load;
  if (record.area && options.lod >= 3)
    load = {[&](std::size_t i) { return todo[i].shard ? shards[*todo[i].shard].seeds.size() : 0; },
            kMostBuildingsAtATime};
  base::ordered_parallel(todo.size(), workers, in_flight, work, consume, load);
  sums.settle(record);
  warn_of_terrain(inputs, progress);
  // A tile that is built alone tells of what is in it, and no more.
  if (finder && area)
    summary.shared_surroundings = close_surroundings(area->things, record.surroundings);
  else if (finder && !tile)
    record.surroundings.take_elsewhere(extract, *inputs.surroundings, options.surroundings);
  account.close(area ? std::nullopt : tile, shards, looked_into, summary);
  if (!options.measure) refuse_shrunk(options, summary, place.earlier);

  progress.begin("documents", open.list.size() + 2);
  finish_outputs(open, sums.whole, account, record, progress);
  if (cache && part && !part->record_key.empty()) {
    if (!resting.empty()) tiles_here = base::unpacked<AreaRecord>(outputs::gunzip(std::exchange(resting, {})));
    for (auto& [tile, key] : keys_here) tiles_here[tile].key = std::move(key);
    cache->keep(kRecords, part->record_key, base::packed(tiles_here), {}, {});
    if (record.area->level >= kCoarsestReaches)
      cache->keep(kReaches, part->record_key, base::packed(reaches_in(tiles_here)), {}, {});
  }
  if (cache) tell_cache(*cache, options, summary, progress);
  folder.write("build.json", build_json(options, record));
  progress.end();

  summary.tiles_in_flight = std::min<std::uint64_t>(in_flight, todo.size());
  const double context_seconds = 1e-9 * static_cast<double>(context_time.load());
  if (options.measure) return summary;
  folder.write("run.json", run_json(run_record(options, start, context_seconds, workers, progress, summary), summary));
  publish(folder, options, summary, progress);
  return summary;
}

}  // namespace

std::string told_input(const BuildOptions& options) {
  return options.input_told.empty() ? options.input : options.input_told;
}

std::string name_of(const BuildOptions& options) {
  if (!options.name.empty()) return options.name;
  std::string name = options.input.substr(options.input.find_last_of('/') + 1);
  for (const std::string_view end : {".gz", ".bz2", ".pbf", ".osm"})
    if (name.size() > end.size() && name.ends_with(end)) name.resize(name.size() - end.size());
  return name;
}

BuildSummary build_area(const BuildOptions& options, const AreaPart& part, base::Progress& progress) {
  return build_all_or_part(options, &part, progress);
}

BuildSummary build(const BuildOptions& asked, base::Progress& progress) {
  BuildOptions options = asked;
  options.surroundings = asked.surroundings.settled(asked.lod);
  if (options.outputs.ground == outputs::GroundChoice::imagery && options.imagery.images.empty())
    throw base::UsageError(
        "--ground imagery lays aerial images on the ground, and there is none: name one with --imagery FILE, or leave "
        "out --ground");
  if (options.areas > 0) return build_in_areas(options, progress);
  if (options.memory_limit > 0 && options.settings.empty())  // a region's settings hold for builds of both kinds
    throw base::UsageError("--memory-limit says how many areas are built at a time: it needs --areas");
  if (!options.area.empty()) return build_one_area(options, progress);
  return build_all_or_part(options, nullptr, progress);
}

}  // namespace blockrand::run
