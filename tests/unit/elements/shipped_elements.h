// The elements of configs/, read once.
#pragma once

#include "styles/elements/element_catalogue.h"

namespace blockrand::elements {

const ElementCatalogue& shipped();

}  // namespace blockrand::elements
