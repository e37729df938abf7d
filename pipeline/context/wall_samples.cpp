#include "pipeline/context/wall_samples.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::context {

namespace {

using model::Point2;
using model::WallSegmentKind;

/// m. Rays begin this far before the wall: clear of its own rounding.
constexpr double kBefore = 0.02;
/// m. Yards and squares are asked this far before the wall: their outlines are as wrong as the walls'.
constexpr double kAsk = 0.45;
/// Rays of the fan that look straight ahead: up to 40 degrees to either side.
constexpr int kAhead = 3;

constexpr double kPushes[] = {4, 12};  ///< m before the wall: what surrounds a yard is seen from its ground
constexpr int kRaysAround = 20;
constexpr double kBeyondGap = 4;  ///< m beyond the end of a wall: there lies what the gap before it leads to
/// Cosine of 50 degrees: a wall that stands steeper to a street is a flank, no front. Chamfers have 45.
constexpr double kMinFrontCosine = 0.643;
/// m. Whatever its direction, a wall this near to a street's line stands at the street.
constexpr double kAtTheStreet = 8;

/// Unit vectors around a place, from the normal; none along it or across.
const std::array<Point2, kRaysAround>& around() {
  static const std::array<Point2, kRaysAround> turns = [] {
    std::array<Point2, kRaysAround> out;
    for (int i = 0; i < kRaysAround; ++i) {
      const base::SinCos t = base::sin_cos((i + 0.5) * 2 * base::kPi / kRaysAround);
      out[static_cast<std::size_t>(i)] = {t.cos, t.sin};
    }
    return out;
  }();
  return turns;
}

/// Whether so much is open that the place is no court whatever the rest of the rays meet, and that beyond doubt.
/// \param seen  rays by what they met, not yet divided  \param rays  of these, the rest included
bool is_open(const Enclosure& seen, int looked, int rays, const WallSegmentOptions& options) {
  Enclosure at_best = seen;
  at_best.others += rays - looked;
  at_best.divide(rays);
  return !at_best.is_court(options) && at_best.margin(options) >= Enclosure::kCertain;
}

/// Adds what is seen around a place.
/// \param before  rays that looked from other places, of `rays` in all
/// \returns false when the rest of the rays would change nothing
bool look_around(Point2 place, Point2 first, model::OsmId own, int before, int rays, const BuildingView& view,
                 const WallSegmentOptions& options, Enclosure& out) {
  for (const Point2 turn : around()) {
    if (is_open(out, before++, rays, options)) return false;
    const Point2 direction{first.x * turn.x - first.y * turn.y, first.y * turn.x + first.x * turn.y};
    const Sight sight = view.index->scene().look(place, direction, options.view, Obstacles::buildings);
    if (sight.street_piece != kNothing)
      out.street += 1;
    else if (sight.footprint != kNothing)
      (view.index->all().footprints[sight.footprint].id == own ? out.own : out.others) += 1;
  }
  return true;
}

/// Whether a gap leads to a street or to open ground, in one direction along it: most of a narrow view does, or the ground
/// behind the end of the gap is no court.
///
/// \param from      in the middle of the gap
/// \param to_end    m to the end of the wall
/// \param in_yard   the gap is known to belong to an open courtyard: only streets lead out
bool leads_out(Point2 from, Point2 along, double to_end, const OutlineEdge& edge, model::OsmId own, bool in_yard,
               const BuildingView& view, const WallSegmentOptions& options) {
  constexpr Point2 kTurns[] = {{0.9945, -0.1045}, {1, 0}, {0.9945, 0.1045}};  // cosine and sine of 6 degrees
  int open = 0;
  double wall = 0;
  for (const Point2 t : kTurns) {
    const Sight sight = view.index->scene().look(from, {along.x * t.x - along.y * t.y, along.y * t.x + along.x * t.y},
                                                 options.view, Obstacles::buildings);
    open += sight.street_piece != kNothing || (!in_yard && sight.footprint == kNothing);
    if (t.x == 1) wall = sight.wall;
  }
  if (open >= 2) return true;
  const double beyond = to_end + kBeyondGap;
  if (in_yard || wall < beyond + kBeyondGap) return false;
  Enclosure ground;
  look_around({from.x + along.x * beyond, from.y + along.y * beyond}, edge.outward, own, 0, kRaysAround, view, options,
              ground);
  ground.divide(kRaysAround);
  return !ground.is_court(options);
}

/// Whether a wall may have its front to the street that it sees.
bool may_front(const OutlineEdge& edge, const Sight& sight, const Scene& scene) {
  const StreetPiece& piece = scene.streets()[sight.street_piece];
  return piece.any_direction || sight.street <= kAtTheStreet ||
         std::fabs(piece.along.x * edge.along.x + piece.along.y * edge.along.y) >= kMinFrontCosine;
}

}  // namespace

