// libFuzzer target: whatever a user's overrides.toml holds, it is read to entries in order, or there is an InputError; and
// what was read can be given to buildings with and without tags of their own.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <variant>

#include "pipeline/attributes/overrides.h"
#include "pipeline/base/error.h"
#include "pipeline/model/extract.h"
#include "pipeline/model/report.h"
#include "tests/fuzz/input_file.h"

namespace {

/// w1 with tags, w2 without, w3 a part of w2, w4 not built.
blockrand::model::Extract few_buildings() {
  using namespace blockrand;
  model::Extract extract;
  for (std::int64_t id = 1; id <= 4; ++id) {
    model::MappedBuilding b;
    b.id = {model::OsmType::way, id};
    if (id == 3) b.kind = model::ObjectKind::building_part;
    if (id == 4) b.state = model::ObjectState::reported;
    if (id == 1) {
      b.attributes.use = extract.strings.intern("apartments");
      b.attributes.height = 18.0f;
      b.attributes.storeys = 5.0f;
      b.attributes.roof_height = 3.0f;
    }
    extract.buildings.push_back(b);
  }
  return extract;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand;
  static const attributes::Defaults defaults = attributes::read_defaults(BLOCKRAND_SOURCE_DIR "/configs");
  try {
    attributes::Overrides read = attributes::read_overrides(fuzz::write_file("overrides.toml", data, size), defaults,
                                                            {{"gz_plain", "postwar"}, {"gz_high"}});
    for (std::size_t i = 0; i < read.entries.size(); ++i) {
      if (i > 0 && !(read.entries[i - 1].object < read.entries[i].object)) std::abort();
      for (const auto& [attribute, value] : read.entries[i].values)
        if (const double* number = std::get_if<double>(&value.value); number && !std::isfinite(*number)) std::abort();
    }
    model::Extract extract = few_buildings();
    model::Report report;
    attributes::apply_overrides(read, extract, report);
    for (const model::MappedBuilding& b : extract.buildings)
      for (const auto& measure : {b.attributes.height, b.attributes.storeys, b.attributes.roof_height})
        if (measure && !std::isfinite(*measure)) std::abort();
  } catch (const base::InputError&) {
  }
  return 0;
}
