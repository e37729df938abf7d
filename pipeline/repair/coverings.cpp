#include "pipeline/repair/coverings.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "pipeline/geometry/polygon.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/repair/rings.h"

namespace blockrand::repair {

namespace {

using model::IssueCode;
using model::ObjectState;
using model::Point2;
using model::Polygon;

struct Extent {
  Point2 low, high;
  double area() const { return (high.x - low.x) * (high.y - low.y); }
};

Extent extent_of(const RowBuilding& b) {
  Extent e{b.polygons.front().outer.points.front(), b.polygons.front().outer.points.front()};
  for (const Polygon& polygon : b.polygons)
    for (const Point2 p : polygon.outer.points) {
      e.low = {std::min(e.low.x, p.x), std::min(e.low.y, p.y)};
      e.high = {std::max(e.high.x, p.x), std::max(e.high.y, p.y)};
    }
  return e;
}

double common_extent(const Extent& a, const Extent& b) {
  const double x = std::min(a.high.x, b.high.x) - std::max(a.low.x, b.low.x);
  const double y = std::min(a.high.y, b.high.y) - std::max(a.low.y, b.low.y);
  return x > 0 && y > 0 ? x * y : 0;
}

double area_of(const RowBuilding& b) {
  double area = 0;
  for (const Polygon& p : b.polygons) area += geometry::area(p);
  return area;
}

/// Boxes of buildings that cover most of each other do so, too; an eighth is lost where walls run askew.
constexpr double kBoxShare = 0.7;

class Coverings {
 public:
  Coverings(Row& row, const RepairOptions& options, model::Report& report)
      : row_(row), options_(options), report_(report) {
    for (const RowBuilding& b : row.buildings) {
      areas_.push_back(area_of(b));
      extents_.push_back(b.polygons.empty() ? Extent{} : extent_of(b));
    }
  }

  void run() {
    find_pairs();
    if (pairs_.empty()) return;
    settle_duplicates();
    // From the smallest outline to the largest, by id where they are equal.
    std::vector<std::uint32_t> order(row_.buildings.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return areas_[a] != areas_[b] ? areas_[a] < areas_[b] : row_.buildings[a].id < row_.buildings[b].id;
    });
    for (const std::uint32_t outer : order) settle_outline(outer);
  }

 private:
  struct Pair {
    std::uint32_t a = 0, b = 0;
    double common = 0;  ///< m²
  };

  bool settled(std::uint32_t i) const { return row_.buildings[i].settled != ObjectState::pending; }

  void find_pairs() {
    // Along x, so that only boxes that meet there are compared.
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < row_.buildings.size(); ++i)
      if (!row_.buildings[i].polygons.empty()) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(extents_[a].low.x, row_.buildings[a].id) < std::pair(extents_[b].low.x, row_.buildings[b].id);
    });
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t k = i + 1; k < order.size() && extents_[order[k]].low.x < extents_[order[i]].high.x; ++k) {
        const std::uint32_t a = order[i], b = order[k];
        const double least = std::min(extents_[a].area(), extents_[b].area());
        if (common_extent(extents_[a], extents_[b]) < kBoxShare * least) continue;
        if (!same_level(row_.buildings[a].level, row_.buildings[b].level)) continue;
        const double common = geometry::common_area(row_.buildings[a].polygons, row_.buildings[b].polygons);
        if (common >= kWithinShare * std::min(areas_[a], areas_[b])) pairs_.push_back({a, b, common});
      }
    std::sort(pairs_.begin(), pairs_.end(), [&](const Pair& p, const Pair& q) {
      if (p.common != q.common) return p.common > q.common;
      return std::minmax(row_.buildings[p.a].id, row_.buildings[p.b].id) <
             std::minmax(row_.buildings[q.a].id, row_.buildings[q.b].id);
    });
  }

  bool stronger(std::uint32_t a, std::uint32_t b) const {
    const RowBuilding &x = row_.buildings[a], &y = row_.buildings[b];
    if (x.has_parts != y.has_parts) return x.has_parts;
    if (x.tags != y.tags) return x.tags > y.tags;
    return x.id < y.id;
  }

  void settle(std::uint32_t i, ObjectState state, std::uint32_t by) {
    RowBuilding& building = row_.buildings[i];
    building.settled = state;
    building.related = row_.buildings[by].id;
    building.polygons.clear();
  }

  void settle_duplicates() {
    for (const Pair& pair : pairs_) {
      if (settled(pair.a) || settled(pair.b)) continue;
      if (pair.common < kSameShare * std::max(areas_[pair.a], areas_[pair.b])) continue;
      const bool a_stays = stronger(pair.a, pair.b);
      const std::uint32_t stays = a_stays ? pair.a : pair.b, goes = a_stays ? pair.b : pair.a;
      if (row_.buildings[goes].has_parts) continue;
      report_.add(row_.buildings[goes].id, IssueCode::near_duplicate,
                  "of " + row_.buildings[stays].id.text() + ", " + square_metres(pair.common) + " in common");
      settle(goes, ObjectState::duplicate, stays);
    }
  }

  void settle_outline(std::uint32_t outer) {
    RowBuilding& building = row_.buildings[outer];
    if (settled(outer) || building.has_parts) return;
    std::vector<std::uint32_t> inner;
    for (const Pair& pair : pairs_) {
      if (pair.a != outer && pair.b != outer) continue;
      const std::uint32_t other = pair.a == outer ? pair.b : pair.a;
      if (settled(other) || areas_[other] > areas_[outer] ||
          (areas_[other] == areas_[outer] && row_.buildings[other].id < building.id))
        continue;
      if (pair.common >= kWithinShare * areas_[other]) inner.push_back(other);
    }
    if (inner.empty()) return;
    std::vector<Polygon> covered;
    for (const std::uint32_t i : inner)
      covered.insert(covered.end(), row_.buildings[i].polygons.begin(), row_.buildings[i].polygons.end());
    const double area = area_of(building);
    const std::vector<Polygon> ground =
        covered.size() == 1 ? covered : geometry::unite(covered, 0, options_.ring_clearance).polygons;
    const double common = geometry::common_area(building.polygons, ground);
    if (common <= options_.max_loss * area) return;  // resolve_overlaps cuts holes
    std::vector<Polygon> rest =
        geometry::difference(building.polygons, ground, options_.parts_free_area, options_.ring_clearance).polygons;
    std::erase_if(rest, [&](const Polygon& p) { return geometry::equivalent_width(p) < options_.parts_free_width; });
    restore_nodes(rest, building.polygons);
    restore_nodes(rest, covered);
    double kept = 0;
    for (const Polygon& p : rest) kept += geometry::area(p);
    report_.add(building.id, IssueCode::covered_outline,
                std::to_string(inner.size()) + " within it; " + square_metres(kept) + " of " + square_metres(area) + " left");
    if (rest.empty())
      settle(outer, ObjectState::represented, inner.front());  // of those with most in common with it
    else
      building.polygons = std::move(rest);
  }

  Row& row_;
  const RepairOptions& options_;
  model::Report& report_;
  std::vector<double> areas_;
  std::vector<Extent> extents_;
  std::vector<Pair> pairs_;
};

}  // namespace

void settle_coverings(Row& row, const RepairOptions& options, model::Report& report) {
  if (row.buildings.size() > 1) Coverings(row, options, report).run();
}

}  // namespace blockrand::repair
