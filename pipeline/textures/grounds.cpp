// Loose grains and grass: many small bodies, the higher hides the lower.
#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/textures/canvas.h"

namespace blockrand::textures {
namespace {

/// Grains smaller than so many pixels are noise, larger ones are bodies.
constexpr float kSmallestBody = 3.5F;

/// A unit vector. \param turn  of a whole turn, [0, 1)
struct Direction {
  float x, y;
};
const Direction& direction_of(float turn) {
  constexpr int kDirections = 256;
  static const std::array<Direction, kDirections> table = [] {
    std::array<Direction, kDirections> out;
    for (int i = 0; i < kDirections; ++i) {
      const base::SinCos a = base::sin_cos(2 * base::kPi * i / kDirections);
      out[i] = {static_cast<float>(a.cos), static_cast<float>(a.sin)};
    }
    return out;
  }();
  return table[wrapped(floor_of(turn * kDirections), kDirections)];
}

void paint_fine_grains(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const float depth = static_cast<float>(row.depth);
  const std::vector<float> clouds =
      Fractal(cells_of(row.width, 0.3), cells_of(row.height, 0.3), 3, 0.6F, seed + 1).pixels(canvas.pixels);
  const std::vector<float> grains =
      Fractal(cells_of(row.width, row.stone_width), cells_of(row.height, row.stone_height), 1, 1, seed + 2)
          .pixels(canvas.pixels);
  const std::vector<float> patches =
      Fractal(cells_of(row.width, 5 * row.stone_width), cells_of(row.height, 5 * row.stone_height), 1, 1, seed + 3)
          .pixels(canvas.pixels);
  canvas.fill([&](float x, float y, std::size_t i) {
    const std::uint32_t key = place_bits(floor_of(x / canvas.pixel_x), floor_of(y / canvas.pixel_y), seed);
    const float white = draw(key, 1) * 2 - 1, g = grains[i], p = patches[i];
    Texel t;
    t.height = depth * (0.5F + 0.3F * g + 0.15F * white + 0.2F * p);
    // Few grains are of bright stone.
    const float bright = draw(key, 3) > 0.95F ? 0.3F : 0;
    t.light = 0.58F + 0.26F * g + 0.2F * white + 0.1F * p + 0.12F * clouds[i] + bright;
    shift_hue(t, 0.02F * (draw(key, 2) - 0.5F) + 0.02F * g);
    t.roughness = 0.04F * g;
    return t;
  });
}

/// A stone of loose ground: a polygon with a domed top.
void paint_grain(Canvas& canvas, float x, float y, float radius, float bed, float dome, std::uint32_t key) {
  constexpr int kSides = 6;
  std::array<float, kSides> nx, ny;
  const float squeeze = 0.65F + 0.35F * draw(key, 21);
  const Direction lie = direction_of(0.5F * draw(key, 22));
  for (int i = 0; i < kSides; ++i) {
    const Direction turn = direction_of((static_cast<float>(i) + 0.7F * draw(key, 30 + i)) / kSides);
    const float out = 1 / (0.8F + 0.2F * draw(key, 40 + i));
    const float a = turn.x * out, b = turn.y * out / squeeze;
    nx[i] = (a * lie.x - b * lie.y) / radius;
    ny[i] = (a * lie.y + b * lie.x) / radius;
  }
  const float tone = 0.7F + 0.34F * draw_middle(key, 23), hue = 0.07F * draw_middle(key, 24);
  const float reach = radius * 1.2F;
  const int left = floor_of((x - reach) / canvas.pixel_x), right = floor_of((x + reach) / canvas.pixel_x);
  const int low = floor_of((y - reach) / canvas.pixel_y), high = floor_of((y + reach) / canvas.pixel_y);
  const float lean_x = (draw(key, 25) - 0.5F) * 0.9F / radius, lean_y = (draw(key, 26) - 0.5F) * 0.9F / radius;
  for (int j = low; j <= high; ++j) {
    const float dy = (static_cast<float>(j) + 0.5F) * canvas.pixel_y - y;
    for (int i = left; i <= right; ++i) {
      const float dx = (static_cast<float>(i) + 0.5F) * canvas.pixel_x - x;
      float d = 0;
      for (int side = 0; side < kSides; ++side) d = std::max(d, nx[side] * dx + ny[side] * dy);
      if (d >= 1) continue;
      const float rise = 1 - d * d * d * d;
      const float top = bed + dome * (rise * (1 + lean_x * dx + lean_y * dy));
      Texel& t = canvas.at(i, canvas.pixels - 1 - j);
      if (top <= t.height) continue;
      t = Texel{};
      t.height = top;
      t.light = tone - 0.4F * d * d * d * d;
      shift_hue(t, hue);
      t.roughness = 0.04F * (draw(key, 27) - 0.5F);
    }
  }
}

/// A blade of grass, from its root to its tip. \param width  m
void paint_blade(Canvas& canvas, float x, float y, float length, float width, float tall, std::uint32_t key) {
  const auto [dx, dy] = direction_of(draw(key, 21));
  const float bend = 0.7F * draw_middle(key, 22), high = 0.35F + 0.65F * draw(key, 23);
  const float tone = 0.16F * draw_middle(key, 24), hue = draw_middle(key, 25);
  const int steps = std::max(2, static_cast<int>(length / (0.8F * canvas.pixel_x)) + 1);
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    const float along = t * length, aside = bend * t * t * length * 0.5F;
    const float px = x + dx * along - dy * aside, py = y + dy * along + dx * aside;
    const float rise = high * (1 - (1 - t) * (1 - t));
    const float half = 0.5F * width * (1 - 0.7F * t);
    // The blade's own width, and one pixel at least.
    const int across = static_cast<int>(2 * half / canvas.pixel_x + 0.5F);
    for (int k = 0; k <= across; ++k) {
      const float off = across == 0 ? 0 : (static_cast<float>(k) / static_cast<float>(across) - 0.5F) * 2 * half;
      Texel& texel = canvas.at(floor_of((px - dy * off) / canvas.pixel_x),
                               canvas.pixels - 1 - floor_of((py + dx * off) / canvas.pixel_y));
      const float top = tall * rise;
      if (top <= texel.height) continue;
      texel = Texel{};
      texel.height = top;
      texel.light = 0.28F + 0.56F * rise + tone;
      // Towards yellow on the one side, towards blue on the other.
      texel.r *= 1 + 0.12F * hue;
      texel.b *= 1 - 0.1F * hue;
    }
  }
}

/// A place that is evenly spread: one in each cell of a grid, anywhere in it.
struct Spot {
  float x, y;
  std::uint32_t key;
};
template <class Put>
void spread(const Canvas& canvas, int columns, int rows, std::uint32_t seed, const Put& put) {
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::uint32_t key = place_bits(i, j, seed);
      put(Spot{(static_cast<float>(i) + draw(key, 1)) * canvas.width / static_cast<float>(columns),
               (static_cast<float>(j) + draw(key, 2)) * canvas.height / static_cast<float>(rows), key});
    }
}

}  // namespace

