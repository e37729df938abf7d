#include "pipeline/observation/roof_view.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::observation {

namespace {

using model::Point2;
using model::Polygon;

/// m: so far from its edge a roof is looked at; what is nearer may be gutter, wall or neighbour. The second one where the
/// first leaves too little.
constexpr double kInset = 0.7, kSmallInset = 0.3;
constexpr std::size_t kFewestPixels = 30;
/// Of the box around a roof: of larger ones every second pixel is looked at, or every third.
constexpr double kMostPixels = 20000;
/// m: the strip along an edge that shows the slope above it.
constexpr double kStripDepth = 2.5;
/// Of the sum of the bands; of the blue band.
constexpr double kExcessGreen = 0.05, kOverBlue = 1.1;

struct Pixel {
  double x, y;  ///< m
  std::uint8_t red, green, blue;
  double brightness() const { return (2.0 * red + 5.0 * green + blue) / 8; }
};

struct NearestEdge {
  double distance = 1e300;  ///< m
  Point2 outward;           ///< unit vector
};

/// The edges of a plan.
class PlanEdges {
 public:
  explicit PlanEdges(std::span<const Polygon> plan) {
    const auto ring = [&](const model::Ring& r) {
      for (std::size_t i = 0; i < r.size(); ++i) edges_.push_back({r.points[i], r.points[(i + 1) % r.size()]});
    };
    for (const Polygon& polygon : plan) {
      ring(polygon.outer);
      for (const model::Ring& hole : polygon.holes) ring(hole);
    }
  }

  /// Where a line of pixels crosses the rings, m east, ascending: between the first two it is inside, and so on.
  std::vector<double> crossings(double y) const {
    std::vector<double> out;
    for (const auto& [a, b] : edges_)
      if ((a.y > y) != (b.y > y)) out.push_back(a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y));
    std::sort(out.begin(), out.end());
    return out;
  }

  /// From now on places on this line are asked for.
  void set_line(double y) {
    near_.clear();
    for (const auto& [a, b] : edges_)
      if (std::min(a.y, b.y) - kStripDepth <= y && y <= std::max(a.y, b.y) + kStripDepth)
        near_.push_back({a, b, std::min(a.x, b.x) - kStripDepth, std::max(a.x, b.x) + kStripDepth});
  }

  /// Of edges within kStripDepth; others are farther. \param p  on the line
  NearestEdge nearest(Point2 p) const {
    NearestEdge nearest;
    for (const Near& e : near_) {
      if (p.x < e.west || p.x > e.east) continue;
      const double d = geometry::distance_to_segment(p, e.a, e.b);
      if (d >= nearest.distance) continue;
      const double dx = e.b.x - e.a.x, dy = e.b.y - e.a.y, length = std::sqrt(dx * dx + dy * dy);
      nearest = {d, length > 0 ? Point2{dy / length, -dx / length} : Point2{}};
    }
    return nearest;
  }

 private:
  struct Near {
    Point2 a, b;
    double west, east;  ///< m: elsewhere it is farther than kStripDepth
  };
  std::vector<std::pair<Point2, Point2>> edges_;
  std::vector<Near> near_;
};

/// The roof's pixels and how far each is from its edge.
struct Roof {
  std::vector<Pixel> pixels;
  std::vector<double> inset;
  std::size_t missing = 0;  ///< that the image does not have
  EdgeStrips strips;
};

void add(EdgeStrips& s, double b, Point2 n) {
  s.count += 1, s.b += b, s.bb += b * b;
  s.nx += n.x, s.ny += n.y, s.bnx += b * n.x, s.bny += b * n.y;
  s.nxx += n.x * n.x, s.nxy += n.x * n.y, s.nyy += n.y * n.y;
}

