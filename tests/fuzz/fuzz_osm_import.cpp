// libFuzzer target: whatever an OSM file holds, reading it gives an extract whose books balance, or an InputError.
// The first byte chooses the format, the rest is the file. Seeds: any small OSM file behind one of the bytes 0 to 3.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "importers/osm/read_extract.h"
#include "pipeline/base/error.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand;
  if (size == 0) return 0;
  static constexpr const char* kNames[] = {"f.osm", "f.osm.pbf", "f.osm.gz", "f.osm.bz2"};
  const std::string path = fuzz::write_file(kNames[data[0] % 4], data + 1, size - 1);
  try {
    const model::Extract e = importers::osm::read_extract(path);
    if (e.counts.buildings() + e.counts.parts() != e.buildings.size()) std::abort();
    for (const auto& b : e.buildings)
      if ((b.state == model::ObjectState::pending) != (b.rings.count > 0)) std::abort();
  } catch (const base::InputError&) {
  }
  return 0;
}
