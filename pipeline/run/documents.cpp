#include "pipeline/run/documents.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pipeline/base/version.h"
#include "pipeline/outputs/output.h"
#include "pipeline/run/area_surroundings.h"
#include "pipeline/run/configuration.h"
#include "pipeline/run/tile_choice.h"

namespace blockrand::run {

namespace {

using Json = nlohmann::ordered_json;

/// Rounded for people; also keeps the last bits of long sums out of the file.
double rounded(double value, double steps = 100) { return std::nearbyint(value * steps) / steps; }

Json terrain_json(const importers::elevation::TerrainDescription& t) {
  return {{"crs", t.crs_code.empty() ? t.crs_name : t.crs_code},
          {"vertical_crs", t.vertical_code.empty() ? t.vertical_name : t.vertical_code},
          {"operation", t.operation},
          {"accuracy_m", t.accuracy_m < 0 ? Json(nullptr) : Json(t.accuracy_m)},
          {"pixel", {t.pixel_width, t.pixel_height}},
          {"size", {t.columns, t.rows}}};
}

Json repair_json(const footprints::RepairTotals& m) {
  return {{"outlines", m.outlines},
          {"rows", m.rows},
          {"buildings_at_cuts", m.at_cuts},
          {"vertices", m.vertices},
          {"vertices_moved", m.moved},
          {"mean_shift_m", rounded(m.mean_shift, 1000)},
          {"max_shift_m", rounded(m.max_shift, 1000)},
          {"outlines_squared", m.squared},
          {"outlines_area_changed", m.area_changed},
          {"median_area_change", rounded(m.median_area_change, 1e6)},
          {"max_area_change", rounded(m.max_area_change, 1e6)},
          {"shared_walls", m.shared_walls},
          {"party_wall_length_m", rounded(m.party_wall_length)},
          {"gaps_closed", m.gaps_closed},
          {"overlaps_resolved", m.overlaps_resolved},
          {"outlines_with_overlap_left", m.overlaps_left},
          {"arcs", m.arcs}};
}

Json counts_json(const BuildRecord& r) {
  const BuildSummary& s = r.summary;
  Json counts = {{"buildings_in", s.buildings_in},
                 {"parts_in", s.parts_in},
                 {"models", s.models},
                 // Represented by its parts or by the object it duplicates.
                 {"represented", s.represented + s.duplicates},
                 {"reported", s.reported},
                 {"represented_as_duplicates", s.duplicates},
                 {"models_lod0", s.models_by_lod[0]},
                 {"models_lod1", s.models_by_lod[1]},
                 {"models_lod2", s.models_by_lod[2]},
                 {"models_lod3", s.models_by_lod[3]},
                 // What every format holds, to the last one.
                 {"buildings", r.statistics.buildings},
                 {"bodies", r.statistics.bodies},
                 {"solids_lod1", r.statistics.solids_lod1},
                 {"solids_lod2", r.statistics.solids_lod2},
                 {"solids_lod3", r.statistics.solids_lod3},
                 {"windows", r.statistics.windows},
                 {"doors", r.statistics.doors},
                 {"dormers", r.statistics.dormers},
                 {"cross_gables", r.statistics.cross_gables},
                 {"placements", r.statistics.placements},
                 {"installations", r.statistics.installations},
                 {"old_style_multipolygons", r.counts.old_style_multipolygons},
                 {"areas_with_holes", r.counts.areas_with_holes}};
  if (!r.area)  // what is missing has no place
    counts["missing_nodes"] = r.counts.missing_nodes, counts["missing_ways"] = r.counts.missing_ways;
  return counts;
}

Json statistics_json(const outputs::Statistics& t) {
  Json j = {{"footprint_area_m2", rounded(t.footprint_area)},      {"volume_m3", rounded(t.volume)},
            {"outer_wall_area_m2", rounded(t.outer_wall_area)},    {"party_walls", t.party_walls},
            {"party_wall_length_m", rounded(t.party_wall_length)}, {"party_wall_area_m2", rounded(t.party_wall_area)}};
  j["edges"] = Json::object();
  for (std::size_t k = 0; k < t.edges.size(); ++k)
    if (t.edges[k] > 0)
      j["edges"][model::name(static_cast<model::WallSegmentKind>(k))] = {{"stretches", t.edges[k]},
                                                                         {"length_m", rounded(t.edge_length[k])}};
  j["positions"] = Json::object();
  for (std::size_t k = 0; k < t.positions.size(); ++k)
    if (t.positions[k] > 0) j["positions"][model::name(static_cast<model::BuildingPosition>(k))] = t.positions[k];
  j["roofs"] = Json::object();
  for (const auto& [shape, count] : t.roofs) j["roofs"][shape] = count;
  const masses::Roofscape& roofs = t.roofscape;
  j["roofscape"] = {{"mid_row", roofs.mid_row},
                    {"eaves_to_street", roofs.eaves_to_street},
                    {"with_rear", roofs.with_rear},
                    {"eaves_to_rear", roofs.eaves_to_rear},
                    {"corner_houses", roofs.corner_houses},
                    {"corner_houses_turned", roofs.turned},
                    {"eaves_at_party_walls", roofs.party_eaves},
                    {"eaves_at_party_walls_as_mapped", roofs.party_eaves_mapped},
                    {"eaves_at_party_walls_m", rounded(roofs.party_eaves_length)},
                    {"slopes_that_should_meet", roofs.meetings},
                    {"slopes_apart", roofs.apart},
                    {"slopes_apart_most_m", roofs.widest}};
  j["sources"] = Json::object();
  for (const auto& [attribute, sources] : t.sources) {
    Json& row = j["sources"][attribute] = Json::object();
    for (const auto& [source, count] : sources) row[source] = count;
  }
  return j;
}

Json image_json(const observation::ImageReceipt& image) {
  const importers::imagery::ImageDescription& d = image.description;
  return {{"path", d.source.path},
          {"date", d.source.date},
          {"licence", d.source.licence},
          {"attribution", d.source.attribution},
          {"crs", d.crs_code.empty() ? d.crs_name : d.crs_code},
          {"operation", d.operation},
          {"accuracy_m", d.accuracy_m},
          {"pixel_m", rounded(d.pixel_m, 1000)},
          {"state", observation::name(image.fit.state)},
          {"shift_m", {rounded(image.fit.shift.x, 1000), rounded(image.fit.shift.y, 1000)}}};
}

}  // namespace

Json crs_json(const BuildRecord& r) {
  Json j = {{"code", r.crs.authority_code},
            {"name", r.crs.name},
            {"operation", r.crs.operation},
            {"pipeline", r.crs.pipeline},
            {"accuracy_m", r.crs.accuracy_m},
            {"portable", r.portable},
            // Rounded up to 10 nm: the last bits of an error say nothing.
            {"round_trip_error_m", std::ceil(r.round_trip.projection_m * 1e8) / 1e8},
            {"frame_round_trip_error_m", std::ceil(r.round_trip.frame_m * 1e8) / 1e8},
            {"height_reference", r.heights.words},
            {"vertical_crs", r.heights.vertical_crs},
            {"height_reference_of_tiles", r.heights.in_tiles}};
  // How heights reach the ellipsoid in 3D Tiles; null: as they are.
  const context::HeightReference& h = r.heights;
  j["to_ellipsoid"] = nullptr;
  if (h.raised_by)
    j["to_ellipsoid"] = {
        {"by", h.raised_by->words()},
        {"from", h.raised_from},
        {"accuracy_m", h.raised_by->accuracy_m() < 0 ? Json(nullptr) : Json(h.raised_by->accuracy_m())}};
  return j;
}

Json region_json(const RegionFacts& facts) {
  Json j = {{"box", {facts.box.west, facts.box.south, facts.box.east, facts.box.north}},
            {"centre", {facts.centre.lon, facts.centre.lat}},
            {"coverage", Json::array()}};
  for (const model::Point2 p : facts.coverage) j["coverage"].push_back({p.x, p.y});
  j["areas"] = Json::array();
  for (const attributes::PinnedArea& area : facts.areas) {
    Json rings = Json::array();
    for (const auto& ring : area.rings) {
      Json numbers = Json::array();  // 1e-7 degrees: longitude, latitude, longitude, ...
      for (const model::Location p : ring) {
        numbers.push_back(p.lon);
        numbers.push_back(p.lat);
      }
      rings.push_back(std::move(numbers));
    }
    j["areas"].push_back(
        {{"question", area.question}, {"value", area.value}, {"id", area.id.text()}, {"rings", std::move(rings)}});
  }
  return j;
}

Json inputs_json(const std::vector<InputFile>& inputs) {
  Json j = Json::array();
  for (const InputFile& f : inputs)
    j.push_back({{"role", f.role}, {"path", f.path}, {"bytes", f.bytes}, {"sha256", f.sha256}});
  return j;
}

std::string build_json(const BuildOptions& options, const BuildRecord& r) {
  Json j;
  j["program"] = {{"name", "blockrand"}, {"version", base::kVersion}};
  j["attribution"] = outputs::attribution(r.images);
  j["data"] = {{"sha256", r.data_sha256}};
  j["inputs"] = inputs_json(r.inputs);
  for (const auto& credit : r.element_credits)
    j["element_credits"].push_back(
        {{"element", credit.kind}, {"licence", credit.licence}, {"source", credit.source}, {"author", credit.author}});
  j["data_time"] = r.data_time;
  j["configuration"] = configuration(options);
  j["crs"] = crs_json(r);
  if (r.terrain) j["terrain"] = terrain_json(*r.terrain);
  for (const observation::ImageReceipt& image : r.images) j["imagery"].push_back(image_json(image));
  if (r.area)
    j["area"] = text_of(*r.area);
  else
    j["region"] = region_json(r.facts);
  j["repair"] = repair_json(r.repair);
  j["counts"] = counts_json(r);
  j["issues"] = Json::object();
  for (const auto& [code, count] : r.summary.issues) j["issues"][code] = count;
  j["statistics"] = statistics_json(r.statistics);
  if (!r.surroundings.empty()) j["surroundings"] = surroundings_json(r.surroundings.counts());
  j["files"] = Json::object();
  for (const base::PublishedFile& f : r.files) j["files"][f.path] = {{"bytes", f.bytes}, {"sha256", f.sha256}};
  return j.dump(1) + "\n";
}

void note_slow_tile(std::vector<TileTime>& slowest, TileTime tile) {
  const auto slower = [](const TileTime& a, const TileTime& b) {
    return a.microseconds != b.microseconds ? a.microseconds > b.microseconds : a.tile < b.tile;
  };
  slowest.insert(std::ranges::upper_bound(slowest, tile, slower), std::move(tile));
  if (slowest.size() > kSlowestTiles) slowest.pop_back();
}

Json slowest_tiles_json(const std::vector<TileTime>& slowest) {
  Json j = Json::array();
  for (const TileTime& t : slowest)
    j.push_back({{"tile", t.tile},
                 {"thread_seconds", rounded(1e-6 * static_cast<double>(t.microseconds), 1000)},
                 {"buildings", t.buildings}});
  return j;
}

std::string run_json(const RunRecord& run, const BuildSummary& summary) {
  Json j;
  j["timings"] = Json::object();
  for (const auto& t : run.timings) j["timings"][t.name] = rounded(t.seconds, 1000);
  j["repair_and_context_in_tiles_thread_seconds"] = rounded(run.tile_context_seconds, 1000);
  j["seconds"] = rounded(run.seconds, 1000);
  const double objects = static_cast<double>(summary.buildings_in + summary.parts_in);
  j["buildings_per_second"] = run.seconds > 0 ? rounded(objects / run.seconds, 10) : 0;
  j["peak_rss_bytes"] = run.peak_rss_bytes;
  j["store_bytes"] = run.store_bytes;
  j["tiles_in_flight"] = run.tiles_in_flight;
  j["tiles"] = {{"built", summary.tiles_built},
                {"kept", summary.tiles_kept},
                {"built_for", summary.tiles_built_for}};  // the latter from an earlier run
  j["slowest_tiles"] = slowest_tiles_json(summary.slowest_tiles);
  j["jobs"] = run.jobs;
  j["host"] = run.host;
  j["inputs"] = inputs_json(run.inputs);
  return j.dump(1) + "\n";
}

}  // namespace blockrand::run
