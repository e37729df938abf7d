// setback, setbackToArea, shapeL, shapeU, shapeO (docs/rule_language.md §2.5).
#include <algorithm>
#include <cmath>

#include "styles/grammar/shapes/offset.h"
#include "styles/grammar/shapes/pieces.h"

namespace blockrand::grammar {

namespace {

/// A shape with this geometry, given in the parent's scope; the scope is refitted.
Shape piece_of(const Shape& parent, Mesh mesh) {
  Shape piece = parent;
  piece.size = {};
  take_mesh(piece, std::move(mesh));
  return piece;
}

std::size_t corner_count(const MeshFace& face) {
  std::size_t count = 0;
  for (const Loop& loop : face.loops) count += loop.size();
  return count;
}

/// Each face of the shape with its strips; distances by corner of all faces in order.
std::vector<OffsetFaces> inset_all(const Mesh& mesh, std::span<const double> distances) {
  std::vector<OffsetFaces> out;
  std::size_t at = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::size_t count = corner_count(mesh.faces[f]);
    out.push_back(inset_faces(mesh, f, distances.subspan(at, std::min(count, distances.size() - at))));
    if (!out.back().done) {
      const auto face = static_cast<std::uint32_t>(f);
      out.back().mesh = extract_faces(mesh, std::span(&face, 1));
      out.back().edges = {-1};
    }
    at += count;
  }
  return out;
}

/// Faces of one side of `inset` (strips or inside) as one polygon each that hangs together.
Mesh united(const OffsetFaces& inset, bool strips) {
  Mesh out;
  out.tag_sets = inset.mesh.tag_sets;
  out.vertices = inset.mesh.vertices;
  std::vector<LooseEdge> edges;
  Vector3 normal;
  std::uint16_t tags = 0, material = 0;
  // By place along the outline, so that the first edge of the first strip leads.
  for (std::size_t f = 0; f < inset.mesh.faces.size(); ++f) {
    if ((inset.edges[f] >= 0) != strips) continue;
    const MeshFace& face = inset.mesh.faces[f];
    normal = face_normal(inset.mesh, face);
    tags = face.tags;
    material = face.material;
    for (const Loop& loop : face.loops)
      for (std::size_t c = 0; c < loop.size(); ++c) {
        // Outline edges come before all others.
        const auto order = static_cast<std::uint32_t>(edges.size()) + (c == 0 ? 0u : 0x1000000u);
        edges.push_back({loop[c].vertex, loop[(c + 1) % loop.size()].vertex, loop[c].edge_tags, order});
      }
  }
  for (MeshFace& face : faces_of_edges(out.vertices, std::move(edges), normal)) {
    face.tags = tags;
    face.material = material;
    out.faces.push_back(std::move(face));
  }
  drop_unused_vertices(out);
  return out;
}

Mesh inside_of(const OffsetFaces& inset) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < inset.edges.size(); ++f)
    if (inset.edges[f] < 0) faces.push_back(f);
  return extract_faces(inset.mesh, faces);
}

void tag_first_edge(Mesh& mesh, std::string_view tag) {
  for (MeshFace& face : mesh.faces) face.loops[0][0].edge_tags = add_tag(mesh, face.loops[0][0].edge_tags, tag);
}

}  // namespace

ComponentSplit setback_edges(const Shape& shape) { return components(shape, ComponentKind::face_edges); }

SetbackPieces setback_pieces(const Shape& shape, std::span<const double> distances) {
  SetbackPieces out;
  const Mesh& mesh = mesh_of(shape);
  std::size_t total = 0;
  for (const MeshFace& face : mesh.faces) total += corner_count(face);
  out.pieces.resize(total);
  std::vector<double> all(distances.begin(), distances.end());
  all.resize(total, 0);
  Mesh rest;
  std::size_t base = 0;
  const auto insets = inset_all(mesh, all);
  for (std::size_t f = 0; f < insets.size(); ++f) {
    const OffsetFaces& inset = insets[f];
    const std::size_t count = corner_count(mesh.faces[f]);
    for (std::size_t e = 0; e < count; ++e) {
      std::vector<std::uint32_t> faces;
      for (std::uint32_t g = 0; g < inset.edges.size(); ++g)
        if (inset.edges[g] == static_cast<std::int32_t>(e)) faces.push_back(g);
      if (faces.empty()) continue;
      Mesh strip = extract_faces(inset.mesh, faces);
      tag_first_edge(strip, "setback.front");
      out.pieces[base + e] = piece_of(shape, std::move(strip));
    }
    append(rest, inside_of(inset));
    base += count;
  }
  if (!rest.faces.empty()) out.remainder = piece_of(shape, std::move(rest));
  return out;
}

