#include "pipeline/facades/opening_blocks.h"

#include <algorithm>
#include <cmath>
#include <optional>

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

namespace {

constexpr double kCell = 4;            ///< m; about a window with its wall
constexpr std::int64_t kLong = 1000;   ///< cells
constexpr double kBoxRounding = 1e-6;  ///< m; more than predicates about points on a border round

geometry::PlanBox plan_box(const Box2& box) { return {{box.left, box.low}, {box.right, box.high}}; }

}  // namespace

GrowingCells::Range GrowingCells::range_of(const Box2& box, double low, double high, double distance) {
  const auto cell = [](double metres) { return static_cast<std::int64_t>(std::floor(metres / kCell)); };
  return {{cell(box.left - distance), cell(box.low - distance), cell(low - distance)},
          {cell(box.right + distance), cell(box.high + distance), cell(high + distance)}};
}

void GrowingCells::add(const Box2& box, double low, double high, std::uint32_t item) {
  const Range range = range_of(box, low, high, 0);
  std::int64_t count = 1;
  for (int i = 0; i < 3; ++i)
    count = std::min(kLong + 1, count * std::min(kLong + 1, range.high[i] - range.low[i] + 1));
  if (count > kLong) {
    long_ones_.push_back(item);
    return;
  }
  for (std::int64_t x = range.low[0]; x <= range.high[0]; ++x)
    for (std::int64_t y = range.low[1]; y <= range.high[1]; ++y)
      for (std::int64_t z = range.low[2]; z <= range.high[2]; ++z) cells_[{x, y, z}].push_back(item);
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
  std::vector<geometry::PlanBox> uprights, slopes;
  for (const Upright& wall : uprights_) uprights.push_back(plan_box(wall.box));
  for (const Slope& slope : slopes_) slopes.push_back(plan_box(slope.box));
  upright_boxes_ = geometry::BoxIndex(std::move(uprights));
  slope_boxes_ = geometry::BoxIndex(std::move(slopes));
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
  for (std::size_t l = 0; l < face.loop_count; ++l) {
    std::vector<Point3>* const hole = l > 0 ? &slope.holes.emplace_back() : nullptr;
    for (const std::uint32_t i : solid.indices_of(solid.loops_of(face)[l])) {
      const Point3& p = solid.vertices[i];
      slope.slack = std::max(slope.slack, std::fabs(slope.z(p.xy()) - p.z));
      if (hole) hole->push_back(p);
    }
  }
  slopes_.push_back(std::move(slope));
}

bool Obstacles::blocked(const Block& block, std::uint32_t own, std::uint32_t other) const {
  const geometry::PlanBox here = plan_box(block.box);
  for (const std::uint32_t u : upright_boxes_.near(here, kBoxRounding)) {
    const Upright& wall = uprights_[u];
    if (wall.face != own && wall.face != other && wall.low <= block.high && wall.high >= block.low &&
        !wall.box.apart(block.box, 0) && block.meets_segment(wall.a, wall.b))
      return true;
  }
  const Box2 around{block.box.left - kBoxRounding, block.box.right + kBoxRounding, block.box.low - kBoxRounding,
                    block.box.high + kBoxRounding};
  const auto far_from = [&](Point2 a, Point2 b) {
    return std::max(a.x, b.x) < around.left || std::min(a.x, b.x) > around.right || std::max(a.y, b.y) < around.low ||
           std::min(a.y, b.y) > around.high;
  };
  for (const std::uint32_t s : slope_boxes_.near(here, kBoxRounding)) {
    const Slope& slope = slopes_[s];
    if (slope.low > block.high || slope.high < block.low || slope.box.apart(block.box, 0)) continue;
    double low = slope.z(block.plan[0]), high = low;
    for (const Point2& p : block.plan) {
      low = std::min(low, slope.z(p));
      high = std::max(high, slope.z(p));
    }
    if (!slope.steep && (low - slope.slack > block.high || high + slope.slack < block.low)) continue;
    for (std::size_t i = 0; i < slope.ring.size(); ++i) {
      const Point2 a = slope.ring[i], b = slope.ring[(i + 1) % slope.ring.size()];
      if (!far_from(a, b) && block.meets_segment(a, b)) return true;
    }
    if (slope.holes.empty() || slope.steep) {
      if (geometry::contains(slope.ring, block.plan[0])) return true;
    } else if (slope.reaches(block)) {
      return true;
    }
  }
  return false;
}

bool Obstacles::Slope::reaches(const Block& block) const {
  // Of the block that part counts through which the slope's plane goes: it is convex, and where no border crosses it, all of it is
  // material or none.
  for (const std::vector<Point3>& hole : holes)
    for (std::size_t i = 0; i < hole.size(); ++i) {
      const Point3 &a = hole[i], &b = hole[(i + 1) % hole.size()];
      if (std::max(a.z, b.z) + slack >= block.low && std::min(a.z, b.z) - slack <= block.high &&
          block.meets_segment(a.xy(), b.xy()))
        return true;
    }
  const auto height = [&](Point2 p) { return z(p); };
  const Point2 *low_corner = nullptr, *high_corner = nullptr;
  std::optional<Point2> in;
  for (const Point2& p : block.plan) {
    const double h = height(p);
    if (h < block.low)
      low_corner = &p;
    else if (h > block.high)
      high_corner = &p;
    else
      in = p;
  }
  if (!in && low_corner && high_corner) {
    const double a = height(*low_corner), b = height(*high_corner),
                 share = ((block.low + block.high) / 2 - a) / (b - a);
    in = Point2{low_corner->x + share * (high_corner->x - low_corner->x),
                low_corner->y + share * (high_corner->y - low_corner->y)};
  }
  if (!in) in = block.plan[0];
  if (!geometry::contains(ring, *in)) return false;
  return std::none_of(holes.begin(), holes.end(), [&](const std::vector<Point3>& hole) {
    std::vector<Point2> flat;
    for (const Point3& p : hole) flat.push_back(p.xy());
    return geometry::contains(flat, *in);
  });
}

}  // namespace blockrand::facades
