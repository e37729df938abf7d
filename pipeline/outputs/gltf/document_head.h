// What every GLB says of itself: who made it, from what, and where it stands on the Earth.
#pragma once

#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/outputs/gltf/glb_writer.h"

namespace blockrand::outputs {

/// Fills `asset`: version, generator, copyright, `extras.georeference`.
void write_head(GlbDocument& document, const GlbOptions& options);

}  // namespace blockrand::outputs
