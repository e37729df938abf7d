#include "pipeline/surroundings/wire_bodies.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "pipeline/base/portable_math.h"
#include "pipeline/model/osm_keys.h"
#include "pipeline/surroundings/placing.h"

namespace blockrand::surroundings {
namespace {

using model::FlatPolygon;
using model::Point2;
using model::Point3;
namespace osm_key = model::osm_key;

/// Of a span: how far wires hang below the line between their ends [power lines 2 to 4 %, low voltage and cables 1 to 2 % E].
constexpr double kLineSag = 0.03, kMinorSag = 0.015, kCableSag = 0.02;
/// m: half of the thickness of a wire: conductors of 2 to 4 cm, ropes of 4 to 5 cm, drawn thicker so that they are seen.
constexpr double kRadius = 0.03;
/// m of a piece, and how many a span has.
constexpr double kPiece = 15, kLeastPieces = 4, kMostPieces = 12;
/// m: wires hang no farther beside the line between two supports.
constexpr double kMostBeside = 50;
/// m above the ground: lower wires over a building would come near its roof.
constexpr double kOverRoofs = 12;
/// m: the step in which places below a span are looked at.
constexpr double kLookStep = 2;
/// m: where ropes leave a station of an aerialway, above the ground and beside its middle [E].
constexpr double kStationHeight = 5, kStationHalf = 1.2;

struct Support {
  Point2 place;
  double base = 0;                               ///< m, of its foot
  Point2 across;                                 ///< to the left of its line
  std::vector<std::pair<double, double>> wires;  ///< m: to the left, above the foot
};

/// The neighbours of a node along lines of wires.
std::vector<Point2> neighbours(const SurroundingInputs& in, const ClaimFinder& claims, std::int64_t node) {
  std::vector<Point2> out;
  for (const std::uint32_t t : claims.wires_at(node)) {
    const Thing& thing = claims.things()[t];
    const auto nodes = in.extract.nodes_of(in.extract.rings_of(in.extract.features[thing.feature].rings)[0]);
    const std::vector<std::vector<Point2>> lines = claims.lines_of(thing);
    if (lines.empty() || lines[0].size() != nodes.size()) continue;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i] != node) continue;
      if (i > 0) out.push_back(lines[0][i - 1]);
      if (i + 1 < nodes.size()) out.push_back(lines[0][i + 1]);
    }
  }
  return out;
}

/// The direction of the line at a support: from a neighbour on one side to the one that lies most opposite to it.
std::optional<Point2> direction_at(const SurroundingInputs& in, const ClaimFinder& claims, std::int64_t node,
                                   Point2 place) {
  std::optional<Point2> first, out;
  double least = 2;
  for (const Point2 p : neighbours(in, claims, node)) {
    const double dx = p.x - place.x, dy = p.y - place.y, length = std::hypot(dx, dy);
    if (!(length > 0)) continue;
    const Point2 d{dx / length, dy / length};
    if (!first) {
      first = d, out = d;
      continue;
    }
    const double cosine = d.x * first->x + d.y * first->y;
    if (cosine >= least) continue;
    least = cosine;
    const double bx = d.x - first->x, by = d.y - first->y, b = std::hypot(bx, by);
    if (b > 0) out = Point2{bx / b, by / b};
  }
  return out;
}

std::string_view kind_of_support(const SurroundingInputs& in, const ClaimFinder& claims, std::int64_t node) {
  const std::optional<std::uint32_t> feature = claims.feature_of_node(node);
  if (!feature) return {};
  const ObjectRule* rule = in.catalogue.object_of(claims.tags_of(*feature), false);
  return rule ? std::string_view(rule->kind) : std::string_view();
}

