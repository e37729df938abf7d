#include "pipeline/surroundings/surroundings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "pipeline/georef/tiles.h"
#include "pipeline/model/osm_keys.h"
#include "pipeline/surroundings/account.h"
#include "pipeline/surroundings/ground_surfaces.h"
#include "pipeline/surroundings/line_bodies.h"
#include "pipeline/surroundings/placing.h"
#include "pipeline/surroundings/portal_bodies.h"
#include "pipeline/surroundings/tile_squares.h"
#include "pipeline/surroundings/water_level.h"
#include "pipeline/surroundings/wire_bodies.h"

namespace blockrand::surroundings {
namespace {

using geometry::PlanBox;
using model::Point2;
using model::SurroundingState;

/// m: how far from a tile's squares places lie at most whose ground is asked for: below bridges that come there (kLookedThrough), and the
/// middles of their squares.
constexpr double kBesideSquares = 450;
/// m. A longer straight line is no thing of a town.
constexpr double kMostLooked = 100000;

/// The middle of the box of a thing's corners.
Point2 middle_of(const std::vector<std::vector<Point2>>& lines) {
  PlanBox box;
  for (const auto& line : lines)
    for (const Point2 p : line) box.include(p);
  return box.empty() ? Point2{} : model::snap(box.centre());
}

/// Whether a thing comes into squares: one of its points, or of points every few metres between them; an area also where it only
/// covers them.
bool comes_to(const std::vector<std::vector<Point2>>& lines, bool area, const PlanBox& box,
              const std::set<SquareIndex>& squares) {
  constexpr double kStep = 50;
  for (const std::vector<Point2>& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (squares.contains(square_of(line[i]))) return true;
      if (i + 1 == line.size()) continue;
      PlanBox segment;
      segment.include(line[i]), segment.include(line[i + 1]);
      if (!segment.near(box, 0)) continue;
      const double length = std::hypot(line[i + 1].x - line[i].x, line[i + 1].y - line[i].y);
      if (length > kMostLooked) continue;
      for (double s = kStep; s < length; s += kStep)
        if (squares.contains(square_of({line[i].x + s / length * (line[i + 1].x - line[i].x),
                                        line[i].y + s / length * (line[i + 1].y - line[i].y)})))
          return true;
    }
  if (!area) return false;
  geometry::AreaClaim claim;
  claim.rings = lines;
  return geometry::claim_holds(claim, box_of(*squares.begin()).centre());
}

PlanBox grown(const PlanBox& box, double by) {
  PlanBox out;
  out.minimum = {box.minimum.x - by, box.minimum.y - by};
  out.maximum = {box.maximum.x + by, box.maximum.y + by};
  return out;
}

bool found_at(Point2 p, const geometry::AreaClaim& claim, const GroundLabel& label, GroundAt& found) {
  if (!geometry::claim_holds(claim, p) || !counts_in(square_of(p), claim, label)) return false;
  found.building = label.building;
  found.ground = label.ground;
  found.height = label.level.value_or(found.height) + static_cast<double>(label.offset);
  return true;
}

/// Where a mapped thing stands that the carriageway, as wide as it is assumed to be, has swallowed: at the nearest kerb, if that is near.
/// Bollards and gates stand where vehicles go.
/// \param on_street  it is mapped as a point of the street itself, whose middle that is
Point2 beside_traffic(Point2 place, std::string_view kind, bool on_street, const GroundAtPlace& ground) {
  using enum model::GroundClass;
  const auto is_traffic = [](const GroundAt& at) {
    return !at.building &&
           (at.ground == carriageway || at.ground == parking_lane || at.ground == cycle_way || at.ground == rail_bed);
  };
  constexpr std::string_view kInTheWay[] = {"bollard",    "gate",      "lift_gate",     "block",       "planter",
                                            "toll_booth", "turnstile", "cycle_barrier", "kissing_gate"};
  if (std::ranges::find(kInTheWay, kind) != std::end(kInTheWay)) return place;
  if (!is_traffic(ground(place))) return place;
  constexpr double kHalf = 0.5, kDiagonal = 0.70710678118654752, kCosine = 0.86602540378443865;
  constexpr double kDirections[16][2] = {{1, 0},  {kCosine, kHalf},   {kDiagonal, kDiagonal},   {kHalf, kCosine},
                                         {0, 1},  {-kHalf, kCosine},  {-kDiagonal, kDiagonal},  {-kCosine, kHalf},
                                         {-1, 0}, {-kCosine, -kHalf}, {-kDiagonal, -kDiagonal}, {-kHalf, -kCosine},
                                         {0, -1}, {kHalf, -kCosine},  {kDiagonal, -kDiagonal},  {kCosine, -kHalf}};
  constexpr double kStep = 0.5, kBehindKerb = 0.4;
  constexpr int kLane = 7;         // what stands farther in stands on an island that nobody mapped
  constexpr int kHalfStreet = 26;  // half of the widest street, to its corner at a junction
  const int most = on_street ? kHalfStreet : kLane;
  for (int step = 1; step <= most; ++step)
    for (const auto& d : kDirections) {
      const double r = step * kStep;
      const GroundAt at = ground({place.x + r * d[0], place.y + r * d[1]});
      if (at.building || is_traffic(at) || at.ground == water) continue;
      const Point2 behind = model::snap(Point2{place.x + (r + kBehindKerb) * d[0], place.y + (r + kBehindKerb) * d[1]});
      const GroundAt there = ground(behind);
      return there.building || is_traffic(there) ? model::snap(Point2{place.x + r * d[0], place.y + r * d[1]}) : behind;
    }
  return place;
}

}  // namespace

/// Heights of the ground of squares that are made when they are asked for.
class SurroundingsFinder::Heights {
 public:
  Heights(const HeightAt& height, double level) : height_(height), level_(level) {}
  const SquareGround& of(SquareIndex square) {
    const auto known = squares_.find(square);
    return known != squares_.end() ? known->second
                                   : squares_.try_emplace(square, square, height_, level_).first->second;
  }
  double at(Point2 place) { return of(square_of(place)).at(place); }