Roof pixels_of(std::span<const Polygon> plan, const Patch& patch) {
  Roof roof;
  PlanEdges edges(plan);
  const double all = static_cast<double>(patch.width) * patch.height;
  const int every = std::max(1, static_cast<int>(std::sqrt(all / kMostPixels)));
  for (int r = 0; r < patch.height; r += every) {
    const double y = patch.north - (r + 0.5) * patch.size;
    const std::vector<double> borders = edges.crossings(y);
    if (borders.empty()) continue;
    edges.set_line(y);
    for (std::size_t k = 0; k + 1 < borders.size(); k += 2) {
      const auto column = [&](double x) { return static_cast<int>(std::ceil((x - patch.west) / patch.size - 0.5)); };
      const int first = std::max(0, column(borders[k])), last = std::min(patch.width, column(borders[k + 1]));
      for (int c = (first + every - 1) / every * every; c < last; c += every) {
        const auto i =
            static_cast<std::size_t>(r) * static_cast<std::size_t>(patch.width) + static_cast<std::size_t>(c);
        if (!patch.valid[i]) {
          ++roof.missing;
          continue;
        }
        const Point2 p{patch.west + (c + 0.5) * patch.size, y};
        const NearestEdge edge = edges.nearest(p);
        if (edge.distance < kSmallInset) continue;
        roof.pixels.push_back({p.x, p.y, patch.red[i], patch.green[i], patch.blue[i]});
        roof.inset.push_back(edge.distance);
        if (edge.distance >= kInset && edge.distance <= kStripDepth)
          add(roof.strips, roof.pixels.back().brightness(), edge.outward);
      }
    }
  }
  return roof;
}

/// Leaves and grass: excess green (Woebbecke, Meyer, Von Bargen, Mortensen, "Color indices for weed identification", 1995),
/// and little blue, which copper has.
bool is_green(const Pixel& p) {
  const double red = p.red, green = p.green, blue = p.blue;
  return 2 * green - red - blue > kExcessGreen * (red + green + blue) && green > kOverBlue * blue && green >= red;
}

std::vector<Pixel> inner(const Roof& roof) {
  std::vector<Pixel> out;
  for (std::size_t i = 0; i < roof.pixels.size(); ++i)
    if (roof.inset[i] >= kInset) out.push_back(roof.pixels[i]);
  return out.size() >= kFewestPixels ? out : roof.pixels;
}

// ---- colour

/// Otsu's threshold between dark and bright, and how much of the variance lies between the two (Otsu, "A threshold
/// selection method from gray-level histograms", 1979).
struct Split {
  int level = 0;
  double share = 0, dark = 0, bright = 0, bright_weight = 0;
};

Split split_by_brightness(const std::vector<Pixel>& pixels) {
  std::array<double, 256> count{};
  double sum = 0, squares = 0;
  for (const Pixel& p : pixels) {
    const double b = p.brightness();
    ++count[static_cast<std::size_t>(b)];
    sum += b, squares += b * b;
  }
  const auto n = static_cast<double>(pixels.size());
  const double mean = sum / n, variance = squares / n - mean * mean;
  Split best;
  double below = 0, below_sum = 0;
  for (int t = 0; t < 255; ++t) {
    below += count[static_cast<std::size_t>(t)];
    below_sum += count[static_cast<std::size_t>(t)] * (t + 0.5);
    if (below <= 0 || below >= n) continue;
    const double a = below_sum / below, b = (sum - below_sum) / (n - below);
    const double between = below / n * (1 - below / n) * (a - b) * (a - b);
    if (variance > 0 && between / variance > best.share) best = {t, between / variance, a, b, 1 - below / n};
  }
  return best;
}

/// Of vegetation over a roof: 2 G - R - B.
constexpr int kGreen = 30;
/// Shares of the pixels: a sunlit part of less is glare; a dark part is shadow when it is so much darker.
constexpr double kLeastSunlit = 0.2, kShadow = 0.62, kTwoParts = 0.6;
/// Levels: side of a cell of the histogram; of the ball around its fullest place that the colour is the mean of.
constexpr int kCell = 12;
constexpr double kBall = 30;
/// A brighter place of the histogram counts when it holds this share of the fullest.
constexpr double kBrighter = 0.45;

