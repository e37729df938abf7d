#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/attributes/defaults.h"
#include "pipeline/attributes/resolve.h"
#include "pipeline/context/tagged_neighbours.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/solid_overlap.h"
#include "pipeline/masses/mass.h"
#include "tests/unit/footprints/repair/repair_alone.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::masses {
namespace {

using model::IssueCode;
using model::MappedAttributes;
using model::Point2;
using model::RoofShape;
using model::Source;
using testing_shapes::ring;

const std::string kConfigs = std::string(BLOCKRAND_SOURCE_DIR) + "/configs";

/// One tile with buildings made from outlines and tags, taken through repair, resolve and mass.
class Town {
 public:
  Town() : defaults(attributes::read_defaults(kConfigs)) { extract.strings.intern("yes"); }

  MappedAttributes& add(std::vector<Point2> outline, const std::string& use = "yes") {
    model::Building b;
    b.osm = {model::OsmType::way, static_cast<std::int64_t>(region.buildings.size()) + 1};
    b.mapped_index = static_cast<std::uint32_t>(region.buildings.size());
    b.rings.rings = {ring(std::move(outline))};
    b.rings.inner = {false};
    b.mapped.use = extract.strings.intern(use);
    region.buildings.push_back(std::move(b));
    return region.buildings.back().mapped;
  }
  MappedAttributes& add_part(std::int64_t number, std::vector<Point2> outline) {
    model::Building& b = region.buildings.back();
    model::BuildingPart p;
    p.osm = {model::OsmType::way, number};
    p.mapped_index = 100 + static_cast<std::uint32_t>(number);
    p.id = b.id() + "." + p.osm.text();
    p.rings.rings = {ring(std::move(outline))};
    p.rings.inner = {false};
    p.mapped.use = extract.strings.intern("yes");
    b.parts.push_back(std::move(p));
    b.has_mapped_parts = true;
    return b.parts.back().mapped;
  }
  void build(int lod = 2) {
    region.extract = &extract;
    for (const attributes::Material& m : defaults.materials) region.materials.push_back(m.material_class);
    repair::test::repair_alone(region);
    const context::TaggedNeighbours index(neighbours, 100);
    attributes::resolve_attributes(region, {defaults, index, seed, [this](const model::Building&) { return ground; }},
                                   {});
    build_masses(region, defaults, {}, lod);
  }
  const model::BuildingPart& part(std::size_t building = 0, std::size_t part = 0) const {
    return region.buildings.at(building).parts.at(part);
  }
  bool reported(IssueCode code) const {
    return std::any_of(region.report.rows.begin(), region.report.rows.end(),
                       [&](const auto& r) { return r.code == code; });
  }

