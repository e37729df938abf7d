#include "pipeline/surroundings/stair_bodies.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "pipeline/base/portable_math.h"
#include "pipeline/model/osm_keys.h"
#include "pipeline/surroundings/line_strips.h"
#include "pipeline/surroundings/street_profile.h"

namespace blockrand::surroundings {
namespace {

using model::FlatPolygon;
using model::Point2;
using model::Point3;
namespace osm_key = model::osm_key;

// m. Outdoor stairs [DIN 18065 and RASt 06: rise 14 to 16 cm, going 28 to 34 cm].
constexpr double kRise = 0.15, kGoing = 0.30;
/// m: risers that `step_count` may tell; others belong to another stretch of the way.
constexpr double kLeastRise = 0.08, kMostRise = 0.25;
/// m a metre: the steepest flight, risers of 15 on goings of 25 cm.
constexpr double kSteepest = 0.6;
/// m: a rise of less is that of a sloping pavement, not of steps.
constexpr double kLeastFlight = 0.25;
/// m: how far treads may lie above the ground; farther, the way rises and falls.
constexpr double kMostAbove = 0.75;
/// m: treads lie this much above the ground they touch, so that neither flickers through the other.
constexpr double kAbove = 0.01;
/// m: samples of the ground along the way.
constexpr double kSample = 0.1;
/// m. A longer way is no flight; on level ground what stands at its end must be near.
constexpr double kMostLength = 500, kMostLevelLength = kLongest;
/// m: how near a building stands to the end of a flight that leads to it.
constexpr double kAtBuilding = 1.5;
/// m: what counts as touching a wall: places of nodes are told to a centimetre.
constexpr double kTouch = 0.02;
/// m: how deep treads reach into the ground.
constexpr double kSunk = 0.3;

/// A number, with a percent sign or a degree sign behind it; nothing for words.
std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  const std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (rest == "°") return 100 * base::tan(std::clamp(value, -60.0, 60.0) * base::kRadiansPerDegree);
  if (rest.empty() || rest == "%" || rest == " %") return value;
  return std::nullopt;
}

class Stairs {
 public:
  Stairs(const BodySite& site, const Thing& thing) : site_(site), tag_(site.claims.tags_of(thing.feature)) {}

  std::vector<FlatPolygon> make(const std::vector<Point2>& mapped, double left, double right) {
    OffsetLine line(mapped);
    if (line.length() < kGoing || line.length() > kMostLength) return {};
    const double rise = site_.terrain_height(mapped.back()) - site_.terrain_height(mapped.front());
    const bool level = std::fabs(rise) < kLeastFlight;
    const bool up = level ? leads_up(line) : rise > 0;
    if (!up) {  // from below
      line = OffsetLine({mapped.rbegin(), mapped.rend()});
      left = -std::exchange(right, -left);
    }
    std::vector<double> ends = level ? level_treads(line) : treads_over_terrain(line, left, right);
    return ends.empty() ? std::vector<FlatPolygon>() : bodies(line, left, right, ends);
  }

 private:
  double step_count() const { return number_of(tag_(model::osm_key::kStepCount)).value_or(0); }

  bool is_at_building(Point2 p) const {
    constexpr double kDiagonal = 0.70710678118654752;
    constexpr double kAround[9][2] = {{0, 0},
                                      {1, 0},
                                      {-1, 0},
                                      {0, 1},
                                      {0, -1},
                                      {kDiagonal, kDiagonal},
                                      {-kDiagonal, kDiagonal},
                                      {kDiagonal, -kDiagonal},
                                      {-kDiagonal, -kDiagonal}};
    return std::ranges::any_of(kAround, [&](const double(&d)[2]) {
      return site_.claims.building_at({p.x + kAtBuilding * d[0], p.y + kAtBuilding * d[1]});
    });
  }

  /// On level ground: whether the end of the way is its upper one.
  bool leads_up(const OffsetLine& line) const {
    const std::string_view incline = tag_(model::osm_key::kIncline);
    if (incline == "up" || incline == "down") return incline == "up";
    if (const auto told = number_of(incline); told && *told != 0) return *told > 0;
    return is_at_building(line.points().back());
  }

