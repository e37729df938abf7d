// libFuzzer target: whatever a CityJSON file holds, `validate` reads it to bodies that can be judged, or says what is
// wrong. The first byte chooses: a sequence where it is odd, else one object.
#include <cstdint>
#include <string_view>

#include "pipeline/validate/cityjson_reader.h"
#include "pipeline/validate/surroundings_files.h"
#include "tests/fuzz/read_contents.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand;
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  fuzz::check_contents(validate::read_cityjson(text, data[0] % 2 == 1 ? "f.city.jsonl" : "f.city.json"));
  validate::read_surroundings(validate::Format::cityjson, text, "f_surroundings.city.jsonl");
  return 0;
}
