#include "pipeline/observation/outline_score.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace blockrand::observation {

namespace {

using model::Point2;

/// m: shorter edges show no direction.
constexpr double kShortestEdge = 0.4;
/// Pixels of each strip beside a wall; the pixel line under the wall itself belongs to none.
constexpr int kStrip = 2;
/// Of the displacements of a piece: with more of them beyond the image's pixels it is not seen.
constexpr double kMostUnseen = 0.4;

/// Of the bands, and of what the image does not show.
using Sample = std::array<float, 4>;

/// The patch's pixels side by side: four numbers are one register.
std::vector<Sample> samples_of(const Patch& patch) {
  std::vector<Sample> out(patch.valid.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {static_cast<float>(patch.red[i]), static_cast<float>(patch.green[i]), static_cast<float>(patch.blue[i]),
              patch.valid[i] ? 0.0F : 1.0F};
  return out;
}

/// The image along a piece: sums along lines parallel to it.
class Profile {
 public:
  Profile(const Patch& patch, const std::vector<Sample>& pixels, Point2 middle, Point2 along, double length,
          double reach)
      : step_(patch.size),
        lines_(static_cast<int>(std::ceil(reach / step_)) + kStrip + 1),
        cells_(std::max(1, static_cast<int>(std::lround(length / step_)))),
        side_(static_cast<int>(std::ceil(reach / step_)) + 1) {
    const int across = 2 * lines_ + 1, columns = 2 * side_ + cells_;
    sums_.resize(static_cast<std::size_t>(across) * static_cast<std::size_t>(columns + 1));
    const Point2 normal{along.y, -along.x};
    std::size_t k = 0;
    for (int i = -lines_; i <= lines_; ++i) {
      Sum sum{};
      sums_[k++] = sum;
      // Position of the first sample in pixels of the patch, from the centre of its first.
      const double first = (0.5 - static_cast<double>(columns) / 2) * step_;
      const double x0 = (middle.x + along.x * first + normal.x * i * step_ - patch.west) / step_ - 0.5;
      const double y0 = (patch.north - middle.y - along.y * first - normal.y * i * step_) / step_ - 0.5;
      for (int j = 0; j < columns; ++j, ++k) {
        const double x = x0 + along.x * j, y = y0 - along.y * j;
        if (x < 0 || y < 0 || x >= patch.width - 1 || y >= patch.height - 1) {
          sum[3] += 1;
        } else {
          const int c = static_cast<int>(x), r = static_cast<int>(y);
          const std::size_t width = static_cast<std::size_t>(patch.width);
          const Sample* const at = pixels.data() + static_cast<std::size_t>(r) * width + static_cast<std::size_t>(c);
          const Sample* const below = at + width;
          const auto u = static_cast<float>(x - c), v = static_cast<float>(y - r);
          const float w00 = (1 - u) * (1 - v), w10 = u * (1 - v), w01 = (1 - u) * v, w11 = u * v;
          for (std::size_t n = 0; n < 4; ++n)
            sum[n] += w00 * at[0][n] + w10 * at[1][n] + w01 * below[0][n] + w11 * below[1][n];
        }
        sums_[k] = sum;
      }
    }
  }

  int lines() const { return lines_ - kStrip; }
  int side() const { return side_; }

  /// Change across the piece displaced by `line` lines along its normal and `cell` cells along itself; negative where
  /// the image has no pixels.
  float change(int line, int cell) const {
    Sum inside{}, outside{};
    for (int k = 1; k <= kStrip; ++k) {
      const Sum &a = sum(line + k, cell + side_ + cells_), &b = sum(line + k, cell + side_),
                &c = sum(line - k, cell + side_ + cells_), &d = sum(line - k, cell + side_);
      for (std::size_t n = 0; n < 4; ++n) outside[n] += a[n] - b[n], inside[n] += c[n] - d[n];
    }
    if (inside[3] + outside[3] > 0) return -1;
    float squares = 0;
    for (std::size_t n = 0; n < 3; ++n) squares += (outside[n] - inside[n]) * (outside[n] - inside[n]);
    return std::sqrt(squares) / static_cast<float>(kStrip * cells_);
  }

 private:
  using Sum = Sample;
  const Sum& sum(int line, int cell) const {
    return sums_[static_cast<std::size_t>(line + lines_) * static_cast<std::size_t>(2 * side_ + cells_ + 1) +
                 static_cast<std::size_t>(cell)];
  }
  double step_;
  int lines_, cells_, side_;
  std::vector<Sum> sums_;  // before each cell of each line
};

}  // namespace

void add_pieces(std::span<const Point2> ring, std::span<const double> weight_of, std::vector<WallPiece>& pieces) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
    const double length = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
    if (length < kShortestEdge) continue;
    const int count = static_cast<int>(std::ceil(length / kPieceLength));
    for (int k = 0; k < count; ++k) {
      const double at = (k + 0.5) / count;
      pieces.push_back({{a.x + (b.x - a.x) * at, a.y + (b.y - a.y) * at},
                        {(b.x - a.x) / length, (b.y - a.y) / length},
                        length / count,
                        weight_of[i]});
    }
  }
}

