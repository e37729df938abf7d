// How much of the sky a place sees, from a map of heights. Internal to this folder.
#pragma once

#include <array>
#include <vector>

#include "pipeline/picture/scene.h"

namespace blockrand::picture {

/// The sky over a scene, seen from above once: for each cell of a grid how high the horizon rises around its highest surface, as what
/// that takes of the light on level ground, and on walls as a function of where they look. Streets and courtyards are darker than
/// roofs, walls darker at their feet; what lies under something (a passage) counts as what lies above it.
class SkyField {
 public:
  /// \param size  cells along the longer side
  SkyField(const Scene& scene, int size);

  /// What a surface asks with.
  struct Asker {
    float ahead_x = 0, ahead_y = 0;  ///< m, to a cell before a wall
    std::array<float, 6> parts{};    ///< of Cell::taken
  };
  /// \param normal  unit vector
  Asker asker(Scene::Vector normal) const;

  /// The share of the sky before a surface that is open, in [0, 1]. Scene's local coordinates.
  float open(const Asker& asker, float x, float y, float z) const;

 private:
  struct Cell {
    /// Of the light on level ground; of that on a wall: the mean over where it looks, and by the sine and cosine (x, y) of that and of
    /// twice that.
    std::array<float, 6> taken{};
    float top = 0;     ///< m, of the highest surface
    float around = 0;  ///< m, of what takes the light
  };
  void measure_heights(const Scene& scene);
  void sweep(double azimuth);
  void finish(double margin);

  int columns_ = 1, rows_ = 1;
  double left_ = 0, bottom_ = 0, cell_ = 1;
  float per_cell_ = 1;
  std::vector<Cell> cells_;  ///< rows from the south
};

}  // namespace blockrand::picture
