#include "pipeline/run/build_inputs.h"

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "importers/imagery/image_files.h"
#include "importers/reference/triangle_model.h"
#include "pipeline/base/sha256.h"

namespace blockrand::run {

namespace {

std::optional<importers::elevation::Terrain> open_terrain(const std::string& path,
                                                          const context::AskedReference& asked) {
  if (path.empty()) return std::nullopt;
  return std::optional<importers::elevation::Terrain>(std::in_place, path, asked.metres_per_unit);
}

std::vector<importers::imagery::AerialImage> open_images(const observation::ImageryOptions& options) {
  std::vector<importers::imagery::AerialImage> images;
  for (const importers::imagery::ImageSource& source : options.images) images.emplace_back(source);
  return images;
}

attributes::Overrides open_overrides(const std::string& path, const attributes::Defaults& defaults,
                                     const districts::RuleSets& book) {
  if (path.empty()) return {};
  attributes::OverrideNames names{{}, book.substyles};
  for (const districts::Preset& p : book.presets) names.presets.push_back(p.name);
  return attributes::read_overrides(path, defaults, names);
}

InputFile input_file(std::string role, const std::string& path) {
  InputFile f{std::move(role), path, 0, base::sha256_file(path)};
  std::error_code no_size;  // of devices: /dev/null is an empty file of corrections
  if (const auto bytes = std::filesystem::file_size(path, no_size); !no_size) f.bytes = bytes;
  return f;
}

constexpr const char* kTexturesFile = "materials/textures.toml";

}  // namespace

BuildInputs::BuildInputs(const BuildOptions& options)
    : defaults(attributes::read_defaults(options.configs)),
      asked(context::read_height_reference(options.terrain_height_reference)),
      terrain(open_terrain(options.terrain, asked)),
      images(open_images(options.imagery)),
      heights(context::choose_height_reference(terrain ? &terrain->describe() : nullptr, asked,
                                               options.ground_height.has_value())),
      tile(choose_tile(options)),
      tables(classify::Tables::read(options.configs)),
      rules(attributes::read_rule_sets(options.configs, options.districts)) {
  if (options.lod >= 3)
    grammars.emplace(
        facades::read_grammars(options.configs, rules.book.presets, importers::reference::read_triangle_model));
  if (options.surroundings.any()) surroundings.emplace(options.configs + "/surroundings.toml");
  if (options.outputs.textures != outputs::TextureChoice::none)
    textures = textures::TextureCatalogue::read(options.configs + "/" + kTexturesFile);
  overrides = open_overrides(options.overrides, defaults, rules.book);
  if (options.lod >= 2) landmarks = read_landmarks(overrides);
}

std::string BuildInputs::rule_file(std::string_view preset) const {
  const facades::GrammarLibrary::Entry* entry = grammars ? grammars->find(preset) : nullptr;
  return entry ? entry->file : std::string();
}

std::vector<InputFile> input_files(const BuildOptions& options, const BuildInputs& inputs) {
  std::vector<InputFile> files;
  if (inputs.terrain) files.push_back(input_file("terrain", options.terrain));
  for (const importers::imagery::ImageSource& s : options.imagery.images)
    for (importers::imagery::ImageFile& f : importers::imagery::files_of_image(s.path))
      files.push_back({"imagery", std::move(f.path), f.bytes, std::move(f.sha256)});
  std::vector<std::pair<std::string, std::string>> configs = {
      {"defaults/uses.toml", options.configs + "/defaults/uses.toml"},
      {"materials/materials.toml", options.configs + "/materials/materials.toml"}};
  for (const char* name : classify::kTableFiles)
    configs.emplace_back(std::string("styles/") + name, options.configs + "/styles/" + name);
  configs.insert(configs.end(), inputs.rules.files.begin(), inputs.rules.files.end());
  if (inputs.grammars)
    for (const std::string& path : inputs.grammars->files())
      configs.emplace_back("grammars/" + std::filesystem::path(path).filename().string(), path);
  // profiles/… and elements/…, of configs or beside a rule set.
  if (inputs.grammars)
    for (const std::string& path : inputs.grammars->elements().files()) {
      const std::filesystem::path file(path);
      configs.emplace_back((file.parent_path().filename() / file.filename()).generic_string(), path);
    }
  if (inputs.surroundings) configs.emplace_back("surroundings.toml", options.configs + "/surroundings.toml");
  if (inputs.textures) configs.emplace_back(kTexturesFile, options.configs + "/" + kTexturesFile);
  for (const auto& [name, path] : configs) {
    files.push_back(input_file("config", path));
    files.back().path = name;
  }
  if (!options.overrides.empty()) files.push_back(input_file("overrides", options.overrides));
  for (const ReadLandmark& landmark : inputs.landmarks) {
    files.push_back(input_file("model", landmark.order.path));
    files.back().path = landmark.order.file;
  }
  return files;
}

InputFile extract_file(const BuildOptions& options) {
  InputFile file = input_file("extract", options.input);
  if (!options.input_told.empty()) file.path = options.input_told;
  return file;
}

}  // namespace blockrand::run
