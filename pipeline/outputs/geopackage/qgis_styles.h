// How the GeoPackage's layers look in QGIS.
#pragma once

#include <vector>

#include "pipeline/layer_file/layer_file.h"

namespace blockrand::outputs {

using layer_file::QgisStyle;

/// buildings: by storeys (default), by built roof, by the source of the storeys, by position; parts: by built roof (default), by
/// level of detail; reported: by code (default); tiles: outlines (default); facade_edges: by kind
/// (default) in the colours of model/wall_segment_colours.h; blocks: by floor area ratio (default), by closure; courtyards: closed
/// or open (default); cells: by built share (default), by storeys; surfaces: by class (default).
/// Buildings are labelled with house numbers at 1:2500 and larger.
/// \param images  with the layers footprint_before, by what was done, and unmapped, by probability
std::vector<QgisStyle> qgis_styles(bool images = false);

}  // namespace blockrand::outputs
