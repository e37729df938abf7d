// Single judges of `blockrand validate`.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "pipeline/base/error.h"
#include "pipeline/geometry/solid_defect.h"
#include "pipeline/georef/frames.h"
#include "pipeline/georef/proj_transform.h"
#include "pipeline/georef/projection.h"
#include "pipeline/outputs/gzip.h"
#include "pipeline/validate/bytes_of_file.h"
#include "pipeline/validate/earth.h"
#include "pipeline/validate/finding_log.h"
#include "pipeline/validate/format_agreement.h"
#include "pipeline/validate/ids.h"
#include "pipeline/validate/part_overlap_check.h"
#include "pipeline/validate/positions.h"
#include "pipeline/validate/solids.h"
#include "pipeline/validate/tileset_reader.h"

namespace blockrand::validate {
namespace {

using model::Point3;

TEST(FindingLog, KeepsSomeAndCountsAll) {
  FindingLog one, two;
  for (int i = 0; i < 400; ++i) one.add(Check::position, "a", "", "");
  for (int i = 0; i < 400; ++i) two.add(Check::position, "b", "", "");
  two.add(Check::off_grid, "b", "", "");
  one.append(std::move(two));
  EXPECT_EQ(one.count(Check::position), 800u);
  EXPECT_EQ(one.count(), 801u);
  EXPECT_EQ(one.kept().size(), FindingLog::kKeptPerCheck + 1);
}

/// What is found between a body as every format has it and as a table for people has it.
std::vector<std::string> against_people(std::map<std::string, std::string> all,
                                        std::map<std::string, std::string> people) {
  Contents a, b;
  a.bodies.emplace_back().attributes = std::move(all);
  b.bodies.emplace_back().attributes = std::move(people);
  a.bodies[0].id = b.bodies[0].id = "w1";
  std::vector<Finding> findings;
  compare_attributes({a, "a.gml"}, {b, "a.glb"}, Precision::people, findings);
  check_sources({b, "a.glb"}, true, findings);
  std::vector<std::string> out;
  for (const Finding& f : findings) out.push_back(std::string(info(f.check).text) + " " + f.detail);
  return out;
}

TEST(AttributesForPeople, AreRoundedAndFewer) {
  using Texts = std::map<std::string, std::string>;
  const Texts all = {{"height", "9.46875"},           {"height_source", "tag"},
                     {"height_confidence", "0.9"},    {"roof_pitch", "37.62"},
                     {"roof_pitch_source", "preset"}, {"min_height", "0"},
                     {"min_height_source", "tag"},    {"style", "modern"},
                     {"style_source", "neighbours"},  {"style_confidence", "0.8149"}};
  const Texts people = {{"height", "9.5"},
                        {"height_source", "tag"},
                        {"roof_pitch", "38"},
                        {"roof_pitch_source", "preset"},
                        {"style", "modern"},
                        {"style_source", "neighbours"},
                        {"style_confidence", "0.81"},
                        {"sources", "tag: height"}};
  EXPECT_THAT(against_people(all, people), testing::IsEmpty());
  const auto with = [&](const char* name, const char* value) {
    Texts changed = people;
    changed[name] = value;
    return against_people(all, changed);
  };
  const auto without = [&](const char* name) {
    Texts changed = people;
    changed.erase(name);
    return against_people(all, changed);
  };
  EXPECT_THAT(with("height", "9.4"),
              testing::ElementsAre(testing::HasSubstr("ATTRIBUTE_DIFFERS height: 9.46875 against 9.4")));
  EXPECT_THAT(with("roof_pitch", "39"), testing::ElementsAre(testing::HasSubstr("roof_pitch: 37.62 against 39")));
  EXPECT_THAT(with("style_confidence", "0.8"), testing::ElementsAre(testing::HasSubstr("style_confidence")));
  EXPECT_THAT(with("height_source", "default"),
              testing::ElementsAre(testing::HasSubstr("height_source: tag against default")));
  EXPECT_THAT(with("height_source", "rumour"),
              testing::Contains(testing::HasSubstr("SOURCE_WRONG height from \"rumour\"")));
  EXPECT_THAT(without("height"), testing::ElementsAre(testing::HasSubstr("height: 9.46875 against nothing")));
  EXPECT_THAT(without("height_source"), testing::Contains(testing::HasSubstr("SOURCE_WRONG height without a source")));
  EXPECT_THAT(without("style_confidence"), testing::ElementsAre(testing::HasSubstr("style without a confidence")));
  EXPECT_THAT(without("sources"), testing::ElementsAre(testing::HasSubstr("METADATA_RULE has no column `sources`")));
}

TEST(Ids, OfBodies) {
  for (const char* id : {"w1", "n-5", "r12.w3", "w1.rest", "w1.2", "w1.w2.3"}) EXPECT_TRUE(is_body_id(id)) << id;
  for (const char* id : {"", "w", "x1", "w1.", "w1..2", "w1.x", "1", "w-", "w1.rest."})
    EXPECT_FALSE(is_body_id(id)) << id;
  EXPECT_EQ(owner("w1.2"), "w1");
  EXPECT_EQ(owner("w1.w2.3"), "w2");
  EXPECT_EQ(owner("w1.rest"), "w1");
  EXPECT_EQ(building_of("w1.w2.3"), "w1");
}

TEST(Gunzip, MembersAndDamage) {
  const std::string a = outputs::gzip("hello "), b = outputs::gzip(std::string(100000, 'x'));
  EXPECT_EQ(gunzip(a + b), "hello " + std::string(100000, 'x'));
  EXPECT_FALSE(gunzip(b.substr(0, b.size() - 1)));
  EXPECT_FALSE(gunzip(a + "rest"));
  std::string flipped = b;
  flipped[flipped.size() - 6] ^= 1;  // of the checksum
  EXPECT_FALSE(gunzip(flipped));
}

TEST(Earth, AgreesWithPROJAndGeoref) {
  georef::ProjTransform proj_transform("EPSG:25832", {10, 50, 12, 52});
  for (const double lat : {-89.9, -45.0, 0.0, 0.001, 51.47, 89.999})
    for (const double height : {-100.0, 0.0, 9000.0}) {
      const Point3 p = earth_centred({11.03 * kRadians, lat * kRadians, height});
      const Point3 q = proj_transform.to_ecef({11.03, lat, height});
      EXPECT_LT(std::hypot(p.x - q.x, p.y - q.y, p.z - q.z), 1e-7);
      const Place back = geodetic(p);
      EXPECT_NEAR(back.lat / kRadians, lat, 1e-10);
      EXPECT_NEAR(back.height, height, 1e-6);
    }
  const Matrix m = east_north_up({11 * kRadians, 51 * kRadians, 100});
  const auto other = georef::EnuFrame({11, 51, 100}).local_to_ecef();
  for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(m[i], other[i], i < 12 ? 1e-14 : 1e-7);
  const Point3 p{3, -4, 5}, q = apply_inverse(m, apply(m, p));
  EXPECT_LT(std::hypot(p.x - q.x, p.y - q.y, p.z - q.z), 1e-8);
}

TEST(ProjTransform, IsIndependentOfTheSeriesAndAgrees) {
  const georef::GeoBox area{10.9, 51.3, 11.2, 51.6};
  const georef::Projection projection(georef::open_crs("EPSG:25832", area), area);
  georef::ProjTransform own("EPSG:25832", area), pinned(projection.crs().pipeline);
  for (const double lon : {10.9, 11.03, 11.2})
    for (const double lat : {51.3, 51.47, 51.6}) {
      const model::Point2 expected = projection.forward(lon, lat);
      for (georef::ProjTransform* w : {&own, &pinned}) {
        const model::Point2 p = w->forward({lon, lat});
        EXPECT_LT(std::hypot(p.x - expected.x, p.y - expected.y), 1e-6);
        const georef::LonLat back = w->inverse(p);
        EXPECT_NEAR(back.lon, lon, 1e-11);
        EXPECT_NEAR(back.lat, lat, 1e-11);
      }
    }
  EXPECT_THROW(georef::ProjTransform("EPSG:999999", area), base::UsageError);
  EXPECT_THROW(georef::ProjTransform("+proj=nonsense"), base::UsageError);
}

TEST(ProjTransform, ComesHomeFromADatumShift) {
  const georef::GeoBox area{6.9, 46.9, 7.1, 47.1};
  georef::ProjTransform w("EPSG:21781", area);  // CH1903 / LV03
  const georef::LonLat back = w.inverse(w.forward({7, 47}));
  EXPECT_NEAR(back.lon, 7, 1e-9);
  EXPECT_NEAR(back.lat, 47, 1e-9);
}

ReadPolygon polygon(std::vector<Point3> ring, std::string kind = "roof", std::string colour = "#112233") {
  ReadPolygon p;
  p.rings = {std::move(ring)};
  p.kind = std::move(kind);
  p.colour = std::move(colour);
  return p;
}

/// A cube of 10 m with one corner at the origin.
ReadSolid cube() {
  const auto p = [](int x, int y, int z) { return Point3{10.0 * x, 10.0 * y, 10.0 * z}; };
  ReadSolid s;
  s.lod = 1;
  s.polygons = {polygon({p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0)}, "ground"),
                polygon({p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)}),
                polygon({p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)}, "wall"),
                polygon({p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1)}, "wall"),
                polygon({p(1, 1, 0), p(0, 1, 0), p(0, 1, 1), p(1, 1, 1)}, "wall"),
                polygon({p(0, 1, 0), p(0, 0, 0), p(0, 0, 1), p(0, 1, 1)}, "wall")};
  return s;
}

