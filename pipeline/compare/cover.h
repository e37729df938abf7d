// Which walls are party walls: another building of the same model stands against them, so that nobody sees them.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/compare/city.h"
#include "pipeline/compare/roofs_from_above.h"
#include "pipeline/geometry/box_index.h"

namespace blockrand::compare {

/// m. How far a neighbour may stand off and still cover a wall: models close such gaps or leave them, by their rules of
/// drawing.
inline constexpr double kAgainst = 0.3;

/// The roof that a building has from above: faces of class roof and outer floor.
RoofSurfaces roof_of(const Building& building);

/// What stands around each building of a city.
class Cover {
 public:
  explicit Cover(const City& city);
  /// False where nothing stands near enough to cover anything.
  bool has_neighbours(std::uint32_t building) const {
    return !neighbours_[building].empty() || city_.buildings[building].bodies > 1;
  }
  /// Whether another building covers a place on an upright face: the place lies within that building's footprint when
  /// moved by kAgainst along the normal to either side (files turn faces as they please), below its roof.
  /// Of buildings of several bodies also what stands between two of them: both sides lie in the building.
  /// \param normal  unit vector
  bool covered(std::uint32_t building, Point3 at, Point3 normal) const;

 private:
  /// Whether a place is within a building's footprint and below its roof.
  bool within(std::uint32_t building, Point3 p) const;
  const City& city_;
  std::vector<geometry::PlanBox> boxes_;  ///< of footprints; empty without one
  std::vector<RoofSurfaces> roofs_;
  std::vector<std::vector<std::uint32_t>> neighbours_;
};

/// Sets Face::left_out: `ground` for the class ground, `covered` for walls of which more than half is covered by
/// other buildings or lies between bodies of its own. Measures of
/// the surface decide by place (Cover), not by face; facades and pictures by face.
/// \param jobs  worker threads; 0: one per core
void mark_left_out(City& city, const Cover& cover, int jobs = 1);

}  // namespace blockrand::compare
