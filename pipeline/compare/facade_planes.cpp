#include "pipeline/compare/facade_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "pipeline/base/portable_math.h"
#include "pipeline/compare/area_vector.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::compare {
namespace {

constexpr double kOnePlane = 0.02;                     // m. Surveyors' points of one wall scatter by millimetres.
constexpr double kLeastArea = 1e-6;                    // m². A square millimetre has no direction.
constexpr std::array<double, 2> kProbes = {0.3, 1.0};  // m beside a wall, where its inside is looked for
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Interval {
  double low = kInfinite, high = -kInfinite;
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  void add(const Interval& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
};

template <typename Visit>
void each_point(const Rings3& rings, Visit visit) {
  for (const auto& ring : rings)
    for (const Point3& p : ring) visit(p);
}

bool finite(const Rings3& rings) {
  bool all = true;
  each_point(rings,
             [&](const Point3& p) { all = all && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); });
  return all;
}

bool inside(const Building& building, Point2 p) {
  return std::any_of(building.footprint.begin(), building.footprint.end(),
                     [&](const model::Polygon& polygon) { return geometry::contains(polygon, p); });
}

/// +1: the normal points out of the footprint, -1: into it, 0: cannot be told.
int side(const Building& building, const Rings3& rings, Point2 normal, Point3 centre) {
  if (building.footprint.empty()) return 0;
  const Point2 along{-normal.y, normal.x};
  Interval extent;
  each_point(rings, [&](const Point3& p) { extent.add(dot(along, p.xy())); });
  const double across = dot(normal, centre.xy());
  for (const double probe : kProbes) {
    int votes = 0;
    for (const double share : {0.5, 0.15, 0.85}) {
      const double at = extent.low + share * (extent.high - extent.low);
      const Point2 on{across * normal.x + at * along.x, across * normal.y + at * along.y};
      const bool out_is_in = inside(building, {on.x + probe * normal.x, on.y + probe * normal.y});
      const bool in_is_in = inside(building, {on.x - probe * normal.x, on.y - probe * normal.y});
      votes += static_cast<int>(in_is_in) - static_cast<int>(out_is_in);
    }
    if (votes != 0) return votes > 0 ? 1 : -1;
  }
  return 0;
}

void add_walls(const City& city, std::uint32_t index, double max_lean, std::vector<WallPiece>& out) {
  const Building& building = city.buildings[index];
  std::vector<std::pair<WallPiece, bool>> found;  // and whether the footprint told its side
  double as_drawn = 0, inside_out = 0;            // m²
  for (std::size_t f = 0; f < building.faces.size(); ++f) {
    const Face& face = building.faces[f];
    if (face.hull != Hull::wall) continue;
    const Flat flat = flat_of(face.rings);
    if (flat.area < kLeastArea || std::fabs(flat.normal.z) > max_lean) continue;
    const double level = std::sqrt(flat.normal.x * flat.normal.x + flat.normal.y * flat.normal.y);
    WallPiece piece{
        index, static_cast<std::uint32_t>(f), {flat.normal.x / level, flat.normal.y / level}, flat.area, flat.centre};
    const int turn = side(building, face.rings, piece.normal, piece.centre);
    (turn < 0 ? inside_out : as_drawn) += turn == 0 ? 0 : piece.area;
    if (turn < 0) piece.normal = {-piece.normal.x, -piece.normal.y};
    found.emplace_back(piece, turn != 0);
  }
  for (auto& [piece, told] : found) {
    if (!told && inside_out > as_drawn) piece.normal = {-piece.normal.x, -piece.normal.y};
    out.push_back(piece);
  }
}

/// Larger first; equal ones by place, so that the order of faces in a file does not count.
bool larger(double area_a, const Point3& a, double area_b, const Point3& b) {
  const auto key = [](double area, const Point3& p) {
    const auto whole = [](double v) { return std::llround(v * 1e6); };
    return std::tuple(-whole(area), whole(p.x), whole(p.y), whole(p.z));
  };
  return key(area_a, a) < key(area_b, b);
}

/// Walls in one plane, or a stretch of them.
struct Sheet {
  Point2 normal;
  double offset = 0;
  std::vector<std::size_t> pieces;
  double area = 0;
  Point3 centre;
  Interval extent;  // along the group that is being gathered
};

class Gatherer {
 public:
  Gatherer(const City& city, const std::vector<WallPiece>& pieces, const FacadeOptions& options)
      : city_(city), pieces_(pieces), options_(options), least_cosine_(base::cos(options.plane_angle)) {}