void paint_grains(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const float grain = static_cast<float>(row.stone_width), depth = static_cast<float>(row.depth);
  paint_fine_grains(canvas, row, seed);
  if (grain < kSmallestBody * canvas.pixel_x) return;
  for (Texel& t : canvas.texels) {  // the bed between the stones
    t.height = 0.12F * t.height;
    t.light = 0.3F * t.light;
  }
  // Stones of three sizes [E]: the large ones do not touch, the small ones fill what is between.
  struct Size {
    float share, cells, dome;
  };
  constexpr Size kSizes[] = {{0.45F, 0.45F, 0.4F}, {0.7F, 0.8F, 0.55F}, {1.0F, 1.15F, 0.75F}};
  std::uint32_t layer = seed + 10;
  for (const Size& size : kSizes) {
    const float radius = 0.62F * grain * size.share;
    if (radius < 0.9F * canvas.pixel_x) continue;
    const int columns = cells_of(row.width, grain * size.cells), rows = cells_of(row.height, grain * size.cells);
    spread(canvas, columns, rows, layer++, [&](const Spot& s) {
      const float own = radius * (0.8F + 0.3F * draw(s.key, 3));
      paint_grain(canvas, s.x, s.y, own, depth * 0.25F * draw(s.key, 4), depth * size.dome, s.key);
    });
  }
}

void paint_soil(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const float depth = static_cast<float>(row.depth);
  const std::vector<float> clods = Fractal(cells_of(row.width, 1.6 * row.stone_width),
                                           cells_of(row.height, 1.6 * row.stone_height), 3, 0.8F, seed + 1)
                                       .pixels(canvas.pixels);
  const std::vector<float> clouds =
      Fractal(cells_of(row.width, 0.3), cells_of(row.height, 0.3), 2, 0.6F, seed + 2).pixels(canvas.pixels);
  canvas.fill([&](float x, float y, std::size_t i) {
    const std::uint32_t key = place_bits(floor_of(x / canvas.pixel_x), floor_of(y / canvas.pixel_y), seed);
    const float white = draw(key, 1) * 2 - 1, c = clods[i];
    Texel t;
    t.height = depth * (0.4F + 0.45F * c + 0.04F * white);
    t.light = 0.6F + 0.6F * c + 0.12F * white + 0.1F * clouds[i];
    shift_hue(t, 0.03F * clouds[i]);
    return t;
  });
  // Crumbs and small stones lie on it, one on two of the cells.
  constexpr float kShare = 0.5F;
  spread(canvas, cells_of(row.width, row.stone_width), cells_of(row.height, row.stone_height), seed + 3,
         [&](const Spot& s) {
           if (draw(s.key, 3) > kShare) return;
           const float radius = static_cast<float>(row.stone_width) * (0.15F + 0.35F * draw(s.key, 4) * draw(s.key, 5));
           paint_grain(canvas, s.x, s.y, radius, depth * 0.3F, depth * (0.2F + 8 * radius), s.key);
         });
}

void paint_grass(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const float depth = static_cast<float>(row.depth), width = static_cast<float>(row.stone_width);
  const float length = static_cast<float>(row.stone_height);
  const std::vector<float> soil =
      Fractal(cells_of(row.width, 0.06), cells_of(row.height, 0.06), 2, 0.6F, seed + 1).pixels(canvas.pixels);
  const Fractal clumps(cells_of(row.width, 0.22), cells_of(row.height, 0.22), 2, 0.6F, seed + 2);
  canvas.fill([&](float, float, std::size_t i) {
    Texel t;
    t.light = 0.22F + 0.15F * soil[i];
    return t;
  });
  // Blades over each place, one above the other [E].
  constexpr double kLayers = 3.2;
  const double count = kLayers * row.width * row.height / (length * std::max(width, canvas.pixel_x));
  const int columns = std::max(1, static_cast<int>(std::sqrt(count)));
  spread(canvas, columns, columns, seed + 3, [&](const Spot& s) {
    const float clump = clumps.at(s.x / canvas.width, s.y / canvas.height);
    const float tall = depth * clamped(0.72F + 0.3F * clump, 0.3F, 1);
    paint_blade(canvas, s.x, s.y, length * (0.5F + 0.7F * draw(s.key, 3)), width, tall, s.key);
  });
}

}  // namespace blockrand::textures