Contents contents_of(ReadSolid solid) {
  Contents c;
  c.buildings = {"w1"};
  c.bodies.emplace_back();
  c.bodies[0].id = c.bodies[0].building = "w1";
  c.bodies[0].attributes = {{"lod", "1"}};
  c.bodies[0].solids.push_back(std::move(solid));
  return c;
}

std::vector<std::string> codes(const std::vector<Finding>& findings) {
  std::vector<std::string> out;
  for (const Finding& f : findings) out.emplace_back(info(f.check).text);
  return out;
}

TEST(Validators, AgreeOnACube) {
  EXPECT_TRUE(validator(cube()).valid());
  ReadSolid open = cube();
  open.polygons.pop_back();
  EXPECT_FALSE(validator(open).valid());
  EXPECT_TRUE(validator(open).agreed());
  ReadSolid flipped = cube();
  std::reverse(flipped.polygons[1].rings[0].begin(), flipped.polygons[1].rings[0].end());
  EXPECT_FALSE(validator(flipped).valid());
  EXPECT_TRUE(validator(flipped).agreed());
  ReadSolid far = cube();
  far.polygons[1].rings[0][0] = {1e8, 0, 10};
  EXPECT_FALSE(validator(far).own.empty());
  EXPECT_FALSE(validator(ReadSolid{}).valid());
}

