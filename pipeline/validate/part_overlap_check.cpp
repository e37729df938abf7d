#include "pipeline/validate/part_overlap_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "pipeline/geometry/solid_defect.h"
#include "pipeline/geometry/solid_overlap.h"
#include "pipeline/model/roof_element.h"
#include "pipeline/validate/solids.h"

namespace blockrand::validate {
namespace {

using model::Point3;

struct Box {
  Point3 min, max;
};

/// What a body stands as at one level of detail; the mesh is made when it is first asked for.
struct Shape {
  std::string lod;
  Box box;
  const ReadSolid* solid = nullptr;
  const std::vector<GlbTriangle>* triangles = nullptr;
  std::optional<ReadMesh> mesh = std::nullopt;
  bool tried = false;

  const ReadMesh* get() {
    if (!tried) mesh = solid ? read_mesh(*solid) : read_mesh(*triangles);
    tried = true;
    return mesh ? &*mesh : nullptr;
  }
};

struct Body {
  std::string_view id;
  bool leans = false;  ///< on sloping surfaces, along a whole edge of the roof
  std::vector<Shape> shapes = {};
};

/// Bodies along the edges of roofs lie on slopes whose corners are rounded to the grid: both surfaces are the same to a
/// millimetre or two, not to the last bit.
bool leans_on_a_roof(std::string_view kind) {
  using enum model::RoofElementKind;
  constexpr model::RoofElementKind kLeaning[] = {eaves, verge, ridge_cap, hip_cap, parapet, firewall, gable, gutter};
  return std::ranges::any_of(kLeaning, [kind](model::RoofElementKind k) { return model::name(k) == kind; });
}

class BoxMaker {
 public:
  void add(const Point3& p) {
    if (empty_) box_ = {p, p};
    empty_ = false;
    box_.min = {std::min(box_.min.x, p.x), std::min(box_.min.y, p.y), std::min(box_.min.z, p.z)};
    box_.max = {std::max(box_.max.x, p.x), std::max(box_.max.y, p.y), std::max(box_.max.z, p.z)};
  }
  bool empty() const { return empty_; }
  const Box& box() const { return box_; }

 private:
  Box box_;
  bool empty_ = true;
};

bool meet(const Box& a, const Box& b) {
  return a.max.x > b.min.x && b.max.x > a.min.x && a.max.y > b.min.y && b.max.y > a.min.y && a.max.z > b.min.z &&
         b.max.z > a.min.z;
}

geometry::ClosedMesh view(const ReadMesh& mesh) { return {mesh.vertices, mesh.triangles}; }

/// How much two meshes of one level of detail have in common, in m³; 0 where that is tolerated.
using Common = double (*)(const ReadMesh& a, const ReadMesh& b);

/// Of coordinates on the grid: nothing is tolerated.
double common_exactly(const ReadMesh& a, const ReadMesh& b) {
  const double volume = geometry::common_volume(view(a), view(b));
  return volume > geometry::kLeastCommonVolume ? volume : 0;
}

/// Of coordinates that are rounded to floats.
double common_roughly(const ReadMesh& a, const ReadMesh& b) {
  const geometry::SolidOverlap found = geometry::overlap_of(view(a), view(b));
  return found.overlap ? found.volume : 0;
}

/// Of what leans on a roof: 1 cm of depth is touching, beyond it a cubic centimetre counts.
double common_deeply(const ReadMesh& a, const ReadMesh& b) {
  constexpr geometry::OverlapOptions kTouching{.depth = 0.01, .volume = 1e-6};
  const geometry::SolidOverlap found = geometry::overlap_of(view(a), view(b), kTouching);
  return found.overlap ? found.volume : 0;
}

std::string volume_text(double volume) {
  return volume >= 0.01 ? fmt::format("{:.2f} m³", volume) : fmt::format("{:.2g} cm³", volume * 1e6);
}

std::vector<PartsOverlap> compare(std::map<std::string_view, std::vector<Body>>& buildings, Common common,
                                  std::uint64_t& pairs) {
  std::vector<PartsOverlap> out;
  for (auto& [building, bodies] : buildings)
    for (std::size_t i = 0; i < bodies.size(); ++i)
      for (std::size_t j = i + 1; j < bodies.size(); ++j) {
        if (bodies[i].id == bodies[j].id) continue;  // one body twice, which is a finding already
        std::string where;
        bool compared = false;
        for (Shape& a : bodies[i].shapes)
          for (Shape& b : bodies[j].shapes) {
            if (a.lod != b.lod || !meet(a.box, b.box)) continue;
            const ReadMesh *one = a.get(), *other = b.get();
            if (!one || !other) continue;
            compared = true;
            const Common judge = bodies[i].leans || bodies[j].leans ? common_deeply : common;
            if (const double volume = judge(*one, *other); volume > 0)
              where += fmt::format("{} {} in {}", where.empty() ? ":" : ",", volume_text(volume), a.lod);
          }
        pairs += compared;
        if (!where.empty())
          out.push_back({std::string(bodies[i].id), std::string(bodies[j].id),
                         fmt::format("{} overlaps {}{}", geometry::kPartsOverlapCode, bodies[j].id, where)});
      }
  return out;
}

}  // namespace

std::vector<PartsOverlap> find_overlaps(const Contents& contents, std::uint64_t& pairs) {
  std::map<std::string_view, std::vector<Body>> buildings;
  // Polygons of installations are no ReadSolid yet; they must not move while bodies point to them.
  std::deque<ReadSolid> installations;
  const auto add = [](Body& body, const ReadSolid& solid) {
    BoxMaker box;
    for (const ReadPolygon& polygon : solid.polygons)
      for (const auto& ring : polygon.rings)
        for (const Point3& p : ring) box.add(p);
    if (!box.empty()) body.shapes.push_back({fmt::format("LoD {}", solid.lod), box.box(), &solid});
  };
  for (const ReadBody& body : contents.bodies) {
    std::vector<Body>& of_building = buildings[body.building];
    Body& made = of_building.emplace_back(Body{body.id});
    for (const ReadSolid& solid : body.solids) add(made, solid);
    for (const ReadInstallation& installation : body.detail.installations)
      add(of_building.emplace_back(Body{installation.id, leans_on_a_roof(installation.kind)}),
          installations.emplace_back(ReadSolid{3, installation.polygons}));
  }
  return compare(buildings, common_exactly, pairs);
}

std::vector<PartsOverlap> find_overlaps(const Glb& glb, std::uint64_t& pairs) {
  std::map<std::string_view, std::vector<Body>> buildings;
  for (std::size_t i = 0; i < glb.triangles.size(); ++i) {
    const ReadBody& body = glb.contents.bodies[i];
    BoxMaker box;
    for (const GlbTriangle& t : glb.triangles[i])
      for (const Point3& p : t.corners) box.add(p);
    const auto lod = body.attributes.find("lod");
    // A footprint laid on the ground is no solid.
    if (box.empty() || (lod != body.attributes.end() && lod->second == "0")) continue;
    Body& made = buildings[body.building].emplace_back(Body{body.id});
    made.shapes.push_back({"the mesh", box.box(), nullptr, &glb.triangles[i]});
  }
  return compare(buildings, common_roughly, pairs);
}

}  // namespace blockrand::validate
