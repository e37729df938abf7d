// `blockrand grammar run --edge` and `--block`: a rule file on the walls of a house that stands nowhere.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pipeline/facades/facade_context.h"
#include "pipeline/outputs/gltf/triangle_glb.h"
#include "styles/elements/element_catalogue.h"
#include "styles/grammar/evaluation/derive.h"

namespace blockrand::cli {

/// A wall of the house: what the derivation begins with, and what its rules can ask for.
struct TrialWall {
  grammar::Shape shape;
  std::size_t wall = 0;  ///< of the house
};

/// A free-standing block of W x D m with as many storeys of 3.2 m as given on a plinth of 0.4 m; its street front looks south, its
/// courtyard front north; the sides are party walls, or of the kind that is asked for.
class TrialHouse {
 public:
  /// \param front  kind of the front: street, courtyard, side, passage
  TrialHouse(double width, double depth, double storeys, model::WallSegmentKind front);
  /// The front alone, or the front and the back as well.
  std::vector<TrialWall> walls(bool both) const;
  /// Values of docs/grammar_attributes.md on a wall. The house must outlive it.
  grammar::AttributeSource values(std::size_t wall) const;
  const model::BuildingPart& part() const { return building_.parts[0]; }

 private:
  model::Building building_;
  std::vector<facades::WallFrame> walls_;
  std::vector<facades::FacadeSegment> segments_;
  std::vector<std::unique_ptr<facades::FacadeContext>> contexts_;
};

/// Elements that leaves order, where they are. \param complaints  gets what cannot be made, one sentence each
std::vector<outputs::ColouredTriangles> element_triangles(const grammar::Derivation& derivation,
                                                          const TrialHouse& house,
                                                          const elements::ElementCatalogue& elements,
                                                          std::vector<std::string>& complaints);

}  // namespace blockrand::cli