  /// Where treads end along a way of which nothing but tags tells that it rises; empty: they tell nothing.
  std::vector<double> level_treads(const OffsetLine& line) {
    const double length = line.length();
    if (length > kMostLevelLength) return {};
    double count = std::round(step_count());
    if (!(count > 0))
      if (const auto told = number_of(tag_(model::osm_key::kIncline)))
        count = std::round(std::fabs(*told) / 100 * length / kRise);
    if (!(count >= 1) || count * kRise > kSteepest * length) return {};
    if (!is_at_building(line.points().back()) || is_at_building(line.points().front())) return {};
    low_ = site_.terrain_height(line.points().front()), rise_ = kRise;
    std::vector<double> ends;
    for (double k = 1; k <= count; ++k) ends.push_back(length * k / count);
    return ends;
  }

  std::vector<double> treads_over_terrain(const OffsetLine& line, double left, double right) {
    const double length = line.length();
    const auto samples = static_cast<std::size_t>(std::ceil(length / kSample));
    std::vector<double> ground(samples + 1);
    std::size_t segment = 0;
    for (std::size_t i = 0; i <= samples; ++i) {
      const double s = length * static_cast<double>(i) / static_cast<double>(samples);
      while (segment + 2 < line.size() && line.along(segment + 1) < s) ++segment;
      const Point2 a = line.points()[segment], b = line.points()[segment + 1];
      const double own = line.along(segment + 1) - line.along(segment);
      const Point2 d{(b.x - a.x) / own, (b.y - a.y) / own};
      const Point2 p{a.x + (s - line.along(segment)) * d.x, a.y + (s - line.along(segment)) * d.y};
      ground[i] = site_.terrain_height(p);
      for (const double side : {left, right})
        ground[i] = std::max(ground[i], site_.terrain_height({p.x + side * d.y, p.y - side * d.x}));
    }
    // What lies nowhere below the ground, falls nowhere and is nowhere too steep.
    std::vector<double> above = ground;
    const double step = length / static_cast<double>(samples);
    for (std::size_t i = samples; i-- > 0;) above[i] = std::max(above[i], above[i + 1] - kSteepest * step);
    for (std::size_t i = 1; i <= samples; ++i) above[i] = std::max(above[i], above[i - 1]);
    for (std::size_t i = 0; i <= samples; ++i)
      if (above[i] - ground[i] > kMostAbove) return {};
    low_ = site_.terrain_height(line.points().front());
    const double height = above.back() - low_, told = std::round(step_count());
    double count = std::max(1.0, std::round(height / kRise));
    if (told >= 1 && height / told >= kLeastRise && height / told <= kMostRise) count = told;
    rise_ = height / count;
    std::vector<double> ends;
    std::size_t at = 0;
    for (double k = 1; k < count; ++k) {
      while (at < samples && above[at + 1] <= low_ + k * rise_) ++at;
      ends.push_back(static_cast<double>(at) * step);
    }
    ends.push_back(length);
    return ends;
  }

