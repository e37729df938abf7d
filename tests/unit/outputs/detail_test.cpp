// LoD3 in the files: elements stored once and placed, the same picture however they are written, CityGML with openings.
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/geometry/cgal_validator.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/outputs/citygml/citygml_writer.h"
#include "pipeline/outputs/gltf/element_pieces.h"
#include "pipeline/outputs/gltf/glb_writer.h"
#include "pipeline/picture/camera.h"
#include "pipeline/picture/render.h"
#include "tests/unit/outputs/citygml_support.h"
#include "tests/unit/outputs/facade_region.h"
#include "tests/validators/citygml_reader.h"

namespace blockrand::outputs {
namespace {

using nlohmann::json;
using test::facade_region;
using test::gml_options;
using test::SampleRegion;
using test::validity;

GlbOptions options(Instancing how) {
  GlbOptions o;
  o.lod = 3;
  o.instancing = how;
  o.crs = "EPSG:25833";
  o.frame.to_enu = [](std::span<const model::Point3> in, std::span<model::Point3> out) {
    for (std::size_t i = 0; i < in.size(); ++i) {
      const double x = in[i].x - 391040.7, y = in[i].y - 5819030.2;
      out[i] = {0.99978 * x - 0.02094 * y, 0.02094 * x + 0.99978 * y, in[i].z};
    }
  };
  return o;
}

struct Vector {
  double x = 0, y = 0, z = 0;
};

/// A GLB as a viewer sees it: every triangle in the scene's frame, with its feature. Written for this test alone.
class Scene {
 public:
  explicit Scene(const std::string& bytes) {
    std::uint32_t length = 0;
    std::memcpy(&length, &bytes[12], 4);
    document = json::parse(bytes.substr(20, length));
    binary_ = bytes.substr(20 + length + 8);
    for (const json& view : document["bufferViews"]) views_.push_back(bytes_of(view));
    for (const int n : document["scenes"][0]["nodes"]) {
      const json& node = document["nodes"][n];
      add_node(node, 1);
      if (!node.contains("children")) continue;
      const auto scale = node["scale"].get<std::vector<double>>();
      EXPECT_EQ(scale, std::vector<double>(3, scale[0]));
      for (const int child : node["children"]) add_node(document["nodes"][child], scale[0]);
    }
  }

  json document;
  struct Triangle {
    Vector corner[3];
    int feature = -1;
    double colour[3];  ///< linear light
  };
  std::vector<Triangle> triangles;
  std::size_t places = 0;

 private:
  /// A view's bytes; compressed ones through meshoptimizer's decoder, as viewers do.
  std::string bytes_of(const json& view) const {
    const std::size_t length = view["byteLength"];
    if (!view.contains("extensions")) return binary_.substr(view.value("byteOffset", std::size_t{0}), length);
    const json& packed = view["extensions"]["EXT_meshopt_compression"];
    EXPECT_EQ(view["buffer"], 1);
    EXPECT_EQ(packed["buffer"], 0);
    const std::size_t count = packed["count"], stride = packed["byteStride"], size = packed["byteLength"];
    EXPECT_EQ(length, count * stride);
    std::string out(length, '\0');
    const auto* from = reinterpret_cast<const unsigned char*>(&binary_.at(packed.value("byteOffset", std::size_t{0})));
    if (packed["mode"] == "TRIANGLES") {
      EXPECT_EQ(meshopt_decodeIndexBuffer(out.data(), count, stride, from, size), 0);
    } else {
      EXPECT_EQ(meshopt_decodeVertexBuffer(out.data(), count, stride, from, size), 0);
      if (packed.value("filter", "NONE") == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), count, stride);
    }
    return out;
  }

