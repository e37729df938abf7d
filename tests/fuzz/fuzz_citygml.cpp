// libFuzzer target: whatever a CityGML file holds, `validate` reads it to bodies that can be judged, or says what is
// wrong.
#include <cstdint>
#include <cstdlib>

#include "pipeline/validate/citygml_reader.h"
#include "tests/fuzz/read_contents.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand;
  const validate::CityGml read = validate::read_citygml({reinterpret_cast<const char*>(data), size}, "f.gml");
  if (read.readable) fuzz::check_contents(read.contents);
  return 0;
}
