// Placed pieces of elements in a GLB: a draw for each shape.
#pragma once

#include <cstddef>
#include <vector>

#include "pipeline/outputs/gltf/element_pieces.h"
#include "pipeline/outputs/gltf/instance_writer.h"
#include "pipeline/outputs/gltf/material.h"

namespace blockrand::outputs {

class GlbDocument;

/// Adds a node for each placed shape of the plan (EXT_mesh_gpu_instancing, EXT_instance_features), below one whose scale
/// turns steps of 1/2048 m into metres. Places are whole steps; positions of shapes are 16-bit integers.
///
/// Shapes whose faces lie along the axes fill one cube, whatever their size, and share the accessors of their vertices;
/// the others have their own. \param groups  of which the plan is: their boxes give the figures
/// \param rows  of the property table 0, which features are rows of
/// \param panes  with which the plan was made; null: panes are part of fillings
InstanceFigures write_pieces(GlbDocument& document, const model::Region& region,
                             const std::vector<InstanceGroup>& groups, const PiecePlan& plan, int material,
                             const MaterialTable& materials, std::size_t rows, const PaneMaterials* panes = nullptr);

}  // namespace blockrand::outputs
