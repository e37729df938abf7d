// A real extract as the edge labels see it, for tests.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pipeline/context/wall_segments.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/region.h"

namespace blockrand::context {

struct Town {
  model::Extract extract;
  std::unique_ptr<georef::Projection> projection;
  std::vector<model::Building> buildings;  ///< repaired one by one, ascending by id
  std::vector<Footprint> footprints;
  std::vector<NetworkLine> lines;
  std::vector<Block> blocks;
  std::vector<BlockFigures> figures;
  std::vector<PassageWay> passages;
  std::vector<SitePoint> points;
  Vicinity vicinity() const { return {footprints, lines, blocks, figures, passages, points}; }
};

/// Reads a file of ../shared/data/osm through import, projection, repair, blocks. Throws when the file is not there.
Town read_town(const std::string& path);

/// Labels all buildings of a town.
void label_town(Town& town);

}  // namespace blockrand::context
