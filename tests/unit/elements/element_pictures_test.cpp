// The figures of docs/elements.md, drawn by the program itself.
//   ELEMENTS_PICTURES=docs/pictures/elements build/release/tests/test_elements --gtest_filter='ElementPictures.*'
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "pipeline/geometry/triangulate.h"
#include "pipeline/picture/camera.h"
#include "pipeline/picture/render.h"
#include "styles/elements/element_catalogue.h"
#include "styles/elements/mesh_builder.h"
#include "styles/elements/sweep.h"
#include "tests/unit/elements/mesh_measures.h"
#include "tests/unit/elements/shipped_elements.h"

namespace blockrand::elements {
namespace {

using model::Colour;
using model::Point2;
using model::Point3;

Colour colour_of(Part part) {
  switch (part) {
    case Part::frame:
      return {246, 244, 238};
    case Part::glass:
      return {88, 108, 122};
    case Part::leaf:
      return {128, 90, 62};
    case Part::surround:
      return {236, 226, 204};
    case Part::sill:
      return {190, 184, 172};
    case Part::wall:
      return {205, 186, 150};
    case Part::metal:
      return {60, 62, 66};
    case Part::panel:
      return {62, 84, 70};
  }
  return {};
}

constexpr Colour kWall{216, 198, 162}, kPaving{168, 164, 158};

/// Elements on a piece of wall, seen by someone on the street: the element's z looks south.
class Wall {
 public:
  Point3 turned(Point3 p) const { return {p.x, -p.z, p.y}; }

  void add(const ElementMesh& mesh, Point2 at) {
    ++object_;
    for (const ElementFace& f : mesh.faces) {
      std::vector<Point3> c;
      for (std::uint32_t i = 0; i < f.count; ++i) {
        Point3 p = mesh.vertices[mesh.indices[f.first + i]];
        c.push_back(turned({p.x + at.x, p.y + at.y, p.z}));
      }
      // From behind nothing is there: what faces the wrong way shows as a hole.
      for (std::size_t i = 1; i + 1 < c.size(); ++i)
        scene_.add_triangle({c[0], c[i], c[i + 1]}, colour_of(f.part), object_);
    }
  }

  void add(const Element& element, Point2 at) {
    add(element.mesh, at);
    if (element.opening.outline.empty()) return;
    Outline hole;
    for (const Point2 p : element.opening.outline) hole.push_back({p.x + at.x, p.y + at.y});
    MeshBuilder reveal;
    reveal.recess(hole, 0, -element.opening.reveal, Part::wall);
    if (element.semantic != ElementClass::installation) add(reveal.take(), {});
    holes_.push_back(std::move(hole));
  }

  /// The wall itself, from (left, foot) to (right, top), and the pavement before it.
  void close(double left, double foot, double right, double top, bool pavement) {
    std::vector<Point2> points;
    std::vector<std::vector<std::uint32_t>> loops;
    const auto loop = [&](const Outline& outline, bool reversed) {
      std::vector<std::uint32_t> out;
      for (const Point2 p : outline) {
        out.push_back(static_cast<std::uint32_t>(points.size()));
        points.push_back(p);
      }
      if (reversed) std::reverse(out.begin(), out.end());
      loops.push_back(out);
    };
    loop({{left, foot - 0.02}, {right, foot - 0.02}, {right, top}, {left, top}}, false);
    for (const Outline& hole : holes_) loop(hole, true);
    const auto faces = convex_faces(points, loops);
    ASSERT_TRUE(faces.has_value());
    ++object_;
    const auto at = [&](std::uint32_t i) { return turned({points[i].x, points[i].y, 0}); };
    for (const auto& f : *faces)
      for (std::size_t i = 1; i + 1 < f.size(); ++i)
        scene_.add_triangle({at(f[0]), at(f[i]), at(f[i + 1])}, kWall, object_);
    if (pavement) scene_.set_ground(foot, kPaving);
    view_ = {turned({left, foot, 0}), turned({right, top, 0}), turned({left, top, 0}), turned({right, foot, 0})};
  }

  void write(const std::string& path, picture::Direction from, int width, int height) const {
    picture::RenderOptions options;
    options.width = width;
    options.height = height;
    options.supersampling = 3;
    options.sun_azimuth = 222;
    options.sun_elevation = 44;
    options.crease_angle = 24;
    options.line_strength = 0.4;
    const auto camera = picture::fit_perspective(view_, from, static_cast<double>(width) / height, 14, 0.02);
    const std::string bytes = picture::palette_png(picture::render(scene_, camera, options), 96);
    std::ofstream(path, std::ios::binary) << bytes;
  }

  picture::Scene& scene() { return scene_; }
  std::vector<Point3>& view() { return view_; }

