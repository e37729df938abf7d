#include "pipeline/picture/view.h"

#include "pipeline/base/portable_math.h"

namespace blockrand::picture {

View::View(const Camera& camera, Point3 origin, int width, int height)
    : perspective_(camera.projection == Projection::perspective),
      eye_(camera.eye - origin),
      right_(camera.right),
      up_(camera.up),
      forward_(camera.forward),
      cx_(width / 2.0),
      cy_(height / 2.0),
      near_(camera.near),
      width_(width),
      height_(height) {
  scale_ = perspective_ ? height / 2.0 / base::tan(camera.field_of_view / 2 * base::kRadiansPerDegree)
                        : height / camera.height;
  size_ = 1 / scale_;
}

View::View(Point3 right, Point3 up, Point3 forward, double left, double top, double scale, int width, int height)
    : right_(right),
      up_(up),
      forward_(forward),
      scale_(scale),
      cx_(-left * scale),
      cy_(top * scale),
      size_(1 / scale),
      width_(width),
      height_(height) {}

int View::clip(std::array<Point3, kMaxCorners>& corners, int count) const {
  // Planes as {right, up, depth, constant}: what is kept has a value of at least 0.
  const double side = kFrame / scale_;
  const double slope = perspective_ ? side : 0, constant = perspective_ ? 0 : side;
  // The parallel view's axis need not pass through the middle of its grid.
  const double mx = perspective_ ? 0 : (width_ / 2.0 - cx_) / scale_,
               my = perspective_ ? 0 : (cy_ - height_ / 2.0) / scale_;
  const double planes[5][4] = {{0, 0, perspective_ ? 1.0 : 0.0, perspective_ ? -near_ : 1.0},
                               {1, 0, slope, constant - mx},
                               {-1, 0, slope, constant + mx},
                               {0, 1, slope, constant - my},
                               {0, -1, slope, constant + my}};
  for (const auto& plane : planes) {
    const auto value = [&](const Point3& p) { return plane[0] * p.x + plane[1] * p.y + plane[2] * p.z + plane[3]; };
    bool all = true, none = true;
    for (int i = 0; i < count; ++i) (value(corners[static_cast<std::size_t>(i)]) >= 0 ? none : all) = false;
    if (all) continue;
    if (none) return 0;
    std::array<Point3, kMaxCorners> kept;
    int n = 0;
    for (int i = 0; i < count; ++i) {
      const Point3 p = corners[static_cast<std::size_t>(i)],
                   q = corners[static_cast<std::size_t>(i + 1 == count ? 0 : i + 1)];
      const double vp = value(p), vq = value(q);
      if (vp >= 0 && n < kMaxCorners) kept[static_cast<std::size_t>(n++)] = p;
      if ((vp >= 0) != (vq >= 0) && n < kMaxCorners)
        kept[static_cast<std::size_t>(n++)] = p + (q - p) * (vp / (vp - vq));
    }
    corners = kept;
    count = n;
  }
  return count;
}

View::Linear View::plane(Point3 normal, double offset) const {
  const double distance = offset - dot(normal, eye_);  // of the plane from the eye
  const double r = dot(normal, right_) / scale_, u = dot(normal, up_) / scale_, f = dot(normal, forward_);
  Linear out;
  if (perspective_) {
    // dot(normal, forward + a right + b up) / distance = 1 / depth
    if (distance == 0) return out;
    out.per_x = r / distance;
    out.per_y = -u / distance;
    out.at = (f - cx_ * r + cy_ * u) / distance;
  } else {
    if (f == 0) return out;
    out.per_x = r / f;
    out.per_y = -u / f;
    out.at = -(distance + cx_ * r - cy_ * u) / f;
  }
  out.valid = true;
  return out;
}

}  // namespace blockrand::picture
