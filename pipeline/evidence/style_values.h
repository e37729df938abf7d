// What classification found, put into a tile's buildings: before their attributes are resolved, and after.
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/evidence/building_facts.h"
#include "pipeline/evidence/classify_extract.h"
#include "pipeline/model/region.h"
#include "styles/classify/classify.h"

namespace blockrand::evidence {

struct StyleInputs {
  const FactsExtract& facts;
  const TagFacts& tags;
  const StyleExtract& styles;
  const classify::Tables& tables;
};

/// Fills `style`, `style_why` and `inferred` of the buildings.
/// \param numbers  of the region's buildings in the store, in their order
/// \param why      false: `style_why` stays empty
void put_styles(model::Region& region, std::span<const std::uint32_t> numbers, const StyleInputs& in, bool why);

/// Fills what no other attribute depends on: construction date, era, style, sub-style and the use of the ground floor.
/// Storeys and use are resolved.
void put_style_attributes(model::Region& region, std::span<const std::uint32_t> numbers, const StyleInputs& in);

}  // namespace blockrand::evidence