std::vector<double> setback_to_area(const Shape& shape, std::span<const std::size_t> chosen, double area,
                                    std::span<const double> minimum, std::span<const double> maximum) {
  const Mesh& mesh = mesh_of(shape);
  std::size_t total = 0;
  for (const MeshFace& face : mesh.faces) total += corner_count(face);
  const auto bound = [](std::span<const double> list, std::size_t i, double otherwise) {
    return list.empty() ? otherwise : list[std::min(i, list.size() - 1)];
  };
  const auto distances = [&](double increment) {
    std::vector<double> out(total, 0);
    for (const std::size_t i : chosen)
      if (i < total) out[i] = std::min(bound(minimum, i, 0) + increment, bound(maximum, i, 1e300));
    return out;
  };
  const auto left = [&](double increment) {
    const auto all = distances(increment);
    double sum = 0;
    for (const OffsetFaces& inset : inset_all(mesh, all))
      for (std::size_t f = 0; f < inset.edges.size(); ++f)
        if (inset.edges[f] < 0) sum += face_area(inset.mesh, inset.mesh.faces[f]);
    return sum;
  };
  if (!(area >= 0) || chosen.empty() || left(0) <= area) return distances(0);
  double low = 0, high = std::max(1.0, length(box_of(mesh).extent()));
  double low_area = left(low), high_area = left(high);
  // The area falls with the distance; halving, and straight interpolation every other time.
  constexpr double kNearEnough = 1e-7;  // m
  for (int i = 0; i < 100 && high - low > kNearEnough; ++i) {
    double middle = (low + high) / 2;
    if (i % 2 == 0 && low_area > high_area) middle = low + (high - low) * (low_area - area) / (low_area - high_area);
    middle = std::clamp(middle, low, high);
    const double here = left(middle);
    if (std::fabs(here - area) < 1e-9 * std::max(1.0, area)) return distances(middle);
    (here > area ? low : high) = middle;
    (here > area ? low_area : high_area) = here;
  }
  return distances((low + high) / 2);
}

std::optional<Shape> merge_pieces(std::span<const Shape> pieces) {
  if (pieces.empty()) return {};
  Shape out = pieces[0];
  Mesh mesh = mesh_of(out);
  const Frame frame = scope_in_object(out);
  for (const Shape& piece : pieces.subspan(1)) {
    Mesh other = mesh_of(piece);
    const Frame way = relative_to(frame, scope_in_object(piece));
    for (Vector3& p : other.vertices) p = place(way, p);
    append(mesh, other);
  }
  weld(mesh, 1e-7);
  take_mesh(out, std::move(mesh));
  return out;
}

ShapeAndRemainder shape_lu_o_pieces(const Shape& shape, double front, double right, double back, double left) {
  ShapeAndRemainder out;
  const ComponentSplit edges = setback_edges(shape);
  std::vector<double> distances(edges.items.size(), 0);
  const std::pair<std::string_view, double> sides[]{{"front", front}, {"right", right}, {"back", back}, {"left", left}};
  for (const auto& [name, width] : sides) {
    const auto selector = selector_of_word(name);
    for (std::size_t i = 0; i < edges.items.size(); ++i)
      if (distances[i] == 0 && width > 0 && selected(edges, i, *selector)) distances[i] = width;
  }
  const Mesh& mesh = mesh_of(shape);
  const auto insets = inset_all(mesh, distances);
  for (const OffsetFaces& inset : insets) {
    if (!inset.done) {  // nothing is set back
      out.remainders.push_back(piece_of(shape, inset.mesh));
      continue;
    }
    Mesh strips = united(inset, true), rest = inside_of(inset);
    if (!strips.faces.empty()) out.shapes.push_back(piece_of(shape, std::move(strips)));
    if (!rest.faces.empty()) out.remainders.push_back(piece_of(shape, std::move(rest)));
  }
  return out;
}

}  // namespace blockrand::grammar
