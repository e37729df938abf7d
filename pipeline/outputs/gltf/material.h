// Materials as glTF has them.
#pragma once

#include <optional>
#include <string>

#include "pipeline/model/colour.h"
#include "pipeline/model/solid.h"

namespace blockrand::outputs {

/// The JSON of a material. \param colour  of all that has it; nothing where vertices carry their own
std::string material_json(const model::MaterialClass& material, const std::optional<model::Colour>& colour);

}  // namespace blockrand::outputs
