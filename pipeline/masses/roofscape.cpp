#include "pipeline/masses/roofscape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

#include "pipeline/attributes/roof_edges.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/model/vector.h"

namespace blockrand::masses {

namespace {

using model::BuildingPart;
using model::Face;
using model::Point2;
using model::Point3;
using model::RoofEdge;
using model::Solid;
using model::SurfaceKind;

constexpr double kLeastFall = 0.03;  ///< rise over run: flatter faces drain nowhere in particular
constexpr double kOverEdge = 0.5;    ///< cosine of 60 degrees: water that runs more along an edge than over it
constexpr double kLevel = 0.1;       ///< rise over run: eaves are level, to what a bay's plane leaves of that
constexpr double kMost = 0.5;        ///< of a front
constexpr double kRearShare = 0.75;  ///< of a facade that looks away from the street: wings stand against its eaves
constexpr double kLooksAway = -0.68199836006249850;  ///< cosine of 133 degrees
constexpr double kSameFacade = 0.97814760073380569;  ///< cosine of 12 degrees
constexpr double kFacadeDepth = 2.5;                 ///< m, of what belongs to one facade
constexpr double kEavesZone = 1.5;        ///< m above the lowest wall top: a level wall top higher up is no eaves
constexpr double kLeastPartyEaves = 1.0;  ///< m. Shorter ones are corners
constexpr double kReturn = 2.5;      ///< m. Shorter party walls are returns of a fire wall: the roof runs on over them.
constexpr double kLeastFront = 3.0;  ///< m of front on each street of a corner house
constexpr double kOtherStreet = 0.86602540378443865;  ///< cosine of 30 degrees
constexpr double kRear = -0.5;                        ///< cosine against the front of what looks to the rear

// Which slopes should meet.
constexpr double kSameHeight = 0.02;        ///< m
constexpr double kSameDirection = 0.99985;  ///< cosine of 1 degree
constexpr double kSamePitch = 0.001;        ///< rise over run: 1 cm over 10 m

Point2 unit(Point2 a) {
  const double l = std::sqrt(dot(a, a));
  return l > 0 ? Point2{a.x / l, a.y / l} : Point2{};
}

/// A wall of the solid with what the roof does above it.
struct Wall {
  Point2 from, to;          ///< along the plan's ring
  std::vector<Point3> top;  ///< from `from` to `to`
  RoofEdge kind = RoofEdge::open;
  double length = 0, eaves = 0;  ///< m; of which water runs over it
  Point2 outwards() const { return unit({to.y - from.y, from.x - to.x}); }
};

class House {
 public:
  House(const model::Building& building, const BuildingPart& part) : building_(building), part_(part) { find_walls(); }

  const std::vector<Wall>& walls() const { return walls_; }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) { return static_cast<std::uint64_t>(a) << 32 | b; }

  /// Down the slope of a roof face, as long as its fall: rise over run.
  std::optional<Point2> fall(const Face& face) const {
    const Solid& s = part_.lod2;
    const auto loop = s.indices_of(s.loops[face.first_loop]);
    double nx = 0, ny = 0, nz = 0;
    const Point3 o = s.vertices[loop[0]];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point3 p = s.vertices[loop[i]], q = s.vertices[loop[(i + 1) % loop.size()]];
      nx += (p.y - o.y) * (q.z - o.z) - (p.z - o.z) * (q.y - o.y);
      ny += (p.z - o.z) * (q.x - o.x) - (p.x - o.x) * (q.z - o.z);
      nz += (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
    }
    if (nz <= 0) return std::nullopt;
    return Point2{nx / nz, ny / nz};
  }

  void find_walls() {
    const Solid& s = part_.lod2;
    std::unordered_map<std::uint64_t, std::uint32_t> above;  // arcs of roof faces
    for (std::uint32_t f = 0; f < s.faces.size(); ++f) {
      if (s.faces[f].kind != SurfaceKind::roof) continue;
      for (const Solid::Loop& l : s.loops_of(s.faces[f])) {
        const auto loop = s.indices_of(l);
        for (std::size_t i = 0; i < loop.size(); ++i) above[key(loop[i], loop[(i + 1) % loop.size()])] = f;
      }
    }
    const attributes::OutlineSegments segments(building_);
    for (const Face& face : s.faces) {
      if (face.kind != SurfaceKind::wall || face.edge < 0) continue;
      const auto loop = s.indices_of(s.loops[face.first_loop]);
      // The base runs from corner to corner; the top follows, back to the first corner.
      if (loop.size() < 4) continue;
      Wall w;
      w.from = s.vertices[loop[0]].xy();
      w.to = s.vertices[loop[1]].xy();
      w.length = distance(w.to, w.from);
      w.kind = segments.kind(w.from, w.to);
      const Point2 out = w.outwards();
      for (std::size_t i = loop.size(); i-- > 2;) {
        w.top.push_back(s.vertices[loop[i]]);
        if (i == 2) break;
        const auto found = above.find(key(loop[i], loop[i - 1]));
        if (found == above.end()) continue;
        const auto down = fall(s.faces[found->second]);
        if (!down) continue;
        const double steep = std::sqrt(dot(*down, *down));
        if (steep < kLeastFall || dot(*down, out) < kOverEdge * steep) continue;
        const Point3 p = s.vertices[loop[i]], q = s.vertices[loop[i - 1]];
        const double length = distance(q.xy(), p.xy());
        if (std::fabs(q.z - p.z) > kLevel * length) continue;  // water runs along it
        w.eaves += length;
      }
      walls_.push_back(std::move(w));
    }
    double lowest = std::numeric_limits<double>::infinity();
    for (const Wall& w : walls_) lowest = std::min({lowest, w.top.front().z, w.top.back().z});
    for (Wall& w : walls_)
      if (std::min(w.top.front().z, w.top.back().z) > lowest + kEavesZone) w.eaves = 0;
  }