  std::vector<WallGroup> gather() {
    make_sheets();
    cut_at_gaps();
    std::vector<WallGroup> groups;
    std::vector<bool> taken(sheets_.size(), false);
    for (std::size_t seed = 0; seed < sheets_.size(); ++seed) {
      if (taken[seed]) continue;
      WallGroup group = gather_around(seed, taken);
      const double height = group.top - group.bottom, width = group.right - group.left;
      if (width >= options_.min_width - 1e-9 && height >= options_.min_height - 1e-9)
        groups.push_back(std::move(group));
    }
    return groups;
  }

 private:
  const Rings3& rings(std::size_t piece) const {
    return city_.buildings[pieces_[piece].building].faces[pieces_[piece].face].rings;
  }
  /// Largest distance of the piece's points from a plane.
  double distance(std::size_t piece, Point2 normal, double offset) const {
    double most = 0;
    each_point(rings(piece), [&](const Point3& p) { most = std::max(most, std::fabs(dot(normal, p.xy()) - offset)); });
    return most;
  }
  Interval extent(std::size_t piece, Point2 along) const {
    Interval out;
    each_point(rings(piece), [&](const Point3& p) { out.add(dot(along, p.xy())); });
    return out;
  }

  void make_sheets() {
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      Sheet* best = nullptr;
      double best_distance = kOnePlane;
      for (Sheet& sheet : sheets_) {
        if (dot(sheet.normal, pieces_[p].normal) < least_cosine_) continue;
        if (std::fabs(dot(sheet.normal, pieces_[p].centre.xy()) - sheet.offset) > kOnePlane) continue;
        const double d = distance(p, sheet.normal, sheet.offset);
        if (d < best_distance) {
          best_distance = d;
          best = &sheet;
        }
      }
      if (best == nullptr) {
        sheets_.push_back({pieces_[p].normal, dot(pieces_[p].normal, pieces_[p].centre.xy()), {}, 0, {}, {}});
        best = &sheets_.back();
      }
      best->pieces.push_back(p);
    }
  }

  /// The mean plane of its pieces, and the middle of them.
  void settle(Sheet& sheet) const {
    Point2 normal;
    Point3 centre;
    sheet.area = 0;
    for (const std::size_t p : sheet.pieces) {
      const WallPiece& piece = pieces_[p];
      sheet.area += piece.area;
      normal = {normal.x + piece.area * piece.normal.x, normal.y + piece.area * piece.normal.y};
      centre = {centre.x + piece.area * piece.centre.x, centre.y + piece.area * piece.centre.y,
                centre.z + piece.area * piece.centre.z};
    }
    const double length = std::sqrt(dot(normal, normal));
    sheet.normal = {normal.x / length, normal.y / length};
    sheet.centre = {centre.x / sheet.area, centre.y / sheet.area, centre.z / sheet.area};
    sheet.offset = dot(sheet.normal, sheet.centre.xy());
  }

