#include "pipeline/observation/unmapped.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "pipeline/base/parallel.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/even_odd.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/observation/eaves.h"
#include "pipeline/observation/image_regions.h"
#include "pipeline/observation/mixed_bits.h"
#include "pipeline/observation/plan_rectangle.h"
#include "pipeline/observation/roof_colours.h"

namespace blockrand::observation {

namespace {

using model::Point2;

/// m: side of a square of the grid that is searched at once; around it, so that a hall at its edge is seen whole.
constexpr double kSquare = 192, kMargin = 48;
/// m: about mapped buildings; squares farther away are not searched.
constexpr double kNear = 40;
/// Mapped houses that colours are learnt from, at most; m about each that is ground.
constexpr std::size_t kColourSample = 300;
constexpr double kGround = 8;
/// RoofColours: a pixel that is rarer on roofs belongs to none: lawn, shadow.
constexpr float kNoRoof = -1.6F;
/// m2: of a region that goes on its own with no other; of a part of a roof of several.
constexpr double kLeastRegion = 3, kLeastPart = 8;
/// RoofColours: of a region's mean colour, at least. Parts of a plan: a hipped roof has four slopes.
constexpr float kLikeRoofs = -0.7F;
constexpr std::size_t kMostParts = 4;
/// Of a rectangle that a region fills, at least; m of its shorter side; its sides' ratio.
constexpr double kLeastFilled = 0.62, kNarrowest = 3.2, kLongest = 7;
/// Of the shorter side of the smaller of two regions: a ridge between them is as long.
constexpr double kLeastBorder = 0.5;
/// Levels of 255, as score_outline() has it.
constexpr double kContrast = 12;
/// m: around a rectangle, where its edge itself belongs to neither.
constexpr double kAroundFrom = 0.5, kAroundTo = 3;
/// Cosine: sides that turn to the sun or away from it.
constexpr double kFacing = 0.35;
/// m: by how much fit_to_edges() may move a middle, and more.
constexpr double kFitted = 2;
/// Of the smaller of two outlines.
constexpr double kSamePlace = 0.25;
/// Of a rectangle: more of it on what is mapped, and it is that.
constexpr double kMostMapped = 0.3;
/// Probability below which nothing is kept.
constexpr double kLeastKept = 0.02;
/// Probability from which on a candidate is as good as any other.
constexpr double kLikely = 0.85;
/// Levels: of brightness, where it divides.
constexpr double kDark = 25;

double brightness(const Patch& p, std::size_t i) { return (2.0 * p.red[i] + 5.0 * p.green[i] + p.blue[i]) / 8; }

/// As roof_view.cpp has it.
bool is_green(const Patch& p, std::size_t i) {
  const double red = p.red[i], green = p.green[i], blue = p.blue[i];
  return 2 * green - red - blue > 0.05 * (red + green + blue) && green > 1.1 * blue && green >= red;
}

double rounded(double value, double steps) { return std::round(value * steps) / steps + 0.0; }

/// Area of what two convex rings have in common (Sutherland, Hodgman, "Reentrant polygon clipping", 1974).
double common_area(std::vector<Point2> a, const std::vector<Point2>& b) {
  std::vector<Point2> next;
  for (std::size_t i = 0; i < b.size() && !a.empty(); ++i) {
    const Point2 p = b[i], q = b[(i + 1) % b.size()];
    const auto side = [&](Point2 x) { return (q.x - p.x) * (x.y - p.y) - (q.y - p.y) * (x.x - p.x); };
    next.clear();
    for (std::size_t k = 0; k < a.size(); ++k) {
      const Point2 x = a[k], y = a[(k + 1) % a.size()];
      const double s = side(x), t = side(y);
      if (s >= 0) next.push_back(x);
      if ((s >= 0) != (t >= 0)) next.push_back({x.x + (y.x - x.x) * s / (s - t), x.y + (y.y - x.y) * s / (s - t)});
    }
    a.swap(next);
  }
  return a.size() < 3 ? 0 : std::fabs(geometry::signed_area(a));
}

/// A part of a patch. \param columns, rows  from, to
Patch cut(const Patch& from, int west, int east, int north, int south) {
  Patch out;
  out.size = from.size, out.width = east - west, out.height = south - north;
  out.west = from.west + west * from.size, out.north = from.north - north * from.size;
  for (int r = north; r < south; ++r) {
    const auto first = static_cast<std::ptrdiff_t>(r) * from.width + west, last = first + out.width;
    const auto copy = [&](const std::vector<std::uint8_t>& a, std::vector<std::uint8_t>& b) {
      b.insert(b.end(), a.begin() + first, a.begin() + last);
    };
    copy(from.red, out.red), copy(from.green, out.green), copy(from.blue, out.blue), copy(from.valid, out.valid);
  }
  return out;
}

/// What the roofs of an image have in common.
struct ImageRoofs {
  RoofColours colours;
  double brightness = 128;  ///< mean
};

/// A square of the grid with what is known of its pixels.
struct Window {
  Patch patch;
  std::vector<Mapped> mapped;
};

/// Sums over pixels.
struct Sums {
  double count = 0, b = 0, leaves = 0, mapped = 0, likeness = 0;
};

void add(Sums& s, const Window& w, std::size_t i, const RoofColours& colours) {
  s.count += 1, s.b += brightness(w.patch, i);
  s.leaves += is_green(w.patch, i), s.mapped += w.mapped[i] != Mapped::nothing;
  s.likeness += static_cast<double>(colours.likeness(w.patch.red[i], w.patch.green[i], w.patch.blue[i]));
}

class Searcher {
 public:
  explicit Searcher(const UnmappedSearch& in)
      : in_(in),
        ground_(
            in.extract, in.footprints, in.index, in.projection,
            [&in](std::uint32_t b) {
              return in.field.at(in.footprints[b].box.centre(), in.eaves[b]).value_or(Point2{});
            },
            in.field.shift()) {}

