#include "pipeline/observation/shadow_heights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "pipeline/base/parallel.h"
#include "pipeline/base/portable_math.h"

namespace blockrand::observation {

namespace {

using model::Point2;

/// Degrees to both sides of where the sunny sides point, and between the directions that are tried; how many houses try.
constexpr double kDoubt = 24, kAngleStep = 4;
constexpr std::size_t kAngleSample = 300;
/// m: of height, and of shadow for each metre, that are looked at before anything is known: the sun of aerial images
/// stands 20 to 65 degrees high.
constexpr double kLowest = 2, kLeastPerMetre = 0.45, kMostPerMetre = 2.8;
/// m of shadow that is looked for behind a house of a guessed height, as multiples of its usual length.
constexpr double kShortest = 0.25, kLongest = 4;
/// What a place is worth where the image shows the roof by its edges alone, as clearness of a shadow.
constexpr double kPlaceValue = 0.15;
/// Places that are tried have this weight at least.
constexpr double kLeastPlace = 0.08;
/// m of ground beyond the longest shadow that its end is compared with; m about a house within which it is sighted.
constexpr double kBeyond = 2.5, kSightingMargin = 9;
/// m between an edge and its shadow for each metre of height: where the image shows them nearer it shows no shadow.
constexpr double kLeastApart = 0.2;
/// A shadow as clear as this speaks for the sun.
constexpr double kClearStep = 0.1;
/// Of a height, as its share: of what is less sure nobody measured or counted anything.
constexpr double kTagged = 0.2;
/// Ratios of shadow to height that agree differ by this factor at most; of all ratios, by clearness: fewer that agree are
/// chance, as in streets where every shadow ends at the house opposite.
constexpr double kAgreeingRatios = 1.4, kLeastAgreeing = 0.48;
/// Houses by whose heights the sun's is measured.
constexpr std::size_t kFewestTagged = 12, kFewestGuessed = 20;

Point2 turned(Point2 p, double degrees) {
  const base::SinCos a = base::sin_cos(degrees * base::kRadiansPerDegree);
  return {p.x * a.cos - p.y * a.sin, p.x * a.sin + p.y * a.cos};
}

double size_of(Point2 p) { return std::sqrt(p.x * p.x + p.y * p.y); }

class Measurer {
 public:
  Measurer(const ShadowInputs& in, const LeanField& field) : in_(in), field_(field) {}

  ShadowHeights run(const ImageSun& known) {
    ShadowHeights out;
    out.sun = known;
    out.buildings.resize(in_.sighted.size());
    std::vector<std::optional<ShadowLength>> found(in_.sighted.size());
    if (!out.sun.towards) {
      const std::optional<Point2> first = sunny_side();
      if (!first) return out;
      out.sun.towards = refined(*first);
      for_all([&](std::uint32_t b) {
        Scanned house = scanned(b, longest_unknown(b));
        found[b] = unknown_length(b, *out.sun.towards, house);
      });
      measure_sun(found, true, out.sun);
    }
    if (out.sun.per_metre <= 0) return out;
    for_all([&](std::uint32_t b) { found[b] = best_length(b, *out.sun.towards, out.sun.per_metre); });
    measure_sun(found, false, out.sun);
    if (out.sun.per_metre <= 0) return out;
    for (std::uint32_t b = 0; b < found.size(); ++b)
      if (found[b]) out.buildings[b] = {*found[b], found[b]->length / apart(b, out.sun)};
    return out;
  }

 private:
  bool is_seen(std::uint32_t b) const { return in_.sighted[b].sightings[0].weight > 0; }

  template <class Work>
  void for_all(const Work& work) const {
    base::ordered_parallel(
        in_.sighted.size(), in_.workers, static_cast<std::size_t>(in_.workers) * 16,
        [&](std::size_t n) {
          if (is_seen(static_cast<std::uint32_t>(n))) work(static_cast<std::uint32_t>(n));
        },
        [](std::size_t) {});
  }

  Patch patch_of(const SearchedOutline& o, double reach) const { return in_.windows.window(o.box, reach); }

  std::optional<Point2> sunny_side() const {
    std::vector<SunnySides> sides(in_.sighted.size());
    for_all([&](std::uint32_t b) {
      const SearchedOutline o = in_.outline(b);
      sides[b].add(o.pieces, patch_of(o, 14), in_.sighted[b].sightings[0].at);
    });
    SunnySides sum;
    for (const SunnySides& s : sides) sum.add(s);
    return sum.to_sun();
  }

  /// Lean of a building for each metre of its height.
  Point2 lean_of(std::uint32_t b) const { return field_.per_metre(in_.sighted[b].place).value_or(Point2{}); }

