// What report.html tells beside its map: filled by the region stage from what build.json and report.json say.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/base/attribution.h"
#include "pipeline/model/building.h"
#include "pipeline/model/extract.h"
#include "pipeline/model/report.h"

namespace blockrand::outputs {

/// An object that is not modelled itself.
struct ReportedObject {
  model::OsmId id;
  model::ObjectKind kind = model::ObjectKind::building;
  model::ObjectState state = model::ObjectState::reported;  ///< represented, duplicate or reported
  model::IssueCode code = model::IssueCode::none;           ///< why, when reported
  model::OsmId related;                                     ///< who represents it or whose duplicate it is
};

struct ReportFile {
  std::string path;  ///< relative to the build's folder
  std::uint64_t bytes = 0;
};

struct ReportPicture {
  std::string png;  ///< the file's bytes
  int width = 0, height = 0;
  std::string caption;  ///< a sentence, plain text
};

/// The model that the page carries.
struct EmbeddedModel {
  std::string files;   ///< embedded_view()
  std::string viewer;  ///< {"viewer.js":"…","viewer.css":"…"}, compressed and in base64 as those are
};

/// What repair and context found, for the section "Footprints and context"; empty where they did not run.
struct ContextFacts {
  /// What repair did, as people read it: {"Corners moved", "12,345 of 67,890"}.
  std::vector<std::pair<std::string, std::string>> repair;
  std::array<std::uint64_t, model::kWallSegmentKindCount> edges{};       ///< wall segments by model::WallSegmentKind
  std::array<double, model::kWallSegmentKindCount> edge_length{};        ///< m
  std::array<std::uint64_t, model::kBuildingPositionCount> positions{};  ///< buildings by model::BuildingPosition
  std::optional<ReportPicture> plan;  ///< from above, edges in the colours of model/wall_segment_colours.h
  std::string plan_note;              ///< what the plan shows, where it is not the whole build; may be empty
};

/// A block of houses; its number is its place in ReportFacts::blocks, from 1.
struct BlockFact {
  std::string id;               ///< as context::Block has it
  std::string streets;          ///< "Arkonaplatz, Ruppiner Straße and Granseer Straße"; may be empty
  double area = 0;              ///< m², up to the middle of its streets
  bool gives_ratios = false;    ///< it is whole, and built land
  std::uint64_t buildings = 0;  ///< that belong to it, also those of other areas
  std::vector<std::vector<std::pair<double, double>>> rings;  ///< m, build CRS
};

struct ReportFacts {
  std::string name;       ///< of the build, for people
  std::string data_time;  ///< ISO 8601, of the data; may be empty
  std::string program_version;
  std::string crs_code, crs_name;
  double crs_accuracy = -1;  ///< m; negative: unknown
  std::string height_reference, vertical_crs;
  int lod = 2;                                       ///< asked for
  double centre_longitude = 0, centre_latitude = 0;  ///< degrees, for the link to the place; both 0: none

  std::uint64_t buildings_in = 0, parts_in = 0;
  std::uint64_t models = 0, represented = 0, duplicates = 0, reported = 0;  ///< represented without duplicates
  std::array<std::uint64_t, 4> models_by_lod{};
  std::uint64_t buildings_built = 0, bodies = 0;  ///< buildings with at least one body; bodies of all

  std::map<std::string, std::map<std::string, std::uint64_t>> sources;  ///< attribute → source → bodies
  std::map<std::string, std::uint64_t> roofs;                           ///< built roof shape → bodies
  double footprint_area = 0, outer_wall_area = 0, party_wall_area = 0;  ///< m²
  double party_wall_length = 0;                                         ///< m
  double volume = 0;                                                    ///< m³
  std::uint64_t party_walls = 0;

  std::vector<BlockFact> blocks;  ///< those that a building of this build belongs to, from north to south
  bool alone = false;             ///< one tile or area of a larger build

  std::span<const model::ReportRow>
      rows;  ///< of all objects, sorted; outlives this. Reported ones carry the detail of their object
  std::vector<ReportedObject> objects;  ///< in id order
  std::vector<ReportFile> files;        ///< in path order, report.html itself left out
  std::vector<ReportPicture> pictures;
  std::string pictures_note;  ///< what the pictures show, where it is not the whole build; may be empty
  std::optional<EmbeddedModel> model;
  ContextFacts context;
  std::string attribution = base::kAttribution;
};

}  // namespace blockrand::outputs
