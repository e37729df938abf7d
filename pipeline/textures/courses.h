// Stones, tiles and boards that lie in courses.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/textures/texture.h"

namespace blockrand::textures {

/// Where a place lies in the stone it belongs to.
struct Stone {
  float inside = 0;              ///< m to the stone's nearest edge; below 0: in the joint
  float x = 0, y = 0;            ///< m from its middle
  float half_x = 0, half_y = 0;  ///< m from its middle to its edges
  std::uint32_t key = 0;
  int course = 0;
};

/// How courses differ from a plain grid.
struct CourseRule {
  float shift = 0.5F;        ///< of each second course against the one below, in stones
  bool headers = false;      ///< cross bond: each second course has stones of half the length
  float uneven_lengths = 0;  ///< share of a stone by which an end may lie aside, up to 0.5
  float uneven_heights = 0;  ///< share of a course by which its lower edge may lie aside, up to 0.5
  float split_share = 0;     ///< of the stones that are two, one upon the other
  float corner_radius = 0;   ///< m
};

/// Courses from the bottom upwards, each begins with its bed joint. They repeat with the texture.
class Courses {
 public:
  Courses(const TextureRow& row, const CourseRule& rule, std::uint32_t seed);
  /// \param x, y  m from the lower left corner of the texture; may lie outside
  Stone at(float x, float y) const;

 private:
  struct Course {
    float bottom;               ///< m
    std::vector<float> starts;  ///< m, of the stones; rising
  };
  float width_, height_, joint_, radius_, split_share_;
  std::vector<Course> courses_;
  std::uint32_t seed_;
};

}  // namespace blockrand::textures
