// libFuzzer target: whatever tileset.json holds, `validate` reads it to volumes that can be asked, or says what is wrong.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "pipeline/validate/tileset_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand;
  const validate::Tileset tileset = validate::read_tileset({reinterpret_cast<const char*>(data), size}, "tileset.json");
  if (!tileset.readable && tileset.findings.empty()) std::abort();
  for (const auto& [uri, entry] : tileset.entries) {
    for (const auto& volume : entry.volumes)
      if (volume == nullptr) std::abort();
    if (entry.volumes.empty()) continue;
    const std::vector<model::Point3> vertices = {{0, 0, 0}, {10, -20, 30}};
    if (validate::overhang(entry, vertices).own < 0) std::abort();
  }
  return 0;
}