  void cut_at_gaps() {
    std::vector<Sheet> stretches;
    for (const Sheet& sheet : sheets_) {
      const Point2 along{-sheet.normal.y, sheet.normal.x};
      std::vector<std::pair<double, double>> extents;
      std::vector<std::size_t> order(sheet.pieces.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      for (const std::size_t p : sheet.pieces) {
        const Interval e = extent(p, along);
        extents.emplace_back(e.low, e.high);
      }
      std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return extents[a] != extents[b] ? extents[a] < extents[b] : a < b;
      });
      double reached = -kInfinite;
      for (const std::size_t i : order) {
        if (extents[i].first > reached + kFacadeGap) stretches.emplace_back();
        stretches.back().pieces.push_back(sheet.pieces[i]);
        reached = std::max(reached, extents[i].second);
      }
    }
    for (Sheet& stretch : stretches) {
      std::sort(stretch.pieces.begin(), stretch.pieces.end());
      settle(stretch);
    }
    std::sort(stretches.begin(), stretches.end(),
              [](const Sheet& a, const Sheet& b) { return larger(a.area, a.centre, b.area, b.centre); });
    sheets_ = std::move(stretches);
  }

  WallGroup gather_around(std::size_t seed, std::vector<bool>& taken) {
    WallGroup group;
    group.normal = sheets_[seed].normal;
    group.offset = sheets_[seed].offset;
    const auto extent_of = [&](const Sheet& sheet) {
      Interval out;
      for (const std::size_t p : sheet.pieces) out.add(extent(p, group.along()));
      return out;
    };
    std::vector<std::size_t> near;
    for (std::size_t s = seed + 1; s < sheets_.size(); ++s) {
      if (taken[s] || dot(sheets_[s].normal, group.normal) < least_cosine_) continue;
      const bool in_plane = std::all_of(sheets_[s].pieces.begin(), sheets_[s].pieces.end(), [&](std::size_t p) {
        return distance(p, group.normal, group.offset) <= options_.plane_distance + 1e-9;
      });
      if (!in_plane) continue;
      sheets_[s].extent = extent_of(sheets_[s]);
      near.push_back(s);
    }
    Interval reached = extent_of(sheets_[seed]);
    std::vector<std::size_t> members = sheets_[seed].pieces;
    taken[seed] = true;
    for (bool grew = true; grew;) {
      grew = false;
      for (const std::size_t s : near) {
        const Interval& e = sheets_[s].extent;
        if (taken[s] || e.low > reached.high + kFacadeGap || e.high < reached.low - kFacadeGap) continue;
        taken[s] = true;
        grew = true;
        reached.add(e);
        members.insert(members.end(), sheets_[s].pieces.begin(), sheets_[s].pieces.end());
      }
    }
    Interval heights;
    for (const std::size_t p : members) {
      each_point(rings(p), [&](const Point3& q) { heights.add(q.z); });
      group.pieces.push_back(pieces_[p]);
    }
    std::sort(group.pieces.begin(), group.pieces.end(), [](const WallPiece& a, const WallPiece& b) {
      return std::pair(a.building, a.face) < std::pair(b.building, b.face);
    });
    group.left = reached.low;
    group.right = reached.high;
    group.bottom = heights.low;
    group.top = heights.high;
    return group;
  }

  const City& city_;
  const std::vector<WallPiece>& pieces_;
  const FacadeOptions& options_;
  double least_cosine_;
  std::vector<Sheet> sheets_;
};

}  // namespace

Flat flat_of(const Rings3& rings) {
  Flat flat;
  if (rings.empty() || rings.front().size() < 3 || !finite(rings)) return flat;
  const Point3 base = rings.front().front();
  const Point3 outer = area_vector(rings.front());
  const double outer_length = length(outer);
  if (!(outer_length > 2 * kLeastArea)) return flat;
  flat.normal = {outer.x / outer_length, outer.y / outer_length, outer.z / outer_length};
  Point3 moment;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const auto& ring = rings[r];
    // Holes take off, whichever way they run.
    const double ring_area = dot(flat.normal, area_vector(ring));
    const double sign = (r == 0) == (ring_area >= 0) ? 1.0 : -1.0;
    flat.area += sign * 0.5 * ring_area;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point3 a = ring[i] - base, b = ring[i + 1 == ring.size() ? 0 : i + 1] - base;
      const double weight = sign * 0.5 * dot(flat.normal, cross(a, b)) / 3;
      moment = {moment.x + weight * (a.x + b.x), moment.y + weight * (a.y + b.y), moment.z + weight * (a.z + b.z)};
    }
  }
  if (!(flat.area > kLeastArea)) return {};
  flat.centre = {base.x + moment.x / flat.area, base.y + moment.y / flat.area, base.z + moment.z / flat.area};
  return flat;
}

std::vector<WallGroup> wall_groups(const City& city, std::span<const std::uint32_t> buildings,
                                   const FacadeOptions& options) {
  std::vector<WallPiece> pieces;
  for (const std::uint32_t b : buildings) add_walls(city, b, base::sin(options.max_tilt), pieces);
  std::sort(pieces.begin(), pieces.end(), [](const WallPiece& a, const WallPiece& b) {
    if (larger(a.area, a.centre, b.area, b.centre)) return true;
    if (larger(b.area, b.centre, a.area, a.centre)) return false;
    return std::pair(a.building, a.face) < std::pair(b.building, b.face);
  });
  return Gatherer(city, pieces, options).gather();
}

}  // namespace blockrand::compare