void find_colour(const std::vector<Pixel>& all, RoofView& view) {
  std::vector<Pixel> pixels;
  for (const Pixel& p : all)
    if (2 * p.green - p.red - p.blue < kGreen) pixels.push_back(p);
  if (pixels.size() < all.size() / 5) pixels = all;  // a green roof
  if (pixels.size() < kFewestPixels) return;
  const Split split = split_by_brightness(pixels);
  if (split.share > kTwoParts && split.dark < kShadow * split.bright && split.bright_weight >= kLeastSunlit)
    std::erase_if(pixels, [&](const Pixel& p) { return p.brightness() < split.level + 1; });
  constexpr int kCells = 256 / kCell + 1;
  std::vector<int> cells(static_cast<std::size_t>(kCells * kCells * kCells), 0);
  const auto at = [](int r, int g, int b) { return static_cast<std::size_t>((r * kCells + g) * kCells + b); };
  for (const Pixel& p : pixels) ++cells[at(p.red / kCell, p.green / kCell, p.blue / kCell)];
  // The sum of each cell and all its neighbours, one direction after the other.
  std::vector<int> smooth = cells, before;
  for (const int along : {kCells * kCells, kCells, 1}) {
    before = smooth;
    const auto stride = static_cast<std::size_t>(along);
    for (std::size_t i = 0; i < smooth.size(); ++i) {
      const int place = static_cast<int>(i) / along % kCells;
      if (place > 0) smooth[i] += before[i - stride];
      if (place < kCells - 1) smooth[i] += before[i + stride];
    }
  }
  const int fullest = *std::max_element(smooth.begin(), smooth.end());
  std::array<double, 3> middle{};
  int brightest = -1;
  for (int r = 0; r < kCells; ++r)
    for (int g = 0; g < kCells; ++g)
      for (int b = 0; b < kCells; ++b) {
        const int here = smooth[at(r, g, b)];
        if (here < kBrighter * fullest) continue;
        // Only peaks: a slope of the fullest place is no place of its own.
        bool peak = true;
        for (int dr = std::max(0, r - 1); dr <= std::min(kCells - 1, r + 1) && peak; ++dr)
          for (int dg = std::max(0, g - 1); dg <= std::min(kCells - 1, g + 1) && peak; ++dg)
            for (int db = std::max(0, b - 1); db <= std::min(kCells - 1, b + 1) && peak; ++db)
              peak = smooth[at(dr, dg, db)] <= here;
        const int brightness = 2 * r + 5 * g + b;
        if (!peak || brightness <= brightest) continue;
        brightest = brightness;
        middle = {(r + 0.5) * kCell, (g + 0.5) * kCell, (b + 0.5) * kCell};
      }
  if (brightest < 0) return;
  double held = 0;
  for (int round = 0; round < 6; ++round) {
    std::array<double, 3> sum{};
    held = 0;
    for (const Pixel& p : pixels) {
      const double dr = p.red - middle[0], dg = p.green - middle[1], db = p.blue - middle[2];
      if (dr * dr + dg * dg + db * db > kBall * kBall) continue;
      sum[0] += p.red, sum[1] += p.green, sum[2] += p.blue;
      ++held;
    }
    if (held <= 0) return;
    middle = {sum[0] / held, sum[1] / held, sum[2] / held};
  }
  const auto level = [](double v) { return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 255.0))); };
  view.colour = model::Colour{level(middle[0]), level(middle[1]), level(middle[2])};
  // A roof of one colour in good light is sure; a patchwork is not.
  view.colour_confidence = std::min(0.9, 0.3 + 0.6 * held / static_cast<double>(all.size()));
}

// ---- ridges

