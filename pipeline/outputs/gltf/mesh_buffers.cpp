#include "pipeline/outputs/gltf/mesh_buffers.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <deque>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "pipeline/geometry/solid_builder.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/model/vector.h"
#include "pipeline/outputs/gltf/element_geometry.h"
#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/outputs/gltf/point_numbers.h"
#include "pipeline/outputs/placed_element.h"

namespace blockrand::outputs {
namespace {

struct SolidRef {
  const model::Solid* solid = nullptr;
  const model::SolidTriangles* triangles = nullptr;
  std::uint32_t feature = 0;
  std::uint32_t first_position = 0;
  std::vector<bool> hidden;  ///< faces that elements stand for; empty: none
};

}  // namespace

std::vector<bool> hidden_faces(const model::Region& region, const model::Detail& detail, bool bake) {
  std::vector<bool> hidden(detail.solid.faces.size(), false);
  for (const model::Placement& p : detail.placements) {
    if (p.opening == model::kNoOpening) continue;
    const model::Opening& o = detail.openings[p.opening];
    if (o.kind == model::OpeningKind::passage) continue;
    if (!has_shape(*region.elements.at(p.element).element)) continue;  // nothing would close the wall
    hidden[o.polygon] = true;
    for (std::uint32_t i = 0; i < o.reveal_count && !bake; ++i) hidden[o.first_reveal + i] = true;
  }
  return hidden;
}

namespace {

/// The best solid of the part at or below `lod`, or nullptr.
std::pair<const model::Solid*, const model::SolidTriangles*> solid_of(const model::BuildingPart& part, int lod) {
  if (lod >= 3 && part.lod >= 3 && !part.lod3.solid.empty()) return {&part.lod3.solid, &part.lod3.triangles};
  if (lod >= 2 && part.lod >= 2 && !part.lod2.empty()) return {&part.lod2, &part.lod2_triangles};
  if (lod >= 1 && part.lod >= 1 && !part.lod1.empty()) return {&part.lod1, &part.lod1_triangles};
  return {nullptr, nullptr};
}

/// A footprint as a mesh: one horizontal face on the ground in the roof's looks. No solid, only what LoD0 shows.
struct Footprint {
  model::Solid surface;
  model::SolidTriangles triangles;
};

std::optional<Footprint> footprint_of(const model::BuildingPart& part, const model::Region& region) {
  if (part.lod < 0 || part.plan.outer.size() < 3) return std::nullopt;
  const double z = part.attributes.ground_height.value;
  std::vector<std::vector<model::Point3>> loops;
  const auto add = [&](const model::Ring& ring) {
    auto& loop = loops.emplace_back();
    for (const model::Point2& p : ring.points) loop.push_back({p.x, p.y, z});
  };
  add(part.plan.outer);
  for (const model::Ring& hole : part.plan.holes) add(hole);
  model::Face looks;
  looks.kind = model::SurfaceKind::roof;
  looks.colour = part.attributes.shown_roof_colour;
  for (std::size_t m = 0; m < region.materials.size(); ++m)
    if (region.materials[m].name == part.attributes.roof_material.value) looks.material = static_cast<std::uint8_t>(m);
  geometry::SolidBuilder builder;
  builder.add_face(loops, looks);
  Footprint out{builder.take(), {}};
  auto triangles = geometry::triangulate(out.surface);
  if (out.surface.empty() || !triangles) return std::nullopt;
  out.triangles = std::move(*triangles);
  return out;
}

std::array<std::int8_t, 3> face_normal(const model::Solid& solid, const model::Face& face,
                                       const model::Point3* positions) {
  const model::Solid::Loop& outer = solid.loops[face.first_loop];
  const std::span<const std::uint32_t> indices = solid.indices_of(outer);
  // Relative to a corner of the face: products of coordinates far from the origin would cancel badly.
  const model::Point3 origin = positions[indices[0]];
  double x = 0, y = 0, z = 0;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const model::Point3& p = positions[indices[i]];
    const model::Point3& q = positions[indices[i + 1 == indices.size() ? 0 : i + 1]];
    const double px = p.x - origin.x, py = p.y - origin.y, pz = p.z - origin.z;
    const double qx = q.x - origin.x, qy = q.y - origin.y, qz = q.z - origin.z;
    x += py * qz - pz * qy;
    y += pz * qx - px * qz;
    z += px * qy - py * qx;
  }
  const double length = std::sqrt(x * x + y * y + z * z);
  if (!(length > 0)) return {0, 0, 127};
  const auto quantise = [&](double v) { return static_cast<std::int8_t>(std::nearbyint(v / length * 127)); };
  return {quantise(x), quantise(y), quantise(z)};
}

/// The primitives of a mesh while faces come in: one for all or one for each look, another when one is full.
class Primitives {
 public:
  enum class By : std::uint8_t { all, look };
  explicit Primitives(By by) : by_(by) {}

