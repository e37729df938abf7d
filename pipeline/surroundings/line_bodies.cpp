#include "pipeline/surroundings/line_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "pipeline/model/osm_keys.h"
#include "pipeline/surroundings/cliff_bodies.h"
#include "pipeline/surroundings/line_strips.h"
#include "pipeline/surroundings/stair_bodies.h"
#include "pipeline/surroundings/street_markings.h"
#include "pipeline/surroundings/street_profile.h"

namespace blockrand::surroundings {
namespace {

using model::BodyClass;
using model::FlatPolygon;
using model::Point2;
using model::Point3;
using model::SurroundingBody;
namespace osm_key = model::osm_key;

/// m: pieces of decks, which bend where they reach their height.
constexpr double kDeckStep = 10;
/// Of one segment: no bridge is longer.
constexpr double kMostDeckPieces = 5000;
/// m: how deep bodies reach into the ground, so that no gap shows on a slope.
constexpr double kSunk = 0.3;
// Bridges. m: clearance above streets and railways [RASt 06: 4.50], above water and green [E], thickness of a deck, height of railings
// [RAS-Q: 1.0 to 1.3]; slopes at most.
constexpr double kClearance = 4.5, kLowClearance = 0.6, kDeck = 0.6, kRailing = 1.1, kRailingWidth = 0.08;
constexpr double kMostSlope = 0.06, kMostRailSlope = 0.025;
// m: half of the opening where a street or a gate is a point of a barrier.
constexpr double kStreetOpening = 1.75, kGateOpening = 0.6;

// ---- barriers

struct BarrierKind {
  std::string_view value;
  BodyClass body;
  double height, width;  ///< m
  std::string_view material;
};
// Measures of what nobody measured: garden walls and fences are limited to 1.2 to 2 m by most building codes of German states.
constexpr std::array<BarrierKind, 12> kBarriers{{{"wall", BodyClass::wall, 1.5, 0.25, "stone"},
                                                 {"city_wall", BodyClass::city_wall, 6, 1.2, "stone"},
                                                 {"retaining_wall", BodyClass::retaining_wall, 1.2, 0.35, "stone"},
                                                 {"fence", BodyClass::fence, 1.3, 0.05, "metal"},
                                                 {"hedge", BodyClass::hedge, 1.5, 0.8, "hedge"},
                                                 {"guard_rail", BodyClass::guard_rail, 0.75, 0.1, "metal"},
                                                 {"handrail", BodyClass::guard_rail, 0.9, 0.05, "metal"},
                                                 {"jersey_barrier", BodyClass::guard_rail, 0.8, 0.5, "concrete"},
                                                 {"cable_barrier", BodyClass::guard_rail, 0.75, 0.05, "metal"},
                                                 {"kerb", BodyClass::kerb, 0.12, 0.15, "kerb_stone"},
                                                 {"ditch", BodyClass::other, 0, 0, ""},
                                                 {"gate", BodyClass::fence, 1.3, 0.06, "metal"}}};

std::string_view material_of(const TagOf& tag, std::string_view usual) {
  const std::string_view told = tag(osm_key::kMaterial), fence = tag(osm_key::kFenceType);
  if (told == "wood" || fence == "wood" || fence == "pole" || fence == "split_rail") return "wood";
  if (told == "concrete") return "concrete";
  if (told == "brick") return "brick";
  if (told == "stone") return "stone";
  if (told == "metal" || told == "steel" || told == "iron") return "metal";
  return usual;
}

/// A fence: posts and two rails. \param base  m, the height that it stands on, by point of the line
/// \param sunk  m, how deep its posts go
void add_fence(const OffsetLine& line, double height, double width, const std::function<double(std::size_t)>& base,
               double sunk, const std::function<bool(std::size_t)>& takes, std::vector<FlatPolygon>& out) {
  for (const double at : {0.35 * height, height - 0.06})
    add_strip(
        line, -width / 2, width / 2, [&](std::size_t i) { return std::pair(base(i) + at - 0.05, base(i) + at + 0.05); },
        takes, false, out);
  constexpr double kPostDistance = 2.5, kPost = 0.05;
  const auto post = [&](Point2 p, double z) {
    const auto corner = [&](double x, double y, double up) { return Point3{p.x + x, p.y + y, model::snap(z + up)}; };
    constexpr std::array<std::array<double, 2>, 4> kCorners{
        {{-kPost, -kPost}, {kPost, -kPost}, {kPost, kPost}, {-kPost, kPost}}};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& a = kCorners[i];
      const auto& b = kCorners[(i + 1) % 4];
      out.push_back({{corner(a[0], a[1], -sunk), corner(b[0], b[1], -sunk), corner(b[0], b[1], height),
                      corner(a[0], a[1], height)},
                     {}});
    }
  };
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    if (!takes(i)) continue;
    const Point2 a = line.points()[i], b = line.points()[i + 1];
    const double length = line.along(i + 1) - line.along(i);
    const int gaps = std::max(1, static_cast<int>(std::round(length / kPostDistance)));
    const bool last = i + 2 == line.size() || !takes(i + 1);
    for (int k = 0; k < gaps + (last ? 1 : 0); ++k) {
      const double f = static_cast<double>(k) / gaps;
      post(model::snap(Point2{a.x + f * (b.x - a.x), a.y + f * (b.y - a.y)}), base(i) + f * (base(i + 1) - base(i)));
    }
  }
}