/// Direction of the walls, radians in [0, pi/2): the mean by length, where opposite and square walls count alike.
double main_direction(std::span<const Polygon> plan) {
  double x = 0, y = 0;
  for (const Polygon& polygon : plan)
    for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
      const Point2 a = polygon.outer.points[i], b = polygon.outer.points[(i + 1) % polygon.outer.size()];
      const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
      if (length <= 0) continue;
      // The fourth power of the unit vector turns by four times its angle.
      const double u = dx / length, v = dy / length, c2 = u * u - v * v, s2 = 2 * u * v;
      x += length * length * (c2 * c2 - s2 * s2), y += length * length * 2 * c2 * s2;
    }
  const double angle = base::atan2(y, x) / 4;
  return angle < 0 ? angle + base::kPi / 2 : angle;
}

/// m: strips beside a ridge that are compared, from `kStripFrom` to `kStripTo` away from it; half the width of the narrow
/// one on it; of the pieces that it is looked at in.
constexpr double kStripFrom = 0.3, kStripTo = 2.0, kWideTo = 5.0, kNarrow = 0.3, kPiece = 1.0;
/// A ridge lies in the middle part of a roof: of half the extent, to both sides.
constexpr double kMiddlePart = 0.6;
/// Levels of 255: darker roofs are compared as if they were so bright.
constexpr double kDark = 25;

