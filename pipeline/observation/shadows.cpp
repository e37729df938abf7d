#include "pipeline/observation/shadows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/base/portable_math.h"

namespace blockrand::observation {

namespace {

using model::Point2;

/// m beside the edge of a roof: where the sun or the shadow shows, and no gutter, nor the foot of the wall.
constexpr double kBesideFrom = 0.5, kBesideTo = 2.0;
/// Levels of 255: differences on dark ground count as if it were so bright.
constexpr double kDark = 25, kDarkShadow = 8;
/// Length of the mean of unit vectors to the brighter sides: below it they point anywhere. By chance it is the inverse of the
/// root of the number of houses: so many times that.
constexpr double kAgreeing = 0.05, kBeyondChance = 2;
/// Cosine between a wall's normal and where its shadow falls: others cast a narrow one.
constexpr double kFacing = 0.35;
/// m: of ground before and behind the end of a shadow that are compared, and the gap between them: edges are blurred.
constexpr double kCompared = 1.5, kGap = 0.25;
/// m: nearer the edge of the roof its gutter is seen.
constexpr double kEaves = 0.75;
/// A step is as good as this at most: snow beside a shadow is no better than gravel.
constexpr double kMostStep = 0.45;
/// Of the walls that cast a shadow: where fewer speak, the others count as if they said no.
constexpr double kFewestSpeak = 0.5;
/// What the square of the logarithm of its multiple of the usual length costs a shadow; what another edge takes from it.
constexpr double kUnusual = 0.1, kSecond = 0.5;
/// m: another edge; of a step: those beside it that are as strong are the same edge.
constexpr double kOtherEdge = 1.5;
constexpr float kSameEdge = 0.9F;

/// Mean along a piece that is moved by `by`; nothing where a pixel of it is missing.
std::optional<double> along_piece(const WallPiece& piece, const Brightness& patch, Point2 by) {
  const int count = std::max(1, static_cast<int>(std::lround(piece.length / patch.size)));
  const double step = piece.length / count / patch.size, dx = piece.along.x * step, dy = -piece.along.y * step;
  // From the middle of its first part, in pixels from the centre of the patch's first.
  const double back = (count - 1) / 2.0;
  const double x0 = (piece.middle.x + by.x - patch.west) / patch.size - 0.5 - back * dx,
               y0 = (patch.north - piece.middle.y - by.y) / patch.size - 0.5 - back * dy;
  const auto inside = [&](double x, double y) {
    return x >= 0 && y >= 0 && x < patch.width - 1 && y < patch.height - 1;
  };
  if (!inside(x0, y0) || !inside(x0 + (count - 1) * dx, y0 + (count - 1) * dy)) return std::nullopt;
  const auto width = static_cast<std::size_t>(patch.width);
  float sum = 0;
  for (int k = 0; k < count; ++k) {
    const double x = x0 + k * dx, y = y0 + k * dy;
    const int c = static_cast<int>(x), r = static_cast<int>(y);
    const auto u = static_cast<float>(x - c), v = static_cast<float>(y - r);
    const float* const at = patch.values.data() + static_cast<std::size_t>(r) * width + static_cast<std::size_t>(c);
    const float upper = at[0] + u * (at[1] - at[0]), lower = at[width] + u * (at[width + 1] - at[width]);
    sum += upper + v * (lower - upper);
  }
  if (std::isnan(sum)) return std::nullopt;
  return static_cast<double>(sum) / count;
}

Point2 outward(const WallPiece& piece) { return {piece.along.y, -piece.along.x}; }

/// The first of the places from + k * step, k > 2, that lies in another house, as k; no larger than `most`.
int first_within(std::span<const Obstacles> others, Point2 from, Point2 step, int most) {
  constexpr int kFirst = 3;
  const Point2 end{from.x + step.x * most, from.y + step.y * most};
  const geometry::PlanBox way{{std::min(from.x, end.x), std::min(from.y, end.y)},
                              {std::max(from.x, end.x), std::max(from.y, end.y)}};
  std::vector<double> borders;
  for (const Obstacles& o : others) {
    if (!o.box.near(way, 0)) continue;
    // Where the way crosses walls, in steps: from the first such place to the second it lies within, and so on.
    borders.clear();
    for (const std::vector<Point2>& ring : o.rings)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
        const double side_a = step.x * (a.y - from.y) - step.y * (a.x - from.x),
                     side_b = step.x * (b.y - from.y) - step.y * (b.x - from.x);
        if ((side_a > 0) == (side_b > 0)) continue;
        const double u = side_a / (side_a - side_b), x = a.x + u * (b.x - a.x) - from.x,
                     y = a.y + u * (b.y - a.y) - from.y;
        borders.push_back((x * step.x + y * step.y) / (step.x * step.x + step.y * step.y));
      }
    std::sort(borders.begin(), borders.end());
    for (std::size_t i = 0; i + 1 < borders.size(); i += 2) {
      const double first = std::max(std::ceil(borders[i]), static_cast<double>(kFirst));
      if (first <= borders[i + 1] && first < most) most = static_cast<int>(first);
    }
  }
  return most;
}

/// Brightness behind a piece by distance, in steps of kShadowStep from 0; ends where the image or another house does.
std::vector<double> behind(const WallPiece& piece, const Brightness& patch, Point2 roof, Point2 away,
                           std::span<const Obstacles> others, double reach) {
  std::vector<double> out;
  const int end = first_within(others, {piece.middle.x + roof.x, piece.middle.y + roof.y},
                               {away.x * kShadowStep, away.y * kShadowStep}, static_cast<int>(reach / kShadowStep) + 1);
  for (int k = 0; k < end; ++k) {
    const Point2 by{roof.x + away.x * k * kShadowStep, roof.y + away.y * k * kShadowStep};
    const auto b = along_piece(piece, patch, by);
    if (!b) break;
    out.push_back(*b);
  }
  return out;
}

/// The change at each distance, not cut at kMostStep: how much brighter the ground beyond is than the shadow before it, and
/// than all before it.
std::vector<float> steps_of(const std::vector<double>& brightness) {
  std::vector<double> sums(brightness.size() + 1, 0.0);
  for (std::size_t i = 0; i < brightness.size(); ++i) sums[i + 1] = sums[i] + brightness[i];
  const auto mean = [&](int from, int to) {
    return (sums[static_cast<std::size_t>(to)] - sums[static_cast<std::size_t>(from)]) / (to - from);
  };
  constexpr int kWide = static_cast<int>(kCompared / kShadowStep), kNarrow = static_cast<int>(kGap / kShadowStep),
                kFirst = static_cast<int>(kEaves / kShadowStep);
  std::vector<float> out;
  const int size = static_cast<int>(brightness.size());
  for (int k = 0; k + kNarrow + kWide <= size; ++k) {
    const int end = k - kNarrow + 1;
    if (end - kFirst < 2) {
      out.push_back(0);
      continue;
    }
    const double beyond = mean(k + kNarrow, k + kNarrow + kWide);
    const double near = mean(std::max(kFirst, end - kWide), end), all = mean(kFirst, end);
    const double before = std::max(near, all);
    out.push_back(static_cast<float>((beyond - before) / ((beyond + before) / 2 + kDarkShadow)));
  }
  return out;
}

/// Of a missing pixel: whatever it is added to is missing as well.
constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();

}  // namespace

