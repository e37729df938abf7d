// Everything that is checked of one tile: its files against their rules, against each other and against the map.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "pipeline/georef/heights.h"
#include "pipeline/georef/proj_transform.h"
#include "pipeline/validate/build_record.h"
#include "pipeline/validate/citygml_reader.h"
#include "pipeline/validate/contents.h"
#include "pipeline/validate/explanations.h"
#include "pipeline/validate/format_agreement.h"
#include "pipeline/validate/formats.h"
#include "pipeline/validate/geopackage.h"
#include "pipeline/validate/positions.h"
#include "pipeline/validate/tileset_reader.h"

namespace blockrand::validate {

/// A tile's files as build.json lists them, relative to the build; empty where it lists none.
struct TileFiles {
  std::string name;  ///< "15_17600_12900"
  std::string path[kTileFormats];
  std::vector<std::string> pieces;    ///< GLBs that hold a part of the buildings each; the first is in `path`
  std::map<int, std::string> levels;  ///< GLBs of the same buildings in less detail, by LoD
  std::string explanations;           ///< "explain/15_17600_12900.jsonl.gz"
};

/// What one format holds of one or of all tiles.
struct FormatCounts {
  std::uint64_t files = 0, buildings = 0, bodies = 0;
  std::uint64_t solids[4] = {0, 0, 0, 0};  ///< by LoD; of GLB, meshes in [0], whichever LoD they show
  std::uint64_t windows = 0, doors = 0, placements = 0, installations = 0;  ///< of LoD3; not of GLB
  std::uint64_t models = 0;  ///< objects of the map that own a solid, or at LoD 0 a footprint
  bool incomplete = false;   ///< a file is missing or unreadable: the counts mean nothing
  void add(const FormatCounts& other);
};

/// How far a sampled corner lies from where OpenStreetMap has it; negative where the format does not show it.
struct PositionResult {
  std::uint64_t rank = 0;
  std::string object;
  std::string file[kTileFormats];
  double off[kTileFormats] = {-1, -1, -1};  ///< m
  model::Point2 offset[kTileFormats];       ///< m east and north, from there to the nearest corner of the model
  double tolerance[kTileFormats] = {0, 0, 0};
  bool moved = false;  ///< repair says that it moved corners of the body
};

struct TileResult {
  std::vector<Finding> findings;
  FormatCounts counts[kTileFormats];
  std::uint64_t pairs = 0;                                    ///< pairs of parts that may overlap
  std::vector<std::string> told_overlaps;                     ///< "w1.w2 601 overlaps …": the report says so as well
  std::uint64_t validated = 0;                                ///< solids that were given to both validators
  std::uint64_t triangles = 0, attributes = 0, compared = 0;  ///< pairs of bodies in two formats
  std::uint64_t explained = 0;                                ///< records in explain/
  FormatCounts geopackage;
  std::vector<PositionResult> positions;
  std::vector<std::string> ids[kTileFormats];  ///< of bodies: across tiles they must differ as well
  std::vector<std::string> modelled;           ///< objects that own a solid or footprint, in any format
  std::vector<std::string> buildings;          ///< those with a footprint, of the first format that is there
  /// By format and body, where a file of the whole build will be compared: BodyDigest; of GLB with the number of
  /// triangles as its geometry.
  BodyDigests digests[kTileFormats];
  std::map<std::string, std::map<std::string, std::uint64_t>> sources;  ///< attribute → source → bodies
  std::map<std::string, std::uint64_t> roofs;                           ///< built roof → bodies
};

/// What all tiles have in common. Every member outlives the checks; const use from several threads.
struct TileContext {
  std::string folder;
  const BuildRecord& record;
  const Tileset* tileset = nullptr;
  const CityGmlSchema* schema = nullptr;
  const PositionSample& sample;
  georef::ProjTransformPool* proj_transform =
      nullptr;  ///< PROJ with the operation of build.json; null where it cannot be used
  georef::ProjTransformPool* positions = nullptr;  ///< PROJ with the operation that the positions are compared by
  const georef::Geoid& geoid;
  const std::set<std::string>* overlapping = nullptr;  ///< objects of which the report tells an overlap
  GeoPackageReader* geopackage = nullptr;              ///< null: not there, or unreadable
  const ExplanationIndex* explanations = nullptr;
  const ExplainedPlaces* places = nullptr;  ///< null: the build has no explain/places.tsv
};

/// Never throws on account of what the files hold.
TileResult check_tile(const TileFiles& files, const TileContext& context);

/// model.glb: the whole build as one mesh. Checked like a tile without a tileset.
TileResult check_single_glb(const std::string& path, const TileContext& context);

}  // namespace blockrand::validate
