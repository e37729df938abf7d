// Placed elements in a GLB: each stored once, placed many times.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "pipeline/outputs/gltf/element_geometry.h"

namespace blockrand::outputs {

class GlbDocument;

/// How placed elements are written.
enum class Instancing : std::uint8_t {
  ext,    ///< EXT_mesh_gpu_instancing with EXT_instance_features: a node per shape, a row of the property table per
          ///< place; pieces that stand nowhere else are triangles like all others (element_pieces.h)
  nodes,  ///< a node per place, for programs without that extension; `extras.feature` is the row
  baked,  ///< triangles like all others: the largest file, which every program reads
};

/// The quaternion of a turn about the upright axis of glTF that leads east to `along`, by half angles without
/// trigonometry. \param along  unit vector, east and north
std::array<double, 4> rotation_to(const model::Point2& along);

/// What was written.
struct InstanceFigures {
  std::size_t elements = 0;  ///< distinct ones
  std::size_t places = 0;
  std::size_t triangles = 0;  ///< as drawn: of an element once for each place
  model::Point3 min, max;     ///< of the boxes of all placed elements, in east, north, up; zero without places
};

/// Widens the box of what is placed by an element. \param min, max  m, of the element in its own frame
void widen(InstanceFigures& figures, const ElementInstance& at, const model::Point3& min, const model::Point3& max,
           bool first);

/// Adds meshes, materials, nodes and their bytes for `nodes`. The root holds a node per step, whose scale
/// turns steps into metres, and that holds the elements: positions are 16-bit integers in steps of 1/4096 m (of 1/2048
/// m and so on for elements that reach farther than 8 m), places are whole steps.
///
/// Equal geometry in other colours shares its accessors. Elements that are a profile drawn along the wall (all corners
/// at one of two ends) are stored once for every length: places have a scale along x.
/// \param panes  where groups have other panes than as modelled; may be null otherwise
InstanceFigures write_instances(GlbDocument& document, const model::Region& region,
                                const std::vector<InstanceGroup>& groups, const PaneMaterials* panes = nullptr);

}  // namespace blockrand::outputs