Brightness::Brightness(const Patch& patch)
    : west(patch.west), north(patch.north), size(patch.size), width(patch.width), height(patch.height) {
  values.resize(patch.valid.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] =
        patch.valid[i] ? static_cast<float>(3 * patch.red[i] + 4 * patch.green[i] + patch.blue[i]) / 8 : kMissing;
}

void SunnySides::add(std::span<const WallPiece> pieces, const Brightness& patch, Point2 roof) {
  struct Beside {
    Point2 normal;
    double brightness, length;
  };
  std::vector<Beside> sides;
  double sum = 0, length = 0;
  for (const WallPiece& piece : pieces) {
    if (piece.weight < 1) continue;
    const Point2 n = outward(piece);
    double brightness = 0;
    int count = 0;
    for (double d = kBesideFrom; d <= kBesideTo; d += patch.size)
      if (const auto b = along_piece(piece, patch, {roof.x + n.x * d, roof.y + n.y * d})) brightness += *b, ++count;
    if (count == 0) continue;
    sides.push_back({n, brightness / count, piece.length});
    sum += brightness / count * piece.length, length += piece.length;
  }
  if (length <= 0) return;
  ++houses_;
  const double usual = sum / length;
  for (const Beside& s : sides) {
    const double w = std::clamp((s.brightness - usual) / (usual + kDark), -0.5, 0.5) * s.length;
    sum_.x += w * s.normal.x, sum_.y += w * s.normal.y, weight_ += std::fabs(w);
  }
}

