// What every output format is to a build: a name, a size, work on a tile, a turn in tile order, an end.
#pragma once

#include <any>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/attribution.h"
#include "pipeline/base/memo.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/publish.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/context/height_reference.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/lon_lat.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/extract.h"
#include "pipeline/model/ground_mesh.h"
#include "pipeline/model/region.h"
#include "pipeline/model/surroundings.h"
#include "pipeline/observation/imagery.h"
#include "pipeline/outputs/explain/explanation.h"
#include "pipeline/outputs/imagery/seen_outline.h"
#include "pipeline/outputs/object_counts.h"
#include "pipeline/outputs/options.h"
#include "pipeline/outputs/output_size.h"
#include "pipeline/outputs/statistics.h"
#include "pipeline/textures/texture_catalogue.h"

namespace blockrand::outputs {

/// What is known of a build before its first tile; outlives the outputs and changes no more, but for the states of the
/// extract's objects, which are complete when the outputs finish.
struct OutputContext {
  const OutputOptions& options;
  int lod = 2;       ///< highest level of detail
  std::string name;  ///< of the build, for people
  base::StagedFolder& folder;
  const georef::Projection& projection;
  const georef::Crs& crs;
  const context::HeightReference& heights;
  std::string_view data_time;  ///< ISO 8601; may be empty
  georef::LonLat centre;       ///< degrees, of the build
  const model::Extract& extract;
  std::span<const footprints::Shard> shards;
  const footprints::RepairedExtract& repaired;
  const context::ContextExtract& context;
  const observation::ImageryObservations* imagery = nullptr;  ///< null: no images
  std::span<const importers::imagery::AerialImage> images{};  ///< parallel to those of `imagery`; empty: read earlier
  SeenOutlines seen;                                          ///< of these images
  std::optional<model::TileId> alone;                         ///< the one tile or area that is built, of a larger build
  std::span<const model::ReportRow> earlier;                  ///< rows from before the tiles, sorted
  std::function<std::string(std::string_view preset)> rule_file;  ///< as ExplainOptions has it; may be empty
  /// What model::Surroundings of tiles number. Null: none are made.
  const model::SurroundingCatalogue* surroundings = nullptr;
  const textures::TextureCatalogue* textures = nullptr;  ///< null: surfaces are plain
  std::function<model::GroundMesh(model::TileId)>
      ground_mesh{};  ///< of a tile; empty: no picture of the ground is asked for
  int workers = 1;
  const base::Memo* memo = nullptr;  ///< where an earlier run left pictures; null: nothing is remembered
};

/// A tile on which all stages have worked.
struct FinishedTile {
  const model::Region& region;
  const model::Surroundings* surroundings = nullptr;     ///< null: none are made
  std::size_t shard = 0;                                 ///< index
  std::string name;                                      ///< "15_17600_12900"
  bool has_parts = false;                                ///< a building has a body
  std::function<FinalState(std::uint32_t)> final_state;  ///< what becomes of object `mapped_index` of the extract
  /// Gets what this output writes. For those with OutputFormat::names_files: what all others wrote comes first.
  std::vector<base::PublishedFile> files;
};

/// Whether formats have something to write of what stands around the tile's buildings.
inline bool has_surroundings(const FinishedTile& tile, const OutputContext& context) {
  return context.surroundings && tile.surroundings && !tile.surroundings->empty();
}

/// What is known when all tiles are done.
struct FinishedBuild {
  const ObjectCounts& counts;
  const Statistics& statistics;
  const model::Region& whole;                 ///< all tiles as one; empty where no output keeps regions
  const std::vector<model::ReportRow>& rows;  ///< of all objects, sorted
  std::vector<base::PublishedFile>& files;    ///< written so far; outputs add theirs
  std::function<void(const std::string&)> warn;
  /// What the list that ends a build tells of a file, behind its purpose: "424 houses, 5,173,355 triangles".
  std::function<void(std::string_view path, std::string figures)> tell;
};

/// A format while a build runs. Every function may throw base::OutputError.
class Output {
 public:
  virtual ~Output() = default;

