// All images against all outlines of an extract, before any tile.
#pragma once

#include <span>
#include <vector>

#include "importers/imagery/aerial_image.h"
#include "pipeline/base/progress.h"
#include "pipeline/footprints/footprint_store.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/extract.h"
#include "pipeline/observation/imagery.h"
#include "pipeline/observation/options.h"

namespace blockrand::observation {

/// What the images are compared with; outlives the call.
struct ObservedExtract {
  const model::Extract& extract;
  const footprints::FootprintStore& footprints;
  const georef::Projection& projection;
};

/// Whether each image fits the map (fit_image), how its roofs lean (LeanField), and where those that fit show each row of
/// buildings (match_row, judge). The outlines stay where they are. Deterministic for any number of workers.
/// \param correct        off: rows are not looked for, their roofs are looked at as mapped
/// \param refine_within  m: single walls are looked for within it (refine_edges) where their row is sure; 0: they are not
ImageryObservations observe_extract(const ObservedExtract& of, std::span<const importers::imagery::AerialImage> images,
                                    Correction correct, double refine_within, int workers, base::Progress& progress);

}  // namespace blockrand::observation
