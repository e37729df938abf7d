// Tiles, slates, sheet metal and felt. Eaves are at the bottom of the picture.
#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/textures/canvas.h"
#include "pipeline/textures/courses.h"

namespace blockrand::textures {
namespace {

/// Unevenness and stains of burnt clay and stone.
struct Weather {
  Weather(const TextureRow& row, std::uint32_t seed)
      : clouds(Fractal(cells_of(row.width, 0.3), cells_of(row.height, 0.3), 3, 0.6F, seed + 1).pixels(row.pixels)),
        fine(Fractal(cells_of(row.width, 0.025), cells_of(row.height, 0.025), 2, 0.7F, seed + 2).pixels(row.pixels)) {}
  std::vector<float> clouds, fine;  // by pixel
};

}  // namespace

void paint_pantiles(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const Weather weather(row, seed);
  const int columns = cells_of(row.width, row.stone_width), rows = cells_of(row.height, row.stone_height);
  const float depth = static_cast<float>(row.depth);
  // Shares of depth [E]: the wave across, and the lap of a row on the one below.
  constexpr float kWave = 0.68F, kLap = 0.32F;
  constexpr float kRollShare = 0.44F;  // of the cover width, the raised part
  constexpr float kPanDepth = 0.3F;    // share of the wave by which the pan lies below the tile's edge
  const auto wave_at = [](float s) {   // 0 to 1 across a tile: the pan, then the roll
    const float t = s < 1 - kRollShare ? 0.5F * s / (1 - kRollShare) : 0.5F + 0.5F * (s - 1 + kRollShare) / kRollShare;
    const float c = static_cast<float>(base::sin(2 * base::kPi * t));
    return kPanDepth - (t < 0.5F ? kPanDepth : 1 - kPanDepth) * c;
  };
  std::vector<float> waves(canvas.pixels);
  for (int i = 0; i < canvas.pixels; ++i) {
    const float s = (static_cast<float>(i) + 0.5F) / static_cast<float>(canvas.pixels) * static_cast<float>(columns);
    waves[i] = wave_at(s - std::floor(s));
  }
  const float width = canvas.width / static_cast<float>(columns), height = canvas.height / static_cast<float>(rows);
  canvas.fill([&](float x, float y, std::size_t i) {
    const float f = weather.fine[i], c = weather.clouds[i];
    const float wave = waves[floor_of(x / canvas.pixel_x)];
    return averaged(canvas, x, y, [&](float px, float py, float& edge) {
      const float place = px / width;
      const int column = floor_of(place), own = wrapped(column, columns);
      // No tile lies quite straight: its lower edge is a few millimetres aside.
      const auto edge_of = [&](int r) {
        return height * (static_cast<float>(r) - 0.035F * wave) +
               0.008F * (draw(place_bits(own, wrapped(r, rows), seed), 1) - 0.5F);
      };
      int r = floor_of(py / height);
      if (py < edge_of(r)) --r;
      if (py >= edge_of(r + 1)) ++r;
      const std::uint32_t key = place_bits(own, wrapped(r, rows), seed + 4);
      const float above = py - edge_of(r), under = edge_of(r + 1) - py;  // m from the edges
      const float up = above / height;
      const float nose = smooth(-0.004F, 0.008F, above);  // the rounded lower edge
      // Beside the roll the next tile begins: a thin joint runs down.
      const float beside = (place - static_cast<float>(column)) * width;
      edge = std::min({above, under, beside, width - beside});
      const float joint = 1 - smooth(0.001F, 0.007F, beside);
      Texel t;
      t.height = depth * (kWave * wave + kLap * (1 - up) * (0.7F + 0.3F * nose) + 0.015F * f - 0.05F * joint);
      // Below an edge it is dark: light falls from above, and dirt gathers there.
      const float shadow = 1 - smooth(0.004F, 0.022F, under);
      t.light = 0.74F + 0.16F * draw_middle(key, 1) + 0.12F * f + 0.1F * c + 0.2F * (wave - 0.35F) - 0.6F * shadow -
                0.3F * joint + 0.08F * (0.5F - up);
      shift_hue(t, 0.05F * draw_middle(key, 2));
      t.roughness = 0.05F * (draw(key, 3) - 0.5F) + 0.04F * f;
      return t;
    });
  });
}

void paint_plain_tiles(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const Weather weather(row, seed);
  const int columns = cells_of(row.width, row.stone_width), rows = cells_of(row.height, row.stone_height);
  const float depth = static_cast<float>(row.depth), joint = static_cast<float>(row.joint);
  const float width = canvas.width / static_cast<float>(columns), height = canvas.height / static_cast<float>(rows);
  constexpr float kRise = 0.3F;  // of the round lower edge, share of half the width [E]
  struct Tile {
    float below, beside;  // m: above the lower edge, from the nearer side
    std::uint32_t key;
  };
  const auto tile_at = [&](float x, float y, int r) {
    const int course = wrapped(r, rows);
    const float place = x / width + (course % 2 == 1 ? 0.5F : 0);
    const int column = floor_of(place);
    const std::uint32_t key = place_bits(wrapped(column, columns), course, seed + 3);
    const float across = (place - static_cast<float>(column)) * 2 - 1;
    // A segment of a circle, near its middle a parabola; the edge of no tile is at quite the same height.
    const float edge = kRise * width / 2 * across * across + 0.004F * (draw(key, 1) - 0.5F) + 0.002F;
    return Tile{y - static_cast<float>(r) * height - edge, (1 - std::abs(across)) * width / 2, key};
  };
  canvas.fill([&](float x, float y, std::size_t i) {
    const float f = weather.fine[i], c = weather.clouds[i];
    return averaged(canvas, x, y, [&](float px, float py, float& edge) {
      const int r = floor_of(py / height);
      Tile tile = tile_at(px, py, r);
      float under = height;  // m below the edge of the tile above
      if (tile.below < 0) {
        under = -tile.below;
        tile = tile_at(px, py, r - 1);
      } else {
        under = std::min(under, -tile_at(px, py, r + 1).below);
      }
      edge = std::min({std::abs(tile.below), under, tile.beside});
      const float slit = 1 - smooth(joint / 2 - 0.001F, joint / 2 + 0.003F, tile.beside);
      const float nose = smooth(-0.002F, 0.005F, tile.below);
      Texel t;
      t.height = depth * (0.75F * (1 - tile.below / (height * 1.25F)) * (0.75F + 0.25F * nose) + 0.03F * f +
                          0.06F * (draw(tile.key, 2) - 0.5F) - 0.25F * slit);
      const float shadow = 1 - smooth(0.002F, 0.016F, under);
      t.light = 0.74F + 0.22F * draw_middle(tile.key, 3) + 0.12F * f + 0.1F * c - 0.55F * shadow - 0.5F * slit +
                0.5F * (0.08F - tile.below);
      shift_hue(t, 0.06F * draw_middle(tile.key, 4));
      t.roughness = 0.05F * (draw(tile.key, 5) - 0.5F) + 0.04F * f;
      return t;
    });
  });
}

void paint_slates(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const Weather weather(row, seed);
  const float depth = static_cast<float>(row.depth);
  CourseRule rule;
  rule.uneven_lengths = 0.16F;
  const Courses courses(row, rule, seed);
  const Fractal cleft(cells_of(row.width, 0.11), cells_of(row.height, 0.05), 3, 0.6F, seed + 4);
  const std::vector<float> chips =
      Fractal(cells_of(row.width, 0.04), cells_of(row.height, 0.04), 1, 1, seed + 5).pixels(canvas.pixels);
  canvas.fill([&](float x, float y, std::size_t i) {
    const float u = x / canvas.width, v = y / canvas.height;
    const float f = weather.fine[i], c = weather.clouds[i], chipped = 0.003F * chips[i];
    // Each slate is split from another block.
    const float k = cleft.at(u + draw(courses.at(x, y + chipped).key, 6), v);
    return averaged(canvas, x, y, [&](float px, float py, float& edge) {
      const Stone s = courses.at(px, py + chipped);
      const float below = s.y + s.half_y, under = s.half_y - s.y, beside = s.half_x - std::abs(s.x) + chipped * 0.5F;
      edge = std::min({below, under, beside});
      const float slit = 1 - smooth(-0.001F, 0.002F, beside);
      const float nose = smooth(-0.001F, 0.004F, below);
      Texel t;
      t.height = depth * (0.8F * (1 - below / (2 * s.half_y)) * (0.8F + 0.2F * nose) + 0.14F * k +
                          0.25F * (draw(s.key, 1) - 0.5F) - 0.3F * slit);
      const float shadow = 1 - smooth(0.001F, 0.013F, under);
      t.light = 0.7F + 0.24F * draw_middle(s.key, 2) + 0.26F * k + 0.1F * f + 0.06F * c - 0.5F * shadow - 0.5F * slit;
      shift_hue(t, 0.06F * draw_middle(s.key, 3));
      t.roughness = 0.1F * (draw(s.key, 4) - 0.5F) + 0.06F * k;
      return t;
    });
  });
}

void paint_metal(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const Weather weather(row, seed);
  const int sheets = cells_of(row.width, row.stone_width);
  const float depth = static_cast<float>(row.depth), sheet = canvas.width / static_cast<float>(sheets);
  const float seam = static_cast<float>(row.joint);  // m wide
  const std::vector<float> dents =
      Fractal(cells_of(row.width, 0.3), cells_of(row.height, 0.4), 2, 0.4F, seed + 4).pixels(canvas.pixels);
  const Noise runs(cells_of(row.width, 0.03), cells_of(row.height, 0.9), seed + 5);
  canvas.fill([&](float x, float y, std::size_t i) {
    const float u = x / canvas.width, v = y / canvas.height;
    const float place = x / sheet;
    const int index = floor_of(place);
    const float aside = place - static_cast<float>(index);
    const float from = std::min(aside, 1 - aside) * sheet;  // m from the middle of the seam
    const std::uint32_t key = place_bits(index, 0, seed);
    const float rib = 1 - smooth(seam / 2 - canvas.pixel_x, seam / 2 + canvas.pixel_x, from);
    const float foot = (1 - smooth(seam / 2, seam / 2 + 0.02F, from)) * (1 - rib);
    const float f = weather.fine[i], c = weather.clouds[i], r = runs.at(u, v);
    Texel t;
    t.height = depth * (rib + 0.06F * dents[i] + 0.004F * f);
    t.light = 0.72F + 0.06F * draw_middle(key, 1) + 0.16F * c + 0.12F * r + 0.09F * f + 0.12F * rib - 0.5F * foot;
    shift_hue(t, 0.012F * c);
    t.roughness = 0.07F * c + 0.06F * r;
    return t;
  });
}

void paint_felt(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const Weather weather(row, seed);
  const int lanes = cells_of(row.width, row.stone_width);
  const float depth = static_cast<float>(row.depth), lane = canvas.width / static_cast<float>(lanes);
  const float lap = static_cast<float>(row.joint);  // m of one lane on the next
  const Noise waver(1, cells_of(row.height, 0.25), seed + 4), ooze(1, cells_of(row.height, 0.05), seed + 5);
  canvas.fill([&](float x, float y, std::size_t i) {
    const float v = y / canvas.height;
    const float place = (x + 0.004F * waver.at(0.5F, v)) / lane;
    const int index = wrapped(floor_of(place), lanes);
    const float from = (place - std::floor(place)) * lane;
    const std::uint32_t key = place_bits(index, 0, seed);
    // At the left the lane lies on its neighbour; welded bitumen oozes out beside the edge.
    const float on_top = 1 - smooth(lap - 0.004F, lap + 0.008F, from);
    const float weld = smooth(lane - 0.014F - 0.008F * ooze.at(0.5F, v), lane - 0.008F, from);
    const float edge = std::min(from, lane - from);
    const float g = unit_of(place_bits(floor_of(x / canvas.pixel_x), floor_of(y / canvas.pixel_y), seed)) * 2 - 1;
    const float f = weather.fine[i], c = weather.clouds[i];
    Texel t;
    t.height = depth * (0.55F + 0.2F * on_top - 0.15F * weld + 0.1F * g + 0.1F * f + 0.1F * c);
    t.light = 0.62F + 0.03F * draw_middle(key, 1) + 0.1F * g + 0.2F * f + 0.12F * c - 0.35F * weld -
              0.3F * (1 - smooth(0, 0.008F, edge));
    t.roughness = -0.15F * weld + 0.03F * f;
    return t;
  });
}

}  // namespace blockrand::textures