  const model::Building& building_;
  const BuildingPart& part_;
  std::vector<Wall> walls_;
};

struct Lengths {
  double wall = 0, eaves = 0;
  void add(const Wall& w) {
    wall += w.length;
    eaves += w.eaves;
  }
  bool mostly_eaves() const { return eaves >= kMost * wall; }
};

/// The longest wall on a street, or null.
const Wall* main_front(const std::vector<Wall>& walls) {
  const Wall* front = nullptr;
  for (const Wall& w : walls)
    if (w.kind == RoofEdge::street && (!front || w.length > front->length)) front = &w;
  return front;
}

/// Is most of the facade that a party wall belongs to one? Where a neighbour touches a corner of a free facade, the
/// eaves run on past it.
bool neighbours_facade(const std::vector<Wall>& walls, const Wall& wall) {
  double own = 0, all = 0;
  const Point2 out = wall.outwards();
  const auto near = [&](Point2 p) {
    return std::fabs(dot({p.x - wall.from.x, p.y - wall.from.y}, out)) <= kFacadeDepth;
  };
  for (const Wall& w : walls) {
    if (dot(w.outwards(), out) < kSameFacade || !near(w.from) || !near(w.to)) continue;
    all += w.length;
    if (w.kind == RoofEdge::party_wall) own += w.length;
  }
  const Wall* front = main_front(walls);
  const bool rear = front && dot(out, front->outwards()) < kLooksAway;
  return own >= (rear ? kRearShare : kMost) * all;
}

void find_ends(const std::vector<Wall>& walls, const BuildingPart& part, std::vector<SlopeEnd>& out) {
  for (const Wall& w : walls) {
    if (w.kind != RoofEdge::party_wall || w.eaves > 0) continue;
    for (const bool at_end : {false, true}) {
      const Point2 corner = at_end ? w.to : w.from;
      const auto beside = std::find_if(walls.begin(), walls.end(), [&](const Wall& o) {
        return &o != &w && (at_end ? o.from == corner : o.to == corner);
      });
      if (beside == walls.end() || beside->kind == RoofEdge::party_wall || beside->eaves < kMost * beside->length)
        continue;
      SlopeEnd end;
      end.x = geometry::to_grid(corner.x);
      end.y = geometry::to_grid(corner.y);
      end.z = (at_end ? w.top.back() : w.top.front()).z;
      end.wall = at_end ? unit({w.from.x - w.to.x, w.from.y - w.to.y}) : unit({w.to.x - w.from.x, w.to.y - w.from.y});
      end.eaves = at_end ? unit({beside->to.x - beside->from.x, beside->to.y - beside->from.y})
                         : unit({beside->from.x - beside->to.x, beside->from.y - beside->to.y});
      const std::size_t n = w.top.size();
      for (std::size_t i = 0; i < n && end.count < end.profile.size(); ++i) {
        const Point3 p = w.top[at_end ? n - 1 - i : i];
        const double along = dot({p.x - corner.x, p.y - corner.y}, end.wall), up = p.z - end.z;
        if (end.count > 0 && up < end.profile[end.count - 1][1]) break;
        end.profile[end.count++] = {along, up};
      }
      if (end.count < 2 || end.profile[1][0] <= 0) continue;
      end.pitch = end.profile[1][1] / end.profile[1][0];
      if (end.pitch < kLeastFall) continue;
      end.usual = part.usual_pitch;
      out.push_back(end);
    }
  }
}

double height_at(const SlopeEnd& end, double along) {
  for (std::uint32_t i = 1; i < end.count; ++i) {
    const auto& a = end.profile[i - 1];
    const auto& b = end.profile[i];
    if (along <= b[0]) return b[0] > a[0] ? a[1] + (b[1] - a[1]) * (along - a[0]) / (b[0] - a[0]) : b[1];
  }
  return end.profile[end.count - 1][1];
}

/// Should two slopes be one plane, and how far apart are they above the wall? m
std::optional<double> distance_between(const SlopeEnd& a, const SlopeEnd& b) {
  if (std::fabs(a.z - b.z) > kSameHeight || dot(a.wall, b.wall) < kSameDirection ||
      dot(a.eaves, b.eaves) > -kSameDirection)
    return std::nullopt;
  const bool asked_alike =
      a.usual > 0 && a.usual == b.usual && std::fabs(a.pitch - b.pitch) < 0.05 * std::max(a.pitch, b.pitch);
  if (!asked_alike && std::fabs(a.pitch - b.pitch) > kSamePitch) return std::nullopt;
  // As far as both slopes are the ones that rise from the eaves.
  const double reach = std::min(a.profile[1][0], b.profile[1][0]);
  double most = std::fabs(a.z - b.z);
  const auto compare = [&](double s) {
    if (s <= reach) most = std::max(most, std::fabs(a.z + height_at(a, s) - b.z - height_at(b, s)));
  };
  for (std::uint32_t i = 0; i < a.count; ++i) compare(a.profile[i][0]);
  for (std::uint32_t i = 0; i < b.count; ++i) compare(b.profile[i][0]);
  return most;
}

}  // namespace

