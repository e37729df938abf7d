#include "pipeline/surroundings/ground_claims.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pipeline/geometry/line_area.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/osm_keys.h"
#include "pipeline/surroundings/street_profile.h"
#include "pipeline/surroundings/wire_bodies.h"

namespace blockrand::surroundings {
namespace {

using geometry::PlanBox;
using model::FeatureKind;
using model::GroundClass;
using model::Point2;
namespace osm_key = model::osm_key;

// m. Widths of waters that nobody measured: half of what the wiki of OpenStreetMap calls usual is seen from a bridge.
constexpr double kRiverWidth = 12, kCanalWidth = 8, kStreamWidth = 2, kDitchWidth = 1;
/// m: how much of a street is judged at a time: whether it is one of a town. A block is as long.
constexpr double kJudgedPiece = 150;
/// Of one segment: ways across oceans are no streets.
constexpr double kMostCuts = 2000;
/// m: how far a pavement reaches beyond its usual width to a house that stands a little farther away [E].
constexpr double kForecourt = 2;
/// m. Beds of a track: ballast of standard gauge is 3 to 4 m wide at its top (Deutsche Bahn, Ril 800.0130: 3.1 to 3.8 m).
constexpr double kTrackBed = 3.4, kTramBed = 2.6;
// Of a block, up to the middle of its streets: from where on yards are paved, and gardens are none.
constexpr double kPavedShare = 0.30, kGardenShare = 0.04;

bool keeps_left(const model::Extract& extract, const model::Feature& feature, const TagOf& tag,
                const Catalogue& catalogue) {
  const std::string_view side = tag(osm_key::kDrivingSide);
  if (side == "left" || side == "right") return side == "left";
  for (const model::MappedRing& ring : extract.rings_of(feature.rings))
    if (const auto vertices = extract.vertices_of(ring); !vertices.empty())
      return catalogue.keeps_left(vertices.front());
  return false;
}

/// Strength among claims of one class: a greater one is stronger.
double strength_of(std::string_view highway) {
  constexpr std::array<std::string_view, 18> kOrder{
      "motorway",      "trunk",        "primary",        "secondary",     "tertiary",     "motorway_link",
      "trunk_link",    "primary_link", "secondary_link", "tertiary_link", "unclassified", "residential",
      "living_street", "road",         "busway",         "service",       "track",        "pedestrian"};
  const auto at = std::ranges::find(kOrder, highway);
  return static_cast<double>(kOrder.end() - at);
}

/// m, of a waterway that nobody measured; 0: of none that has ground.
double usual_width(std::string_view waterway) {
  return waterway == "river"                          ? kRiverWidth
         : waterway == "canal"                        ? kCanalWidth
         : waterway == "stream"                       ? kStreamWidth
         : waterway == "ditch" || waterway == "drain" ? kDitchWidth
                                                      : 0;
}

/// m: how far beyond its points a thing reaches.
double reach_of(SurroundingKind kind, const model::Feature& feature, const TagOf& tag) {
  if (feature.area) return 0;
  if (kind == SurroundingKind::road || kind == SurroundingKind::railway || kind == SurroundingKind::bridge)
    return kStreetReach;
  // Wires hang beside their line, portals stand beside the end of theirs.
  if (kind == SurroundingKind::power || kind == SurroundingKind::aerialway || kind == SurroundingKind::tunnel)
    return 20;
  if (kind != SurroundingKind::water) return 5;
  return length_of(tag(osm_key::kWidth)).value_or(kRiverWidth) / 2 + 1;
}

bool is_coast(const TagOf& tag) { return tag(osm_key::kNatural) == "coastline"; }

/// m.
double surroundings_length(std::span<const Point2> line) {
  double sum = 0;
  for (std::size_t i = 1; i < line.size(); ++i) sum += std::hypot(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y);
  return sum;
}

std::vector<Point2> without_repeat(std::vector<Point2> ring) {
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  return ring;
}

}  // namespace

/// A claim before it is sorted in.
struct ClaimFinder::Entry {
  int rank = 0;         ///< less is stronger
  double strength = 0;  ///< more is stronger
  GroundLabel label;
  std::vector<std::vector<Point2>> rings;
  bool sea = false;  ///< AreaClaim::right_of_lines
};

namespace {

constexpr int kPassageRank = 0, kBuildingRank = 1, kFirstGroundRank = 2, kSeaRank = 998, kForecourtRank = 999,
              kBlockRank = 1000;

int rank_of(GroundClass ground) { return kFirstGroundRank + static_cast<int>(ground); }

void add_polygons(std::vector<model::Polygon> polygons, std::vector<std::vector<std::vector<Point2>>>& out) {
  for (model::Polygon& p : polygons) {
    std::vector<std::vector<Point2>> rings;
    rings.push_back(std::move(p.outer.points));
    for (model::Ring& hole : p.holes) rings.push_back(std::move(hole.points));
    out.push_back(std::move(rings));
  }
}

}  // namespace

ClaimFinder::ClaimFinder(const SurroundingInputs& inputs) : in_(inputs) {
  std::vector<PlanBox> boxes;
  const model::Extract& e = in_.extract;
  for (std::uint32_t f = 0; f < e.features.size(); ++f) {
    const model::Feature& feature = e.features[f];
    const TagOf tag = tags_of(f);
    if (feature.id.type == model::OsmType::node)
      if (const CrossingMarking marking = crossing_of(tag); marking != CrossingMarking::none)
        crossings_.emplace_back(feature.id.number, marking);
    if (feature.id.type == model::OsmType::node)
      if (const StreetControl control = control_of(tag); control.kind != ControlKind::none)
        controls_.emplace_back(feature.id.number, control);
    const std::optional<SurroundingKind> kind = kind_of(feature, tag, in_.catalogue);
    if (!kind) continue;
    Thing thing{f, *kind, hidden_state(feature, tag)};
    if (*kind == SurroundingKind::road || *kind == SurroundingKind::bridge || *kind == SurroundingKind::tunnel)
      thing.keeps_left = keeps_left(e, feature, tag, in_.catalogue);
    PlanBox box, degrees;
    for (const model::MappedRing& ring : e.rings_of(feature.rings))
      for (const model::Location at : e.vertices_of(ring)) {
        constexpr double kUnit = 1e-7;
        degrees.include(Point2{kUnit * at.lon, kUnit * at.lat});
        const Point2 p = in_.projection.forward(at);
        if (std::isfinite(p.x) && std::isfinite(p.y)) box.include(p);
      }
    thing.wide = feature.area && !degrees.empty() &&
                 std::max(degrees.maximum.x - degrees.minimum.x, degrees.maximum.y - degrees.minimum.y) > kWidest;
    if (const double reach = reach_of(*kind, feature, tag); reach > 0 && !box.empty()) {
      box.minimum = {box.minimum.x - reach, box.minimum.y - reach};
      box.maximum = {box.maximum.x + reach, box.maximum.y + reach};
    }
    const auto add_nodes = [&](std::vector<std::int64_t>& out) {
      for (const model::MappedRing& ring : e.rings_of(feature.rings)) {
        const auto nodes = e.nodes_of(ring);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          out.push_back(nodes[i]);
          if (i > 0 && i + 1 < nodes.size()) out.push_back(nodes[i]);
        }
      }
    };
    if ((*kind == SurroundingKind::road || *kind == SurroundingKind::bridge) && !feature.area && !thing.hidden)
      add_nodes(street_nodes_);
    if (*kind == SurroundingKind::railway && !feature.area && !thing.hidden && is_track(tag(osm_key::kRailway)))
      add_nodes(track_nodes_);
    if (has_wires(in_, thing) && !thing.hidden)
      for (const std::int64_t node : e.nodes_of(e.rings_of(feature.rings)[0]))
        wire_nodes_.emplace_back(node, static_cast<std::uint32_t>(things_.size()));
    if (*kind == SurroundingKind::bridge && !feature.area && feature.rings.count == 1) {
      const auto nodes = e.nodes_of(e.rings_of(feature.rings)[0]);
      if (nodes.size() >= 2)
        for (const std::int64_t node : {nodes.front(), nodes.back()})
          bridge_ends_.emplace_back(node, static_cast<std::uint32_t>(things_.size()));
    }
    if (feature.id.type == model::OsmType::node && !tag(osm_key::kBarrier).empty()) gates_.push_back(feature.id.number);
    if (is_coast(tag)) coasts_.push_back(static_cast<std::uint32_t>(things_.size()));
    things_.push_back(thing);
    boxes.push_back(box);
  }
  boxes_ = geometry::BoxIndex(std::move(boxes));
  std::ranges::sort(street_nodes_);
  std::ranges::sort(bridge_ends_);
  std::ranges::sort(gates_);
  std::ranges::sort(crossings_);
  std::ranges::sort(controls_, {}, &std::pair<std::int64_t, StreetControl>::first);
  std::ranges::sort(track_nodes_);
  std::ranges::sort(wire_nodes_);
  wire_nodes_.erase(std::unique(wire_nodes_.begin(), wire_nodes_.end()), wire_nodes_.end());
  boxes.clear();
  for (const context::Block& block : in_.context.blocks)
    boxes.push_back(block.gives_ratios() ? geometry::box_of(block.polygon.outer.points) : PlanBox{});
  blocks_ = geometry::BoxIndex(std::move(boxes));
  boxes.clear();
  for (const context::PassageWay& passage : in_.context.passages) boxes.push_back(geometry::box_of(passage.points));
  passages_ = geometry::BoxIndex(std::move(boxes));
}

