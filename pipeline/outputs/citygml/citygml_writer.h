// A tile as CityGML 2.0.
#pragma once

#include <string>

#include "pipeline/model/region.h"
#include "pipeline/outputs/imagery/seen_outline.h"
#include "pipeline/outputs/sink.h"

namespace blockrand::outputs {

struct CityGmlOptions {
  int lod = 2;                   ///< highest level of detail; all levels up to it are written
  std::string srs_name;          ///< of the envelope: "urn:ogc:def:crs:EPSG::25833"
  std::string height_reference;  ///< in words, for gml:description
  std::string attribution;       ///< source and licence of the data, for gml:description
  std::string name;              ///< gml:name of the city model, for example "Blockrand 15/17600/12900"
  bool evidence = false;         ///< also `<attribute>_evidence`: why each attribute has its value
  SeenOutlines seen;             ///< what aerial images show; may be empty
  bool lean = false;             ///< flat openings without elements, elements on walls without small pieces
};

/// Writes the owned buildings of `region` that have a part, in their order, to `sink` in pieces.
///
/// A building is a bldg:Building with gml:id = its id. One whose single part has the building's id carries the geometry
/// itself; otherwise each part is a bldg:BuildingPart with gml:id = the part's id (a part that has the building's id
/// beside others becomes "<id>.1"). Each level of detail that a part has reached, up to `lod`, is written:
/// lod0FootPrint at ground height, lod1Solid, lod2Solid and lod3Solid with their polygons, to which the boundary
/// surfaces refer (geometry_text.h says why). Elements are implicit geometries (element_templates.h). Where it is
/// lean, openings have neither reveals nor elements (flat_openings.h); a wall's generic attribute `reveal_depth` says in metres how far its windows and doors
/// really lie behind it, that of an opening where it differs. Attributes without an element of their own are generic attributes named as in model::for_each_attribute; each attribute not
/// taken from a tag also has `<attribute>_source` and `<attribute>_confidence`; OSM tags are `osm.<key>`. A building that an
/// aerial image shows has imagery_attributes().
///
/// After the city objects stands one app:Appearance of the theme "visual" with an app:X3DMaterial per pair of material
/// class and colour (appearance_text.h). Its targets are polygons, or MultiSurfaces and CompositeSurfaces of one look.
///
/// Coordinates have four decimals (see append_grid). The same region gives the same bytes; no date is written, since an
/// update may only touch the tiles whose data changed. An empty region gives a valid CityModel without members.
void write_citygml(const model::Region& region, const CityGmlOptions& options, const Sink& sink);

/// The same as one string.
std::string write_citygml(const model::Region& region, const CityGmlOptions& options);

/// The gml:description of a file: reference system, heights, detail, whose data it is.
std::string citygml_description(const CityGmlOptions& options);

}  // namespace blockrand::outputs
