#include "pipeline/outputs/gltf/texture_set.h"

#include <array>
#include <utility>

#include "pipeline/base/parallel.h"
#include "pipeline/outputs/number_text.h"
#include "pipeline/picture/image.h"
#include "pipeline/textures/texture_files.h"

namespace blockrand::outputs {
namespace {

/// The pictures of a texture: how their files end, how well they are kept (0 to 100). Faults of normals show as blocks in
/// the sheen; roughness is not seen as such.
struct Picture {
  std::string_view ending;
  int quality;
  std::vector<std::uint8_t> textures::TextureMaps::*pixels;
};
constexpr std::array<Picture, 3> kPictures = {{{"", 90, &textures::TextureMaps::base},
                                               {"_normal", 90, &textures::TextureMaps::normal},
                                               {"_orm", 70, &textures::TextureMaps::orm}}};

std::string texture_info(int index, double scale) {
  if (scale == 1) return "{\"index\":" + std::to_string(index) + '}';
  std::string json = "{\"extensions\":{\"KHR_texture_transform\":{\"scale\":[";
  append_number(json, scale);
  json += ',';
  append_number(json, scale);
  json += "]}},\"index\":";
  append_number(json, std::int64_t{index});
  return json + '}';
}

}  // namespace

TextureSet::TextureSet(const textures::TextureCatalogue& catalogue, textures::TextureSize size)
    : catalogue_(catalogue), size_(size), made_(std::make_unique<Made[]>(catalogue.rows().size())) {}

const textures::TextureMaps& TextureSet::maps(int row) const {
  Made& made = made_[static_cast<std::size_t>(row)];
  std::call_once(made.once, [&] { made.maps = textures::make_maps(this->row(row), size_); });
  return made.maps;
}

std::pair<std::size_t, std::size_t> TextureSet::write(const std::set<std::string>& names, base::StagedFolder& folder,
                                                      std::vector<base::PublishedFile>& files) const {
  struct File {
    std::string path, bytes;
  };
  std::vector<std::pair<int, const Picture*>> wanted;
  for (std::size_t row = 0; row < catalogue_.rows().size(); ++row)
    if (names.contains(catalogue_.rows()[row].name))
      for (const Picture& picture : kPictures) wanted.emplace_back(static_cast<int>(row), &picture);
  std::vector<std::array<File, 2>> made(wanted.size());
  base::share(wanted.size(), [&](std::size_t i) {
    const auto& [row, picture] = wanted[i];
    const textures::TextureMaps& of = maps(row);
    const std::string path = std::string(kTextureFolder) + this->row(row).name + std::string(picture->ending);
    made[i][0] = {path + ".webp", textures::webp(of.*picture->pixels, of.pixels, picture->quality)};
    made[i][1] = {path + ".png", picture::png({of.pixels, of.pixels, of.*picture->pixels})};
  });
  std::array<std::size_t, 2> bytes{};
  for (const auto& both : made)
    for (std::size_t k = 0; k < both.size(); ++k) {
      files.push_back(folder.write(both[k].path, both[k].bytes));
      bytes[k] += both[k].bytes.size();
    }
  return {bytes[0], bytes[1]};
}

int TextureSet::add_material(GlbDocument& document, int row, std::string_view material, const std::string& folder,
                             double scale, const std::optional<std::array<double, 3>>& tint) const {
  std::array<std::string, kPictures.size()> infos;
  for (std::size_t i = 0; i < kPictures.size(); ++i) {
    if (i == 1 && tint) continue;
    const std::string path = folder + this->row(row).name + std::string(kPictures[i].ending);
    infos[i] = texture_info(document.add_repeated_texture(path + ".webp", path + ".png"), scale);
  }
  // What colours must be multiplied with to be those of the data.
  std::string json = "{\"extras\":{\"texture_mean\":[";
  for (const double part : mean(row)) {
    if (json.back() != '[') json += ',';
    append_number(json, part);
  }
  json += "]},\"name\":";
  append_json(json, material);
  // Readers would have to make tangents for vertices without normals, each its own.
  if (!tint) json += ",\"normalTexture\":" + infos[1];
  json += ",\"pbrMetallicRoughness\":{";
  if (tint) {
    json += "\"baseColorFactor\":[";
    for (const double part : *tint) {
      append_number(json, part);
      json += ',';
    }
    json += "1],";
  }
  json += "\"baseColorTexture\":" + infos[0] + ",\"metallicRoughnessTexture\":" + infos[2] + "}}";
  if (scale != 1) document.use("KHR_texture_transform", false);
  return document.add_material(json);
}

}  // namespace blockrand::outputs