TagOf ClaimFinder::tags_of(std::uint32_t feature) const {
  return [&e = in_.extract, range = in_.extract.features[feature].tags](std::string_view k) { return e.tag(range, k); };
}

bool ClaimFinder::is_closed(const model::Feature& feature) const {
  if (feature.area) return true;
  if (feature.rings.count != 1) return false;
  const auto nodes = in_.extract.nodes_of(in_.extract.rings_of(feature.rings)[0]);
  return nodes.size() > 3 && nodes.front() == nodes.back();
}

std::vector<std::vector<Point2>> ClaimFinder::lines_of(const Thing& thing) const {
  std::vector<std::vector<Point2>> out;
  const model::Feature& feature = in_.extract.features[thing.feature];
  for (const model::MappedRing& ring : in_.extract.rings_of(feature.rings)) {
    std::vector<Point2> line;
    for (const model::Location at : in_.extract.vertices_of(ring)) {
      const Point2 p = in_.projection.forward(at);
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
      const Point2 snapped = model::snap(p);
      if (line.empty() || line.back() != snapped) line.push_back(snapped);
    }
    if (!line.empty()) out.push_back(std::move(line));
  }
  return out;
}

bool ClaimFinder::claims_ground(const Thing& thing) const {
  using enum SurroundingKind;
  const model::Feature& feature = in_.extract.features[thing.feature];
  const TagOf tag = tags_of(thing.feature);
  if (feature.area) return thing.kind != bridge && in_.catalogue.ground_of(tag) != nullptr;
  if (thing.kind == road) return street_profile(tag, true, in_.catalogue, false).has_value();
  if (thing.kind == railway) return is_track(tag(osm_key::kRailway));
  return thing.kind == water && (usual_width(tag(osm_key::kWaterway)) > 0 || is_coast(tag));
}

