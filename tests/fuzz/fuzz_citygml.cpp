// libFuzzer target: whatever a CityGML file holds, `validate` reads it to bodies that can be judged, or says what is
// wrong.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "pipeline/validate/citygml_reader.h"
#include "pipeline/validate/surroundings_files.h"
#include "tests/fuzz/read_contents.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const validate::CityGml read = validate::read_citygml(text, "f.gml");
  if (read.readable) fuzz::check_contents(read.contents);
  validate::read_surroundings(validate::Format::citygml, text, "f_surroundings.gml");
  return 0;
}