  std::vector<double> accessor(int number) const {
    const json& a = document["accessors"][number];
    const json& view = document["bufferViews"][a["bufferView"].get<int>()];
    const std::string& bytes = views_.at(a["bufferView"].get<std::size_t>());
    const int component = a["componentType"];
    const std::size_t size = component == 5126 || component == 5125   ? 4
                             : component == 5122 || component == 5123 ? 2
                                                                      : 1;
    const std::map<std::string, std::size_t> widths{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
    const std::size_t width = widths.at(a["type"]), count = a["count"];
    const std::size_t stride = view.value("byteStride", size * width);
    const std::size_t start = a.value("byteOffset", std::size_t{0});
    EXPECT_EQ(a.value("byteOffset", std::size_t{0}) % size, 0u) << "accessors are aligned to their components";
    const bool normalised = a.value("normalized", false);
    std::vector<double> out;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < width; ++k) {
        const char* at = &bytes.at(start + i * stride + k * size);
        EXPECT_LE(start + i * stride + k * size + size, bytes.size());
        const auto read = [&](auto zero, double most) {
          std::memcpy(&zero, at, sizeof(zero));
          out.push_back(normalised ? static_cast<double>(zero) / most : static_cast<double>(zero));
        };
        switch (component) {
          case 5120:
            read(std::int8_t{}, 127);
            break;
          case 5121:
            read(std::uint8_t{}, 255);
            break;
          case 5122:
            read(std::int16_t{}, 32767);
            break;
          case 5123:
            read(std::uint16_t{}, 65535);
            break;
          case 5125:
            read(std::uint32_t{}, 1);
            break;
          default:
            read(float{}, 1);
        }
      }
    return out;
  }

  static Vector turned(const std::vector<double>& q, Vector v) {
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const Vector t{2 * (y * v.z - z * v.y), 2 * (z * v.x - x * v.z), 2 * (x * v.y - y * v.x)};
    return {v.x + w * t.x + y * t.z - z * t.y, v.y + w * t.y + z * t.x - x * t.z, v.z + w * t.z + x * t.y - y * t.x};
  }

  /// \param size  of a step, m
  void add_node(const json& node, double size) {
    if (!node.contains("mesh")) return;
    const auto list = [&](const char* key, std::vector<double> usual) {
      return node.contains(key) ? node[key].get<std::vector<double>>() : usual;
    };
    const auto t = list("translation", {0, 0, 0}), r = list("rotation", {0, 0, 0, 1}), s = list("scale", {1, 1, 1});
    std::vector<double> ts{0, 0, 0}, rs{0, 0, 0, 1}, ss{1, 1, 1}, fs{-1};
    std::size_t n = 1;
    const bool instanced = node.contains("extensions") && node["extensions"].contains("EXT_mesh_gpu_instancing");
    if (instanced) {
      const json& a = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
      ts = accessor(a["TRANSLATION"]);
      rs = accessor(a["ROTATION"]);
      fs = accessor(a["_FEATURE_ID_0"]);
      n = fs.size();
      ss = a.contains("SCALE") ? accessor(a["SCALE"]) : std::vector<double>(3 * n, 1);
      EXPECT_EQ(ts.size(), 3 * n);
      EXPECT_EQ(rs.size(), 4 * n);
      EXPECT_EQ(ss.size(), 3 * n);
      const json& id = node["extensions"]["EXT_instance_features"]["featureIds"][0];
      EXPECT_EQ(id["attribute"], 0);
      EXPECT_EQ(id["propertyTable"], 0);
      EXPECT_EQ(id["featureCount"].get<std::size_t>(), std::set<double>(fs.begin(), fs.end()).size());
    } else if (node.contains("extras")) {
      fs = {node["extras"]["feature"].get<double>()};
    }
    const bool placed = instanced || node.contains("extras");
    places += placed ? n : 0;
    for (const json& p : document["meshes"][node["mesh"].get<int>()]["primitives"]) {
      const auto position = accessor(p["attributes"]["POSITION"]), index = accessor(p["indices"]);
      std::vector<double> feature, colour;
      if (!placed) feature = accessor(p["attributes"]["_FEATURE_ID_0"]);
      const auto normal = accessor(p["attributes"]["NORMAL"]);
      double worst = 0;  // Khronos' validator takes up to 0.00674 off
      for (std::size_t v = 0; v + 2 < normal.size(); v += 3)
        worst = std::max(worst, std::fabs(std::sqrt(normal[v] * normal[v] + normal[v + 1] * normal[v + 1] +
                                                    normal[v + 2] * normal[v + 2]) -
                                          1));
      EXPECT_LT(worst, 0.0067) << "normals have length one";
      if (p["attributes"].contains("COLOR_0")) colour = accessor(p["attributes"]["COLOR_0"]);
      const json& material = document["materials"][p["material"].get<int>()]["pbrMetallicRoughness"];
      for (std::size_t k = 0; k < n; ++k)
        for (std::size_t i = 0; i < index.size(); i += 3) {
          Triangle out;
          for (std::size_t c = 0; c < 3; ++c) {
            const auto v = static_cast<std::size_t>(index[i + c]);
            const Vector local = turned({rs[4 * k], rs[4 * k + 1], rs[4 * k + 2], rs[4 * k + 3]},
                                        {position[3 * v] * ss[3 * k], position[3 * v + 1] * ss[3 * k + 1],
                                         position[3 * v + 2] * ss[3 * k + 2]});
            const Vector in_node{(local.x + ts[3 * k]) * s[0], (local.y + ts[3 * k + 1]) * s[1],
                                 (local.z + ts[3 * k + 2]) * s[2]};
            const Vector world = turned(r, in_node);
            out.corner[c] = {(world.x + t[0]) * size, (world.y + t[1]) * size, (world.z + t[2]) * size};
            for (std::size_t d = 0; d < 3; ++d)
              out.colour[d] = colour.empty() ? material.value("baseColorFactor", std::vector<double>{1, 1, 1, 1})[d]
                                             : colour[4 * v + d];
          }
          out.feature = static_cast<int>(placed ? fs[k] : feature[static_cast<std::size_t>(index[i])]);
          triangles.push_back(out);
        }
    }
  }

