// Random numbers of places, and noise that repeats after a whole number of cells.
//
// All is worked out from integers and with + - * / and floor: the same on every machine.
#pragma once

#include <cstdint>
#include <vector>

namespace blockrand::textures {

/// Random bits of a place on a grid. Rounds of multiply and shift, constants of MurmurHash3's finaliser (Appleby 2011).
constexpr std::uint32_t place_bits(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  std::uint32_t h = x * 0x9e3779b1U ^ (y * 0x85ebca77U + seed * 0xc2b2ae3dU);
  h = (h ^ (h >> 16)) * 0x85ebca6bU;
  h = (h ^ (h >> 13)) * 0xc2b2ae35U;
  return h ^ (h >> 16);
}

/// Uniform in [0, 1), a multiple of 2^-24.
constexpr float unit_of(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1.0p-24F; }

/// Uniform in [0, 1) for one property of a stone. \param key  of the stone
constexpr float draw(std::uint32_t key, std::uint32_t property) { return unit_of(place_bits(key, property, 77)); }

/// Between -1 and 1, values near 0 more often (triangular).
constexpr float draw_middle(std::uint32_t key, std::uint32_t property) {
  return draw(key, property) + draw(key, property + 1000) - 1;
}

/// `i` modulo `n`, never negative.
constexpr int wrapped(int i, int n) {
  if (i >= 0 && i < n) return i;  // the common case; division is slow
  const int r = i % n;
  return r < 0 ? r + n : r;
}

/// The largest whole number up to `x`. |x| < 2^31
inline int floor_of(float x) {
  const int i = static_cast<int>(x);
  return i - (static_cast<float>(i) > x ? 1 : 0);
}

constexpr float clamped(float x, float low = 0, float high = 1) { return x < low ? low : (x > high ? high : x); }

/// 0 up to `from`, 1 from `to` on, smooth between (3t^2 - 2t^3). from < to
constexpr float smooth(float from, float to, float x) {
  const float t = clamped((x - from) / (to - from));
  return t * t * (3 - 2 * t);
}

/// Gradient noise (Perlin, Improving Noise, SIGGRAPH 2002) on a grid that covers one repeat of the texture.
class Noise {
 public:
  Noise(int cells_x, int cells_y, std::uint32_t seed);
  /// About -1 to 1, mean 0. \param u, v  of the texture: repeats after 1
  float at(float u, float v) const;
  /// Adds `share` times the noise at the middles of n x n pixels, row by row from the top: faster than one by one.
  void add(int n, float share, std::vector<float>& sum) const;

 private:
  struct Gradient {
    float x, y;
  };
  int cells_x_, cells_y_;
  std::vector<Gradient> gradients_;  ///< the first column and row are repeated at the end
};

/// A sum of noises: each has cells of half the size, and `gain` times the share, of the one before.
class Fractal {
 public:
  Fractal(int cells_x, int cells_y, int octaves, float gain, std::uint32_t seed);
  float at(float u, float v) const;        ///< about -1 to 1, mean 0
  std::vector<float> pixels(int n) const;  ///< at the middles of n x n pixels, row by row from the top

 private:
  std::vector<Noise> octaves_;
  float gain_, scale_;
};

/// The Voronoi cells of scattered points (Worley, A Cellular Texture Basis Function, SIGGRAPH 1996), one in each cell of a
/// grid that covers one repeat of the texture.
class Scatter {
 public:
  /// \param jitter  0: points in even rows, each second one half a cell aside; 1: scattered
  Scatter(int cells_x, int cells_y, float jitter, std::uint32_t seed);
  struct Cell {
    float edge = 0;      ///< to the nearest border of the Voronoi cell, in cells of the grid
    float x = 0, y = 0;  ///< from the point, in cells of the grid
    std::uint32_t key = 0;
  };
  Cell at(float u, float v) const;

 private:
  static constexpr int kMargin = 3;  // cells that a look around a place reaches beyond the grid
  struct Point {
    float x, y;
  };
  int cells_x_, cells_y_;
  std::vector<Point> points_;  ///< with a margin of repeated cells
};

}  // namespace blockrand::textures
