// Materials as glTF has them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "pipeline/model/colour.h"
#include "pipeline/model/solid.h"

namespace blockrand::outputs {

/// What a material is called.
enum class MaterialName : std::uint8_t {
  plain,        ///< "brick": several of a file may be called so
  with_colour,  ///< "brick #8c4a32": each has a name of its own, for programs that list them
};

/// The JSON of a material. \param colour  of all that has it; nothing where vertices carry their own
std::string material_json(const model::MaterialClass& material, const std::optional<model::Colour>& colour,
                          MaterialName name = MaterialName::plain);

}  // namespace blockrand::outputs
