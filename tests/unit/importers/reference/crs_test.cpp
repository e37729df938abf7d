// Where a file says it lies, and the trap of which coordinate comes first.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "importers/reference/affine_transform.h"
#include "importers/reference/reference_crs.h"
#include "pipeline/base/error.h"
#include "pipeline/georef/crs_facts.h"
#include "pipeline/georef/proj_transform.h"
#include "tests/unit/importers/reference/support.h"

namespace blockrand::importers::reference::test {
namespace {

using model::Point3;
using testing::HasSubstr;

struct Name {
  const char *text, *horizontal, *vertical;
  bool authority_order;
};
class SrsNames : public testing::TestWithParam<Name> {};

TEST_P(SrsNames, AreTakenApart) {
  const SrsName parsed = parse_srs_name(GetParam().text);
  EXPECT_EQ(parsed.horizontal, GetParam().horizontal);
  EXPECT_EQ(parsed.vertical, GetParam().vertical);
  EXPECT_EQ(parsed.authority_order, GetParam().authority_order);
}

INSTANTIATE_TEST_SUITE_P(
    Forms, SrsNames,
    testing::Values(Name{"EPSG:25833", "EPSG:25833", "", false}, Name{" epsg:25833 ", "EPSG:25833", "", false},
                    Name{"25833", "EPSG:25833", "", false}, Name{"EPSG:3068", "EPSG:3068", "", false},
                    Name{"EPSG:25832+5783", "EPSG:25832", "EPSG:5783", false},
                    Name{"EPSG:25832+EPSG:5783", "EPSG:25832", "EPSG:5783", false},
                    Name{"urn:ogc:def:crs:EPSG::25833", "EPSG:25833", "", true},
                    Name{"urn:ogc:def:crs:EPSG:6.9:4326", "EPSG:4326", "", true},
                    Name{"urn:x-ogc:def:crs:EPSG:4326", "EPSG:4326", "", true},
                    Name{"urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783", "EPSG:25832", "EPSG:5783", true},
                    Name{"urn:ogc:def:crs,crs:EPSG:6.12:3068,crs:EPSG:6.12:5783", "EPSG:3068", "EPSG:5783", true},
                    Name{"urn:ogc:def:crs:OGC:1.3:CRS84", "OGC:CRS84", "", true},
                    Name{"http://www.opengis.net/def/crs/EPSG/0/6697", "EPSG:6697", "", true},
                    Name{"http://www.opengis.net/gml/srs/epsg.xml#25832", "EPSG:25832", "", false},
                    Name{"http://www.opengis.net/def/crs-compound?1=http://www.opengis.net/def/crs/EPSG/0/"
                         "25832&2=http://www.opengis.net/def/crs/EPSG/0/7837",
                         "EPSG:25832", "EPSG:7837", true},
                    Name{"urn:adv:crs:ETRS89_UTM32", "EPSG:25832", "", false},
                    Name{"urn:adv:crs:ETRS89_UTM33*DE_DHHN2016_NH", "EPSG:25833", "EPSG:7837", false},
                    Name{"urn:adv:crs:DE_DHDN_3GK4*DE_DHHN92_NH", "EPSG:31468", "EPSG:5783", false},
                    Name{"ETRS89 / UTM zone 32N", "ETRS89 / UTM zone 32N", "", false}, Name{"", "", "", false}));

TEST(CrsFacts, TellWhatTheDatabaseSays) {
  const auto utm = georef::crs_facts("EPSG:25833");
  ASSERT_TRUE(utm);
  EXPECT_EQ(utm->name, "ETRS89 / UTM zone 33N");
  EXPECT_TRUE(utm->projected && !utm->geographic && !utm->north_first);
  EXPECT_EQ(utm->metres_per_unit, 1);
  ASSERT_TRUE(utm->area);
  EXPECT_NEAR(utm->area->west, 12, 0.1);
  EXPECT_TRUE(georef::crs_facts("EPSG:31467")->north_first);
  EXPECT_TRUE(georef::crs_facts("EPSG:4326")->north_first);
  EXPECT_TRUE(georef::crs_facts("EPSG:4326")->geographic);
  EXPECT_FALSE(georef::crs_facts("OGC:CRS84")->north_first);
  EXPECT_NEAR(georef::crs_facts("EPSG:2263")->metres_per_unit, 0.3048006, 1e-6);
  EXPECT_EQ(georef::crs_facts("EPSG:5555")->vertical_code, "EPSG:5783");
  EXPECT_EQ(georef::crs_facts("EPSG:5555")->authority_code, "EPSG:25832");
  EXPECT_FALSE(georef::crs_facts("EPSG:5783"));  // heights alone
  EXPECT_FALSE(georef::crs_facts("EPSG:4978"));  // earth-centred
  EXPECT_FALSE(georef::crs_facts("no such thing"));
}

/// A triangle whose first corner has these coordinates in the file.
ReferenceModel triangle(const std::string& srs, double first, double second, double step = 10,
                        const ReadOptions& options = {}) {
  const auto at = [&](double a, double b) {
    return std::to_string(first + a * step) + " " + std::to_string(second + b * step) + " 30 ";
  };
  std::string points = at(0, 0) + at(1, 0) + at(0, 1);
  points.pop_back();
  return read(document(building("b", surface("GroundSurface", polygon(points))), srs), options);
}

TEST(AxisOrder, UtmIsEastFirstUnlessOnlyTheOtherFits) {
  const auto usual = triangle("urn:ogc:def:crs:EPSG::25833", 390000, 5820000);
  EXPECT_EQ(usual.crs.axis_order, AxisOrder::east_first);
  EXPECT_EQ(usual.polygons[0].outer[0], (Point3{390000, 5820000, 30}));
  EXPECT_EQ(usual.count(NoteKind::crs), 0u);
  const auto swapped = triangle("EPSG:25833", 5820000, 390000);
  EXPECT_EQ(swapped.crs.axis_order, AxisOrder::north_first);
  EXPECT_EQ(swapped.polygons[0].outer[0], (Point3{390000, 5820000, 30}));
  EXPECT_EQ(swapped.count(NoteKind::crs), 1u);
}

TEST(AxisOrder, GeographicOnesGoByTheForm) {
  // Both orders lie somewhere on Earth: only the form can tell.
  const auto urn = triangle("urn:ogc:def:crs:EPSG::4326", 48.75, 11.5, 1e-4);
  EXPECT_EQ(urn.crs.axis_order, AxisOrder::north_first);
  EXPECT_TRUE(urn.crs.geographic);
  EXPECT_EQ(urn.polygons[0].outer[0], (Point3{11.5, 48.75, 30}));
  const auto plain = triangle("EPSG:4326", 11.5, 48.75, 1e-4);
  EXPECT_EQ(plain.crs.axis_order, AxisOrder::east_first);
  EXPECT_EQ(plain.polygons[0].outer[0], (Point3{11.5, 48.75, 30}));
  const auto crs84 = triangle("urn:ogc:def:crs:OGC:1.3:CRS84", 11.5, 48.75, 1e-4);
  EXPECT_EQ(crs84.polygons[0].outer[0], (Point3{11.5, 48.75, 30}));
  // A latitude of 139 degrees there is not.
  const auto japan = triangle("http://www.opengis.net/def/crs/EPSG/0/6697", 139.75, 35.68, 1e-4);
  EXPECT_EQ(japan.polygons[0].outer[0], (Point3{139.75, 35.68, 30}));
  const auto japan_right = triangle("http://www.opengis.net/def/crs/EPSG/0/6697", 35.68, 139.75, 1e-4);
  EXPECT_EQ(japan_right.polygons[0].outer[0], (Point3{139.75, 35.68, 30}));
  EXPECT_EQ(japan_right.count(NoteKind::crs), 0u);
}

TEST(AxisOrder, GaussKrueger) {
  for (const bool north_first : {false, true}) {
    const auto m = north_first ? triangle("EPSG:31468", 5403000, 4457000) : triangle("EPSG:31468", 4457000, 5403000);
    EXPECT_EQ(m.polygons[0].outer[0], (Point3{4457000, 5403000, 30}));
  }
}

TEST(AxisOrder, WhereBothFitThePlaceDecides) {
  // Near the origin of Soldner's system for Berlin both orders lie in the city.
  const auto usual = triangle("urn:ogc:def:crs:EPSG::3068", 23000, 21000);
  EXPECT_EQ(usual.crs.axis_order, AxisOrder::east_first);
  EXPECT_EQ(usual.count(NoteKind::crs), 1u);
  ReadOptions options;
  options.near = extent_of(usual);
  ASSERT_TRUE(options.near);
  const auto near = triangle("urn:ogc:def:crs:EPSG::3068", 23000, 21000, 10, options);
  EXPECT_EQ(near.crs.axis_order, AxisOrder::east_first);
  EXPECT_EQ(near.count(NoteKind::crs), 0u);
  const auto turned = triangle("EPSG:3068", 21000, 23000, 10, options);
  EXPECT_EQ(turned.crs.axis_order, AxisOrder::north_first);
  EXPECT_EQ(turned.polygons[0].outer[0], (Point3{23000, 21000, 30}));
  ReadOptions forced;
  forced.axis_order = AxisOrder::north_first;
  EXPECT_EQ(triangle("EPSG:25833", 390000, 5820000, 10, forced).polygons[0].outer[0], (Point3{5820000, 390000, 30}));
}

TEST(AxisOrder, OutsideOfTheAreaIsNoted) {
  const auto m = triangle("EPSG:25833", 10, 20);  // a local system under a borrowed name
  ASSERT_EQ(m.notes.size(), 1u);
  EXPECT_THAT(m.notes[0].examples[0], HasSubstr("outside of the area of use"));
}

TEST(Crs, SeveralInOneFile) {
  const std::string other = "<bldg:lod1MultiSurface><gml:MultiSurface srsName=\"SRS\"><gml:surfaceMember>" +
                            polygon("390000 5820000 30 390001 5820000 30 390001 5820001 30") +
                            "</gml:surfaceMember></gml:MultiSurface></bldg:lod1MultiSurface>";
  const auto with = [&](const std::string& srs) {
    std::string text = other;
    return read(document(building("b", text.replace(text.find("SRS"), 3, srs))));
  };
  EXPECT_EQ(with("urn:ogc:def:crs:EPSG::25833").count(NoteKind::mixed_crs), 0u);
  EXPECT_EQ(with("ETRS89 / UTM zone 33N").count(NoteKind::mixed_crs), 0u);
  EXPECT_EQ(with("EPSG:25832").count(NoteKind::mixed_crs), 1u);
}

TEST(Transform, MatchesProjAndKeepsHeights) {
  auto m = triangle("EPSG:25832", 678145.778, 5403919.12);
  const georef::GeoBox area{11.3, 48.6, 11.6, 48.9};
  georef::ProjTransform from("EPSG:25832", area), to("EPSG:25833", area);
  const model::Point2 expected = to.forward(from.inverse({678145.778, 5403919.12}));
  const TransformFacts facts = transform_to(m, "EPSG:25833");
  EXPECT_EQ(facts.accuracy_m, 0);
  EXPECT_NEAR(m.polygons[0].outer[0].x, expected.x, 1e-3);
  EXPECT_NEAR(m.polygons[0].outer[0].y, expected.y, 1e-3);
  EXPECT_EQ(m.polygons[0].outer[0].z, 30);
  EXPECT_EQ(m.crs.horizontal, "EPSG:25833");
}

TEST(Transform, FromDegreesAndAcrossDatums) {
  auto degrees = triangle("urn:ogc:def:crs:EPSG::4258", 48.75, 11.5, 1e-4);
  georef::ProjTransform proj_transform("EPSG:25832", {11.4, 48.6, 11.6, 48.9});
  const model::Point2 expected = proj_transform.forward({11.5, 48.75});
  transform_to(degrees, "EPSG:25832");
  EXPECT_NEAR(degrees.polygons[0].outer[0].x, expected.x, 1e-3);
  EXPECT_NEAR(degrees.polygons[0].outer[0].y, expected.y, 1e-3);
  EXPECT_FALSE(degrees.crs.geographic);
  auto old = triangle("EPSG:3068", 23000, 21000);
  const TransformFacts facts = transform_to(old, "EPSG:25833");
  EXPECT_GT(facts.accuracy_m, 0);  // a change of datum
  EXPECT_LE(facts.accuracy_m, 3);
  EXPECT_NEAR(old.polygons[0].outer[0].x, 389500, 3000);
  EXPECT_NEAR(old.polygons[0].outer[0].y, 5819500, 3000);
}

TEST(Transform, RefusesWhatIsNoPlaneInMetres) {
  auto m = triangle("EPSG:25832", 678145, 5403919);
  for (const char* target : {"EPSG:4326", "EPSG:2263", "nothing"})
    EXPECT_THROW(transform_to(m, target), base::UsageError) << target;
}

TEST(Transform, OfNothingNeedsNoSystem) {
  ReferenceModel empty;
  empty.path = "empty.gltf";
  EXPECT_EQ(transform_to(empty, "EPSG:25833").operation, "");
  EXPECT_EQ(empty.crs.horizontal, "EPSG:25833");
  EXPECT_FALSE(empty.crs.geographic);
  EXPECT_EQ(empty.crs.metres_per_unit, 1);
}

TEST(Transform, FaultsNameTheOptionsOfBothModels) {
  const std::string both = "--reference-crs (of the judged model: --model-crs)";
  const auto message = [](const auto& run) -> std::string {
    try {
      run();
      return "none";
    } catch (const std::exception& error) {
      return error.what();
    }
  };
  NoteLog notes;
  EXPECT_THAT(message([&] { decide_crs("a.gml", {}, {}, notes); }), HasSubstr(both));
  ReadOptions options;
  options.reference_crs = "EPSG:999999";
  EXPECT_THAT(message([&] { decide_crs("a.gml", {}, options, notes); }), HasSubstr(both + " EPSG:999999"));
  auto m = triangle("EPSG:25832", 678145, 5403919);
  m.polygons[0].outer[1].x = INFINITY;
  EXPECT_THAT(message([&] { transform_to(m, "EPSG:25833"); }), HasSubstr(both));
}

TEST(Heights, AreWhatTheFileSaysTheyAre) {
  const auto heights = [](const std::string& srs, const std::string& description = "") {
    std::string ground = "390000 5820000 30 390000 5820008 30 390010 5820008 30 390010 5820000 30";
    if (srs.ends_with("4979")) ground = "52.5 13.4 30 52.6 13.4 30 52.6 13.5 30";
    std::string xml = document(building("b", surface("GroundSurface", polygon(ground))), srs);
    xml.insert(xml.find("<gml:boundedBy>"), "<gml:description>" + description + "</gml:description>");
    return read(xml).crs.height_reference;
  };
  EXPECT_EQ(heights("EPSG:25833"), HeightReference::unknown);
  EXPECT_EQ(heights("urn:ogc:def:crs,crs:EPSG::25833,crs:EPSG::5783"), HeightReference::vertical_crs);
  EXPECT_EQ(heights("urn:ogc:def:crs:EPSG::4979"), HeightReference::ellipsoidal);
  EXPECT_EQ(heights("EPSG:25833", "CRS: x; heights: heights above local ground; data: y"),
            HeightReference::above_local_ground);
  EXPECT_EQ(heights("EPSG:25833", "heights: heights of the terrain raster, above sea level"),
            HeightReference::sea_level);
}

}  // namespace
}  // namespace blockrand::importers::reference::test
