// split(u|v): cutting along lines of equal texture coordinates (docs/rule_language.md §2.3).
#include <algorithm>
#include <cmath>

#include "styles/grammar/shapes/measure.h"
#include "styles/grammar/shapes/mesh_cut.h"
#include "styles/grammar/shapes/split.h"

namespace blockrand::grammar {

namespace {

/// A face laid out in texture space, with what has to come along as uv sets.
Mesh laid_out(const Mesh& mesh, std::size_t face, int set, bool places) {
  Mesh out;
  out.tag_sets = mesh.tag_sets;
  const auto& uv = *uv_of(mesh, set, face);
  MeshFace flat = mesh.faces[face];
  for (UvSet& s : out.uv) s.clear();
  if (places) {
    out.uv[0].emplace_back();
    out.uv[1].emplace_back();
  } else {
    for (std::size_t s = 0; s < mesh.uv.size(); ++s)
      if (!mesh.uv[s].empty()) out.uv[s].push_back(face < mesh.uv[s].size() ? mesh.uv[s][face] : UvSet::value_type{});
  }
  for (std::size_t l = 0; l < flat.loops.size(); ++l) {
    if (places) {
      out.uv[0][0].emplace_back();
      out.uv[1][0].emplace_back();
    }
    for (std::size_t c = 0; c < flat.loops[l].size(); ++c) {
      if (places) {
        const Vector3 p = mesh.vertices[flat.loops[l][c].vertex];
        out.uv[0][0].back().push_back({p.x, p.y});
        out.uv[1][0].back().push_back({p.z, 0});
      }
      flat.loops[l][c].vertex = static_cast<std::uint32_t>(out.vertices.size());
      out.vertices.push_back({uv[l][c].x, uv[l][c].y, 0});
    }
  }
  out.faces.push_back(std::move(flat));
  return out;
}

void cut(Mesh& mesh, bool v, double from, double to) {
  const Vector3 along = v ? Vector3{0, 1, 0} : Vector3{1, 0, 0};
  cut_mesh(mesh, {along, from}, false);
  cut_mesh(mesh, {-along, -to}, false);
}

}  // namespace

tl::expected<UvRange, std::string> uv_range(const Shape& shape, bool v, bool unit_space, int set) {
  if (set < 0 || set >= kUvSetCount) return tl::unexpected<std::string>("the uv set must be 0 to 9");
  if (!geometry_has_uvs(shape, set))
    return tl::unexpected<std::string>("the geometry has no coordinates in uv set " + std::to_string(set));
  UvRange out;
  out.minimum = geometry_uv_minimum(shape, v, set);
  out.maximum = geometry_uv_maximum(shape, v, set);
  const double units = out.maximum - out.minimum;
  if (unit_space && units > 0) out.scale = geometry_uv_extent(shape, v, true, set) / units;
  return out;
}

std::vector<Shape> split_uv(const Shape& shape, bool v, int set, const UvRange& range,
                            std::span<const SplitPiece> pieces) {
  std::vector<Shape> out;
  const Mesh& mesh = mesh_of(shape);
  for (const SplitPiece& piece : pieces) {
    Shape& made = out.emplace_back(shape);
    made.split = {static_cast<std::int32_t>(out.size() - 1), static_cast<std::int32_t>(pieces.size())};
    made.mesh = nullptr;
    made.size = {};
    const double from = range.minimum + piece.from / range.scale, to = range.minimum + piece.to / range.scale;
    Mesh part;
    part.tag_sets = mesh.tag_sets;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      if (uv_of(mesh, set, f) == nullptr) continue;
      // Twice the same cut: once with the coordinates, once with the places.
      Mesh flat = laid_out(mesh, f, set, false), places = laid_out(mesh, f, set, true);
      cut(flat, v, from, to);
      cut(places, v, from, to);
      if (flat.faces.size() != places.faces.size()) continue;
      flat.vertices.clear();
      for (std::size_t g = 0; g < flat.faces.size(); ++g)
        for (std::size_t l = 0; l < flat.faces[g].loops.size(); ++l)
          for (std::size_t c = 0; c < flat.faces[g].loops[l].size(); ++c) {
            const Vector2 xy = places.uv[0][g][l][c];
            flat.faces[g].loops[l][c].vertex = static_cast<std::uint32_t>(flat.vertices.size());
            flat.vertices.push_back({xy.x, xy.y, places.uv[1][g][l][c].x});
          }
      append(part, flat);
    }
    weld(part, 1e-7);
    made.size = shape.size;
    take_mesh(made, std::move(part));
  }
  return out;
}

}  // namespace blockrand::grammar
