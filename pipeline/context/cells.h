// District cells: statistics of the buildings in squares of a fixed grid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "pipeline/model/point.h"
#include "pipeline/model/polygon.h"

namespace blockrand::context {

/// m. A few blocks: enough buildings for a mean, small enough to follow a change of quarter. Part of every cell's name
/// and value, so it is no option.
inline constexpr double kCellSize = 250;

/// A square of the grid: x and y count cells from the origin of the build CRS, so that a cell depends on no tile.
struct CellIndex {
  std::int32_t x = 0, y = 0;
  friend auto operator<=>(const CellIndex&, const CellIndex&) = default;
  std::string id() const { return "c" + std::to_string(x) + "_" + std::to_string(y); }
  model::Point2 corner() const { return {x * kCellSize, y * kCellSize}; }  ///< m, south-west
};

/// Each cell owns its western and southern edge.
CellIndex cell_of(model::Point2 p);

/// What a cell learns of a building: geometry and tagged values only, never inferred ones (ARCHITECTURE.md, law 4).
struct CellBuilding {
  model::Point2 place;            ///< m; the whole building counts in the cell of this point
  double area = 0;                ///< m², footprint
  double wall_length = 0;         ///< m, outline
  double party_wall_length = 0;   ///< m of it shared with other buildings
  std::optional<double> storeys;  ///< as tagged
  std::optional<int> year;        ///< as tagged; the middle where the tag tells several
};

/// The place of a building in the grid: the centre of mass of its outer ring, on the 1/1024 m grid.
model::Point2 cell_place(const model::Polygon& footprint);

/// m². Upper bounds of the bins of footprint sizes, excluded; a last bin holds what is larger.
inline constexpr std::array<double, 20> kFootprintBins = {10,  20,  30,  45,  60,  80,  100,  125,  150,  180,
                                                          220, 270, 330, 400, 500, 650, 1000, 2000, 5000, 10000};

/// Sums over the buildings of a cell. All are integers, so that their order does not matter.
struct CellSums {
  std::int64_t buildings = 0;
  std::int64_t area = 0;                                        ///< 1/1024 m²
  std::int64_t walls = 0;                                       ///< 1/1024 m
  std::int64_t party_walls = 0;                                 ///< 1/1024 m
  std::int64_t tagged = 0;                                      ///< buildings with tagged storeys
  std::int64_t tagged_area = 0;                                 ///< 1/1024 m² under them
  std::int64_t storeys = 0, storeys_squared = 0;                ///< in hundredths of a storey, and these squared
  std::int64_t floor_area = 0;                                  ///< 1/1024 m², storeys times area of the tagged
  std::int64_t dated = 0;                                       ///< buildings with a year
  std::int64_t years = 0, years_squared = 0;                    ///< from 1900
  std::array<std::int64_t, kFootprintBins.size() + 1> sizes{};  ///< buildings by footprint, kFootprintBins

  void add(const CellBuilding& building);
  friend bool operator==(const CellSums&, const CellSums&) = default;
};

/// What a cell says. Empty values: nobody told.
struct CellFigures {
  std::int64_t buildings = 0;
  double covered_share = 1;  ///< of the cell's area lies within the data
  // By the area of the cell: empty where less than kMinCovered of it is covered.
  std::optional<double> density;      ///< buildings per hectare
  std::optional<double> built_share;  ///< footprint area / cell area; above 1 where a large building reaches out of
                                      ///< its cell
  std::optional<double> floor_area_ratio;              ///< built share times storeys by area, as good as `tagged_share`
  double tagged_share = 0;                             ///< of the buildings have tagged storeys
  std::optional<double> storeys_mean, storeys_spread;  ///< of these buildings; spread is the standard deviation
  std::optional<double> party_wall_share;              ///< of the length of outlines
  double dated_share = 0;                              ///< of the buildings have a year
  std::optional<double> year_mean, year_spread;
  std::optional<double> footprint_quartile, footprint_median, footprint_upper_quartile;  ///< m², from the bins, linear
                                                                                         ///< within a bin
};

/// Of a cell's area. Where less is within the data, buildings by its area would tell of the data's edge, not of the
/// district.
inline constexpr double kMinCovered = 0.95;

/// How much of a cell's area lies within `coverage`, from 0 to 1: a convex counter-clockwise ring in metres (coverage_of,
/// blocks.h), which is pinned for a tile alone, so that a cell's value does not depend on the tile. 0 where it is empty:
/// fewer than three buildings cover nothing.
double covered_share(CellIndex cell, std::span<const model::Point2> coverage);

CellFigures figures_of(const CellSums& sums, double covered_share = 1);

/// The cells of a region, ascending.
using Cells = std::map<CellIndex, CellSums>;

Cells cells_of(std::span<const CellBuilding> buildings);

}  // namespace blockrand::context