  std::vector<UnmappedBuilding> run() {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> houses;
    model::Ring middles;
    std::set<std::pair<long long, long long>> squares;
    for (std::uint32_t b = 0; b < in_.footprints.size(); ++b) {
      const geometry::PlanBox& box = in_.footprints[b].box;
      if (box.empty() || !in_.in_image(b)) continue;
      houses.emplace_back(mixed(static_cast<std::uint64_t>(in_.footprints[b].id.number)), b);
      middles.points.push_back(box.centre()), middles.nodes.push_back(0);
      const auto square = [](double v) { return static_cast<long long>(std::floor(v / kSquare)); };
      for (long long x = square(box.minimum.x - kNear); x <= square(box.maximum.x + kNear); ++x)
        for (long long y = square(box.minimum.y - kNear); y <= square(box.maximum.y + kNear); ++y)
          squares.emplace(x, y);
    }
    if (houses.size() < 3) return {};
    hull_ = geometry::convex_hull(middles);
    std::sort(houses.begin(), houses.end());
    if (houses.size() > kColourSample) houses.resize(kColourSample);
    learn(houses);
    const std::vector<std::pair<long long, long long>> all(squares.begin(), squares.end());
    std::vector<std::vector<UnmappedBuilding>> found(all.size());
    std::vector<UnmappedBuilding> out;
    base::ordered_parallel(
        all.size(), in_.workers, static_cast<std::size_t>(in_.workers) * 4,
        [&](std::size_t k) { found[k] = search(all[k]); },
        [&](std::size_t k) { std::ranges::move(std::exchange(found[k], {}), std::back_inserter(out)); });
    return without_overlaps(std::move(out));
  }