  std::string binary_;
  std::vector<std::string> views_;
};

std::array<double, 3> middle(const Scene::Triangle& t) {
  std::array<double, 3> m{};
  for (const Vector& v : t.corner) m = {m[0] + v.x / 3, m[1] + v.y / 3, m[2] + v.z / 3};
  return m;
}

double area(const Scene::Triangle& t) {
  const Vector u{t.corner[1].x - t.corner[0].x, t.corner[1].y - t.corner[0].y, t.corner[1].z - t.corner[0].z};
  const Vector v{t.corner[2].x - t.corner[0].x, t.corner[2].y - t.corner[0].y, t.corner[2].z - t.corner[0].z};
  const Vector c{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  return std::sqrt(c.x * c.x + c.y * c.y + c.z * c.z) / 2;
}

TEST(DetailGlb, ElementsAreStoredOnceAndLeadToTheirBuilding) {
  const SampleRegion s = facade_region();
  const Glb glb = write_glb(s.region(), options(Instancing::ext));
  std::size_t wanted = 0;
  std::map<int, std::size_t> by_feature;
  int feature = 0;
  for (const auto& b : s.region().buildings)
    for (const auto& part : b.parts) {
      wanted += part.lod3.placements.size();
      by_feature[feature++] = part.lod3.placements.size();
    }
  ASSERT_GT(wanted, 100u);
  EXPECT_EQ(glb.placements, wanted);
  EXPECT_EQ(glb.elements, 4u) << "window and door, a reveal and a lamp; what is rare is not worth a draw";
  const Scene scene(glb.bytes);
  EXPECT_GE(scene.places, wanted) << "each element in pieces";
  EXPECT_EQ(scene.triangles.size(), glb.triangles);
  std::set<int> positions;  // accessors: shapes share them
  for (const auto& node : scene.document["nodes"])
    if (node.contains("extensions"))
      for (const auto& p : scene.document["meshes"][node["mesh"].get<std::size_t>()]["primitives"])
        positions.insert(p["attributes"]["POSITION"].get<int>());
  EXPECT_LT(positions.size(), glb.elements);
  for (const char* extension : {"EXT_mesh_gpu_instancing", "KHR_mesh_quantization"}) {
    const auto& required = scene.document["extensionsRequired"];
    EXPECT_NE(std::find(required.begin(), required.end(), extension), required.end()) << extension;
  }
  const Scene nodes(write_glb(s.region(), options(Instancing::nodes)).bytes);
  EXPECT_EQ(nodes.places, wanted);
  std::map<int, std::size_t> extras;
  for (const auto& node : nodes.document["nodes"])
    if (node.contains("extras")) ++extras[node["extras"]["feature"].get<int>()];
  for (const auto& [row, n] : by_feature) EXPECT_EQ(extras[row], n) << row;
}

/// Each way of writing shows the same triangles in the same colours to within 2 mm, but for how reveals are cut in two.
TEST(DetailGlb, BakedNodesAndInstancesShowTheSame) {
  const SampleRegion s = facade_region();
  const Scene ext(write_glb(s.region(), options(Instancing::ext)).bytes),
      nodes(write_glb(s.region(), options(Instancing::nodes)).bytes),
      baked(write_glb(s.region(), options(Instancing::baked)).bytes);
  ASSERT_EQ(ext.triangles.size(), nodes.triangles.size());
  EXPECT_EQ(ext.triangles.size(), baked.triangles.size());
  EXPECT_EQ(baked.places, 0u);
  const auto sums = [](const Scene& scene) {
    std::map<int, std::array<double, 7>> out;  // by feature: area, area times middle, area times colour
    for (const auto& t : scene.triangles) {
      const double a = area(t);
      const auto m = middle(t);
      auto& sum = out[t.feature];
      sum[0] += a;
      for (std::size_t i = 0; i < 3; ++i) sum[1 + i] += a * m[i];
      for (std::size_t i = 0; i < 3; ++i) sum[4 + i] += a * t.colour[i];
    }
    return out;
  };
  const auto a = sums(ext), b = sums(baked), c = sums(nodes);
  ASSERT_EQ(a.size(), 4u);
  for (const auto& [feature, sum] : a) {
    EXPECT_NEAR(sum[0], c.at(feature)[0], 5e-5 * sum[0]) << "steps of a millimetre";
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(sum[1 + i] / sum[0], b.at(feature)[1 + i] / b.at(feature)[0], 0.002) << feature;
      EXPECT_NEAR(sum[1 + i] / sum[0], c.at(feature)[1 + i] / c.at(feature)[0], 0.002) << feature;
    }
    EXPECT_NEAR(sum[0], b.at(feature)[0], 0.002 * sum[0]);
  }
  // Every triangle of an element that is baked stands among the instanced ones.
  std::set<std::array<long, 3>> near;
  for (const auto& t : ext.triangles) {
    const auto m = middle(t);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz)
          near.insert({std::lround(m[0] * 250) + dx, std::lround(m[1] * 250) + dy, std::lround(m[2] * 250) + dz});
  }
  std::size_t away = 0;
  for (const auto& t : baked.triangles) {
    const auto m = middle(t);
    away += near.count({std::lround(m[0] * 250), std::lround(m[1] * 250), std::lround(m[2] * 250)}) == 0;
  }
  EXPECT_LT(away, baked.triangles.size() / 20) << "of reveals that are cut along the other diagonal";
}

