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

/// The change of brightness across a piece, displaced by whole pixels along its normal (lines) and along itself (cells), within
/// the reach of the search. Negative where the image has no pixels. Kept between pieces for its memory.
class ChangeTable {
 public:
  ChangeTable(const PatchSamples& patch, double reach)
      : patch_(patch),
        radius_(reach / patch.size + kCorner),
        side_(static_cast<int>(std::ceil(reach / patch.size)) + 1) {
    for (int i = 0; i <= side_ + kStrip; ++i) {
      const double rest = radius_ * radius_ - static_cast<double>(i) * i;
      chord_.push_back(rest > 0 ? std::min(side_, static_cast<int>(std::sqrt(rest))) : -1);
    }
    const auto all = static_cast<std::size_t>(2 * (side_ + kStrip) + 1) * static_cast<std::size_t>(columns());
    for (std::vector<float>& plane : strips_) plane.resize(all);
    values_.resize(static_cast<std::size_t>(columns()) * static_cast<std::size_t>(columns()));
  }

  int side() const { return side_; }
  int columns() const { return 2 * side_ + 1; }
  /// Cells on both sides of a line's middle that are within reach; -1: none.
  int chord(int line) const { return chord_[static_cast<std::size_t>(std::abs(line))]; }
  /// Of the cell (0, -side) of a line, in [-side, side].
  float* line(int i) {
    return values_.data() + static_cast<std::size_t>(i + side_) * static_cast<std::size_t>(columns());
  }
  const float* values() const { return values_.data(); }

  /// Fills it. \param contrast  as score_outline() has it
  /// \returns  whether the image shows all of it
  bool fill(Point2 middle, Point2 along, double length, float contrast) {
    const int cells = std::max(1, static_cast<int>(std::lround(length / patch_.size)));
    bool all_seen = true;
    for (int i = -side_ - kStrip; i <= side_ + kStrip; ++i) all_seen &= sum_line(i, middle, along, cells);
    const float per_pixel = 1 / static_cast<float>(kStrip * cells);
    for (int i = -side_; i <= side_; ++i) {
      const int reach = chord(i);
      if (reach < 0) continue;
      float* const out = line(i) + side_ - reach;
      const auto count = static_cast<std::size_t>(2 * reach + 1);
      std::fill_n(out, count, 0.0F);
      for (std::size_t band = 0; band < 3; ++band) {
        const float *a = strip(band, i + 1, reach), *b = strip(band, i + 2, reach), *c = strip(band, i - 1, reach),
                    *d = strip(band, i - 2, reach);
        for (std::size_t j = 0; j < count; ++j) {
          const float difference = (a[j] + b[j]) - (c[j] + d[j]);
          out[j] += difference * difference;
        }
      }
      for (std::size_t j = 0; j < count; ++j) {
        const float x = std::sqrt(out[j]) * per_pixel;
        out[j] = x / (x + contrast);
      }
      if (all_seen) continue;
      const float *a = strip(3, i + 1, reach), *b = strip(3, i + 2, reach), *c = strip(3, i - 1, reach),
                  *d = strip(3, i - 2, reach);
      for (std::size_t j = 0; j < count; ++j)
        if (a[j] + b[j] + c[j] + d[j] > 0) out[j] = -1;
    }
    return all_seen;
  }

  /// What lies beyond the image speaks neither for a displacement nor against it: it becomes as what is seen is on average.
  /// \returns  false where too little is seen, or not the piece as it lies
  bool fill_unseen() {
    std::size_t all = 0, unseen = 0;
    double sum = 0;
    const auto for_each = [&](const auto& visit) {
      for (int i = -side_; i <= side_; ++i)
        for (int j = -chord(i); j <= chord(i); ++j) visit(line(i)[j + side_]);
    };
    for_each([&](float x) { ++all, unseen += x < 0, sum += x < 0 ? 0 : static_cast<double>(x); });
    if (static_cast<double>(unseen) > kMostUnseen * static_cast<double>(all) || line(0)[side_] < 0) return false;
    const auto usual = static_cast<float>(sum / static_cast<double>(all - unseen));
    for_each([&](float& x) { x = x < 0 ? usual : x; });
    return true;
  }

 private:
  static_assert(kStrip == 2, "fill() adds two lines on each side");
  /// Pixels: a displacement within reach lies between four cells, the farthest of them so much farther.
  static constexpr double kCorner = 2;

  const float* strip(std::size_t band, int i, int reach) const {
    return strips_[band].data() + static_cast<std::size_t>(i + side_ + kStrip) * static_cast<std::size_t>(columns()) +
           static_cast<std::size_t>(side_ - reach);
  }

