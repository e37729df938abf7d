// Reference models in another coordinate reference system.
#pragma once

#include <optional>
#include <string>

#include "importers/reference/reference_model.h"
#include "pipeline/georef/lon_lat.h"

namespace blockrand::importers::reference {

/// How a model got into its present CRS.
struct TransformFacts {
  std::string operation;   ///< PROJ's name
  double accuracy_m = -1;  ///< as PROJ states it; 0 on the same datum, -1 unknown
};

/// Bounding box of all polygons in degrees; nothing without polygons or where PROJ has no operation.
std::optional<georef::GeoBox> extent_of(const ReferenceModel& model);

/// Turns x and y of all polygons into another projected CRS in metres, by the best operation that PROJ has where the
/// model lies. Heights stay as they are, and so does `crs.vertical`. A model without polygons only gets the target's
/// name, unchecked.
/// \param target  "EPSG:25833"
/// \throws base::UsageError  when the target is no projected CRS in metres or only a "ballpark" operation leads to it
/// \throws base::InputError  when a coordinate lies where the operation is not defined
TransformFacts transform_to(ReferenceModel& model, const std::string& target);

}  // namespace blockrand::importers::reference
