// Namespaces and elements of the CityGML that Blockrand writes. Internal to this folder.
#pragma once

#include <string_view>

namespace blockrand::validate {

inline constexpr std::string_view kGml = "http://www.opengis.net/gml", kCore = "http://www.opengis.net/citygml/2.0",
                                  kBuilding = "http://www.opengis.net/citygml/building/2.0",
                                  kGenerics = "http://www.opengis.net/citygml/generics/2.0",
                                  kAppearance = "http://www.opengis.net/citygml/appearance/2.0",
                                  kAddress = "urn:oasis:names:tc:ciq:xsdschema:xAL:2.0",
                                  kLink = "http://www.w3.org/1999/xlink";

/// "roof" for RoofSurface and so on; empty for what is no boundary surface.
std::string_view surface_kind(std::string_view element);

/// "window" for Window, "door" for Door; empty for what is no opening.
std::string_view opening_kind(std::string_view element);

/// Whether an element may stand in a file of Blockrand.
bool known_element(std::string_view space, std::string_view name);

}  // namespace blockrand::validate
