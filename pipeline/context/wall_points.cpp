#include "pipeline/context/wall_points.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pipeline/geometry/polygon.h"

namespace blockrand::context {

namespace {

using model::EdgeKind;
using model::FacadeEdge;
using model::Point2;

/// m. Distances that differ by less are the same: repair has moved corners.
constexpr double kSame = 0.05;

int rank(EdgeKind kind) {
  switch (kind) {
    case EdgeKind::street: return 0;
    case EdgeKind::passage: return 1;
    case EdgeKind::courtyard: return 2;
    default: return 3;
  }
}

}  // namespace

void assign_points(model::Building& building, const std::vector<OutlineEdge>& outline, const SurroundingsIndex& index) {
  building.trees.clear();
  const std::vector<std::uint32_t> near = index.points_near(box_of(building, kTreeReach));
  if (near.empty() || building.edges.empty()) return;
  std::vector<const OutlineEdge*> of;
  std::size_t at = 0;
  for (const FacadeEdge& f : building.edges) {
    while (outline[at].polygon != f.polygon || outline[at].ring != f.ring || outline[at].edge != f.edge) ++at;
    of.push_back(&outline[at]);
  }
  for (const std::uint32_t p : near) {
    const SitePoint& point = index.all().points[p];
    if (point.kind == SitePointKind::address) continue;
    const bool tree = point.kind == SitePointKind::tree;
    const double reach = tree ? kTreeReach : kEntranceReach;
    std::vector<double> distances(building.edges.size(), std::numeric_limits<double>::infinity());
    double least = reach;
    for (std::size_t i = 0; i < building.edges.size(); ++i) {
      const FacadeEdge& f = building.edges[i];
      if (f.kind == EdgeKind::party_wall) continue;
      const OutlineEdge& edge = *of[i];
      const bool behind = (point.place.x - edge.a.x) * edge.outward.x + (point.place.y - edge.a.y) * edge.outward.y < 0;
      if (tree && behind) continue;
      distances[i] = geometry::distance_to_segment(point.place, edge.at(f.start), edge.at(f.end));
      least = std::min(least, distances[i]);
    }
    std::size_t best = building.edges.size();
    const auto key = [&](std::size_t i) {
      const FacadeEdge& f = building.edges[i];
      return std::tuple(rank(f.kind), -f.length(), i);
    };
    for (std::size_t i = 0; i < building.edges.size(); ++i)
      if (distances[i] <= reach && distances[i] <= least + kSame && (best == building.edges.size() || key(i) < key(best))) best = i;
    if (best == building.edges.size()) continue;
    if (tree)
      building.trees.push_back({point.id, point.place, static_cast<std::uint32_t>(best), static_cast<float>(distances[best])});
    else
      ++building.edges[best].entrances;
  }
  std::sort(building.trees.begin(), building.trees.end(),
            [](const model::NearTree& a, const model::NearTree& b) { return a.id < b.id; });
}

}  // namespace blockrand::context
