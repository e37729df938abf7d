#include "pipeline/footprints/move_buildings.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::footprints {

namespace {

using model::Extract;
using model::Feature;
using model::FeatureKind;
using model::Location;
using model::MappedBuilding;
using model::MappedRing;
using model::Point2;

/// m: outlines are written in millimetres.
constexpr double kRounded = 0.002;

constexpr FeatureKind kOnBuildings[] = {FeatureKind::roof_line, FeatureKind::roof_apex, FeatureKind::entrance,
                                        FeatureKind::address,   FeatureKind::shop,      FeatureKind::amenity};

class Mover {
 public:
  Mover(Extract& extract, std::span<const Shard> shards, std::span<const MovedBuilding> moved,
        const georef::Projection& projection)
      : extract_(extract), moved_(moved), projection_(projection) {
    std::vector<const Seed*> seeds;
    for (const Shard& shard : shards)
      for (const Seed& seed : shard.seeds) seeds.push_back(&seed);
    std::vector<geometry::PlanBox> boxes(moved.size());
    outlines_.resize(moved.size());
    for (std::size_t k = 0; k < moved.size(); ++k) {
      const Seed& seed = *seeds[moved[k].building];
      if (seed.outline != model::kNoIndex) take(seed.outline, k);
      for (const std::uint32_t part : seed.parts) take(part, k);
      for (const auto& ring : outlines_[k]) boxes[k].include(geometry::box_of(ring));
    }
    boxes_ = geometry::BoxIndex(std::move(boxes));
  }

  void run() {
    if (extract_.mapped_vertices.empty()) extract_.mapped_vertices = extract_.vertices;
    for (const Feature& feature : extract_.features) move_feature(feature);
    for (const auto& [vertices, k] : rings_)
      for (std::uint32_t v = vertices.first; v < vertices.first + vertices.count; ++v) move(v, k);
  }

 private:
  /// Notes what is mapped of an object, before anything moves.
  void take(std::uint32_t object, std::size_t k) {
    const MappedBuilding& mapped = extract_.buildings[object];
    for (const MappedRing& ring : extract_.rings_of(mapped.rings)) {
      rings_.emplace_back(ring.vertices, k);
      for (const std::int64_t node : extract_.nodes_of(ring))
        if (node != 0) by_node_.emplace(node, k);
      if (ring.inner) continue;
      outlines_[k].emplace_back();
      for (const Location at : extract_.vertices_of(ring)) outlines_[k].back().push_back(projection_.forward(at));
    }
  }

  void move(std::uint32_t vertex, std::size_t k) {
    Location& at = extract_.vertices[vertex];
    const Point2 before = projection_.forward(at);
    if (!std::isfinite(before.x) || !std::isfinite(before.y)) return;
    const georef::LonLat after = projection_.inverse(moved_[k].movement(before));
    if (!std::isfinite(after.lon) || std::fabs(after.lon) > 180 || std::fabs(after.lat) > 90) return;
    at = {static_cast<std::int32_t>(std::lround(after.lon * 1e7)),
          static_cast<std::int32_t>(std::lround(after.lat * 1e7))};
  }

  /// The moved building on whose outline all of a feature lies.
  std::size_t holder(const Feature& feature) const {
    geometry::PlanBox box;
    std::vector<Point2> points;
    for (const MappedRing& ring : extract_.rings_of(feature.rings))
      for (const Location at : extract_.vertices_of(ring)) {
        points.push_back(projection_.forward(at));
        box.include(points.back());
      }
    if (points.empty()) return moved_.size();
    for (const std::uint32_t k : boxes_.near(box, 0)) {
      const bool all = std::ranges::all_of(points, [&](Point2 p) {
        return std::ranges::any_of(outlines_[k], [&](const auto& ring) { return geometry::contains(ring, p); });
      });
      if (all) return k;
    }
    return moved_.size();
  }

  void move_feature(const Feature& feature) {
    std::size_t within = moved_.size();
    if (!feature.area && std::ranges::any_of(kOnBuildings, [&](FeatureKind kind) { return feature.is(kind); }))
      within = holder(feature);
    for (const MappedRing& ring : extract_.rings_of(feature.rings))
      for (std::uint32_t i = 0; i < ring.vertices.count; ++i) {
        const std::uint32_t v = ring.vertices.first + i;
        const auto node = by_node_.find(extract_.vertex_nodes[v]);
        const std::size_t k = node != by_node_.end() ? node->second : within;
        if (k < moved_.size()) move(v, k);
      }
  }

  Extract& extract_;
  std::span<const MovedBuilding> moved_;
  const georef::Projection& projection_;
  std::vector<std::pair<model::Range, std::size_t>> rings_;  ///< of the buildings, with their place in moved_
  std::unordered_map<std::int64_t, std::size_t> by_node_;    ///< the first that has the node
  std::vector<std::vector<std::vector<Point2>>> outlines_;   ///< outer rings, as mapped
  geometry::BoxIndex boxes_;
};

}  // namespace

Point2 Movement::rigid(Point2 p) const {
  const base::SinCos t = base::sin_cos(turn * base::kRadiansPerDegree);
  const double x = p.x - centre.x, y = p.y - centre.y;
  return {centre.x + x * t.cos - y * t.sin + shift.x, centre.y + x * t.sin + y * t.cos + shift.y};
}

Point2 Movement::operator()(Point2 p) const {
  const Point2 moved = rigid(p);
  double nearest = 0, along = 0;
  std::size_t ring = reshape.before.size(), wall = 0;
  for (std::size_t r = 0; r < reshape.before.size(); ++r) {
    const std::vector<Point2>& points = reshape.before[r];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point2 a = points[i], b = points[(i + 1) % points.size()], d{b.x - a.x, b.y - a.y};
      const double squared = d.x * d.x + d.y * d.y;
      const double t = squared > 0 ? std::clamp(((p.x - a.x) * d.x + (p.y - a.y) * d.y) / squared, 0.0, 1.0) : 0;
      const Point2 off{p.x - a.x - t * d.x, p.y - a.y - t * d.y};
      const double distance = off.x * off.x + off.y * off.y;
      if (ring < reshape.before.size() && distance >= nearest) continue;
      nearest = distance, along = t, ring = r, wall = i;
    }
  }
  if (ring == reshape.before.size()) return moved;
  const auto beside = [&](std::size_t i) {
    const Point2 without = rigid(reshape.before[ring][i]), with = reshape.after[ring][i];
    const Point2 by{with.x - without.x, with.y - without.y};
    return by.x * by.x + by.y * by.y > kRounded * kRounded ? by : Point2{};
  };
  const Point2 begin = beside(wall), end = beside((wall + 1) % reshape.before[ring].size());
  return {moved.x + begin.x * (1 - along) + end.x * along, moved.y + begin.y * (1 - along) + end.y * along};
}

void move_buildings(Extract& extract, std::span<const Shard> shards, std::span<const MovedBuilding> moved,
                    const georef::Projection& projection) {
  Mover(extract, shards, moved, projection).run();
}

}  // namespace blockrand::footprints
