// Which part of the scene a light reaches: the nearest surfaces along one direction. Internal to this folder.
#pragma once

#include <vector>

#include "pipeline/model/vector.h"
#include "pipeline/picture/scene.h"

namespace blockrand::picture {

/// The scene in parallel projection along a light's rays.
class DepthMap {
 public:
  /// \param to_light  unit vector towards the light
  /// \param box       scene's local coordinates: what it covers, seen along the light, is what the map covers
  /// \param size      cells along a side
  DepthMap(const Scene& scene, Point3 to_light, const Box& box, int size);

  /// Side of a map cell in metres.
  double cell() const { return cell_; }
  struct Vector {
    float x, y, z;
  };
  /// Column, row and height towards the light of a point in the scene's local coordinates.
  Vector locate(float x, float y, float z) const {
    return {column_[0] * x + column_[1] * y + column_[2] * z + column_[3],
            row_[0] * x + row_[1] * y + row_[2] * z + row_[3],
            height_[0] * x + height_[1] * y + height_[2] * z + height_[3]};
  }
  /// The map knows what stands between the light and the place.
  bool covers(const Vector& place) const {
    return place.x >= 2 && place.y >= 2 && place.x < static_cast<float>(size_ - 2) &&
           place.y < static_cast<float>(size_ - 2);
  }
  /// Share of the light that arrives at a place that the map covers, in [0, 1]: a tent-shaped mean over 3 x 3 cells.
  float soft(const Vector& place) const;

 private:
  static constexpr int kBlock = 8;  // cells along a side
  void find_highest();

  int size_;
  /// Height towards the light of the highest surface, in steps; 0: there is none. Two bytes hold any scene to a few millimetres, and
  /// half as many bytes are twice as near.
  std::vector<std::uint16_t> depth_;
  int blocks_ = 0;                      ///< along a side
  std::vector<std::uint16_t> highest_;  ///< of each block and the two cells around it: most places lie above all of it
  double cell_ = 1;
  float column_[4] = {}, row_[4] = {}, height_[4] = {};
};

}  // namespace blockrand::picture
