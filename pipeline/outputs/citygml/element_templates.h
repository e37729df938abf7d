// Elements as geometry templates of a CityGML file: what several have in common is written once.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "pipeline/model/region.h"
#include "pipeline/outputs/citygml/appearance_text.h"

namespace blockrand::outputs {

/// The relative geometry of implicit geometries: a MultiSurface in the frame of CityGML's implicit geometries, x along
/// the wall, y into it, z up; metres with four decimals. Faces of one look are a CompositeSurface, which the appearance
/// names as a whole. A polygon that another template of the file has in the same look is a reference to it: windows of
/// one house differ in few of their hundred faces. Keeps the text of each distinct polygon, about 100 bytes.
class ElementTemplates {
 public:
  /// The elements that the buildings of `region` place at `lod`; lean without those in openings and without
  /// small pieces (lean_element.h). Ids begin with "e" and a number of the tile, since those
  /// of the files of one build are to differ.
  ElementTemplates(const model::Region& region, int lod, bool lean);

  /// Appends the core:relativeGMLGeometry of an element of the region: the first time with its geometry, whose looks go to
  /// `appearance`, then as a reference.
  void append(std::string& out, std::uint32_t element, AppearanceText& appearance);

 private:
  struct Polygon {
    std::string_view rings;  ///< its exterior and interiors
    std::uint32_t uses = 0;  ///< by templates
    std::uint32_t id = 0;    ///< once it is written, if it is used again; 0: none
  };
  struct Group {
    std::uint32_t look = 0;               ///< MaterialNumbers::key
    std::vector<std::uint32_t> polygons;  ///< into polygons_
  };
  struct Template {
    std::vector<Group> groups;
    std::uint32_t id = 0;  ///< once it is written
  };

  std::uint32_t add(const model::ColouredElement& coloured, bool lean);
  void append_id(std::string& out, std::uint32_t id) const;
  void append_polygon(std::string& out, Polygon& polygon);

  std::string prefix_;
  std::uint32_t last_id_ = 0;
  std::vector<std::uint32_t> template_of_;  ///< by element of the region
  std::vector<Template> templates_;
  std::vector<Polygon> polygons_;
  std::unordered_map<std::string, std::uint32_t> polygon_at_;        ///< by look and ring; looked up only
  std::map<std::vector<std::uint32_t>, std::uint32_t> template_at_;  ///< by polygons
};

}  // namespace blockrand::outputs
