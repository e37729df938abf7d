// The kinds that the program makes itself. Internal to this folder.
#pragma once

#include <span>

#include "styles/elements/parameters.h"

namespace blockrand::elements {

/// In the order of docs/elements.md.
std::span<const ElementKind> built_in_kinds();
/// The generator of each, parallel to built_in_kinds().
std::span<const Generator> generators();

}  // namespace blockrand::elements