  /// Sums of the bands over the length of the piece, at each cell of a line. \returns  whether the image shows all of it
  bool sum_line(int i, Point2 middle, Point2 along, int cells) {
    const int reach = chord(std::max(0, std::abs(i) - kStrip)), samples = 2 * reach + cells;
    if (reach < 0) return true;
    before_.resize(static_cast<std::size_t>(samples) + 1);
    // Position of the first sample in pixels of the patch, from the centre of its first.
    const double size = patch_.size, first = (0.5 - reach - static_cast<double>(cells) / 2) * size;
    const double x0 = (middle.x + along.x * first + along.y * i * size - patch_.west) / size - 0.5;
    const double y0 = (patch_.north - middle.y - along.y * first + along.x * i * size) / size - 0.5;
    const auto width = static_cast<std::size_t>(patch_.width);
    Sample sum{};
    before_[0] = sum;
    const auto inside = [&](int j) {
      const double x = x0 + along.x * j, y = y0 - along.y * j;
      return x >= 0 && y >= 0 && x < patch_.width - 1 && y < patch_.height - 1;
    };
    const auto pixel = [&](int j) {
      const double x = x0 + along.x * j, y = y0 - along.y * j;
      const int c = static_cast<int>(x), r = static_cast<int>(y);
      const Sample* const at = patch_.pixels.data() + static_cast<std::size_t>(r) * width + static_cast<std::size_t>(c);
      const Sample* const below = at + width;
      const auto u = static_cast<float>(x - c), v = static_cast<float>(y - r);
      const Sample upper = at[0] + u * (at[1] - at[0]), lower = below[0] + u * (below[1] - below[0]);
      return upper + v * (lower - upper);
    };
    Sample* next = before_.data() + 1;
    if (inside(0) && inside(samples - 1)) {  // and so are all between
      for (int j = 0; j < samples; ++j) *next++ = sum += pixel(j);
    } else {
      for (int j = 0; j < samples; ++j) {
        if (inside(j))
          sum += pixel(j);
        else
          sum[3] += 1;
        *next++ = sum;
      }
    }
    const std::size_t start = static_cast<std::size_t>(i + side_ + kStrip) * static_cast<std::size_t>(columns()) +
                              static_cast<std::size_t>(side_ - reach);
    for (std::size_t j = 0; j < static_cast<std::size_t>(2 * reach + 1); ++j) {
      const Sample over = before_[j + static_cast<std::size_t>(cells)] - before_[j];
      for (std::size_t band = 0; band < 4; ++band) strips_[band][start + j] = over[band];
    }
    return sum[3] <= 0;
  }

  const PatchSamples& patch_;
  std::vector<Sample> before_;  ///< sums before each sample of a line
  double radius_;
  int side_;
  std::vector<int> chord_;                    ///< by line, from the middle on
  std::array<std::vector<float>, 4> strips_;  ///< by band, line by line
  std::vector<float> values_;
};

}  // namespace

PatchSamples::PatchSamples(const Patch& patch)
    : west(patch.west), north(patch.north), size(patch.size), width(patch.width), height(patch.height) {
  pixels.resize(patch.valid.size());
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = Sample{static_cast<float>(patch.red[i]), static_cast<float>(patch.green[i]),
                       static_cast<float>(patch.blue[i]), patch.valid[i] ? 0.0F : 1.0F};
}

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

double score_margin(const Displacements& grid, double pixel) {
  return grid.reach() + kPieceLength / 2 + (kStrip + 3) * pixel;
}

ScoreMap score_outline(std::span<const WallPiece> pieces, const PatchSamples& patch, const Displacements& grid,
                       Point2 centre, base::SinCos turn, double contrast) {
  ScoreMap map(grid);
  if (pieces.empty()) return map;
  ChangeTable table(patch, grid.reach());
  const int side = table.side();
  const std::ptrdiff_t columns = table.columns();
  for (const WallPiece& piece : pieces) {
    const double weight = piece.length * piece.weight;
    if (weight <= 0) continue;
    const Point2 from{piece.middle.x - centre.x, piece.middle.y - centre.y};
    const Point2 middle{centre.x + from.x * turn.cos - from.y * turn.sin,
                        centre.y + from.x * turn.sin + from.y * turn.cos};
    const Point2 along{piece.along.x * turn.cos - piece.along.y * turn.sin,
                       piece.along.x * turn.sin + piece.along.y * turn.cos};
    if (!table.fill(middle, along, piece.length, static_cast<float>(contrast)) && !table.fill_unseen()) {
      map.missing += weight;
      continue;
    }
    map.weight += weight;
    // The displacement in lines and cells, bilinear between them: all four lie within the table's reach.
    const double scale = grid.step / patch.size, reach = static_cast<double>(grid.half) * grid.half + 0.5;
    const auto step_across = static_cast<float>(along.y * scale), step_onward = static_cast<float>(along.x * scale);
    const auto share = static_cast<float>(weight);
    for (int j = -grid.half; j <= grid.half; ++j) {
      const int chord = static_cast<int>(std::sqrt(reach - static_cast<double>(j) * j));
      const auto across = static_cast<float>(side - j * along.x * scale),
                 onward = static_cast<float>(side + j * along.y * scale);
      float* to = map.score.data() + static_cast<std::size_t>(j + grid.half) * static_cast<std::size_t>(grid.side()) +
                  static_cast<std::size_t>(grid.half - chord);
      for (int i = -chord; i <= chord; ++i, ++to) {
        const float x = across + static_cast<float>(i) * step_across, y = onward + static_cast<float>(i) * step_onward;
        const int a = static_cast<int>(x), b = static_cast<int>(y);
        const float u = x - static_cast<float>(a), v = y - static_cast<float>(b);
        const float* t = table.values() + static_cast<std::ptrdiff_t>(a) * columns + b;
        const float near = t[0] + v * (t[1] - t[0]), far = t[columns] + v * (t[columns + 1] - t[columns]);
        *to += share * (near + u * (far - near));
      }
    }
  }
  if (map.weight > 0)
    for (float& s : map.score) s = static_cast<float>(static_cast<double>(s) / map.weight);
  return map;
}

}  // namespace blockrand::observation
