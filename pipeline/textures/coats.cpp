// Plaster, concrete and wood.
#include <algorithm>
#include <cmath>

#include "pipeline/textures/canvas.h"
#include "pipeline/textures/courses.h"

namespace blockrand::textures {

void paint_plaster(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const float depth = static_cast<float>(row.depth);
  const std::vector<float> clouds =
      Fractal(cells_of(row.width, 0.32), cells_of(row.height, 0.32), 3, 0.55F, seed + 1).pixels(canvas.pixels);
  const std::vector<float> bend =
      Fractal(cells_of(row.width, 0.5), cells_of(row.height, 0.5), 2, 0.5F, seed + 2).pixels(canvas.pixels);
  const double grain = row.stone_width > 0 ? row.stone_width : 0.014;
  const std::vector<float> grains =
      Fractal(cells_of(row.width, grain), cells_of(row.height, grain), 2, 0.7F, seed + 3).pixels(canvas.pixels);
  if (row.stone_width > 0) {
    // Rough: the grains of the sand stand out.
    const std::vector<float> lumps =
        Fractal(cells_of(row.width, 4 * grain), cells_of(row.height, 4 * grain), 2, 0.6F, seed + 4)
            .pixels(canvas.pixels);
    canvas.fill([&](float, float, std::size_t i) {
      const float g = grains[i], l = lumps[i];
      Texel t;
      t.height = depth * (0.5F + 0.4F * g + 0.22F * l);
      t.light = 0.66F + 0.32F * g + 0.12F * l + 0.1F * clouds[i];
      t.roughness = 0.02F * g;
      return t;
    });
    return;
  }
  // Trowelled: the float's arcs, that is bent noise, long in one direction, in two layers.
  const Noise along(cells_of(row.width, 0.32), cells_of(row.height, 0.05), seed + 5);
  const Noise across(cells_of(row.width, 0.07), cells_of(row.height, 0.36), seed + 6);
  canvas.fill([&](float x, float y, std::size_t i) {
    const float u = x / canvas.width, v = y / canvas.height;
    const float b = bend[i] * 0.03F, c = clouds[i];
    const float strokes = along.at(u + b, v + b) * (0.5F + 0.5F * c) + across.at(u - b, v + b) * (0.5F - 0.5F * c);
    const float g = grains[i];
    Texel t;
    const float white = unit_of(place_bits(floor_of(x / canvas.pixel_x), floor_of(y / canvas.pixel_y), seed)) * 2 - 1;
    t.height = depth * (0.5F + 0.3F * strokes + 0.22F * g + 0.05F * white);
    t.light = 0.6F + 0.14F * strokes + 0.26F * c + 0.26F * g + 0.08F * white;
    t.roughness = -0.03F * strokes;
    return t;
  });
}

namespace {

/// Air pores of concrete: small holes.
void paint_pores(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  constexpr float kPerSquareMetre = 130, kRadius = 0.002F, kMoreRadius = 0.005F;  // m [E]
  const float depth = static_cast<float>(row.depth);
  const auto count = static_cast<std::uint32_t>(kPerSquareMetre * canvas.width * canvas.height);
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t key = place_bits(k, 0, seed);
    const float x = draw(key, 1) * canvas.width, y = draw(key, 2) * canvas.height;
    const float radius = kRadius + kMoreRadius * draw(key, 3);
    const int column = floor_of(x / canvas.pixel_x), line = floor_of(y / canvas.pixel_y);
    const int reach = floor_of(radius / std::min(canvas.pixel_x, canvas.pixel_y)) + 2;
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i) {
        const float dx = (static_cast<float>(column + i) + 0.5F) * canvas.pixel_x - x;
        const float dy = (static_cast<float>(line + j) + 0.5F) * canvas.pixel_y - y;
        const float d = std::sqrt(dx * dx + dy * dy);
        const float hole = 1 - smooth(radius - 0.5F * canvas.pixel_x, radius + 0.5F * canvas.pixel_x, d);
        Texel& t = canvas.at(column + i, canvas.pixels - 1 - line - j);
        t.height -= depth * 0.2F * hole;
        t.light -= 0.4F * hole;
      }
  }
}

}  // namespace

