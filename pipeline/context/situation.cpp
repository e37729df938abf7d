#include "pipeline/context/situation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "pipeline/base/portable_math.h"
#include "pipeline/context/wall_samples.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::context {

namespace {

using model::BuildingPosition;
using model::Point2;
using model::WallSegment;
using model::WallSegmentKind;

constexpr double kMaxChamfer = 8;       ///< m. Longer walls between two streets are fronts of their own
constexpr double kMaxRounding = 20;     ///< m. The same along a mapped curve: radii up to 12 m
constexpr double kMinCutSine = 0.26;    ///< sine of 15 degrees, and
constexpr double kMinCutCosine = 0.34;  ///< cosine of 70 degrees: how far a chamfer is turned from its neighbours
constexpr double kCornerSine = 0.5;     ///< sine of 30 degrees: the least turn of a street corner
constexpr double kMinCornerFront = 2;   ///< m. Fronts that meet at a corner are at least this long
constexpr double kMinPartyWall = 1.5;   ///< m. Shorter ones tie no row together
constexpr double kMaxWingDepth = 12;    ///< m. Side wings have rooms on one side only
constexpr double kMinWingLength = 1.5;  ///< times the depth
constexpr double kSidewards = 0.5;      ///< cosine of 60 degrees: party walls that look left or right of the front
constexpr double kSetbackReach = 40;    ///< m to both sides: whose fronts make the building line
constexpr double kSetbackStep = 8;      ///< m between places where it is looked for: a narrow house

/// Finds the outline edge of a wall segment.
class Edges {
 public:
  explicit Edges(const std::vector<OutlineEdge>& outline) : outline_(outline) {
    for (std::size_t i = 0; i < outline.size(); ++i)
      if (outline[i].edge == 0) first_[{outline[i].polygon, outline[i].ring}] = i;
  }
  const OutlineEdge& operator[](const WallSegment& f) const {
    return outline_[first_.at({f.polygon, f.ring}) + f.edge];
  }

 private:
  const std::vector<OutlineEdge>& outline_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> first_;
};

bool same_street(const WallSegment& a, const WallSegment& b) {
  return a.street_name.empty() && b.street_name.empty() ? a.street == b.street : a.street_name == b.street_name;
}

/// Wall segments of one ring: [first, last) of Building::edges.
template <class Visit>
void for_each_ring(const std::vector<WallSegment>& edges, Visit&& visit) {
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t last = first;
    while (last < edges.size() && edges[last].polygon == edges[first].polygon && edges[last].ring == edges[first].ring)
      ++last;
    visit(first, last);
    first = last;
  }
}

// ---- fronts ---------------------------------------------------------------------------------------------------------

/// The street of the building's address: its own, else what most addresses on it name (ties: the first name).
std::string address_of(const model::Building& building, const VicinityIndex& index, std::string_view own) {
  if (!own.empty()) return std::string(own);
  std::map<std::string, int> votes;
  for (const std::uint32_t p : index.points_near(box_of(building, 0.5))) {
    const SitePoint& point = index.all().points[p];
    if (point.kind == SitePointKind::tree || point.kind == SitePointKind::shop || point.street.empty()) continue;
    if (std::any_of(building.outline.begin(), building.outline.end(),
                    [&](const model::Polygon& polygon) { return geometry::contains(polygon, point.place); }))
      ++votes[point.street];
  }
  std::string best;
  int most = 0;
  for (const auto& [street, count] : votes)
    if (count > most) {
      most = count;
      best = street;
    }
  return best;
}

