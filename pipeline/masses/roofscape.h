// How the finished roofs of a tile stand in their rows: counted from the solids, not from what was asked. build.json
// and the summary print it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/model/region.h"

namespace blockrand::masses {

/// Sums over houses without mapped parts whose roof is not flat; of mid-row and corner houses, those whose shape has
/// eaves at two sides.
struct Roofscape {
  std::uint64_t mid_row = 0;          ///< between two neighbours, with a front on a street
  std::uint64_t eaves_to_street = 0;  ///< of them: water runs to the street from at least half of the front
  std::uint64_t with_rear = 0;        ///< of them: with a free wall opposite to the front
  std::uint64_t eaves_to_rear =
      0;  ///< ... and water runs to the yard from half of the free walls there, or half a front's length
  std::uint64_t corner_houses = 0;  ///< on two streets, with a neighbour
  std::uint64_t turned = 0;         ///< of them: eaves to both streets
  /// Houses from whose eaves water runs into a neighbour's wall: eaves of more than 1 m, at most 1.5 m above the
  /// lowest, on a party wall longer than 2.5 m in a facade that is one (half of it, three quarters of a rear one).
  std::uint64_t party_eaves = 0;
  std::uint64_t party_eaves_mapped =
      0;  ///< of them: roof:shape, roof:direction, roof:orientation or the gables of a style want it so
  double party_eaves_length = 0;  ///< m
  std::uint64_t meetings = 0;     ///< slopes of two neighbours that are one plane by eaves, pitch and direction
  std::uint64_t apart = 0;        ///< of them: more than kApart between them somewhere
  double widest = 0;              ///< m, of those
};

/// m. Slopes that should meet may be this far apart above their common wall.
inline constexpr double kApart = 0.01;

/// A slope where it comes to a party wall at its eaves' corner. Two neighbours' slopes with the same corner, height,
/// direction and pitch should meet.
struct SlopeEnd {
  std::int64_t x = 0, y = 0;  ///< the corner, in grid steps
  double z = 0;               ///< m, eaves
  model::Point2 wall, eaves;  ///< unit vectors from the corner: along the party wall; along the eaves, away from it
  double pitch = 0;           ///< rise over run along the wall, of what stands
  double usual = 0;           ///< BuildingPart::usual_pitch
  std::uint32_t count = 0;    ///< of `profile`
  std::array<std::array<double, 2>, 4> profile{};  ///< m along the wall, m above the eaves; up to the highest point
};

struct RoofscapeCount {
  Roofscape sums;
  std::vector<SlopeEnd> open;  ///< ends whose neighbour was not among the buildings
};

/// Counts the owned buildings of a region at LoD2.
RoofscapeCount count_roofscape(const model::Region& region);

/// Pairs up ends that are left over from several regions, in any order, and adds what is found.
void settle_slope_ends(std::vector<SlopeEnd>& ends, Roofscape& sums);

void add(Roofscape& sum, const Roofscape& other);

}  // namespace blockrand::masses