  /// The one for a face with `corners` more vertices at most.
  MeshPrimitive& with_room(const model::PartMaterial& look, std::size_t corners) {
    Bucket& bucket = buckets_[by_ == By::all ? std::array<std::uint8_t, 4>{}
                                             : std::array{look.material, look.colour.r, look.colour.g, look.colour.b}];
    if (bucket.pieces.empty() || bucket.pieces.back().vertices.size() + corners > MeshPrimitive::kMostVertices)
      bucket.pieces.emplace_back().look = look;
    return bucket.pieces.back();
  }

  std::vector<MeshPrimitive> take() {
    std::vector<MeshPrimitive> out;
    for (auto& [look, bucket] : buckets_)
      std::move(bucket.pieces.begin(), bucket.pieces.end(), std::back_inserter(out));
    return out;
  }

 private:
  struct Bucket {
    std::deque<MeshPrimitive> pieces;  // a deque keeps its elements in place
  };

  By by_;
  std::map<std::array<std::uint8_t, 4>, Bucket> buckets_;  ///< by material and colour
};

/// Finds equal vertices of one part: open addressing, cleared by a stamp.
class Welder {
 public:
  void start(std::size_t corners) {
    std::size_t size = 64;
    while (size < corners * 2) size *= 2;
    if (size > slots_.size()) slots_.assign(size, {});
    mask_ = slots_.size() - 1;
    ++stamp_;
  }
  std::uint16_t index(MeshPrimitive& primitive, const MeshVertex& vertex) {
    std::uint64_t h = vertex.position * 0x9E3779B97F4A7C15u;
    h ^= (static_cast<std::uint64_t>(static_cast<std::uint8_t>(vertex.normal[0])) << 16 |
          static_cast<std::uint64_t>(static_cast<std::uint8_t>(vertex.normal[1])) << 8 |
          static_cast<std::uint8_t>(vertex.normal[2])) *
         0xC2B2AE3D27D4EB4Fu;
    h ^= h >> 29;
    for (std::size_t i = h & mask_;; i = (i + 1) & mask_) {
      Slot& slot = slots_[i];
      if (slot.stamp != stamp_) {
        slot = {stamp_, static_cast<std::uint16_t>(primitive.vertices.size()), &primitive};
        primitive.vertices.push_back(vertex);
        return slot.index;
      }
      if (slot.primitive == &primitive && primitive.vertices[slot.index] == vertex) return slot.index;
    }
  }

