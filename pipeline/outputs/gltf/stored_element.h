// Geometry of elements in a GLB: equal geometry once, whatever colours, places and lengths it has.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pipeline/outputs/gltf/element_geometry.h"
#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/outputs/gltf/material.h"

namespace blockrand::outputs {

/// Geometry as it is stored.
struct StoredElement {
  struct Part {
    model::ElementPart part = model::ElementPart::frame;
    bool screen = false;                       ///< of glass
    int block = 0;                             ///< into `blocks`
    std::size_t first_index = 0, indices = 0;  ///< bytes into the stream, number
  };
  struct Block {
    int position = 0;
    int normal = -1;  ///< accessors; -1: left out
  };
  std::vector<Part> parts;    ///< in the order of ElementPart; indices of one block follow each other
  std::vector<Block> blocks;  ///< vertices that parts share, at most 65,535
  double steps = 0;           ///< of a metre, in which positions are stored; 1 where they are floats
  bool stretched = false;     ///< places have a scale along x
  std::size_t triangles = 0;
  std::map<std::pair<std::size_t, std::size_t>, int> ranges;  ///< accessors of indices by first byte and count
};

/// An element's use of stored geometry.
struct ElementForm {
  int stored = -1;         ///< index; -1: it has no triangles
  double stretch = 1;      ///< of stretched geometry: the scale along x
  model::Point3 min, max;  ///< m, of the element itself
};

/// How vertices of elements are stored.
enum class ElementVertices : std::uint8_t {
  steps,   ///< positions as 16-bit steps, normals as bytes (KHR_mesh_quantization)
  floats,  ///< positions as floats, no normals: readers shade such meshes flat, and no extension is needed
};

class StoredElements {
 public:
  /// \param region, panes  must outlive it; panes that are not as modelled need them
  StoredElements(GlbDocument& document, ElementVertices how, const model::Region& region,
                 const PaneMaterials* panes = nullptr)
      : document_(document), how_(how), region_(region), panes_(panes) {}

  /// Writes what was not there yet.
  ElementForm form(const model::Element& element, Panes panes = Panes::as_modelled);
  const StoredElement& operator[](int stored) const { return stored_[static_cast<std::size_t>(stored)]; }
  /// The accessor of the indices of parts [first, last], which are of one block.
  int indices(int stored, std::size_t first, std::size_t last);

  /// What two elements with equal meshes have in common: geometry and the looks of its parts.
  std::vector<int> mesh_key(int stored, const model::ColouredElement& element, Panes panes) const;
  /// Adds a mesh of the geometry in the colours of `element`; neighbouring parts that look the same are one primitive.
  /// \return its number
  int add_mesh(int stored, const model::ColouredElement& element, Panes panes, MaterialName name);

 private:
  StoredElement::Block store_block(const std::vector<float>& positions, const std::vector<std::int8_t>& normals,
                                   std::size_t count, const std::array<std::array<double, 3>, 2>& bounds);
  int store(ElementGeometry geometry, double steps, bool stretched);
  model::PartMaterial look(const StoredElement::Part& part, const model::ColouredElement& element, Panes panes) const;

  GlbDocument& document_;
  ElementVertices how_;
  const model::Region& region_;
  const PaneMaterials* panes_;
  std::vector<StoredElement> stored_;
  std::map<std::pair<const model::Element*, Panes>, ElementForm> forms_;  // looked up only: its order reaches nothing
  std::map<std::string, int> known_;                                      ///< by the bytes of the geometry
};

}  // namespace blockrand::outputs