/// A line in pieces: without what lies within `half` metres of the points that are openings.
std::vector<std::vector<Point2>> without_openings(const std::vector<Point2>& line, const std::vector<double>& half) {
  std::vector<std::vector<Point2>> out;
  std::vector<Point2> run;
  const auto end_run = [&] {
    if (run.size() >= 2) out.push_back(run);
    run.clear();
  };
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Point2 a = line[i], b = line[i + 1];
    const double length = std::hypot(b.x - a.x, b.y - a.y), from = half[i], to = length - half[i + 1];
    if (from > 0) end_run();
    if (to <= from) {
      end_run();
      continue;
    }
    const auto at = [&](double s) {
      return model::snap(Point2{a.x + s / length * (b.x - a.x), a.y + s / length * (b.y - a.y)});
    };
    if (run.empty()) run.push_back(from > 0 ? at(from) : a);
    run.push_back(half[i + 1] > 0 ? at(to) : b);
    if (half[i + 1] > 0) end_run();
  }
  end_run();
  return out;
}

class Bodies {
 public:
  Bodies(const BodySite& site, const Thing& thing)
      : site_(site),
        in_(site.in),
        claims_(site.claims),
        thing_(thing),
        is_own_(site.is_own),
        around_(site.around),
        ground_(site.ground),
        run_height_(site.terrain_height),
        tag_(site.claims.tags_of(thing.feature)),
        feature_(site.in.extract.features[thing.feature]) {}

  std::vector<SurroundingBody> make() {
    switch (thing_.kind) {
      case SurroundingKind::barrier:
        barrier();
        break;
      case SurroundingKind::railway:
        if (!feature_.area)
          for (const auto& line : claims_.lines_of(thing_)) rails(OffsetLine(following(line, ground_, around_)), {});
        break;
      case SurroundingKind::bridge:
        if (!feature_.area) bridge();
        break;
      case SurroundingKind::road:
        if (feature_.area) break;
        take(street_markings(site_, thing_));
        take(stair_bodies(site_, thing_));
        break;
      case SurroundingKind::cliff:
        take(cliff_bodies(site_, thing_));
        break;
      case SurroundingKind::aeroway:
      case SurroundingKind::aerialway:
      case SurroundingKind::parking:
      case SurroundingKind::bicycle_parking:
      case SurroundingKind::water:
      case SurroundingKind::pool:
      case SurroundingKind::golf:
      case SurroundingKind::pitch:
      case SurroundingKind::power:
      case SurroundingKind::wind_turbine:
      case SurroundingKind::mast:
      case SurroundingKind::tunnel:
      case SurroundingKind::surface_area:
      case SurroundingKind::tree:
      case SurroundingKind::street_furniture:
      case SurroundingKind::traffic_sign:
      case SurroundingKind::other:
        break;
    }
    return std::move(out_);
  }

