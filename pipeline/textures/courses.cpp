#include "pipeline/textures/courses.h"

#include <algorithm>
#include <cmath>

#include "pipeline/textures/canvas.h"

namespace blockrand::textures {

Courses::Courses(const TextureRow& row, const CourseRule& rule, std::uint32_t seed)
    : width_(static_cast<float>(row.width)),
      height_(static_cast<float>(row.height)),
      joint_(static_cast<float>(row.joint)),
      radius_(rule.corner_radius),
      split_share_(rule.split_share),
      seed_(seed) {
  const float stone_width = row.stone_width > 0 ? static_cast<float>(row.stone_width) : width_;
  const float stone_height = row.stone_height > 0 ? static_cast<float>(row.stone_height) : height_;
  const int courses = cells_of(height_, stone_height);
  for (int c = 0; c < courses; ++c) {
    Course course;
    // The first course keeps its place: walls start with it at the ground.
    const float aside = c == 0 ? 0 : (draw(place_bits(c, 0, seed), 1) - 0.5F) * 2 * rule.uneven_heights;
    course.bottom = (static_cast<float>(c) + aside) * stone_height;
    const bool headers = rule.headers && c % 2 == 1;
    const float length = headers ? stone_width / 2 : stone_width;
    float shift = c % 2 == 1 ? rule.shift : 0;
    // Cross bond: headers lie in the middle above stretchers, stretchers are shifted from one to the next.
    if (rule.headers) shift = headers ? 0.5F : (c % 4 == 2 ? 0.5F : 0);
    if (rule.uneven_lengths > 0) shift += draw(place_bits(c, 1, seed), 2);
    const int stones = cells_of(width_, length);
    for (int s = 0; s < stones; ++s) {
      const float end = (draw(place_bits(c, s, seed), 3) - 0.5F) * 2 * rule.uneven_lengths;
      float start = (static_cast<float>(s) + shift + end) * length;
      start -= std::floor(start / width_) * width_;
      course.starts.push_back(start);
    }
    std::sort(course.starts.begin(), course.starts.end());
    courses_.push_back(std::move(course));
  }
}

Stone Courses::at(float x, float y) const {
  x -= std::floor(x / width_) * width_;
  y -= std::floor(y / height_) * height_;
  const auto above = std::upper_bound(courses_.begin(), courses_.end(), y,
                                      [](float value, const Course& course) { return value < course.bottom; });
  Stone stone;
  stone.course = static_cast<int>(above - courses_.begin()) - 1;
  const Course& course = courses_[stone.course];
  const float top = above == courses_.end() ? height_ : above->bottom;

  const auto next = std::upper_bound(course.starts.begin(), course.starts.end(), x);
  const int count = static_cast<int>(course.starts.size());
  const int index = wrapped(static_cast<int>(next - course.starts.begin()) - 1, count);
  float left = course.starts[index], right = course.starts[index + 1 == count ? 0 : index + 1];
  if (left > x) left -= width_;
  if (right <= x) right += width_;

  stone.key = place_bits(index, stone.course, seed_ + 9);
  stone.half_x = (right - left - joint_) / 2;
  float bottom = course.bottom;
  float upper = top;
  constexpr float kLeastSplit = 8;  // joints: lower stones stay whole, their halves would be shards
  if (split_share_ > 0 && top - bottom > kLeastSplit * joint_ && draw(stone.key, 51) < split_share_) {
    const float split = bottom + (top - bottom) * (0.4F + 0.2F * draw(stone.key, 52));
    if (y < split) {
      upper = split;
    } else {
      bottom = split;
      stone.key = place_bits(stone.key, 1, seed_ + 9);
    }
  }
  stone.half_y = (upper - bottom - joint_) / 2;
  stone.x = x - (left + right) / 2;
  stone.y = y - (bottom + joint_ + upper) / 2;
  const float radius = std::min({radius_, stone.half_x, stone.half_y});
  const float qx = std::abs(stone.x) - stone.half_x + radius, qy = std::abs(stone.y) - stone.half_y + radius;
  const float ax = std::max(qx, 0.0F), ay = std::max(qy, 0.0F);
  stone.inside = radius - std::sqrt(ax * ax + ay * ay) - std::min(std::max(qx, qy), 0.0F);
  // In the bed joint the stone beneath may be nearer.
  if (y < bottom + joint_) stone.inside = std::max(stone.inside, bottom - y);
  return stone;
}

}  // namespace blockrand::textures
