// The Simple 3D Buildings keys of one object as model::MappedAttributes.
#pragma once

#include <span>
#include <string_view>
#include <utility>

#include "pipeline/model/extract.h"

namespace blockrand::importers::osm {

/// Reads every key of the scheme. Of synonyms the first counts that can be read and lies within the limits, in this
/// order. Materials are text, which can always be read: the first that is there counts.
///
/// | attribute             | keys                                                                    | limits     |
/// |-----------------------|-------------------------------------------------------------------------|------------|
/// | height                | height, building:height, est_height                                     | (0, 1000] m |
/// | min_height            | min_height, building:min_height                                         | [0, 1000] m |
/// | storeys               | building:levels, levels                                                 | [0, 200]   |
/// | min_storey            | building:min_level, min_level                                           | [0, 200]   |
/// | layer                 | layer                                                                   | [-20, 20]  |
/// | roof_storeys          | roof:levels, building:roof:levels                                       | [0, 20]    |
/// | storeys_underground   | building:levels:underground                                             | [0, 50]    |
/// | roof_height           | roof:height, building:roof:height                                       | [0, 300] m |
/// | roof_angle            | roof:angle, building:roof:angle                                         | [0, 90)    |
/// | roof_direction        | roof:direction, roof:slope:direction                                    |            |
/// | roof_orientation      | roof:orientation, building:roof:orientation                             |            |
/// | roof_shape            | roof:shape, building:roof:shape, building:roof (where it names a shape) |            |
/// | wall_colour           | building:colour, building:color, building:facade:colour, facade:colour  |            |
/// | roof_colour           | roof:colour, roof:color, building:roof:colour                           |            |
/// | wall_material         | building:material, building:facade:material, facade:material            |            |
/// | roof_material         | roof:material, building:roof:material                                   |            |
/// | built                 | building:start_date, building:year_of_construction, year_of_construction, construction_date, start_date | 500 to 2100 |
///
/// `start_date` on an object that also carries shop, amenity, office, craft or tourism=hotel|museum may date the business:
/// half the confidence.
/// A value that cannot be read is reported as VALUE_UNREADABLE, one outside the limits as VALUE_CLAMPED; neither is
/// set, both stay in the tags. Of lists and ranges the highest number counts, for min_height and min_storey the lowest.
/// \param tags     clean text, in any order
/// \param strings  where materials and the value of building=* are interned
model::MappedAttributes read_attributes(model::OsmId id, model::ObjectKind kind,
                                        std::span<const std::pair<std::string_view, std::string_view>> tags,
                                        base::StringPool& strings, model::Report& report);

}  // namespace blockrand::importers::osm