void paint_concrete(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const float depth = static_cast<float>(row.depth), joint = static_cast<float>(row.joint);
  const bool panels = row.stone_width > 0;
  CourseRule rule;
  rule.shift = 0;  // joints of panels run through
  const Courses courses(row, rule, seed);
  const std::vector<float> clouds =
      Fractal(cells_of(row.width, 0.4), cells_of(row.height, 0.4), 4, 0.6F, seed + 1).pixels(canvas.pixels);
  const std::vector<float> fine =
      Fractal(cells_of(row.width, 0.03), cells_of(row.height, 0.03), 2, 0.7F, seed + 2).pixels(canvas.pixels);
  // Marks of a formwork of boards, upright, 0.15 m [E].
  const int boards = cells_of(row.width, 0.15);
  const Noise streaks(cells_of(row.width, 0.02), cells_of(row.height, 0.6), seed + 3);
  canvas.fill([&](float x, float y, std::size_t i) {
    const float u = x / canvas.width, v = y / canvas.height;
    const float c = clouds[i], f = fine[i];
    Texel t;
    t.height = depth * (0.8F + 0.04F * f);
    t.light = 0.72F + 0.22F * c + 0.18F * f;
    if (panels) {
      const float place = u * static_cast<float>(boards);
      const int board = wrapped(floor_of(place), boards);
      const float aside = place - std::floor(place);
      const float edge = std::min(aside, 1 - aside) * canvas.width / static_cast<float>(boards);
      const float seam = 1 - smooth(0, 0.006F, edge);
      const float tone = draw_middle(place_bits(board, 0, seed), 1);
      t.height += depth * (0.03F * tone + 0.05F * seam);
      t.light += 0.05F * tone - 0.07F * seam + 0.07F * streaks.at(u, v);
      // Upright joints lie aside of the border: corners of houses have none.
      const Stone s = courses.at(x + 0.25F * canvas.width, y);
      const float face = smooth(-0.5F * joint, 0.5F * joint, s.inside);
      t.height *= face;
      t.light -= 0.3F * (1 - face);
    }
    t.roughness = 0.03F * c;
    return t;
  });
  paint_pores(canvas, row, seed + 4);
}

void paint_boards(Canvas& canvas, const TextureRow& row, std::uint32_t seed) {
  const float depth = static_cast<float>(row.depth);
  CourseRule rule;
  rule.shift = 0;
  rule.uneven_lengths = 0.3F;
  const Courses courses(row, rule, seed);
  const Fractal bend(cells_of(row.width, 0.6), cells_of(row.height, 0.08), 2, 0.5F, seed + 1);
  const Fractal fibre(cells_of(row.width, 0.4), cells_of(row.height, 0.012), 2, 0.6F, seed + 2);
  const Noise rings(cells_of(row.width, 1.0), cells_of(row.height, 0.035), seed + 3);
  canvas.fill([&](float x, float y, std::size_t) {
    const Stone s = courses.at(x, y);
    const float u = x / canvas.width, v = y / canvas.height;
    // Each board is cut elsewhere from the tree.
    const float du = draw(s.key, 1), dv = draw(s.key, 2);
    const float b = 0.004F * bend.at(u + du, v + dv);
    const float r = rings.at(u + du, v + dv + b), f = fibre.at(u + du, v + dv + b);
    const float edge = smooth(-0.5F * canvas.pixel_y, 0.006F, s.inside);
    const float cover = clamped(s.inside / canvas.pixel_y + 0.5F);
    Texel t;
    t.height = depth * (edge * (0.85F + 0.1F * (draw(s.key, 3) - 0.5F)) + 0.08F * f + 0.05F * r);
    t.light = (0.68F + 0.2F * draw_middle(s.key, 4) + 0.3F * f + 0.22F * r) * cover + 0.12F * (1 - cover);
    shift_hue(t, 0.05F * draw_middle(s.key, 5) - 0.04F * r);
    t.roughness = 0.04F * f;
    return t;
  });
}

}  // namespace blockrand::textures