/// A rare ornament becomes part of the mesh, in whole steps. What of it has no area then is left out, as it need not close.
TEST(DetailGlb, BakedPiecesHaveNoFlatTriangles) {
  const auto triangles = [](Instancing how, bool sliver) {
    SampleRegion s = facade_region();
    for (model::ColouredElement& coloured : s.region().elements) {
      if (coloured.element->name != "lamp") continue;
      auto lamp = std::make_shared<model::Element>(*coloured.element);
      if (sliver) {
        lamp->mesh.faces.push_back({.first = static_cast<std::uint32_t>(lamp->mesh.indices.size()),
                                    .count = 3,
                                    .part = model::ElementPart::frame});
        for (const model::Point3& p : {model::Point3{0, 0.5, 0}, {0.2, 0.5, 0}, {0.20001, 0.50001, 0}}) {
          lamp->mesh.indices.push_back(static_cast<std::uint32_t>(lamp->mesh.vertices.size()));
          lamp->mesh.vertices.push_back(p);
        }
      }
      coloured.element = lamp;
    }
    const Scene scene(write_glb(s.region(), options(how)).bytes);
    for (const Scene::Triangle& t : scene.triangles) EXPECT_GT(area(t), 0);
    return scene.triangles.size();
  };
  for (const Instancing how : {Instancing::ext, Instancing::baked})
    EXPECT_GE(triangles(how, true), triangles(how, false)) << "nothing else is lost";
}

