#include "pipeline/validate/detail_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "pipeline/base/random.h"

namespace blockrand::validate {
namespace {

using model::Point3;

/// A polygon's plane: Newell's normal and the mean of the outer ring's corners.
struct Plane {
  Point3 normal, mean;
  double above(const Point3& p) const {
    return (p.x - mean.x) * normal.x + (p.y - mean.y) * normal.y + (p.z - mean.z) * normal.z;
  }
};

Plane plane_of(const std::vector<Point3>& ring) {
  Plane out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point3 &o = ring[0], &p = ring[i], &q = ring[(i + 1) % ring.size()];
    out.normal.x += (p.y - o.y) * (q.z - o.z) - (p.z - o.z) * (q.y - o.y);
    out.normal.y += (p.z - o.z) * (q.x - o.x) - (p.x - o.x) * (q.z - o.z);
    out.normal.z += (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
    out.mean.x += (p.x - o.x) / static_cast<double>(ring.size());
    out.mean.y += (p.y - o.y) / static_cast<double>(ring.size());
    out.mean.z += (p.z - o.z) / static_cast<double>(ring.size());
  }
  const Point3& n = out.normal;
  const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
  if (length > 0) out.normal = {n.x / length, n.y / length, n.z / length};
  out.mean = {out.mean.x + ring[0].x, out.mean.y + ring[0].y, out.mean.z + ring[0].z};
  return out;
}

using Edge = std::pair<Point3, Point3>;

void add_edges(const ReadPolygon& polygon, std::set<Edge>& edges) {
  for (const auto& ring : polygon.rings)
    for (std::size_t i = 0; i < ring.size(); ++i) edges.emplace(ring[i], ring[(i + 1) % ring.size()]);
}

bool has_ring(const ReadPolygon& polygon) { return !polygon.rings.empty() && polygon.rings[0].size() >= 3; }

void check_placement(const ReadPlacement& placement, const std::vector<Point3>& outline, const Plane& wall,
                     const Complain& complain, const std::string& id) {
  const model::Point2 along = placement.along;
  const auto way = [&](const Point3& p) { return p.x * along.x + p.y * along.y; };
  const auto [left, right] = std::minmax_element(outline.begin(), outline.end(),
                                                 [&](const Point3& a, const Point3& b) { return way(a) < way(b); });
  const auto [low, high] =
      std::minmax_element(outline.begin(), outline.end(), [](const Point3& a, const Point3& b) { return a.z < b.z; });
  const Point3& o = placement.origin;
  if (std::fabs(wall.above(o)) > kWallTolerance ||
      std::fabs(along.x * wall.normal.x + along.y * wall.normal.y) > kWallTolerance)
    complain(fmt::format("its element does not stand in the plane of the wall ({:.3f} m off)", wall.above(o)), id);
  else if (way(o) < way(*left) - kWallTolerance || way(o) > way(*right) + kWallTolerance ||
           o.z < low->z - kWallTolerance || o.z > high->z + kWallTolerance)
    complain("its element stands outside of the opening", id);
}

}  // namespace

void check_detail(const ReadBody& body, const Complain& complain) {
  const ReadSolid* solid = nullptr;
  for (const ReadSolid& s : body.solids)
    if (s.lod == 3) solid = &s;
  if (!solid) {
    if (!body.detail.openings.empty()) complain("openings without a LoD3 solid", body.id);
    return;
  }
  std::map<std::size_t, std::set<Edge>> edges_of_wall;
  for (const ReadOpening& opening : body.detail.openings) {
    if (opening.polygon >= solid->polygons.size() || opening.wall >= solid->polygons.size()) continue;
    const ReadPolygon &polygon = solid->polygons[opening.polygon], &wall_polygon = solid->polygons[opening.wall];
    if (!has_ring(polygon) || !has_ring(wall_polygon)) continue;
    const std::vector<Point3>& outline = polygon.rings[0];
    const Plane wall = plane_of(wall_polygon.rings[0]), own = plane_of(outline);
    double nearest = 1e300, deepest = -1e300;
    for (const Point3& p : outline) {
      nearest = std::min(nearest, -wall.above(p));
      deepest = std::max(deepest, -wall.above(p));
    }
    const double cosine = wall.normal.x * own.normal.x + wall.normal.y * own.normal.y + wall.normal.z * own.normal.z;
    if (nearest < -kWallTolerance || deepest > kDeepestReveal || deepest - nearest > kWallTolerance)
      complain(fmt::format("lies {:.3f} to {:.3f} m behind its wall", nearest, deepest), opening.id);
    else if (cosine < 0.99)
      complain("does not look the way its wall looks", opening.id);
    // The first opening of a wall lists the reveals of all.
    const auto [of_wall, fresh] = edges_of_wall.try_emplace(opening.wall);
    std::set<Edge>& edges = of_wall->second;
    if (fresh) add_edges(wall_polygon, edges);
    for (const std::size_t r : opening.reveals)
      if (r < solid->polygons.size()) add_edges(solid->polygons[r], edges);
    for (std::size_t i = 0; i < outline.size(); ++i)
      if (!edges.count({outline[(i + 1) % outline.size()], outline[i]})) {
        complain("an edge of it is none of its reveal nor of its wall", opening.id);
        break;
      }
    if (opening.placement && *opening.placement < body.detail.placements.size())
      check_placement(body.detail.placements[*opening.placement], outline, wall, complain, opening.id);
  }
}

bool turns_about_the_vertical(std::span<const double> m) {
  constexpr double kTurn = 1e-6;  // what rounding to nine decimals leaves of a rotation, with room
  if (m.size() != 16) return false;
  const auto is = [&](std::size_t i, double v) { return std::fabs(m[i] - v) <= kTurn; };
  for (const std::size_t i : {2u, 3u, 6u, 7u, 8u, 9u, 11u, 12u, 13u, 14u})
    if (!is(i, 0)) return false;
  return is(10, 1) && is(15, 1) && is(5, m[0]) && is(4, -m[1]) && std::fabs(m[0] * m[0] + m[1] * m[1] - 1) <= kTurn;
}

std::string detail_difference(const ReadBody& a, const ReadBody& b) {
  const ReadDetail &x = a.detail, &y = b.detail;
  if (x.openings.size() != y.openings.size())
    return fmt::format("{} openings against {}", x.openings.size(), y.openings.size());
  if (x.placements.size() != y.placements.size())
    return fmt::format("{} placed elements against {}", x.placements.size(), y.placements.size());
  auto p = x.placements, q = y.placements;
  std::sort(p.begin(), p.end());
  std::sort(q.begin(), q.end());
  for (std::size_t i = 0; i < p.size(); ++i)
    if (p[i] != q[i])
      return fmt::format("another element, or one at another place (near {:.3f} {:.3f} {:.3f})", p[i].origin.x,
                         p[i].origin.y, p[i].origin.z);
  return installation_difference(a, b);
}

std::string installation_difference(const ReadBody& a, const ReadBody& b) {
  const ReadDetail &x = a.detail, &y = b.detail;
  if (x.installations.size() != y.installations.size())
    return fmt::format("{} installations against {}", x.installations.size(), y.installations.size());
  for (std::size_t i = 0; i < x.installations.size(); ++i) {
    const ReadInstallation &u = x.installations[i], &v = y.installations[i];
    if (u.kind != v.kind) return fmt::format("installation {} is a {} against a {}", u.id, u.kind, v.kind);
    if (element_digest(u.polygons) != element_digest(v.polygons))
      return fmt::format("installation {} has other faces or colours", u.id);
  }
  return {};
}

ReadElement element_of(std::span<const ReadPolygon> polygons) {
  ReadElement out;
  bool first = true;
  for (const ReadPolygon& polygon : polygons) {
    out.colours.push_back(polygon.colour);
    for (const auto& ring : polygon.rings)
      for (const Point3& p : ring) {
        if (first) out.min = out.max = p;
        first = false;
        out.min = {std::min(out.min.x, p.x), std::min(out.min.y, p.y), std::min(out.min.z, p.z)};
        out.max = {std::max(out.max.x, p.x), std::max(out.max.y, p.y), std::max(out.max.z, p.z)};
      }
  }
  std::sort(out.colours.begin(), out.colours.end());
  out.colours.erase(std::unique(out.colours.begin(), out.colours.end()), out.colours.end());
  return out;
}

bool reaches_beyond(const ReadPlacement& placement, const ReadElement& e, const Point3& lower, const Point3& upper) {
  const model::Point2 along = placement.along;
  const Point3& o = placement.origin;
  for (const double x : {e.min.x, e.max.x})
    for (const double y : {e.min.y, e.max.y}) {
      const double east = o.x + along.x * x - along.y * y, north = o.y + along.y * x + along.x * y;
      if (!(east >= lower.x - kRoomTolerance && east <= upper.x + kRoomTolerance && north >= lower.y - kRoomTolerance &&
            north <= upper.y + kRoomTolerance))
        return true;
    }
  return !(o.z + e.min.z >= lower.z - kRoomTolerance && o.z + e.max.z <= upper.z + kRoomTolerance);
}

std::uint64_t element_digest(std::span<const ReadPolygon> polygons) {
  std::uint64_t h = polygons.size();
  const auto mix = [&](std::uint64_t v) { h = base::mix64(h ^ v) + 0x9e3779b97f4a7c15ULL; };
  for (const ReadPolygon& polygon : polygons) {
    mix(base::hash_text(polygon.colour));
    for (const auto& ring : polygon.rings) {
      mix(ring.size());
      for (const Point3& p : ring)
        for (const double v : {p.x, p.y, p.z})
          mix(static_cast<std::uint64_t>(std::llrint(std::clamp(v, -1e12, 1e12) * 1e4)));
    }
  }
  return h;
}

}  // namespace blockrand::validate
