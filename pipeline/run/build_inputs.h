// What a build reads beside the extract, all of it before: what can be refused without the extract is refused first.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "importers/elevation/terrain.h"
#include "importers/imagery/aerial_image.h"
#include "pipeline/attributes/defaults.h"
#include "pipeline/attributes/overrides.h"
#include "pipeline/attributes/rule_sets.h"
#include "pipeline/context/height_reference.h"
#include "pipeline/facades/grammar_library.h"
#include "pipeline/run/documents.h"
#include "pipeline/run/landmarks.h"
#include "pipeline/run/options.h"
#include "pipeline/run/tile_choice.h"
#include "pipeline/surroundings/catalogue.h"
#include "pipeline/textures/texture_catalogue.h"
#include "styles/classify/classify.h"

namespace blockrand::run {

struct BuildInputs {
  /// Reads everything. \throws base::InputError, base::UsageError
  explicit BuildInputs(const BuildOptions& options);

  attributes::Defaults defaults;
  context::AskedReference asked;
  std::optional<importers::elevation::Terrain> terrain;
  std::vector<importers::imagery::AerialImage> images;
  context::HeightReference heights;
  std::optional<TileChoice> tile;  ///< empty: the whole extract
  classify::Tables tables;
  attributes::ReadRuleSets rules;
  std::optional<facades::GrammarLibrary> grammars;  ///< of LoD3
  attributes::Overrides overrides;
  std::optional<surroundings::Catalogue> surroundings;  ///< where they are asked for
  std::optional<textures::TextureCatalogue> textures;   ///< where they are asked for
  std::vector<ReadLandmark> landmarks;  ///< models that overrides put in the place of buildings; from LoD2 on

  /// The rule file of a preset; empty for one without, or where facades were not asked for.
  std::string rule_file(std::string_view preset) const;
};

/// The file by which the data came.
InputFile extract_file(const BuildOptions& options);

/// Every other file that went into the build, in the order of build.json. Where configs lie differs between installations;
/// what they say does not: their paths are those below the folder of configs.
std::vector<InputFile> input_files(const BuildOptions& options, const BuildInputs& inputs);

}  // namespace blockrand::run