/// What fits sixteen bits is written so, and nothing leaves its bounds.
TEST(DetailGlb, BoundsHoldEveryTriangle) {
  const SampleRegion s = facade_region();
  for (const Instancing how : {Instancing::ext, Instancing::nodes, Instancing::baked}) {
    const Glb glb = write_glb(s.region(), options(how));
    const Scene scene(glb.bytes);
    for (const json& p : scene.document["accessors"]) EXPECT_NE(p["componentType"], 5125) << "no index needs 32 bits";
    double out = 0;
    for (const auto& t : scene.triangles)
      for (const Vector& v : t.corner)
        out = std::max({out, glb.min.x - v.x, v.x - glb.max.x, glb.min.y + v.z, -v.z - glb.max.y, glb.min.z - v.y,
                        v.y - glb.max.z});
    EXPECT_LT(out, 0.001);
  }
}

picture::Image picture_of(const Scene& scene, picture::Direction from) {
  picture::Scene drawn;
  const auto srgb = [](double v) {
    return static_cast<std::uint8_t>(
        std::lround(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055)));
  };
  for (const Scene::Triangle& t : scene.triangles) {
    std::array<model::Point3, 3> c{};
    for (std::size_t i = 0; i < 3; ++i) c[i] = {t.corner[i].x, -t.corner[i].z, t.corner[i].y};
    drawn.add_triangle(c, {srgb(t.colour[0]), srgb(t.colour[1]), srgb(t.colour[2])},
                       static_cast<std::uint32_t>(t.feature));
  }
  picture::RenderOptions options;
  options.width = 900;
  options.height = 600;
  options.shadows = options.sky_occlusion = false;
  const std::vector<model::Point3> points = drawn.points();
  return picture::render(drawn, picture::fit_perspective(points, from, 1.5), options);
}

/// However elements are written, they are seen as the same: pixels differ only along edges.
TEST(DetailGlb, EveryWayOfWritingGivesTheSamePicture) {
  SampleRegion s = facade_region();
  // Reveals have the wall's looks, as grammars give them: baked ones are the wall's own faces.
  const model::Solid& house = s.region().buildings[0].parts[0].lod3.solid;
  const auto wall = std::find_if(house.faces.begin(), house.faces.end(),
                                 [](const model::Face& f) { return f.kind == model::SurfaceKind::wall; });
  for (model::ColouredElement& e : s.region().elements)
    e.materials[static_cast<std::size_t>(model::ElementPart::wall)] = {wall->material, wall->colour};
  GlbOptions packed = options(Instancing::ext);
  packed.compression = Compression::meshopt;
  for (const picture::Direction from : {picture::Direction{215, 25}, picture::Direction{40, 8}}) {
    const picture::Image baked = picture_of(Scene(write_glb(s.region(), options(Instancing::baked)).bytes), from);
    GlbOptions bare = options(Instancing::ext);
    bare.lod = 2;
    const auto unlike = [&](const GlbOptions& o) {
      const picture::Image other = picture_of(Scene(write_glb(s.region(), o).bytes), from);
      EXPECT_EQ(other.rgb.size(), baked.rgb.size());
      if (const char* folder = std::getenv("BLOCKRAND_PICTURES")) {
        const std::string name = std::string(folder) + "/ways_" + std::to_string(static_cast<int>(from.azimuth));
        std::ofstream(name + "_baked.png", std::ios::binary) << picture::png(baked);
        if (o.lod == 3) std::ofstream(name + "_other.png", std::ios::binary) << picture::png(other);
      }
      std::size_t off = 0;
      for (std::size_t i = 0; i < baked.rgb.size(); i += 3) {
        int worst = 0;
        for (std::size_t k = i; k < i + 3; ++k) worst = std::max(worst, std::abs(baked.rgb[k] - other.rgb[k]));
        off += worst > 24;
      }
      return static_cast<double>(off) / (900 * 600);
    };
    EXPECT_LT(unlike(options(Instancing::ext)), 0.002);
    EXPECT_LT(unlike(options(Instancing::nodes)), 0.002);
    EXPECT_LT(unlike(packed), 0.002);
    EXPECT_GT(unlike(bare), 0.02) << "the pictures would not show missing elements";
  }
}

