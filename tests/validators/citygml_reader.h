// Reads the solids of CityGML files for the judges. Shares no code with the exporter.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::validators {

struct GmlPolygon {
  std::string id;       ///< gml:id; may be empty
  std::string surface;  ///< "WallSurface", "RoofSurface" …; empty outside of boundary surfaces
  std::vector<std::vector<model::Point3>> rings;  ///< the outer ring first; without the repeated last point
};

struct GmlSolid {
  std::string id;        ///< gml:id of the Solid
  std::string building;  ///< gml:id of the Building or BuildingPart that it belongs to
  int lod = 0;           ///< 1, 2 or 3
  std::vector<GmlPolygon> polygons;
};

struct GmlBuilding {
  std::string id;
  bool part = false;
  std::vector<GmlPolygon> footprint;                            ///< lod0FootPrint
  std::vector<std::pair<std::string, std::string>> attributes;  ///< generic attributes, in order
  std::vector<std::pair<std::string, std::string>>
      elements;                                     ///< bldg:* elements with text, gml:name, xAL:* …, in order
  std::string text(const std::string& name) const;  ///< first such attribute or element, or empty
};

struct GmlFile {
  std::string srs_name;
  std::optional<model::Point3> lower, upper;  ///< of the envelope
  std::vector<GmlBuilding> buildings;         ///< Buildings and BuildingParts in the order of their start tags
  std::vector<GmlSolid> solids;               ///< in the order of the file
};

/// Reads a .gml or .gml.gz file; every surfaceMember with an xlink:href is replaced by the polygon it names.
/// \throws std::runtime_error  not well-formed, a reference to nowhere, an id twice, a ring that does not close
GmlFile read_citygml(const std::string& path);

/// The same from memory (not compressed).
GmlFile read_citygml_text(const std::string& text);

}  // namespace blockrand::validators
