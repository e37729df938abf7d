#include "pipeline/textures/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "pipeline/base/portable_math.h"
#include "pipeline/base/random.h"
#include "pipeline/textures/canvas.h"

namespace blockrand::textures {
namespace {

/// Transfer function of sRGB (IEC 61966-2-1).
double linear_of(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : base::pow((encoded + 0.055) / 1.055, 2.4);
}
double encoded_of(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * base::pow(linear, 1 / 2.4) - 0.055;
}

struct Transfer {
  /// Steps of linear light. The steepest part that textures use, above 0.1, has 13 steps for each of the 255.
  static constexpr int kSteps = 1 << 13;
  std::array<double, 256> linear;
  std::array<std::uint8_t, kSteps + 1> encoded;
  Transfer() {
    for (int i = 0; i < 256; ++i) linear[i] = linear_of(i / 255.0);
    for (int i = 0; i <= kSteps; ++i)
      encoded[i] = static_cast<std::uint8_t>(encoded_of(static_cast<double>(i) / kSteps) * 255 + 0.5);
  }
};

const Transfer& transfer() {
  static const Transfer tables;
  return tables;
}

std::uint8_t byte_of(float share) { return static_cast<std::uint8_t>(clamped(share) * 255 + 0.5F); }

void paint(Canvas& canvas, const TextureRow& row) {
  const auto seed = static_cast<std::uint32_t>(base::hash_text(row.name));
  switch (row.pattern) {
    case Pattern::plaster:
      return paint_plaster(canvas, row, seed);
    case Pattern::bond:
    case Pattern::cross_bond:
    case Pattern::ashlar:
    case Pattern::rubble:
    case Pattern::setts:
    case Pattern::flags:
      return paint_masonry(canvas, row, seed);
    case Pattern::cyclopean:
    case Pattern::cobbles:
      return paint_scattered(canvas, row, seed);
    case Pattern::concrete:
      return paint_concrete(canvas, row, seed);
    case Pattern::boards:
      return paint_boards(canvas, row, seed);
    case Pattern::metal:
      return paint_metal(canvas, row, seed);
    case Pattern::pantiles:
      return paint_pantiles(canvas, row, seed);
    case Pattern::plain_tiles:
      return paint_plain_tiles(canvas, row, seed);
    case Pattern::slates:
      return paint_slates(canvas, row, seed);
    case Pattern::felt:
      return paint_felt(canvas, row, seed);
    case Pattern::grains:
      return paint_grains(canvas, row, seed);
    case Pattern::soil:
      return paint_soil(canvas, row, seed);
    case Pattern::grass:
      return paint_grass(canvas, row, seed);
  }
}

/// The mean of a square around each pixel, wrapping. \param reach  pixels to each side
std::vector<float> blurred(const std::vector<float>& in, int n, int reach) {
  std::vector<float> rows(in.size()), out(in.size());
  const float share = 1.0F / static_cast<float>(2 * reach + 1);
  for (int y = 0; y < n; ++y) {
    const float* from = &in[static_cast<std::size_t>(y) * n];
    float* to = &rows[static_cast<std::size_t>(y) * n];
    for (int x = 0; x < n; ++x) {
      float sum = 0;
      for (int k = -reach; k <= reach; ++k) sum += from[(x + k) & (n - 1)];
      to[x] = sum * share;
    }
  }
  for (int y = 0; y < n; ++y) {
    float* to = &out[static_cast<std::size_t>(y) * n];
    for (int k = -reach; k <= reach; ++k) {
      const float* from = &rows[static_cast<std::size_t>((y + k) & (n - 1)) * n];
      for (int x = 0; x < n; ++x) to[x] += from[x] * share;
    }
  }
  return out;
}

/// Darkens what lies lower than its neighbourhood: less of the sky is seen from there.
void shade_hollows(Canvas& canvas, const TextureRow& row, const std::vector<float>& heights) {
  constexpr float kLeastReach = 0.012F, kReach = 0.8F;  // m, and of the depth: of the neighbourhood [E]
  constexpr float kStrength = 0.9F;                     // share of contrast for a hollow of the whole depth [E]
  const float around_m = std::max(kLeastReach, kReach * static_cast<float>(row.depth));
  const int reach = std::clamp(static_cast<int>(around_m / canvas.pixel_x + 0.5F), 1, 6);
  const std::vector<float> around = blurred(heights, canvas.pixels, reach);
  const float scale = kStrength / static_cast<float>(row.depth);
  for (std::size_t i = 0; i < heights.size(); ++i)
    canvas.texels[i].light -= std::max(0.0F, around[i] - heights[i]) * scale;
}

using Channels = std::array<std::vector<float>, 3>;

/// Linear light of the pixels, no pixel darker than `contrast` allows but for its hue.
Channels light_of(const Canvas& canvas, const TextureRow& row) {
  Channels out;
  for (auto& channel : out) channel.resize(canvas.texels.size());
  const float contrast = static_cast<float>(row.contrast);
  for (std::size_t i = 0; i < canvas.texels.size(); ++i) {
    const Texel& t = canvas.texels[i];
    const float light = 1 - contrast * (1 - clamped(t.light));
    out[0][i] = light * t.r;
    out[1][i] = light * t.g;
    out[2][i] = light * t.b;
  }
  return out;
}

/// Takes from the light what varies over decimetres: from afar it would show where the texture repeats.
void even_out(Channels& light, int n) {
  constexpr int kCells = 8;          // along each side of the texture
  constexpr float kStrength = 0.9F;  // share of the variation that is taken
  const int size = n / kCells;
  if (size < 2) return;
  std::array<float, kCells * kCells> cells{};
  float mean = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) cells[y / size * kCells + x / size] += light[1][static_cast<std::size_t>(y) * n + x];
  for (float& cell : cells) mean += cell /= static_cast<float>(size * size);
  mean /= kCells * kCells;
  for (float& cell : cells) cell = 1 + kStrength * (mean / cell - 1);
  for (int y = 0; y < n; ++y) {
    const float fy = (static_cast<float>(y) + 0.5F) / static_cast<float>(size) - 0.5F;
    const int y0 = floor_of(fy);
    const float ty = fy - static_cast<float>(y0);
    const float* low = &cells[static_cast<std::size_t>(wrapped(y0, kCells)) * kCells];
    const float* high = &cells[static_cast<std::size_t>(wrapped(y0 + 1, kCells)) * kCells];
    for (int x = 0; x < n; ++x) {
      const float fx = (static_cast<float>(x) + 0.5F) / static_cast<float>(size) - 0.5F;
      const int x0 = floor_of(fx), left = wrapped(x0, kCells), right = wrapped(x0 + 1, kCells);
      const float tx = fx - static_cast<float>(x0);
      const float a = low[left] + (low[right] - low[left]) * tx, b = high[left] + (high[right] - high[left]) * tx;
      const float factor = a + (b - a) * ty;
      for (auto& channel : light) channel[static_cast<std::size_t>(y) * n + x] *= factor;
    }
  }
}

/// Scales the light so that its brightest pixels, all but five of a thousand, just reach 1. One factor for the three
/// channels, so that hues stay.
void brighten(Channels& light) {
  constexpr int kBins = 4096;
  constexpr float kTop = 2;  // of the bins; no light is above it
  std::vector<int> counts(kBins, 0);
  const std::size_t n = light[0].size();
  for (std::size_t i = 0; i < n; ++i) {
    const float brightest = std::max({light[0][i], light[1][i], light[2][i]});
    ++counts[static_cast<int>(clamped(brightest / kTop) * (kBins - 1))];
  }
  std::size_t above = 0;
  int bin = kBins - 1;
  while (bin > 0 && above + counts[bin] <= n / 200) above += counts[bin--];
  const float factor = kBins / (kTop * (static_cast<float>(bin) + 1));
  for (auto& channel : light)
    for (float& value : channel) value = std::min(value * factor, 1.0F);
}

std::vector<float> halved(const std::vector<float>& in, int n) {
  std::vector<float> out(in.size() / 4);
  for (int y = 0; y < n / 2; ++y)
    for (int x = 0; x < n / 2; ++x) {
      const float* p = &in[static_cast<std::size_t>(2 * y) * n + 2 * x];
      out[static_cast<std::size_t>(y) * (n / 2) + x] = (p[0] + p[1] + p[n] + p[n + 1]) * 0.25F;
    }
  return out;
}

/// Central differences, in metres, wrapping. Green is up, against the rows (glTF 2.0, 3.9.3).
std::vector<std::uint8_t> normals_of(const std::vector<float>& heights, int n, float pixel_x, float pixel_y) {
  std::vector<std::uint8_t> out;
  out.reserve(heights.size() * 3);
  const auto index = [n](int x, int y) { return static_cast<std::size_t>(y & (n - 1)) * n + (x & (n - 1)); };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const float along = (heights[index(x + 1, y)] - heights[index(x - 1, y)]) / (2 * pixel_x);
      const float up = (heights[index(x, y - 1)] - heights[index(x, y + 1)]) / (2 * pixel_y);
      const float scale = 0.5F / std::sqrt(along * along + up * up + 1);
      out.push_back(byte_of(0.5F - along * scale));
      out.push_back(byte_of(0.5F - up * scale));
      out.push_back(byte_of(0.5F + scale));
    }
  return out;
}

}  // namespace