/// Street wall segments: those of the main front first, each group the longest first. `main` tells how many are the main front.
std::vector<std::uint32_t> fronts_of(const model::Building& building, std::string_view address, std::size_t& main) {
  const std::vector<WallSegment>& edges = building.edges;
  struct Street {
    std::vector<std::uint32_t> wall_segments;
    double length = 0;
    bool addressed = false;
  };
  std::vector<Street> streets;
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    if (edges[i].kind != WallSegmentKind::street || edges[i].chamfer) continue;
    auto street = std::find_if(streets.begin(), streets.end(),
                               [&](const Street& s) { return same_street(edges[s.wall_segments[0]], edges[i]); });
    if (street == streets.end()) {
      streets.push_back({{}, 0, !address.empty() && edges[i].street_name == address});
      street = streets.end() - 1;
    }
    street->wall_segments.push_back(i);
    street->length += edges[i].length();
  }
  std::sort(streets.begin(), streets.end(), [&](const Street& a, const Street& b) {
    const WallSegment &x = edges[a.wall_segments[0]], &y = edges[b.wall_segments[0]];
    return std::tuple(!a.addressed, -a.length, std::string_view(x.street_name), x.street) <
           std::tuple(!b.addressed, -b.length, std::string_view(y.street_name), y.street);
  });
  std::vector<std::uint32_t> out;
  main = streets.empty() ? 0 : streets[0].wall_segments.size();
  for (Street& street : streets) {
    std::sort(street.wall_segments.begin(), street.wall_segments.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(-edges[a].length(), a) < std::pair(-edges[b].length(), b);
    });
    out.insert(out.end(), street.wall_segments.begin(), street.wall_segments.end());
  }
  return out;
}

/// Where the main front looks: mean of the normals by length, among those within 60 degrees of the longest wall segment.
Point2 outlook(const model::Building& building, const Edges& outline, std::span<const std::uint32_t> front) {
  const Point2 main = outline[building.edges[front[0]]].outward;
  Point2 sum;
  for (const std::uint32_t f : front) {
    const Point2 n = outline[building.edges[f]].outward;
    if (dot(n, main) < kSidewards) continue;
    sum.x += n.x * building.edges[f].length();
    sum.y += n.y * building.edges[f].length();
  }
  const double length = std::sqrt(dot(sum, sum));
  return {sum.x / length, sum.y / length};
}

double extent(const model::Building& building, Point2 direction) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const model::Polygon& polygon : building.outline) {
    const geometry::Extent e = geometry::extent_along(polygon.outer.points, direction);
    low = std::min(low, e.minimum);
    high = std::max(high, e.maximum);
  }
  return high - low;
}

/// m that a front stands behind the building line: the lower quartile of where walls stand along its street.
std::optional<double> setback_of(const WallSegment& front, const OutlineEdge& edge, const VicinityIndex& index) {
  if (front.street_distance <= 0) return std::nullopt;
  const Point2 middle = edge.at((front.start + front.end) / 2);
  // From the street's line, straight back at the front and at its neighbours.
  const Scene& scene = index.scene();
  constexpr double kBefore = 0.02;  // m; clear of the wall's own rounding
  const Point2 eye{middle.x + edge.outward.x * kBefore, middle.y + edge.outward.y * kBefore};
  const double own = scene.look(eye, edge.outward, kWallSegmentReach / 2).street;
  if (!std::isfinite(own)) return std::nullopt;
  std::vector<double> depths{own};
  for (const int side : {-1, 1})
    for (double along = kSetbackStep; along <= kSetbackReach; along += kSetbackStep) {
      const Point2 place{middle.x + edge.outward.x * own + side * edge.along.x * along,
                         middle.y + edge.outward.y * own + side * edge.along.y * along};
      const Sight back = scene.look(place, {-edge.outward.x, -edge.outward.y}, own + kSetbackStep);
      if (std::isfinite(back.wall) && !back.from_inside) depths.push_back(back.wall);
    }
  std::sort(depths.begin(), depths.end());
  return std::max(0.0, own - depths[(depths.size() - 1) / 4]);
}

// ---- position -------------------------------------------------------------------------------------------------------

double area_of(model::OsmId id, const VicinityIndex& index) {
  const auto& all = index.all().footprints;
  double area = 0;
  for (auto f =
           std::lower_bound(all.begin(), all.end(), id, [](const Footprint&a, model::OsmId i) { return a.id < i; });
       f != all.end() && f->id == id; ++f)
    area += geometry::area(f->polygon);
  return area;
}

/// Party walls, m, by where they look from the front (or from the long axis): ahead, left, behind, right.
struct PartyWalls {
  double left = 0, right = 0, across = 0;
};
PartyWalls party_walls(const model::Building& building, const Edges& outline, Point2 ahead) {
  PartyWalls out;
  for (const WallSegment& f : building.edges) {
    if (f.kind != WallSegmentKind::party_wall || f.outbuilding) continue;
    const double side = cross(ahead, outline[f].outward);
    (side > kSidewards ? out.left : side < -kSidewards ? out.right : out.across) += f.length();
  }
  return out;
}

