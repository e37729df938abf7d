// The file configs/materials/textures.toml: which material of walls, roofs and grounds has which texture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/textures/texture.h"

namespace blockrand::textures {

enum class Surface : std::uint8_t { wall, roof, ground };

class TextureCatalogue {
 public:
  /// \throws base::InputError  missing, not TOML, unknown key or word, measures that do not repeat: file, line, column, remedy
  static TextureCatalogue read(const std::string& path);
  /// As read. \param path  what messages call the text
  static TextureCatalogue parse(std::string_view text, const std::string& path);

  /// In the order of the file.
  const std::vector<TextureRow>& rows() const { return rows_; }
  /// The row of a material on such a surface, or -1: it is shown plain (glass, water).
  int find(Surface surface, std::string_view material) const;
  /// All materials that the file names for such a surface, by name: the caller knows which there are.
  std::vector<std::string> materials(Surface surface) const;

 private:
  std::vector<TextureRow> rows_;
  std::map<std::string, int, std::less<>> by_material_[3];
};

}  // namespace blockrand::textures
