// Placed elements in a glTF model: each stored once, placed many times.
#pragma once

#include <cstddef>
#include <vector>

#include "pipeline/export/gltf/element_geometry.h"

namespace tinygltf {
class Model;
}

namespace blockrand::export_ {

/// How placed elements are written.
enum class Instancing : std::uint8_t {
  ext,    ///< EXT_mesh_gpu_instancing with EXT_instance_features: a node per element, a row of the property table per
          ///< place
  nodes,  ///< a node per place, for programs without that extension; `extras.feature` is the row
  baked,  ///< triangles like all others: the largest file, which every program reads
};

/// What was written.
struct InstanceFigures {
  std::size_t elements = 0;  ///< distinct ones
  std::size_t places = 0;
  std::size_t triangles = 0;  ///< as drawn: of an element once for each place
  model::Point3 min, max;     ///< of the places' origins, widened by the reach of their elements; zero without places
};

/// Adds meshes, materials, nodes and their bytes for `ext` or `nodes`; nodes are added to the model's first scene,
/// which is made when there is none. Equal geometry in other colours shares its accessors. Positions are 16-bit
/// integers in steps of 1/4096 m (the node's scale), float for elements larger than 8 m. \param label  class of the
/// property table 0 that features are rows of
InstanceFigures write_instances(tinygltf::Model& model, const model::Region& region,
                                const std::vector<InstanceGroup>& groups, Instancing how, const char* label);

}  // namespace blockrand::export_
