// Tags on faces and edges (docs/rule_language.md §2.6), and the stand-in for assets bent along texture coordinates.
#include "styles/grammar/shapes/components.h"
#include "styles/grammar/shapes/mesh_tools.h"
#include "styles/grammar/shapes/operation_list.h"

namespace blockrand::grammar {

namespace {

/// The set without tags that the query matches (all when it is empty).
std::uint16_t without(Mesh& mesh, std::uint16_t tags, std::string_view query) {
  std::uint16_t out = 0;
  for (const std::string& tag : std::vector<std::string>(mesh.tag_sets[tags]))
    if (!tag_matches(query, tag)) out = add_tag(mesh, out, tag);
  return out;
}

}  // namespace

Result run_tag(Shape& shape, const OperationInput&, Arguments arguments) {
  const std::string* name = text(arguments, 0);
  if (name == nullptr || name->empty()) return failure("the tag must be a text");
  const std::string_view where = arguments.size() > 1 ? word(arguments, 1) : "auto";
  if (where == "vertices") return failure("vertices cannot be tagged yet: faces and edges can");
  if (where != "auto" && where != "faces" && where != "edges")
    return failure(unknown_word(where, "auto, faces, edges"));
  if (!shape.mesh) return {};
  Mesh mesh = *shape.mesh;
  for (MeshFace& face : mesh.faces) {
    if (where != "edges") face.tags = add_tag(mesh, face.tags, *name);
    if (where == "edges")
      for (Loop& loop : face.loops)
        for (Corner& c : loop) c.edge_tags = add_tag(mesh, c.edge_tags, *name);
  }
  shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
  return {};
}

Result run_delete_tags(Shape& shape, const OperationInput&, Arguments arguments) {
  const std::string* query = text(arguments, 0);
  if (!arguments.empty() && query == nullptr) return failure("the query must be a text");
  const std::string_view where = arguments.size() > 1 ? word(arguments, 1) : "auto";
  if (where != "auto" && where != "faces" && where != "edges" && where != "vertices")
    return failure(unknown_word(where, "auto, faces, edges, vertices"));
  if (!shape.mesh) return {};
  const std::string_view wanted = query == nullptr ? std::string_view{} : std::string_view(*query);
  Mesh mesh = *shape.mesh;
  for (MeshFace& face : mesh.faces) {
    if (where == "auto" || where == "faces") face.tags = without(mesh, face.tags, wanted);
    if (where == "auto" || where == "edges")
      for (Loop& loop : face.loops)
        for (Corner& c : loop) c.edge_tags = without(mesh, c.edge_tags, wanted);
  }
  shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
  return {};
}

Result run_insert_along_uv(Shape& shape, const OperationInput&, Arguments arguments) {
  if (!is_number(arguments, 0)) return failure("the uv set must be a number from 0 to 9");
  const std::string* file = text(arguments, 1);
  if (file == nullptr) return failure("the second argument must be the name of a file");
  if (!shape.mesh) return {};
  // No assets are read: the surface that the asset would lie on stays, under its name.
  Mesh mesh = *shape.mesh;
  const auto slash = file->find_last_of("/\\");
  mesh.asset = slash == std::string::npos ? *file : file->substr(slash + 1);
  mesh.asset.resize(std::min(mesh.asset.size(), mesh.asset.find_last_of('.')));
  shape.mesh = std::make_shared<const Mesh>(std::move(mesh));
  return {};
}

}  // namespace blockrand::grammar