/// Corners, features and colours are the same to the last bit; triangles may begin at another corner.
TEST(DetailGlb, CompressedFilesShowTheSame) {
  const SampleRegion s = facade_region();
  for (const Instancing how : {Instancing::ext, Instancing::baked}) {
    GlbOptions o = options(how);
    const std::string plain = write_glb(s.region(), o).bytes;
    o.compression = Compression::meshopt;
    const std::string packed = write_glb(s.region(), o).bytes;
    EXPECT_EQ(packed, write_glb(s.region(), o).bytes);
    EXPECT_LT(packed.size(), plain.size() * 3 / 4);
    const Scene a(plain), b(packed);
    EXPECT_EQ(b.document["buffers"].size(), 2u);
    EXPECT_FALSE(b.document["buffers"][1].contains("uri"));
    const auto& required = b.document["extensionsRequired"];
    EXPECT_NE(std::find(required.begin(), required.end(), "EXT_meshopt_compression"), required.end());
    ASSERT_EQ(a.triangles.size(), b.triangles.size());
    EXPECT_EQ(a.places, b.places);
    const auto turned = [](const Scene::Triangle& t) {
      std::array<std::array<double, 3>, 3> c{};
      for (std::size_t i = 0; i < 3; ++i) c[i] = {t.corner[i].x, t.corner[i].y, t.corner[i].z};
      std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
      return c;
    };
    for (std::size_t i = 0; i < a.triangles.size(); ++i) {
      ASSERT_EQ(turned(a.triangles[i]), turned(b.triangles[i])) << i;
      ASSERT_EQ(a.triangles[i].feature, b.triangles[i].feature) << i;
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(a.triangles[i].colour[k], b.triangles[i].colour[k]) << i;
    }
  }
}