  /// m between an edge and its shadow for each metre of height.
  double apart(std::uint32_t b, const ImageSun& sun) const {
    const Point2 k = lean_of(b);
    return size_of({-sun.towards->x * sun.per_metre - k.x, -sun.towards->y * sun.per_metre - k.y});
  }

  std::vector<Obstacles> obstacles_of(std::uint32_t b, Point2 roof, double reach) const {
    std::vector<Obstacles> out;
    for (const std::uint32_t other : in_.index.near(in_.footprints[b].box, reach)) {
      const Point2 by = other == b ? roof : Point2{};
      Obstacles o;
      o.box = in_.footprints[other].box;
      o.box.minimum.x += by.x, o.box.maximum.x += by.x, o.box.minimum.y += by.y, o.box.maximum.y += by.y;
      in_.footprints.for_each_ring(other, [&](std::span<const Point2> ring, bool) {
        o.rings.emplace_back(ring.begin(), ring.end());
        for (Point2& p : o.rings.back()) p.x += by.x, p.y += by.y;
      });
      out.push_back(std::move(o));
    }
    return out;
  }

  /// A house, its surroundings in the image, and what stands there, for any direction of the shadows.
  struct Scanned {
    SearchedOutline outline;
    Brightness patch;
    double reach = 0;                                                        ///< m of shadow
    std::array<std::optional<std::vector<Obstacles>>, kMostSightings> near;  ///< by place of the house
  };

  Scanned scanned(std::uint32_t b, double most) const {
    const double reach = most + kBeyond;
    SearchedOutline outline = in_.outline(b);
    Brightness patch(patch_of(outline, reach + kPieceLength / 2 + kSightingMargin));
    return {std::move(outline), std::move(patch), reach, {}};
  }

  /// m of shadow that are looked for before anything is known.
  double longest_unknown(std::uint32_t b) const {
    return std::min(kLongestShadow, in_.heights[b] * kMostPerMetre * 1.3);
  }

  /// Unit vector from a roof's edge to its shadow in the image, and m between them for each metre of height.
  std::pair<Point2, double> away_of(std::uint32_t b, Point2 towards, double per_metre) const {
    const Point2 k = lean_of(b), away{-towards.x * per_metre - k.x, -towards.y * per_metre - k.y};
    const double apart = size_of(away);
    return {apart > 0 ? Point2{away.x / apart, away.y / apart} : away, apart};
  }

  /// The clearest end of a shadow, nobody knows how long they are. \param house  with reach for longest_unknown()
  std::optional<ShadowLength> unknown_length(std::uint32_t b, Point2 towards, Scanned& house) const {
    const auto [away, apart] = away_of(b, towards, 1);
    constexpr double kLeast = kLowest * kLeastPerMetre;
    if (apart < kLeastApart || longest_unknown(b) <= kLeast) return std::nullopt;
    return shadow_length(scan(b, 0, away, house), kLeast, longest_unknown(b), 0);
  }

  /// The same with the usual length known, for the places where the image shows the house.
  std::optional<ShadowLength> best_length(std::uint32_t b, Point2 towards, double per_metre) const {
    const SightedOutline& s = in_.sighted[b];
    const auto [away, apart] = away_of(b, towards, per_metre);
    if (apart < kLeastApart) return std::nullopt;
    const double least = std::max(kLowest * apart, in_.heights[b] * apart * kShortest),
                 most = std::min(kLongestShadow, in_.heights[b] * apart * kLongest);
    if (most <= least) return std::nullopt;
    Scanned house = scanned(b, most);
    std::optional<ShadowLength> best;
    double best_value = 0;
    for (std::size_t n = 0; n < s.sightings.size() && s.sightings[n].weight >= kLeastPlace; ++n) {
      const auto found = shadow_length(scan(b, n, away, house), least, most, in_.heights[b] * apart);
      if (!found) continue;
      const double value = found->clearness + kPlaceValue * s.sightings[n].weight;
      if (!best || value > best_value) best = found, best_value = value;
    }
    return best;
  }

  ShadowScan scan(std::uint32_t b, std::size_t place, Point2 away, Scanned& house) const {
    const Point2 roof = in_.sighted[b].sightings[place].at;
    auto& near = house.near[place];
    if (!near) near = obstacles_of(b, roof, house.reach);
    return scan_shadow(house.outline.pieces, house.patch, roof, away, *near, house.reach);
  }

