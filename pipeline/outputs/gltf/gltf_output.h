// 3D Tiles with GLB: tileset.json and tiles/, with --single-glb model.glb.
#pragma once

#include "pipeline/outputs/output.h"

namespace blockrand::outputs {

OutputFormat gltf_output();

}  // namespace blockrand::outputs
