// Small towns as OSM files, with what stands around their houses.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "importers/osm/read_extract.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/context/vicinity_finder.h"
#include "pipeline/footprints/area.h"
#include "pipeline/footprints/load.h"
#include "pipeline/footprints/repair/kept_nodes.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/surroundings/surroundings.h"

namespace blockrand::surroundings::test {

inline const Catalogue& catalogue() {
  static const Catalogue read(std::string(BLOCKRAND_SOURCE_DIR) + "/configs/surroundings.toml");
  return read;
}

/// Draws in metres around a place in Berlin; equal points are one node.
class Town {
 public:
  using Points = std::vector<model::Point2>;
  using Tags = std::vector<std::pair<std::string, std::string>>;

  /// \return the id of the node
  std::int64_t point(model::Point2 p, const Tags& tags = {}) {
    const std::int64_t id = (std::llround(p.x * 10) + 50'000) * 1'000'000 + std::llround(p.y * 10) + 50'000;
    if (!nodes_.insert(id).second) return id;
    nodes_text_ += fmt::format("<node id=\"{}\" version=\"1\" lat=\"{:.7f}\" lon=\"{:.7f}\">", id,
                               52.5 + p.y / 111265.0, 13.4 + p.x / 67908.0);
    add(nodes_text_, tags);
    nodes_text_ += "</node>\n";
    return id;
  }
  void way(std::int64_t id, const Points& points, const Tags& tags) {
    for (const model::Point2 p : points) point(p);
    ways_text_ += fmt::format("<way id=\"{}\" version=\"1\">", id);
    for (const model::Point2 p : points) ways_text_ += fmt::format("<nd ref=\"{}\"/>", point(p));
    add(ways_text_, tags);
    ways_text_ += "</way>\n";
  }
  void box(std::int64_t id, double x0, double y0, double x1, double y1, const Tags& tags) {
    way(id, {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}, {x0, y0}}, tags);
  }
  std::string text() const {
    return "<?xml version='1.0' encoding='UTF-8'?>\n<osm version=\"0.6\" generator=\"test\">\n" + nodes_text_ +
           ways_text_ + "</osm>\n";
  }

 private:
  static void add(std::string& out, const Tags& tags) {
    for (const auto& [k, v] : tags) out += fmt::format("<tag k=\"{}\" v=\"{}\"/>", k, v);
  }
  std::set<std::int64_t> nodes_;
  std::string nodes_text_, ways_text_;
};

/// A town read, with the surroundings of all its tiles. Places are in metres from the town's origin.
class BuiltTown {
 public:
  /// \param height  of the terrain by place from the origin, m; empty: level
  explicit BuiltTown(const Town& town, const std::function<double(model::Point2)>& height = {},
                     SurroundingOptions layers = {.ground = true, .bodies = true, .objects = true}) {
    const std::string path = (std::filesystem::path(testing::TempDir()) /
                              (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".osm"))
                                 .string();
    std::ofstream(path) << town.text();
    importers::osm::ReadOptions options;
    options.surroundings = true;
    extract_ = importers::osm::read_extract(path, options);
    std::filesystem::remove(path);
    const footprints::Area area = footprints::area_of(extract_).value();
    projection_ = std::make_unique<georef::Projection>(
        georef::open_crs(georef::choose_crs(area.centre.lon, area.centre.lat), area.box), area.box);
    base::Progress quiet;
    model::Report report;
    const auto shards = footprints::make_shards(extract_, report);
    const repair::KeptNodes kept(extract_);
    repaired_ = std::make_unique<footprints::RepairedExtract>(
        footprints::repair_extract(extract_, shards, *projection_, kept, {}, 1, quiet));
    context_ = context::context_extract(extract_, repaired_->footprints,
                                        context::coverage_of(footprints::building_places(extract_, *projection_)),
                                        *projection_, 1, quiet);
    vicinity_ = std::make_unique<context::VicinityFinder>(extract_, repaired_->footprints, context_);
    origin_ = projection_->forward(13.4, 52.5);
    // Metres of the town and of the build CRS differ by its convergence of meridians.
    constexpr double kFar = 1000;
    const model::Point2 far = projection_->forward(13.4 + kFar / 67908.0, 52.5);
    east_ = {(far.x - origin_.x) / kFar, (far.y - origin_.y) / kFar};
    HeightAt at;
    if (height) at = [this, height](model::Point2 p) { return std::optional(height(in_town(p))); };
    finder_ = std::make_unique<SurroundingsFinder>(
        SurroundingInputs{extract_, repaired_->footprints, context_, *vicinity_, *projection_, catalogue()}, layers, at,
        0, 1);
    std::set<model::TileId> tiles;
    for (const model::Location& v : extract_.vertices) {
      const model::TileId tile = georef::tile_of(v, footprints::kTileLevel);
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy) {
          model::TileId near = tile;
          near.x += static_cast<decltype(near.x)>(dx), near.y += static_cast<decltype(near.y)>(dy);
          tiles.insert(near);
        }
    }
    for (const model::TileId tile : tiles) {
      model::Surroundings one = finder_->around(tile);
      std::ranges::move(one.surfaces, std::back_inserter(all_.surfaces));
      std::ranges::move(one.bodies, std::back_inserter(all_.bodies));
      std::ranges::move(one.objects, std::back_inserter(all_.objects));
      for (const model::SurroundingOutcome& outcome : one.outcomes) {
        const auto [known, added] = states_.try_emplace(outcome.object, outcome.state);
        if (!added) known->second = std::min(known->second, outcome.state);
      }
    }
  }