  attributes::Defaults defaults;
  model::Extract extract;
  model::Region region;
  std::vector<context::TaggedBuilding> neighbours;
  std::uint64_t seed = 1;
  context::BuildingGround ground{.lowest = {34, Source::override_, 1, 0}, .entrance_reason = {}, .part_rise = {}};
};

const std::vector<Point2> kHouse{{0, 0}, {12, 0}, {12, 9}, {0, 9}};
const std::vector<Point2> kHall{{0, 0}, {60, 0}, {60, 40}, {0, 40}};

double top(const model::Solid& s) {
  double z = -1e9;
  for (const auto& v : s.vertices) z = std::max(z, v.z);
  return z;
}
double bottom(const model::Solid& s) {
  double z = 1e9;
  for (const auto& v : s.vertices) z = std::min(z, v.z);
  return z;
}

TEST(Defaults, ReadsTheShippedTables) {
  const attributes::Defaults d = attributes::read_defaults(kConfigs);
  EXPECT_EQ(d.use("bungalow").storeys, 1);
  EXPECT_EQ(d.use("no such use").name, "default");
  EXPECT_EQ(d.materials[static_cast<std::size_t>(d.material("sandstone"))].material_class.name, "stone");
  EXPECT_EQ(d.material("unobtainium"), -1);
}

/// Whatever a building lacks (outline, parts, the plan of a part, the ground under its parts), attributes and masses are
/// numbers and nothing crashes: with every roof shape, with and without a height, storeys and a direction.
TEST(Resolve, BuildingsThatLackSomethingPassThrough) {
  const model::Polygon plan{ring(kHouse), {}};
  for (std::size_t shape = 0; shape < model::kRoofShapeCount; ++shape)
    for (int tags = 0; tags < 8; ++tags) {
      Town t;
      t.region.extract = &t.extract;
      for (const attributes::Material& m : t.defaults.materials) t.region.materials.push_back(m.material_class);
      const auto describe = [&](MappedAttributes& mapped) {
        mapped.roof_shape = static_cast<RoofShape>(shape);
        if (tags & 1) mapped.height = 9.0f;
        if (tags & 2) mapped.storeys = 0.0f;
        if (tags & 4) mapped.roof_direction = 90.0f;
      };
      for (int lacks = 0; lacks < 5; ++lacks) {
        describe(t.add(kHouse));
        model::Building& b = t.region.buildings.back();
        if (lacks == 0) b.settled = model::ObjectState::duplicate;  // has nothing at all
        if (lacks == 1 || lacks == 4) b.outline = {plan};
        if (lacks >= 2) describe(t.add_part(10 + lacks, kHouse));  // of 2 and 4 without a plan
        if (lacks == 3) b.parts.back().plan = plan;
      }
      const context::TaggedNeighbours index(t.neighbours, 100);
      attributes::resolve_attributes(t.region, {t.defaults, index, 1, [&](const model::Building&) { return t.ground; }},
                                     {});
      build_masses(t.region, t.defaults, {}, 2);
      for (const model::Building& b : t.region.buildings)
        for (const double height :
             {b.attributes.height.value, b.attributes.roof_height.value, b.attributes.storeys.value})
          EXPECT_TRUE(std::isfinite(height)) << b.id() << " shape " << shape << " tags " << tags;
    }
}

TEST(Resolve, HeightTagRunsToTheTopOfTheRoof) {
  Town t;
  auto& tags = t.add(kHouse);
  tags.height = 10;
  tags.roof_shape = RoofShape::gabled;
  tags.roof_height = 4;
  t.build();
  EXPECT_DOUBLE_EQ(top(t.part().lod2), 44);
  EXPECT_DOUBLE_EQ(bottom(t.part().lod2), 34);
  EXPECT_EQ(t.part().attributes.height.source, Source::tag);
  double eaves = 1e9;
  for (const auto& v : t.part().lod2.vertices)
    if (v.z > 34) eaves = std::min(eaves, v.z);
  EXPECT_DOUBLE_EQ(eaves, 40);
}

TEST(Resolve, StoreysCountTheGroundFloorAndRoofLevelsAdd) {
  Town t;
  auto& tags = t.add(kHouse, "apartments");
  tags.storeys = 4;
  tags.roof_storeys = 1;
  tags.roof_shape = RoofShape::gabled;
  t.build();
  const auto& a = t.part().attributes;
  EXPECT_DOUBLE_EQ(a.storeys.value, 4);
  EXPECT_DOUBLE_EQ(a.height.value, 4 * 3.0 + 3.0);
  EXPECT_EQ(a.roof_height.source, Source::implied);
}

TEST(Resolve, MinLevelIsPartOfTheLevels) {
  // building:levels=5 with building:min_level=2 stands on the third storey and ends at the fifth.
  Town t;
  auto& tags = t.add(kHouse, "apartments");
  tags.storeys = 5;
  tags.min_storey = 2;
  tags.roof_shape = RoofShape::flat;
  t.build();
  EXPECT_DOUBLE_EQ(bottom(t.part().lod2), 34 + 6);
  EXPECT_DOUBLE_EQ(top(t.part().lod2), 34 + 15);
  const bool has_ceiling = std::any_of(t.part().lod2.faces.begin(), t.part().lod2.faces.end(),
                                       [](const auto& f) { return f.kind == model::SurfaceKind::outer_ceiling; });
  EXPECT_TRUE(has_ceiling) << "the underside of a raised part is no ground surface";
}

TEST(Resolve, StoreysFromAHeightAlone) {
  Town t;
  auto& tags = t.add(kHall, "office");
  tags.height = 35;
  t.build();
  EXPECT_DOUBLE_EQ(t.part().attributes.storeys.value, 10);
  EXPECT_NEAR(t.part().attributes.storeys.value * t.part().attributes.storey_height.value, 35, 1e-9);
}

TEST(Resolve, NeighboursBeatPresetsAndTagsBeatNeighbours) {
  Town t;
  for (int i = 0; i < 3; ++i)
    t.neighbours.push_back({{model::OsmType::way, 100 + i},
                            {10.0 * i, 20},
                            attributes::neighbour_group(t.defaults, "yes", 100),
                            6,
                            std::nullopt});
  t.add(kHouse);
  t.add({{20, 0}, {32, 0}, {32, 9}, {20, 9}}).storeys = 2;
  t.build();
  EXPECT_DOUBLE_EQ(t.part(0).attributes.storeys.value, 6);
  EXPECT_EQ(t.part(0).attributes.storeys.source, Source::neighbours);
  const auto& evidence = t.region.evidence[t.part(0).attributes.storeys.evidence];
  EXPECT_EQ(evidence.text, "median of 3 neighbours within 100 m");
  ASSERT_EQ(evidence.other_candidates.size(), 1u);
  EXPECT_EQ(evidence.other_candidates[0].value, "3");
  EXPECT_EQ(t.part(1).attributes.storeys.source, Source::tag);
}

TEST(Resolve, AGarageDoesNotGrowToItsNeighbours) {
  Town t;
  for (int i = 0; i < 5; ++i)
    t.neighbours.push_back({{model::OsmType::way, 100 + i},
                            {10.0 * i, 20},
                            attributes::neighbour_group(t.defaults, "yes", 100),
                            6,
                            std::nullopt});
  t.add({{0, 0}, {6, 0}, {6, 3}, {0, 3}}, "garage");
  t.add({{20, 0}, {21, 0}, {21, 2}, {20, 2}}, "yes");  // a stele
  t.build();
  EXPECT_LT(t.part(0).attributes.height.value, 4);
  EXPECT_LT(t.part(1).attributes.height.value, 4);
}

TEST(Resolve, WideHallsAreFlat) {
  Town t;
  t.add(kHall);
  t.build();
  EXPECT_EQ(t.part().built_roof, RoofShape::flat);
  EXPECT_EQ(t.part().attributes.roof_shape.source, Source::geometry);
}

TEST(Resolve, TowersAreFlatAndTenementsAreNot) {
  Town t;
  t.add(kHouse, "apartments").storeys = 7;
  t.add({{30, 0}, {42, 0}, {42, 9}, {30, 9}}, "apartments").storeys = 6;
  auto& tagged = t.add({{60, 0}, {72, 0}, {72, 9}, {60, 9}}, "apartments");
  tagged.storeys = 7;
  tagged.roof_shape = RoofShape::gabled;
  t.build();
  EXPECT_EQ(t.part(0).built_roof, RoofShape::flat);
  EXPECT_EQ(t.part(0).attributes.roof_shape.source, Source::geometry);
  EXPECT_EQ(t.part(1).built_roof, RoofShape::gabled);
  EXPECT_EQ(t.part(2).built_roof, RoofShape::gabled);
}

TEST(Resolve, ADeepRowHouseHasItsRidgeFromPartyWallToPartyWall) {
  const auto house = [](bool in_row, std::optional<model::RoofOrientation> tagged) {
    Town t;
    auto& tags = t.add({{0, 0}, {6, 0}, {6, 10}, {0, 10}});
    tags.storeys = 2;
    tags.roof_shape = RoofShape::gabled;
    tags.roof_orientation = tagged;
    for (const std::uint32_t number : {1u, 3u}) {
      if (!in_row) break;
      model::WallSegment e;
      e.edge = number;
      e.kind = model::WallSegmentKind::party_wall;
      e.end = 10;
      t.region.buildings.back().edges.push_back(e);
    }
    t.build();
    return t.part().attributes;
  };
  const auto row = house(true, {}), alone = house(false, {}), tagged = house(true, model::RoofOrientation::along);
  EXPECT_EQ(row.roof_orientation.value, model::RoofOrientation::across);
  EXPECT_EQ(row.roof_orientation.source, Source::geometry);
  EXPECT_EQ(alone.roof_orientation.value, model::RoofOrientation::along);
  EXPECT_EQ(tagged.roof_orientation.source, Source::tag);
  EXPECT_EQ(tagged.roof_orientation.value, model::RoofOrientation::along);
  // The same pitch over a longer run.
  EXPECT_NEAR(row.roof_height.value / tagged.roof_height.value, 10.0 / 6.0, 1e-6);
}

TEST(Resolve, ColoursAreDrawnPerBuildingNotPerRun) {
  Town a, b;
  for (int i = 0; i < 12; ++i) {
    const double x = 30.0 * i;
    a.add({{x, 0}, {x + 12, 0}, {x + 12, 9}, {x, 9}});
  }
  b.add(kHouse);  // same id as the first of a, nothing else in common
  a.build();
  b.build();
  EXPECT_EQ(a.part(0).attributes.wall_colour.value, b.part(0).attributes.wall_colour.value);
  std::set<model::Colour> seen;
  for (std::size_t i = 0; i < 12; ++i) seen.insert(a.part(i).attributes.wall_colour.value);
  EXPECT_GT(seen.size(), 2u);
}

TEST(Mass, FootprintAndHeightGiveAClosedBodyOfTheRightVolume) {
  // docs/internal/seeds.md S3A-01: volume = area times height.
  Town t;
  auto& tags = t.add({{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 18}, {0, 18}});
  tags.height = 12;
  tags.roof_shape = RoofShape::flat;
  t.build();
  const auto& p = t.part();
  EXPECT_TRUE(geometry::check_solid(p.lod2, p.lod2_triangles).valid());
  EXPECT_NEAR(geometry::volume(p.lod2, p.lod2_triangles), 240 * 12, 1e-6);
  EXPECT_NEAR(geometry::volume(p.lod1, p.lod1_triangles), 240 * 12, 1e-6);
}

TEST(Mass, LoD1HasTheVolumeOfTheRoof) {
  Town t;
  auto& tags = t.add(kHouse);
  tags.height = 10;
  tags.roof_height = 4;
  tags.roof_shape = RoofShape::gabled;
  t.build();
  EXPECT_NEAR(geometry::volume(t.part().lod1, t.part().lod1_triangles),
              geometry::volume(t.part().lod2, t.part().lod2_triangles), 1);
}

TEST(Mass, CanopiesAreSlabsWithoutWallsBelow) {
  Town t;
  t.add(kHouse, "roof").height = 5;
  t.build();
  EXPECT_DOUBLE_EQ(top(t.part().lod2), 39);
  EXPECT_NEAR(bottom(t.part().lod2), 38.7, 0.001);
}

TEST(Mass, WhatHasAnUndersideAndNoHeightStandsAboveIt) {
  Town t;
  t.add(kHouse).min_height = 12;
  t.add({{50, 0}, {60, 0}, {60, 9}, {50, 9}}, "roof").min_height = 5;
  auto& part = t.add({{100, 0}, {110, 0}, {110, 9}, {100, 9}});
  part.storeys = 2;  // counted from its underside
  part.min_storey = 4;
  part.roof_shape = RoofShape::flat;
  t.build();
  EXPECT_DOUBLE_EQ(bottom(t.part(0).lod2), 46);
  EXPECT_GT(top(t.part(0).lod2), 48);
  EXPECT_DOUBLE_EQ(bottom(t.part(1).lod2), 39);
  EXPECT_NEAR(top(t.part(1).lod2), 39.3, 0.001);
  const double storey = t.part(2).attributes.storey_height.value;
  EXPECT_NEAR(bottom(t.part(2).lod2), 34 + 4 * storey, 0.001);
  EXPECT_NEAR(top(t.part(2).lod2), 34 + 6 * storey, 0.001);
  EXPECT_EQ(std::count_if(t.region.report.rows.begin(), t.region.report.rows.end(),
                          [](const auto& r) { return r.code == IssueCode::values_conflict; }),
            1);
}

TEST(Mass, ARoofThatThePlanDoesNotTakeSaysSo) {
  Town t;
  t.add({{0, 0}, {30, 0}, {30, 20}, {22, 20}, {22, 8}, {8, 8}, {8, 20}, {0, 20}}).roof_shape = RoofShape::pyramidal;
  t.build();
  EXPECT_EQ(t.part().built_roof, RoofShape::hipped);
  EXPECT_EQ(t.part().lod, 2);
  EXPECT_EQ(t.part().attributes.roof_shape.value, RoofShape::pyramidal);
  EXPECT_TRUE(t.reported(IssueCode::roof_shape_adapted));
}

TEST(Mass, ARoofHigherThanItsHouseIsClampedAndReported) {
  Town t;
  auto& tags = t.add(kHouse);
  tags.height = 4;
  tags.roof_height = 9;
  tags.roof_shape = RoofShape::gabled;
  t.build();
  EXPECT_DOUBLE_EQ(top(t.part().lod2), 38);
  EXPECT_TRUE(t.reported(IssueCode::values_conflict));
}

TEST(Mass, EveryShapeOnEveryPlanGivesAValidSolid) {
  const std::vector<std::vector<Point2>> plans{kHouse,
                                               {{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 18}, {0, 18}},
                                               {{0, 0}, {10, 0}, {10, 10}, {0, 10}},
                                               {{0, 0}, {30, 0}, {30, 20}, {22, 20}, {22, 8}, {8, 8}, {8, 20}, {0, 20}},
                                               {{0, 0}, {9, 1}, {5, 8}}};
  for (std::size_t shape = 0; shape < std::size(model::kRoofShapeNames); ++shape) {
    Town t;
    for (const auto& plan : plans) {
      auto& tags = t.add(testing_shapes::turned(testing_shapes::polygon(plan)).outer.points);
      tags.roof_shape = static_cast<RoofShape>(shape);
      tags.storeys = 3;
    }
    t.build();
    for (std::size_t i = 0; i < plans.size(); ++i) {
      EXPECT_EQ(t.part(i).lod, 2) << model::kRoofShapeNames[shape] << " on plan " << i;
      EXPECT_TRUE(geometry::check_solid(t.part(i).lod2, t.part(i).lod2_triangles).valid());
    }
    EXPECT_FALSE(t.reported(IssueCode::roof_failed)) << model::kRoofShapeNames[shape];
  }
}

TEST(Mass, AdverseHeightsStillGiveSolids) {
  for (const float height : {0.0f, 0.1f, 0.5f, 900.0f})
    for (const float minimum : {0.0f, 3.0f, 1000.0f}) {
      Town t;
      auto& tags = t.add(kHouse);
      tags.height = height;
      tags.min_height = minimum;
      t.build();
      EXPECT_EQ(t.part().lod, 2) << height << " over " << minimum;
    }
}

TEST(Parts, HeightOfTheBuildingIsItsHighestPart) {
  Town t;
  t.add({{0, 0}, {30, 0}, {30, 12}, {0, 12}}, "church");
  t.add_part(50, {{0, 3}, {6, 3}, {6, 9}, {0, 9}}).height = 40;
  t.build();
  const auto& b = t.region.buildings[0];
  EXPECT_DOUBLE_EQ(b.attributes.height.value, 40);
  EXPECT_EQ(b.attributes.height.source, Source::part);
  ASSERT_EQ(b.parts.size(), 2u);
  EXPECT_EQ(b.parts[0].id, "w1.w50");
  EXPECT_EQ(b.parts[1].id, "w1.rest");
  EXPECT_LT(b.parts[1].attributes.height.value, 30) << "the rest does not inherit the tower's height";
}

TEST(Parts, InheritColoursFromTheOutline) {
  Town t;
  t.add({{0, 0}, {30, 0}, {30, 12}, {0, 12}}).wall_colour = model::Colour{170, 51, 51};
  t.add_part(50, {{0, 0}, {30, 0}, {30, 12}, {0, 12}}).height = 14;
  t.build();
  EXPECT_EQ(t.part().attributes.wall_colour.value, (model::Colour{170, 51, 51}));
  EXPECT_EQ(t.part().attributes.wall_colour.source, Source::implied);
}

TEST(Mass, PartsThatShareAGableShareNoRoom) {
  int gables = 0;
  for (int turn = 0; turn < 40; ++turn) {
    SCOPED_TRACE(turn);
    const double angle = 0.157 * turn, c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](std::vector<Point2> points) {
      for (Point2& p : points) p = model::snap(Point2{c * p.x - s * p.y, s * p.x + c * p.y});
      return points;
    };
    Town t;
    t.add(turned({{0, 0}, {31, 0}, {31, 11}, {0, 11}}));
    for (int part = 0; part < 3; ++part) {
      const double from = 10.3 * part, to = part == 2 ? 31 : from + 10.3;
      MappedAttributes& tags = t.add_part(2 + part, turned({{from, 0}, {to, 0}, {to, 11}, {from, 11}}));
      tags.height = static_cast<float>(12 + part);
      tags.roof_shape = RoofShape::gabled;
      tags.roof_height = 3.7f;
    }
    t.build();
    ASSERT_EQ(t.region.buildings[0].parts.size(), 3u);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const model::BuildingPart &p = t.part(0, a), &q = t.part(0, b);
        gables += p.built_roof == RoofShape::gabled;
        EXPECT_EQ(geometry::common_volume({p.lod2.vertices, p.lod2_triangles.triangles},
                                          {q.lod2.vertices, q.lod2_triangles.triangles}) > geometry::kLeastCommonVolume,
                  false)
            << p.id << " and " << q.id;
      }
  }
  EXPECT_GT(gables, 60);
}

