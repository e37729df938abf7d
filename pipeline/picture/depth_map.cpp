#include "pipeline/picture/depth_map.h"

#include <algorithm>
#include <limits>

#include "pipeline/picture/view.h"

namespace blockrand::picture {

void DepthMap::draw(const Scene& scene, Point3 to_light, const Box& receivers) {
  std::fill(depth_.begin(), depth_.end(), -std::numeric_limits<float>::max());
  const Point3 forward = to_light * -1;
  Point3 right = cross(forward, {0, 0, 1});
  right = length(right) > 5e-6 ? unit(right) : Point3{1, 0, 0};
  const Point3 up = cross(right, forward);

  double left = 0, east = 0, top = 0, bottom = 0;
  bool first = true;
  for (const Point3& p : receivers.corners()) {
    const double a = dot(p, right), b = dot(p, up);
    left = first ? a : std::min(left, a);
    east = first ? a : std::max(east, a);
    bottom = first ? b : std::min(bottom, b);
    top = first ? b : std::max(top, b);
    first = false;
  }
  // Two cells of margin for the soft edge and for what lies on the border.
  const double extent = std::max({east - left, top - bottom, 1e-3});
  cell_ = extent / (size_ - 4);
  left -= 2 * cell_;
  top += 2 * cell_;

  const View view(right, up, forward, left, top, 1 / cell_, size_, size_);
  for (const Scene::Triangle& t : scene.triangles()) {
    // A solid's faces towards the light cast the same shadow as all of them.
    if (t.closed && t.normal.x * to_light.x + t.normal.y * to_light.y + t.normal.z * to_light.z <= 0) continue;
    picture::draw(view, t, [&](std::size_t i, double nearness) {
      const auto height = static_cast<float>(nearness);
      if (height > depth_[i]) depth_[i] = height;
    });
  }

  const auto set = [&](float* out, Point3 axis, double factor) {
    out[0] = static_cast<float>(axis.x * factor);
    out[1] = static_cast<float>(axis.y * factor);
    out[2] = static_cast<float>(axis.z * factor);
  };
  set(column_, right, 1 / cell_);
  column_[3] = static_cast<float>(-left / cell_);
  set(row_, up, -1 / cell_);
  row_[3] = static_cast<float>(top / cell_);
  set(height_, to_light, 1);
}

float DepthMap::soft(const Vector& place) const {
  const float x = place.x - 0.5f, y = place.y - 0.5f;
  const int cx = cell_of(x), cy = cell_of(y);
  if (cx < 1 || cy < 1 || cx + 2 >= size_ || cy + 2 >= size_) return lit(place) ? 1.0f : 0.0f;
  const float fx = x - static_cast<float>(cx), fy = y - static_cast<float>(cy);
  // Cells cx-1 … cx+2 weighted by a box of width 3 around the place: the inner ones fully, the outer ones in part.
  const float wx[4] = {1 - fx, 1, 1, fx}, wy[4] = {1 - fy, 1, 1, fy};
  float sum = 0;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      if (at(cx - 1 + i, cy - 1 + j) <= place.z) sum += wx[i] * wy[j];
  return sum / 9.0f;
}

}  // namespace blockrand::picture
