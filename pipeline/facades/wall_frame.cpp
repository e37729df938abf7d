#include "pipeline/facades/wall_frame.h"

#include <algorithm>
#include <cmath>

namespace blockrand::facades {

using model::Point2;
using model::Point3;

std::optional<WallFrame> wall_frame(const model::Solid& solid, std::uint32_t face) {
  const model::Face& looks = solid.faces[face];
  if (looks.kind != model::SurfaceKind::wall || looks.loop_count == 0) return std::nullopt;
  const auto loops = solid.loops_of(looks);
  const auto outer = solid.indices_of(loops[0]);
  // Newell's normal, relative to a corner of the face.
  const Point3 origin = solid.vertices[outer[0]];
  double nx = 0, ny = 0, nz = 0;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const Point3& p = solid.vertices[outer[i]];
    const Point3& q = solid.vertices[outer[i + 1 == outer.size() ? 0 : i + 1]];
    const double px = p.x - origin.x, py = p.y - origin.y, pz = p.z - origin.z;
    const double qx = q.x - origin.x, qy = q.y - origin.y, qz = q.z - origin.z;
    nx += py * qz - pz * qy;
    ny += pz * qx - px * qz;
    nz += px * qy - py * qx;
  }
  const double across = std::sqrt(nx * nx + ny * ny);
  if (!(across > 0)) return std::nullopt;
  WallFrame frame;
  frame.face = face;
  // The two points farthest apart in plan give the direction more exactly than the normal does.
  const Point2 rough{-ny / across, nx / across};
  const auto place = [&](const Point3& p) { return (p.x - origin.x) * rough.x + (p.y - origin.y) * rough.y; };
  Point3 left = origin, right = origin;
  double low = origin.z, high = origin.z;
  for (const std::uint32_t i : outer) {
    const Point3& p = solid.vertices[i];
    const double u = place(p), l = place(left), r = place(right);
    if (u < l || (u == l && p < left)) left = p;
    if (u > r || (u == r && p < right)) right = p;
    low = std::min(low, p.z);
    high = std::max(high, p.z);
  }
  const double dx = right.x - left.x, dy = right.y - left.y;
  frame.length = std::sqrt(dx * dx + dy * dy);
  if (!(frame.length >= kShortestWall)) return std::nullopt;
  frame.start = left.xy();
  frame.along = {dx / frame.length, dy / frame.length};
  frame.base = low;
  frame.height = high - low;
  const Point2 out = frame.outward();
  for (const model::Solid::Loop& loop : loops) {
    auto& flat = frame.loops.emplace_back();
    for (const std::uint32_t i : solid.indices_of(loop)) {
      const Point3& p = solid.vertices[i];
      const Point2 d{p.x - left.x, p.y - left.y};
      if (std::fabs(d.x * out.x + d.y * out.y) > kLeaningWall) return std::nullopt;
      flat.push_back({d.x * frame.along.x + d.y * frame.along.y, p.z - low});
    }
  }
  return frame;
}

}  // namespace blockrand::facades
