// Geometry of elements in a GLB: equal geometry once, whatever colours, places and lengths it has.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pipeline/outputs/gltf/element_geometry.h"
#include "pipeline/outputs/gltf/glb_document.h"

namespace blockrand::outputs {

/// Geometry as it is stored.
struct StoredElement {
  struct Part {
    model::ElementPart part = model::ElementPart::frame;
    int block = 0;                             ///< into `blocks`
    std::size_t first_index = 0, indices = 0;  ///< bytes into the stream, number
  };
  struct Block {
    int position = 0, normal = 0;  ///< accessors
  };
  std::vector<Part> parts;    ///< in the order of ElementPart; indices of one block follow each other
  std::vector<Block> blocks;  ///< vertices that parts share, at most 65,535
  double steps = 0;           ///< of a metre
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

class StoredElements {
 public:
  explicit StoredElements(GlbDocument& document) : document_(document) {}

  /// Writes what was not there yet.
  ElementForm form(const model::Element& element);
  const StoredElement& operator[](int stored) const { return stored_[static_cast<std::size_t>(stored)]; }
  /// The accessor of the indices of parts [first, last], which are of one block.
  int indices(int stored, std::size_t first, std::size_t last);

 private:
  int store(ElementGeometry geometry, double steps, bool stretched);

  GlbDocument& document_;
  std::vector<StoredElement> stored_;
  std::map<const model::Element*, ElementForm> forms_;  // looked up only: its order reaches nothing
  std::map<std::string, int> known_;                    ///< by the bytes of the geometry
};

}  // namespace blockrand::outputs
