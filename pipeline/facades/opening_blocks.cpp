#include "pipeline/facades/opening_blocks.h"

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::facades {

using model::Point2;
using model::Point3;

bool Block::valid() const {
  for (int i = 0; i < 4; ++i)
    if (!(cross(plan[i], plan[(i + 1) % 4], plan[(i + 2) % 4]) > 0)) return false;
  return true;
}

bool Block::contains(Point2 p) const {
  for (int i = 0; i < 4; ++i)
    if (cross(plan[i], plan[(i + 1) % 4], p) < 0) return false;
  return true;
}

bool Block::meets_segment(Point2 a, Point2 b) const {
  if (contains(a) || contains(b)) return true;
  for (int i = 0; i < 4; ++i)
    if (segments_meet(plan[i], plan[(i + 1) % 4], a, b)) return true;
  return false;
}

bool Block::meets(const Block& other) const {
  if (high < other.low || other.high < low || box.apart(other.box, 0)) return false;
  for (int i = 0; i < 4; ++i)
    if (other.meets_segment(plan[i], plan[(i + 1) % 4])) return true;
  return contains(other.plan[0]);
}

Obstacles::Obstacles(const model::Solid& solid) {
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    if (const auto frame = wall_frame(solid, f)) {
      const std::array<Point2, 2> ends{frame->start, frame->at({frame->length, 0}).xy()};
      uprights_.push_back({ends[0], ends[1], box_of(ends), frame->base, frame->base + frame->height, f});
    } else {
      add_slope(solid, f);
    }
  }
}

void Obstacles::add_slope(const model::Solid& solid, std::uint32_t f) {
  const model::Face& face = solid.faces[f];
  if (face.loop_count == 0) return;
  Slope slope;
  double nx = 0, ny = 0, nz = 0;
  const auto outer = solid.indices_of(solid.loops_of(face)[0]);
  slope.at = solid.vertices[outer[0]];
  slope.low = slope.high = slope.at.z;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const Point3& p = solid.vertices[outer[i]];
    const Point3& q = solid.vertices[outer[i + 1 == outer.size() ? 0 : i + 1]];
    const double px = p.x - slope.at.x, py = p.y - slope.at.y, pz = p.z - slope.at.z;
    const double qx = q.x - slope.at.x, qy = q.y - slope.at.y, qz = q.z - slope.at.z;
    nx += py * qz - pz * qy;
    ny += pz * qx - px * qz;
    nz += px * qy - py * qx;
    slope.ring.push_back(p.xy());
    slope.low = std::min(slope.low, p.z);
    slope.high = std::max(slope.high, p.z);
  }
  slope.box = box_of(slope.ring);
  slope.steep = std::fabs(nz) < 1e-3 * std::sqrt(nx * nx + ny * ny);
  if (!slope.steep && nz != 0) {
    slope.sx = -nx / nz;
    slope.sy = -ny / nz;
  }
  for (const auto& loop : solid.loops_of(face))
    for (const std::uint32_t i : solid.indices_of(loop)) {
      const Point3& p = solid.vertices[i];
      slope.slack = std::max(slope.slack, std::fabs(slope.z(p.xy()) - p.z));
    }
  slopes_.push_back(std::move(slope));
}

bool Obstacles::blocked(const Block& block, std::uint32_t own, std::uint32_t other) const {
  for (const Upright& wall : uprights_)
    if (wall.face != own && wall.face != other && wall.low <= block.high && wall.high >= block.low &&
        !wall.box.apart(block.box, 0) && block.meets_segment(wall.a, wall.b))
      return true;
  for (const Slope& slope : slopes_) {
    if (slope.low > block.high || slope.high < block.low || slope.box.apart(block.box, 0)) continue;
    double low = slope.z(block.plan[0]), high = low;
    for (const Point2& p : block.plan) {
      low = std::min(low, slope.z(p));
      high = std::max(high, slope.z(p));
    }
    if (!slope.steep && (low - slope.slack > block.high || high + slope.slack < block.low)) continue;
    for (std::size_t i = 0; i < slope.ring.size(); ++i)
      if (block.meets_segment(slope.ring[i], slope.ring[(i + 1) % slope.ring.size()])) return true;
    if (geometry::contains(slope.ring, block.plan[0])) return true;
  }
  return false;
}

}  // namespace blockrand::facades