TEST(Validators, GiveTheNumberOfTheDefect) {
  ReadSolid open = cube();
  open.polygons.pop_back();
  EXPECT_EQ(validator(open).number, 302);
  EXPECT_THAT(validator(open).text(), testing::HasSubstr("302 shell not closed"));
  ReadSolid bent = cube();
  std::swap(bent.polygons[0].rings[0][0], bent.polygons[0].rings[0][1]);
  EXPECT_EQ(validator(bent).number, 104);
  EXPECT_EQ(validator(cube()).number, 0);
  EXPECT_EQ(validator(ReadSolid{}).number, 902);
  ReadSolid hollow = cube();
  hollow.polygons[0].rings.clear();
  EXPECT_EQ(validator(hollow).number, 101);
  std::vector<Finding> findings;
  note(validator(open), "a.gml", "w1", "LoD 2", findings);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].number, 302);
}

TEST(Overlaps, OfPartsOfOneBuilding) {
  const auto moved = [](double by, const char* id, const char* building) {
    ReadBody body;
    body.id = id;
    body.building = building;
    ReadSolid solid = cube();
    for (ReadPolygon& p : solid.polygons)
      for (auto& ring : p.rings)
        for (Point3& q : ring) q.x += by;
    body.solids = {solid};
    return body;
  };
  const auto overlaps = [](std::vector<ReadBody> bodies) {
    Contents c;
    c.bodies = std::move(bodies);
    std::uint64_t pairs = 0;
    return find_overlaps(c, pairs);
  };
  const Point3 corner = cube().polygons[0].rings[0][0];
  double side = 0;
  const ReadSolid whole = cube();
  for (const ReadPolygon& p : whole.polygons)
    for (const Point3& q : p.rings[0]) side = std::max(side, std::fabs(q.x - corner.x));
  EXPECT_TRUE(overlaps({moved(0, "w1.w2", "w1"), moved(side, "w1.w3", "w1")}).empty());
  EXPECT_TRUE(overlaps({moved(0, "w1.w2", "w1"), moved(side / 2, "w4.w3", "w4")}).empty()) << "another building";
  const auto found = overlaps({moved(0, "w1.w2", "w1"), moved(side / 2, "w1.w3", "w1")});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].first, "w1.w2");
  EXPECT_THAT(found[0].detail, testing::StartsWith("601 overlaps w1.w3: "));
}