/// The clearest line in the direction (u along, v across).
RidgeEvidence find_ridge(const std::vector<Pixel>& pixels, double angle) {
  const base::SinCos a = base::sin_cos(angle);
  double u0 = 1e300, u1 = -1e300, v0 = 1e300, v1 = -1e300;
  const Point2 origin{pixels.front().x, pixels.front().y};
  const auto along = [&](const Pixel& p) { return (p.x - origin.x) * a.cos + (p.y - origin.y) * a.sin; };
  const auto across = [&](const Pixel& p) { return -(p.x - origin.x) * a.sin + (p.y - origin.y) * a.cos; };
  for (const Pixel& p : pixels) {
    u0 = std::min(u0, along(p)), u1 = std::max(u1, along(p));
    v0 = std::min(v0, across(p)), v1 = std::max(v1, across(p));
  }
  // Brightness by piece along and step across, summed once for all lines.
  constexpr double kStep = 0.2;
  const int columns = static_cast<int>((u1 - u0) / kPiece) + 1, rows = static_cast<int>((v1 - v0) / kStep) + 1;
  const auto cell = [columns](int c, int r) {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c);
  };
  std::vector<double> sum(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0),
      count(sum.size(), 0.0);
  for (const Pixel& p : pixels) {
    const auto at = cell(std::min(columns - 1, static_cast<int>((along(p) - u0) / kPiece)),
                         std::min(rows - 1, static_cast<int>((across(p) - v0) / kStep)));
    sum[at] += p.brightness();
    ++count[at];
  }
  RidgeEvidence best;
  best.angle = std::fmod(angle * base::kDegreesPerRadian + 360, 180);
  const double middle = (v1 - v0) / 2;
  double best_score = -1;
  // Both halves of the plan, piece by piece, where both have pixels.
  double halves = 0, both = 0;
  for (int c = 0; c < columns; ++c) {
    double left = 0, n_left = 0, right = 0, n_right = 0;
    for (int k = 0; k < rows; ++k) {
      const bool upper = (k + 0.5) * kStep > middle;
      (upper ? left : right) += sum[cell(c, k)];
      (upper ? n_left : n_right) += count[cell(c, k)];
    }
    if (n_left < 4 || n_right < 4) continue;
    halves += left / n_left - right / n_right, both += (left / n_left + right / n_right) / 2 + kDark;
  }
  best.halves = both > 0 ? halves / both : 0;
  for (int r = 0; r < rows; ++r) {
    const double v = (r + 0.5) * kStep, offset = middle > 0 ? std::fabs(v - middle) / middle : 1;
    if (offset > kMiddlePart) continue;
    const auto mean = [&](int c, double from, double to, double& n) {
      double s = 0;
      n = 0;
      for (int k = std::max(0, static_cast<int>(std::floor((v + from) / kStep)));
           k <= std::min(rows - 1, static_cast<int>(std::floor((v + to) / kStep))); ++k)
        s += sum[cell(c, k)], n += count[cell(c, k)];
      return n > 0 ? s / n : 0;
    };
    double left_more = 0, right_more = 0, difference = 0, level = 0, line = 0, pieces = 0;
    double far_left = 0, far_right = 0, left_squares = 0, right_squares = 0, far_pieces = 0;
    for (int c = 0; c < columns; ++c) {
      double n_left = 0, n_right = 0, n_line = 0;
      const double left = mean(c, kStripFrom, kStripTo, n_left), right = mean(c, -kStripTo, -kStripFrom, n_right),
                   on = mean(c, -kNarrow / 2, kNarrow / 2, n_line);
      if (n_left < 4 || n_right < 4 || n_line < 1) continue;
      ++pieces;
      (left > right ? left_more : right_more) += 1;
      difference += left - right;
      level += (left + right) / 2;
      line += std::max(on - std::max(left, right), std::min(left, right) - on);
      const double wide_left = mean(c, kStripFrom, kWideTo, n_left),
                   wide_right = mean(c, -kWideTo, -kStripFrom, n_right);
      far_left += wide_left, left_squares += wide_left * wide_left;
      far_right += wide_right, right_squares += wide_right * wide_right;
      ++far_pieces;
    }
    if (pieces < 3) continue;
    const double brightness = level / pieces + kDark;
    const double contrast = difference / pieces / brightness;
    const double consistency = std::max(left_more, right_more) / pieces;
    const double bright_line = std::max(0.0, line / pieces) / brightness;
    const double score = (std::fabs(contrast) * (2 * consistency - 1) + bright_line) * (1 - 0.4 * offset);
    if (score <= best_score) continue;
    best_score = score;
    best.contrast = contrast, best.consistency = consistency, best.line = bright_line, best.offset = offset;
    best.length = pieces * kPiece;
    best.wide = (far_left - far_right) / far_pieces / brightness;
    const auto variance = [&](double sum, double squares) {
      return std::max(0.0, squares / far_pieces - sum * sum / far_pieces / far_pieces);
    };
    best.within = std::sqrt((variance(far_left, left_squares) + variance(far_right, right_squares)) / 2) / brightness;
  }
  return best;
}

// ---- what it means

Point2 left_of(const RidgeEvidence& line) {
  const base::SinCos a = base::sin_cos(line.angle * base::kRadiansPerDegree);
  return {-a.sin, a.cos};
}

/// Contrast that is the same along the line.
double steady(const RidgeEvidence& line) { return line.contrast * (2 * line.consistency - 1); }

/// A line as the sun sees it.
struct LitLine {
  double facing = 0;            ///< how far one of its sides turns to the sun, [0, 1]
  double steady = 0, wide = 0;  ///< contrast; > 0: the side that turns to the sun is the brighter one
  double halves = 0;            ///< of the roof's halves, as `steady`
  double consistency = 0, line = 0, offset = 0, within = 0;
};

LitLine lit(const RidgeEvidence& r, Point2 to_sun) {
  const Point2 n = left_of(r);
  const double turn = n.x * to_sun.x + n.y * to_sun.y, sign = turn < 0 ? -1 : 1;
  return {std::fabs(turn),
          std::clamp(sign * steady(r), -0.5, 0.5),
          std::clamp(sign * r.wide, -0.5, 0.5),
          std::clamp(sign * r.halves, -0.5, 0.5),
          r.consistency,
          std::min(0.1, r.line),
          r.offset,
          std::min(0.3, r.within)};
}