/// A profile along a wall is stored once for all lengths.
TEST(DetailGlb, ProfilesOfDifferentLengthsShareTheirGeometry) {
  SampleRegion s = facade_region();
  model::Region& region = s.region();
  const auto profile = [&](double length, double slant) {
    model::Element e;
    e.name = "band " + std::to_string(length);
    e.kind = "band";
    const double x = length / 2;
    e.mesh.vertices = {{-x, 0, 0.1}, {x, 0, 0.1}, {x - slant, 0.2, 0}, {-x, 0.2, 0}};
    e.mesh.indices = {0, 1, 2, 3};
    e.mesh.faces = {{0, 4, model::ElementPart::surround}};
    model::ColouredElement coloured;
    coloured.element = std::make_shared<const model::Element>(std::move(e));
    region.elements.push_back(coloured);
    return static_cast<std::uint32_t>(region.elements.size() - 1);
  };
  const Glb before = write_glb(region, options(Instancing::nodes));
  model::BuildingPart* part = nullptr;
  for (auto& b : region.buildings)
    for (auto& p : b.parts)
      if (p.lod >= 3 && !part) part = &p;
  ASSERT_NE(part, nullptr);
  const model::Placement like = part->lod3.placements.front();
  for (const double length : {1.5, 2.25, 31.0}) {
    model::Placement p = like;
    p.element = profile(length, 0);
    p.opening = model::kNoOpening;
    part->lod3.placements.push_back(p);
  }
  const Glb after = write_glb(region, options(Instancing::nodes));
  EXPECT_EQ(after.elements, before.elements + 1);
  EXPECT_EQ(after.placements, before.placements + 3);
  const auto lengths = [](const Glb& glb) {
    const Scene scene(glb.bytes);
    std::multiset<long> out;  // mm
    for (std::size_t i = scene.triangles.size() - 6; i < scene.triangles.size(); i += 2) {
      const Vector &a = scene.triangles[i].corner[0], &b = scene.triangles[i].corner[1];
      out.insert(std::lround(std::sqrt((a.x - b.x) * (a.x - b.x) + (a.z - b.z) * (a.z - b.z)) * 1000));
    }
    return out;
  };
  EXPECT_EQ(lengths(after), (std::multiset<long>{1500, 2250, 31000}));
  model::Placement slanted = like;
  slanted.element = profile(1.5, 0.3);
  part->lod3.placements.push_back(slanted);
  EXPECT_EQ(write_glb(region, options(Instancing::nodes)).elements, before.elements + 2) << "its ends are not plane";
}

/// Whatever number of shapes there may be: all triangles are there, and none is farther from its place than promised.
TEST(DetailGlb, PiecesShowEveryElementWhereItStands) {
  SampleRegion s = facade_region();
  model::Region& region = s.region();
  // A row of windows of many widths, which scale into each other within the tolerance or not at all.
  const model::ColouredElement like = region.elements.front();
  model::BuildingPart* part = nullptr;
  for (auto& b : region.buildings)
    for (auto& p : b.parts)
      if (p.lod >= 3 && !part) part = &p;
  ASSERT_NE(part, nullptr);
  for (int i = 1; i <= 40; ++i) {
    auto wide = std::make_shared<model::Element>(*like.element);
    for (model::Point3& p : wide->mesh.vertices) p.x += p.x > 0 ? 0.01 * i : p.x < 0 ? -0.01 * i : 0;
    for (model::Point2& p : wide->opening.outline) p.x += p.x > 0 ? 0.01 * i : -0.01 * i;
    model::ColouredElement coloured = like;
    coloured.element = wide;
    region.elements.push_back(coloured);
    model::Placement place = part->lod3.placements.front();
    place.element = static_cast<std::uint32_t>(region.elements.size() - 1);
    place.origin.z += 3.5 * i;
    place.opening = model::kNoOpening;
    for (int k = 0; k < i; ++k) part->lod3.placements.push_back(place);
  }
  const std::vector<InstanceGroup> groups = element_instances(region, {});
  std::size_t wanted = 0;
  std::vector<std::array<double, 4>> corners;  // of all elements: place and row
  for (const InstanceGroup& group : groups) {
    const ElementGeometry geometry = element_geometry(*region.elements[group.element].element, true);
    for (const auto& p : geometry.parts) {
      wanted += p.indices.size() / 3 * group.instances.size();
      for (const ElementInstance& at : group.instances)
        for (const ElementVertex& v : p.vertices) {
          const model::Point3 d = PieceTurn(at.along)(v.position);
          corners.push_back({at.origin.x + d.x, at.origin.y + d.y, at.origin.z + d.z, static_cast<double>(at.feature)});
        }
    }
  }
  std::sort(corners.begin(), corners.end());
  const auto stands = [&](const model::Point3& p, std::uint32_t feature) {
    constexpr double kWithin = kPieceTolerance + 1e-6;  // m: vertices of pieces have single precision
    auto at = std::lower_bound(corners.begin(), corners.end(), std::array<double, 4>{p.x - kWithin});
    for (; at != corners.end() && (*at)[0] <= p.x + kWithin; ++at)
      if (std::fabs((*at)[1] - p.y) <= kWithin && std::fabs((*at)[2] - p.z) <= kWithin && (*at)[3] == feature)
        return true;
    return false;
  };
  for (const std::size_t most : {0u, 1u, 4u, 20u, 60u}) {
    const PiecePlan plan = plan_pieces(region, groups, most);
    EXPECT_LE(plan.placed.size(), most);
    std::size_t shown = 0, away = 0;
    for (const PlacedPiece& piece : plan.placed) {
      EXPECT_FALSE(piece.places.empty());
      shown += piece.shape.triangles() * piece.places.size();
      for (const PlacedPiece::Place& place : piece.places)
        for (const Piece::Vertex& v : piece.shape.vertices) {
          const model::Point3 d = PieceTurn(place.at->along)({place.middle.x + v.position.x * place.scale.x,
                                                              place.middle.y + v.position.y * place.scale.y,
                                                              place.middle.z + v.position.z * place.scale.z});
          const model::Point3& o = place.at->origin;
          away += !stands({o.x + d.x, o.y + d.y, o.z + d.z}, place.at->feature);
        }
    }
    for (const BakedPiece& baked : plan.baked) shown += baked.piece.triangles() * baked.places->size();
    EXPECT_EQ(shown, wanted) << most;
    EXPECT_EQ(away, 0u) << most;
  }
}

