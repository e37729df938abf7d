// Rules that begin on a footprint, as published files do: the shape they begin with, the values they ask for under their OSM
// names, and what they make as surfaces that stand for LoD3.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/facades/facade_segments.h"
#include "pipeline/facades/wall_frame.h"
#include "pipeline/model/building.h"
#include "styles/grammar/evaluation/derive.h"
#include "styles/grammar/shapes/scope.h"

namespace blockrand::facades {

/// The plan of a part as rules begin with it.
struct FootprintShape {
  grammar::Shape shape;  ///< its first edge is the main front, where one is known; else the longest
  grammar::Frame
      world;  ///< world coordinates of the rules (x east, y up, z south, m) in the build CRS (east, north, up)
};

/// \param base      m above the height reference: where the shape lies
/// \param segments  of the part's walls; edges on streets are what `street.*` selects
FootprintShape footprint_shape(const model::BuildingPart& part, double base, std::span<const WallFrame> walls,
                               std::span<const FacadeSegment> segments, const model::Building& building);

/// What the part is, under the keys of OSM: resolved values first, in metres and "#rrggbb", then its other tags and its building's.
/// A name may stand twice; the first counts.
/// \param extract  may be null: no tags
std::vector<std::pair<std::string, grammar::Value>> osm_attributes(const model::Building& building,
                                                                   const model::BuildingPart& part,
                                                                   const model::Extract* extract);

/// Surfaces that rules made, one after the other.
class RuleSurfaces {
 public:
  /// Corners of one part: what is beyond is told, and left out.
  static constexpr std::size_t kMostCorners = 2'000'000;

  /// \param body  they are of an opaque leaf with an inside: where two such leaves touch, both faces are hidden and left out
  void add(const std::string& rule, std::vector<model::Point3> polygon, const model::PartMaterial& look, bool body);
  bool empty() const { return faces_.empty(); }
  std::size_t corners() const { return corners_; }

  struct Made {
    model::Solid surfaces;  ///< not closed
    model::SolidTriangles triangles;
    std::vector<model::RuleFaces> rules;  ///< in the order of their first faces
  };
  /// \param ground  m: faces that look down there are the ground surface
  Made take(double ground);

 private:
  struct MadeFace {
    std::size_t rule;
    std::vector<model::Point3> polygon;  ///< on the grid
    model::PartMaterial look;
    bool body;
  };
  void drop_hidden();
  std::vector<std::string> rules_;
  std::map<std::string, std::size_t> number_;
  std::vector<MadeFace> faces_;
  std::size_t corners_ = 0;
};

}  // namespace blockrand::facades
