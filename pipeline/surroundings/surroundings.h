// What stands and lies around the houses of a tile.
#pragma once

#include <cstdint>

#include "pipeline/base/pack.h"
#include "pipeline/model/region.h"
#include "pipeline/surroundings/ground_claims.h"
#include "pipeline/surroundings/ground_height.h"
#include "pipeline/surroundings/options.h"

namespace blockrand::surroundings {

/// m: how far around its squares a tile's surroundings read: streets that reach in, houses beside them.
inline constexpr double kSurroundingsReach = kStreetReach + kBuiltUpReach;

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

  /// What becomes of objects of which no built tile has a square: their kinds, by index of SurroundingKind.
  const ClaimFinder& claims() const { return claims_; }

 private:
  std::vector<SquareIndex> squares_of(model::TileId tile) const;
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
