// What the patterns paint on, before it becomes maps.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/textures/noise.h"
#include "pipeline/textures/texture.h"

namespace blockrand::textures {

/// One pixel of a surface.
struct Texel {
  float height = 0;           ///< m
  float light = 1;            ///< 1: brightest; 0: darker by the row's `contrast`
  float r = 1, g = 1, b = 1;  ///< factors of linear light: shifts of hue
  float roughness = 0;        ///< added to the row's
};

/// The pixels of one repeat, row by row from the top.
struct Canvas {
  explicit Canvas(const TextureRow& row)
      : pixels(row.pixels),
        width(static_cast<float>(row.width)),
        height(static_cast<float>(row.height)),
        pixel_x(width / static_cast<float>(row.pixels)),
        pixel_y(height / static_cast<float>(row.pixels)),
        texels(static_cast<std::size_t>(row.pixels) * row.pixels) {}

  int pixels;
  float width, height;     ///< m until it repeats
  float pixel_x, pixel_y;  ///< m
  std::vector<Texel> texels;

  /// Wraps.
  Texel& at(int column, int row) {
    return texels[static_cast<std::size_t>(wrapped(row, pixels)) * pixels + wrapped(column, pixels)];
  }
  /// \param paint  Texel of (x, y, i): m from the lower left corner to the middle of the pixel; the pixel's index
  template <class Paint>
  void fill(const Paint& paint) {
    std::size_t i = 0;
    for (int row = 0; row < pixels; ++row) {
      const float y = height - (static_cast<float>(row) + 0.5F) * pixel_y;
      for (int column = 0; column < pixels; ++column, ++i)
        texels[i] = paint((static_cast<float>(column) + 0.5F) * pixel_x, y, i);
    }
  }
};

/// The mean over a pixel that an edge crosses, from four places in it, no two in a row or column: edges do not step.
/// \param paint  Texel of (x, y), m; also sets the distance to the nearest edge, m
template <class Paint>
Texel averaged(const Canvas& canvas, float x, float y, const Paint& paint) {
  constexpr float kPlaces[4][2] = {{-0.375F, -0.125F}, {-0.125F, 0.375F}, {0.125F, -0.375F}, {0.375F, 0.125F}};
  float edge = 0;
  const Texel middle = paint(x, y, edge);
  if (edge > 1.2F * std::max(canvas.pixel_x, canvas.pixel_y))
    return middle;  // 1.2 pixels: its corners are nearer than that
  Texel sum{0, 0, 0, 0, 0, 0};
  for (const auto& place : kPlaces) {
    const Texel t = paint(x + place[0] * canvas.pixel_x, y + place[1] * canvas.pixel_y, edge);
    sum.height += 0.25F * t.height;
    sum.light += 0.25F * t.light;
    sum.r += 0.25F * t.r;
    sum.g += 0.25F * t.g;
    sum.b += 0.25F * t.b;
    sum.roughness += 0.25F * t.roughness;
  }
  return sum;
}

/// How many cells of `size` m fit one repeat of `length` m; one at least.
inline int cells_of(double length, double size) {
  const int n = static_cast<int>(length / size + 0.5);
  return n < 1 ? 1 : n;
}

/// Shifts the hue: warm is towards red and yellow, cold towards blue. \param warm  share, below 0: cold
inline void shift_hue(Texel& texel, float warm) {
  texel.r *= 1 + 0.5F * warm;
  texel.b *= 1 - warm;
}

// The patterns. Each paints the whole canvas.
void paint_plaster(Canvas& canvas, const TextureRow& row, std::uint32_t seed);
void paint_concrete(Canvas& canvas, const TextureRow& row, std::uint32_t seed);
void paint_boards(Canvas& canvas, const TextureRow& row, std::uint32_t seed);
void paint_masonry(Canvas& canvas, const TextureRow& row, std::uint32_t seed);  ///< bonds, ashlar, rubble, setts, flags
void paint_scattered(Canvas& canvas, const TextureRow& row, std::uint32_t seed);  ///< cyclopean, cobbles
void paint_pantiles(Canvas& canvas, const TextureRow& row, std::uint32_t seed);
void paint_plain_tiles(Canvas& canvas, const TextureRow& row, std::uint32_t seed);
void paint_slates(Canvas& canvas, const TextureRow& row, std::uint32_t seed);
void paint_metal(Canvas& canvas, const TextureRow& row, std::uint32_t seed);
void paint_felt(Canvas& canvas, const TextureRow& row, std::uint32_t seed);
void paint_grains(Canvas& canvas, const TextureRow& row, std::uint32_t seed);
void paint_soil(Canvas& canvas, const TextureRow& row, std::uint32_t seed);
void paint_grass(Canvas& canvas, const TextureRow& row, std::uint32_t seed);

}  // namespace blockrand::textures
