#include "pipeline/picture/depth_map.h"

#include <algorithm>

#include "pipeline/picture/view.h"

namespace blockrand::picture {

DepthMap::DepthMap(const Scene& scene, Point3 to_light, const Box& box, int size)
    : size_(size), depth_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size)) {
  const Point3 forward = to_light * -1;
  Point3 right = cross(forward, {0, 0, 1});
  right = length(right) > 5e-6 ? unit(right) : Point3{1, 0, 0};
  const Point3 up = cross(right, forward);

  double left = 0, east = 0, top = 0, bottom = 0;
  bool first = true;
  for (const Point3& p : box.corners()) {
    const double a = dot(p, right), b = dot(p, up);
    left = first ? a : std::min(left, a);
    east = first ? a : std::max(east, a);
    bottom = first ? b : std::min(bottom, b);
    top = first ? b : std::max(top, b);
    first = false;
  }
  // Four cells of margin for the soft edge and for what lies on the border.
  const double extent = std::max({east - left, top - bottom, 1e-3});
  cell_ = extent / std::max(1, size_ - 8);
  left -= 4 * cell_;
  top += 4 * cell_;

  // Of everything that may throw a shadow on the box.
  double low = 0, high = 0;
  const Box bounds = scene.bounds();
  first = true;
  for (const Point3& p : bounds.corners()) {
    const double h = dot(p - scene.origin(), to_light);
    low = first ? h : std::min(low, h);
    high = first ? h : std::max(high, h);
    first = false;
  }
  constexpr double kSteps = 65000;
  const double scale = kSteps / std::max(high - low, 1e-3), base = 1 - low * scale;

  const View view(right, up, forward, left, top, 1 / cell_, size_, size_);
  const Rows rows{size_, 0, size_};
  const auto faces = scene.faces();
  for (const Scene::Triangle& t : scene.triangles()) {
    const Scene::Face& face = faces[t.face];
    // A solid's faces towards the light cast the same shadow as all of them.
    if (face.closed && face.normal.x * to_light.x + face.normal.y * to_light.y + face.normal.z * to_light.z <= 0)
      continue;
    picture::draw(view, t, rows, [&](std::size_t i, double nearness) {
      const auto height = static_cast<std::uint16_t>(std::clamp(nearness * scale + base, 1.0, 65535.0));
      if (height > depth_[i]) depth_[i] = height;
    });
  }

  find_highest();

  const auto set = [&](float* out, Point3 axis, double factor) {
    out[0] = static_cast<float>(axis.x * factor);
    out[1] = static_cast<float>(axis.y * factor);
    out[2] = static_cast<float>(axis.z * factor);
  };
  set(column_, right, 1 / cell_);
  column_[3] = static_cast<float>(-left / cell_);
  set(row_, up, -1 / cell_);
  row_[3] = static_cast<float>(top / cell_);
  set(height_, to_light, scale);
  height_[3] = static_cast<float>(base);
}

void DepthMap::find_highest() {
  blocks_ = (size_ + kBlock - 1) / kBlock;
  highest_.assign(static_cast<std::size_t>(blocks_) * static_cast<std::size_t>(blocks_), 0);
  constexpr int kAround = 2;
  std::vector<std::uint16_t> column(static_cast<std::size_t>(size_));
  for (int j = 0; j < blocks_; ++j) {
    std::ranges::fill(column, std::uint16_t{0});
    const int end = std::min(size_, (j + 1) * kBlock + kAround);
    for (int y = std::max(0, j * kBlock - kAround); y < end; ++y) {
      const std::uint16_t* const row = &depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_)];
      for (std::size_t x = 0; x < column.size(); ++x) column[x] = std::max(column[x], row[x]);
    }
    for (int i = 0; i < blocks_; ++i) {
      const int right = std::min(size_, (i + 1) * kBlock + kAround);
      std::uint16_t& highest =
          highest_[static_cast<std::size_t>(j) * static_cast<std::size_t>(blocks_) + static_cast<std::size_t>(i)];
      for (int x = std::max(0, i * kBlock - kAround); x < right; ++x)
        highest = std::max(highest, column[static_cast<std::size_t>(x)]);
    }
  }
}

float DepthMap::soft(const Vector& place) const {
  const float x = place.x - 0.5f, y = place.y - 0.5f;
  const int cx = static_cast<int>(x), cy = static_cast<int>(y);
  const float fx = x - static_cast<float>(cx), fy = y - static_cast<float>(cy);
  const int z = place.z < 0 ? 0 : place.z > 65535 ? 65535 : static_cast<int>(place.z);
  if (highest_[static_cast<std::size_t>(cy / kBlock) * static_cast<std::size_t>(blocks_) +
               static_cast<std::size_t>(cx / kBlock)] <= z)
    return 1;
  // Cells cx-1 … cx+2 weighted by a box of width 3 around the place: the inner ones fully, the outer ones in part.
  const std::uint16_t* row =
      &depth_[static_cast<std::size_t>(cy - 1) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(cx - 1)];
  float sum = 0;
  const float wy[4] = {1 - fy, 1, 1, fy};
  for (int j = 0; j < 4; ++j, row += size_) {
    const float a = row[0] <= z ? 1 - fx : 0.0f, b = row[1] <= z ? 1.0f : 0.0f, c = row[2] <= z ? 1.0f : 0.0f,
                d = row[3] <= z ? fx : 0.0f;
    sum += wy[j] * (a + b + (c + d));
  }
  return sum / 9.0f;
}

}  // namespace blockrand::picture