TEST(Documentation, ListsEveryFindingAndEveryNumber) {
  std::ifstream file(BLOCKRAND_SOURCE_DIR "/docs/validate.md");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  ASSERT_FALSE(text.empty());
  for (const CheckInfo& c : kChecks) {
    const std::string row = fmt::format("| `{}` | {} |\n", c.text, c.meaning);
    EXPECT_NE(text.find(row), std::string::npos) << "docs/validate.md lacks the row " << row;
  }
  for (const geometry::SolidDefectInfo& d : geometry::kSolidDefects) {
    if (d.number == 0) continue;
    const std::string row = fmt::format("| {} | {} | {} |\n", d.number, d.name, d.meaning);
    EXPECT_NE(text.find(row), std::string::npos) << "docs/validate.md lacks the row " << row;
  }
}

TEST(Compare, OrderAndFirstPointsDoNotMatter) {
  const std::string a = "a", b = "b";
  const Contents x = contents_of(cube());
  ReadSolid turned = cube();
  std::reverse(turned.polygons.begin(), turned.polygons.end());
  for (ReadPolygon& p : turned.polygons) std::rotate(p.rings[0].begin(), p.rings[0].begin() + 1, p.rings[0].end());
  std::vector<Finding> findings;
  compare_polygons({x, a}, {contents_of(turned), b}, findings);
  EXPECT_THAT(codes(findings), testing::IsEmpty());
}

TEST(Compare, FindsEachDifference) {
  const std::string a = "a", b = "b";
  const Contents x = contents_of(cube());
  const auto found = [&](const auto& change) {
    ReadSolid other = cube();
    change(other);
    std::vector<Finding> findings;
    compare_polygons({x, a}, {contents_of(other), b}, findings);
    return codes(findings);
  };
  using testing::ElementsAre;
  EXPECT_THAT(found([](ReadSolid& s) { s.polygons[1].rings[0][2].z += 1.0 / 1024; }), ElementsAre("GEOMETRY_DIFFERS"));
  EXPECT_THAT(found([](ReadSolid& s) { s.polygons.pop_back(); }), ElementsAre("GEOMETRY_DIFFERS"));
  EXPECT_THAT(found([](ReadSolid& s) { s.polygons[1].kind = "wall"; }), ElementsAre("GEOMETRY_DIFFERS"));
  EXPECT_THAT(found([](ReadSolid& s) { s.polygons[1].colour = "#112234"; }), ElementsAre("COLOUR_DIFFERS"));
  EXPECT_THAT(found([](ReadSolid& s) { s.lod = 2; }), ElementsAre("GEOMETRY_DIFFERS", "GEOMETRY_DIFFERS"));
  EXPECT_THAT(found([](ReadSolid& s) { std::reverse(s.polygons[1].rings[0].begin(), s.polygons[1].rings[0].end()); }),
              ElementsAre("GEOMETRY_DIFFERS"));
}

