// Models of any format as a City: one CRS, one origin, the outside of every building.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "importers/reference/read_options.h"
#include "pipeline/compare/city.h"
#include "pipeline/geometry/box_index.h"

namespace blockrand::compare {

struct ReadCityOptions {
  importers::reference::ReadOptions read;  ///< for every file
  std::string crs;  ///< that the city is wanted in ("EPSG:25833"); empty: that of its first file where it is
                    ///< projected and in metres, else UTM where that file lies
  std::optional<Point2> origin;  ///< empty: the middle of the first file's buildings, to a full kilometre
  int max_lod = 3;  ///< of each building the highest level of detail up to this one; the lowest where all are higher
  std::optional<geometry::PlanBox>
      reach;     ///< m, relative to the origin: buildings whose box lies outside are counted only
  int jobs = 0;  ///< worker threads; 0: one per core
};

/// Reads files, or all model files of folders and builds (importers::reference::model_files).
///
/// Of every building and part: thematic surfaces of the outside; polygons of its solids and multi-surfaces that no
/// thematic surface uses or lies on get their class from their normal. Installations count at the level they have, but
/// do not choose it. A building's own body of a lower level than its parts' is left out. Interiors never count. A
/// building that stands where one of an earlier file does (more than half of both footprints in common), or that is in
/// one file twice, is a repetition, as where tiles of different years overlap: it is counted and left out. Files are
/// taken in the order of their names and buildings sorted by id, then by place: the order of `paths` does not matter.
/// \throws base::InputError  as read_model
/// \throws base::UsageError  when a file's CRS does not lead to the wanted one
City read_city(const std::vector<std::string>& paths, const ReadCityOptions& options);

/// What read_city makes of one model that was read, before sorting. The model must be in a projected CRS in metres.
/// For tests, and for callers that make models themselves.
City city_of(const importers::reference::ReferenceModel& model, Point2 origin, int max_lod = 3);

/// Sorts the buildings as read_city does.
void sort_buildings(City& city);

/// Box of a building's footprint, of its faces where it has none. Relative to the origin.
geometry::PlanBox plan_box(const Building& building);

}  // namespace blockrand::compare
