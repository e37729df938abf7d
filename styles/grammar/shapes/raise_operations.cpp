// extrude and taper.
#include <cmath>

#include "styles/grammar/shapes/extrude.h"
#include "styles/grammar/shapes/operation_list.h"

namespace blockrand::grammar {

Result run_extrude(Shape& shape, const OperationInput& input, Arguments arguments) {
  ExtrudeWay way = ExtrudeWay::face_normal;
  const std::size_t at = arguments.size() - 1;
  if (arguments.size() == 2) {
    const std::string_view type = word(arguments, 0);
    if (type == "world.up" || type == "world.y" || type == "y")
      way = ExtrudeWay::world_up;
    else if (type == "world.up.flatTop")
      way = ExtrudeWay::flat_top;
    else if (type == "vertex.normal")
      way = ExtrudeWay::vertex_normal;
    else if (type != "face.normal")
      return failure(unknown_word(type, "world.up, world.up.flatTop, face.normal, vertex.normal"));
  }
  if (!is_number(arguments, at)) return failure("the distance must be a number");
  extrude(shape, way, measured(arguments, at, input.base.size.y));
  return {};
}

Result run_taper(Shape& shape, const OperationInput&, Arguments arguments) {
  if (auto ok = wants_numbers(arguments); !ok) return ok;
  const double height = number(arguments, 0);
  const Mesh& old = mesh_of(shape);
  if (old.faces.empty() || height == 0) return {};
  const Vector3 normal = face_normal(old, old.faces[0]);
  if (normal == Vector3{}) return {};
  const std::uint32_t first = 0;
  Mesh base = extract_faces(old, std::span(&first, 1));
  for (UvSet& set : base.uv) set.clear();
  // Centre of gravity of the face, holes taken off.
  Vector3 weighted;
  double weight = 0;
  const Vector3 anchor = base.vertices[0];
  for (const Loop& loop : base.faces[0].loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vector3 a = base.vertices[loop[i].vertex] - anchor,
                    b = base.vertices[loop[(i + 1) % loop.size()].vertex] - anchor;
      const double twice = dot(cross(a, b), normal);
      weighted = weighted + (a + b) * (twice / 3);
      weight += twice;
    }
  const Vector3 apex = anchor + (weight != 0 ? weighted * (1 / weight) : Vector3{}) + normal * height;
  const auto top = static_cast<std::uint32_t>(base.vertices.size());
  base.vertices.push_back(apex);
  const MeshFace outline = base.faces[0];
  if (height > 0) reverse_face(base.faces[0]);
  base.faces[0].tags = add_tag(base, base.faces[0].tags, "taper.bottom");
  for (const Loop& loop : outline.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      MeshFace side;
      side.material = outline.material;
      side.tags = add_tag(base, loop[i].edge_tags, "taper.side");
      side.loops.push_back({loop[i], {loop[(i + 1) % loop.size()].vertex, 0}, {top, 0}});
      if (height < 0) reverse_face(side);
      base.faces.push_back(std::move(side));
    }
  shape.size = {0, height < 0 ? -1.0 : 0.0, 0};
  take_mesh_in_frame(shape, std::move(base), frame_with_y({}, normal, {1, 0, 0}));
  return {};
}

}  // namespace blockrand::grammar