std::vector<std::vector<Point2>> ClaimFinder::judged_pieces(const std::vector<Point2>& line) {
  std::vector<std::vector<Point2>> out;
  std::vector<Point2> piece;
  double length = 0;
  for (const Point2 p : line) {
    if (!piece.empty()) {
      const Point2 from = piece.back();
      const double own = std::hypot(p.x - from.x, p.y - from.y);
      const double cuts = std::min(std::floor((length + own) / kJudgedPiece), kMostCuts);
      for (double c = 1; c <= cuts; ++c) {
        const double s = c * kJudgedPiece - length;
        if (s <= 0 || s >= own) continue;
        piece.push_back(model::snap(Point2{from.x + s / own * (p.x - from.x), from.y + s / own * (p.y - from.y)}));
        out.push_back(piece);
        piece = {piece.back()};
      }
      length = cuts > 0 ? (length + own) - cuts * kJudgedPiece : length + own;
    }
    piece.push_back(p);
  }
  if (piece.size() >= 2) out.push_back(piece);
  return out;
}

bool ClaimFinder::is_built_up(std::span<const Point2> line) const {
  // A house every 60 m of the line, on either side.
  const std::size_t wanted = 1 + static_cast<std::size_t>(surroundings_length(line) / 60);
  std::size_t found = 0;
  for (std::size_t i = 1; i < line.size() && found < wanted; ++i) {
    PlanBox box;
    box.include(line[i - 1]), box.include(line[i]);
    found += in_.vicinity.buildings_near(box, kBuiltUpReach).size();
  }
  return found >= wanted;
}