void SunnySides::add(const SunnySides& other) {
  sum_.x += other.sum_.x, sum_.y += other.sum_.y, weight_ += other.weight_, houses_ += other.houses_;
}

std::optional<Point2> SunnySides::to_sun() const {
  const double size = std::sqrt(sum_.x * sum_.x + sum_.y * sum_.y);
  if (weight_ <= 0) return std::nullopt;
  if (size < std::max(kAgreeing, kBeyondChance / std::sqrt(static_cast<double>(houses_))) * weight_)
    return std::nullopt;
  return Point2{sum_.x / size, sum_.y / size};
}

ShadowScan scan_shadow(std::span<const WallPiece> pieces, const Brightness& patch, Point2 roof, Point2 away,
                       std::span<const Obstacles> others, double reach) {
  ShadowScan scan;
  const auto size = static_cast<std::size_t>(std::floor(reach / kShadowStep)) + 1;
  std::vector<double> sum(size, 0.0), sharp(size, 0.0), walls(size, 0.0);
  for (const WallPiece& piece : pieces) {
    const Point2 n = outward(piece);
    const double facing = n.x * away.x + n.y * away.y;
    if (piece.weight < 1 || facing < kFacing) continue;
    const double weight = piece.length * facing;
    scan.weight += weight;
    const std::vector<float> steps = steps_of(behind(piece, patch, roof, away, others, reach));
    for (std::size_t k = 0; k < std::min(size, steps.size()); ++k)
      sum[k] += weight * std::clamp(static_cast<double>(steps[k]), -kMostStep, kMostStep),
          sharp[k] += weight * static_cast<double>(steps[k]), walls[k] += weight;
  }
  for (std::size_t k = 0; k < size; ++k) {
    const double speak = std::max(walls[k], kFewestSpeak * scan.weight);
    scan.step.push_back(speak > 0 ? static_cast<float>(sum[k] / speak) : 0.0F);
    scan.sharp.push_back(speak > 0 ? static_cast<float>(sharp[k] / speak) : 0.0F);
    scan.walls.push_back(static_cast<float>(walls[k]));
  }
  return scan;
}

std::optional<ShadowLength> shadow_length(const ShadowScan& scan, double least, double most, double usual) {
  const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil(least / kShadowStep)));
  const std::size_t end = std::min(scan.step.size(), static_cast<std::size_t>(std::floor(most / kShadowStep)) + 1);
  if (first >= end || scan.weight <= 0) return std::nullopt;
  const auto value = [&](std::size_t k) {
    const double off = usual > 0 ? base::log(std::max(0.5, static_cast<double>(k)) * kShadowStep / usual) : 0;
    return static_cast<double>(scan.step[k]) - kUnusual * off * off;
  };
  std::size_t best = first;
  for (std::size_t k = first; k < end; ++k)
    if (value(k) > value(best)) best = k;
  if (!(scan.step[best] > 0)) return std::nullopt;
  ShadowLength out;
  out.step = static_cast<double>(scan.step[best]);
  out.walls = static_cast<double>(scan.walls[best]);
  constexpr auto kApart = static_cast<std::size_t>(kOtherEdge / kShadowStep);
  for (std::size_t k = first; k < end; ++k)
    if (k + kApart <= best || k >= best + kApart) out.second = std::max(out.second, static_cast<double>(scan.step[k]));
  out.clearness = value(best) - kSecond * out.second;
  // A strong step is cut over a wide stretch: it lies where it is strongest. Between the steps, by a parabola.
  std::size_t at = best;
  for (std::size_t k = best >= kApart ? best - kApart : 0; k < std::min(scan.sharp.size(), best + kApart + 1); ++k)
    if (scan.step[k] >= kSameEdge * scan.step[best] && scan.sharp[k] > scan.sharp[at]) at = k;
  double by = 0;
  if (at > 0 && at + 1 < scan.sharp.size()) {
    const double l = static_cast<double>(scan.sharp[at - 1]), m = static_cast<double>(scan.sharp[at]),
                 r = static_cast<double>(scan.sharp[at + 1]);
    if (const double bend = l - 2 * m + r; bend < 0) by = std::clamp((l - r) / 2 / bend, -0.5, 0.5);
  }
  out.length = (static_cast<double>(at) + by) * kShadowStep;
  return out;
}

}  // namespace blockrand::observation
