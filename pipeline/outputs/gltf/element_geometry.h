// Facade elements as triangles, and where they stand in a tile's frame.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/model/region.h"
#include "pipeline/outputs/frame.h"
#include "pipeline/outputs/gltf/panes.h"

namespace blockrand::outputs {

/// A corner in the element's frame.
struct ElementVertex {
  model::Point3 position;               ///< m: x right, y up, z out of the wall
  std::array<std::int8_t, 3> normal{};  ///< in 1/127, the same axes
  model::Point3 exact_normal;           ///< unit vector, for those who turn it before they round it
};

/// The triangles of an element by part; vertices are shared within a part.
struct ElementGeometry {
  struct PartTriangles {
    model::ElementPart part = model::ElementPart::frame;
    bool screen = false;  ///< of glass: there is fabric behind it
    std::vector<ElementVertex> vertices;
    std::vector<std::uint32_t> indices;  ///< counter-clockwise from outside
  };
  /// In the order of ElementPart, of glass what has no fabric behind it first; none is empty, none has more than kMostVertices.
  std::vector<PartTriangles> parts;
  model::Point3 min, max;  ///< m
  static constexpr std::size_t kMostVertices = 65535;
};

/// \param with_reveal  also the strip from the wall to the opening's end, as part `wall`, which solids have as faces
/// \param panes  what is seen in its glass
ElementGeometry element_geometry(const model::Element& element, bool with_reveal, Panes panes = Panes::as_modelled);

/// The box around all its triangles, m: min and max of the geometry; nothing where it has none.
std::optional<std::pair<model::Point3, model::Point3>> element_box(const model::Element& element, bool with_reveal);

/// An element where it stands, in east, north, up.
struct ElementInstance {
  std::uint32_t feature = 0;  ///< row of the property table
  model::Point3 origin;       ///< m
  model::Point2 along;        ///< unit vector, east and north
};

/// All places of one element with the same panes.
struct InstanceGroup {
  std::uint32_t element = 0;  ///< into Region::elements
  Panes panes = Panes::as_modelled;
  std::vector<ElementInstance> instances;
};

/// The placements of elements with a shape, of parts that were built at LoD3, by element; features as build_mesh()
/// counts them. \param glazed  what is seen in their panes differs; else they are as modelled
std::vector<InstanceGroup> element_instances(const model::Region& region, const Frame& frame, bool glazed = false);

/// An element of one part.
struct PartElement {
  std::uint32_t element = 0;  ///< into Region::elements
  Panes panes = Panes::as_modelled;
  const ElementInstance* at = nullptr;
};

/// All places by part: by ascending feature, within it in the order of the groups, which must outlive the list.
std::vector<PartElement> elements_by_part(const std::vector<InstanceGroup>& groups);

}  // namespace blockrand::outputs