 private:
  picture::Scene scene_;
  std::vector<Outline> holes_;
  std::vector<Point3> view_;
  std::uint32_t object_ = 0;
};

struct Shown {
  double width, height;
  std::vector<Parameter> parameters;
};

/// What the figure of a kind shows beside its default: left to right.
std::vector<Shown> shown_of(const ElementKind& kind) {
  const double w = kind.width.usual, h = kind.height.usual;
  const char* const detail = std::getenv("ELEMENTS_DETAIL");
  const auto full = Parameter{"detail", detail ? std::atof(detail) : 2.0};
  const std::string n = kind.name;
  if (n == "casement_window")
    return {{w, h, {full}},
            {w, h, {full, {"leaves", 1.0}, {"surround", "plain"}, {"head", "round"}, {"sill", "moulded"}}},
            {1.6,
             h,
             {full,
              {"leaves", 3.0},
              {"transom", 0.7},
              {"bars", 1.0},
              {"head", "segmental"},
              {"surround", "brick"},
              {"keystone", "yes"}}}};
  if (n == "double_casement")
    return {{w, h, {full, {"pediment", "triangular"}, {"pediment_consoles", "yes"}}},
            {w, h, {full, {"head", "segmental"}, {"keystone", "yes"}}},
            {w, h, {full, {"pediment", "segmental"}, {"upper_upright_bars", 1.0}}},
            {w, h, {full, {"surround", "double_cornice"}}}};
  if (n == "shop_window")
    return {{w, h, {full}}, {4.2, h, {full, {"door", "middle"}, {"mullions", 1.0}, {"surround", "plain"}}}};
  if (n == "cellar_window")
    return {{w, h, {full}},
            {w, h, {full, {"head", "segmental"}, {"surround", "plain"}, {"grille", 0.0}}},
            {w, h, {full, {"sill", "plain"}, {"leaves", 2.0}}}};
  if (n == "shaped_window")
    return {{w, h, {full, {"top", "ogee"}, {"top_size", 0.35}, {"upright_bars", 1.0}, {"surround", "moulded"}}},
            {w, w, {full, {"outline", "circular"}, {"bars", 1.0}, {"upright_bars", 1.0}, {"surround", "plain"}}},
            {w, h, {full, {"top", "basket"}, {"top_size", 0.15}, {"bottom", "basket"}, {"bottom_size", 0.1}}},
            {w,
             h,
             {full,
              {"top_left", 0.25},
              {"top_right", 0.25},
              {"left_above", 0.2},
              {"right_above", 0.2},
              {"sill", "plain"},
              {"bars", 2.0}}}};
  if (n == "house_door")
    return {{1.1, 2.5, {full, {"leaves", 1.0}, {"surround", "none"}, {"glazing", "upper"}, {"top_light", 0.0}}},
            {w, h, {full, {"pediment", "straight"}, {"pediment_consoles", "yes"}}},
            {w,
             h,
             {full,
              {"head", "round"},
              {"top_light", 0.9},
              {"surround", "moulded"},
              {"keystone", "yes"},
              {"upright_bars", 3.0}}}};
  if (n == "carriage_gateway")
    return {{w, h, {full, {"keystone", "yes"}, {"guards", "yes"}}},
            {w, h, {full, {"leaves", "open"}, {"head", "round"}, {"surround", "moulded"}, {"surround_width", 0.35}}},
            {w, h, {full, {"leaves", "absent"}, {"head", "straight"}, {"surround", "brick"}}}};
  if (n == "reveal")
    return {{w, h, {full}},
            {w, h, {full, {"head", "round"}, {"surround", "moulded"}, {"sill", "plain"}}},
            {w, h, {full, {"head", "gabled"}, {"rise", 0.45}, {"surround", "plain"}}}};
  if (n == "sill") return {{w, h, {full}}, {w, h, {full, {"sill", "plain"}, {"sill_projection", 0.12}}}};
  if (n == "surround")
    return {{w, h, {full, {"surround", "plain"}}},
            {w, h, {full, {"surround", "moulded"}, {"head", "segmental"}}},
            {w, h, {full, {"surround", "double_cornice"}}},
            {w, h, {full, {"surround", "brick"}, {"keystone", "yes"}, {"head", "round"}}}};
  if (n == "pediment")
    return {{w, h, {full, {"pediment", "straight"}, {"pediment_consoles", "yes"}}},
            {w, h, {full}},
            {w, h, {full, {"pediment", "segmental"}}}};
  if (n == "string_course")
    return {{0.7, h, {full, {"ends", "returned"}}},
            {0.7, h, {full, {"profile", "cyma"}, {"ends", "returned"}}},
            {0.7, h, {full, {"profile", "drip"}, {"ends", "returned"}}},
            {0.7, h, {full, {"profile", "corona"}, {"ends", "returned"}, {"projection", 0.2}}}};
  if (n == "main_cornice")
    return {{3, h, {full, {"ends", "returned"}}},
            {3, 0.75, {full, {"profile", "main_cornice"}, {"bracket_spacing", 0.0}, {"ends", "returned"}}}};
  if (n == "plinth")
    return {{2, h, {full, {"ends", "returned"}}},
            {2, h, {full, {"profile", "plinth_moulded"}, {"projection", 0.12}, {"ends", "returned"}}}};
  if (n == "console") return {{w, h, {full}}, {0.3, 0.6, {full, {"projection", 0.5}}}};
  if (n == "balcony")
    return {{w, h, {full}},
            {3.0, h, {full, {"railing", "stone"}, {"consoles", 3.0}, {"depth", 1.2}}},
            {w, h, {full, {"railing", "glass"}, {"consoles", 0.0}}}};
  if (n == "bay")
    return {{w, h, {full}},
            {3.2,
             h,
             {full, {"plan", "polygonal"}, {"base", "consoles"}, {"roof", "flat"}, {"depth", 1.2}, {"storeys", 2.0}}}};
  if (n == "quoin") return {{w, h, {full}}, {w, h, {full, {"corner", "middle"}}}, {w, h, {full, {"corner", "right"}}}};
  if (n == "pilaster") return {{w, h, {full}}, {w, h, {full, {"order", "lesene"}}}};
  return {{w, h, {full}}};
}

/// With ELEMENTS_PICTURES=<folder>: a PNG per kind, and cornice_chain.png for sweeps. ELEMENTS_KIND limits it to one,
/// ELEMENTS_DETAIL shows another level of detail than 2.
TEST(ElementPictures, WritesFigures) {
  const char* const folder = std::getenv("ELEMENTS_PICTURES");
  if (!folder) GTEST_SKIP() << "ELEMENTS_PICTURES names no folder";
  for (const ElementKind& kind : shipped().kinds()) {
    const char* const only = std::getenv("ELEMENTS_KIND");
    if (only && kind.name != only) continue;
    Wall wall;
    const bool standing = kind.semantic == ElementClass::door || kind.name == "shop_window";
    double x = 0, top = 0, bottom = 0;
    for (const Shown& s : shown_of(kind)) {
      const auto element = shipped().make(kind.name, s.width, s.height, s.parameters);
      ASSERT_TRUE(element.has_value()) << element.error();
      const Bounds3 box = bounds_of(element->mesh);
      const double gap = kind.name == "console" ? 0.25 : 0.35;
      x += gap - box.least.x;
      wall.add(*element, {x, 0});
      x += box.most.x;
      top = std::max(top, box.most.y);
      bottom = std::min(bottom, box.least.y);
    }
    const bool small =
        kind.name == "console" || kind.name == "string_course" || kind.name == "sill" || kind.name == "pediment";
    const double pad = kind.name == "console" || kind.name == "sill" ? 0.15 : 0.3;
    wall.close(0, standing ? 0 : bottom - pad, x + 0.35, top + pad, standing);
    const double aspect = (x + 0.35) / (top + pad - (standing ? 0 : bottom - pad));
    const int width = aspect > 1.2 ? 900 : 640;
    wall.write(fmt::format("{}/{}.png", folder, kind.name), {small ? 220.0 : 204.0, standing ? 4.0 : -10.0}, width,
               std::clamp(static_cast<int>(width / aspect * 1.05), 260, 700));
  }
  // A chain with an avant-corps, an obtuse and an acute corner, interrupted.
  Wall wall;
  const std::vector<Point2> chain{{0, 0}, {3, 0}, {3, -0.5}, {5, -0.5}, {5, 0}, {8, 0}, {9.5, 1.5}, {9.5, 5}};
  const auto preset = shipped().profiles().at("main_cornice_brackets");
  SweepOptions options;
  options.base = 2.2;
  const std::vector<std::pair<double, double>> gaps{{8.0, 8.6}};
  options.interruptions = gaps;
  options.ends = RunEnd::returned;
  options.consoles = {0.5, 0.16, 0.3, 0.25, 0.42};
  const auto cornice = sweep(scaled_to_height(trace(preset.program, 5), 0.75, 0.6), chain, false, options);
  ASSERT_TRUE(cornice.has_value());
  wall.add(cornice->mesh, {});
  SweepOptions low;
  low.part = Part::wall;
  const auto foot = sweep(scaled_to_height(trace(shipped().profiles().at("plinth_moulded").program, 5), 0.7, 0.12),
                          chain, false, low);
  ASSERT_TRUE(foot.has_value());
  wall.add(foot->mesh, {});
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const Point2 a = chain[i], b = chain[i + 1];
    wall.scene().add_triangle({Point3{a.x, a.y, 0}, {b.x, b.y, 0}, {b.x, b.y, 2.93}}, kWall, 100);
    wall.scene().add_triangle({Point3{a.x, a.y, 0}, {b.x, b.y, 2.93}, {a.x, a.y, 2.93}}, kWall, 100);
  }
  wall.scene().set_ground(0, kPaving);
  wall.view() = {{0, 0, 0}, {0, 0, 3.1}, {9.5, 4, 0}, {9.5, 4, 3.1}, {4, -1.2, 0}, {4, -1, 3}};
  wall.write(std::string(folder) + "/cornice_chain.png", {165, -3}, 900, 420);
}

}  // namespace
}  // namespace blockrand::elements
