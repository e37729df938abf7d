#include "importers/reference/triangle_model.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "importers/reference/gltf_file.h"
#include "importers/reference/gltf_scene.h"
#include "importers/reference/matrix4.h"
#include "pipeline/base/error.h"

namespace blockrand::importers::reference {
namespace {

constexpr std::size_t kMostNodes = 100'000;

class ModelReading {
 public:
  explicit ModelReading(const std::string& path) : path_(path), file_(path, notes_) { file_.refuse_files_beside(); }

  model::TriangleModel read() {
    const Json& scenes = member(file_.json(), "scenes");
    const Json& scene = element(scenes, index(member(file_.json(), "scene")).value_or(0));
    std::vector<std::pair<std::size_t, Matrix4>> open;
    const auto add = [&](const Json& numbers, const Matrix4& place) {
      for (std::size_t i = length(numbers); i-- > 0;)
        if (const auto n = index(numbers[i])) open.emplace_back(*n, place);
      if (open.size() > kMostNodes) fail("has nodes without end", "Export it again");
    };
    add(member(scene, "nodes"), kIdentity);
    for (std::size_t met = 0; !open.empty(); ++met) {
      if (met > kMostNodes) fail("has nodes without end", "Export it again");
      const auto [number, place] = open.back();
      open.pop_back();
      const Json& node = element(member(file_.json(), "nodes"), number);
      const auto own = GltfScene::transform_of(node);
      if (!own) fail("has a node whose matrix is none", "Export it again");
      if (!member(member(node, "extensions"), "EXT_mesh_gpu_instancing").is_null())
        fail("has instances", "Export it without them");
      const Matrix4 world = place * *own;
      if (const Json& mesh = member(node, "mesh"); !mesh.is_null())
        for (const Json& primitive : member(element_of(member(file_.json(), "meshes"), mesh), "primitives"))
          add_primitive(primitive, world);
      add(member(node, "children"), world);
    }
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw base::InputError(path_, "", what, remedy);
  }

  std::uint32_t material_of(const Json& primitive) {
    const Json& number = member(primitive, "material");
    const Json& material = element_of(member(file_.json(), "materials"), number);
    const std::string name = text(member(material, "name"));
    auto& names = out_.material_names;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<std::uint32_t>(found - names.begin());
    names.push_back(name);
    return static_cast<std::uint32_t>(names.size() - 1);
  }

  void add_primitive(const Json& primitive, const Matrix4& world) {
    constexpr std::size_t kTriangles = 4;
    if (index(member(primitive, "mode")).value_or(kTriangles) != kTriangles)
      fail("has strips, lines or points", "Export triangles");
    const auto positions = file_.accessor(member(member(primitive, "attributes"), "POSITION"));
    if (!positions || positions->components != 3) fail("has a mesh without corners", "Export it again");
    std::vector<model::Point3> points(positions->count());
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = apply(world, {positions->values[3 * i], positions->values[3 * i + 1], positions->values[3 * i + 2]});
      if (!std::isfinite(points[i].x + points[i].y + points[i].z)) fail("has a corner that is no place", "Mend it");
    }
    std::vector<std::size_t> corners;
    if (const Json& stated = member(primitive, "indices"); !stated.is_null()) {
      const auto indices = file_.accessor(stated);
      if (!indices) fail("has a mesh whose indices are not there", "Export it again");
      for (const double i : indices->values) {
        if (!(i >= 0 && i < static_cast<double>(points.size()))) fail("has a corner that does not exist", "Mend it");
        corners.push_back(static_cast<std::size_t>(i));
      }
    } else {
      for (std::size_t i = 0; i < points.size(); ++i) corners.push_back(i);
    }
    if (out_.triangles.size() + corners.size() / 3 > kMostModelTriangles)
      fail("has more than " + std::to_string(kMostModelTriangles) + " triangles", "Simplify it");
    const std::uint32_t material = material_of(primitive);
    const bool turned = mirrors(world);
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
      const model::Point3 &a = points[corners[t]], &b = points[corners[t + (turned ? 2 : 1)]],
                          &c = points[corners[t + (turned ? 1 : 2)]];
      if (a == b || b == c || c == a) continue;
      out_.triangles.push_back({{a, b, c}, material});
    }
  }

  std::string path_;
  NoteLog notes_;
  GltfFile file_;
  model::TriangleModel out_;
};

}  // namespace

model::TriangleModel read_triangle_model(const std::string& path) { return ModelReading(path).read(); }

}  // namespace blockrand::importers::reference