 private:
  struct Slot {
    std::uint32_t stamp = 0;
    std::uint16_t index = 0;
    const MeshPrimitive* primitive = nullptr;
  };
  std::vector<Slot> slots_;
  std::size_t mask_ = 0;
  std::uint32_t stamp_ = 0;
};

/// Makes positions that are equal within a solid one index, so that welding by index is welding by position.
void unify_equal_points(const std::vector<model::Point3>& points, std::uint32_t first, std::uint32_t count,
                        std::vector<std::uint32_t>& representative, PointNumbers& numbers) {
  numbers.start(count);
  for (std::uint32_t i = first; i < first + count; ++i)
    representative[i] =
        numbers.first(hash_of(points[i]), i, [&](std::uint32_t other) { return points[other] == points[i]; });
}

/// Puts the triangles of an element that stands at `at` into the mesh.
void bake_element(const model::ColouredElement& element, const ElementGeometry& geometry, const ElementInstance& at,
                  Panes panes, const PaneMaterials* materials, Mesh& mesh, Primitives& primitives) {
  const model::Point2 out{at.along.y, -at.along.x};
  const auto turn = [&](double x, double y, double z) {
    return model::Point3{at.along.x * x + out.x * z, at.along.y * x + out.y * z, y};
  };
  for (const ElementGeometry::PartTriangles& part : geometry.parts) {
    model::PartMaterial look = element.materials[static_cast<std::size_t>(part.part)];
    if (materials && part.part == model::ElementPart::glass) look = materials->look(panes, part.screen, look);
    MeshPrimitive& primitive = primitives.with_room(look, part.vertices.size());
    const std::size_t first = primitive.vertices.size();
    for (const ElementVertex& v : part.vertices) {
      const model::Point3 d = turn(v.position.x, v.position.y, v.position.z);
      const model::Point3 n = turn(v.exact_normal.x, v.exact_normal.y, v.exact_normal.z);
      MeshVertex vertex;
      vertex.position = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.push_back({at.origin.x + d.x, at.origin.y + d.y, at.origin.z + d.z});
      vertex.feature = at.feature;
      vertex.look = look;
      const auto quantise = [](double c) { return static_cast<std::int8_t>(std::nearbyint(c * 127)); };
      vertex.normal = {quantise(n.x), quantise(n.y), quantise(n.z)};
      primitive.vertices.push_back(vertex);
    }
    for (const std::uint32_t i : part.indices) primitive.indices.push_back(static_cast<std::uint16_t>(first + i));
    mesh.triangles += part.indices.size() / 3;
  }
}

/// In whole steps of a tile.
model::Point3 on_tile_grid(const model::Point3& p) {
  const auto snap = [](double v) { return std::nearbyint(v * kTileStepsPerMetre) / kTileStepsPerMetre; };
  return {snap(p.x), snap(p.y), snap(p.z)};
}

/// Puts the triangles of a piece into the mesh, wherever it stands. Place and corner are rounded one by one: all copies
/// on a wall have the same steps from corner to corner, which gzip finds. A corner lies up to 0.85 mm from its place.
void bake_piece(const BakedPiece& baked, Mesh& mesh, Primitives& primitives) {
  const Piece& piece = baked.piece;
  for (const ElementInstance& at : *baked.places) {
    const PieceTurn turn(at.along);
    MeshPrimitive& primitive = primitives.with_room({}, piece.vertices.size());
    const std::size_t first = primitive.vertices.size();
    for (const Piece::Vertex& v : piece.vertices) {
      const model::Point3 n = turn(v.normal);
      MeshVertex vertex;
      vertex.position = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.push_back(on_tile_grid(at.origin) + on_tile_grid(turn(piece.middle + model::Point3(v.position))));
      vertex.feature = at.feature;
      vertex.look = v.look;
      const auto quantise = [](double c) { return static_cast<std::int8_t>(std::nearbyint(c * 127)); };
      vertex.normal = {quantise(n.x), quantise(n.y), quantise(n.z)};
      primitive.vertices.push_back(vertex);
    }
    for (const std::uint32_t i : piece.indices) primitive.indices.push_back(static_cast<std::uint16_t>(first + i));
    mesh.triangles += piece.triangles();
  }
}

/// The solids or footprints that are shown, and their points.
struct Bodies {
  std::vector<SolidRef> solids;       ///< by ascending feature
  std::deque<Footprint> footprints;   ///< a deque keeps its elements in place
  std::vector<model::Point3> source;  ///< in the build CRS
  std::vector<model::Point3> local;   ///< the same in the frame
  std::uint32_t features = 0;
};

Bodies collect_bodies(const model::Region& region, int lod, const Frame& frame, bool bake) {
  Bodies out;
  for (const model::Building& building : region.buildings) {
    if (!building.owned) continue;
    for (const model::BuildingPart& part : building.parts) {
      const std::uint32_t feature = out.features++;
      auto [solid, triangles] = solid_of(part, lod);
      if (lod == 0) {
        if (auto footprint = footprint_of(part, region)) {
          solid = &out.footprints.emplace_back(std::move(*footprint)).surface;
          triangles = &out.footprints.back().triangles;
        }
      }
      if (!solid) continue;
      const auto add = [&](const model::Solid& shown, const model::SolidTriangles& its, std::vector<bool> hidden) {
        out.solids.push_back({&shown, &its, feature, static_cast<std::uint32_t>(out.source.size()), std::move(hidden)});
        out.source.insert(out.source.end(), shown.vertices.begin(), shown.vertices.end());
      };
      const bool detailed = solid == &part.lod3.solid;
      add(*solid, *triangles, detailed ? hidden_faces(region, part.lod3, bake) : std::vector<bool>{});
      if (!detailed) continue;
      for (const model::WallInstallation& body : part.lod3.installations) add(body.solid, body.triangles, {});
      for (const model::RoofInstallation& body : part.lod3.roof_installations) add(body.solid, body.triangles, {});
    }
  }
  out.local.resize(out.source.size());
  if (frame.to_enu)
    frame.to_enu(out.source, out.local);
  else
    out.local = out.source;
  return out;
}

/// Puts solids into meshes.
class SolidWriter {
 public:
  explicit SolidWriter(const std::vector<model::Point3>& source) : source_(source), representative_(source.size()) {}