void ClaimFinder::add_street(const Thing& thing, const PlanBox& box, std::vector<Entry>& out) const {
  const model::Feature& feature = in_.extract.features[thing.feature];
  const TagOf tag = tags_of(thing.feature);
  const auto rings = in_.extract.rings_of(feature.rings);
  const std::vector<std::vector<Point2>> lines = lines_of(thing);
  for (std::size_t l = 0; l < lines.size() && l < rings.size(); ++l) {
    const std::vector<Point2>& line = lines[l];
    if (line.size() < 2) continue;
    const auto nodes = in_.extract.nodes_of(rings[l]);
    const auto end = [&](std::int64_t node) {
      // At a junction of three, what lies beside a carriageway would reach into the others.
      return streets_at(node) > 2 ? geometry::LineEnd::flat : geometry::LineEnd::round;
    };
    // What stands around is asked piece by piece: a way may be long, and what a place looks like depends on what is near.
    for (const std::vector<Point2>& piece : judged_pieces(line)) {
      if (!geometry::box_of(piece).near(box, kStreetReach)) continue;
      add_street_piece(thing, tag, piece, piece.front() == line.front() ? end(nodes.front()) : geometry::LineEnd::round,
                       piece.back() == line.back() ? end(nodes.back()) : geometry::LineEnd::round, out);
    }
  }
}

void ClaimFinder::add_street_piece(const Thing& thing, const TagOf& tag, const std::vector<Point2>& line,
                                   geometry::LineEnd start, geometry::LineEnd end, std::vector<Entry>& out) const {
  const std::optional<StreetProfile> profile = street_profile(tag, is_built_up(line), in_.catalogue, thing.keeps_left);
  if (!profile) return;
  const model::OsmId id = in_.extract.features[thing.feature].id;
  // Strips of a class on both sides are one claim from the far side of the one to that of the other: what lies between them
  // is stronger.
  struct Reach {
    const StreetStrip* strip = nullptr;
    double left = 0, right = 0;
    bool beyond = false;  ///< what a pavement has beyond its width where nothing is mapped
  };
  std::vector<Reach> reaches;
  for (const StreetStrip& strip : profile->strips) {
    auto known = std::ranges::find_if(reaches, [&](const Reach& r) {
      return r.strip->ground == strip.ground && r.strip->material == strip.material;
    });
    if (known == reaches.end()) known = reaches.insert(known, {&strip, 0, 0, false});
    known->left = std::max(known->left, -strip.left), known->right = std::max(known->right, strip.right);
  }
  // Pavements reach up to kForecourt farther where nothing is mapped: mostly to a house, with a strip of land before it otherwise. A width
  // that is told of a footway holds.
  const bool told = profile->carriageway_left == profile->carriageway_right && !tag(osm_key::kWidth).empty();
  std::vector<Reach> claims = reaches;
  for (Reach forecourt : reaches) {
    if (told || forecourt.strip->ground != GroundClass::pavement) continue;
    if (forecourt.left > 0) forecourt.left += kForecourt;
    if (forecourt.right > 0) forecourt.right += kForecourt;
    forecourt.beyond = true;
    claims.push_back(forecourt);
  }
  for (const Reach& reach : claims) {
    if (reach.left <= 0 && reach.right <= 0) continue;
    const GroundClass ground = reach.strip->ground;
    const bool is_lane = ground == GroundClass::carriageway || ground == GroundClass::parking_lane;
    std::vector<std::vector<std::vector<Point2>>> polygons;
    add_polygons(geometry::line_area(line, reach.left, reach.right, is_lane ? geometry::LineEnd::round : start,
                                     is_lane ? geometry::LineEnd::round : end),
                 polygons);
    for (auto& rings_of_polygon : polygons) {
      Entry entry;
      entry.rank = rank_of(ground);
      entry.strength = strength_of(tag(osm_key::kHighway)) + 1e-3 * (reach.left + reach.right);
      if (reach.beyond) entry.rank = kForecourtRank;
      // A crossing is that of a carriageway: it does not reach into the pavements beside.
      if (ground == GroundClass::footway && tag(osm_key::kFootway) == "crossing")
        entry.rank = rank_of(GroundClass::pavement), entry.strength = -1;
      entry.label = {.ground = ground,
                     .object = id,
                     .material = reach.strip->material,
                     .offset = is_lane && profile->kerbed ? -kKerb : 0};
      entry.rings = std::move(rings_of_polygon);
      out.push_back(std::move(entry));
    }
  }
}

