#include "pipeline/run/report_facts.h"

#include <fmt/format.h>

#include "pipeline/base/text.h"
#include "pipeline/base/version.h"

namespace blockrand::run {

namespace {

/// What repair did, in words for the report.
std::vector<std::pair<std::string, std::string>> repair_lines(const footprints::RepairTotals& t) {
  using base::with_thousands;
  const auto of = [](std::uint64_t part, std::uint64_t whole) {
    return with_thousands(part) + " of " + with_thousands(whole);
  };
  const auto share = [](double ratio) { return fmt::format("{:.2f} %", 100 * ratio); };
  std::vector<std::pair<std::string, std::string>> out = {
      {"Outlines", with_thousands(t.outlines)},
      {"Rows of touching buildings", with_thousands(t.rows)},
      {"Corners moved", of(t.moved, t.vertices)},
      {"Mean, largest shift of those", fmt::format("{:.3f} m, {:.2f} m", t.mean_shift, t.max_shift)},
      {"Median, largest change of area", share(t.median_area_change) + ", " + share(t.max_area_change)},
      {"Shared walls", with_thousands(t.shared_walls)},
      {"Gaps closed", with_thousands(t.gaps_closed)},
      {"Overlaps resolved", with_thousands(t.overlaps_resolved)},
      {"Outlines with an overlap left", with_thousands(t.overlaps_left)},
      {"Outlines with a main direction", with_thousands(t.squared)},
      {"Curved walls", with_thousands(t.arcs)}};
  if (t.at_cuts > 0) out.emplace_back("Buildings at cuts of long rows", with_thousands(t.at_cuts));
  return out;
}

}  // namespace

outputs::ReportFacts report_facts(const BuildOptions& options, const BuildRecord& record, const model::Extract& extract,
                                  const std::vector<model::ReportRow>& rows, const outputs::ReportBuilder& page,
                                  georef::LonLat centre) {
  outputs::ReportFacts f;
  f.input = options.input;
  f.data_time = record.data_time;
  f.program_version = base::kVersion;
  f.crs_code = record.crs.authority_code;
  f.crs_name = record.crs.name;
  f.crs_accuracy = record.crs.accuracy_m;
  f.height_reference = record.heights.words;
  f.vertical_crs = record.heights.vertical_crs;
  f.lod = options.lod;
  f.centre_longitude = centre.lon;
  f.centre_latitude = centre.lat;
  const BuildSummary& s = record.summary;
  f.buildings_in = s.buildings_in;
  f.parts_in = s.parts_in;
  f.models = s.models;
  f.represented = s.represented;
  f.duplicates = s.duplicates;
  f.reported = s.reported;
  f.models_by_lod = s.models_by_lod;
  f.buildings_built = page.buildings_built();
  f.bodies = page.bodies();
  const outputs::Statistics& t = record.statistics;
  f.sources = t.sources;
  f.roofs = t.roofs;
  f.footprint_area = t.footprint_area;
  f.outer_wall_area = t.outer_wall_area;
  f.party_wall_area = t.party_wall_area;
  f.party_wall_length = t.party_wall_length;
  f.volume = t.volume;
  f.party_walls = t.party_walls;
  if (record.repair.outlines > 0) f.context.repair = repair_lines(record.repair);
  f.context.edges = t.edges;
  f.context.edge_length = t.edge_length;
  f.context.positions = t.positions;
  f.rows = rows;
  for (const model::MappedBuilding& b : extract.buildings)
    if (b.state != model::ObjectState::modelled) f.objects.push_back({b.id, b.kind, b.state, b.code, b.related});
  for (const base::PublishedFile& file : record.files) f.files.push_back({file.path, file.bytes});
  return f;
}

}  // namespace blockrand::run
