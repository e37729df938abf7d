// CityJSON 2.0: a tile as a text sequence, or a whole build as one object.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "pipeline/model/region.h"
#include "pipeline/outputs/imagery/seen_outline.h"
#include "pipeline/outputs/sink.h"

namespace blockrand::outputs {

struct CityJsonOptions {
  int lod = 2;                   ///< highest level of detail; all levels up to it are written
  std::string crs_code;          ///< "EPSG:25833", for metadata.referenceSystem; empty: none is named
  std::string vertical_crs;      ///< "EPSG:7837" or empty; CityJSON 2.0 has no compound systems, so the title names it
  std::string height_reference;  ///< in words, for the title
  std::string attribution;       ///< source and licence of the data, for the title
  std::string name;              ///< first words of the title, for example "Blockrand 15/17600/12900"
  std::string generator;         ///< program and version, for the title
  std::string data_time;         ///< ISO 8601 time of the data; its date becomes metadata.referenceDate; may be empty
  SeenOutlines seen;             ///< what aerial images show; may be empty
  bool evidence = false;         ///< also `<attribute>_evidence`: why each attribute has its value
};

/// Writes the owned buildings of `region` that have a part, in their order, as a text sequence: a CityJSON object
/// without city objects in the first line, then one CityJSONFeature a line.
///
/// Ids are those of CityGML: a Building, and unless its single part has its id, a BuildingPart per part. Each level of
/// detail that a part has reached, up to `lod`, is written: the footprint at ground height as a MultiSurface of LoD 0,
/// Solids of LoD 1 to 3; those of LoD 2 and 3 with semantics, the highest block and those with materials of the theme
/// "visual". Windows and doors of LoD 3 are children of their wall's surface; elements are instances of geometry
/// templates in a BuildingInstallation for each kind of a part, chimneys, cornices and the like are one each.
/// Attributes are named as in model::for_each_attribute, each with `<attribute>_source` and `<attribute>_confidence`;
/// beside them stand those that other CityJSON files have (measuredHeight, storeysAboveGround, function, roofType …,
/// codes as in CityGML); OSM tags are `osm.<key>`.
///
/// The scale is 1/1024 m and the translation a whole number of metres: vertices are integers and give the model's
/// coordinates back exactly. Equal vertices of a feature are one. The same region gives the same bytes.
void write_cityjson_sequence(const model::Region& region, const CityJsonOptions& options, const Sink& sink);

/// The same as one string.
std::string write_cityjson_sequence(const model::Region& region, const CityJsonOptions& options);

/// One CityJSON object from the regions of a build, added in tile order; the same content as the sequences. City
/// objects go to the sink at once; vertices (about 20 bytes each) and the list of materials are kept to the end, and
/// written after them with transform and metadata. Equal vertices of the whole file are one.
class SingleCityJson {
 public:
  SingleCityJson(CityJsonOptions options, Sink sink);
  ~SingleCityJson();

  void add(const model::Region& region);
  /// Writes the rest. Call once, after the last region. Without regions the file is valid and empty.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blockrand::outputs