void ClaimFinder::add_railway(const Thing& thing, std::vector<Entry>& out) const {
  const TagOf tag = tags_of(thing.feature);
  const std::string_view kind = tag(osm_key::kRailway);
  const bool tram = kind == "tram";
  if (!is_track(kind)) return;
  for (const std::vector<Point2>& line : lines_of(thing)) {
    if (line.size() < 2) continue;
    const double half = (tram ? kTramBed : kTrackBed) / 2;
    std::vector<std::vector<std::vector<Point2>>> polygons;
    add_polygons(geometry::line_area(line, half, half, geometry::LineEnd::round, geometry::LineEnd::round), polygons);
    for (auto& rings : polygons) {
      Entry entry;
      entry.rank = rank_of(GroundClass::rail_bed);
      entry.strength = tram ? 0 : 1;
      const std::string_view surface = tag(osm_key::kSurface);
      entry.label = {
          .ground = GroundClass::rail_bed,
          .object = in_.extract.features[thing.feature].id,
          .material = in_.catalogue.surface(surface).value_or(in_.catalogue.material(tram ? "gravel" : "ballast"))};
      entry.rings = std::move(rings);
      out.push_back(std::move(entry));
    }
  }
}

void ClaimFinder::add_waterway(const Thing& thing, std::vector<Entry>& out) const {
  const TagOf tag = tags_of(thing.feature);
  const std::string_view kind = tag(osm_key::kWaterway);
  const double usual = usual_width(kind);
  if (usual == 0) return;
  const std::optional<double> tagged = length_of(tag(osm_key::kWidth));
  const double half = (tagged && *tagged > 0.2 && *tagged < 500 ? *tagged : usual) / 2;
  for (const std::vector<Point2>& line : lines_of(thing)) {
    if (line.size() < 2) continue;
    std::vector<std::vector<std::vector<Point2>>> polygons;
    add_polygons(geometry::line_area(line, half, half, geometry::LineEnd::round, geometry::LineEnd::round), polygons);
    for (auto& rings : polygons) {
      Entry entry;
      entry.rank = rank_of(GroundClass::water);
      entry.label = {.ground = GroundClass::water,
                     .object = in_.extract.features[thing.feature].id,
                     .material = in_.catalogue.material("water"),
                     .offset = -std::min(kBank, static_cast<float>(half))};
      entry.rings = std::move(rings);
      out.push_back(std::move(entry));
    }
  }
}