 private:
  /// Colours of mapped roofs, and of the ground about them.
  void learn(const std::vector<std::pair<std::uint64_t, std::uint32_t>>& houses) {
    struct Looked {
      Patch patch;
      std::vector<std::uint8_t> kinds;
    };
    std::vector<Looked> looked(houses.size());
    std::uint64_t count = 0, sum = 0;
    base::ordered_parallel(
        houses.size(), in_.workers, static_cast<std::size_t>(in_.workers) * 8,
        [&](std::size_t k) {
          const std::uint32_t b = houses[k].second;
          Looked& l = looked[k];
          l.patch = in_.windows.window(in_.footprints[b].box, kGround);
          std::vector<std::span<const Point2>> rings;
          in_.footprints.for_each_ring(b, [&](std::span<const Point2> ring, bool) { rings.push_back(ring); });
          l.kinds.assign(l.patch.valid.size(), 0);
          fill_rings(l.patch, rings, ground_.lean(b), l.kinds);
          const std::vector<Mapped> mapped = ground_.on(l.patch);
          for (std::size_t i = 0; i < mapped.size(); ++i)
            if (mapped[i] != Mapped::building) l.kinds[i] = 2;
        },
        [&](std::size_t k) {
          const Looked l = std::exchange(looked[k], {});
          roofs_.colours.learn(l.patch, l.kinds);
          for (std::size_t i = 0; i < l.kinds.size(); ++i)
            if (l.kinds[i] == 1 && l.patch.valid[i])
              ++count, sum += static_cast<std::uint64_t>(2 * l.patch.red[i] + 5 * l.patch.green[i] + l.patch.blue[i]);
        });
    roofs_.colours.settle();
    if (count > 0) roofs_.brightness = static_cast<double>(sum) / 8 / static_cast<double>(count);
  }

  std::vector<UnmappedBuilding> search(std::pair<long long, long long> square) const {
    const Point2 corner{static_cast<double>(square.first) * kSquare, static_cast<double>(square.second) * kSquare};
    Window w;
    w.patch = in_.windows.window({corner, {corner.x + kSquare, corner.y + kSquare}}, kMargin);
    if (std::ranges::none_of(w.patch.valid, [](std::uint8_t v) { return v != 0; })) return {};
    w.mapped = ground_.on(w.patch);
    std::vector<std::uint8_t> open(w.mapped.size(), 0);
    for (std::size_t i = 0; i < open.size(); ++i)
      open[i] = w.patch.valid[i] && w.mapped[i] == Mapped::nothing && !is_green(w.patch, i) &&
                roofs_.colours.likeness(w.patch.red[i], w.patch.green[i], w.patch.blue[i]) > kNoRoof;
    const double pixel = w.patch.size * w.patch.size;
    const ImageRegions regions =
        grow_regions(w.patch, open, static_cast<std::uint32_t>(std::ceil(kLeastRegion / pixel)));
    std::vector<UnmappedBuilding> found;
    // Fitting moves a middle by little: what surely belongs to another square is left to it.
    const auto here = [&](Point2 p, double beyond) {
      return p.x >= corner.x - beyond && p.x < corner.x + kSquare + beyond && p.y >= corner.y - beyond &&
             p.y < corner.y + kSquare + beyond;
    };
    const auto look = [&](std::span<const std::uint32_t> pixels) {
      const std::optional<FilledRectangle> filled = rectangle_of(w.patch, pixels);
      if (!filled || filled->filled < kLeastFilled || !fits(filled->rectangle)) return;
      if (!here(filled->rectangle.centre, kFitted)) return;
      std::optional<UnmappedBuilding> one = measure(w, *filled);
      if (one && here(roof_middle(*one), 0)) found.push_back(std::move(*one));
    };
    const auto pixels_of = [&](std::uint32_t r) {
      return std::span(regions.pixels).subspan(regions.regions[r].first, regions.regions[r].count);
    };
    for (const std::vector<std::uint32_t>& parts : plans_of(w, regions)) {
      std::vector<std::uint32_t> pixels;
      for (const std::uint32_t r : parts) {
        const auto own = pixels_of(r);
        pixels.insert(pixels.end(), own.begin(), own.end());
      }
      if (parts.size() > 1) std::ranges::sort(pixels);
      look(pixels);
    }
    return without_overlaps(std::move(found));
  }

