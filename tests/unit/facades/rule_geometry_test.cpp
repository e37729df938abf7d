// What rule files make beside orders of elements: counts and volumes worked out by hand (tests/golden/rule_files).
#include "pipeline/facades/rule_geometry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "pipeline/base/toml_file.h"
#include "pipeline/facades/wall_paint.h"
#include "styles/grammar/evaluation/derive.h"

namespace blockrand::facades {
namespace {

using model::Point2;
using model::Point3;

const std::filesystem::path kFiles = std::filesystem::path(BLOCKRAND_SOURCE_DIR) / "tests/golden/rule_files/outset";

WallFrame wall_of(double width, double height) {
  WallFrame wall;
  wall.along = {1, 0};
  wall.length = width;
  wall.height = height;
  wall.loops = {{{0, 0}, {width, 0}, {width, height}, {0, height}}};
  return wall;
}

grammar::Shape shape_of(const WallFrame& wall) {
  grammar::SmallFace face;
  face.size = 4;
  face.points = {{{0, 0, 0}, {wall.length, 0, 0}, {wall.length, wall.height, 0}, {0, wall.height, 0}}};
  grammar::Shape shape;
  shape.size = {wall.length, wall.height, 0};
  shape.mesh = face;
  return shape;
}

grammar::Program program_of(const std::string& text) {
  grammar::LoadOptions options;
  options.read = [&](const std::string& path) -> std::optional<std::string> {
    if (path == "text.cga") return text;
    std::ifstream in(path);
    if (!in) return std::nullopt;
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  };
  return grammar::load(text.ends_with(".cga") ? text : "text.cga", options);
}

const model::PartMaterial kUsual{0, {220, 210, 180}};

attributes::Defaults materials() {
  attributes::Defaults out;
  for (const char* name : {"glass", "metal", "plaster"}) {
    out.material_by_value[name] = static_cast<std::uint8_t>(out.materials.size());
    out.materials.push_back({{name, 0.5f, 0}, {}});
  }
  return out;
}

RuleGeometry made_on(const WallFrame& wall, const std::string& text, std::span<const KeptFree> portals = {}) {
  const grammar::Program program = program_of(text);
  EXPECT_TRUE(program.diagnostics.empty());
  const grammar::Derivation derivation = grammar::derive(program, shape_of(wall));
  return rule_geometry(derivation.leaves, wall, portals, kUsual, nullptr, materials());
}

double volume(const model::ElementMesh& mesh) {
  double six = 0;
  for (const model::ElementFace& face : mesh.faces)
    for (std::uint32_t i = 1; i + 1 < face.count; ++i) {
      const Point3 &a = mesh.vertices[mesh.indices[face.first]], &b = mesh.vertices[mesh.indices[face.first + i]],
                   &c = mesh.vertices[mesh.indices[face.first + i + 1]];
      six += a.x * (b.y * c.z - b.z * c.y) - a.y * (b.x * c.z - b.z * c.x) + a.z * (b.x * c.y - b.y * c.x);
    }
  return six / 6;
}

TEST(RuleGeometry, MakesTheLeavesWorkedOutByHand) {
  base::TomlTable expected = base::TomlTable::read((kFiles / "expected.toml").string());
  for (const char* file : {"cornice_and_pilasters.cga", "balconies.cga", "brick_bays.cga", "assets.cga"}) {
    SCOPED_TRACE(file);
    const WallFrame wall = wall_of(12, 9);
    const RuleGeometry made = made_on(wall, (kFiles / file).string());
    EXPECT_TRUE(made.dropped.empty()) << made.dropped.begin()->first;
    EXPECT_EQ(made.yielding, 0u);
    auto of_file = expected.table(file);
    ASSERT_TRUE(of_file);
    auto leaves = of_file->table("leaves"), volumes = of_file->table("volume");
    double wanted = 0;
    for (const std::string& name : leaves->keys()) wanted += *leaves->number(name, 0, 1e6);
    std::size_t found = made.bare;
    std::map<std::string, double> volume_of;
    for (const RuleBody& body : made.bodies) {
      found += body.leaves;
      if (body.element.opening.outline.empty()) volume_of[body.element.name + "."] += volume(body.element.mesh);
    }
    EXPECT_EQ(static_cast<double>(found), wanted);
    if (std::string(file) == "brick_bays.cga")
      continue;  // its closed pieces stand in openings, with what is behind them
    std::size_t compared = 0;
    for (const std::string& name : volumes->keys()) {
      if (!volume_of.contains(name)) continue;
      const double by_hand = *volumes->number(name, 0, 1e6);
      EXPECT_NEAR(volume_of[name], by_hand, 0.03 * by_hand) << name;  // corners lie on the grid of a millimetre
      ++compared;
    }
    EXPECT_GE(compared, 3u);
  }
}

TEST(RuleGeometry, TheWallItselfHasTheLookOfMostOfItsPieces) {
  const RuleGeometry made = made_on(wall_of(10, 4), R"(version "2021.0"
@StartRule
Facade --> split(x){ ~1 : color("#aa0000") Brick. | 2 : color("#00aa00") Sign. | 1 : Bare. })");
  EXPECT_EQ(made.ground.colour, (model::Colour{0xaa, 0, 0}));
  EXPECT_EQ(made.bare, 1u);
  ASSERT_EQ(made.bodies.size(), 2u);
  EXPECT_EQ(made.bodies[0].element.name, "Sign");
  // Painted faces stand before the wall, so that nothing flickers; a piece without colour is the building's.
  for (const Point3& v : made.bodies[0].element.mesh.vertices) EXPECT_NEAR(v.z, 0.006, 0.001);
  const auto looks = [](const RuleBody& b) {
    return b.materials[static_cast<std::size_t>(b.element.mesh.faces[0].part)];
  };
  EXPECT_EQ(looks(made.bodies[0]).colour, (model::Colour{0, 0xaa, 0}));
  EXPECT_EQ(looks(made.bodies[1]).colour, kUsual.colour);
}

TEST(RuleGeometry, WhatLiesInTheWallSharesAnOpening) {
  const std::string rules = R"(version "2021.0"
@StartRule
Facade --> split(x){ ~1 : Wall. | 1.2 : split(y){ 1 : Wall. | 1.5 : Window | ~1 : Wall. } | ~1 : Wall. }
Window --> [ t(0, 0, -0.2) color("#334455") Glass. ] [ extrude(-0.2) comp(f){ side : color("#ffffff") Reveal. } ])";
  const RuleGeometry made = made_on(wall_of(6, 4), rules);
  ASSERT_EQ(made.bodies.size(), 1u);
  const RuleBody& body = made.bodies[0];
  EXPECT_EQ(body.leaves, 5u);
  EXPECT_EQ(body.element.semantic, model::ElementClass::window);
  EXPECT_NEAR(body.element.opening.reveal, 0.2, 0.001);
  ASSERT_EQ(body.element.opening.outline.size(), 4u);
  EXPECT_NEAR(body.element.opening.outline[2].x - body.element.opening.outline[0].x, 1.2, 0.002);
  EXPECT_NEAR(body.element.opening.outline[2].y, 1.5, 0.002);
  // Where the wall takes no opening it stands before the wall, all of it.
  const model::Element before = before_wall(body.element);
  EXPECT_TRUE(before.opening.outline.empty());
  for (const Point3& v : before.mesh.vertices) EXPECT_GT(v.z, 0.004);
  // In a passage it yields.
  const KeptFree portal{2, 4, 3};
  const RuleGeometry beside = made_on(wall_of(6, 4), rules, std::span(&portal, 1));
  EXPECT_TRUE(beside.bodies.empty());
  EXPECT_EQ(beside.yielding, 5u);
}

TEST(RuleGeometry, SunkPanelsDoNotWallUpAWindowAmongThem) {
  const RuleGeometry made = made_on(wall_of(6, 4), R"(version "2021.0"
@StartRule
Facade --> split(x){ ~1 : Panel | 1.2 : split(y){ 0.9 : Panel | 1.5 : blockrand.window("casement_window") | ~1 : Panel } | ~1 : Panel }
Panel --> t(0, 0, -0.03) color("#808080") Panel.)");
  EXPECT_EQ(made.bodies.size(), 4u);
  for (const RuleBody& body : made.bodies) {
    EXPECT_TRUE(body.element.opening.outline.empty());
    double left = 10, right = 0, low = 10, high = 0;
    for (const Point3& v : body.element.mesh.vertices) {
      EXPECT_GT(v.z, 0.004);
      left = std::min(left, v.x + body.at.x), right = std::max(right, v.x + body.at.x);
      low = std::min(low, v.y + body.at.y), high = std::max(high, v.y + body.at.y);
    }
    EXPECT_FALSE(left < 3 && right > 3 && low < 1.6 && high > 1.6);  // the middle of the window
    // A panel is no pane.
    EXPECT_EQ(body.materials[static_cast<std::size_t>(body.element.mesh.faces[0].part)].material, kUsual.material);
  }
}

TEST(RuleGeometry, WhiteIsAColour) {
  const RuleGeometry made = made_on(wall_of(6, 4), R"(version "2021.0"
@StartRule
Facade --> split(y){ ~1 : Wall. | 0.4 : extrude(0.1) color("#ffffff") Cornice. | 0.3 : extrude(0.1) Band. })");
  ASSERT_EQ(made.bodies.size(), 2u);
  const auto colour = [](const RuleBody& b) {
    return b.materials[static_cast<std::size_t>(b.element.mesh.faces[0].part)].colour;
  };
  EXPECT_EQ(colour(made.bodies[0]), (model::Colour{255, 255, 255}));
  EXPECT_EQ(colour(made.bodies[1]), kUsual.colour);
}

TEST(RuleGeometry, ACorniceIsCutOffAtAPassage) {
  const KeptFree portal{2, 4, 3};
  const RuleGeometry made = made_on(wall_of(6, 4), R"(version "2021.0"
@StartRule
Facade --> s('1, 0.5, 0.2) primitiveCube() color("#808080") Plinth.)",
                                    std::span(&portal, 1));
  ASSERT_EQ(made.bodies.size(), 1u);
  double nearest = 10;
  for (const Point3& v : made.bodies[0].element.mesh.vertices) {
    const double x = v.x + made.bodies[0].at.x;
    EXPECT_TRUE(x < 2.001 || x > 3.999) << x;
    nearest = std::min(nearest, std::fabs(x - 2));
  }
  EXPECT_LT(nearest, 0.001);
}

TEST(RuleGeometry, TooDeepIsToldWithItsRule) {
  const RuleGeometry made = made_on(wall_of(6, 4), R"(version "2021.0"
@StartRule
Facade --> split(y){ 2 : t(0, 0, -1.5) Loggia. | ~1 : Wall. })");
  ASSERT_EQ(made.dropped.size(), 1u);
  EXPECT_THAT(made.dropped.begin()->first, testing::HasSubstr("Loggia"));
  EXPECT_EQ(made.dropped.begin()->second, 1u);
}

TEST(RuleGeometry, KnowsRulesThatOnlyOrderElements) {
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(BLOCKRAND_SOURCE_DIR) / "configs/grammars")) {
    if (entry.path().extension() != ".cga") continue;
    EXPECT_FALSE(makes_geometry(program_of(entry.path().string()))) << entry.path();
  }
  EXPECT_TRUE(makes_geometry(program_of((kFiles / "brick_bays.cga").string())));
  EXPECT_TRUE(makes_geometry(program_of("version \"2021.0\"\nLot --> split(x){ 1 : t(0, 0, -0.1) A. | ~1 : B. }")));
}

TEST(WallPaint, CoversTheStoreyLessItsOpenings) {
  const WallFrame wall = wall_of(10, 9);
  const std::vector<std::vector<Point2>> openings{{{2, 4}, {3, 4}, {3, 5.5}, {2, 5.5}}};
  const PaintOrder order{0, 0, 10, 3, 6, kUsual, "storey 1"};
  const auto paint = wall_paint(order, wall, openings, 1);
  ASSERT_TRUE(paint);
  double area = 0;
  for (const model::ElementFace& face : paint->element.mesh.faces) {
    const auto at = [&](std::uint32_t i) {
      return paint->element.mesh.vertices[paint->element.mesh.indices[face.first + i]];
    };
    const Point3 a = at(0), b = at(1), c = at(2);
    const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    EXPECT_GT(twice, 0);  // seen from outside
    EXPECT_NEAR(a.z, 0.018, 0.001);
    area += twice / 2;
  }
  EXPECT_NEAR(area, 10 * 3 - 1.5, 0.02);
  EXPECT_FALSE(wall_paint({0, 0, 10, 9.5, 12, kUsual, "storey 4"}, wall, {}, 0));
}

}  // namespace
}  // namespace blockrand::facades
