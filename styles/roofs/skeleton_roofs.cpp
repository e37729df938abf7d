// Hipped and gabled roofs on any plan, by the straight skeleton.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "pipeline/geometry/straight_skeleton.h"
#include "styles/roofs/roof.h"

namespace blockrand::roofs {

using geometry::StraightSkeleton;
using model::Point2;
using model::Point3;
using model::Polygon;

namespace {

/// m. Skeleton nodes nearer than this become one: simultaneous events come as several nodes a rounding apart, and a
/// face edge shorter than a few grid steps would have no reliable direction. Moves a node by less than a roof tile's
/// tolerance and keeps faces plane within the checker's 0.01 m up to pitches of 60 degrees.
constexpr double kMergeDistance = 0.005;
/// The gable's ridge must meet its edge in the middle part; elsewhere a hip looks better than a lopsided gable.
constexpr double kGableShare = 0.15;
/// m. A wider end is no gable of a wing but the side of a hall.
constexpr double kWidestGable = 30.0;

/// The skeleton with near nodes merged: `faces[edge]` holds node numbers without repetitions.
struct Merged {
  std::vector<geometry::SkeletonNode> nodes;
  std::vector<std::vector<std::uint32_t>> faces;
};

Merged merge_near_nodes(const StraightSkeleton& skeleton) {
  std::vector<std::uint32_t> parent(skeleton.nodes.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& face : skeleton.faces) {
    for (std::size_t i = 0; i < face.nodes.size(); ++i) {
      const std::uint32_t a = face.nodes[i], b = face.nodes[(i + 1) % face.nodes.size()];
      const auto &na = skeleton.nodes[a], &nb = skeleton.nodes[b];
      if (na.contour && nb.contour) continue;
      const double dx = na.point.x - nb.point.x, dy = na.point.y - nb.point.y;
      if (dx * dx + dy * dy > kMergeDistance * kMergeDistance) continue;
      const std::uint32_t ra = root(a), rb = root(b);
      if (ra == rb || (skeleton.nodes[ra].contour && skeleton.nodes[rb].contour)) continue;
      // Corners have the lowest numbers, so they stay.
      parent[std::max(ra, rb)] = std::min(ra, rb);
    }
  }
  Merged out;
  out.nodes = skeleton.nodes;
  for (const auto& face : skeleton.faces) {
    std::vector<std::uint32_t> loop;
    for (const std::uint32_t n : face.nodes) {
      const std::uint32_t r = root(n);
      if (loop.empty() || loop.back() != r) loop.push_back(r);
    }
    while (loop.size() > 1 && loop.back() == loop.front()) loop.pop_back();
    out.faces.push_back(std::move(loop));
  }
  return out;
}

struct Height {
  Point2 point;
  double above_eaves;
};

/// Surfaces over the plan from merged faces, node places and heights; `gable[edge]` holds the node at a gable's top.
Roof assemble(const Polygon& plan, const Merged& merged, const std::vector<Height>& heights,
              const std::vector<std::int32_t>& gable, RoofMeasures measures) {
  double most = 0;
  for (const auto& face : merged.faces)
    for (const std::uint32_t n : face) most = std::max(most, heights[n].above_eaves);
  const double scale = most > 0 ? measures.height / most : 0;
  const auto point = [&](std::uint32_t n) {
    return Point3{heights[n].point.x, heights[n].point.y, measures.eaves + scale * heights[n].above_eaves};
  };
  Roof roof;
  std::uint32_t edge = 0;
  const auto add_ring = [&](const model::Ring& ring) {
    const std::uint32_t first = edge;
    for (std::size_t i = 0; i < ring.size(); ++i, ++edge) {
      const std::uint32_t from = edge, to = first + static_cast<std::uint32_t>((i + 1) % ring.size());
      if (gable[edge] >= 0) {
        roof.wall_tops.push_back({point(to), point(static_cast<std::uint32_t>(gable[edge])), point(from)});
        continue;
      }
      roof.wall_tops.push_back({point(to), point(from)});
      Roof::Surface surface{static_cast<std::int32_t>(edge), {{}}};
      for (const std::uint32_t n : merged.faces[edge]) surface.loops[0].push_back(point(n));
      roof.surfaces.push_back(std::move(surface));
    }
  };
  add_ring(plan.outer);
  for (const model::Ring& hole : plan.holes) add_ring(hole);
  return roof;
}

std::vector<Height> heights_of(const Merged& merged) {
  std::vector<Height> heights;
  for (const auto& node : merged.nodes) heights.push_back({node.point, node.time});
  return heights;
}

}  // namespace

std::optional<Roof> hipped_roof(const Polygon& plan, RoofMeasures measures) {
  const auto skeleton = geometry::straight_skeleton(plan);
  if (!skeleton) return std::nullopt;
  const Merged merged = merge_near_nodes(*skeleton);
  return assemble(plan, merged, heights_of(merged), std::vector<std::int32_t>(merged.faces.size(), -1), measures);
}

std::optional<GabledRoof> gabled_roof(const Polygon& plan, RoofMeasures measures) {
  const auto skeleton = geometry::straight_skeleton(plan);
  if (!skeleton) return std::nullopt;
  const Merged merged = merge_near_nodes(*skeleton);
  std::vector<std::set<std::uint32_t>> neighbours(merged.nodes.size());
  for (const auto& face : merged.faces)
    for (std::size_t i = 0; i < face.size(); ++i) {
      const std::uint32_t a = face[i], b = face[(i + 1) % face.size()];
      neighbours[a].insert(b);
      neighbours[b].insert(a);
    }
  std::vector<Height> heights = heights_of(merged);
  std::vector<std::int32_t> gable(merged.faces.size(), -1);
  GabledRoof out;
  for (std::size_t edge = 0; edge < merged.faces.size(); ++edge) {
    const auto& face = merged.faces[edge];
    if (face.size() != 3) continue;
    // The two corners come first; the third node is where the hip's end would meet the ridge.
    const std::uint32_t a = face[0], b = face[1], n = face[2];
    if (merged.nodes[n].contour || neighbours[n].size() != 3) continue;
    std::uint32_t m = n;
    for (const std::uint32_t k : neighbours[n])
      if (k != a && k != b) m = k;
    if (m == n || merged.nodes[m].contour) continue;
    const Point2 pa = merged.nodes[a].point, pb = merged.nodes[b].point;
    const Point2 pm = merged.nodes[m].point, pn = merged.nodes[n].point;
    const double ex = pb.x - pa.x, ey = pb.y - pa.y, dx = pn.x - pm.x, dy = pn.y - pm.y;
    if (ex * ex + ey * ey > kWidestGable * kWidestGable) continue;
    const double determinant = dx * ey - dy * ex;
    if (determinant == 0) continue;
    // m + t (n - m) = a + u (b - a): the ridge led on beyond n meets the edge.
    const double t = ((pa.x - pm.x) * ey - (pa.y - pm.y) * ex) / determinant;
    const double u = ((pa.x - pm.x) * dy - (pa.y - pm.y) * dx) / determinant;
    if (t <= 1 || u < kGableShare || u > 1 - kGableShare) continue;
    const double rise = merged.nodes[n].time - merged.nodes[m].time;
    const double above = merged.nodes[m].time + t * rise;
    // A ridge that climbs or falls steeply towards the gable belongs to a plan that tapers: keep the hip.
    if (above < 0.5 * merged.nodes[n].time || above > 2 * merged.nodes[n].time) continue;
    heights[n] = {{pm.x + t * dx, pm.y + t * dy}, above};
    gable[edge] = static_cast<std::int32_t>(n);
    ++out.gables;
  }
  out.roof = assemble(plan, merged, heights, gable, measures);
  return out;
}

}  // namespace blockrand::roofs
