// What LoD3 put on a body, for explanations.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "pipeline/model/region.h"
#include "pipeline/outputs/explain/json_text.h"

namespace blockrand::outputs {

struct DetailCounts {
  std::uint64_t windows = 0, doors = 0;
  std::uint64_t passages = 0;  ///< each once, though it has two portals
  std::map<std::string_view, std::uint64_t> elements, roof_elements, installations;  ///< by kind
};

void add_detail(const model::Region& region, const model::Detail& detail, DetailCounts& counts);

/// "24 windows, 1 door; placed 24 casement, 3 sill; 3 chimney, 2 plinth".
std::string detail_text(const DetailCounts& counts);

/// The member "detail" of a body.
void append_detail(JsonText& json, const model::Region& region, const model::Detail& detail);

}  // namespace blockrand::outputs