TEST(DetailGlb, WithoutLod3NothingChanges) {
  const SampleRegion s = facade_region();
  GlbOptions o = options(Instancing::ext);
  o.lod = 2;
  const Glb two = write_glb(s.region(), o);
  EXPECT_EQ(two.placements, 0u);
  EXPECT_EQ(two.bytes.find("EXT_mesh_gpu_instancing"), std::string::npos);
  EXPECT_EQ(write_glb(s.region(), options(Instancing::ext)).bytes,
            write_glb(facade_region().region(), options(Instancing::ext)).bytes);
}

TEST(DetailCityGml, SolidsOfBothLevelsAreClosed) {
  const SampleRegion s = facade_region();
  const std::string text = write_citygml(s.region(), gml_options(false));
  const validators::GmlFile file = validators::read_citygml_text(text);
  std::map<int, int> levels;
  for (const auto& solid : file.solids) {
    ++levels[solid.lod];
    EXPECT_EQ(validity(solid), "") << solid.id;
  }
  EXPECT_EQ(levels, (std::map<int, int>{{1, 4}, {2, 4}, {3, 3}}));
  for (const auto& b : s.region().buildings)
    for (const auto& part : b.parts) {
      if (part.lod < 3) continue;
      for (const auto& solid : file.solids)
        if (solid.building == part.id && solid.lod == 3) {
          EXPECT_EQ(solid.polygons.size(), part.lod3.solid.faces.size());
        }
    }
  const auto count = [&](const std::string& what) { return test::times(text, what); };
  std::size_t openings = 0, placements = 0;
  for (const auto& b : s.region().buildings)
    for (const auto& part : b.parts) openings += part.lod3.openings.size(), placements += part.lod3.placements.size();
  EXPECT_EQ(count("<bldg:opening>"), openings);
  EXPECT_EQ(count("<bldg:Door "), 3u);
  EXPECT_EQ(count("<bldg:Window "), openings - 3);
  EXPECT_EQ(count("<bldg:BuildingInstallation "), 3u);
  EXPECT_EQ(count("<core:ImplicitGeometry>"), placements);
  EXPECT_EQ(count("<core:relativeGMLGeometry>"), 4u) << "once each: lamp and window look alike";
}

TEST(DetailCityGml, ValidatesAgainstTheSchema) {
  if (!std::filesystem::exists(test::citygml_schemas() / "citygml2.xsd"))
    GTEST_SKIP() << "no CityGML schemas in " << test::citygml_schemas();
  EXPECT_EQ(
      test::schema_complaints(write_citygml(facade_region().region(), gml_options(false)), "blockrand_detail_schema"),
      "");
}

}  // namespace
}  // namespace blockrand::outputs
