// Lean CityGML against a format that has everything: what it leaves out must be just that.
#pragma once

#include <string>

#include "pipeline/validate/contents.h"

namespace blockrand::validate {

/// The bodies of another format as lean CityGML has them: windows and doors of LoD3 moved out to their walls, no reveals,
/// ReadOpening::depth how far they were moved. Elements stay.
Contents without_reveals(const Contents& contents);

/// The first thing in which a body of lean CityGML differs from the same one of without_reveals(), its polygons aside:
/// depths of reveals, elements that stand elsewhere, reach further or have other colours, elements missing that stand in
/// no opening, bodies on walls and roofs. Empty: none.
std::string lean_difference(const ReadBody& lean, const Contents& of_lean, const ReadBody& full,
                            const Contents& of_full);

}  // namespace blockrand::validate
