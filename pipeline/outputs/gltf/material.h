// Materials as glTF has them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
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

/// One material for all that a tile shows: colours are those of vertices, metallic and roughness factors pixels of a
/// picture of one row, one for each class. Their names are `extras.classes`.
class MaterialTable {
 public:
  /// \param classes  at most 256, must outlive it
  explicit MaterialTable(std::span<const model::MaterialClass> classes);
  /// A PNG, the same bytes everywhere.
  std::string png() const;
  std::string material_json(int texture) const;
  /// Where vertices of a class look the picture up: u and v in 1/65535.
  std::array<std::uint16_t, 2> place(std::uint8_t material) const;

 private:
  std::span<const model::MaterialClass> classes_;
  std::size_t width_ = 1;  ///< a power of two
};

}  // namespace blockrand::outputs