/// Marks party walls with neighbours that are too small for houses.
void mark_outbuildings(model::Building& building, const VicinityIndex& index) {
  std::map<model::OsmId, bool> small;
  for (WallSegment& f : building.edges) {
    if (f.kind != WallSegmentKind::party_wall) continue;
    const auto [known, fresh] = small.try_emplace(f.neighbour, false);
    if (fresh) known->second = area_of(f.neighbour, index) < kOutbuildingArea;
    f.outbuilding = known->second;
  }
}

BuildingPosition position_of(const model::Building& building, const Edges& outline, Point2 ahead, bool has_front) {
  const PartyWalls walls = party_walls(building, outline, ahead);
  if (has_front) {
    const bool corner = std::any_of(building.edges.begin(), building.edges.end(),
                                    [](const WallSegment& f) { return f.corner_start || f.corner_end; });
    if (corner) return BuildingPosition::corner_house;
    const int sides = (walls.left >= kMinPartyWall) + (walls.right >= kMinPartyWall);
    if (sides == 2) return BuildingPosition::mid_row;
    return sides == 1 || walls.across >= kMinPartyWall ? BuildingPosition::end_of_row : BuildingPosition::free_standing;
  }
  const bool tied = walls.left >= kMinPartyWall || walls.right >= kMinPartyWall || walls.across >= kMinPartyWall;
  const bool at_court = std::any_of(building.edges.begin(), building.edges.end(),
                                    [](const WallSegment& f) { return f.kind == WallSegmentKind::courtyard; });
  if (!tied) return at_court ? BuildingPosition::rear_building : BuildingPosition::free_standing;
  // `ahead` is the long axis here: its ends look across, its long sides left and right.
  const double depth = extent(building, {-ahead.y, ahead.x}), length = extent(building, ahead);
  const bool one_side = walls.left < length / 2 || walls.right < length / 2;
  if (walls.across >= kMinPartyWall && one_side && depth <= kMaxWingDepth && length >= kMinWingLength * depth)
    return BuildingPosition::side_wing;
  return BuildingPosition::rear_building;
}

// ---- block and courtyards -------------------------------------------------------------------------------------------

bool meets_border(const Block& block, const VicinityIndex::Box& box) {
  const auto meets = [&](const model::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring.points[i], b = ring.points[(i + 1) % ring.size()];
      if (std::min(a.x, b.x) <= box.high.x && box.low.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= box.high.y &&
          box.low.y <= std::max(a.y, b.y))
        return true;
    }
    return false;
  };
  return meets(block.polygon.outer) || std::any_of(block.polygon.holes.begin(), block.polygon.holes.end(), meets);
}

/// The block that holds more than half of the building (as measure_blocks), or empty.
std::string block_of(const model::Building& building, const VicinityIndex& index) {
  const VicinityIndex::Box box = box_of(building, 0);
  const std::span<const Block> blocks = index.all().blocks;
  double area = 0;
  for (const model::Polygon& polygon : building.outline) area += geometry::area(polygon);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (!index.block_box(b).meets(box)) continue;
    if (!meets_border(blocks[b], box)) {
      if (geometry::contains(blocks[b].polygon, building.outline[0].outer.points[0])) return blocks[b].id;
      continue;
    }
    double held = 0;
    for (const model::Polygon& polygon : building.outline) held += area_within(polygon, blocks[b].polygon);
    if (2 * held > area) return blocks[b].id;
  }
  return {};
}