  /// The direction in which the shadows of all houses end most clearly.
  Point2 refined(Point2 first) const {
    std::vector<std::uint32_t> sample;
    for (std::uint32_t b = 0; b < in_.sighted.size(); ++b)
      if (is_seen(b)) sample.push_back(b);
    const std::size_t every = std::max<std::size_t>(1, (sample.size() + kAngleSample - 1) / kAngleSample);
    constexpr int kSteps = static_cast<int>(kDoubt / kAngleStep);
    std::vector<double> score(2 * kSteps + 1, 0.0);
    std::vector<std::vector<double>> own(sample.size() / every + 1);
    base::ordered_parallel(
        own.size(), in_.workers, static_cast<std::size_t>(in_.workers) * 16,
        [&](std::size_t n) {
          if (n * every >= sample.size()) return;
          const std::uint32_t b = sample[n * every];
          Scanned house = scanned(b, longest_unknown(b));
          for (int k = -kSteps; k <= kSteps; ++k) {
            const auto found = unknown_length(b, turned(first, k * kAngleStep), house);
            own[n].push_back(found ? std::max(0.0, found->clearness) : 0);
          }
        },
        [&](std::size_t n) {
          for (std::size_t k = 0; k < own[n].size(); ++k) score[k] += own[n][k];
        });
    // Each with its neighbours: walls of whole quarters run one way, and some direction along them may please by chance.
    std::vector<double> smooth = score;
    for (std::size_t k = 1; k + 1 < score.size(); ++k) smooth[k] = (score[k - 1] + 2 * score[k] + score[k + 1]) / 4;
    std::size_t best = 1;
    for (std::size_t k = 1; k + 1 < smooth.size(); ++k)
      if (smooth[k] > smooth[best]) best = k;
    const double l = smooth[best - 1], m = smooth[best], r = smooth[best + 1];
    const double bend = l - 2 * m + r, by = bend < 0 ? std::clamp((l - r) / 2 / bend, -0.5, 0.5) : 0;
    return turned(first, (static_cast<double>(best) + by - kSteps) * kAngleStep);
  }

  /// A house's length of shadow for each metre of its height, and what it counts.
  struct Ratio {
    double value, weight;
    friend auto operator<=>(const Ratio&, const Ratio&) = default;
  };

  /// m of shadow for each metre of height: where the ratios of most houses lie, of those whose heights are tagged, else of
  /// all. Shadows that end at the next house, or on it, lie anywhere. \param first  lengths were not looked for near those
  /// that are usual: how many agree says whether there are shadows at all
  void measure_sun(const std::vector<std::optional<ShadowLength>>& found, bool first, ImageSun& sun) const {
    std::vector<Ratio> tagged, guessed;
    for (std::uint32_t b = 0; b < found.size(); ++b) {
      if (!found[b] || found[b]->clearness < kClearStep) continue;
      // |s - k| = length / height: s along the known direction, k known.
      const double ratio = found[b]->length / in_.heights[b];
      const Point2 k = lean_of(b), away{-sun.towards->x, -sun.towards->y};
      const double along = k.x * away.x + k.y * away.y, across = k.x * away.y - k.y * away.x;
      if (ratio * ratio < across * across) continue;
      const double value = along + std::sqrt(ratio * ratio - across * across);
      if (value < kLeastPerMetre || value > kMostPerMetre) continue;
      (in_.uncertainty[b] > kTagged ? guessed : tagged).push_back({value, found[b]->clearness});
    }
    const bool by_tags = tagged.size() >= kFewestTagged;
    std::vector<Ratio>& chosen = by_tags ? tagged : guessed;
    sun.houses = chosen.size(), sun.tagged = by_tags, sun.per_metre = 0;
    if (!by_tags && guessed.size() < kFewestGuessed) return;
    std::sort(chosen.begin(), chosen.end());
    double all = 0, best = 0, within = 0;
    std::size_t from = 0, best_from = 0, best_to = 0;
    for (const Ratio& r : chosen) all += r.weight;
    for (std::size_t to = 0; to < chosen.size(); ++to) {
      within += chosen[to].weight;
      while (chosen[from].value * kAgreeingRatios < chosen[to].value) within -= chosen[from++].weight;
      if (within > best) best = within, best_from = from, best_to = to;
    }
    if (first && best < kLeastAgreeing * all) return;
    const double middle = chosen[(best_from + best_to) / 2].value;
    sun.per_metre = middle;
    sun.uncertainty = (kAgreeingRatios - 1) / 2 / std::sqrt(static_cast<double>(best_to - best_from + 1));
  }

  const ShadowInputs& in_;
  const LeanField& field_;
};

}  // namespace

ShadowHeights measure_shadows(const ShadowInputs& in, const LeanField& field, const ImageSun& sun) {
  return Measurer(in, field).run(sun);
}

}  // namespace blockrand::observation
