// GML text of rings, polygons and solids.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/polygon.h"
#include "pipeline/model/solid.h"

namespace blockrand::export_ {

/// Appends "<id>_p<face>", the gml:id of a polygon.
void append_polygon_id(std::string& out, std::string_view id, std::size_t face);

/// Appends GML 3.1.1 geometry. Keeps the text of a solid's vertices while its faces are written: each vertex is
/// formatted once and copied into every ring that uses it, so that equal vertices have equal text.
class GeometryText {
 public:
  explicit GeometryText(std::string& out) : out_(out) {}

  /// gml:Polygon of a footprint at height z, facing up.
  void footprint(const model::Polygon& plan, double z);

  /// gml:Solid with its polygons inside; with `polygon_ids` these are "<solid_id>_p<face>".
  void solid(const model::Solid& solid, std::string_view solid_id, bool polygon_ids);

  /// gml:Solid whose members refer to the polygons "<id>_p<face>" of surfaces().
  void solid_of_references(const model::Solid& solid, std::string_view solid_id, std::string_view id);
  /// One bldg:boundedBy per face: WallSurface "<id>_s<face>" with the polygon "<id>_p<face>", and so on.
  void surfaces(const model::Solid& solid, std::string_view id);

 private:
  void load_vertices(const model::Solid& solid);
  void polygon(const model::Solid& solid, const model::Face& face, std::string_view id, std::size_t number);
  void ring(const model::Ring& ring, std::string_view z);

  std::string& out_;
  std::string vertex_text_;
  std::vector<std::uint32_t> vertex_ends_;
};

}  // namespace blockrand::export_
