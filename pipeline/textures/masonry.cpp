// Bricks, hewn stones, setts and flags.
#include <algorithm>
#include <cmath>

#include "pipeline/textures/canvas.h"
#include "pipeline/textures/courses.h"

namespace blockrand::textures {
namespace {

/// How stones are dressed. Shares are of the row's `contrast` or `depth`.
struct Dressing {
  CourseRule rule;
  float waver = 0;            ///< m by which edges leave the straight line
  float waver_size = 0.1F;    ///< m of a wave of it
  float arris = 0.003F;       ///< m over which the edge falls to the joint
  float pillow = 0;           ///< share of depth by which the middle stands above the edges
  float tilt = 0;             ///< share of depth by which a stone may lean
  float proud = 0;            ///< share of depth by which a stone may stand out
  float relief = 0.1F;        ///< share of depth, of the face's unevenness
  float relief_size = 0.03F;  ///< m
  float stone_light = 0.7F;   ///< mean of the stones
  float joint_light = 0.8F;
  float tone = 0.2F;     ///< from stone to stone, to both sides
  float mottle = 0.12F;  ///< within a stone, to both sides
  float grain = 0.08F;   ///< from pixel to pixel, to both sides
  float hue = 0.02F;     ///< share of linear light, from stone to stone
  float joint_hue = 0;   ///< share of linear light; below 0: colder than the stones
};

Dressing dressing_of(const TextureRow& row) {
  const float stone = static_cast<float>(std::min(row.stone_width, row.stone_height));
  Dressing d;
  switch (row.pattern) {
    case Pattern::cross_bond:
      d.rule.headers = true;
      [[fallthrough]];
    case Pattern::bond:
      d.waver = 0.0016F;
      d.waver_size = 0.05F;
      d.rule.corner_radius = 0.004F;
      d.arris = 0.004F;
      d.proud = 0.2F;
      d.tilt = 0.2F;
      d.relief = 0.2F;
      d.relief_size = 0.02F;
      d.stone_light = 0.6F;
      d.joint_light = 1.3F;
      d.tone = 0.26F;
      d.mottle = 0.18F;
      d.grain = 0.1F;
      d.hue = 0.06F;
      d.joint_hue = -0.05F;
      break;
    case Pattern::ashlar:
      d.rule.uneven_lengths = 0.22F;
      d.rule.corner_radius = 0.006F;
      d.waver = 0.0015F;
      d.arris = 0.006F;
      d.proud = 0.08F;
      d.relief = 0.16F;
      d.relief_size = 0.045F;
      d.stone_light = 0.7F;
      d.joint_light = 0.55F;
      d.tone = 0.24F;
      d.mottle = 0.26F;
      d.grain = 0.12F;
      d.hue = 0.03F;
      break;
    case Pattern::rubble:
      d.rule.uneven_lengths = 0.34F;
      d.rule.uneven_heights = 0.3F;
      d.rule.split_share = 0.4F;
      d.rule.corner_radius = 0.2F * stone;
      d.waver = 0.07F * stone;
      d.waver_size = 0.9F * stone;
      d.arris = 0.13F * stone;
      d.pillow = 0.3F;
      d.proud = 0.2F;
      d.tilt = 0.15F;
      d.relief = 0.3F;
      d.relief_size = 0.35F * stone;
      d.stone_light = 0.6F;
      d.joint_light = 0.8F;
      d.tone = 0.34F;
      d.mottle = 0.2F;
      d.hue = 0.03F;
      break;
    case Pattern::setts:
      d.rule.uneven_lengths = 0.14F;
      d.rule.uneven_heights = 0.06F;
      d.rule.corner_radius = 0.16F * stone;
      d.waver = 0.022F * stone;
      d.waver_size = 0.6F * stone;
      d.arris = 0.1F * stone;
      d.pillow = 0.35F;
      d.tilt = 0.15F;
      d.proud = 0.15F;
      d.relief = 0.14F;
      d.relief_size = 0.3F * stone;
      d.stone_light = 0.74F;
      d.joint_light = 0.34F;
      d.tone = 0.2F;
      d.mottle = 0.14F;
      d.grain = 0.1F;
      d.hue = 0.025F;
      break;
    case Pattern::plaster:
    case Pattern::cyclopean:
    case Pattern::concrete:
    case Pattern::boards:
    case Pattern::metal:
    case Pattern::pantiles:
    case Pattern::plain_tiles:
    case Pattern::slates:
    case Pattern::felt:
    case Pattern::grains:
    case Pattern::soil:
    case Pattern::cobbles:
    case Pattern::flags:
    case Pattern::grass:
      d.rule.corner_radius = 0.003F;
      d.arris = 0.005F;
      d.proud = 0.1F;
      d.tilt = 0.12F;
      d.relief = 0.08F;
      d.relief_size = 0.02F;
      d.stone_light = 0.74F;
      d.joint_light = 0.3F;
      d.tone = 0.14F;
      d.mottle = 0.12F;
      d.grain = 0.12F;
      d.hue = 0.015F;
  }
  return d;
}

/// The face of a stone and the joint beside it. \param inside  m to the stone's edge \param lean  of the place, -1 to 1
Texel dressed(const Dressing& d, float depth, float pixel, float inside, float reach, float lean_x, float lean_y,
              std::uint32_t key, float relief, float mottle, float grain) {
  // An edge is drawn over one pixel at least, so that it does not step.
  const float face = smooth(-0.5F * pixel, std::max(d.arris, 0.5F * pixel), inside);
  const float cover = clamped(inside / pixel + 0.5F);
  Texel t;
  const float leaning = (draw(key, 11) - 0.5F) * lean_x + (draw(key, 12) - 0.5F) * lean_y;
  const float middle = clamped(inside / reach);
  const float top = 1 - d.pillow * (1 - middle) * (1 - middle) + d.tilt * leaning + d.proud * (draw(key, 13) - 0.5F);
  t.height = depth * (face * top + d.relief * relief * (0.4F + 0.6F * face));
  const float tone = d.stone_light + d.tone * draw_middle(key, 14) + d.mottle * mottle + d.grain * grain;
  const float joint = d.joint_light + 0.6F * d.mottle * mottle + d.grain * grain;
  t.light = joint + (tone - joint) * cover;
  shift_hue(t, d.joint_hue + (d.hue * draw_middle(key, 15) - d.joint_hue) * cover);
  t.g *= 1 + 0.4F * d.hue * draw_middle(key, 16) * cover;
  t.roughness = 0.05F * (1 - cover) + 0.06F * (draw(key, 17) - 0.5F) * cover;
  return t;
}

/// Noise from pixel to pixel, -1 to 1.
float grain_at(const Canvas& canvas, float x, float y, std::uint32_t seed) {
  const int column = floor_of(x / canvas.pixel_x), row = floor_of(y / canvas.pixel_y);
  return unit_of(place_bits(column, row, seed)) * 2 - 1;
}

}  // namespace

void paint_masonry(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const Dressing d = dressing_of(row);
  const Courses courses(row, d.rule, seed);
  const std::vector<float> waver_x =
      Fractal(cells_of(row.width, d.waver_size), cells_of(row.height, d.waver_size), 2, 0.5F, seed + 1)
          .pixels(canvas.pixels);
  const std::vector<float> waver_y =
      Fractal(cells_of(row.width, d.waver_size), cells_of(row.height, d.waver_size), 2, 0.5F, seed + 2)
          .pixels(canvas.pixels);
  const std::vector<float> relief =
      Fractal(cells_of(row.width, d.relief_size), cells_of(row.height, d.relief_size), 2, 0.6F, seed + 3)
          .pixels(canvas.pixels);
  const std::vector<float> mottle =
      Fractal(cells_of(row.width, 0.12), cells_of(row.height, 0.12), 3, 0.6F, seed + 4).pixels(canvas.pixels);
  const float depth = static_cast<float>(row.depth);
  canvas.fill([&](float x, float y, std::size_t i) {
    const Stone s = courses.at(x + d.waver * waver_x[i], y + d.waver * waver_y[i]);
    return dressed(d, depth, canvas.pixel_x, s.inside, std::min(s.half_x, s.half_y), s.x / s.half_x, s.y / s.half_y,
                   s.key, relief[i], mottle[i], grain_at(canvas, x, y, seed));
  });
}

void paint_scattered(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const bool round = row.pattern == Pattern::cobbles;
  const float stone = static_cast<float>(std::min(row.stone_width, row.stone_height));
  Dressing d;
  d.waver = (round ? 0.04F : 0.05F) * stone;
  d.waver_size = (round ? 0.6F : 0.45F) * stone;
  d.arris = (round ? 0.18F : 0.06F) * stone;
  d.pillow = round ? 0.6F : 0.25F;
  d.proud = 0.2F;
  d.tilt = round ? 0.1F : 0.25F;
  d.relief = round ? 0.08F : 0.2F;
  d.relief_size = (round ? 0.3F : 0.16F) * stone;
  d.stone_light = 0.72F;
  d.joint_light = round ? 0.3F : 0.25F;
  d.tone = 0.26F;
  d.mottle = 0.22F;
  d.grain = 0.12F;
  d.hue = 0.03F;
  const Scatter stones(cells_of(row.width, row.stone_width), cells_of(row.height, row.stone_height),
                       round ? 0.6F : 0.8F, seed);
  const std::vector<float> waver_x =
      Fractal(cells_of(row.width, d.waver_size), cells_of(row.height, d.waver_size), 2, 0.5F, seed + 1)
          .pixels(canvas.pixels);
  const std::vector<float> waver_y =
      Fractal(cells_of(row.width, d.waver_size), cells_of(row.height, d.waver_size), 2, 0.5F, seed + 2)
          .pixels(canvas.pixels);
  const std::vector<float> relief =
      Fractal(cells_of(row.width, d.relief_size), cells_of(row.height, d.relief_size), 2, 0.6F, seed + 3)
          .pixels(canvas.pixels);
  const std::vector<float> mottle =
      Fractal(cells_of(row.width, 0.12), cells_of(row.height, 0.12), 3, 0.6F, seed + 4).pixels(canvas.pixels);
  const float depth = static_cast<float>(row.depth), joint = static_cast<float>(row.joint);
  canvas.fill([&](float x, float y, std::size_t i) {
    const float u = x / canvas.width, v = y / canvas.height;
    const Scatter::Cell c =
        stones.at(u + d.waver / canvas.width * waver_x[i], v + d.waver / canvas.height * waver_y[i]);
    float inside = c.edge * stone - joint / 2;
    if (round) {
      // Corners of the cell are filled with joint: the stone is the smaller of the cell and a ball.
      const float ball = 0.6F * stone - joint / 2 - std::sqrt(c.x * c.x + c.y * c.y) * stone;
      const float k = 0.22F * stone, h = clamped(0.5F + 0.5F * (ball - inside) / k);
      inside = ball + (inside - ball) * h - k * h * (1 - h);
    }
    return dressed(d, depth, canvas.pixel_x, inside, 0.4F * stone, c.x * 2, c.y * 2, c.key, relief[i], mottle[i],
                   grain_at(canvas, x, y, seed));
  });
}

}  // namespace blockrand::textures
