// What the masses know of the bodies they built and hand on within the tile: a finished solid does not tell it any more.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/model/polygon.h"
#include "styles/roofs/gables.h"
#include "styles/roofs/roof.h"

namespace blockrand::masses {

/// What rules for roofs say of a roof's edges, m; what is empty follows age and size (facades::add_roof_edges).
struct RoofEdgeOrders {
  std::optional<double> eaves, verge;  ///< out from the wall; 0: none
  std::optional<double> parapet;       ///< high; 0: none
  bool caps = true;                    ///< along ridges and hips, where the material has some
  bool gutters = false;                ///< along eaves
  bool downpipes = false;              ///< from gutters to the ground, where there is room
};

/// The plan that a body's LoD2 solid stands on and the roof that closes it, in the solid's own points: what later stages
/// put on the roof stands on the very faces that are written.
struct BuiltMass {
  model::Polygon plan;  ///< may be simpler than BuildingPart::roof_plan; edges are numbered as those of `roof`
  double bottom = 0;    ///< m above the build's height reference: z of the underside
  roofs::Roof roof;
  std::optional<roofs::GableOptions> gable;  ///< rules for roofs want it before what looks on a street; LoD3
  RoofEdgeOrders edge_orders;
};

/// Plan and roof as geometry::SolidBuilder makes faces of them: points rounded to the 1/1024 m grid, repetitions within
/// a loop dropped, surfaces and holes left out that keep fewer than three points. Numbers of surfaces are those of the
/// solid's faces after its walls; envelope() of the result is the solid again.
/// \param plan  strictly simple, as envelope() wants it
BuiltMass built_mass(const model::Polygon& plan, double bottom, const roofs::Roof& roof);

/// A body of a tile: its building's place in Region::buildings and its own in Building::parts.
struct BodyIndex {
  std::uint32_t building = 0, part = 0;
  friend auto operator<=>(const BodyIndex&, const BodyIndex&) = default;
};

/// What build_masses() hands on of a tile's bodies; lives as long as stages of that tile ask for it.
class BuiltMasses {
 public:
  struct Entry {
    BodyIndex body;
    BuiltMass mass;
  };
  BuiltMasses() = default;
  /// \param entries  in ascending order, each body at most once
  explicit BuiltMasses(std::vector<Entry> entries);
  /// Null for bodies without a LoD2 solid.
  const BuiltMass* find(BodyIndex body) const;
  /// The same. LoD3 puts dormers and cross gables on its roof; for one thread a body.
  BuiltMass* find(BodyIndex body);

 private:
  std::vector<Entry> entries_;
};

}  // namespace blockrand::masses