/// The cube's faces as two triangles each.
Glb mesh_of(const ReadSolid& solid) {
  Glb glb;
  glb.readable = true;
  glb.contents = contents_of({});
  glb.contents.bodies[0].solids.clear();
  glb.triangles.emplace_back();
  for (const ReadPolygon& p : solid.polygons) {
    const auto& r = p.rings[0];
    glb.triangles[0].push_back({{r[0], r[1], r[2]}, {0x11, 0x22, 0x33}});
    glb.triangles[0].push_back({{r[0], r[2], r[3]}, {0x11, 0x22, 0x33}});
  }
  return glb;
}

TEST(Compare, MeshesByCornersVolumeAndColour) {
  const std::string a = "a";
  const Contents x = contents_of(cube());
  const ToLocal same = [](std::span<const Point3> in, std::span<Point3> out) {
    std::copy(in.begin(), in.end(), out.begin());
  };
  const auto found = [&](const Glb& glb) {
    std::vector<Finding> findings;
    compare_meshes({x, a}, glb, "b", same, 1e-3, false, findings);
    return codes(findings);
  };
  using testing::ElementsAre;
  EXPECT_THAT(found(mesh_of(cube())), testing::IsEmpty());
  Glb moved = mesh_of(cube());
  for (GlbTriangle& t : moved.triangles[0])
    for (Point3& p : t.corners) p.x += 0.0005;
  EXPECT_THAT(found(moved), testing::IsEmpty()) << "half a millimetre is rounding";
  for (GlbTriangle& t : moved.triangles[0])
    for (Point3& p : t.corners) p.x += 0.001;
  EXPECT_THAT(found(moved), ElementsAre("GEOMETRY_DIFFERS"));
  Glb turned = mesh_of(cube());
  for (GlbTriangle& t : turned.triangles[0]) std::swap(t.corners[0], t.corners[1]);
  EXPECT_THAT(found(turned), ElementsAre("GEOMETRY_DIFFERS")) << "the volume is negative";
  Glb gap = mesh_of(cube());
  gap.triangles[0].pop_back();
  EXPECT_THAT(found(gap), testing::Not(testing::IsEmpty()));
  Glb painted = mesh_of(cube());
  painted.triangles[0][0].colour = {255, 0, 0};
  EXPECT_THAT(found(painted), ElementsAre("COLOUR_DIFFERS"));
  Glb empty = mesh_of(cube());
  empty.triangles[0].clear();
  EXPECT_THAT(found(empty), ElementsAre("GEOMETRY_DIFFERS"));
}