  /// Regions, and neighbours together, that may be the plan of a building: each of the lists once.
  std::set<std::vector<std::uint32_t>> plans_of(const Window& w, const ImageRegions& regions) const {
    const double pixel = w.patch.size * w.patch.size;
    const auto area = [&](std::uint32_t r) { return regions.regions[r].count * pixel; };
    std::set<std::vector<std::uint32_t>> plans;
    std::vector<std::vector<std::uint32_t>> neighbours(regions.regions.size());
    std::vector<bool> like(regions.regions.size());
    for (std::uint32_t r = 0; r < regions.regions.size(); ++r) {
      const ImageRegion& region = regions.regions[r];
      const auto level = [](double v) { return static_cast<std::uint8_t>(v); };
      like[r] = roofs_.colours.likeness(level(region.red), level(region.green), level(region.blue)) > kLikeRoofs &&
                area(r) <= kMostUnmapped;
      if (like[r] && area(r) >= kLeastUnmapped * kLeastFilled) plans.insert({r});
    }
    for (const RegionBorder& border : regions.borders) {
      if (!like[border.a] || !like[border.b]) continue;
      const double smaller = std::min(area(border.a), area(border.b));
      if (smaller < kLeastPart || border.length * w.patch.size < kLeastBorder * std::sqrt(smaller)) continue;
      neighbours[border.a].push_back(border.b), neighbours[border.b].push_back(border.a);
    }
    for (std::uint32_t seed = 0; seed < neighbours.size(); ++seed) {
      if (neighbours[seed].empty()) continue;
      std::vector<std::uint32_t> plan{seed};
      std::vector<std::uint32_t> own(
          regions.pixels.begin() + regions.regions[seed].first,
          regions.pixels.begin() + regions.regions[seed].first + regions.regions[seed].count);
      while (plan.size() < kMostParts) {
        // The neighbour with which it is most like a rectangle.
        double best = kLeastFilled;
        std::uint32_t with = 0;
        std::vector<std::uint32_t> pixels, best_pixels;
        std::set<std::uint32_t> tried(plan.begin(), plan.end());
        for (const std::uint32_t part : plan)
          for (const std::uint32_t n : neighbours[part]) {
            if (!tried.insert(n).second ||
                (static_cast<double>(own.size()) + regions.regions[n].count) * pixel > kMostUnmapped)
              continue;
            pixels.clear();
            std::ranges::merge(own,
                               std::span(regions.pixels).subspan(regions.regions[n].first, regions.regions[n].count),
                               std::back_inserter(pixels));
            const std::optional<FilledRectangle> filled = rectangle_of(w.patch, pixels);
            if (!filled || filled->filled <= best) continue;
            best = filled->filled, with = n;
            best_pixels.swap(pixels);
          }
        if (best_pixels.empty()) break;
        plan.insert(std::ranges::upper_bound(plan, with), with);
        own.swap(best_pixels);
        if (!plans.insert(plan).second) break;
      }
    }
    return plans;
  }

  static bool fits(const PlanRectangle& r) {
    return 2 * r.half_short >= kNarrowest && r.half_long <= kLongest * r.half_short && r.area() >= kLeastUnmapped &&
           r.area() <= kMostUnmapped;
  }
  static Point2 roof_middle(const UnmappedBuilding& u) {
    return {(u.outline[0].x + u.outline[2].x) / 2 + u.lean.x, (u.outline[0].y + u.outline[2].y) / 2 + u.lean.y};
  }