  std::vector<FlatPolygon> bodies(const OffsetLine& way, double left, double right, const std::vector<double>& ends) {
    std::vector<Point2> points{way.points().front()};
    std::vector<std::size_t> tread;  // of each segment
    std::size_t next = 0;
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      const Point2 a = way.points()[i], b = way.points()[i + 1];
      const double from = way.along(i), to = way.along(i + 1);
      const auto add = [&](Point2 p) {
        if (p == points.back()) return;
        points.push_back(p), tread.push_back(next);
      };
      for (; next + 1 < ends.size() && ends[next] < to; ++next) {
        const double t = (ends[next] - from) / (to - from);
        if (t > 0) add(model::snap(Point2{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}));
      }
      add(b);
    }
    const OffsetLine line(points);
    struct Step {
      bool taken = false;
      Point2 l0, r0, l1, r1;
      double top = 0;
    };
    std::vector<Step> steps;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      Step step{.l0 = line.beside(i, left, i),
                .r0 = line.beside(i, right, i),
                .l1 = line.beside(i + 1, left, i),
                .r1 = line.beside(i + 1, right, i),
                .top = model::snap(low_ + static_cast<double>(tread[i] + 1) * rise_ + kAbove)};
      step.taken = is_free(points[i], points[i + 1], {step.l0, step.r0, step.l1, step.r1});
      steps.push_back(step);
    }
    std::vector<FlatPolygon> out;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Step& s = steps[i];
      if (!s.taken) continue;
      const double foot = model::snap(std::min({site_.terrain_height(s.l0), site_.terrain_height(s.r0),
                                                site_.terrain_height(s.l1), site_.terrain_height(s.r1)}) -
                                      kSunk);
      const auto at = [](Point2 p, double z) { return Point3{p.x, p.y, z}; };
      add_quad(out, at(s.r0, s.top), at(s.r1, s.top), at(s.l1, s.top), at(s.l0, s.top));
      add_quad(out, at(s.r0, foot), at(s.r1, foot), at(s.r1, s.top), at(s.r0, s.top));
      add_quad(out, at(s.l1, foot), at(s.l0, foot), at(s.l0, s.top), at(s.l1, s.top));
      const double below = i > 0 && steps[i - 1].taken ? steps[i - 1].top : foot;
      if (below < s.top) add_quad(out, at(s.l0, below), at(s.r0, below), at(s.r0, s.top), at(s.l0, s.top));
      if (i + 1 == steps.size() || !steps[i + 1].taken)
        add_quad(out, at(s.r1, foot), at(s.l1, foot), at(s.l1, s.top), at(s.r1, s.top));
    }
    return out;
  }

  /// Whether a tread may lie between two points of the way: within the tile, on ground of steps, and not folded by a bend.
  bool is_free(Point2 a, Point2 b, const std::array<Point2, 4>& corners) const {
    const Point2 middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
    if (!site_.is_own(middle)) return false;
    const auto forward = [&](Point2 from, Point2 to) {
      return (to.x - from.x) * (b.x - a.x) + (to.y - from.y) * (b.y - a.y) > 0;
    };
    if (!forward(corners[0], corners[2]) || !forward(corners[1], corners[3])) return false;
    using enum model::GroundClass;
    if (const GroundAt at = site_.ground(middle); at.building || at.ground != steps) return false;
    return std::ranges::none_of(corners, [&](Point2 corner) {
      // A tread that ends at a wall touches it.
      const double dx = middle.x - corner.x, dy = middle.y - corner.y, f = kTouch / std::hypot(dx, dy);
      const GroundAt at = site_.ground({corner.x + f * dx, corner.y + f * dy});
      return at.building || at.ground == carriageway || at.ground == parking_lane || at.ground == rail_bed ||
             at.ground == water;
    });
  }

  const BodySite& site_;
  TagOf tag_;
  double low_ = 0, rise_ = 0;  ///< m: height of the lower end; of a riser
};

}  // namespace

std::optional<model::SurroundingBody> stair_bodies(const BodySite& site, const Thing& thing) {
  const TagOf tag = site.claims.tags_of(thing.feature);
  const std::optional<StreetProfile> profile = street_profile(tag, true, site.in.catalogue, false);
  if (tag(osm_key::kHighway) != "steps" || !profile || profile->strips.empty()) return std::nullopt;
  std::vector<FlatPolygon> faces;
  for (const std::vector<Point2>& line : site.claims.lines_of(thing)) {
    if (line.size() < 2 || !geometry::box_of(line).near(site.around, 0)) continue;
    std::vector<FlatPolygon> of_line =
        Stairs(site, thing).make(line, profile->strips.front().left, profile->strips.back().right);
    std::ranges::move(of_line, std::back_inserter(faces));
  }
  if (faces.empty()) return std::nullopt;
  model::SurroundingBody made = body_of(site, thing, model::BodyClass::stairs, "stone");
  made.material = profile->strips.front().material;
  made.faces = std::move(faces);
  return made;
}

}  // namespace blockrand::surroundings
