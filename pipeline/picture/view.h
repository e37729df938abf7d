// From the scene to samples of the picture and back. Internal to this folder.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "pipeline/model/vector.h"
#include "pipeline/picture/camera.h"

namespace blockrand::picture {

/// A point on the grid of samples: x to the right, y down, sample (i, j) has its centre at (i + 0.5, j + 0.5).
/// `nearness` grows towards the eye and is linear over a plane: 1 / depth in perspective, -depth in parallel projection.
struct Projected {
  double x = 0, y = 0, nearness = 0;
};

/// A camera with a grid of samples, in the scene's local coordinates.
class View {
 public:
  View(const Camera& camera, Point3 origin, int width, int height);
  /// Parallel projection along `forward`: samples of `1 / scale` metres, (0, 0) of the grid at the given coordinates.
  View(Point3 right, Point3 up, Point3 forward, double left, double top, double scale, int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  bool perspective() const { return perspective_; }
  Point3 forward() const { return forward_; }
  Point3 eye() const { return eye_; }

  /// Right, up and depth from the eye.
  Point3 to_camera(Point3 p) const {
    const Point3 d = p - eye_;
    return {dot(d, right_), dot(d, up_), dot(d, forward_)};
  }
  Projected project(Point3 camera_point) const {
    if (!perspective_) return {cx_ + camera_point.x * scale_, cy_ - camera_point.y * scale_, -camera_point.z};
    const double inverse = 1 / camera_point.z;
    return {cx_ + camera_point.x * scale_ * inverse, cy_ - camera_point.y * scale_ * inverse, inverse};
  }
  bool in_front(Point3 camera_point) const { return !perspective_ || camera_point.z >= near_; }
  /// Within what the rasteriser's integers hold.
  bool in_frame(const Projected& p) const {
    const double x = p.x - width_ / 2.0, y = p.y - height_ / 2.0;
    return x >= -kFrame && x <= kFrame && y >= -kFrame && y <= kFrame;
  }
  /// The visible corners of a convex polygon, clipped against the near plane and a wide frame around the picture, within
  /// which coordinates fit the rasteriser's integers. `count` corners in camera coordinates; returns how many remain.
  static constexpr int kMaxCorners = 9;
  int clip(std::array<Point3, kMaxCorners>& corners, int count) const;

  /// Where the line of sight through a sample has this nearness, in the scene's local coordinates.
  Point3 position(double x, double y, double nearness) const {
    const double a = (x - cx_) * size_, b = (cy_ - y) * size_;
    if (!perspective_) return eye_ + (right_ * a + up_ * b) + (forward_ * -nearness);
    return eye_ + (forward_ + (right_ * a + up_ * b)) * (1 / nearness);
  }

  /// The nearness of a plane {p: dot(normal, p) = offset} as a linear function of the sample.
  struct Linear {
    double at = 0, per_x = 0, per_y = 0;
    bool valid = false;
    double operator()(double x, double y) const { return at + per_x * x + per_y * y; }
  };
  Linear plane(Point3 normal, double offset) const;
  /// Metres that a sample covers at this nearness, across the line of sight.
  double sample_size(double nearness) const { return perspective_ ? 1 / (scale_ * nearness) : 1 / scale_; }

 private:
  /// Samples from the middle of the grid to the edge of the frame that triangles are clipped to. Wider than any picture,
  /// so that clipped edges are never seen, and narrow enough for 64-bit edge functions in 1/256 of a sample.
  static constexpr double kFrame = 20000;

  bool perspective_ = false;
  Point3 eye_, right_, up_, forward_;
  double scale_ = 1, cx_ = 0, cy_ = 0, near_ = 0;
  double size_ = 1;  ///< 1 / scale_
  int width_ = 0, height_ = 0;
};

/// A part of the grid of samples: all columns, some rows.
struct Rows {
  int width = 0;
  int first = 0, end = 0;
};

/// Calls `write(index, nearness)` for every sample of `rows` whose centre lies in the triangle; the first sample of the first row has
/// index 0. Samples on an edge that two triangles share belong to one of them. Corners within +-2^15 of the grid.
template <class Write>
void fill(const Projected& a, Projected b, Projected c, const Rows& rows, Write&& write) {
  constexpr double kSteps = 256;
  const auto fixed = [](double v) { return static_cast<std::int64_t>(v * kSteps + (v < 0 ? -0.5 : 0.5)); };
  const std::int64_t ax = fixed(a.x), ay = fixed(a.y);
  std::int64_t bx = fixed(b.x), by = fixed(b.y), cx = fixed(c.x), cy = fixed(c.y);
  // First and last row and column whose middle lies between the corners.
  const std::int64_t first_row = std::max<std::int64_t>(rows.first, (std::min({ay, by, cy}) + 127) >> 8);
  const std::int64_t last_row = std::min<std::int64_t>(rows.end - 1, (std::max({ay, by, cy}) - 128) >> 8);
  const std::int64_t left = std::max<std::int64_t>(0, (std::min({ax, bx, cx}) + 127) >> 8);
  const std::int64_t right = std::min<std::int64_t>(rows.width - 1, (std::max({ax, bx, cx}) - 128) >> 8);
  if (first_row > last_row || left > right) return;
  std::int64_t area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
  if (area == 0) return;
  if (area < 0) {
    std::swap(b, c);
    std::swap(bx, cx);
    std::swap(by, cy);
    area = -area;
  }

  // Nearness over the grid. Slivers make steep planes: what leaves the corners' range is brought back.
  const double inverse = 1 / (static_cast<double>(area) / kSteps);
  const double b_up = b.nearness - a.nearness, c_up = c.nearness - a.nearness;
  const double per_x = (b_up * static_cast<double>(cy - ay) - c_up * static_cast<double>(by - ay)) * inverse;
  const double per_y = (c_up * static_cast<double>(bx - ax) - b_up * static_cast<double>(cx - ax)) * inverse;
  const double lowest = std::min({a.nearness, b.nearness, c.nearness});
  const double highest = std::max({a.nearness, b.nearness, c.nearness});
  const double ax_in_samples = static_cast<double>(ax) / kSteps;
  const auto put = [&](std::size_t index, std::int64_t x, double offset) {
    const double n = offset + (static_cast<double>(x) + 0.5 - ax_in_samples) * per_x;
    write(index, n < lowest ? lowest : n > highest ? highest : n);
  };

  // An edge p → q holds what is on its positive side: e = (qx - px) (y - py) - (qy - py) (x - px) >= bias. Along a row:
  // e - bias = at - dy * 256 * x, for the sample in column x.
  struct Edge {
    std::int64_t dx, dy, x, y, bias;
    std::int64_t at(std::int64_t my) const { return dx * (my - y) - dy * (128 - x) - bias; }
  };
  const auto edge = [](std::int64_t px, std::int64_t py, std::int64_t qx, std::int64_t qy) {
    const std::int64_t dx = qx - px, dy = qy - py;
    return Edge{dx, dy, px, py, dy < 0 || (dy == 0 && dx > 0) ? 0 : 1};
  };
  const Edge edges[3] = {edge(ax, ay, bx, by), edge(bx, by, cx, cy), edge(cx, cy, ax, ay)};
  constexpr std::int64_t kNarrow = 12;  // samples: to ask each is cheaper than to divide
  const auto floor_divide = [](std::int64_t n, std::int64_t d) { return n >= 0 ? n / d : -((-n + d - 1) / d); };
  for (std::int64_t y = first_row; y <= last_row; ++y) {
    const std::int64_t my = y * 256 + 128;
    const double offset = (static_cast<double>(my) - static_cast<double>(ay)) / kSteps * per_y + a.nearness;
    const std::size_t row = static_cast<std::size_t>(y - rows.first) * static_cast<std::size_t>(rows.width);
    if (right - left < kNarrow) {
      const std::int64_t step0 = edges[0].dy * 256, step1 = edges[1].dy * 256, step2 = edges[2].dy * 256;
      std::int64_t e0 = edges[0].at(my) - step0 * left, e1 = edges[1].at(my) - step1 * left,
                   e2 = edges[2].at(my) - step2 * left;
      for (std::int64_t x = left; x <= right; ++x, e0 -= step0, e1 -= step1, e2 -= step2)
        if ((e0 | e1 | e2) >= 0) put(row + static_cast<std::size_t>(x), x, offset);
      continue;
    }
    std::int64_t from = left, to = right;
    for (const Edge& e : edges) {
      const std::int64_t at = e.at(my), step = e.dy * 256;
      if (step == 0) {
        if (at < 0) to = -1;
      } else if (step > 0) {
        to = std::min(to, floor_divide(at, step));
      } else {
        from = std::max(from, -floor_divide(at, -step));
      }
    }
    for (std::int64_t x = from; x <= to; ++x) put(row + static_cast<std::size_t>(x), x, offset);
  }
}

/// Projects a triangle of the scene, clips it where needed and fills it.
template <class Write>
void draw(const View& view, const Scene::Triangle& t, const Rows& rows, Write&& write) {
  std::array<Point3, View::kMaxCorners> corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = view.to_camera({t.corners[i].x, t.corners[i].y, t.corners[i].z});
  // Nearly all triangles are far from every plane that they could be clipped against.
  std::array<Projected, 3> p;
  bool inside = true;
  for (std::size_t i = 0; inside && i < 3; ++i) {
    inside = view.in_front(corners[i]);
    if (!inside) break;
    p[i] = view.project(corners[i]);
    inside = view.in_frame(p[i]);
  }
  if (inside) {
    fill(p[0], p[1], p[2], rows, write);
    return;
  }
  const int count = view.clip(corners, 3);
  if (count < 3) return;
  const Projected first = view.project(corners[0]);
  Projected before = view.project(corners[1]);
  for (int i = 2; i < count; ++i) {
    const Projected next = view.project(corners[static_cast<std::size_t>(i)]);
    fill(first, before, next, rows, write);
    before = next;
  }
}

}  // namespace blockrand::picture