void ClaimFinder::add_area(const Thing& thing, std::vector<Entry>& out) const {
  const TagOf tag = tags_of(thing.feature);
  const GroundRule* rule = in_.catalogue.ground_of(tag);
  if (rule == nullptr) return;
  Entry entry;
  entry.rank = rank_of(rule->ground);
  const std::string_view surface = tag(osm_key::kSurface);
  const auto tagged = surface.empty() ? std::nullopt : in_.catalogue.surface(surface);
  entry.label = {.ground = rule->ground,
                 .object = in_.extract.features[thing.feature].id,
                 .material = tagged.value_or(in_.catalogue.material(rule->material)),
                 .trees_per_hectare = static_cast<float>(rule->trees_per_hectare),
                 .wide = thing.wide};
  if (rule->ground == GroundClass::water) entry.label.offset = -kBank;
  // Of area:highway the value is the class of its street.
  const std::string_view street = tag(osm_key::kAreaHighway);
  if (rule->kerbed || (rule->ground == GroundClass::carriageway &&
                       in_.catalogue.street(street.empty() ? "residential" : street).kerbed))
    entry.label.offset = -kKerb;
  if (rule->ground == GroundClass::swimming_pool) entry.label.offset = -0.1f;
  double area = 0;
  for (std::vector<Point2>& ring : lines_of(thing)) {
    ring = without_repeat(std::move(ring));
    if (ring.size() < 3) continue;
    area += std::fabs(geometry::signed_area(ring));
    entry.rings.push_back(std::move(ring));
  }
  if (entry.rings.empty()) return;
  entry.strength = -area;  // what is smaller was drawn with more care
  out.push_back(std::move(entry));
}

void ClaimFinder::add_passages(const PlanBox& box, std::vector<Entry>& out) const {
  for (const std::uint32_t p : passages_.near(box, context::kMaxPassageWidth)) {
    const context::PassageWay& passage = in_.context.passages[p];
    std::vector<std::vector<std::vector<Point2>>> polygons;
    add_polygons(geometry::line_area(passage.points, passage.width / 2, passage.width / 2, geometry::LineEnd::flat,
                                     geometry::LineEnd::flat),
                 polygons);
    for (auto& rings : polygons) {
      Entry entry;
      entry.rank = kPassageRank;
      entry.label = {
          .ground = GroundClass::passage, .object = passage.id, .material = in_.catalogue.material("paving_stones")};
      entry.rings = std::move(rings);
      out.push_back(std::move(entry));
    }
  }
}

void ClaimFinder::add_buildings(const PlanBox& box, std::vector<Entry>& out) const {
  for (const std::uint32_t number : in_.vicinity.buildings_near(box, 0)) {
    const footprints::StoredFootprint& stored = in_.footprints[number];
    if (stored.level.canopy || stored.level.low > 0 || stored.settled != model::ObjectState::pending) continue;
    Entry entry;
    entry.rank = kBuildingRank;
    entry.label.building = true;
    in_.footprints.for_each_ring(
        number, [&](std::span<const Point2> ring, bool) { entry.rings.emplace_back(ring.begin(), ring.end()); });
    out.push_back(std::move(entry));
  }
}

void ClaimFinder::add_blocks(const PlanBox& box, std::vector<Entry>& out) const {
  for (const std::uint32_t b : blocks_.near(box, 0)) {
    const context::Block& block = in_.context.blocks[b];
    const double built = in_.context.figures[b].built_share.value_or(0);
    Entry entry;
    entry.rank = kBlockRank;
    const bool paved = built >= kPavedShare, garden = built >= kGardenShare;
    if (!garden) continue;
    entry.label = {.ground = paved ? GroundClass::yard : GroundClass::garden,
                   .object = {},
                   .material = in_.catalogue.material(paved ? "yard" : "garden")};
    entry.rings.push_back(block.polygon.outer.points);
    for (const model::Ring& hole : block.polygon.holes) entry.rings.push_back(hole.points);
    out.push_back(std::move(entry));
  }
}