  std::optional<UnmappedBuilding> measure(const Window& whole, const FilledRectangle& filled) const {
    if (!geometry::contains(hull_.points, filled.rectangle.centre)) return std::nullopt;
    // The part of the window about it.
    constexpr double kReach = 5;
    const Patch& p = whole.patch;
    const double reach = filled.rectangle.radius() + kReach;
    const auto column = [&](double x) { return static_cast<int>(std::floor((x - p.west) / p.size)); };
    const auto row = [&](double y) { return static_cast<int>(std::floor((p.north - y) / p.size)); };
    const Point2 c = filled.rectangle.centre;
    const int west = std::max(0, column(c.x - reach)), east = std::min(p.width, column(c.x + reach) + 1),
              north = std::max(0, row(c.y + reach)), south = std::min(p.height, row(c.y - reach) + 1);
    Window w;
    w.patch = cut(p, west, east, north, south);
    for (int r = north; r < south; ++r) {
      const auto first = whole.mapped.begin() + static_cast<std::ptrdiff_t>(r) * p.width + west;
      w.mapped.insert(w.mapped.end(), first, first + w.patch.width);
    }
    const std::optional<EdgedRectangle> edged = fit_to_edges(filled.rectangle, w.patch, kContrast);
    if (!edged || !fits(edged->rectangle)) return std::nullopt;
    UnmappedBuilding out;
    UnmappedEvidence& e = out.evidence;
    e.score = edged->score, e.around = edged->around, e.filled = filled.filled;
    const PlanRectangle& r = edged->rectangle;
    e.area = r.area(), e.elongation = r.half_long / r.half_short;
    if (!look_around(w, r, e)) return std::nullopt;
    out.probability = rounded(unmapped_probability(e), 1000);
    if (out.probability < kLeastKept) return std::nullopt;
    place(r, out);
    return out;
  }

  /// Colours within and about a rectangle, and its shadow. False where the map has something on it.
  bool look_around(const Window& w, const PlanRectangle& r, UnmappedEvidence& e) const {
    Sums within, about;
    double before = 0, behind = 0, before_count = 0, behind_count = 0;
    for (int row = 0; row < w.patch.height; ++row)
      for (int column = 0; column < w.patch.width; ++column) {
        const auto i =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(w.patch.width) + static_cast<std::size_t>(column);
        if (!w.patch.valid[i]) continue;
        const double x = w.patch.west + (column + 0.5) * w.patch.size - r.centre.x,
                     y = w.patch.north - (row + 0.5) * w.patch.size - r.centre.y;
        const double s = x * r.along.x + y * r.along.y, t = y * r.along.x - x * r.along.y;
        const double beyond_s = std::fabs(s) - r.half_long, beyond_t = std::fabs(t) - r.half_short,
                     beyond = std::max(beyond_s, beyond_t);
        if (beyond < 0) add(within, w, i, roofs_.colours);
        if (beyond < kAroundFrom || beyond > kAroundTo) continue;
        add(about, w, i, roofs_.colours);
        if (!in_.to_sun || w.mapped[i] == Mapped::building || (beyond_s > 0 && beyond_t > 0)) continue;
        const Point2 outward = beyond_s > beyond_t
                                   ? Point2{s > 0 ? r.along.x : -r.along.x, s > 0 ? r.along.y : -r.along.y}
                                   : Point2{t > 0 ? -r.along.y : r.along.y, t > 0 ? r.along.x : -r.along.x};
        const double facing = outward.x * in_.to_sun->x + outward.y * in_.to_sun->y;
        if (facing > kFacing) before += brightness(w.patch, i), before_count += 1;
        if (facing < -kFacing) behind += brightness(w.patch, i), behind_count += 1;
      }
    if (within.count < 1 || about.count < 1 || within.mapped > kMostMapped * within.count) return false;
    e.likeness = within.likeness / within.count;
    e.green_around = about.leaves / about.count, e.mapped_around = about.mapped / about.count;
    e.brightness = within.b / within.count / (roofs_.brightness + kDark);
    if (before_count > 0 && behind_count > 0) {
      const double light = before / before_count, dark = behind / behind_count;
      e.shadow = (light - dark) / (light + dark + kDark);
    }
    return true;
  }

