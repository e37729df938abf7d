// libFuzzer target: whatever a user's overrides.toml holds, it is read to entries in order, or there is an InputError.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <variant>

#include "pipeline/attributes/overrides.h"
#include "pipeline/base/error.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand;
  static const attributes::Defaults defaults = attributes::read_defaults(BLOCKRAND_SOURCE_DIR "/configs");
  try {
    const attributes::Overrides read = attributes::read_overrides(fuzz::write_file("overrides.toml", data, size),
                                                                  defaults, {{"gz_plain", "postwar"}, {"gz_high"}});
    for (std::size_t i = 0; i < read.entries.size(); ++i) {
      if (i > 0 && !(read.entries[i - 1].object < read.entries[i].object)) std::abort();
      for (const auto& [attribute, value] : read.entries[i].values)
        if (const double* number = std::get_if<double>(&value.value); number && !std::isfinite(*number)) std::abort();
    }
  } catch (const base::InputError&) {
  }
  return 0;
}
