// What the documents of an area tell, tile by tile: so that they are made of what the area itself holds, whatever was read around it,
// and a night replaces the records of the tiles that it looks into.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/context/context_extract.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/extract.h"
#include "pipeline/run/area_reach.h"
#include "pipeline/run/tile_choice.h"

namespace blockrand::run {

/// A mapped object as it stands before the tiles.
struct RecordedObject {
  model::OsmId id;
  model::ObjectKind kind = model::ObjectKind::building;
  model::ObjectState state = model::ObjectState::pending;
  model::IssueCode code = model::IssueCode::none;
  model::OsmId related;
  std::optional<model::Location> place;  ///< middle of its raw box
  std::uint32_t edited = 0;              ///< seconds since 1970
  bool has_holes = false, old_style = false;
};

/// A building with its outline, as the store has it.
struct RecordedBuilding {
  std::uint32_t outline = model::kNoIndex;  ///< into the tile's objects
  std::vector<std::uint32_t> parts;
  footprints::StoredFootprint footprint;
  std::vector<model::Polygon> polygons;
};

struct RecordedBlock {
  context::Block block;
  std::vector<model::OsmId> lines;  ///< parallel to Block::borders
  context::BlockFigures figures;    ///< without buildings
  std::vector<model::OsmId> buildings;
};

struct RecordedCourtyard {
  std::string block;             ///< id; may be empty
  context::Courtyard courtyard;  ///< without buildings
  std::vector<model::OsmId> buildings;
};

/// Something that the surroundings of houses are asked for.
struct RecordedThing {
  model::OsmId id;
  std::uint8_t kind = 0;  ///< surroundings::SurroundingKind
  bool inside = false;    ///< far enough from the border of the area: no other one tells of it
};

/// One tile of an area.
struct TileRecord {
  bool is_tile = false;                 ///< it has buildings to build
  std::string key;                      ///< of the work on it (TileKey::key)
  std::vector<RecordedObject> objects;  ///< by id
  std::vector<RecordedBuilding> buildings;
  std::vector<RecordedThing> things;   ///< that begin here, by id
  std::vector<model::ReportRow> rows;  ///< from before the tiles, sorted
  std::string data_sha256;             ///< of its objects
  std::uint64_t terrace_rows = 0;      ///< that begin here
  std::uint64_t at_cuts = 0;           ///< buildings that a cut parted from a neighbour
  std::vector<RecordedBlock> blocks;   ///< of its buildings, and empty ones whose first corner lies here
  std::vector<RecordedCourtyard> courtyards;
  std::map<context::CellIndex, context::CellSums> cells;
  std::vector<context::NetworkLine> lines;  ///< that come near
  std::string shown;                        ///< Output::reads_of_tile of all outputs
  TileReach reach;
};

/// By tile, those with anything to tell. kNowhere for what has no place.
using AreaRecord = std::map<model::TileId, TileRecord>;

/// Kinds of kept work: the records of an area, and what of them says which tiles a change concerns.
inline constexpr std::string_view kRecords = "areas", kReaches = "reaches";

/// What records are made of.
struct RecordInputs {
  const model::Extract& extract;  ///< before any tile has run
  std::span<const footprints::Shard> shards;
  const footprints::RepairedExtract& repaired;
  const context::ContextExtract& context;
  const georef::Projection& projection;
  std::span<const model::ReportRow> rows;  ///< from before the tiles
  const TileChoice& area;
  /// What of the features to tell as things around houses; empty: nothing.
  std::function<std::optional<RecordedThing>(const model::Feature&)> thing_of;
};

/// \param wanted  which tiles of the area
AreaRecord record_area(const RecordInputs& inputs, const std::function<bool(const model::TileId&)>& wanted);

/// The reaches of all tiles, for a piece of their own.
AreaReach reaches_in(const AreaRecord& record);

/// What outputs and the account see of an area: of buildings elsewhere that a block has they know the ids alone.
struct AreaAsTold {
  model::Extract extract;  ///< the area's objects by id, without rings, tags and features
  std::vector<footprints::Shard> shards;
  footprints::RepairedExtract repaired;
  context::ContextExtract context;
  std::vector<RecordedThing> things;  ///< by id
  std::vector<model::ReportRow> rows;
  std::string data_sha256, data_time;
  model::ExtractCounts counts;
};

/// \param coverage  as RegionFacts has it
AreaAsTold told_area(const AreaRecord& record, std::span<const model::Point2> coverage);

}  // namespace blockrand::run