/// What holds the wires at a node of a line; nothing where nothing is known to.
std::optional<Support> support_at(const SurroundingInputs& in, const ClaimFinder& claims, std::int64_t node,
                                  Point2 place, bool station, const GroundAtPlace& ground) {
  const std::optional<Point2> along = direction_at(in, claims, node, place);
  if (!along) return std::nullopt;
  Support out{.place = place, .base = 0, .across = {-along->y, along->x}, .wires = {}};
  const std::string_view kind = kind_of_support(in, claims, node);
  const GroundAt at = ground(place);
  out.base = at.height;
  if (!kind.empty()) {
    const TagOf tag = claims.tags_of(*claims.feature_of_node(node));
    const ChosenShape chosen = choose_shape(in.catalogue, kind, tag, [](std::string_view) { return 0.5; });
    for (const auto& [left, up] : in.catalogue.wires_of(chosen.shape))
      out.wires.emplace_back(left * static_cast<double>(chosen.width), up * static_cast<double>(chosen.height));
    if (!out.wires.empty()) {
      if (at.building) return std::nullopt;  // it is not placed there
      return out;
    }
  }
  if (!station) return std::nullopt;
  for (const double side : {-kStationHalf, kStationHalf}) out.wires.emplace_back(side, kStationHeight);
  return out;
}

/// A wire's piece: three sides around its axis.
void add_piece(std::vector<FlatPolygon>& out, Point3 a, Point3 b, Point2 left) {
  constexpr double kCorners[3][2] = {{0, 1}, {-0.866, -0.5}, {0.866, -0.5}};
  const auto corner = [&](Point3 p, std::size_t i) {
    return model::snap(Point3{p.x + kRadius * kCorners[i][0] * left.x, p.y + kRadius * kCorners[i][0] * left.y,
                              p.z + kRadius * kCorners[i][1]});
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 2) % 3;
    add_quad(out, corner(a, i), corner(a, k), corner(b, k), corner(b, i));
  }
}

/// Which wire of one support goes on in which of the other: from left to right, the upper ones of a side first.
std::vector<std::pair<std::size_t, std::size_t>> pairs_of(std::vector<std::pair<double, double>>& a,
                                                          std::vector<std::pair<double, double>>& b) {
  std::ranges::sort(a), std::ranges::sort(b);
  const std::size_t count = std::min(a.size(), b.size());
  const auto of = [&](std::size_t size, std::size_t i) {
    return count == 1 ? size / 2 : (i * (size - 1) + (count - 1) / 2) / (count - 1);
  };
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t i = 0; i < count; ++i) out.emplace_back(of(a.size(), i), of(b.size(), i));
  return out;
}

}  // namespace

bool has_wires(const SurroundingInputs& in, const Thing& thing) {
  const model::Feature& feature = in.extract.features[thing.feature];
  if (feature.area || feature.rings.count != 1) return false;
  const auto tag = [&](std::string_view key) { return in.extract.tag(feature.tags, key); };
  if (in.extract.rings_of(feature.rings)[0].vertices.count < 2) return false;
  if (thing.kind == SurroundingKind::power)
    return tag(osm_key::kPower) == "line" || tag(osm_key::kPower) == "minor_line";
  if (thing.kind != SurroundingKind::aerialway) return false;
  const std::string_view kind = tag(osm_key::kAerialway);
  return kind != "pylon" && kind != "station" && kind != "no";
}

std::optional<double> wire_direction(const SurroundingInputs& in, const ClaimFinder& claims, std::int64_t node) {
  if (claims.wires_at(node).empty()) return std::nullopt;
  const std::optional<std::uint32_t> feature = claims.feature_of_node(node);
  if (!feature) return std::nullopt;
  const model::Location at = in.extract.vertices_of(in.extract.rings_of(in.extract.features[*feature].rings)[0])[0];
  const std::optional<Point2> d = direction_at(in, claims, node, model::snap(in.projection.forward(at)));
  if (!d) return std::nullopt;
  return base::atan2(d->y, d->x);
}

