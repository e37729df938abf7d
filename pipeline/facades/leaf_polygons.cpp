#include "pipeline/facades/leaf_polygons.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "styles/grammar/shapes/mesh_triangles.h"

namespace blockrand::facades {
namespace {

using grammar::Vector3;
using model::Point3;

constexpr double kSmallest = 1e-6;       ///< m2, of a triangle
constexpr std::size_t kMostCorners = 8;  ///< of a face that stays whole; others become triangles
constexpr double kPlane = 0.001;         ///< m, of a whole face across its plane: a grid step
constexpr double kOnceRound = 7;         ///< rad: between one turn and two

Point3 point(Vector3 v) { return {v.x, v.y, v.z}; }

/// A face without holes whose corners all turn the same way.
bool is_convex(const grammar::Mesh& mesh, const grammar::MeshFace& face) {
  if (face.loops.size() != 1 || face.loops[0].size() < 3) return false;
  const auto& loop = face.loops[0];
  Vector3 first{};
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector3 a = mesh.vertices[loop[i].vertex], b = mesh.vertices[loop[(i + 1) % loop.size()].vertex],
                  c = mesh.vertices[loop[(i + 2) % loop.size()].vertex];
    const Vector3 turn = grammar::cross(b - a, c - b);
    if (grammar::length(turn) < kSmallest) continue;
    if (grammar::length(first) == 0)
      first = turn;
    else if (grammar::dot(first, turn) < 0)
      return false;
  }
  if (grammar::length(first) == 0 || loop.size() > kMostCorners) return false;
  const Vector3 normal = grammar::normalized(first), at = mesh.vertices[loop[0].vertex];
  for (const grammar::Corner& corner : loop)
    if (std::fabs(grammar::dot(normal, mesh.vertices[corner.vertex] - at)) > kPlane) return false;
  // Once round: stars turn the same way, too.
  double turned = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector3 a = mesh.vertices[loop[i].vertex], b = mesh.vertices[loop[(i + 1) % loop.size()].vertex],
                  c = mesh.vertices[loop[(i + 2) % loop.size()].vertex];
    const double straight = grammar::dot(grammar::normalized(b - a), grammar::normalized(c - b));
    turned += std::acos(std::clamp(straight, -1.0, 1.0));
  }
  return turned < kOnceRound;
}

model::Colour colour_of(const grammar::Material& material) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint8_t>(std::clamp(std::floor(material.colour[i] * 255 + 0.5), 0.0, 255.0));
  };
  return {byte(0), byte(1), byte(2)};
}

}  // namespace

bool has_word(std::string_view symbol, std::initializer_list<std::string_view> words) {
  std::string word;
  const auto known = [&] { return std::find(words.begin(), words.end(), word) != words.end(); };
  for (const char c : symbol) {
    const auto u = static_cast<unsigned char>(c);
    if (!std::isalpha(u) || (std::isupper(u) && !word.empty())) {
      if (known()) return true;
      word.clear();
    }
    if (std::isalpha(u)) word += static_cast<char>(std::tolower(u));
  }
  return known();
}

LeafPolygons leaf_polygons(const grammar::Leaf& leaf, const grammar::Frame& frame, const model::PartMaterial& usual,
                           const attributes::Defaults& defaults) {
  LeafPolygons out;
  out.symbol = leaf.symbol.ends_with('.') ? leaf.symbol.substr(0, leaf.symbol.size() - 1) : leaf.symbol;
  out.look = usual;
  const grammar::Material* material = leaf.shape.material.get();
  if (material) {  // somebody gave it looks, white among them
    const bool coloured = material->colour != grammar::Material{}.colour;
    if (coloured || material->colour_map.empty()) out.look.colour = colour_of(*material);
    const char* name = material->colour[3] < 0.9 || has_word(out.symbol, {"glass", "pane", "panes", "glazing"})
                           ? "glass"
                       : material->metallic > 0.5 ? "metal"
                                                  : "";
    if (*name) out.look.material = static_cast<std::uint8_t>(std::max(defaults.material(name), 0));
  }
  const grammar::Mesh& mesh = *leaf.shape.mesh;
  const auto placed = [&](std::uint32_t vertex) { return point(grammar::place(frame, mesh.vertices[vertex])); };
  std::vector<bool> whole(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if ((whole[f] = is_convex(mesh, mesh.faces[f]))) {
      auto& polygon = out.polygons.emplace_back();
      for (const grammar::Corner& c : mesh.faces[f].loops[0]) polygon.push_back(placed(c.vertex));
    }
  if (std::find(whole.begin(), whole.end(), false) != whole.end())
    for (const grammar::MeshTriangle& t : grammar::triangles_of(mesh))
      if (!whole[t.face]) out.polygons.push_back({placed(t.vertices[0]), placed(t.vertices[1]), placed(t.vertices[2])});
  for (const auto& polygon : out.polygons)
    for (const Point3& p : polygon) {
      out.low = {std::min(out.low.x, p.x), std::min(out.low.y, p.y), std::min(out.low.z, p.z)};
      out.high = {std::max(out.high.x, p.x), std::max(out.high.y, p.y), std::max(out.high.z, p.z)};
    }
  return out;
}

}  // namespace blockrand::facades