double logistic(double sum) { return 1 / (1 + base::exp(-std::clamp(sum, -30.0, 30.0))); }

/// From these probabilities on an answer is given. Of synthetic images that were not fitted to (fit.py): see
/// docs/internal/RESULTS.md, "Aerial images".
constexpr double kSurePitched = 0.75, kSureFlat = 0.8, kSureRidge = 0.7;
/// m: of the shorter side that is looked at. Of narrower roofs that look flat one in three is none.
constexpr double kLeastFlat = 9;
/// m: of a line; shorter ones make no ridge.
constexpr double kLeastRidge = 3;
/// Length of the mean of unit vectors to the brighter sides: below it they point anywhere.
constexpr double kAgreeing = 0.1;

/// How the strips along the edges answer to the sun: by how much they are brighter, by the mean, for a strip that turns
/// from across to it; and the correlation.
struct StripsAnswer {
  double slope = 0, correlation = 0;
};

StripsAnswer answer_of(const EdgeStrips& s, Point2 to_sun) {
  constexpr double kFewest = 20, kLeastVariance = 0.02;  // strips that all look one way say nothing
  if (s.count < kFewest) return {};
  const double n = s.count, turn = (s.nx * to_sun.x + s.ny * to_sun.y) / n, bright = s.b / n;
  const double turns =
      (s.nxx * to_sun.x * to_sun.x + 2 * s.nxy * to_sun.x * to_sun.y + s.nyy * to_sun.y * to_sun.y) / n - turn * turn;
  const double both = (s.bnx * to_sun.x + s.bny * to_sun.y) / n - turn * bright;
  const double variance = std::max(1e-9, s.bb / n - bright * bright);
  if (turns < kLeastVariance) return {};
  return {std::clamp(both / turns / (bright + kDark), -0.5, 0.5),
          std::clamp(both / std::sqrt(turns * variance), -1.0, 1.0)};
}

}  // namespace

std::optional<double> sun_azimuth(std::span<const RoofView> roofs) {
  constexpr double kMostMetres = 30;  // a hall says no more than that
  Point2 sum;
  double weight = 0;
  for (const RoofView& roof : roofs)
    for (const RidgeEvidence& line : roof.ridges) {
      const Point2 n = left_of(line);
      const double w = steady(line) * std::min(kMostMetres, line.length);
      sum.x += n.x * w, sum.y += n.y * w, weight += std::fabs(w);
    }
  if (weight <= 0 || std::sqrt(sum.x * sum.x + sum.y * sum.y) < kAgreeing * weight) return std::nullopt;
  const double azimuth = 90 - base::atan2(sum.y, sum.x) * base::kDegreesPerRadian;
  return azimuth < 0 ? azimuth + 360 : azimuth;
}