 private:
  SurroundingBody& body(BodyClass kind, std::string_view material) {
    SurroundingBody made;
    made.body = kind, made.object = feature_.id, made.material = in_.catalogue.material(material);
    out_.push_back(std::move(made));
    return out_.back();
  }
  void take(std::optional<SurroundingBody> made) {
    if (made) out_.push_back(std::move(*made));
  }
  void drop_empty() {
    std::erase_if(out_, [](const SurroundingBody& b) { return b.faces.empty(); });
  }
  bool is_own(const OffsetLine& line, std::size_t i) const {
    const Point2 a = line.points()[i], b = line.points()[i + 1];
    return is_own_({(a.x + b.x) / 2, (a.y + b.y) / 2});
  }

  void barrier() {
    const std::string_view value = tag_(osm_key::kBarrier);
    const auto kind = std::ranges::find(kBarriers, value, &BarrierKind::value);
    if (kind == kBarriers.end() || kind->height == 0) return;
    const auto tagged = [&](std::string_view k, double usual, double most) {
      const std::optional<double> told = length_of(tag_(k));
      return told && *told > 0.02 && *told <= most ? *told : usual;
    };
    const double height = tagged(osm_key::kHeight, kind->height, 30), width = tagged(osm_key::kWidth, kind->width, 5);
    std::vector<FlatPolygon>& faces = body(kind->body, material_of(tag_, kind->material)).faces;
    const auto rings = in_.extract.rings_of(feature_.rings);
    const auto lines = claims_.lines_of(thing_);
    for (std::size_t r = 0; r < lines.size(); ++r) {
      std::vector<Point2> mapped = lines[r];
      if (mapped.size() < 2) continue;
      if (feature_.area && mapped.front() != mapped.back()) mapped.push_back(mapped.front());
      std::vector<double> openings(mapped.size(), 0.0);
      const auto nodes = in_.extract.nodes_of(rings[r]);
      if (nodes.size() == mapped.size())
        for (std::size_t i = 0; i < nodes.size(); ++i)
          openings[i] = claims_.opening_at(nodes[i], kStreetOpening, kGateOpening);
      for (const std::vector<Point2>& run : without_openings(mapped, openings)) {
        const OffsetLine line(following(run, ground_, around_));
        if (line.size() < 2) continue;
        const auto takes = [&](std::size_t i) {
          if (!is_own(line, i)) return false;
          const Point2 a = line.points()[i], b = line.points()[i + 1];
          return !ground_({(a.x + b.x) / 2, (a.y + b.y) / 2}).building;
        };
        if (kind->body == BodyClass::fence) {
          add_fence(
              line, height, width, [&](std::size_t i) { return ground_(line.points()[i]).height; }, kSunk, takes,
              faces);
        } else {
          add_strip(
              line, -width / 2, width / 2,
              [&](std::size_t i) {
                const double z = ground_(line.points()[i]).height;
                return std::pair(z - kSunk, z + height);
              },
              takes, false, faces);
        }
      }
    }
    drop_empty();
  }

  /// \param deck  heights of a bridge, by point of the line; empty: those of the ground
  void rails(const OffsetLine& line, const std::vector<double>& deck) {
    if (line.size() < 2) return;
    const std::string_view kind = tag_(osm_key::kRailway);
    const bool tram = kind == "tram";
    if (!is_track(kind)) return;
    double gauge = 1.435;
    if (const std::optional<double> told = length_of(tag_(osm_key::kGauge)); told && *told >= 300 && *told <= 2000)
      gauge = *told / 1000;
    // Rails of trams lie in the pavement; others stand 15 to 17 cm high (UIC 54: 159 mm).
    const double top = tram ? 0.015 : 0.16, half = 0.035;
    std::vector<FlatPolygon>& faces = body(BodyClass::rail, "rail_steel").faces;
    for (const double side : {-gauge / 2, gauge / 2})
      add_strip(
          line, side - half, side + half,
          [&](std::size_t i) {
            const double z = deck.empty() ? ground_(line.points()[i]).height : deck[i];
            return std::pair(z - (tram ? 0.05 : 0), z + top);
          },
          [&](std::size_t i) { return is_own(line, i); }, false, faces);
    drop_empty();
  }