  /// Writes a tile's files, notes them in `tile.files`, and returns what `take` wants to know of the tile. Called for
  /// different tiles at the same time.
  virtual std::any write_tile(FinishedTile& tile) const = 0;
  /// What write_tile returned, as bytes (pipeline/base/pack.h) for a run that finds the tile unchanged, and back.
  virtual std::string packed_product(const std::any& product) const = 0;
  /// \throws base::UnpackError
  virtual std::any unpacked_product(std::string_view bytes) const = 0;
  /// What write_tile reads of a tile beside its region and what OutputContext says of all tiles alike: packed, so that a tile
  /// for which it is another counts as changed.
  virtual std::string reads_of_tile(std::size_t /*shard*/) const { return {}; }
  /// Takes over what write_tile returned, in tile order, one at a time. `tile.files` is complete.
  virtual void take(const FinishedTile& /*tile*/, std::any /*product*/) {}
  /// All tiles are taken: begins with what needs no file of the whole, beside the others' `finish` where there are several
  /// workers. `build` must outlive `conclude`.
  virtual void begin_finish(const FinishedBuild& /*build*/) {}
  /// Writes the files of the whole build.
  virtual void finish(const FinishedBuild& /*build*/) {}
  /// Writes the files that list all others: after every output has finished.
  virtual void conclude(const FinishedBuild& /*build*/) {}
};

/// A format whose write_tile returns a Product.
template <class Product>
class OutputOf : public Output {
 public:
  std::string packed_product(const std::any& product) const override {
    return base::packed(*std::any_cast<Product>(&product));
  }
  std::any unpacked_product(std::string_view bytes) const override { return base::unpacked<Product>(bytes); }
};

/// A file or folder, and what people find in it.
struct OutputPlace {
  std::string_view path;                                                          ///< relative to the build
  std::string_view about;                                                         ///< for the list that ends a build
  bool (*written)(const OutputOptions& options, std::uint64_t models) = nullptr;  ///< null: wherever the format is
};

/// A format before a build: what it is called, what it takes, how it begins.
struct OutputFormat {
  std::string_view name;                        ///< as --formats has it
  std::string_view title{};                     ///< what the name does not say; may be empty
  std::vector<std::string_view> other_names{};  ///< that --formats understands as well
  bool in_formats = true;                       ///< false: an option of its own asks for it, or it is always there
  std::vector<OutputPlace> places{};            ///< for the list that ends a build
  std::vector<std::pair<std::string_view, std::string_view>> manual{};  ///< path and text for the manual page
  /// One of its files is asked for.
  bool (*asked)(const OutputOptions& options) = nullptr;
  /// What its files take. \param lod  0 to 3
  OutputSize (*size)(const OutputOptions& options, std::size_t lod) = nullptr;
  /// `take` gets regions: all stay in memory until their turn.
  bool (*takes_regions)(const OutputOptions& options) = nullptr;  ///< null: never
  /// `finish` gets the whole build as one region, in memory.
  bool (*keeps_whole)(const OutputOptions& options) = nullptr;  ///< null: never
  bool names_files = false;                                     ///< of its tile: it is written behind the others
  std::unique_ptr<Output> (*open)(const OutputContext& context) = nullptr;
};

/// Every format, in the order in which a tile is written, a build is finished and people read of them. The only list:
/// options, help, manual, disk estimate and the build itself follow from it (all_outputs.cpp).
const std::vector<OutputFormat>& all_outputs();

/// All asked formats together. \param lod  clamped to 0 to 3
OutputSize output_size(const OutputOptions& options, int lod);

// ---- What several formats say alike.

using base::kAttribution;
/// Of everything that an output was made from: the map, and the images that were looked at, with their licences.
std::string attribution(const OutputContext& context);
/// \param images  empty: none was looked at
std::string attribution(std::span<const observation::ImageReceipt> images);
std::string generator();                      ///< "Blockrand 0.1.0"
std::string model_name(model::TileId id);     ///< "Blockrand 15/17600/12900"
std::string tile_name(model::TileId id);      ///< "15_17600_12900"
std::string tile_glb_path(model::TileId id);  ///< "tiles/15/17600/12900.glb"

/// Writes a file that web clients fetch, and `<path>.gz` beside it where --precompress asks for it. \param files  are added
void write_served(const std::string& path, const std::string& bytes, const OutputOptions& options,
                  base::StagedFolder& folder, std::vector<base::PublishedFile>& files);

/// Writes a city model, compressed as `<path>.gz` where --gzip asks for it.
base::PublishedFile write_text_file(const std::string& path, const std::string& bytes, const OutputContext& context);

}  // namespace blockrand::outputs
