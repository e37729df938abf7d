// GML text of rings, polygons and solids.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/facade.h"
#include "pipeline/model/polygon.h"
#include "pipeline/model/solid.h"

namespace blockrand::outputs {

/// Appends "<id>_p<face>", the gml:id of a polygon.
void append_polygon_id(std::string& out, std::string_view id, std::size_t face);
/// Appends "<id>_q<face>", the gml:id of a polygon of a LoD3 solid that its LoD2 solid does not have.
void append_detail_polygon_id(std::string& out, std::string_view id, std::size_t face);
/// Whether face `face` of a LoD3 solid is, point for point, that of the LoD2 solid which it was made of.
bool is_shared_face(const model::Solid& lod2, const model::Solid& lod3, std::size_t face);

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
  /// gml:Solid of a LoD3 solid, of references to the polygons that the second surfaces() writes.
  void solid_of_detail(const model::Solid& lod2, const model::Solid& lod3, std::string_view solid_id,
                       std::string_view id);
  /// As surfaces(), with LoD3 beside LoD2: a wall has what is left of it around its openings, their reveals, and as
  /// bldg:opening the windows and doors themselves; `implicit(o)` writes what stands in opening o. Faces that LoD2 has
  /// as well refer to its polygons. Tunnels of passages are surfaces of their own.
  void surfaces(const model::Solid& lod2, const model::Detail& detail, std::string_view id,
                const std::function<void(std::size_t)>& implicit);
  /// gml:MultiSurface of all faces of a body.
  void multi_surface(const model::Solid& solid, std::string_view id);
  /// gml:MultiSurface of an element in its own coordinates (x right, y into the wall, z up), polygons "<id>_p<face>".
  void multi_surface(const model::ElementMesh& mesh, std::string_view id);

  /// One bldg:boundedBy per face: WallSurface "<id>_s<face>" with the polygon "<id>_p<face>", and so on.
  void surfaces(const model::Solid& solid, std::string_view id);

 private:
  void load_vertices(const model::Solid& solid);
  void polygon(const model::Solid& solid, const model::Face& face, std::string_view id, std::size_t number,
               bool detail = false);
  void open_surface(std::string_view name, std::string_view id, std::size_t face);
  /// gml:LinearRing at a height, running as it is told, however the plan's ring runs.
  void ring(const model::Ring& plan, bool counter_clockwise, std::string_view z);

  std::string& out_;
  std::string vertex_text_;
  std::vector<std::uint32_t> vertex_ends_;
};

}  // namespace blockrand::outputs