 private:
  const HeightAt& height_;
  double level_ = 0;
  std::map<SquareIndex, SquareGround> squares_;
};

SurroundingsFinder::SurroundingsFinder(const SurroundingInputs& inputs, SurroundingOptions layers, HeightAt height,
                                       double level, std::uint64_t seed)
    : in_(inputs), layers_(layers), height_(std::move(height)), level_(level), seed_(seed), claims_(inputs) {}

std::vector<SquareIndex> SurroundingsFinder::squares_of(model::TileId tile) const {
  return squares_of_tile(in_.projection, tile);
}

model::Surroundings SurroundingsFinder::around(model::TileId tile) const {
  model::Surroundings out;
  const std::vector<SquareIndex> squares = squares_of(tile);
  if (squares.empty()) return out;
  PlanBox box;
  for (const SquareIndex s : squares) box.include(box_of(s));
  const std::set<SquareIndex> own(squares.begin(), squares.end());
  const auto is_own = [&](Point2 p) { return own.contains(square_of(p)); };

  GroundClaims claims = claims_.claims_in(grown(box, kLongest));
  set_levels(claims);
  const geometry::BoxIndex claim_boxes([&] {
    std::vector<PlanBox> boxes;
    for (const geometry::AreaClaim& claim : claims.claims) {
      boxes.push_back(claim.box);
      if (!claim.right_of_lines) continue;  // it reaches far beyond its lines
      boxes.back().minimum = {claim.box.minimum.x - geometry::kCoastReach, claim.box.minimum.y - geometry::kCoastReach};
      boxes.back().maximum = {claim.box.maximum.x + geometry::kCoastReach, claim.box.maximum.y + geometry::kCoastReach};
    }
    return boxes;
  }());
  GroundLabel land;
  land.material = in_.catalogue.material("land");

  // Mapped points and rows, and what becomes of each thing.
  std::map<model::OsmId, SurroundingState> states;
  std::map<model::OsmId, SurroundingKind> kinds;
  std::vector<PlannedObject> planned;
  std::vector<Point2> mapped_trees;
  std::set<model::OsmId> with_ground;
  const std::vector<std::uint32_t> near = claims_.things_near(box, 0);
  std::map<model::OsmId, std::uint32_t> thing_of;
  for (const std::uint32_t t : near) {
    const Thing& thing = claims_.things()[t];
    const model::Feature& feature = in_.extract.features[thing.feature];
    thing_of[feature.id] = t;
    const std::vector<std::vector<Point2>> lines = claims_.lines_of(thing);
    if (is_asked(thing.kind, layers_) && comes_to(lines, feature.area && !thing.wide, box, own)) {
      kinds[feature.id] = thing.kind;
      states[feature.id] = thing.hidden.value_or(SurroundingState::not_modelled);
    }
    if (thing.hidden) continue;
    const TagOf tag = claims_.tags_of(thing.feature);
    if (!layers_.objects) continue;
    const bool point = !feature.area && lines.size() == 1 && lines[0].size() == 1;
    if (thing.kind == SurroundingKind::tree) {
      if (point) {
        if (auto tree = object_at(in_.catalogue, "tree", feature.id, lines[0][0], tag, seed_)) {
          planned.push_back(*tree), mapped_trees.push_back(tree->place);
        }
      } else if (!feature.area) {
        for (const auto& line : lines) {
          if (line.size() < 2) continue;
          for (PlannedObject& tree : row_of_trees(in_.catalogue, feature.id, line, tag, seed_))
            mapped_trees.push_back(tree.place), planned.push_back(std::move(tree));
        }
      }
      continue;
    }
    if (!point && !feature.area) continue;
    const ObjectRule* rule = in_.catalogue.object_of(tag, feature.area);
    if (rule == nullptr || rule->kind.empty()) continue;
    if (auto object =
            object_at(in_.catalogue, rule->kind, feature.id, point ? lines[0][0] : middle_of(lines), tag, seed_))
      planned.push_back(std::move(*object));
  }

  const std::function<TagOf(model::OsmId)> tags_of_object = [&](model::OsmId id) {
    const auto known = thing_of.find(id);
    return known != thing_of.end() ? claims_.tags_of(claims_.things()[known->second].feature)
                                   : TagOf([](std::string_view) { return std::string_view(); });
  };
  // The ground, square by square.
  Heights heights(height_, level_);
  for (const SquareIndex square : squares) {
    const SquareGround& ground = heights.of(square);
    GroundClaims of_square;
    of_square.labels = claims.labels;
    for (const std::uint32_t c : claim_boxes.near(box_of(square), 1))
      if (counts_in(square, claims.claims[c], claims.labels[claims.claims[c].label]))
        of_square.claims.push_back(claims.claims[c]);
    if (of_square.claims.empty()) continue;
    std::vector<SquareSurface> surfaces = ground_surfaces(square, ground, of_square, land);
    const auto is_mapped = [&](const SquareSurface& s) { return s.label < claims.labels.size(); };
    // Squares into which nothing mapped comes are left out; the land around a building is not.
    const bool has_building = std::ranges::any_of(of_square.claims, [&](const geometry::AreaClaim& claim) {
      return claims.labels[claim.label].building && claim.box.near(box_of(square), 0);
    });
    if (!has_building && std::ranges::none_of(surfaces, is_mapped)) continue;
    for (const SquareSurface& s : surfaces)
      if (is_mapped(s) && layers_.ground) with_ground.insert(claims.labels[s.label].object);
    if (layers_.objects)
      for (PlannedObject& tree : scattered_trees(in_.catalogue, surfaces, claims, mapped_trees, tags_of_object, seed_))
        planned.push_back(std::move(tree));
    if (layers_.ground)
      for (SquareSurface& s : surfaces) out.surfaces.push_back(std::move(s.surface));
  }

  const GroundAtPlace ground_at = [&](Point2 p) {
    PlanBox at;
    at.include(p);
    GroundAt found{false, model::GroundClass::land, heights.at(p)};
    for (const std::uint32_t c : claim_boxes.near(at, 0))  // the strongest first
      if (found_at(p, claims.claims[c], claims.labels[claims.claims[c].label], found)) break;
    return found;
  };
  const GroundAtPlace anywhere = [&](Point2 p) { return ground_anywhere(p, heights); };
  // Of the squares of a run's ends alone: a run leads far beyond the tile.
  const std::function<double(Point2)> run_height = [&](Point2 p) { return heights.at(p); };
  for (PlannedObject& object : planned) {
    if (!is_own(object.place)) continue;
    if (const auto thing = thing_of.find(object.object.object); thing != thing_of.end())
      kinds[object.object.object] = claims_.things()[thing->second].kind;
    SurroundingState& state = states.try_emplace(object.object.object, SurroundingState::not_modelled).first->second;
    // What holds wires stands where its line has it, and looks along it.
    const bool has_line =
        object.object.object.type == model::OsmType::node && !in_.catalogue.wires_of(object.object.shape).empty();
    const std::optional<double> along =
        has_line ? wire_direction(in_, claims_, object.object.object.number) : std::nullopt;
    if (along) {
      object.object.turn = static_cast<float>(*along);
    } else {
      object.place = beside_traffic(
          object.place, in_.catalogue.shown().shapes[object.object.shape].kind,
          object.object.object.type == model::OsmType::node && claims_.streets_at(object.object.object.number) > 0,
          ground_at);
    }
    const GroundAt ground = ground_at(object.place);
    if (ground.building) {
      if (state == SurroundingState::not_modelled) state = SurroundingState::covered;
      continue;
    }
    object.object.place = {object.place.x, object.place.y, model::snap(ground.height)};
    state = SurroundingState::modelled;
    out.objects.push_back(object.object);
  }
  if (layers_.bodies) {
    const std::function<bool(Point2)> has_place = is_own;
    const BodySite site{.in = in_,
                        .claims = claims_,
                        .is_own = has_place,
                        .around = box,
                        .ground = ground_at,
                        .terrain_height = run_height};
    for (const std::uint32_t t : near) {
      const Thing& thing = claims_.things()[t];
      const model::OsmId id = in_.extract.features[thing.feature].id;
      std::vector<model::SurroundingBody> bodies = thing.hidden ? portal_bodies(site, thing) : line_bodies(site, thing);
      if (auto wires = wire_bodies(site, thing, anywhere)) bodies.push_back(std::move(*wires));
      if (!bodies.empty()) states[id] = SurroundingState::modelled, kinds[id] = thing.kind;
      for (model::SurroundingBody& body : bodies) out.bodies.push_back(std::move(body));
    }
  }
  const bool has_sea = std::ranges::any_of(out.surfaces, [](const model::GroundSurface& s) {
    return s.ground == model::GroundClass::water && s.object.number == 0;
  });
  if (has_sea)
    for (const std::uint32_t t : claims_.coasts())
      if (const auto coast = states.find(in_.extract.features[claims_.things()[t].feature].id); coast != states.end())
        coast->second = SurroundingState::modelled;
  for (const model::OsmId id : with_ground)
    if (const auto thing = thing_of.find(id); thing != thing_of.end()) {
      states[id] = SurroundingState::modelled;
      kinds[id] = claims_.things()[thing->second].kind;
    }
  for (const auto& [id, state] : states) {
    const auto kind = kinds.find(id);
    if (kind == kinds.end()) continue;
    SurroundingState told = state;
    // Ground that nobody sees lies under something stronger.
    if (told == SurroundingState::not_modelled && layers_.ground &&
        claims_.claims_ground(claims_.things()[thing_of.at(id)]))
      told = SurroundingState::covered;
    out.outcomes.push_back({id, told, static_cast<std::uint8_t>(kind->second)});
  }
  return out;
}

void SurroundingsFinder::set_levels(GroundClaims& claims) const {
  if (!height_) return;
  for (GroundLabel& label : claims.labels) {
    const bool water = label.ground == model::GroundClass::water || label.ground == model::GroundClass::swimming_pool;
    if (label.building || !water || label.object.number == 0) continue;
    const Thing* thing = claims_.thing_of(label.object);
    if (thing == nullptr) continue;
    label.level = bank_level(claims_, *thing, in_.extract.features[thing->feature].area, height_);
  }
}

GroundAt SurroundingsFinder::ground_anywhere(Point2 place, Heights& heights) const {
  PlanBox at;
  at.include(place);
  GroundAt found{false, model::GroundClass::land, heights.at(place)};
  GroundClaims there = claims_.claims_in(at);
  set_levels(there);
  for (const geometry::AreaClaim& claim : there.claims)
    if (!claim.right_of_lines && !there.labels[claim.label].wide &&
        found_at(place, claim, there.labels[claim.label], found))
      break;
  return found;
}

void SurroundingsFinder::pack(model::TileId tile, base::Packer& out) const {
  const std::vector<SquareIndex> squares = squares_of(tile);
  if (squares.empty()) return;
  PlanBox box;
  for (const SquareIndex s : squares) box.include(box_of(s));
  for (const std::uint32_t t : claims_.things_near(box, kSurroundingsReach)) pack_thing(claims_.things()[t], box, out);
  const GroundClaims claims = claims_.claims_in(grown(box, kSurroundingsReach));
  for (const geometry::AreaClaim& claim : claims.claims) {
    const GroundLabel& label = claims.labels[claim.label];
    out << label.building << label.ground << label.object << label.material << label.offset << label.trees_per_hectare
        << claim.right_of_lines << claim.rings;
  }
  if (!layers_.bodies && !layers_.objects) return;
  Heights heights(height_, level_);
  const std::set<SquareIndex> own(squares.begin(), squares.end());
  const std::function<bool(Point2)> is_own = [&](Point2 p) { return own.contains(square_of(p)); };
  const GroundAtPlace anywhere = [&](Point2 p) { return ground_anywhere(p, heights); };
  const std::function<double(Point2)> height = [&](Point2 p) { return heights.at(p); };
  const BodySite site{
      .in = in_, .claims = claims_, .is_own = is_own, .around = box, .ground = anywhere, .terrain_height = height};
  for (const std::uint32_t t : claims_.things_near(box, 0)) {
    const Thing& thing = claims_.things()[t];
    const model::Feature& feature = in_.extract.features[thing.feature];
    if (feature.area || thing.hidden || feature.rings.count != 1) continue;
    // Wires hang on what stands far away, and over houses on their way: they are their own key.
    if (has_wires(in_, thing)) {
      const std::optional<model::SurroundingBody> wires = wire_bodies(site, thing, anywhere);
      out << wires.has_value();
      if (wires) out << wires->faces;
    }
    // Bridges look along their runs, and at the ground at its ends.
    if (thing.kind != SurroundingKind::bridge) continue;
    const ClaimFinder::BridgeRun run = claims_.bridge_run(thing);
    out << run.length << run.before << run.layer << run.crosses_traffic << run.line;
  }
}

SurroundingsReach SurroundingsFinder::reach(model::TileId tile) const {
  SurroundingsReach out;
  PlanBox box;
  for (const SquareIndex s : squares_of(tile)) box.include(box_of(s));
  if (box.empty()) return out;
  const auto add = [&](const PlanBox& place) { out.things.push_back(grown(place, kTownStreetReach)); };
  // The segments of lines that come near the squares.
  const auto add_lines = [&](const Thing& thing, double distance) {
    const bool area = in_.extract.features[thing.feature].area;
    for (const std::vector<Point2>& line : claims_.lines_of(thing))
      for (std::size_t i = area ? 0 : 1; i < line.size(); ++i) {
        PlanBox segment;
        segment.include(line[i]), segment.include(i > 0 ? line[i - 1] : line.back());
        if (segment.near(box, distance)) add(segment);
      }
  };
  add(box);
  for (const std::uint32_t t : claims_.things_near(box, 0)) {
    const Thing& thing = claims_.things()[t];
    const model::Feature& feature = in_.extract.features[thing.feature];
    if (feature.area || thing.hidden || feature.rings.count != 1) continue;
    if (has_wires(in_, thing)) add_lines(thing, kMostSpan);
    if (thing.kind == SurroundingKind::bridge) add(geometry::box_of(claims_.bridge_run(thing).line));
    // Gates at the ends of its segments say how long its pieces are.
    if (thing.kind == SurroundingKind::barrier) add_lines(thing, kSurroundingsReach);
  }
  for (const std::uint32_t t : claims_.coasts()) add_lines(claims_.things()[t], geometry::kCoastReach + kBesideSquares);
  for (const Thing& thing : claims_.things())
    if (thing.wide) add_lines(thing, kWideReach + kBesideSquares);
  out.blocks = claims_.blocks_near(grown(box, kTownStreetReach));
  return out;
}

void SurroundingsFinder::pack_thing(const Thing& thing, const PlanBox& around, base::Packer& out) const {
  const model::Extract& e = in_.extract;
  const model::Feature& feature = e.features[thing.feature];
  out << feature.id << feature.kinds << feature.area << feature.tags.count << feature.rings.count;
  for (const model::Tag& tag : e.tags_of(feature.tags)) out << e.strings.view(tag.key) << e.strings.view(tag.value);
  for (const model::MappedRing& ring : e.rings_of(feature.rings)) {
    const auto vertices = e.vertices_of(ring);
    const auto nodes = e.nodes_of(ring);
    out << ring.inner << vertices;
    if (feature.area && thing.kind != SurroundingKind::barrier) continue;
    // What single nodes of lines are: junctions, crossings, gates, supports.
    for (std::size_t i = 0; i < nodes.size() && i < vertices.size(); ++i) {
      PlanBox at;
      at.include(in_.projection.forward(vertices[i]));
      // A barrier's pieces are as long as its segment has room for, from end to end.
      if (thing.kind == SurroundingKind::barrier)
        for (const std::size_t k : {i > 0 ? i - 1 : i, i + 1 < vertices.size() ? i + 1 : i})
          at.include(in_.projection.forward(vertices[k]));
      if (!at.near(around, kNodeReach)) continue;
      const StreetControl control = claims_.control_at(nodes[i]);
      constexpr double kStreet = 2, kGate = 1;  // any two lengths
      out << static_cast<std::uint64_t>(claims_.streets_at(nodes[i]))
          << static_cast<std::uint64_t>(claims_.tracks_at(nodes[i])) << claims_.crossing_at(nodes[i]) << control
          << claims_.opening_at(nodes[i], kStreet, kGate);
      if (at.near(around, 0)) out << wire_direction(in_, claims_, nodes[i]);
    }
  }
}

}  // namespace blockrand::surroundings
