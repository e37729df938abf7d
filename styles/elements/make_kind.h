// Makes an element of a kind: checks size and parameters, and names what was made. Internal to this folder.
#pragma once

#include <functional>

#include "styles/elements/element_catalogue.h"
#include "styles/elements/parameters.h"

namespace blockrand::elements {

/// Fills opening and mesh; a Generator, or what an element file says.
using Maker = std::function<Made(const Request&, Element&)>;

/// As ElementCatalogue::make() and make_fitting().
tl::expected<Element, std::string> make_kind(const ElementKind& kind, const Maker& maker, double width, double height,
                                             std::span<const Parameter> parameters, const ProfileLibrary& profiles);
tl::expected<FittedElement, std::string> make_fitting_kind(const ElementKind& kind, const Maker& maker, double width,
                                                           double height, std::span<const Parameter> parameters,
                                                           const ProfileLibrary& profiles);

}  // namespace blockrand::elements
