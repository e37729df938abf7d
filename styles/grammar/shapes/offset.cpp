// offset: a face moved in or out, and the ring between (docs/rule_language.md §2.2).
#include "styles/grammar/shapes/offset.h"

#include <algorithm>
#include <cmath>

#include "styles/grammar/shapes/operation_list.h"

namespace blockrand::grammar {

OffsetFaces inset_faces(const Mesh& mesh, std::size_t face, std::span<const double> distances) {
  OffsetFaces out;
  const auto flat = flat_face(mesh, face);
  if (!flat) return out;
  double most = 0;
  for (const double d : distances) most = std::max(most, std::isfinite(d) ? d : 0);
  if (!(most > 0)) return out;
  // All edges reach their distance at height `most`.
  std::vector<double> slopes;
  for (const double d : distances)
    slopes.push_back(std::isfinite(d) && d > most / 1000 ? most / d : geometry::kUpright);
  const auto plan = sweep_plan(*flat, slopes, most);
  if (!plan) return out;
  out.done = true;
  out.mesh.tag_sets = mesh.tag_sets;
  for (std::size_t i = 0; i < plan->points.size(); ++i)
    out.mesh.vertices.push_back(i < flat->vertices.size()
                                    ? mesh.vertices[flat->vertices[i]]
                                    : place(flat->plane, {plan->points[i].x, plan->points[i].y, 0}));
  const MeshFace& source = mesh.faces[face];
  const auto add = [&](const SweptFace& swept, std::int32_t edge) {
    MeshFace made;
    made.tags = source.tags;
    // Welding may drop faces without area: their number stands in for the material until it is done.
    made.material = static_cast<std::uint16_t>(out.edges.size());
    for (const auto& ring : swept.loops) {
      made.loops.emplace_back();
      for (const std::uint32_t v : ring) made.loops.back().push_back({v, 0});
    }
    if (edge >= 0) made.loops[0][0].edge_tags = flat->corners[static_cast<std::size_t>(edge)].edge_tags;
    out.mesh.faces.push_back(std::move(made));
    out.edges.push_back(edge);
  };
  for (const SweptFace& swept : plan->faces)
    if (swept.edge == SweptFace::kDeck) add(swept, -1);
  for (const SweptFace& swept : plan->faces)
    if (swept.edge != SweptFace::kDeck && !swept.upright) add(swept, swept.edge);
  weld(out.mesh, 1e-8);
  std::vector<std::int32_t> left;
  for (MeshFace& made : out.mesh.faces) {
    left.push_back(out.edges[made.material]);
    made.material = source.material;
  }
  out.edges = std::move(left);
  // The inner faces' first edges: those nearest to the first of the outline.
  const auto edges = edges_of(*flat);
  for (std::size_t f = 0; f < out.mesh.faces.size(); ++f) {
    if (out.edges[f] >= 0) continue;
    Loop& loop = out.mesh.faces[f].loops[0];
    std::size_t best = 0;
    std::size_t best_source = edges.size();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i].vertex, b = loop[(i + 1) % loop.size()].vertex;
      std::size_t from = edges.size();
      for (std::size_t g = 0; g < out.mesh.faces.size() && from == edges.size(); ++g) {
        if (out.edges[g] < 0) continue;
        for (const Loop& ring : out.mesh.faces[g].loops)
          for (std::size_t k = 0; k < ring.size(); ++k)
            if (ring[k].vertex == b && ring[(k + 1) % ring.size()].vertex == a)
              from = static_cast<std::size_t>(out.edges[g]);
      }
      for (std::size_t e = 0; e < edges.size() && from == edges.size(); ++e) {
        // On the outline itself: an edge that stayed.
        const Vector3 p = mesh.vertices[flat->vertices[edges[e].first]],
                      q = mesh.vertices[flat->vertices[edges[e].second]];
        const Vector3 along = normalized(q - p);
        const auto off = [&](std::uint32_t v) {
          const Vector3 r = out.mesh.vertices[v] - p;
          return length(r - along * dot(r, along));
        };
        if (off(a) < 1e-5 && off(b) < 1e-5 && dot(out.mesh.vertices[b] - out.mesh.vertices[a], along) > 0) from = e;
      }
      if (from < best_source) best_source = from, best = i;
    }
    std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(best), loop.end());
  }
  join_borders(out.mesh, 1e-5);
  return out;
}

Result run_offset(Shape& shape, const OperationInput&, Arguments arguments) {
  if (!is_number(arguments, 0)) return failure("the distance must be a number");
  const std::string_view keep = arguments.size() > 1 ? word(arguments, 1) : "all";
  if (keep != "all" && keep != "inside" && keep != "border") return failure(unknown_word(keep, "all, inside, border"));
  const double distance = number(arguments, 0);
  const Mesh& old = mesh_of(shape);
  if (old.faces.empty() || distance == 0) return {};
  Mesh out;
  out.tag_sets = old.tag_sets;
  for (std::uint32_t f = 0; f < old.faces.size(); ++f) {
    Mesh made;
    std::vector<std::uint32_t> kept;
    const auto flat = flat_face(old, f);
    if (distance < 0) {
      std::size_t corners = 0;
      for (const Loop& loop : old.faces[f].loops) corners += loop.size();
      OffsetFaces inset = inset_faces(old, f, std::vector<double>(corners, -distance));
      const bool any_inside = std::find(inset.edges.begin(), inset.edges.end(), -1) != inset.edges.end();
      if (inset.done && any_inside) {
        for (std::uint32_t g = 0; g < inset.edges.size(); ++g)
          if (keep == "all" || (keep == "inside") == (inset.edges[g] < 0)) kept.push_back(g);
        made = extract_faces(inset.mesh, kept);
      }
    } else if (flat) {
      const auto wider = expanded(*flat, std::vector<double>(flat->corners.size(), distance));
      if (wider) {
        made.tag_sets = old.tag_sets;
        std::vector<std::uint32_t> inner, outer;
        std::vector<model::Point2> moved = wider->polygon.outer.points;
        for (const auto& hole : wider->polygon.holes) moved.insert(moved.end(), hole.points.begin(), hole.points.end());
        const auto vertex = [&](Vector3 p) {
          made.vertices.push_back(p);
          return static_cast<std::uint32_t>(made.vertices.size() - 1);
        };
        for (std::size_t i = 0; i < moved.size(); ++i) {
          inner.push_back(vertex(old.vertices[flat->vertices[i]]));
          outer.push_back(vertex(wider->to_mesh(moved[i])));
        }
        const auto edges = edges_of(*flat);
        if (keep != "border") {
          MeshFace face = old.faces[f];
          std::size_t at = 0;
          for (Loop& loop : face.loops)
            for (Corner& c : loop) c.vertex = outer[at++];
          made.faces.push_back(std::move(face));
        }
        if (keep != "inside")
          for (std::size_t e = 0; e < edges.size(); ++e) {
            const auto [a, b] = edges[e];
            MeshFace ring{{{{outer[b], flat->corners[a].edge_tags}, {outer[a], 0}, {inner[a], 0}, {inner[b], 0}}},
                          old.faces[f].tags,
                          old.faces[f].material};
            made.faces.push_back(std::move(ring));
          }
        drop_unused_vertices(made);
      }
    }
    // Nothing left inside, or a face that cannot be moved: it stays as it was (2022.1).
    if (made.faces.empty()) made = extract_faces(old, std::span(&f, 1));
    append(out, made);
  }
  take_mesh(shape, std::move(out));
  return {};
}

}  // namespace blockrand::grammar