/// Ids of the courtyards before walls of the building, ascending.
std::vector<std::string> courtyards_of(const model::Building& building, const Edges& outline,
                                       const VicinityIndex& index) {
  std::vector<std::string> out;
  const std::vector<std::uint32_t> near = index.yards_near(box_of(building, 1));
  if (near.empty()) return out;
  const geometry::BoxIndex boxes = yard_boxes(near, index);
  std::set<std::uint32_t> found;
  constexpr double kBefore = 0.45;  // m; walls and yards are mapped that well
  for (const WallSegment& f : building.edges) {
    if (f.kind == WallSegmentKind::party_wall || f.kind == WallSegmentKind::street) continue;
    const OutlineEdge& edge = outline[f];
    const Point2 wall = edge.at((f.start + f.end) / 2);
    const Point2 p{wall.x + edge.outward.x * kBefore, wall.y + edge.outward.y * kBefore};
    for (const std::uint32_t n : boxes.near({p, p}, 0))
      if (!found.contains(near[n]) && geometry::contains(index.courtyard(index.yards()[near[n]]).polygon, p))
        found.insert(near[n]);
  }
  for (const std::uint32_t y : found) out.push_back(index.courtyard(index.yards()[y]).id);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

void mark_corners(model::Building& building, const std::vector<OutlineEdge>& outline) {
  const Edges of(outline);
  std::vector<WallSegment>& edges = building.edges;
  for_each_ring(edges, [&](std::size_t first, std::size_t last) {
    const std::size_t n = last - first;
    const auto at = [&](std::size_t i) -> WallSegment& { return edges[first + i % n]; };
    // A short wall between two others, turned outwards from both, but by less than a right angle.
    const auto is_cut = [&](std::size_t i) {
      const WallSegment &b = at(i + n - 1), &c = at(i), &d = at(i + 1);
      if (n < 4 || c.length() > kMaxChamfer || c.kind != WallSegmentKind::street || b.kind != WallSegmentKind::street ||
          d.kind != WallSegmentKind::street)
        return false;
      const auto turns = [&](const WallSegment& p, const WallSegment& q) {
        return cross(of[p].along, of[q].along) > kMinCutSine && dot(of[p].along, of[q].along) > kMinCutCosine;
      };
      return turns(b, c) && turns(c, d);
    };
    for (std::size_t i = 0; i < n; ++i) {
      WallSegment& a = at(i);
      if (a.kind != WallSegmentKind::street || a.length() < kMinCornerFront || is_cut(i)) continue;
      // Over cuts and short wall segments of street to the next that looks at another one.
      double between = 0;
      bool curved = false;
      for (std::size_t k = 1; k < n; ++k) {
        WallSegment& b = at(i + k);
        if (b.kind != WallSegmentKind::street) break;
        if (b.length() >= kMinCornerFront && !is_cut(i + k)) {
          if (same_street(a, b) || cross(of[a].along, of[b].along) <= kCornerSine) break;
          a.corner_end = b.corner_start = true;
          for (std::size_t c = 1; c < k; ++c) at(i + c).chamfer = is_cut(i + c) || at(i + c).arc >= 0;
          break;
        }
        between += b.length();
        curved = curved || b.arc >= 0;
        if (between > (curved ? kMaxRounding : kMaxChamfer)) break;
      }
    }
  });
}

void describe_situation(model::Building& building, const std::vector<OutlineEdge>& outline, const VicinityIndex& index,
                        std::string_view address_street) {
  model::BuildingSituation& s = building.situation;
  s = {};
  if (building.edges.empty()) return;
  const Edges of(outline);
  std::size_t main = 0;
  s.fronts = fronts_of(building, address_of(building, index, address_street), main);
  Point2 ahead;
  if (!s.fronts.empty()) {
    ahead = outlook(building, of, std::span(s.fronts).first(main));
    const double degrees = base::atan2(ahead.x, ahead.y) * base::kDegreesPerRadian;
    s.orientation = degrees < 0 ? degrees + 360 : degrees;
    s.depth = extent(building, ahead);
    s.width = extent(building, {-ahead.y, ahead.x});
    const WallSegment& front = building.edges[s.fronts[0]];
    s.setback = setback_of(front, of[front], index);
  } else {
    ahead = geometry::long_axis(building.outline[0].outer.points);
    s.depth = extent(building, {-ahead.y, ahead.x});
    s.width = extent(building, ahead);
    if (*s.depth > *s.width) std::swap(s.depth, s.width);
  }
  for (const WallSegment& f : building.edges)
    if (f.kind == WallSegmentKind::party_wall) s.party_wall_length += f.length();
  mark_outbuildings(building, index);
  s.position = position_of(building, of, ahead, !s.fronts.empty());
  s.block = block_of(building, index);
  s.courtyards = courtyards_of(building, of, index);
}

}  // namespace blockrand::context