double ScoreMap::at(double dx, double dy) const {
  const double x = dx / grid.step + grid.half, y = dy / grid.step + grid.half;
  if (!(x >= 0 && y >= 0 && x <= grid.side() - 1 && y <= grid.side() - 1) || grid.side() < 2)
    return grid.side() == 1 && x == 0 && y == 0 ? static_cast<double>(score[0]) : 0;
  const int i = std::min(static_cast<int>(x), grid.side() - 2), j = std::min(static_cast<int>(y), grid.side() - 2);
  const double u = x - i, v = y - j;
  const auto value = [&](int a, int b) { return static_cast<double>(at(a - grid.half, b - grid.half)); };
  return (value(i, j) * (1 - u) + value(i + 1, j) * u) * (1 - v) +
         (value(i, j + 1) * (1 - u) + value(i + 1, j + 1) * u) * v;
}

ScoreMap score_outline(std::span<const WallPiece> pieces, const Patch& patch, const Displacements& grid, Point2 centre,
                       base::SinCos turn, double contrast) {
  ScoreMap map(grid);
  std::vector<double> total(map.score.size(), 0.0);
  std::vector<float> table;
  const std::vector<Sample> pixels = samples_of(patch);
  for (const WallPiece& piece : pieces) {
    const double weight = piece.length * piece.weight;
    if (weight <= 0) continue;
    const Point2 from{piece.middle.x - centre.x, piece.middle.y - centre.y};
    const Point2 middle{centre.x + from.x * turn.cos - from.y * turn.sin,
                        centre.y + from.x * turn.sin + from.y * turn.cos};
    const Point2 along{piece.along.x * turn.cos - piece.along.y * turn.sin,
                       piece.along.x * turn.sin + piece.along.y * turn.cos};
    const Profile profile(patch, pixels, middle, along, piece.length, grid.reach());
    const int lines = profile.lines(), side = profile.side(), columns = 2 * side + 1;
    table.resize(static_cast<std::size_t>(2 * lines + 1) * static_cast<std::size_t>(columns));
    std::size_t k = 0, unseen = 0;
    double sum = 0;
    const auto limit = static_cast<float>(contrast);
    for (int i = -lines; i <= lines; ++i)
      for (int j = -side; j <= side; ++j) {
        const float x = profile.change(i, j);
        table[k] = x < 0 ? -1.0F : x / (x + limit);
        unseen += x < 0;
        sum += x < 0 ? 0 : static_cast<double>(table[k]);
        ++k;
      }
    if (static_cast<double>(unseen) > kMostUnseen * static_cast<double>(k) || profile.change(0, 0) < 0) {
      map.missing += weight;
      continue;
    }
    map.weight += weight;
    // What lies beyond the image speaks neither for a displacement nor against it.
    const auto usual = static_cast<float>(sum / static_cast<double>(k - unseen));
    if (unseen > 0)
      for (float& value : table)
        if (value < 0) value = usual;
    // The displacement in lines and cells; both grids are fine enough for the nearest line, and bilinear along it.
    const double scale = grid.step / patch.size;
    const double reach = static_cast<double>(grid.half) * grid.half + 0.5;
    std::size_t cell = 0;
    for (int j = -grid.half; j <= grid.half; ++j)
      for (int i = -grid.half; i <= grid.half; ++i, ++cell) {
        if (static_cast<double>(i) * i + static_cast<double>(j) * j > reach) continue;
        const double across = (i * along.y - j * along.x) * scale + lines,
                     onward = (i * along.x + j * along.y) * scale + side;
        const int a = std::clamp(static_cast<int>(across), 0, 2 * lines - 1),
                  b = std::clamp(static_cast<int>(onward), 0, columns - 2);
        const double u = across - a, v = onward - b;
        const float* t = table.data() + static_cast<std::size_t>(a) * static_cast<std::size_t>(columns) +
                         static_cast<std::size_t>(b);
        const double here = (static_cast<double>(t[0]) * (1 - v) + static_cast<double>(t[1]) * v) * (1 - u) +
                            (static_cast<double>(t[columns]) * (1 - v) + static_cast<double>(t[columns + 1]) * v) * u;
        total[cell] += weight * here;
      }
  }
  if (map.weight > 0)
    for (std::size_t i = 0; i < total.size(); ++i) map.score[i] = static_cast<float>(total[i] / map.weight);
  return map;
}

}  // namespace blockrand::observation
