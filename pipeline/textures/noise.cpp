#include "pipeline/textures/noise.h"

#include <algorithm>
#include <cmath>

namespace blockrand::textures {

namespace {

// Gradients are drawn from a square: 1.6 brings the largest values near 1.
constexpr float kNoiseScale = 1.6F;

float quintic(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

}  // namespace

Noise::Noise(int cells_x, int cells_y, std::uint32_t seed) : cells_x_(cells_x), cells_y_(cells_y) {
  gradients_.reserve(static_cast<std::size_t>(cells_x + 1) * (cells_y + 1));
  for (int y = 0; y <= cells_y; ++y)
    for (int x = 0; x <= cells_x; ++x) {
      const std::uint32_t key = place_bits(x == cells_x ? 0 : x, y == cells_y ? 0 : y, seed);
      gradients_.push_back({draw(key, 1) * 2 - 1, draw(key, 2) * 2 - 1});
    }
}

float Noise::at(float u, float v) const {
  const float x = u * static_cast<float>(cells_x_), y = v * static_cast<float>(cells_y_);
  const int x0 = floor_of(x), y0 = floor_of(y);
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const Gradient* low =
      &gradients_[static_cast<std::size_t>(wrapped(y0, cells_y_)) * (cells_x_ + 1) + wrapped(x0, cells_x_)];
  const Gradient* high = low + cells_x_ + 1;
  const float a = low[0].x * fx + low[0].y * fy, b = low[1].x * (fx - 1) + low[1].y * fy;
  const float c = high[0].x * fx + high[0].y * (fy - 1), d = high[1].x * (fx - 1) + high[1].y * (fy - 1);
  const float sx = quintic(fx), below = a + (b - a) * sx, above = c + (d - c) * sx;
  return (below + (above - below) * quintic(fy)) * kNoiseScale;
}

void Noise::add(int n, float share, std::vector<float>& sum) const {
  // What depends on the column alone is worked out once.
  std::vector<int> cells(n);
  std::vector<float> asides(n), weights(n);
  for (int i = 0; i < n; ++i) {
    const float x = (static_cast<float>(i) + 0.5F) / static_cast<float>(n) * static_cast<float>(cells_x_);
    cells[i] = floor_of(x);
    asides[i] = x - static_cast<float>(cells[i]);
    weights[i] = quintic(asides[i]);
  }
  const float scale = share * kNoiseScale;
  for (int row = 0; row < n; ++row) {
    const float y = (static_cast<float>(n - row) - 0.5F) / static_cast<float>(n) * static_cast<float>(cells_y_);
    const int y0 = floor_of(y);
    const float fy = y - static_cast<float>(y0), sy = quintic(fy);
    const Gradient* low = &gradients_[static_cast<std::size_t>(y0) * (cells_x_ + 1)];
    const Gradient* high = low + cells_x_ + 1;
    float* out = &sum[static_cast<std::size_t>(row) * n];
    for (int i = 0; i < n; ++i) {
      const int cell = cells[i];
      const float fx = asides[i], sx = weights[i];
      const float a = low[cell].x * fx + low[cell].y * fy, b = low[cell + 1].x * (fx - 1) + low[cell + 1].y * fy;
      const float c = high[cell].x * fx + high[cell].y * (fy - 1);
      const float d = high[cell + 1].x * (fx - 1) + high[cell + 1].y * (fy - 1);
      const float below = a + (b - a) * sx, above = c + (d - c) * sx;
      out[i] += scale * (below + (above - below) * sy);
    }
  }
}

Fractal::Fractal(int cells_x, int cells_y, int octaves, float gain, std::uint32_t seed) : gain_(gain), scale_(0) {
  float share = 1;
  for (int i = 0; i < octaves; ++i) {
    octaves_.emplace_back(cells_x << i, cells_y << i, seed + static_cast<std::uint32_t>(i) * 101);
    scale_ += share;
    share *= gain;
  }
  scale_ = 1 / scale_;
}

float Fractal::at(float u, float v) const {
  float sum = 0, share = scale_;
  for (const Noise& octave : octaves_) {
    sum += share * octave.at(u, v);
    share *= gain_;
  }
  return sum;
}

std::vector<float> Fractal::pixels(int n) const {
  std::vector<float> sum(static_cast<std::size_t>(n) * n, 0.0F);
  float share = scale_;
  for (const Noise& octave : octaves_) {
    octave.add(n, share, sum);
    share *= gain_;
  }
  return sum;
}

Scatter::Scatter(int cells_x, int cells_y, float jitter, std::uint32_t seed) : cells_x_(cells_x), cells_y_(cells_y) {
  points_.reserve(static_cast<std::size_t>(cells_x + 2 * kMargin) * (cells_y + 2 * kMargin));
  for (int y = -kMargin; y < cells_y + kMargin; ++y)
    for (int x = -kMargin; x < cells_x + kMargin; ++x) {
      const std::uint32_t key = place_bits(wrapped(x, cells_x), wrapped(y, cells_y), seed);
      // Rows lie half a cell aside from each other: cells become six-sided, as closely packed stones are.
      const float aside = wrapped(y, cells_y) % 2 == 1 ? 0.25F : -0.25F;
      points_.push_back({0.5F + aside + (draw(key, 1) - 0.5F) * 0.7F * jitter, 0.5F + (draw(key, 2) - 0.5F) * jitter});
    }
}

Scatter::Cell Scatter::at(float u, float v) const {
  const float x = u * static_cast<float>(cells_x_), y = v * static_cast<float>(cells_y_);
  const int x0 = floor_of(x), y0 = floor_of(y);
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const int stride = cells_x_ + 2 * kMargin;
  const Point* here =
      &points_[static_cast<std::size_t>(wrapped(y0, cells_y_) + kMargin) * stride + wrapped(x0, cells_x_) + kMargin];
  const auto from = [&](int i, int j) {  // from here to the point of a near cell
    const Point& p = here[j * stride + i];
    return Point{static_cast<float>(i) + p.x - fx, static_cast<float>(j) + p.y - fy};
  };
  float best = 1e9F;
  int at_i = 0, at_j = 0;
  Point nearest{0, 0};
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      const Point p = from(i, j);
      const float d = p.x * p.x + p.y * p.y;
      if (d < best) {
        best = d;
        at_i = i;
        at_j = j;
        nearest = p;
      }
    }
  Cell cell;
  cell.x = -nearest.x;
  cell.y = -nearest.y;
  cell.key = place_bits(wrapped(x0 + at_i, cells_x_), wrapped(y0 + at_j, cells_y_), 5);
  // The nearest border is that of the smallest distance to a bisector of two points.
  cell.edge = 1e9F;
  const float own = std::sqrt(best);
  float reach = 1e9F;  // square of the distance between two points beyond which their bisector lies farther than `edge`
  for (int j = -2; j <= 2; ++j)
    for (int i = -2; i <= 2; ++i) {
      if (i == 0 && j == 0) continue;
      const Point p = from(at_i + i, at_j + j);
      const float dx = p.x - nearest.x, dy = p.y - nearest.y;
      const float length = dx * dx + dy * dy;
      if (length > reach) continue;
      const float edge = 0.5F * ((p.x + nearest.x) * dx + (p.y + nearest.y) * dy) / std::sqrt(length);
      if (edge >= cell.edge) continue;
      cell.edge = std::max(edge, 0.0F);
      reach = 4 * (cell.edge + own) * (cell.edge + own);
    }
  return cell;
}

}  // namespace blockrand::textures
