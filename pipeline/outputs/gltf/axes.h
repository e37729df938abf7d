// From the axes of a tile to those of glTF.
#pragma once

#include <array>

namespace blockrand::outputs {

/// East, north, up to glTF's axes: x east, y up, z south.
template <class T>
std::array<T, 3> y_up(T east, T north, T up) {
  return {east, up, static_cast<T>(0 - north)};
}

}  // namespace blockrand::outputs