  /// \param first  the point that is the first one of `mesh.positions`
  void add(const SolidRef& ref, std::uint32_t first, Mesh& mesh, Primitives& primitives) {
    const model::Solid& solid = *ref.solid;
    assert(ref.triangles->first.size() == solid.faces.size() + 1);
    const auto count = static_cast<std::uint32_t>(solid.vertices.size());
    unify_equal_points(source_, ref.first_position, count, representative_, numbers_);
    welder_.start(ref.triangles->triangles.size() * 3);
    for (std::size_t f = 0; f < solid.faces.size(); ++f) {
      if (!ref.hidden.empty() && ref.hidden[f]) continue;
      const model::Face& face = solid.faces[f];
      const std::uint32_t begin = ref.triangles->first[f], end = ref.triangles->first[f + 1];
      if (begin == end) continue;
      MeshPrimitive* primitive = nullptr;
      MeshVertex vertex;
      vertex.feature = ref.feature;
      vertex.normal = face_normal(solid, face, mesh.positions.data() + (ref.first_position - first));
      const model::PartMaterial look{face.material, face.colour};
      vertex.look = look;
      for (std::uint32_t t = begin; t < end; ++t) {
        if (!primitive || primitive->vertices.size() + 3 > MeshPrimitive::kMostVertices)
          primitive = &primitives.with_room(look, 3);
        for (const std::uint32_t corner : ref.triangles->triangles[t]) {
          vertex.position = representative_[ref.first_position + corner] - first;
          primitive->indices.push_back(welder_.index(*primitive, vertex));
        }
        ++mesh.triangles;
      }
    }
  }

