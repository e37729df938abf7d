// The textures of a build: made when a tile asks for one first, shared by all tiles, written once.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/base/publish.h"
#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/textures/texture_catalogue.h"

namespace blockrand::outputs {

/// Of pictures beside tilesets and models: "textures/brick.webp", "textures/brick_normal.webp", "textures/brick_orm.webp".
inline constexpr std::string_view kTextureFolder = "textures/";

/// For several threads at once.
class TextureSet {
 public:
  TextureSet(const textures::TextureCatalogue& catalogue, textures::TextureSize size);

  /// The row of a material, or -1: it is shown plain.
  int find(textures::Surface surface, std::string_view material) const { return catalogue_.find(surface, material); }
  const textures::TextureRow& row(int row) const { return catalogue_.rows()[static_cast<std::size_t>(row)]; }
  /// Of its base colour, in linear light. Makes the texture at the first call.
  const std::array<double, 3>& mean(int row) const { return maps(row).mean; }

  /// Writes the files of these rows: WebP, and PNG for those who do not read it.
  /// \param rows  by name; unknown ones, of another program's build, are left out
  /// \return bytes of WebP and of PNG
  std::pair<std::size_t, std::size_t> write(const std::set<std::string>& names, base::StagedFolder& folder,
                                            std::vector<base::PublishedFile>& files) const;

  /// The material of a texture with a class's name, in a document beside which `folder` leads to the pictures.
  /// \param scale  repeats that a texture coordinate of 1 stands for
  /// \param tint   linear light that the texture is multiplied with; nothing where vertices carry it
  int add_material(GlbDocument& document, int row, std::string_view material, const std::string& folder, double scale,
                   const std::optional<std::array<double, 3>>& tint) const;

 private:
  struct Made {
    std::once_flag once;
    textures::TextureMaps maps;
  };
  const textures::TextureMaps& maps(int row) const;

  const textures::TextureCatalogue& catalogue_;
  textures::TextureSize size_;
  std::unique_ptr<Made[]> made_;
};

}  // namespace blockrand::outputs
