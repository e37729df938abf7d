// What stands and lies around the houses of a tile.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/base/pack.h"
#include "pipeline/model/region.h"
#include "pipeline/surroundings/body_site.h"
#include "pipeline/surroundings/ground_claims.h"
#include "pipeline/surroundings/ground_height.h"
#include "pipeline/surroundings/options.h"

namespace blockrand::surroundings {

/// m: how far around its squares a tile's surroundings read what is mapped: pieces of bodies of 60 m, and what stands at their ends.
/// Farther away (ARCHITECTURE.md, law 4): houses that make a street one of a town, to 280 m; blocks, to their ends; coasts, to 2 km;
/// bridges that go on in each other, to 2 km; supports of wires, to 1.5 km, and the ground below them. Streets, lines and areas count
/// as a whole where they come near. All of it lies within 3 km (kHalo).
inline constexpr double kSurroundingsReach = kStreetReach + kBuiltUpReach;
/// m: how far around its squares nodes of lines tell of anything: the ends of a piece of a street (150 m), junctions before a stop line.
inline constexpr double kNodeReach = 250;
/// m: how far houses make a street one of a town: a piece of it, and what stands beside it.
inline constexpr double kTownStreetReach = 280;

/// Where a change of the map can make what stands around a tile another one.
struct SurroundingsReach {
  std::vector<geometry::PlanBox> things;  ///< m: of anything mapped, and of houses
  std::vector<geometry::PlanBox> blocks;  ///< m: of houses, and of what bounds these blocks
};

/// Read-only once made, safe to share between threads; what it is made of outlives it.
class SurroundingsFinder {
 public:
  /// \param height  of the terrain; empty: there is none  \param level  m, of the ground where there is none
  SurroundingsFinder(const SurroundingInputs& inputs, SurroundingOptions layers, HeightAt height, double level,
                     std::uint64_t seed);

  /// Everything in the squares whose middles lie in the tile. Depends on what lies within kSurroundingsReach of these squares,
  /// and on blocks and ways that come there as a whole; not on the tile.
  /// Squares into which nothing mapped comes, no building either, are left out.
  model::Surroundings around(model::TileId tile) const;

  /// All that `around` reads of the map, so that a tile for which it is another counts as changed.
  void pack(model::TileId tile, base::Packer& out) const;

  /// Where that lies. Coasts and wide areas (Thing::wide) as they are now: a new one is heard of from farther away.
  SurroundingsReach reach(model::TileId tile) const;

 private:
  class Heights;
  std::vector<SquareIndex> squares_of(model::TileId tile) const;
  /// The ground, wherever it is; slow: claims are found anew. The sea and areas that
  /// are wide have none: they reach farther than what is read around a tile alone.
  GroundAt ground_anywhere(model::Point2 place, Heights& heights) const;
  void pack_thing(const Thing& thing, const geometry::PlanBox& around, base::Packer& out) const;
  /// GroundLabel::level of still water.
  void set_levels(GroundClaims& claims) const;

  SurroundingInputs in_;
  SurroundingOptions layers_;
  HeightAt height_;
  double level_ = 0;
  std::uint64_t seed_ = 1;
  ClaimFinder claims_;
};

}  // namespace blockrand::surroundings