  void bridge() {
    const auto lines = claims_.lines_of(thing_);
    for (const std::vector<Point2>& mapped : lines) {
      if (mapped.size() < 2) continue;
      const ClaimFinder::BridgeRun run = claims_.bridge_run(thing_);
      // A deck bends where its clearance is reached: points every kFollowStep metres.
      std::vector<Point2> points;
      for (std::size_t i = 0; i + 1 < mapped.size(); ++i) {
        const Point2 a = mapped[i], b = mapped[i + 1];
        const int pieces = std::max(
            1, static_cast<int>(std::min(kMostDeckPieces, std::ceil(std::hypot(b.x - a.x, b.y - a.y) / kDeckStep))));
        for (int k = 0; k < pieces; ++k) {
          const double f = static_cast<double>(k) / pieces;
          points.push_back(model::snap(Point2{a.x + f * (b.x - a.x), a.y + f * (b.y - a.y)}));
        }
      }
      points.push_back(mapped.back());
      points.erase(std::unique(points.begin(), points.end()), points.end());
      const OffsetLine line(points);
      if (line.size() < 2) continue;
      const double first = run_height_(run.start), last = run_height_(run.end);
      const bool rail = !tag_(osm_key::kRailway).empty();
      double lowest = std::min(first, last);
      if (run.length <= kLookedThrough)
        for (const Point2 p : run.line) lowest = std::min(lowest, run_height_(p));
      const double asked = run.crosses_traffic ? kClearance * std::clamp(run.layer, 1.0, 4.0) : kLowClearance;
      const double clearance = std::max(0.0, asked - (std::min(first, last) - lowest));
      const double slope = rail ? kMostRailSlope : kMostSlope;
      std::vector<double> deck;
      for (std::size_t i = 0; i < line.size(); ++i) {
        const double s = run.before + line.along(i);
        const double t = run.length > 0 ? s / run.length : 0;
        const double rise = std::min({clearance, slope * s, slope * std::max(0.0, run.length - s)});
        deck.push_back(first + t * (last - first) + rise);
      }
      const auto takes = [&](std::size_t i) { return is_own(line, i); };
      double left = -1.7, right = 1.7;
      if (rail) {
        add_strip(
            line, left, right, [&](std::size_t i) { return std::pair(deck[i], deck[i]); }, takes, false,
            body(BodyClass::bridge, "ballast").faces);
        rails(line, deck);
      } else if (const std::optional<StreetProfile> profile =
                     street_profile(tag_, true, in_.catalogue, thing_.keeps_left)) {
        if (profile->strips.empty()) return;
        left = profile->strips.front().left, right = profile->strips.back().right;
        for (const StreetStrip& strip : profile->strips)
          add_strip(
              line, strip.left, strip.right, [&](std::size_t i) { return std::pair(deck[i] + 0.005, deck[i] + 0.005); },
              takes, false, body(BodyClass::bridge, in_.catalogue.shown().materials[strip.material].name).faces);
      } else {
        return;
      }
      std::vector<FlatPolygon>& structure = body(BodyClass::bridge, "concrete").faces;
      add_strip(
          line, left - 0.3, right + 0.3, [&](std::size_t i) { return std::pair(deck[i] - kDeck, deck[i] - 0.01); },
          takes, true, structure);
      for (const double side : {left - 0.2, right + 0.2}) {
        std::vector<Point2> beside;
        for (std::size_t i = 0; i < line.size(); ++i)
          beside.push_back(line.beside(i, side, std::min(i, line.size() - 2)));
        beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
        if (beside.size() != line.size()) continue;  // a bend that is tighter than the deck is wide
        add_fence(
            OffsetLine(beside), kRailing, kRailingWidth, [&](std::size_t i) { return deck[i]; }, 0.05, takes,
            body(BodyClass::bridge, "metal").faces);
      }
    }
    drop_empty();
  }

  const BodySite& site_;
  const SurroundingInputs& in_;
  const ClaimFinder& claims_;
  const Thing& thing_;
  const std::function<bool(Point2)>& is_own_;
  const geometry::PlanBox& around_;
  const GroundAtPlace& ground_;
  const std::function<double(Point2)>& run_height_;
  TagOf tag_;
  const model::Feature& feature_;
  std::vector<SurroundingBody> out_;
};

}  // namespace

std::vector<SurroundingBody> line_bodies(const BodySite& site, const Thing& thing) {
  return Bodies(site, thing).make();
}

}  // namespace blockrand::surroundings
