// What differs between two builds as a map: for a browser, and as a layer for a GIS.
#pragma once

#include <optional>
#include <string>

#include "pipeline/base/template.h"
#include "pipeline/run/build_changes.h"

namespace blockrand::run {

/// Footprints of what is new, gone or other, as values of changes.html, a drawing for each place, the largest places only: north up,
/// lengths true at its middle latitude. Small ones have a dot. Nothing where nothing has a footprint, or nothing differs.
std::optional<base::Values> changes_map(const BuildChanges& changes);

/// The same as a GeoPackage in WGS 84: layer `buildings` with a row for each that differs, `values` with a row for each value.
/// \throws base::OutputError  it cannot be written
void write_changes_layers(const BuildChanges& changes, const std::string& path);

}  // namespace blockrand::run