TEST(Mass, PartsThatStandOnEachOtherShareNoHeight) {
  Town t;
  t.add({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  const std::vector<Point2> plan{{0, 0}, {20, 0}, {20, 10}, {0, 10}};
  const auto part = [&](std::int64_t number, float bottom, float top) {
    MappedAttributes& tags = t.add_part(number, plan);
    if (bottom > 0) tags.min_height = bottom;
    tags.height = top;
    tags.roof_shape = RoofShape::flat;
  };
  part(2, 0, 9.5f);
  part(3, 9.5f, 9.53f);  // a slab of 3 cm, which would be thickened to a wall's least height
  part(4, 9.53f, 14);
  t.build();
  ASSERT_EQ(t.region.buildings[0].parts.size(), 3u);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_EQ(t.part(0, a).lod, 2);
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_FALSE(geometry::interiors_meet({t.part(0, a).lod2.vertices, t.part(0, a).lod2_triangles.triangles},
                                            {t.part(0, b).lod2.vertices, t.part(0, b).lod2_triangles.triangles}));
  }
}

TEST(Mass, ATowerOnAPitchedRoofBeginsAtItsRidge) {
  Town t;
  t.add({{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  MappedAttributes& house = t.add_part(2, {{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  house.height = 12.0f;
  house.roof_shape = RoofShape::gabled;
  house.roof_height = 1.0f;
  MappedAttributes& tower = t.add_part(3, {{5, 3}, {9, 3}, {9, 7}, {5, 7}});
  tower.min_storey = 4.0f;  // by its storeys it begins at the eaves
  tower.height = 20.0f;
  tower.roof_shape = RoofShape::flat;
  t.build();
  ASSERT_EQ(t.region.buildings[0].parts.size(), 2u);
  EXPECT_EQ(t.part(0, 0).built_roof, RoofShape::gabled);
  EXPECT_FALSE(geometry::interiors_meet({t.part(0, 0).lod2.vertices, t.part(0, 0).lod2_triangles.triangles},
                                        {t.part(0, 1).lod2.vertices, t.part(0, 1).lod2_triangles.triangles}));
}

}  // namespace
}  // namespace blockrand::masses
