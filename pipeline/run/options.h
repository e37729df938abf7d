// What `blockrand build` is asked for.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "pipeline/attributes/options.h"
#include "pipeline/base/option_table.h"
#include "pipeline/footprints/repair/options.h"
#include "pipeline/observation/options.h"
#include "pipeline/outputs/options.h"
#include "pipeline/surroundings/options.h"

namespace blockrand::importers::osm {
class ChangedObjects;
}

namespace blockrand::run {

/// What the user asked for. Defaults are those of `blockrand build`.
struct BuildOptions {
  std::string input;                          ///< .osm, .osm.pbf, .osm.gz, .osm.bz2
  std::string name;                           ///< of the build, for people; empty: that of `input`
  std::string input_told;                     ///< what people call `input`, where it is a copy; empty: its path
  std::string output;                         ///< folder that the build becomes
  std::string configs;                        ///< folder with defaults/ and materials/; empty: found by the program
  std::optional<std::array<double, 4>> bbox;  ///< west, south, east, north in degrees
  std::string tile;                           ///< "15/35207/25941": build this tile alone; needs `pinned`
  std::string pinned;                         ///< build.json of an earlier build of the extract: its CRS, its coverage
  int areas = 0;        ///< level of the quadtree whose tiles are built one by one; 0: all at once
  std::string area;     ///< "11/1093/805": build this one of them alone; needs `pinned`
  std::string earlier;  ///< a build in areas whose unchanged ones are taken over, or empty
  /// What differs between the data of `earlier` and the input; null: nobody knows. Its store is brought up to date by it.
  std::shared_ptr<const importers::osm::ChangedObjects> changes;
  std::string settings;                  ///< says whether a build of `earlier` had the same; of `update`
  std::int64_t memory_limit = 0;         ///< bytes for all areas in work; 0: one at a time
  std::string crs;                       ///< "EPSG:…"; empty: chosen from the extent
  int lod = 3;                           ///< highest level of detail, 0 to 3
  bool force = false;                    ///< replace an existing build
  bool allow_empty = false;              ///< a build without models may replace one with some
  double allow_shrink = 50;              ///< percent fewer models than the build that is replaced
  bool strict = false;                   ///< exit code 3 when a building is below the asked quality
  int jobs = 0;                          ///< worker threads; 0: one per core
  bool plan = false;                     ///< only look what there is to do: `output` is not written
  bool measure = false;                  ///< files are counted, not written; no earlier build matters
  std::string cache;                     ///< folder where the work on tiles is kept for later runs, or empty
  std::uint64_t seed = 1;                ///< of all random choices
  std::string terrain;                   ///< raster with ground heights, or empty
  std::string terrain_height_reference;  ///< "EPSG:7837", "sea-level", "ellipsoid"; empty: what the raster says
  std::string districts;                 ///< rule set by name or file; empty: chosen by place from configs/districts/
  std::string overrides;                 ///< overrides.toml, or empty
  std::optional<double> ground_height;   ///< m above sea level for every base where there is no terrain
  observation::ImageryOptions imagery;
  outputs::OutputOptions outputs;
  repair::RepairOptions repair;
  attributes::GenerateOptions generate;
  surroundings::SurroundingOptions surroundings = surroundings::usual_surroundings();
};

/// How users set them: the main section, and those of the stages whose options a build holds.
base::OptionTable<BuildOptions> build_options();

}  // namespace blockrand::run