std::optional<model::SurroundingBody> wire_bodies(const BodySite& site, const Thing& thing,
                                                  const GroundAtPlace& anywhere) {
  const SurroundingInputs& in = site.in;
  if (thing.hidden || !has_wires(in, thing)) return std::nullopt;
  const model::Feature& feature = in.extract.features[thing.feature];
  const auto nodes = in.extract.nodes_of(in.extract.rings_of(feature.rings)[0]);
  const std::vector<std::vector<Point2>> lines = site.claims.lines_of(thing);
  if (lines.empty() || lines[0].size() != nodes.size()) return std::nullopt;
  const std::vector<Point2>& line = lines[0];
  const bool rope = thing.kind == SurroundingKind::aerialway;
  const bool minor = site.claims.tags_of(thing.feature)(osm_key::kPower) == "minor_line";
  const double sag_share = rope ? kCableSag : minor ? kMinorSag : kLineSag;
  model::SurroundingBody made = body_of(site, thing, model::BodyClass::power_line, "steel_zinc");
  // Ropes pass vertices where nothing holds them: a span leads from one support to the next.
  std::optional<Support> from;
  std::size_t first = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool end = i == 0 || i + 1 == line.size();
    geometry::PlanBox place;
    place.include(line[i]);
    // Of a line that leads through a whole country, what holds a span that comes here.
    if (!rope && !place.near(site.around, kMostSpan + kMostBeside)) {
      from.reset();
      continue;
    }
    std::optional<Support> to = support_at(in, site.claims, nodes[i], line[i], rope && end, anywhere);
    if (rope && !to && !end) continue;
    if (from && to) {
      geometry::PlanBox box;
      for (std::size_t k = first; k <= i; ++k) box.include(line[k]);
      const double dx = to->place.x - from->place.x, dy = to->place.y - from->place.y, length = std::hypot(dx, dy);
      if (box.near(site.around, 0) && length > 0 && length <= kMostSpan) {
        const Point2 left{-dy / length, dx / length};
        const double sag = sag_share * length;
        const auto pieces = static_cast<int>(std::clamp(std::ceil(length / kPiece), kLeastPieces, kMostPieces));
        const auto pairs = pairs_of(from->wires, to->wires);
        const auto wire = [&](std::pair<std::size_t, std::size_t> p, double t) {
          const auto [a_left, a_up] = from->wires[p.first];
          const auto [b_left, b_up] = to->wires[p.second];
          const auto between = [&](double a, double b) { return a + t * (b - a); };
          return Point3{between(from->place.x + a_left * from->across.x, to->place.x + b_left * to->across.x),
                        between(from->place.y + a_left * from->across.y, to->place.y + b_left * to->across.y),
                        between(from->base + a_up, to->base + b_up) - 4 * sag * t * (1 - t)};
        };
        // The sides of both supports may be told from opposite directions.
        if (from->across.x * left.x + from->across.y * left.y < 0) {
          from->across = {-from->across.x, -from->across.y};
        }
        if (to->across.x * left.x + to->across.y * left.y < 0) to->across = {-to->across.x, -to->across.y};
        const auto is_low_over_roofs = [&](double t) {
          for (const auto& p : pairs) {
            const Point3 at = wire(p, t);
            const Point2 plan{at.x, at.y};
            if (site.claims.building_at(plan) && at.z - site.terrain_height(plan) < kOverRoofs) return true;
          }
          return false;
        };
        bool free = true;
        for (double s = kLookStep; !rope && free && s < length; s += kLookStep) free = !is_low_over_roofs(s / length);
        for (int k = 0; free && k < pieces; ++k) {
          const double t0 = static_cast<double>(k) / pieces, t1 = static_cast<double>(k + 1) / pieces;
          if (rope && (is_low_over_roofs(t0) || is_low_over_roofs((t0 + t1) / 2) || is_low_over_roofs(t1))) continue;
          for (const auto& p : pairs) {
            const Point3 a = wire(p, t0), b = wire(p, t1);
            if (site.is_own({(a.x + b.x) / 2, (a.y + b.y) / 2})) add_piece(made.faces, a, b, left);
          }
        }
      }
    }
    from = std::move(to), first = i;
  }
  if (made.faces.empty()) return std::nullopt;
  return made;
}

}  // namespace blockrand::surroundings
