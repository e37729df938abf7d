#include "pipeline/context/cells.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::context {

namespace {

constexpr double kStepsPerUnit = 1024;  ///< of areas and lengths in CellSums
constexpr double kStoreySteps = 100;
constexpr int kYearZero = 1900;  ///< keeps the sums of squares small

std::int64_t steps(double value, double per_unit) { return static_cast<std::int64_t>(std::llrint(value * per_unit)); }

/// Mean and standard deviation of `n` integers from their sum and the sum of their squares, exact up to the last
/// division.
struct Spread {
  double mean = 0, deviation = 0;
};
Spread spread_of(std::int64_t n, std::int64_t sum, std::int64_t squares) {
  __extension__ typedef __int128 Wide;
  const Wide variance =
      static_cast<Wide>(n) * squares - static_cast<Wide>(sum) * sum;  // times n squared, never negative
  return {static_cast<double>(sum) / static_cast<double>(n),
          std::sqrt(static_cast<double>(variance)) / static_cast<double>(n)};
}

double quantile(const CellSums& sums, double share) {
  const double wanted = share * static_cast<double>(sums.buildings);
  double passed = 0;
  for (std::size_t bin = 0; bin < kFootprintBins.size(); ++bin) {
    const double here = static_cast<double>(sums.sizes[bin]);
    const double low = bin == 0 ? 0 : kFootprintBins[bin - 1];
    if (here > 0 && passed + here >= wanted) return low + (kFootprintBins[bin] - low) * (wanted - passed) / here;
    passed += here;
  }
  return kFootprintBins.back();  // the last bin has no upper bound
}

}  // namespace

CellIndex cell_of(model::Point2 p) {
  return {static_cast<std::int32_t>(std::floor(p.x / kCellSize)),
          static_cast<std::int32_t>(std::floor(p.y / kCellSize))};
}

model::Point2 cell_place(const model::Polygon& footprint) {
  // From the least point on, so that a ring that starts elsewhere does not round into another cell.
  std::vector<model::Point2> points = footprint.outer.points;
  if (points.empty()) return {};
  if (geometry::signed_area(points) < 0) std::reverse(points.begin(), points.end());
  std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
  return model::snap(geometry::centroid(points));
}

void CellSums::add(const CellBuilding& b) {
  const std::int64_t size = steps(b.area, kStepsPerUnit);
  ++buildings;
  area += size;
  walls += steps(b.wall_length, kStepsPerUnit);
  party_walls += steps(b.party_wall_length, kStepsPerUnit);
  const auto bin =
      std::upper_bound(kFootprintBins.begin(), kFootprintBins.end(), static_cast<double>(size) / kStepsPerUnit);
  ++sizes[static_cast<std::size_t>(bin - kFootprintBins.begin())];
  if (b.storeys) {
    const std::int64_t s = steps(*b.storeys, kStoreySteps);
    ++tagged;
    tagged_area += size;
    storeys += s;
    storeys_squared += s * s;
    floor_area += steps(b.area * *b.storeys, kStepsPerUnit);
  }
  if (b.year) {
    const std::int64_t y = *b.year - kYearZero;
    ++dated;
    years += y;
    years_squared += y * y;
  }
}

double covered_share(CellIndex cell, std::span<const model::Point2> coverage) {
  if (coverage.size() < 3) return 0;
  // Sutherland and Hodgman (1974): the square, cut by one edge of the convex ring after the other; metres from its corner.
  const model::Point2 corner = cell.corner();
  std::vector<model::Point2> rest{{0, 0}, {kCellSize, 0}, {kCellSize, kCellSize}, {0, kCellSize}};
  for (std::size_t i = 0; i < coverage.size() && !rest.empty(); ++i) {
    const model::Point2 a{coverage[i].x - corner.x, coverage[i].y - corner.y};
    const model::Point2 end = coverage[(i + 1) % coverage.size()];
    const double dx = end.x - corner.x - a.x, dy = end.y - corner.y - a.y;
    const auto inside = [&](model::Point2 p) { return dx * (p.y - a.y) - dy * (p.x - a.x); };
    std::vector<model::Point2> cut;
    for (std::size_t k = 0; k < rest.size(); ++k) {
      const model::Point2 p = rest[k], q = rest[(k + 1) % rest.size()];
      const double u = inside(p), v = inside(q);
      if (u >= 0) cut.push_back(p);
      if ((u >= 0) != (v >= 0)) cut.push_back({p.x + (q.x - p.x) * u / (u - v), p.y + (q.y - p.y) * u / (u - v)});
    }
    rest = std::move(cut);
  }
  return rest.empty() ? 0 : std::clamp(geometry::signed_area(rest) / (kCellSize * kCellSize), 0.0, 1.0);
}

CellFigures figures_of(const CellSums& s, double covered) {
  constexpr double kSquareMetresPerHectare = 10000;
  CellFigures f;
  f.buildings = s.buildings;
  f.covered_share = covered;
  if (s.buildings == 0) return f;
  const double n = static_cast<double>(s.buildings);
  if (covered >= kMinCovered) {
    f.density = n / (kCellSize * kCellSize / kSquareMetresPerHectare);
    f.built_share = static_cast<double>(s.area) / kStepsPerUnit / (kCellSize * kCellSize);
  }
  f.tagged_share = static_cast<double>(s.tagged) / n;
  f.dated_share = static_cast<double>(s.dated) / n;
  if (s.tagged > 0) {
    const Spread storeys = spread_of(s.tagged, s.storeys, s.storeys_squared);
    f.storeys_mean = storeys.mean / kStoreySteps;
    f.storeys_spread = storeys.deviation / kStoreySteps;
  }
  if (f.built_share && s.tagged_area > 0)
    f.floor_area_ratio = *f.built_share * static_cast<double>(s.floor_area) / static_cast<double>(s.tagged_area);
  if (s.walls > 0) f.party_wall_share = static_cast<double>(s.party_walls) / static_cast<double>(s.walls);
  if (s.dated > 0) {
    const Spread years = spread_of(s.dated, s.years, s.years_squared);
    f.year_mean = kYearZero + years.mean;
    f.year_spread = years.deviation;
  }
  f.footprint_quartile = quantile(s, 0.25);
  f.footprint_median = quantile(s, 0.5);
  f.footprint_upper_quartile = quantile(s, 0.75);
  return f;
}

Cells cells_of(std::span<const CellBuilding> buildings) {
  Cells cells;
  for (const CellBuilding& b : buildings) cells[cell_of(b.place)].add(b);
  return cells;
}

}  // namespace blockrand::context
