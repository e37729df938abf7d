// Rules that begin on a footprint: the shape they begin with, the values they find, what becomes of their leaves.
#include "pipeline/facades/footprint_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "pipeline/facades/facades.h"
#include "pipeline/facades/grammar_library.h"
#include "pipeline/facades/leaf_polygons.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/solid_builder.h"
#include "styles/grammar/shapes/scope.h"
#include "tests/unit/facades/house.h"

namespace blockrand::facades {
namespace {

using model::Point2;
using model::Point3;
using test::defaults;

const model::PartMaterial kLook{0, {200, 190, 170}};

/// A part on a rectangle of 10 x 20 m, its lower left corner at (1000, 2000).
struct Scene {
  model::Building building;
  std::vector<WallFrame> walls;
  std::vector<FacadeSegment> segments;
  model::BuildingPart& part() { return building.parts[0]; }
};

Scene scene() {
  Scene s;
  s.building.osm = {model::OsmType::way, 1};
  model::BuildingPart part;
  part.id = "w1";
  part.osm = s.building.osm;
  part.plan = part.roof_plan = testing_shapes::polygon({{1000, 2000}, {1010, 2000}, {1010, 2020}, {1000, 2020}});
  part.attributes.storeys.value = 3;
  part.attributes.height.value = 13.5;
  part.attributes.roof_height.value = 4;
  part.attributes.shown_wall_colour = {0x11, 0x22, 0x33};
  part.built_roof = model::RoofShape::half_hipped;
  s.building.parts.push_back(part);
  return s;
}

/// A street on the side that looks east.
void add_street(Scene& s) {
  WallFrame wall;
  wall.start = {1010, 2000};
  wall.along = {0, 1};
  wall.length = 20;
  wall.height = 9.5;
  s.walls.push_back(wall);
  FacadeSegment segment;
  segment.to = 20;
  segment.kind = model::WallSegmentKind::street;
  segment.edges = {0};
  s.segments.push_back(segment);
  model::WallSegment edge;
  edge.street_distance = 7;
  s.building.edges.push_back(edge);
}

Point3 in_build(const FootprintShape& f, const grammar::Vector3& world) {
  const grammar::Vector3 p = grammar::place(f.world, world);
  return {p.x, p.y, p.z};
}

TEST(FootprintShape, BeginsWithTheMainFront) {
  Scene s = scene();
  add_street(s);
  const FootprintShape f = footprint_shape(s.part(), 5, s.walls, s.segments, s.building);
  ASSERT_TRUE(f.shape.mesh);
  EXPECT_NEAR(f.shape.size.x, 20, 1e-9) << "along the first edge";
  EXPECT_NEAR(f.shape.size.z, 10, 1e-9);
  // The scope's x runs north along the eastern wall, its y up, and the front looks to the street: +z is outwards.
  const grammar::Frame frame = grammar::compose(f.world, grammar::scope_in_world(f.shape));
  EXPECT_NEAR(frame.axes[0].y, 1, 1e-9);
  EXPECT_NEAR(frame.axes[1].z, 1, 1e-9);
  EXPECT_NEAR(frame.axes[2].x, 1, 1e-9);
  ASSERT_TRUE(f.shape.origin);
  EXPECT_THAT(f.shape.origin->street_widths, testing::ElementsAre(14, 0, 0, 0));
  // On the ground it was given, where the plan is.
  const Point3 first = in_build(f, grammar::scope_in_world(f.shape).origin);
  EXPECT_NEAR(first.z, 5, 1e-9);
}

TEST(FootprintShape, WithoutAStreetTheLongestEdgeIsFirst) {
  Scene s = scene();
  const FootprintShape f = footprint_shape(s.part(), 0, s.walls, s.segments, s.building);
  EXPECT_NEAR(f.shape.size.x, 20, 1e-9);
  // A ring that runs the other way is turned.
  std::reverse(s.part().roof_plan.outer.points.begin(), s.part().roof_plan.outer.points.end());
  const FootprintShape turned = footprint_shape(s.part(), 0, s.walls, s.segments, s.building);
  const grammar::Frame frame = grammar::compose(turned.world, grammar::scope_in_world(turned.shape));
  EXPECT_NEAR(frame.axes[1].z, 1, 1e-9) << "it looks up";
}

TEST(OsmAttributes, ResolvedValuesComeFirst) {
  Scene s = scene();
  const auto all = osm_attributes(s.building, s.part(), nullptr);
  const auto value = [&](const std::string& key) {
    for (const auto& [name, v] : all)
      if (name == key) return std::get<std::string>(v);
    return std::string("(none)");
  };
  EXPECT_EQ(value("building:levels"), "3");
  EXPECT_EQ(value("height"), "13.5");
  EXPECT_EQ(value("roof:height"), "4");
  EXPECT_EQ(value("roof:shape"), "half-hipped") << "as OSM writes it";
  EXPECT_EQ(value("building:colour"), "#112233");
}

std::vector<std::vector<Point3>> box(Point3 a, Point3 b) {
  return {{{a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, a.y, a.z}},
          {{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}},
          {{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}},
          {{b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}},
          {{b.x, b.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}},
          {{a.x, b.y, a.z}, {a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}}};
}

TEST(RuleSurfaces, FacesBetweenBodiesAreHidden) {
  RuleSurfaces surfaces;
  for (auto& f : box({0, 0, 0}, {4, 4, 3})) surfaces.add("Lower", f, kLook, true);
  for (auto& f : box({0, 0, 3}, {4, 4, 6})) surfaces.add("Upper", f, kLook, true);
  surfaces.add("Sign", {{0, -1, 1}, {2, -1, 1}, {2, -1, 2}, {0, -1, 2}}, kLook, false);
  const RuleSurfaces::Made made = surfaces.take(0);
  EXPECT_FALSE(made.surfaces.closed);
  ASSERT_EQ(made.surfaces.faces.size(), 11u) << "twelve without the two that touch, and the sign";
  ASSERT_EQ(made.rules.size(), 3u);
  EXPECT_EQ(made.rules[0].rule, "Lower");
  EXPECT_EQ(made.rules[0].count, 5u);
  EXPECT_EQ(made.rules[1].first, 5u);
  EXPECT_EQ(made.rules[2].rule, "Sign");
  std::size_t of[model::kSurfaceKindCount] = {};
  for (const model::Face& f : made.surfaces.faces) ++of[static_cast<std::size_t>(f.kind)];
  EXPECT_EQ(of[static_cast<std::size_t>(model::SurfaceKind::ground)], 1u);
  EXPECT_EQ(of[static_cast<std::size_t>(model::SurfaceKind::roof)], 1u);
  EXPECT_EQ(of[static_cast<std::size_t>(model::SurfaceKind::wall)], 9u);
  ASSERT_EQ(made.triangles.first.size(), 12u);
  EXPECT_EQ(made.triangles.triangles.size(), 22u);
}

TEST(RuleSurfaces, WhatIsThinnerThanTheGridShowsNothing) {
  RuleSurfaces surfaces;
  surfaces.add("Hair", {{0, 0, 0}, {1, 0, 0}, {1, 0, 1e-5}, {0, 0, 1e-5}}, kLook, false);
  // Wider than the grid, and still no ring: two steps are needed.
  surfaces.add("Slit", {{0, 0, 0}, {1, 0, 0}, {1, 0, 0.0015}, {0, 0, 0.0015}}, kLook, false);
  EXPECT_TRUE(surfaces.empty());
  // A corner a step off the next one goes; the face stays.
  surfaces.add("Wall", {{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0.001, 0, 3}, {0, 0, 2.999}}, kLook, false);
  const RuleSurfaces::Made made = surfaces.take(0);
  ASSERT_EQ(made.surfaces.faces.size(), 1u);
  EXPECT_EQ(made.surfaces.vertices.size(), 4u);
}

// ---- the whole way: a rule file as the preset of a house

struct Built {
  model::Region region;
  const model::BuildingPart& part() const { return region.buildings[0].parts[0]; }
};

/// A block of 10 x 20 x 9.5 m that wears the preset.
Built built(const std::string& file, const std::vector<std::pair<std::string, std::string>>& attributes = {},
            const std::filesystem::path& folder = std::filesystem::path(BLOCKRAND_SOURCE_DIR) /
                                                  "tests/golden/rule_files/independent") {
  const std::vector<PresetGrammar> presets{{"own", file, attributes}};
  const GrammarLibrary grammars(folder.string(), presets, test::elements_of_configs());
  Built out;
  out.region.materials.resize(defaults().materials.size());
  Scene s = scene();
  s.part().attributes.preset.value = s.building.attributes.preset.value = "own";
  s.part().attributes.height.value = 0;  // levels decide
  s.part().built_roof = model::RoofShape::gabled;
  geometry::SolidBuilder builder;
  auto faces = box({1000, 2000, 0}, {1010, 2020, 9.5});
  for (std::size_t i = 0; i < faces.size(); ++i) {
    model::Face face;
    face.kind = i == 0 ? model::SurfaceKind::ground : i == 1 ? model::SurfaceKind::roof : model::SurfaceKind::wall;
    builder.add_face(faces[i], face);
  }
  s.part().lod2 = builder.take();
  s.part().lod2_triangles = *geometry::triangulate(s.part().lod2);
  s.part().lod = 2;
  out.region.buildings.push_back(std::move(s.building));
  build_facades(out.region, grammars, defaults(), {});
  return out;
}

std::size_t faces_of(const model::BuildingPart& part, std::string_view rule) {
  for (const model::RuleFaces& r : part.lod3.rules)
    if (r.rule == rule) return r.count;
  return 0;
}

TEST(FootprintRules, APublishedFileIsThePart) {
  // osm_massing.cga: 9 leaves on 10 x 20 m with three levels; the volumes are worked out in its head.
  const Built b = built("osm_massing.cga");
  EXPECT_EQ(b.part().lod, 3);
  EXPECT_FALSE(b.part().lod3.solid.closed);
  EXPECT_TRUE(b.region.report.rows.empty()) << b.region.report.rows.front().detail;
  EXPECT_EQ(faces_of(b.part(), "SlabBand"), 3u * 6);
  EXPECT_GE(faces_of(b.part(), "Roof"), 4u);
  double top = 0;
  for (const Point3& v : b.part().lod3.solid.vertices) top = std::max(top, v.z);
  EXPECT_NEAR(top, 9.5 + 4 + 1, 0.01) << "the chimney stands over the ridge";
  // It stands where the part stands.
  for (const Point3& v : b.part().lod3.solid.vertices) {
    EXPECT_GT(v.x, 999.5);
    EXPECT_LT(v.x, 1010.5);
    EXPECT_GT(v.y, 1999.5);
    EXPECT_LT(v.y, 2020.5);
  }
}

TEST(FootprintRules, ValuesOfThePresetBeatThoseOfTheHouse) {
  const Built b = built("osm_massing.cga", {{"building__levels", "5"}});
  EXPECT_EQ(faces_of(b.part(), "SlabBand"), 5u * 6);
}

TEST(FootprintRules, OurWindowsStandInTheirWalls) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "footprint_rules";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "own.cga")
      << "@StartRule\nLot --> extrude(9) comp(f){ side : Side | top : Top. | bottom : Bottom. }\n"
         "Side --> split(x){ ~1 : Wall. | 1.1 : Axis | ~1 : Wall. }\n"
         "Axis --> split(y){ 1 : Wall. | 1.6 : blockrand.window(\"casement_window\", \"head\", \"round\") | ~1 : Wall. "
         "}\n";
  const Built b = built("own.cga", {}, folder);
  ASSERT_EQ(b.part().lod3.placements.size(), 4u);
  EXPECT_TRUE(b.region.report.rows.empty()) << b.region.report.rows.front().detail;
  for (const model::Placement& p : b.part().lod3.placements) {
    const model::Element& window = *b.region.elements.at(p.element).element;
    EXPECT_EQ(window.kind, "casement_window");
    EXPECT_NEAR(p.origin.z, 1, 0.001);
  }
  // What is left of the leaf above the arch, and the reveal's sides.
  EXPECT_GT(faces_of(b.part(), "Axis") + faces_of(b.part(), "blockrand.window"), 4u * 6);
}

TEST(FootprintRules, RulesThatMakeNothingLeaveTheBodyAndAreTold) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "footprint_nothing";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "own.cga") << "@StartRule\nLot --> NIL\n";
  const Built b = built("own.cga", {}, folder);
  EXPECT_EQ(b.part().lod, 2);
  ASSERT_EQ(b.region.report.rows.size(), 1u);
  EXPECT_EQ(b.region.report.rows[0].code, model::IssueCode::grammar_error);
}

TEST(FootprintRules, ElementsOnSlopesAreDroppedAndTold) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "footprint_slope";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "own.cga")
      << "@StartRule\nLot --> extrude(9) comp(f){ side : Side. | top : Top | bottom : NIL }\n"
         "Top --> blockrand.window(\"casement_window\")\n";
  const Built b = built("own.cga", {}, folder);
  EXPECT_EQ(b.part().lod, 3);
  ASSERT_EQ(b.region.report.rows.size(), 1u);
  EXPECT_EQ(b.region.report.rows[0].code, model::IssueCode::leaf_dropped);
  EXPECT_THAT(b.region.report.rows[0].detail, testing::HasSubstr("upright"));
}

}  // namespace
}  // namespace blockrand::facades
