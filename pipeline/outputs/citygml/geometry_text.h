// GML text of rings, polygons and solids. GML's elements have no prefix, since they are most of a file.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/facade.h"
#include "pipeline/model/polygon.h"
#include "pipeline/model/solid.h"

namespace blockrand::outputs {

/// A Polygon within a surfaceMember: after the first stand its id and ">", then the rings.
inline constexpr std::string_view kPolygonBegin = "<surfaceMember><Polygon",
                                  kExteriorBegin = "<exterior><LinearRing><posList>",
                                  kExteriorEnd = "</posList></LinearRing></exterior>",
                                  kInteriorBegin = "<interior><LinearRing><posList>",
                                  kInteriorEnd = "</posList></LinearRing></interior>",
                                  kPolygonEnd = "</Polygon></surfaceMember>\n";

/// Appends "<id>_p<face>", the gml:id of a polygon.
void append_polygon_id(std::string& out, std::string_view id, std::size_t face);
/// Appends "<id>_q<face>", the gml:id of a polygon of a LoD3 solid that its LoD2 solid does not have.
void append_detail_polygon_id(std::string& out, std::string_view id, std::size_t face);
/// Appends "<id>_m<face>", the gml:id of the MultiSurface of a LoD3 wall and its reveals; of a body of its own "_m0".
void append_wall_id(std::string& out, std::string_view id, std::size_t face);
/// Whether face `face` of a LoD3 solid is, point for point and in its looks, that of the LoD2 solid which it was made of.
bool is_shared_face(const model::Solid& lod2, const model::Solid& lod3, std::size_t face);
/// The faces of the reveals of a wall's windows and doors, by face of the LoD2 solid.
std::vector<std::vector<std::size_t>> reveals_by_wall(const model::Solid& lod2, const model::Detail& detail);

/// Appends GML 3.1.1 geometry. Keeps the text of a solid's vertices while its faces are written: each vertex is
/// formatted once and copied into every ring that uses it, so that equal vertices have equal text.
///
/// Polygons stand in solids, and surfaces refer to them: GDAL follows no references unless it is told to, and takes a
/// building's last geometry. A face that two levels of detail have stands in the solid of the higher one.
class GeometryText {
 public:
  explicit GeometryText(std::string& out) : out_(out) {}

  /// Polygon of a footprint at height z, facing up.
  void footprint(const model::Polygon& plan, double z);

  /// Solid with its polygons inside, or a MultiSurface where it is not closed; these are "<id>_p<face>", or have no id where `id`
  /// is empty.
  void solid(const model::Solid& solid, std::string_view solid_id, std::string_view id);
  /// Solid of LoD2 of a body that has LoD3: polygons that both have are references to those of detail_solid().
  void solid_beside_detail(const model::Solid& lod2, const model::Solid& lod3, std::string_view solid_id,
                           std::string_view id);
  /// Solid of LoD3: "<id>_p<face>" are the polygons that LoD2 has as well, "<id>_q<face>" the others.
  void detail_solid(const model::Solid& lod2, const model::Solid& lod3, std::string_view solid_id, std::string_view id);

  /// MultiSurface of what rules for footprints made: its polygons are "<id>_q<face>".
  void rule_surfaces(const model::Solid& lod3, std::string_view surface_id, std::string_view id);
  /// One bldg:boundedBy per rule and class of what they made: WallSurface "<id>_r<number>" with the rule's symbol as its name.
  void surfaces_of_rules(const model::Detail& detail, std::string_view id);

  /// One bldg:boundedBy per face of solid(): WallSurface "<id>_s<face>" with a reference to its polygon, and so on. Where it is
  /// not closed one per class, "<id>_s<number>".
  void surfaces(const model::Solid& solid, std::string_view id);
  /// What others write into the surfaces of LoD3.
  struct SurfaceText {
    std::function<void(std::size_t)> wall;     ///< generic attributes of a face of LoD2
    std::function<void(std::size_t)> opening;  ///< generic attributes of an opening
    std::function<void(std::size_t)> inside;   ///< what stands in an opening, as implicit geometry
  };
  /// The same with LoD3 beside LoD2: a wall has what is left of it around its openings, their reveals, and as
  /// bldg:opening the windows and doors themselves. Tunnels of passages are surfaces of their own.
  void surfaces(const model::Solid& lod2, const model::Detail& detail, std::string_view id, const SurfaceText& text);
  /// MultiSurface "<id>_m0" of all faces of a body; with `polygon_ids` these are "<id>_p<face>".
  void multi_surface(const model::Solid& solid, std::string_view id, bool polygon_ids);

 private:
  enum class Mark { none, polygon, detail };  ///< id of a polygon: none, "_p", "_q"
  void load_vertices(const model::Solid& solid);
  void begin_solid(std::string_view solid_id, bool closed = true);
  void end_solid(bool closed = true);
  void polygon(const model::Solid& solid, std::size_t face, std::string_view id, Mark mark);
  void reference(std::string_view id, std::size_t face, Mark mark);
  void open_surface(std::string_view name, std::string_view id, std::size_t face, const char* kind = "_s");
  /// A property of several polygons.
  void surface_group(std::string_view property, std::string_view id, const std::vector<std::size_t>& faces, Mark mark);
  void close_surface(std::string_view name);
  void single_surface(std::string_view property, std::string_view id, std::size_t face, Mark mark);
  /// LinearRing at a height, running as it is told, however the plan's ring runs.
  void ring(const model::Ring& plan, bool counter_clockwise, std::string_view z);

  std::string& out_;
  std::string vertex_text_;
  std::vector<std::uint32_t> vertex_ends_;
};

}  // namespace blockrand::outputs