RoofscapeCount count_roofscape(const model::Region& region) {
  RoofscapeCount out;
  Roofscape& s = out.sums;
  for (const model::Building& building : region.buildings) {
    if (!building.owned || building.has_mapped_parts) continue;
    for (const BuildingPart& part : building.parts) {
      const bool in_row =
          std::find(part.roof_edges.begin(), part.roof_edges.end(), RoofEdge::party_wall) != part.roof_edges.end();
      if (!in_row || part.lod < 2 || part.built_roof == model::RoofShape::flat) continue;
      const House house(building, part);
      const std::vector<Wall>& walls = house.walls();

      double party = 0;
      for (const Wall& w : walls)
        if (w.kind == RoofEdge::party_wall && w.eaves > kLeastPartyEaves && w.length > kReturn &&
            neighbours_facade(walls, w))
          party += w.eaves;
      if (party > kLeastPartyEaves) {
        ++s.party_eaves;
        const model::Attributes& a = part.attributes;
        s.party_eaves_mapped += a.roof_shape.source == model::Source::tag || a.roof_direction ||
                                a.roof_orientation.source == model::Source::preset ||
                                a.roof_orientation.source == model::Source::tag;
        s.party_eaves_length += party;
      }
      find_ends(walls, part, out.open);

      // Fronts by the street they look at: the longest, what looks its way, and what looks elsewhere.
      const Wall* front = main_front(walls);
      if (!front) continue;
      Lengths main, other, yard;
      bool has_rear = false;
      for (const Wall& w : walls) {
        const double looks = dot(w.outwards(), front->outwards());
        if (w.kind == RoofEdge::street)
          (looks >= kOtherStreet ? main : other).add(w);
        else if (w.kind != RoofEdge::party_wall)
          yard.add(w);
        has_rear = has_rear || (w.kind != RoofEdge::party_wall && w.kind != RoofEdge::street && looks < kRear &&
                                w.length >= kLeastFront);
      }
      if (!model::rises_from_edges(part.attributes.roof_shape.value)) continue;
      if (building.situation.position == model::BuildingPosition::mid_row) {
        ++s.mid_row;
        s.eaves_to_street += main.mostly_eaves();
        if (has_rear) {
          ++s.with_rear;
          s.eaves_to_rear += yard.eaves >= kMost * std::min(yard.wall, main.wall);
        }
      } else if (building.situation.position == model::BuildingPosition::corner_house && other.wall >= kLeastFront) {
        ++s.corner_houses;
        s.turned += main.mostly_eaves() && other.mostly_eaves();
      }
    }
  }
  settle_slope_ends(out.open, s);
  return out;
}

void settle_slope_ends(std::vector<SlopeEnd>& ends, Roofscape& sums) {
  std::stable_sort(ends.begin(), ends.end(),
                   [](const SlopeEnd& a, const SlopeEnd& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<SlopeEnd> left;
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t k = i + 1;
    while (k < ends.size() && ends[k].x == ends[i].x && ends[k].y == ends[i].y) ++k;
    std::vector<char> met(k - i, 0);
    for (std::size_t a = i; a < k; ++a)
      for (std::size_t b = a + 1; b < k; ++b) {
        const auto distance = distance_between(ends[a], ends[b]);
        if (!distance) continue;
        met[a - i] = met[b - i] = 1;
        ++sums.meetings;
        if (*distance <= kApart) continue;
        ++sums.apart;
        sums.widest = std::max(sums.widest, *distance);
      }
    for (std::size_t a = i; a < k; ++a)
      if (!met[a - i]) left.push_back(ends[a]);
    i = k;
  }
  ends = std::move(left);
}

void add(Roofscape& sum, const Roofscape& other) {
  sum.mid_row += other.mid_row;
  sum.eaves_to_street += other.eaves_to_street;
  sum.with_rear += other.with_rear;
  sum.eaves_to_rear += other.eaves_to_rear;
  sum.corner_houses += other.corner_houses;
  sum.turned += other.turned;
  sum.party_eaves += other.party_eaves;
  sum.party_eaves_mapped += other.party_eaves_mapped;
  sum.party_eaves_length += other.party_eaves_length;
  sum.meetings += other.meetings;
  sum.apart += other.apart;
  sum.widest = std::max(sum.widest, other.widest);
}

}  // namespace blockrand::masses