TextureMaps make_maps(const TextureRow& row, TextureSize size) {
  Canvas canvas(row);
  paint(canvas, row);
  std::vector<float> heights(canvas.texels.size()), roughness(canvas.texels.size());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    heights[i] = canvas.texels[i].height;
    roughness[i] = static_cast<float>(row.roughness) + canvas.texels[i].roughness;
  }
  if (row.depth > 0) shade_hollows(canvas, row, heights);
  Channels light = light_of(canvas, row);
  even_out(light, canvas.pixels);
  brighten(light);

  TextureMaps maps;
  maps.pixels = canvas.pixels;
  if (size == TextureSize::small) {
    for (auto& channel : light) channel = halved(channel, maps.pixels);
    heights = halved(heights, maps.pixels);
    roughness = halved(roughness, maps.pixels);
    maps.pixels /= 2;
  }
  const float pixel = static_cast<float>(canvas.pixels / maps.pixels);
  maps.normal = normals_of(heights, maps.pixels, canvas.pixel_x * pixel, canvas.pixel_y * pixel);

  const Transfer& tables = transfer();
  const std::uint8_t metallic = byte_of(static_cast<float>(row.metallic));
  std::array<double, 3> sum{};
  maps.base.reserve(heights.size() * 3);
  maps.orm.reserve(heights.size() * 3);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const std::uint8_t value = tables.encoded[static_cast<int>(light[c][i] * Transfer::kSteps + 0.5F)];
      maps.base.push_back(value);
      sum[c] += tables.linear[value];
    }
    maps.orm.insert(maps.orm.end(), {std::uint8_t{255}, byte_of(roughness[i]), metallic});
  }
  for (int c = 0; c < 3; ++c) maps.mean[c] = sum[c] / static_cast<double>(heights.size());
  return maps;
}

}  // namespace blockrand::textures