/// The sea lies on the right of coasts. It is weaker than all that is mapped: quays and piers stand in it.
void ClaimFinder::add_sea(const PlanBox& box, std::vector<Entry>& out) const {
  Entry entry;
  entry.rank = kSeaRank, entry.sea = true;
  entry.label = {
      .ground = GroundClass::water, .object = {}, .material = in_.catalogue.material("water"), .offset = -kBank};
  for (const std::uint32_t t : coasts_) {
    if (!boxes_.box(t).near(box, geometry::kCoastReach)) continue;
    for (std::vector<Point2>& line : lines_of(things_[t]))
      if (line.size() >= 2) entry.rings.push_back(std::move(line));
  }
  if (!entry.rings.empty()) out.push_back(std::move(entry));
}

GroundClaims ClaimFinder::claims_in(const PlanBox& box) const {
  std::vector<Entry> entries;
  add_passages(box, entries);
  add_buildings(box, entries);
  for (const std::uint32_t t : boxes_.near(box, 0)) {
    const Thing& thing = things_[t];
    if (thing.hidden) continue;
    const model::Feature& feature = in_.extract.features[thing.feature];
    const TagOf tag = tags_of(thing.feature);
    switch (thing.kind) {
      case SurroundingKind::road:
        if (feature.is(FeatureKind::passage)) break;  // add_passages
        if (feature.area) {
          add_area(thing, entries);
        } else {
          add_street(thing, box, entries);
        }
        break;
      case SurroundingKind::railway:
        if (feature.area) {
          add_area(thing, entries);
        } else {
          add_railway(thing, entries);
        }
        break;
      case SurroundingKind::water:
        if (feature.area) {
          add_area(thing, entries);
        } else {
          add_waterway(thing, entries);
        }
        break;
      case SurroundingKind::barrier:
        // A fence around a garden is often mapped as one with it.
        if (is_closed(feature)) add_area(thing, entries);
        break;
      case SurroundingKind::bridge:
      case SurroundingKind::tunnel:
      case SurroundingKind::tree:
      case SurroundingKind::cliff:
      case SurroundingKind::power:
      case SurroundingKind::wind_turbine:
      case SurroundingKind::mast:
      case SurroundingKind::aerialway:
      case SurroundingKind::traffic_sign:
        break;
      case SurroundingKind::aeroway:
      case SurroundingKind::parking:
      case SurroundingKind::bicycle_parking:
      case SurroundingKind::pool:
      case SurroundingKind::golf:
      case SurroundingKind::pitch:
      case SurroundingKind::surface_area:
      case SurroundingKind::street_furniture:
      case SurroundingKind::other:
        if (feature.area) add_area(thing, entries);
        break;
    }
  }
  add_sea(box, entries);
  add_blocks(box, entries);
  std::ranges::stable_sort(entries, [](const Entry& a, const Entry& b) {
    return std::tuple(a.rank, -a.strength, a.label.object) < std::tuple(b.rank, -b.strength, b.label.object);
  });
  GroundClaims out;
  for (Entry& entry : entries) {
    const auto same = [&](const GroundLabel& l) {
      return l.building == entry.label.building && l.ground == entry.label.ground && l.object == entry.label.object &&
             l.material == entry.label.material && l.offset == entry.label.offset;
    };
    // Claims of one label follow each other, but for strips on both sides of a street.
    std::size_t label = out.labels.size();
    for (std::size_t back = 1; back <= std::min<std::size_t>(out.labels.size(), 4); ++back)
      if (same(out.labels[out.labels.size() - back])) label = out.labels.size() - back;
    if (label == out.labels.size()) out.labels.push_back(entry.label);
    geometry::AreaClaim claim;
    claim.label = static_cast<std::uint32_t>(label);
    for (const auto& ring : entry.rings)
      for (const Point2 p : ring) claim.box.include(p);
    claim.rings = std::move(entry.rings);
    claim.right_of_lines = entry.sea;
    out.claims.push_back(std::move(claim));
  }
  return out;
}

}  // namespace blockrand::surroundings
