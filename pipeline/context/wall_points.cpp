#include "pipeline/context/wall_points.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "pipeline/context/point_owner.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::context {

namespace {

using model::Point2;
using model::WallSegment;
using model::WallSegmentKind;

int rank(WallSegmentKind kind) {
  switch (kind) {
    case WallSegmentKind::street:
      return 0;
    case WallSegmentKind::passage:
      return 1;
    case WallSegmentKind::courtyard:
      return 2;
    case WallSegmentKind::unknown:
    case WallSegmentKind::side:
    case WallSegmentKind::party_wall:
      break;
  }
  return 3;
}

/// Distances of places to the wall segments of a building.
class WallSegments {
 public:
  WallSegments(const model::Building& building, const std::vector<OutlineEdge>& outline) : building_(building) {
    std::size_t at = 0;
    for (const WallSegment& f : building.edges) {
      while (outline[at].polygon != f.polygon || outline[at].ring != f.ring || outline[at].edge != f.edge) ++at;
      of_.push_back(&outline[at]);
    }
  }

  double distance(std::size_t i, Point2 p) const {
    return geometry::distance_to_segment(p, of_[i]->at(edge(i).start), of_[i]->at(edge(i).end));
  }

  /// The nearest wall segment within `reach` for which `allowed(i)` holds; of those as near the one of the least `key(i)`,
  /// then the longer, then the earlier.
  template <class Allowed, class Key>
  std::optional<std::uint32_t> nearest(Point2 p, double reach, Allowed&& allowed, Key&& key) const {
    std::vector<std::pair<double, std::uint32_t>> found;
    double least = reach;
    for (std::uint32_t i = 0; i < building_.edges.size(); ++i) {
      if (edge(i).kind == WallSegmentKind::party_wall || !allowed(i)) continue;
      found.emplace_back(distance(i, p), i);
      least = std::min(least, found.back().first);
    }
    std::erase_if(found, [&](const auto& f) { return f.first > std::min(reach, least + kSameDistance); });
    const auto order = [&](std::uint32_t i) { return std::tuple(key(i), -edge(i).length(), i); };
    const auto best = std::min_element(found.begin(), found.end(),
                                       [&](const auto& a, const auto& b) { return order(a.second) < order(b.second); });
    return best == found.end() ? std::nullopt : std::optional(best->second);
  }

  bool is_before(std::size_t i, Point2 p) const {
    const OutlineEdge& e = *of_[i];
    return (p.x - e.a.x) * e.outward.x + (p.y - e.a.y) * e.outward.y >= 0;
  }
  const WallSegment& edge(std::size_t i) const { return building_.edges[i]; }

 private:
  const model::Building& building_;
  std::vector<const OutlineEdge*> of_;
};

/// Where repair has put the node, if the outline has it; else where it was mapped.
Point2 place_at(const model::Building& building, const SitePoint& point) {
  for (const model::Polygon& polygon : building.outline)
    if (const auto corner = corner_of_node(polygon, point.id)) return *corner;
  return point.place;
}

/// The wall segment that an entrance, address or shop of the building belongs to.
std::optional<std::uint32_t> wall_segment_of(const SitePoint& point, Point2 place, const WallSegments& walls) {
  const auto at_its_street = [&](std::uint32_t i) {
    return !point.street.empty() && walls.edge(i).street_name == point.street;
  };
  const auto is_street = [&](std::uint32_t i) { return walls.edge(i).kind == WallSegmentKind::street; };
  const auto any = [](std::uint32_t) { return true; };
  const auto by_kind = [&](std::uint32_t i) { return std::pair(!at_its_street(i), rank(walls.edge(i).kind)); };
  if (const auto near = walls.nearest(place, kEntranceReach, any, by_kind)) return near;
  if (point.house_number.empty() && point.use.empty()) return std::nullopt;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  if (const auto own = walls.nearest(place, kFar, at_its_street, by_kind)) return own;
  if (const auto front = walls.nearest(place, kFar, is_street, by_kind)) return front;
  return walls.nearest(place, kFar, any, by_kind);
}

void add_tree(model::Building& building, const SitePoint& tree, const WallSegments& walls) {
  const auto before = [&](std::uint32_t i) { return walls.is_before(i, tree.place); };
  const auto by_kind = [&](std::uint32_t i) { return rank(walls.edge(i).kind); };
  if (const auto best = walls.nearest(tree.place, kTreeReach, before, by_kind))
    building.trees.push_back({tree.id, tree.place, *best, static_cast<float>(walls.distance(*best, tree.place))});
}

bool is_within(const VicinityIndex::Box& box, Point2 p) {
  return box.low.x <= p.x && p.x <= box.high.x && box.low.y <= p.y && p.y <= box.high.y;
}

}  // namespace

void assign_points(model::Building& building, const std::vector<OutlineEdge>& outline, const VicinityIndex& index,
                   const WallSegmentOptions& options) {
  building.trees.clear();
  const std::vector<std::uint32_t> near = index.points_near(box_of(building, kTreeReach));
  if (near.empty() || building.edges.empty()) return;
  const VicinityIndex::Box own = box_of(building, kEntranceReach);
  const WallSegments walls(building, outline);
  for (const std::uint32_t p : near) {
    const SitePoint& point = index.all().points[p];
    if (point.kind == SitePointKind::tree) {
      add_tree(building, point, walls);
      continue;
    }
    const bool entrance = point.kind == SitePointKind::entrance;
    if ((!entrance && point.house_number.empty() && point.use.empty()) || !is_within(own, point.place)) continue;
    if (owner_of(point, index, options) != building.osm) continue;
    const auto wall_segment = wall_segment_of(point, place_at(building, point), walls);
    if (!wall_segment) continue;
    WallSegment& edge = building.edges[*wall_segment];
    edge.points.push_back({point.id, point.place, entrance, point.house_number, point.use});
    edge.entrances += entrance;
  }
  for (WallSegment& edge : building.edges)
    std::sort(edge.points.begin(), edge.points.end(),
              [](const model::WallPoint& a, const model::WallPoint& b) { return a.id < b.id; });
  std::sort(building.trees.begin(), building.trees.end(),
            [](const model::NearTree& a, const model::NearTree& b) { return a.id < b.id; });
}

}  // namespace blockrand::context