geometry::BoxIndex yard_boxes(std::span<const std::uint32_t> yards, const VicinityIndex& index) {
  std::vector<geometry::PlanBox> boxes;
  for (const std::uint32_t y : yards) boxes.push_back({index.yards()[y].box.low, index.yards()[y].box.high});
  return geometry::BoxIndex(std::move(boxes));
}

BuildingView view_of(const model::Building& building, const VicinityIndex& index) {
  const VicinityIndex::Box box = box_of(building, 2 * kAsk);
  std::vector<std::uint32_t> yards = index.yards_near(box);
  geometry::BoxIndex boxes = yard_boxes(yards, index);
  return {&index, building.osm, std::move(yards), std::move(boxes), index.squares_near(box)};
}

WallSample look_out(const OutlineEdge& edge, double at, const BuildingView& view, const WallSegmentOptions& options) {
  const VicinityIndex& index = *view.index;
  WallSample out;
  out.at = at;
  const Point2 wall = edge.at(at);
  const Point2 eye{wall.x + edge.outward.x * kBefore, wall.y + edge.outward.y * kBefore};
  const Point2 front{wall.x + edge.outward.x * kAsk, wall.y + edge.outward.y * kAsk};
  const std::array<Point2, kFanRays> fan = fan_around(edge.outward);
  double all = 0, seen = 0, near = 0, ahead = 0, distance = 0;
  for (std::size_t i = 0; i < kFanRays; ++i) {
    const double weight = fan[i].x * edge.outward.x + fan[i].y * edge.outward.y;
    const Sight& sight = out.fan[i] = index.scene().look(eye, fan[i], options.view);
    const bool sees_street = sight.street_piece != kNothing;
    all += weight;
    if (sees_street) seen += weight;
    if (sees_street && sight.street <= options.street_view) near += weight;
    if (i + kAhead < kFanRays / 2 || i > kFanRays / 2 + kAhead) continue;
    ahead += weight;
    if (!sees_street || sight.street > options.street_view || !may_front(edge, sight, index.scene())) continue;
    out.ahead += weight;
    distance += weight * sight.street * weight;
  }
  if (out.ahead > 0) out.street_distance = distance / out.ahead;
  out.ahead /= ahead;
  out.street_share = seen / all;
  const Sight& straight = out.fan[kFanRays / 2];
  // Where a recess is narrower than rays begin before a wall, they begin in the building itself.
  if (straight.from_inside && index.all().footprints[straight.footprint].id != view.own)
    out.inside = straight.footprint;
  for (const std::uint32_t s : view.squares)
    if (out.square == kNothing && index.squares()[s].box.meets({front, front}) &&
        index.contains(index.squares()[s], front))
      out.square = s;
  for (const std::uint32_t near : view.yard_boxes.near({front, front}, 0)) {
    const std::uint32_t y = view.yards[near];
    if (out.yard == kNothing && geometry::contains(index.courtyard(index.yards()[y]).polygon, front)) out.yard = y;
  }

  const bool closed_yard = out.yard != kNothing && index.courtyard(index.yards()[out.yard]).closed;
  if (out.inside != kNothing)
    out.kind = WallSegmentKind::party_wall;
  else if ((out.square != kNothing && !closed_yard) || out.ahead >= 0.5 || near >= options.min_street_only * all)
    out.kind = WallSegmentKind::street;
  else if (closed_yard)
    out.kind = WallSegmentKind::courtyard;
  return out;
}

Enclosure enclosure_at(const OutlineEdge& edge, double at, model::OsmId own, bool in_yard, const BuildingView& view,
                       const WallSegmentOptions& options) {
  const Scene& scene = view.index->scene();
  const Point2 wall = edge.at(at);
  const Point2 eye{wall.x + edge.outward.x * kBefore, wall.y + edge.outward.y * kBefore};
  const Sight ahead = scene.look(eye, edge.outward, options.view);
  const double opposite = std::min(ahead.wall, options.view);
  Enclosure out;
  constexpr int kRays = kRaysAround * static_cast<int>(std::size(kPushes));
  int looked = 0;
  for (const double push : kPushes) {
    const double before = std::min(push, opposite / 2);
    if (!look_around({wall.x + edge.outward.x * before, wall.y + edge.outward.y * before}, edge.outward, own, looked,
                     kRays, view, options, out))
      break;
    looked += kRaysAround;
  }
  out.divide(kRays);
  const bool gap = opposite <= options.max_alley && view.index->all().footprints[ahead.footprint].id != own;
  if (!gap || !out.is_court(options)) return out;
  const Point2 middle{wall.x + edge.outward.x * opposite / 2, wall.y + edge.outward.y * opposite / 2};
  const Point2 back{-edge.along.x, -edge.along.y};
  out.alley = leads_out(middle, edge.along, edge.length - at, edge, own, in_yard, view, options) ||
              leads_out(middle, back, at, edge, own, in_yard, view, options);
  return out;
}

}  // namespace blockrand::context