TEST(Positions, OnlyClearCornersAndTheSameEachTime) {
  const std::vector<model::Location> ring = {{110300000, 514700000},
                                             {110301000, 514700000},
                                             {110302000, 514700001},  // on a straight wall
                                             {110302000, 514701000},
                                             {110300000, 514701000}};
  PositionSampler one, two;
  one.add("w1", ring);
  two.add("w1", ring);
  const PositionSample a = std::move(one).finish("x"), b = std::move(two).finish("x");
  ASSERT_EQ(a.corners.at("w1").size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(a.corners.at("w1")[i].rank, b.corners.at("w1")[i].rank);
}

PositionSample sampled(std::initializer_list<const char*> ids) {
  PositionSample sample;
  for (const char* id : ids) sample.corners[id] = {{{110300000, 514700000}, 1, 8}, {{110300000, 514700000}, 2, 0.5}};
  return sample;
}

TEST(Positions, WhatTheBuildSaysOfRepairBoundsCorners) {
  PositionSample sample = sampled({"w1", "w2", "w3", "w4", "w5"});
  bound_positions(sample, {{"w1", {0, false}}, {"w2", {0.31, false}}, {"w3", {0.2, true}}}, {"w2", "w4"}, 0);
  EXPECT_EQ(sample.reach.count("w1"), 0u) << "agrees to the millimetre";
  EXPECT_DOUBLE_EQ(sample.reach.at("w2"), 0.3105) << "as written, in millimetres";
  EXPECT_FALSE(sample.corners.contains("w3")) << "an overlap was cut off: corners may be gone";
  EXPECT_FALSE(sample.corners.contains("w4")) << "moved, and nobody says how far";
  EXPECT_TRUE(sample.corners.contains("w5"));
  EXPECT_EQ(sample.reach.size(), 1u);
  EXPECT_EQ(sample.corners.at("w2").size(), 1u) << "the flat one may lie in a straight wall now";
  EXPECT_EQ(sample.corners.at("w1").size(), 2u);
}

TEST(Positions, WithoutRecordsTheLargestShiftBoundsCorners) {
  PositionSample sample = sampled({"w1", "w4"});
  bound_positions(sample, {}, {"w4"}, 0.31);
  EXPECT_DOUBLE_EQ(sample.reach.at("w1"), 0.3105);
  EXPECT_FALSE(sample.corners.contains("w4"));
}

/// Offsets of `buildings` buildings with four corners each, a share of which repair moved by up to 0.3 m to and fro; all
/// shifted by `common` to the east.
std::vector<std::pair<std::string, model::Point2>> offsets(int buildings, double moved, double common) {
  std::vector<std::pair<std::string, model::Point2>> out;
  std::uint64_t state = 11;
  const auto random = [&] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state >> 11) / 9007199254740992.0;
  };
  for (int b = 0; b < buildings; ++b) {
    const bool is_moved = random() < moved;
    for (int i = 0; i < 4; ++i)
      out.emplace_back("w" + std::to_string(1000 + b),
                       is_moved ? model::Point2{common + random() * 0.6 - 0.3, random() * 0.6 - 0.3}
                                : model::Point2{common, 0.0004});
  }
  return out;
}

TEST(Positions, FiveCentimetresOfEverythingAreFoundAmongRepairs) {
  for (const double moved : {0.0, 0.4, 0.9}) {
    const CommonShift sound = common_shift(offsets(250, moved, 0)), shifted = common_shift(offsets(250, moved, 0.05));
    EXPECT_EQ(sound.buildings, 250u);
    EXPECT_LT(std::hypot(sound.median.x, sound.median.y), 0.01 + sound.uncertainty) << moved;
    EXPECT_GT(std::hypot(shifted.median.x, shifted.median.y), 0.01 + shifted.uncertainty) << moved;
    EXPECT_NEAR(shifted.median.x - sound.median.x, 0.05, 1e-9);
  }
  EXPECT_EQ(common_shift({}).buildings, 0u);
}

TEST(Positions, ManyAreThinnedByRankNotByOrder) {
  const auto sample = [](bool backwards) {
    PositionSampler sampler;
    for (int i = 0; i < 40000; ++i) {
      const int n = backwards ? 39999 - i : i;
      const std::int32_t x = 110000000 + n * 3000;
      sampler.add("w" + std::to_string(n),
                  {{x, 514700000}, {x + 2000, 514700000}, {x + 2000, 514702000}, {x, 514702000}});
    }
    return std::move(sampler).finish("x");
  };
  const PositionSample a = sample(false), b = sample(true);
  std::size_t count = 0;
  for (const auto& [id, corners] : a.corners) {
    count += corners.size();
    EXPECT_TRUE(b.corners.count(id));
  }
  EXPECT_EQ(count, kSampled);
  EXPECT_EQ(a.corners.size(), b.corners.size());
}

TEST(TilesetReader, DeepNestingEnds) {
  std::string text = R"({"asset":{"version":"1.1"},"geometricError":1,"root":)";
  for (int i = 0; i < 2000; ++i)
    text += R"({"geometricError":0,"refine":"ADD","boundingVolume":{"sphere":[0,0,0,1e8]},"children":[)";
  text += "{}";
  for (int i = 0; i < 2000; ++i) text += "]}";
  text += "}";
  EXPECT_FALSE(read_tileset(text, "t").findings.empty());
}

}  // namespace
}  // namespace blockrand::validate
