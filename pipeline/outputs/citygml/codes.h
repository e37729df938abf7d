// Code list values of SIG 3D, which CityGML 2.0 refers to.
#pragma once

#include <string_view>

#include "pipeline/model/roof_shape.h"

namespace blockrand::outputs {

inline constexpr std::string_view kRoofTypeCodeSpace =
    "http://www.sig3d.org/codelists/standard/building/2.0/_AbstractBuilding_roofType.xml";
inline constexpr std::string_view kClassCodeSpace =
    "http://www.sig3d.org/codelists/standard/building/2.0/_AbstractBuilding_class.xml";
inline constexpr std::string_view kUseCodeSpace = "https://wiki.openstreetmap.org/wiki/Key:building";

/// The nearest entry of the roof type list (1000 flat … 1130 combination of roof forms); empty for `other`.
std::string_view roof_type_code(model::RoofShape shape);

/// The entry of the building class list (1000 habitation, 1030 business, 1080 church institution, 1160 industry …) for
/// a value of building=*; empty where no entry fits.
std::string_view class_code(std::string_view use);

}  // namespace blockrand::outputs
