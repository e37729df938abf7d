// libFuzzer target: whatever the text files of a user's configuration hold, they are read, or there is an InputError.
// The first byte chooses the file; the others are those of configs/.
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"
#include "pipeline/settings/config_file.h"
#include "styles/classify/catalogue.h"
#include "styles/classify/evidence_model.h"
#include "styles/classify/ground_floor.h"
#include "styles/classify/non_houses.h"
#include "styles/classify/tag_features.h"
#include "styles/classify/votes.h"
#include "styles/districts/presets.h"
#include "styles/districts/read_rule_set.h"
#include "styles/elements/element_file.h"
#include "styles/elements/profile_library.h"
#include "tests/fuzz/input_file.h"

namespace {

using namespace blockrand;
namespace fs = std::filesystem;

const std::string kConfigs = BLOCKRAND_SOURCE_DIR "/configs";

const classify::Catalogue& catalogue() {
  static const classify::Catalogue read = classify::read_catalogue(kConfigs);
  return read;
}

/// What rule sets are checked against.
const districts::RuleSets& known() {
  static const districts::RuleSets read = [] {
    districts::RuleSets book;
    book.presets = districts::read_presets(kConfigs + "/styles/presets.toml");
    for (const classify::Style& style : catalogue().styles()) book.substyles.push_back(style.id);
    return book;
  }();
  return read;
}

/// What element files may use.
const elements::ProfileLibrary& profiles() {
  static const elements::ElementCatalogue read = elements::read_element_catalogue(std::vector<std::string>{kConfigs});
  return read.profiles();
}

/// A copy of configs/ of which the input replaces one file: readers look for their files themselves.
std::string configs_with(const char* file, const std::uint8_t* data, std::size_t size) {
  const std::string copy = fuzz::folder() + "/" + fs::path(file).stem().string();
  if (!fs::exists(copy))
    for (const char* folder : {"defaults", "materials", "styles"}) {
      fs::create_directories(copy);
      fs::copy(kConfigs + "/" + folder, copy + "/" + folder, fs::copy_options::recursive);
    }
  fuzz::write_file(fs::path(file).stem().string() + "/" + file, data, size);
  return copy;
}

void read(std::uint8_t kind, const std::uint8_t* data, std::size_t size) {
  const auto input = [&] { return fuzz::write_file("input.toml", data, size); };
  const auto replaced = [&](const char* file) { return configs_with(file, data, size); };
  switch (kind) {
    case 0: {
      settings::Settings settings;
      settings::read_config(input(), settings, settings::kBuild | settings::kUpdate);
      break;
    }
    case 1:
      (void)districts::read_presets(input());
      break;
    case 2: {
      districts::RuleSets book = known();
      districts::read_rule_set(input(), book);
      break;
    }
    case 3:
      (void)attributes::read_defaults(replaced("defaults/uses.toml"));
      break;
    case 4:
      (void)attributes::read_defaults(replaced("materials/materials.toml"));
      break;
    case 5:
      (void)classify::read_catalogue(replaced("styles/catalogue.toml"));
      break;
    case 6:
      (void)classify::read_ground_floor(replaced("styles/ground_floor.toml"));
      break;
    case 7:
      (void)classify::read_non_houses(replaced("styles/non_houses.toml"), catalogue());
      break;
    case 8:
      (void)classify::TagTables::read(input());
      break;
    case 9: {
      base::TomlTable root = base::TomlTable::read(input());
      (void)classify::VoteKernel::read(root);
      root.finish();
      break;
    }
    case 10:
      (void)classify::EvidenceModel::read(input());
      break;
    case 11: {
      elements::ProfileLibrary library;
      elements::parse_profile_preset({reinterpret_cast<const char*>(data), size}, "input.toml", "input", library);
      break;
    }
    default: {
      const elements::ElementFile file =
          elements::parse_element_file({reinterpret_cast<const char*>(data), size}, "input.toml", "input", profiles());
      elements::check_element_file(file, profiles());
      break;
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    read(data[0] % 13, data + 1, size - 1);
  } catch (const base::InputError&) {
  }
  return 0;
}
