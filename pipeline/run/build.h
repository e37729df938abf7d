// The main job: one extract in, a published build out.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/outputs/gltf/compression.h"
#include "pipeline/outputs/gltf/instance_writer.h"
#include "pipeline/attributes/options.h"
#include "pipeline/masses/roofscape.h"
#include "pipeline/footprints/repair/options.h"

namespace blockrand::run {

/// What the user asked for. Defaults are those of `blockrand build`.
struct BuildOptions {
  std::string input;                          ///< .osm, .osm.pbf, .osm.gz, .osm.bz2
  std::string output;                         ///< folder that the build becomes
  std::string configs;                        ///< folder with defaults/ and materials/; empty: found by the program
  std::optional<std::array<double, 4>> bbox;  ///< west, south, east, north in degrees
  std::string tile;                           ///< "15/35207/25941": build this tile alone; needs `pinned`
  std::string pinned;                         ///< build.json of an earlier build of the extract: its CRS, its coverage
  std::string crs;                            ///< "EPSG:…"; empty: chosen from the extent
  int lod = 2;                                ///< highest level of detail, 0 to 3
  outputs::Compression compression = outputs::Compression::none;  ///< of vertices, indices and places in GLBs
  outputs::Instancing instancing = outputs::Instancing::ext;  ///< how GLBs hold what stands in facades
  bool gltf = true;                           ///< tileset.json and tiles/
  bool citygml = true;                        ///< citygml/
  bool cityjson = true;                       ///< cityjson/
  bool geopackage = true;                     ///< buildings.gpkg
  bool report = true;                         ///< report.html
  bool explain = true;                        ///< explain/: what `blockrand explain` reads
  bool evidence = false;                      ///< GLB, CityGML and CityJSON also say why each attribute has its value
  bool gzip = false;                          ///< CityGML as .gml.gz, CityJSON as .city.jsonl.gz
  bool single_glb = false;                    ///< also model.glb: the whole build in one frame
  bool single_cityjson = false;               ///< also model.city.json: the whole build as one CityJSON object
  bool force = false;                         ///< replace an existing build
  bool strict = false;                        ///< exit code 3 when a building is below the asked quality
  int jobs = 0;                               ///< worker threads; 0: one per core
  std::uint64_t seed = 1;                     ///< of all random choices
  std::string terrain;                        ///< raster with ground heights, or empty
  std::string terrain_height_reference;       ///< "EPSG:7837", "sea-level", "ellipsoid"; empty: what the raster says
  std::string districts;                      ///< rule set by name or file; empty: chosen by place from configs/districts/
  std::string overrides;                      ///< overrides.toml, or empty
  std::optional<double> ground_height;        ///< m above sea level for every base where there is no terrain
  repair::RepairOptions repair;
  attributes::GenerateOptions generate;
};

/// What a build ended with.
struct BuildSummary {
  std::uint64_t buildings_in = 0, parts_in = 0;
  std::uint64_t models = 0, represented = 0, duplicates = 0, reported = 0;
  std::array<std::uint64_t, 4> models_by_lod{};   ///< objects whose best solid is LoD 0, 1, 2, 3
  std::map<std::string, std::uint64_t> issues;    ///< rows by code
  masses::Roofscape roofscape;                  ///< how roofs stand in their rows
  std::uint64_t files = 0, bytes = 0;             ///< written
  double seconds = 0;
  std::uint64_t peak_rss_bytes = 0;
  std::uint64_t store_bytes = 0;                  ///< of it: the extract and its indices before the first tile
  std::uint64_t tiles_in_flight = 0;              ///< at most this many tiles share the rest
  bool below_quality = false;                     ///< a building is simpler than asked, or has no solid
};

/// Builds and publishes. An existing output folder stays untouched until the new one is complete.
/// \throws base::InputError   unreadable or invalid input
/// \throws base::UsageError   options that contradict each other; an output place that cannot be used
/// \throws base::OutputError  the disk is full or cannot be written
BuildSummary build(const BuildOptions& options, base::Progress& progress);

}  // namespace blockrand::run
