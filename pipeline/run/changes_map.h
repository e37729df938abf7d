// What differs between two builds as a map: for a browser, and as a layer for a GIS.
#pragma once

#include <string>

#include "pipeline/run/build_changes.h"

namespace blockrand::run {

/// Footprints of what is new, gone or other, as drawings in the page (SVG), one for each place, the largest places only: north up,
/// lengths true at its middle latitude. Small ones have a dot. Empty where nothing has a footprint, or nothing differs.
std::string changes_svg(const BuildChanges& changes);

/// The same as a GeoPackage in WGS 84: layer `buildings` with a row for each that differs, `values` with a row for each value.
/// \throws base::OutputError  it cannot be written
void write_changes_layers(const BuildChanges& changes, const std::string& path);

}  // namespace blockrand::run
