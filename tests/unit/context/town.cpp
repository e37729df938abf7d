#include "tests/unit/context/town.h"

#include <algorithm>

#include "importers/osm/read_extract.h"
#include "pipeline/footprints/area.h"
#include "pipeline/footprints/load.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/crs.h"
#include "tests/unit/footprints/repair/repair_alone.h"

namespace blockrand::context {

Town read_town(const std::string& path) {
  Town town;
  town.extract = importers::osm::read_extract(path);
  const footprints::Area area = footprints::area_of(town.extract).value();
  town.projection = std::make_unique<georef::Projection>(
      georef::open_crs(georef::choose_crs(area.centre.lon, area.centre.lat), area.box), area.box);
  const auto project = [&](model::Location l) { return town.projection->forward(l); };

  model::Report report;
  for (const footprints::Shard& shard : footprints::make_shards(town.extract, report)) {
    model::Region tile = footprints::load_region(town.extract, shard, *town.projection);
    repair::test::repair_alone(tile);
    for (model::Building& b : tile.buildings)
      if (!b.outline.empty()) town.buildings.push_back(std::move(b));
  }
  std::sort(town.buildings.begin(), town.buildings.end(),
            [](const model::Building& a, const model::Building& b) { return a.osm < b.osm; });
  std::vector<model::Point2> corners;
  for (const model::Building& b : town.buildings) {
    const std::string_view use = town.extract.strings.view(b.mapped.use);
    for (const model::Polygon& polygon : b.outline) {
      town.footprints.push_back({b.osm, polygon, b.mapped.storeys, use == "roof"});
      corners.push_back(polygon.outer.points.front());
    }
  }
  town.lines = network_lines(town.extract, project);
  town.blocks = find_blocks(town.lines, coverage_of(corners));
  town.figures = measure_blocks(town.blocks, town.footprints, town.lines);
  town.passages = passage_ways(town.extract, project);
  town.points = site_points(town.extract, project);
  return town;
}

void label_town(Town& town) {
  const VicinityIndex index(town.vicinity());
  for (model::Building& b : town.buildings) label_wall_segments(b, index, address_street(town.extract, b.tags));
}

}  // namespace blockrand::context
