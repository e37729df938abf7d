// What lies around the buildings of a tile, picked from the context of the whole extract.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/context/context_extract.h"
#include "pipeline/footprints/footprint_store.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/model/region.h"

namespace blockrand::context {

/// Read-only after construction, safe to share between threads; keeps references to what it is made of.
class VicinityFinder {
 public:
  VicinityFinder(const model::Extract& extract, const footprints::FootprintStore& footprints,
                 const ContextExtract& context);

  /// Labels the edges of a region's buildings (context::label_wall_segments) with everything around them in view.
  /// \param numbers  of the region's buildings in the store, in their order
  void label_wall_segments(model::Region& region, std::span<const std::uint32_t> numbers) const;

 private:
  const model::Extract& extract_;
  const footprints::FootprintStore& footprints_;
  const ContextExtract& context_;
  geometry::BoxIndex buildings_, lines_, passages_, points_, blocks_, courtyards_;
};

}  // namespace blockrand::context
