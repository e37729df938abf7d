// Small towns as OSM files, measured as a build measures them.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "importers/osm/read_extract.h"
#include "pipeline/context/blocks.h"
#include "pipeline/evidence/building_facts.h"
#include "pipeline/footprints/area.h"
#include "pipeline/footprints/load.h"
#include "pipeline/footprints/repair/kept_nodes.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/projection.h"

namespace blockrand::run::test {

/// Draws houses and streets in metres around a place in Berlin; equal points become one node.
class OsmTown {
 public:
  using Points = std::vector<model::Point2>;
  using Tags = std::vector<std::pair<std::string, std::string>>;

  void house(std::int64_t id, Points ring, const Tags& tags = {{"building", "yes"}}) {
    ring.push_back(ring.front());
    way(id, ring, tags);
  }
  void box(std::int64_t id, double x, double y, double width, double depth, const Tags& tags = {{"building", "yes"}}) {
    house(id, {{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}}, tags);
  }
  /// A house with a yard: a relation of two ways.
  void ring(std::int64_t id, Points outer, Points inner) {
    outer.push_back(outer.front());
    inner.push_back(inner.front());
    way(800'000 + 2 * id, outer, {});
    way(800'001 + 2 * id, inner, {});
    relation_text_ += fmt::format(
        "<relation id=\"{}\" version=\"1\"><member type=\"way\" ref=\"{}\" role=\"outer\"/><member type=\"way\" "
        "ref=\"{}\" role=\"inner\"/>"
        "<tag k=\"type\" v=\"multipolygon\"/><tag k=\"building\" v=\"yes\"/></relation>\n",
        id, 800'000 + 2 * id, 800'001 + 2 * id);
  }
  void street(std::int64_t id, const Points& line, const std::string& name, const std::string& kind = "residential") {
    way(id, line, {{"highway", kind}, {"name", name}});
  }
  void write(const std::string& path) const {
    std::ofstream(path) << "<?xml version='1.0' encoding='UTF-8'?>\n<osm version=\"0.6\" generator=\"test\">\n"
                        << node_text_ << way_text_ << relation_text_ << "</osm>\n";
  }

 private:
  std::int64_t node(model::Point2 p) {
    // The place says the id: a town and a part of it have the same nodes.
    const std::int64_t id = (std::llround(p.x * 10) + 50'000) * 1'000'000 + std::llround(p.y * 10) + 50'000;
    // Metres per degree at 52.5 degrees north on the ellipsoid.
    if (nodes_.insert(id).second)
      node_text_ += fmt::format("<node id=\"{}\" version=\"1\" lat=\"{:.7f}\" lon=\"{:.7f}\"/>\n", id,
                                52.5 + p.y / 111265.0, 13.4 + p.x / 67908.0);
    return id;
  }
  void way(std::int64_t id, const Points& points, const Tags& tags) {
    way_text_ += fmt::format("<way id=\"{}\" version=\"1\">\n", id);
    for (const model::Point2 p : points) way_text_ += fmt::format("<nd ref=\"{}\"/>", node(p));
    for (const auto& [k, v] : tags) way_text_ += fmt::format("<tag k=\"{}\" v=\"{}\"/>", k, v);
    way_text_ += "</way>\n";
  }
  std::set<std::int64_t> nodes_;
  std::string node_text_, way_text_, relation_text_;
};

/// A town read, repaired and measured.
struct MeasuredTown {
  model::Extract extract;
  std::unique_ptr<footprints::RepairedExtract> repaired;
  context::ContextExtract context;
  evidence::FactsExtract facts;

  /// \param crs_of  the projection of another town, pinned as in a build; null: its own
  explicit MeasuredTown(const OsmTown& town, const std::string& name, const MeasuredTown* crs_of = nullptr,
                        int workers = 2) {
    const std::string path = (std::filesystem::path(testing::TempDir()) / (name + ".osm")).string();
    town.write(path);
    extract = importers::osm::read_extract(path, {});
    std::filesystem::remove(path);
    const footprints::Area area = footprints::area_of(extract).value();
    projection = crs_of
                     ? crs_of->projection
                     : std::make_shared<georef::Projection>(
                           georef::open_crs(georef::choose_crs(area.centre.lon, area.centre.lat), area.box), area.box);
    base::Progress quiet;
    model::Report report;
    const auto shards = footprints::make_shards(extract, report);
    const repair::KeptNodes kept(extract);
    repaired = std::make_unique<footprints::RepairedExtract>(
        footprints::repair_extract(extract, shards, *projection, kept, {}, workers, quiet));
    context = context::context_extract(extract, repaired->footprints,
                                       context::coverage_of(footprints::building_places(extract, *projection)),
                                       *projection, workers, quiet);
    const context::VicinityFinder vicinity(extract, repaired->footprints, context);
    facts = evidence::facts_extract(extract, repaired->footprints, repaired->first, context, vicinity, workers, quiet);
  }
  std::uint32_t number(std::int64_t id, model::OsmType type = model::OsmType::way) const {
    for (std::uint32_t b = 0; b < repaired->footprints.size(); ++b)
      if (repaired->footprints[b].id == model::OsmId{type, id}) return b;
    throw std::out_of_range("no building " + std::to_string(id));
  }
  double of(std::int64_t id, classify::Feature f) const { return static_cast<double>(facts.features[number(id)][f]); }
  double of_relation(std::int64_t id, classify::Feature f) const {
    return static_cast<double>(facts.features[number(id, model::OsmType::relation)][f]);
  }
  bool knows(std::int64_t id, classify::Feature f) const { return facts.features[number(id)].has(f); }

  std::shared_ptr<georef::Projection> projection;
};

}  // namespace blockrand::run::test
