#include "pipeline/validate/lean_agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "pipeline/geometry/box_index.h"
#include "pipeline/model/vector.h"
#include "pipeline/validate/detail_check.h"

namespace blockrand::validate {
namespace {

using model::Point3;

constexpr double kDepthTolerance = 6e-4;    // m; depths are written in millimetres
constexpr double kElementTolerance = 2e-4;  // m; elements are written in tenths of millimetres

/// The reveals of one wall, by the edge of the opening's polygon that each begins at.
class Reveals {
 public:
  Reveals(const ReadSolid& solid, const std::vector<std::size_t>& reveals) {
    for (const std::size_t r : reveals) {
      if (r >= solid.polygons.size()) continue;
      for (const auto& ring : solid.polygons[r].rings)
        for (std::size_t i = 0; i < ring.size(); ++i)
          if (ring.size() == 4) sides_[{ring[(i + 1) % 4], ring[i]}] = {r, ring[(i + 2) % 4]};
    }
  }
  struct Side {
    std::size_t polygon = 0;
    Point3 corner;  ///< of the wall, behind which the first end of the edge lies
  };
  const Side* find(const Point3& from, const Point3& to) const {
    const auto side = sides_.find({from, to});
    return side == sides_.end() ? nullptr : &side->second;
  }

 private:
  std::map<std::pair<Point3, Point3>, Side> sides_;
};

void flatten(ReadBody& body) {
  const auto solid =
      std::find_if(body.solids.begin(), body.solids.end(), [](const ReadSolid& s) { return s.lod == 3; });
  if (solid == body.solids.end()) return;
  std::map<std::size_t, std::vector<std::size_t>> of_wall;
  for (const ReadOpening& o : body.detail.openings)
    of_wall[o.wall].insert(of_wall[o.wall].end(), o.reveals.begin(), o.reveals.end());
  std::map<std::size_t, Reveals> reveals;
  for (const auto& [wall, polygons] : of_wall) reveals.emplace(wall, Reveals(*solid, polygons));
  std::vector<bool> gone(solid->polygons.size(), false);
  for (ReadOpening& o : body.detail.openings) {
    if (o.polygon >= solid->polygons.size() || solid->polygons[o.polygon].rings.size() != 1) continue;
    auto& ring = solid->polygons[o.polygon].rings[0];
    std::vector<Point3> moved;
    std::vector<std::size_t> of_ring;
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (const auto* side = reveals.at(o.wall).find(ring[i], ring[(i + 1) % ring.size()])) {
        moved.push_back(side->corner);
        of_ring.push_back(side->polygon);
      }
    if (moved.empty() || moved.size() != ring.size()) continue;
    o.depth = length(ring[0] - moved[0]);
    ring = std::move(moved);
    for (const std::size_t r : of_ring) gone[r] = true;
  }
  std::vector<std::size_t> at(gone.size(), 0);
  std::vector<ReadPolygon> left;
  for (std::size_t p = 0; p < gone.size(); ++p) {
    at[p] = left.size();
    if (!gone[p]) left.push_back(std::move(solid->polygons[p]));
  }
  solid->polygons = std::move(left);
  for (ReadOpening& o : body.detail.openings) {
    if (o.polygon < at.size()) o.polygon = at[o.polygon];
    if (o.wall < at.size()) o.wall = at[o.wall];
    o.reveals.clear();
  }
}

const ReadSolid* lod3_of(const ReadBody& body) {
  for (const ReadSolid& s : body.solids)
    if (s.lod == 3) return &s;
  return nullptr;
}

/// Wherever the ring starts.
std::vector<Point3> outline_of(const ReadBody& body, const ReadOpening& opening) {
  const ReadSolid* solid = lod3_of(body);
  if (!solid || opening.polygon >= solid->polygons.size() || solid->polygons[opening.polygon].rings.empty()) return {};
  std::vector<Point3> ring = solid->polygons[opening.polygon].rings[0];
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  return ring;
}

std::string depth_difference(const ReadBody& lean, const ReadBody& full) {
  std::map<std::vector<Point3>, double> depths;
  for (const ReadOpening& o : full.detail.openings) depths.emplace(outline_of(full, o), o.depth);
  for (const ReadOpening& o : lean.detail.openings) {
    const auto is = depths.find(outline_of(lean, o));
    if (is == depths.end()) return fmt::format("opening {} has other corners", o.id);
    if (std::fabs(is->second - o.depth) > kDepthTolerance)
      return fmt::format("opening {} is said to lie {:.3f} m behind its wall, it lies {:.3f} m", o.id, o.depth,
                         is->second);
  }
  return {};
}

/// Whether an element may be what is left of another.
bool within(const ReadElement& lean, const ReadElement& full) {
  const auto from = [](double a, double b) { return a >= b - kElementTolerance; };
  return from(lean.min.x, full.min.x) && from(lean.min.y, full.min.y) && from(lean.min.z, full.min.z) &&
         from(full.max.x, lean.max.x) && from(full.max.y, lean.max.y) && from(full.max.z, lean.max.z) &&
         std::includes(full.colours.begin(), full.colours.end(), lean.colours.begin(), lean.colours.end());
}

/// Seen along the wall: an axis-parallel box of an oblique outline would reach far off it.
bool stands_in(const ReadPlacement& placement, const std::vector<Point3>& outline) {
  if (outline.size() < 3) return false;
  const auto way = [&](const Point3& p) { return p.x * placement.along.x + p.y * placement.along.y; };
  const Point3 &a = outline[0], &o = placement.origin;
  Point3 normal;  // Newell's
  double least = way(a), most = least, low = a.z, high = a.z;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point3 &p = outline[i], &q = outline[(i + 1) % outline.size()];
    normal = normal + cross(p - a, q - a);
    least = std::min(least, way(p)), most = std::max(most, way(p));
    low = std::min(low, p.z), high = std::max(high, p.z);
  }
  return std::fabs(dot(normal, o - a)) <= kWallTolerance * length(normal) && way(o) >= least - kWallTolerance &&
         way(o) <= most + kWallTolerance && o.z >= low - kWallTolerance && o.z <= high + kWallTolerance;
}

std::string placement_difference(const ReadBody& lean, const Contents& of_lean, const ReadBody& full,
                                 const Contents& of_full) {
  const auto near = [](const ReadPlacement& p) {
    return fmt::format("near {:.3f} {:.3f} {:.3f}", p.origin.x, p.origin.y, p.origin.z);
  };
  const auto element = [](const Contents& of, const ReadPlacement& p) {
    const auto found = of.elements.find(p.element);
    return found == of.elements.end() ? nullptr : &found->second;
  };
  std::multimap<std::pair<Point3, model::Point2>, ReadPlacement> left;
  for (const ReadPlacement& p : full.detail.placements) left.emplace(std::pair(p.origin, p.along), p);
  for (const ReadPlacement& p : lean.detail.placements) {
    const ReadElement* const is = element(of_lean, p);
    auto [same, end] = left.equal_range({p.origin, p.along});
    while (same != end && !(is && element(of_full, same->second) && within(*is, *element(of_full, same->second))))
      ++same;
    if (same == end) return "another element, or one at another place (" + near(p) + ")";
    left.erase(same);
  }
  std::vector<std::vector<Point3>> outlines;
  std::vector<geometry::PlanBox> boxes;
  for (const ReadOpening& o : full.detail.openings) {
    outlines.push_back(outline_of(full, o));
    geometry::PlanBox& box = boxes.emplace_back();
    for (const Point3& p : outlines.back()) box.include(p.xy());
  }
  const geometry::BoxIndex index(std::move(boxes));
  std::vector<bool> taken(outlines.size(), false);
  for (const auto& [place, p] : left) {
    const auto candidates = index.near({p.origin.xy(), p.origin.xy()}, kWallTolerance);
    const auto stands = std::find_if(candidates.begin(), candidates.end(),
                                     [&](std::uint32_t i) { return !taken[i] && stands_in(p, outlines[i]); });
    if (stands == candidates.end()) return "an element is missing that stands in no opening (" + near(p) + ")";
    taken[*stands] = true;
  }
  return {};
}

}  // namespace

Contents without_reveals(const Contents& contents) {
  Contents out = contents;
  for (ReadBody& body : out.bodies) flatten(body);
  return out;
}

std::string lean_difference(const ReadBody& lean, const Contents& of_lean, const ReadBody& full,
                            const Contents& of_full) {
  const std::size_t is = lean.detail.openings.size(), should = full.detail.openings.size();
  if (is != should) return fmt::format("{} openings against {}", is, should);
  if (std::string what = depth_difference(lean, full); !what.empty()) return what;
  if (std::string what = placement_difference(lean, of_lean, full, of_full); !what.empty()) return what;
  return installation_difference(lean, full);
}

}  // namespace blockrand::validate
