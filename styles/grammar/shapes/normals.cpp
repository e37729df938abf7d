// setNormals: which way faces look (docs/rule_language.md §2.6).
#include <vector>

#include "styles/grammar/shapes/mesh_tools.h"
#include "styles/grammar/shapes/operation_list.h"

namespace blockrand::grammar {

namespace {

/// Turns faces so that neighbours look to the same side: each set of faces that hang together by edges of two faces
/// follows its first one; closed sets look outwards.
void conform(Mesh& mesh) {
  const std::vector<EdgeSide> sides = edge_sides(mesh);
  struct Neighbour {
    std::uint32_t face;
    bool turned;  ///< the two run along the edge in the same direction: one of them is the wrong way round
  };
  std::vector<std::vector<Neighbour>> neighbours(mesh.faces.size());
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    if (end - i == 2 && sides[i].face != sides[i + 1].face) {
      const bool turned = sides[i].forward == sides[i + 1].forward;
      neighbours[sides[i].face].push_back({sides[i + 1].face, turned});
      neighbours[sides[i + 1].face].push_back({sides[i].face, turned});
    }
    i = end;
  }
  std::vector<std::uint8_t> seen(mesh.faces.size(), 0), turn(mesh.faces.size(), 0);
  for (std::uint32_t first = 0; first < mesh.faces.size(); ++first) {
    if (seen[first] != 0) continue;
    std::vector<std::uint32_t> set{first};
    seen[first] = 1;
    for (std::size_t i = 0; i < set.size(); ++i)
      for (const Neighbour& next : neighbours[set[i]]) {
        if (seen[next.face] != 0) continue;
        seen[next.face] = 1;
        turn[next.face] = static_cast<std::uint8_t>(turn[set[i]] ^ static_cast<std::uint8_t>(next.turned));
        set.push_back(next.face);
      }
    Mesh part = extract_faces(mesh, set);
    for (std::size_t i = 0; i < set.size(); ++i)
      if (turn[set[i]] != 0) reverse_face(part.faces[i]);
    if (is_closed(part) && signed_volume(part) < 0)
      for (const std::uint32_t face : set) turn[face] ^= 1;
  }
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    if (turn[f] == 0) continue;
    reverse_face(mesh.faces[f]);
    for (UvSet& set : mesh.uv) {
      if (f >= set.size() || set[f].empty()) continue;
      MeshFace copy = mesh.faces[f];  // the coordinates follow; the loops were turned already
      reverse_face(copy, &set[f]);
    }
  }
}

}  // namespace

/// hard, soft and auto tell renderers how to shade; faces here are flat shaded, their geometry is what it was.
Result run_set_normals(Shape& shape, const OperationInput&, Arguments arguments) {
  if (arguments[0].word != "conform" || mesh_of(shape).empty()) return {};
  Mesh mesh = mesh_of(shape);
  conform(mesh);
  keep_scope(shape, std::move(mesh));
  return {};
}

}  // namespace blockrand::grammar