 private:
  const std::vector<model::Point3>& source_;
  std::vector<std::uint32_t> representative_;
  PointNumbers numbers_;
  Welder welder_;
};

void set_box(Mesh& mesh) {
  bool first = true;
  for (const auto* list : {&mesh.primitives, &mesh.pieces})
    for (const MeshPrimitive& primitive : *list)
      for (const MeshVertex& v : primitive.vertices) {
        const model::Point3& p = mesh.positions[v.position];
        if (first) mesh.min = mesh.max = p;
        first = false;
        mesh.min = {std::min(mesh.min.x, p.x), std::min(mesh.min.y, p.y), std::min(mesh.min.z, p.z)};
        mesh.max = {std::max(mesh.max.x, p.x), std::max(mesh.max.y, p.y), std::max(mesh.max.z, p.z)};
      }
}

}  // namespace

Mesh build_mesh(const model::Region& region, int lod, const Frame& frame, bool bake, std::span<const BakedPiece> pieces,
                const PaneMaterials* panes) {
  Bodies bodies = collect_bodies(region, lod, frame, bake);
  Mesh mesh;
  mesh.positions = std::move(bodies.local);
  mesh.solid_positions = mesh.positions.size();
  Primitives primitives(Primitives::By::all);
  {
    SolidWriter writer(bodies.source);
    for (const SolidRef& ref : bodies.solids) writer.add(ref, 0, mesh, primitives);
  }
  bodies = {};
  if (bake && lod >= 3)
    for (const InstanceGroup& group : element_instances(region, frame, panes != nullptr)) {
      const model::ColouredElement& element = region.elements[group.element];
      const ElementGeometry geometry = element_geometry(*element.element, false, group.panes);
      for (const ElementInstance& at : group.instances)
        bake_element(element, geometry, at, group.panes, panes, mesh, primitives);
    }
  std::size_t points = mesh.positions.size();
  for (const BakedPiece& piece : pieces) points += piece.places->size() * piece.piece.vertices.size();
  mesh.positions.reserve(points);
  Primitives of_pieces(Primitives::By::all);
  for (const BakedPiece& piece : pieces) bake_piece(piece, mesh, of_pieces);
  mesh.primitives = primitives.take();
  mesh.pieces = of_pieces.take();
  set_box(mesh);
  return mesh;
}

void for_each_part_mesh(const model::Region& region, int lod, const Frame& frame, bool bake,
                        const std::function<void(std::uint32_t feature, Mesh mesh)>& visit,
                        const PaneMaterials* panes) {
  const Bodies bodies = collect_bodies(region, lod, frame, bake);
  std::vector<InstanceGroup> groups;
  if (bake && lod >= 3) groups = element_instances(region, frame, panes != nullptr);
  const std::vector<PartElement> elements = elements_by_part(groups);
  SolidWriter writer(bodies.source);
  auto ref = bodies.solids.begin();
  auto element = elements.begin();
  for (std::uint32_t feature = 0; feature < bodies.features; ++feature) {
    Mesh mesh;
    Primitives primitives(Primitives::By::look);
    const auto end = std::find_if(ref, bodies.solids.end(), [&](const SolidRef& r) { return r.feature != feature; });
    if (ref != end) {
      const std::uint32_t first = ref->first_position;
      const std::size_t last = end == bodies.solids.end() ? bodies.local.size() : end->first_position;
      mesh.positions.assign(bodies.local.begin() + first, bodies.local.begin() + static_cast<std::ptrdiff_t>(last));
      mesh.solid_positions = mesh.positions.size();
      for (; ref != end; ++ref) writer.add(*ref, first, mesh, primitives);
    }
    ElementGeometry geometry;
    for (std::pair known(model::kNoIndex, Panes::as_modelled);
         element != elements.end() && element->at->feature == feature; ++element) {
      const model::ColouredElement& coloured = region.elements[element->element];
      const std::pair wanted(element->element, element->panes);
      if (known != wanted) geometry = element_geometry(*coloured.element, false, element->panes);
      known = wanted;
      bake_element(coloured, geometry, *element->at, element->panes, panes, mesh, primitives);
    }
    mesh.primitives = primitives.take();
    set_box(mesh);
    visit(feature, std::move(mesh));
  }
}

}  // namespace blockrand::outputs