  const model::Surroundings& all() const { return all_; }
  const SurroundingsFinder& finder() const { return *finder_; }
  std::optional<model::SurroundingState> state(model::OsmId id) const {
    const auto known = states_.find(id);
    return known == states_.end() ? std::nullopt : std::optional(known->second);
  }
  /// All corners of the bodies of a class, in metres from the origin.
  std::vector<model::Point3> corners(model::BodyClass kind) const {
    std::vector<model::Point3> out;
    for (const model::SurroundingBody& body : all_.bodies)
      if (body.body == kind)
        for (const model::FlatPolygon& face : body.faces)
          for (const model::Point3& p : face.outer) {
            const model::Point2 at = in_town({p.x, p.y});
            out.push_back({at.x, at.y, p.z});
          }
    return out;
  }
  /// m² of the faces of a body class that look up, and in plan of all ground.
  double top_area(model::BodyClass kind) const {
    double sum = 0;
    for (const model::SurroundingBody& body : all_.bodies)
      if (body.body == kind)
        for (const model::FlatPolygon& face : body.faces) sum += std::max(0.0, plan_area(face.outer));
    return sum;
  }
  double ground_area() const {
    double sum = 0;
    for (const model::GroundSurface& surface : all_.surfaces)
      for (const model::FlatPolygon& face : surface.faces) {
        sum += plan_area(face.outer);
        for (const auto& hole : face.holes) sum += plan_area(hole);
      }
    return sum;
  }
  /// A place in metres from the town's origin in the build CRS.
  model::Point2 from_town(model::Point2 p) const {
    return {origin_.x + p.x * east_.x - p.y * east_.y, origin_.y + p.x * east_.y + p.y * east_.x};
  }
  /// A place of the build CRS in metres from the town's origin.
  model::Point2 in_town(model::Point2 p) const {
    const double x = p.x - origin_.x, y = p.y - origin_.y;
    return {x * east_.x + y * east_.y, y * east_.x - x * east_.y};
  }

 private:
  static double plan_area(const std::vector<model::Point3>& ring) {
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const model::Point3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
      sum += ((a.x - ring[0].x) * (b.y - ring[0].y) - (b.x - ring[0].x) * (a.y - ring[0].y)) / 2;
    }
    return sum;
  }

  model::Extract extract_;
  std::unique_ptr<georef::Projection> projection_;
  std::unique_ptr<footprints::RepairedExtract> repaired_;
  context::ContextExtract context_;
  std::unique_ptr<context::VicinityFinder> vicinity_;
  std::unique_ptr<SurroundingsFinder> finder_;
  model::Surroundings all_;
  std::map<model::OsmId, model::SurroundingState> states_;
  model::Point2 origin_, east_{1, 0};
};

/// Lowest and highest of some heights.
inline std::pair<double, double> heights_of(const std::vector<model::Point3>& points) {
  double low = 1e9, high = -1e9;
  for (const model::Point3& p : points) low = std::min(low, p.z), high = std::max(high, p.z);
  return {low, high};
}

}  // namespace blockrand::surroundings::test
