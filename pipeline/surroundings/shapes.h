// The shapes of things around the houses, made of bodies of few triangles: [shape.NAME] of configs/surroundings.toml.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "pipeline/base/toml_file.h"
#include "pipeline/model/surroundings.h"

namespace blockrand::surroundings {

/// The row of the material that a key of a table names.
using MaterialOf = std::function<model::SurroundingMaterial(base::TomlTable& table, std::string_view key)>;

/// Triangles of one material are one part, in the order in which the materials first come. Corners lie on the 1/1024 m grid.
/// \throws base::InputError with file, line and column for anything unknown, missing or out of range
model::ObjectShape read_shape(base::TomlTable& table, const std::string& name, const MaterialOf& material);

}  // namespace blockrand::surroundings
