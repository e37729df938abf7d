#include "pipeline/footprints/repair/nested_outlines.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "pipeline/footprints/repair/rings.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/slivers.h"
#include "pipeline/geometry/valid_polygon.h"

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

Extent extent_of(const TerraceBuilding& b) {
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

double area_of(const TerraceBuilding& b) {
  double area = 0;
  for (const Polygon& p : b.polygons) area += geometry::area(p);
  return area;
}

/// Buildings by the cells of a grid that their boxes meet. No BoxIndex: it grows while it is asked. The few that meet
/// very many are asked each time.
class ExtentGrid {
 public:
  void add(std::uint32_t building, const Extent& e) {
    const Cells c = cells_of(e);
    if (c.count() > kMostCells) {
      large_.push_back(building);
      return;
    }
    for (std::int64_t x = c.x0; x <= c.x1; ++x)
      for (std::int64_t y = c.y0; y <= c.y1; ++y) cells_[{x, y}].push_back(building);
  }

  /// All buildings whose boxes may meet this one, each once, by index.
  std::vector<std::uint32_t> near(const Extent& e) const {
    std::vector<std::uint32_t> out = large_;
    const Cells c = cells_of(e);
    const auto take = [&](const std::vector<std::uint32_t>& cell) { out.insert(out.end(), cell.begin(), cell.end()); };
    if (c.count() > kMostCells) {
      for (const auto& [at, cell] : cells_) take(cell);
    } else {
      for (std::int64_t x = c.x0; x <= c.x1; ++x)
        for (std::int64_t y = c.y0; y <= c.y1; ++y)
          if (const auto found = cells_.find({x, y}); found != cells_.end()) take(found->second);
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

 private:
  static constexpr double kCell = 32;  ///< m, some houses wide
  static constexpr double kMostCells = 256;
  struct Cells {
    std::int64_t x0, y0, x1, y1;
    double count() const { return static_cast<double>(x1 - x0 + 1) * static_cast<double>(y1 - y0 + 1); }
  };
  static Cells cells_of(const Extent& e) {
    const auto cell = [](double metres) { return static_cast<std::int64_t>(std::floor(metres / kCell)); };
    return {cell(e.low.x), cell(e.low.y), cell(e.high.x), cell(e.high.y)};
  }
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::uint32_t>> cells_;
  std::vector<std::uint32_t> large_;
};

/// Boxes of buildings that cover most of each other do so, too; an eighth is lost where walls run askew.
constexpr double kBoxShare = 0.7;
/// What rounding of areas may amount to, of the area.
constexpr double kRounding = 1e-9;

class Coverings {
 public:
  Coverings(TerraceRow& row, const RepairOptions& options, model::Report& report)
      : row_(row), options_(options), report_(report) {
    for (const TerraceBuilding& b : row.buildings) {
      areas_.push_back(area_of(b));
      extents_.push_back(b.polygons.empty() ? Extent{} : extent_of(b));
    }
  }

  void run() {
    settle_duplicates();
    find_pairs();
    // From the smallest outline to the largest, by id where they are equal.
    std::vector<std::uint32_t> order(row_.buildings.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return areas_[a] != areas_[b] ? areas_[a] < areas_[b] : row_.buildings[a].id < row_.buildings[b].id;
    });
    for (const std::uint32_t outer : order) settle_outline(outer);
  }

 private:
  /// A building that lies within another one.
  struct Inner {
    std::uint32_t building = 0;
    double common = 0;  ///< m²
  };

  bool settled(std::uint32_t i) const { return row_.buildings[i].settled != ObjectState::pending; }

  /// m² common to both; 0 where boxes and areas tell that it is less than `least`.
  double common_if(std::uint32_t a, std::uint32_t b, double least) const {
    const double box = common_extent(extents_[a], extents_[b]);
    const double most = std::min({box, areas_[a], areas_[b]});
    if (box <= 0 || most < least * (1 - kRounding)) return 0;
    if (box < kBoxShare * std::min(extents_[a].area(), extents_[b].area())) return 0;
    if (!same_level(row_.buildings[a].level, row_.buildings[b].level)) return 0;
    const double common = geometry::common_area(row_.buildings[a].polygons, row_.buildings[b].polygons);
    return common >= least ? common : 0;
  }

  /// True when b may lie within a: the larger is around the smaller, of equal ones the lower id.
  bool around(std::uint32_t a, std::uint32_t b) const {
    return areas_[a] != areas_[b] ? areas_[a] > areas_[b] : row_.buildings[a].id < row_.buildings[b].id;
  }

  /// Who lies within whom, of those that are still there. Outlines with parts need not know.
  void find_pairs() {
    inner_.assign(row_.buildings.size(), {});
    // Along x, so that only boxes that meet there are compared.
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < row_.buildings.size(); ++i)
      if (!row_.buildings[i].polygons.empty()) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(extents_[a].low.x, row_.buildings[a].id) < std::pair(extents_[b].low.x, row_.buildings[b].id);
    });
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t k = i + 1; k < order.size() && extents_[order[k]].low.x < extents_[order[i]].high.x; ++k) {
        const bool first = around(order[i], order[k]);
        const std::uint32_t outer = first ? order[i] : order[k], inner = first ? order[k] : order[i];
        if (row_.buildings[outer].has_parts) continue;
        const double common = common_if(outer, inner, kWithinShare * areas_[inner]);
        if (common > 0) inner_[outer].push_back({inner, common});
      }
    for (std::vector<Inner>& inner : inner_)
      std::sort(inner.begin(), inner.end(), [&](const Inner& p, const Inner& q) {
        if (p.common != q.common) return p.common > q.common;
        return row_.buildings[p.building].id < row_.buildings[q.building].id;
      });
  }

  bool stronger(std::uint32_t a, std::uint32_t b) const {
    const TerraceBuilding &x = row_.buildings[a], &y = row_.buildings[b];
    if (x.has_parts != y.has_parts) return x.has_parts;
    if (x.tags != y.tags) return x.tags > y.tags;
    return x.id < y.id;
  }

  void settle(std::uint32_t i, ObjectState state, std::uint32_t by) {
    TerraceBuilding& building = row_.buildings[i];
    building.settled = state;
    building.related = row_.buildings[by].id;
    building.polygons.clear();
  }

  /// From the strongest to the weakest, each against those that stay only: what a duplicate is a duplicate of is there.
  void settle_duplicates() {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < row_.buildings.size(); ++i)
      if (!row_.buildings[i].polygons.empty()) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return stronger(a, b); });
    ExtentGrid survivors;
    for (const std::uint32_t b : order) {
      const Inner same = row_.buildings[b].has_parts ? Inner{} : most_like(b, survivors);
      if (same.common <= 0) {
        survivors.add(b, extents_[b]);
        continue;
      }
      report_.add(row_.buildings[b].id, IssueCode::near_duplicate,
                  "of " + row_.buildings[same.building].id.text() + ", " + square_metres(same.common) + " in common");
      settle(b, ObjectState::duplicate, same.building);
    }
  }

  /// Of those of which b is a drawing, the one with most in common, of equal ones the stronger; without `common` where
  /// there is none.
  Inner most_like(std::uint32_t b, const ExtentGrid& survivors) const {
    Inner best;
    for (const std::uint32_t s : survivors.near(extents_[b])) {
      const double common = common_if(s, b, kSameShare * std::max(areas_[s], areas_[b]));
      if (common <= 0 || common < best.common) continue;
      if (common > best.common || stronger(s, best.building)) best = {s, common};
    }
    return best;
  }

  void settle_outline(std::uint32_t outer) {
    TerraceBuilding& building = row_.buildings[outer];
    if (settled(outer) || building.has_parts) return;
    std::vector<std::uint32_t> inner;
    for (const Inner& pair : inner_[outer])
      if (!settled(pair.building)) inner.push_back(pair.building);
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
    geometry::cut_slivers(rest, options_.spike_width);
    restore_nodes(rest, building.polygons);
    restore_nodes(rest, covered);
    double kept = 0;
    for (const Polygon& p : rest) kept += geometry::area(p);
    report_.add(
        building.id, IssueCode::covered_outline,
        std::to_string(inner.size()) + " within it; " + square_metres(kept) + " of " + square_metres(area) + " left");
    if (rest.empty())
      settle(outer, ObjectState::represented, inner.front());  // of those with most in common with it
    else
      building.polygons = std::move(rest);
  }

  TerraceRow& row_;
  const RepairOptions& options_;
  model::Report& report_;
  std::vector<double> areas_;
  std::vector<Extent> extents_;
  std::vector<std::vector<Inner>> inner_;  ///< by outer building, most in common first
};

}  // namespace

void settle_coverings(TerraceRow& row, const RepairOptions& options, model::Report& report) {
  if (row.buildings.size() > 1) Coverings(row, options, report).run();
}

}  // namespace blockrand::repair