  /// Its outline, the lean undone as far as it is known for a house of this size.
  void place(const PlanRectangle& r, UnmappedBuilding& out) const {
    const std::optional<Point2> lean = in_.field.at(r.centre, usual_eaves(r.area(), false));
    out.of_roof = !lean || !in_.field.found();
    if (!out.of_roof) out.lean = {rounded(lean->x, 1000), rounded(lean->y, 1000)};
    for (const Point2 p : r.corners()) out.outline.push_back(model::snap(Point2{p.x - out.lean.x, p.y - out.lean.y}));
    out.image = in_.image;
    out.area = rounded(geometry::signed_area(out.outline), 10);
    const auto cell = [](double v) { return static_cast<long long>(std::floor(v / 2)); };
    out.id = fmt::format("u{}_{}", cell((out.outline[0].x + out.outline[2].x) / 2),
                         cell((out.outline[0].y + out.outline[2].y) / 2));
  }

  const UnmappedSearch& in_;
  MappedGround ground_;
  model::Ring hull_;
  ImageRoofs roofs_;
};

}  // namespace

double unmapped_probability(const UnmappedEvidence& e) {
  // Weights of a logistic regression (fit.py of tests/bench/imagery) on synthetic images with houses that omit.py left out
  // of the map.
  const double shadow = std::max(e.shadow, -0.2);
  const double sum = 0.09 + 0.94 * e.score + 1.44 * (e.score - e.around) + 3.43 * e.filled -
                     0.17 * base::log(e.elongation) + 2.87 * e.likeness - 2.94 * e.green_around -
                     0.94 * e.mapped_around + 4.48 * std::min(shadow, 0.4) + 1.43 * std::min(shadow - 0.1, 0.0) -
                     5.23 * std::clamp(e.brightness, 0.5, 1.2) + 1.05 * base::log(e.area / 100);
  return 1 / (1 + base::exp(-sum));
}

std::vector<UnmappedBuilding> find_unmapped(const UnmappedSearch& search) { return Searcher(search).run(); }

std::vector<UnmappedBuilding> without_overlaps(std::vector<UnmappedBuilding> candidates) {
  // Of those that are all likely the largest: half of a roof is as likely as the whole.
  std::ranges::sort(candidates, [](const UnmappedBuilding& a, const UnmappedBuilding& b) {
    const double p = std::min(a.probability, kLikely), q = std::min(b.probability, kLikely);
    return p != q ? p > q : std::tie(b.area, a.id, a.image) < std::tie(a.area, b.id, b.image);
  });
  std::vector<UnmappedBuilding> kept;
  std::map<std::pair<long long, long long>, std::vector<std::size_t>> near;  // squares of the longest outline's side
  constexpr double kSide = 200;  // m: sqrt(kMostUnmapped * kLongest) and more
  for (UnmappedBuilding& c : candidates) {
    const auto x = static_cast<long long>(std::floor(c.outline[0].x / kSide)),
               y = static_cast<long long>(std::floor(c.outline[0].y / kSide));
    bool free = true;
    for (long long i = x - 1; i <= x + 1 && free; ++i)
      for (long long j = y - 1; j <= y + 1 && free; ++j)
        if (const auto found = near.find({i, j}); found != near.end())
          for (const std::size_t k : found->second)
            free = free && kept[k].id != c.id &&
                   common_area(kept[k].outline, c.outline) <= kSamePlace * std::min(kept[k].area, c.area);
    if (!free) continue;
    near[{x, y}].push_back(kept.size());
    kept.push_back(std::move(c));
  }
  std::ranges::sort(kept, [](const UnmappedBuilding& a, const UnmappedBuilding& b) {
    return a.probability != b.probability ? a.probability > b.probability
                                          : std::tie(a.id, a.image) < std::tie(b.id, b.image);
  });
  return kept;
}

}  // namespace blockrand::observation