void judge_roof(RoofView& roof, double sun) {
  if (roof.ridges[0].length < kLeastRidge || roof.ridges[1].length < kLeastRidge) return;
  const base::SinCos a = base::sin_cos(sun * base::kRadiansPerDegree);
  const LitLine along = lit(roof.ridges[0], {a.sin, a.cos}), across = lit(roof.ridges[1], {a.sin, a.cos});
  const double longer = base::log(roof.long_side + 1), shorter = base::log(roof.short_side + 1);
  // Weights of logistic regressions, fit.py of tests/bench/imagery.
  const LitLine &lit = along.facing >= across.facing ? along : across, &other = &lit == &along ? across : along;
  const LitLine& clear = along.steady >= across.steady ? along : across;
  // Red tiles lie on slopes, gravel and white foil do not.
  const model::Colour colour = roof.colour.value_or(model::Colour{128, 128, 128});
  const double red = colour.r, green = colour.g, blue = colour.b, total = red + green + blue;
  const double redness = std::clamp(3 * (red - blue) / (total + 1), -0.5, 1.0),
               greenness = std::clamp(3 * (2 * green - red - blue) / (total + 1), 0.0, 0.5);
  const StripsAnswer strips = answer_of(roof.strips, {a.sin, a.cos});
  const double pitched =
      logistic(-0.74 + 4.59 * redness + 0.39 * greenness - 3.62 * total / 765 + 0.92 * lit.steady +
               0.72 * other.steady + 0.91 * lit.wide + 0.39 * other.wide + 1.74 * lit.halves + 0.69 * other.halves +
               0.68 * strips.slope + 1.25 * strips.correlation + 3.61 * std::min(0.3, roof.spread) + 0.44 * shorter -
               0.73 * longer + 1.55 * clear.consistency - 1.56 * clear.offset + 1.71 * lit.facing);
  if (pitched >= kSurePitched) roof.form = RoofForm::pitched;
  if (pitched <= 1 - kSureFlat && roof.short_side >= kLeastFlat) roof.form = RoofForm::flat;
  if (roof.form != RoofForm::unknown) roof.form_confidence = std::max(pitched, 1 - pitched);
  if (pitched < 0.5) return;
  const double runs_along =
      logistic(0.2 + 3.33 * (along.steady - across.steady) + 5.44 * (along.wide - across.wide) -
               0.09 * (along.line - across.line) + 1.34 * (across.offset - along.offset) -
               0.08 * std::min(2.0, longer - shorter) + 2.45 * (along.consistency - across.consistency) -
               1.46 * (along.facing - across.facing) - 4.76 * (along.within - across.within));
  if (std::max(runs_along, 1 - runs_along) < kSureRidge) return;
  const RidgeEvidence& ridge = roof.ridges[runs_along > 0.5 ? 0 : 1];
  roof.ridge = std::fmod(90 - ridge.angle + 180, 180);
  roof.ridge_confidence = std::max(runs_along, 1 - runs_along);
}

RoofView look_at_roof(std::span<const Polygon> plan, const ImageWindows& windows) {
  RoofView view;
  geometry::PlanBox box;
  for (const Polygon& polygon : plan) box.include(geometry::box_of(polygon.outer.points));
  if (box.empty()) return view;
  const Roof roof = pixels_of(plan, windows.window(box, 0.5));
  const std::vector<Pixel> pixels = inner(roof);
  if (pixels.empty() || roof.missing > roof.pixels.size() / 4) return view;
  view.pixels = static_cast<std::uint32_t>(pixels.size());
  view.strips = roof.strips;
  if (pixels.size() < kFewestPixels) return view;
  find_colour(pixels, view);
  double sum = 0, squares = 0;
  for (const Pixel& p : pixels) sum += p.brightness(), squares += p.brightness() * p.brightness();
  const double mean = sum / static_cast<double>(pixels.size());
  view.green = static_cast<double>(std::ranges::count_if(pixels, is_green)) / static_cast<double>(pixels.size());
  view.spread = std::sqrt(std::max(0.0, squares / static_cast<double>(pixels.size()) - mean * mean)) / (mean + kDark);
  const double direction = main_direction(plan);
  double extent[2];
  for (int k = 0; k < 2; ++k) {
    const base::SinCos a = base::sin_cos(direction + k * base::kPi / 2);
    double low = 1e300, high = -1e300;
    for (const Pixel& p : pixels) {
      const double u = (p.x - pixels.front().x) * a.cos + (p.y - pixels.front().y) * a.sin;
      low = std::min(low, u), high = std::max(high, u);
    }
    extent[k] = high - low;
  }
  const int longer = extent[1] > extent[0] ? 1 : 0;
  for (int k = 0; k < 2; ++k)
    view.ridges[static_cast<std::size_t>(k)] = find_ridge(roof.pixels, direction + ((k + longer) % 2) * base::kPi / 2);
  view.long_side = extent[longer], view.short_side = extent[1 - longer];
  return view;
}

}  // namespace blockrand::observation
