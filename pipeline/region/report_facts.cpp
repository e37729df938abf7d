#include "pipeline/region/report_facts.h"

#include "pipeline/base/version.h"

namespace blockrand::region {

export_::ReportFacts report_facts(const BuildOptions& options, const BuildRecord& record, const model::Extract& extract,
                                  const std::vector<model::ReportRow>& rows, const export_::ReportBuilder& page,
                                  georef::LonLat centre) {
  export_::ReportFacts f;
  f.input = options.input;
  f.data_time = record.data_time;
  f.program_version = base::kVersion;
  f.crs_code = record.crs.authority_code;
  f.crs_name = record.crs.name;
  f.crs_accuracy = record.crs.accuracy_m;
  f.height_reference = record.height_reference;
  f.vertical_crs = record.vertical_crs;
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
  const Statistics& t = record.statistics;
  f.sources = t.sources;
  f.roofs = t.roofs;
  f.footprint_area = t.footprint_area;
  f.outer_wall_area = t.outer_wall_area;
  f.party_wall_area = t.party_wall_area;
  f.party_wall_length = t.party_wall_length;
  f.volume = t.volume;
  f.party_walls = t.party_walls;
  f.rows = rows;
  for (const model::MappedBuilding& b : extract.buildings)
    if (b.state != model::ObjectState::modelled) f.objects.push_back({b.id, b.kind, b.state, b.code, b.related});
  for (const base::PublishedFile& file : record.files) f.files.push_back({file.path, file.bytes});
  return f;
}

}  // namespace blockrand::region
