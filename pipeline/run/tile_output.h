// A finished tile becomes files; the whole build gets its tileset.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/base/publish.h"
#include "pipeline/outputs/cityjson/cityjson_writer.h"
#include "pipeline/outputs/explain/explanation.h"
#include "pipeline/outputs/geopackage/geopackage_writer.h"
#include "pipeline/outputs/tileset/tileset.h"
#include "pipeline/attributes/defaults.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/region.h"
#include "pipeline/run/build.h"
#include "pipeline/run/documents.h"

namespace blockrand::run {

/// What all tiles of a build have in common.
struct OutputContext {
  const BuildOptions& options;
  const georef::Projection& projection;
  const BuildRecord& record;
  const attributes::Defaults& defaults;
};

/// What a tile leaves behind besides its files.
struct TileOutput {
  std::vector<base::PublishedFile> files;
  std::optional<outputs::TileEntry> tile;  ///< set when the GLB shows something
  outputs::GeoPackageRows rows;            ///< empty where no GeoPackage is asked for
  std::vector<std::pair<model::OsmId, model::OsmId>> explained;  ///< object, building whose line explains it
};

/// Writes tiles/l/x/y.glb (at LoD3 y_lod1.glb and y_lod2.glb beside it, the same buildings seen from farther away), citygml/l_x_y.gml[.gz], cityjson/l_x_y.city.jsonl[.gz] and explain/l_x_y.jsonl.gz as asked
/// for. `explain` lacks tile and files: they are filled in here.
/// Safe for different tiles at the same time. \throws base::OutputError
TileOutput write_tile(const model::Region& region, const OutputContext& context, outputs::ExplainOptions explain,
                      base::StagedFolder& folder);

/// How a build's CityJSON, and its GeoPackage, describe themselves.
outputs::CityJsonOptions cityjson_options(const OutputContext& context, std::string name);
outputs::GeoPackageOptions geopackage_options(const OutputContext& context);

/// A tile as a row of the GeoPackage; its outline follows the tile's meridians and parallels.
outputs::GeoPackageTile geopackage_tile(model::TileId id, const TileOutput& output, const OutputContext& context);

/// m. Farther from its origin, the single-precision vertices of model.glb are coarser than 4 mm.
inline constexpr double kFineModelRadius = 65'536;

/// Writes tileset.json, with --single-glb model.glb from `whole`, and for a build without buildings an empty CityGML
/// file, so that every asked format is there.
/// \returns m, how far model.glb reaches from its origin; 0 without one
double write_whole(const model::Region& whole, std::span<const outputs::TileEntry> tiles, georef::LonLat centre,
                   const OutputContext& context, base::StagedFolder& folder,
                   std::vector<base::PublishedFile>& files);

}  // namespace blockrand::run
