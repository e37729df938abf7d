// libFuzzer target: the value parsers never crash, and what they return lies in their documented ranges.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "importers/osm/tag_values.h"
#include "importers/osm/text_cleaner.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand::importers::osm;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const Pick pick : {Pick::highest, Pick::lowest}) {
    if (const auto v = parse_length(text, pick); v && !std::isfinite(*v)) std::abort();
    if (const auto v = parse_storeys(text, pick); v && !std::isfinite(*v)) std::abort();
  }
  if (const auto v = parse_angle(text); v && !std::isfinite(*v)) std::abort();
  if (const auto v = parse_direction(text); v && !(*v >= 0 && *v < 360)) std::abort();
  (void)parse_colour(text);
  (void)parse_roof_shape(text);
  (void)parse_roof_orientation(text);
  if (!is_clean_text(clean_text(text))) std::abort();
  return 0;
}
