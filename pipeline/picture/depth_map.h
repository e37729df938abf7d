// Which part of the scene a light reaches: the nearest surfaces along one direction. Internal to this folder.
#pragma once

#include <vector>

#include "pipeline/model/vector.h"
#include "pipeline/picture/scene.h"

namespace blockrand::picture {

/// The scene in parallel projection along a light's rays.
class DepthMap {
 public:
  explicit DepthMap(int size) : size_(size), depth_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size)) {}

  /// \param to_light  unit vector towards the light
  /// \param receivers  box (scene's local coordinates) of what will ask; what stands outside its shadow column is left out
  void draw(const Scene& scene, Point3 to_light, const Box& receivers);

  /// Side of a map cell in metres.
  double cell() const { return cell_; }
  struct Vector {
    float x, y, z;
  };
  /// Column, row and height towards the light of a point in the scene's local coordinates.
  Vector locate(float x, float y, float z) const {
    return {column_[0] * x + column_[1] * y + column_[2] * z + column_[3],
            row_[0] * x + row_[1] * y + row_[2] * z + row_[3], height_[0] * x + height_[1] * y + height_[2] * z};
  }
  /// True where nothing stands between the light and the place. Outside the map all is lit.
  bool lit(const Vector& place) const {
    const int x = cell_of(place.x), y = cell_of(place.y);
    return x < 0 || y < 0 || x >= size_ || y >= size_ || at(x, y) <= place.z;
  }
  /// Share of the light that arrives, in [0, 1]: a tent-shaped mean over 3 x 3 cells.
  float soft(const Vector& place) const;

 private:
  static int cell_of(float v) {
    const int i = static_cast<int>(v);
    return v < 0 ? i - 1 : i;
  }
  float at(int x, int y) const {
    return depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x)];
  }
  int size_;
  std::vector<float> depth_;  ///< height towards the light of the highest surface
  double cell_ = 1;
  float column_[4] = {}, row_[4] = {}, height_[3] = {};
};

}  // namespace blockrand::picture
