// Vector files as plain polygons.
#include "importers/polygons/read_polygons.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "pipeline/base/error.h"

namespace blockrand::importers::polygons {
namespace {

using testing::HasSubstr;

class ReadPolygons : public testing::Test {
 protected:
  ReadPolygons() : folder_(std::filesystem::temp_directory_path() / ("blockrand-vector-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~ReadPolygons() override { std::filesystem::remove_all(folder_); }
  std::string place(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  static std::string error_of(const std::string& path, const VectorChoice& choice = {}) {
    try {
      read_polygons(path, choice);
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "no error";
  }
  std::filesystem::path folder_;
};

std::string square(double x, double y, double size, const std::string& properties) {
  const auto p = [](double u, double v) { return "[" + std::to_string(u) + "," + std::to_string(v) + "]"; };
  return R"({"type":"Feature","properties":{)" + properties + R"(},"geometry":{"type":"Polygon","coordinates":[[)" +
         p(x, y) + "," + p(x + size, y) + "," + p(x + size, y + size) + "," + p(x, y + size) + "," + p(x, y) + "]]}}";
}
std::string collection(const std::string& features, const std::string& crs = "") {
  return R"({"type":"FeatureCollection",)" +
         (crs.empty() ? "" : R"("crs":{"type":"name","properties":{"name":")" + crs + "\"}},") + "\"features\":[" +
         features + "]}";
}

TEST_F(ReadPolygons, GivesRingsAndAttributesAndChoosesByThem) {
  const std::string file = place("a.geojson", collection(square(12, 51, 0.1, R"("name":"north","n":1)") + "," +
                                                         square(13, 51, 0.1, R"("name":"south","n":2)")));
  const auto all = read_polygons(file);
  ASSERT_EQ(all.size(), 2u);
  ASSERT_EQ(all[0].polygons.size(), 1u);
  EXPECT_EQ(all[0].polygons[0][0].size(), 4u) << "the first point is not repeated";
  EXPECT_EQ(all[0].polygons[0][0][0], (model::Location{120000000, 510000000}));
  EXPECT_EQ(all[0].attributes[0], (std::pair<std::string, std::string>{"name", "north"}));
  const auto chosen = read_polygons(file, {"", {{"name", "south"}}});
  ASSERT_EQ(chosen.size(), 1u);
  EXPECT_EQ(chosen[0].polygons[0][0][0].lon, 130000000);
}

TEST_F(ReadPolygons, BringsOtherSystemsToWgs84) {
  const std::string file =
      place("utm.geojson", collection(square(390000, 5820000, 100, ""), "urn:ogc:def:crs:EPSG::25833"));
  const auto all = read_polygons(file);
  EXPECT_NEAR(all[0].polygons[0][0][0].lon_degrees(), 13.380, 0.02);
  EXPECT_NEAR(all[0].polygons[0][0][0].lat_degrees(), 52.52, 0.02);
}

TEST_F(ReadPolygons, PartsThatOverlapStayPolygonsOfTheirOwn) {
  const std::string file =
      place("m.geojson",
            collection(R"({"type":"Feature","properties":{},"geometry":{"type":"MultiPolygon","coordinates":[)"
                       "[[[12,51],[14,51],[14,53],[12,53],[12,51]]],[[[13,52],[15,52],[15,54],[13,54],[13,52]]]]}}"));
  const auto all = read_polygons(file);
  ASSERT_EQ(all.size(), 1u);
  ASSERT_EQ(all[0].polygons.size(), 2u);
  EXPECT_EQ(all[0].polygons[1].size(), 1u);
}

TEST_F(ReadPolygons, AFileThatBreaksOffIsRefused) {
  std::string lines;
  for (int i = 0; i < 2000; ++i) lines += square(12 + 0.001 * i, 51, 0.001, "\"n\":" + std::to_string(i)) + "\n";
  const std::string whole = collection([&] {
    std::string list = lines;
    list.pop_back();
    std::replace(list.begin(), list.end(), '\n', ',');
    return list;
  }());
  EXPECT_EQ(read_polygons(place("whole.geojson", whole)).size(), 2000u);
  EXPECT_EQ(read_polygons(place("whole.geojsonl", lines)).size(), 2000u);
  EXPECT_THAT(error_of(place("broken.geojson", whole.substr(0, whole.size() / 2))), HasSubstr("GDAL"));
  EXPECT_THAT(error_of(place("broken.geojsonl", lines.substr(0, lines.size() - 40))), HasSubstr("GDAL"));
  std::string gml =
      "<?xml version=\"1.0\"?><f:FeatureCollection xmlns:f=\"http://f\" xmlns:gml=\"http://www.opengis.net/gml\">";
  for (int i = 0; i < 500; ++i)
    gml +=
        "<gml:featureMember><f:a><f:g><gml:Polygon "
        "srsName=\"EPSG:25832\"><gml:outerBoundaryIs><gml:LinearRing><gml:coordinates>"
        "400000,5700000 400100,5700000 400100,5700100 "
        "400000,5700000</gml:coordinates></gml:LinearRing></gml:outerBoundaryIs>"
        "</gml:Polygon></f:g></f:a></gml:featureMember>";
  EXPECT_THAT(error_of(place("broken.gml", gml.substr(0, gml.size() - 300))), HasSubstr("GDAL"));
}

TEST_F(ReadPolygons, SaysWhatIsWrongAndWhatToDo) {
  const std::string file = place("a.geojson", collection(square(12, 51, 0.1, R"("name":"north")")));
  EXPECT_THAT(error_of((folder_ / "none.geojson").string()), HasSubstr("does not exist"));
  EXPECT_THAT(error_of(place("b.txt", "hello")), HasSubstr("no vector file"));
  EXPECT_THAT(error_of(file, {"b", {}}), HasSubstr("no such layer"));
  EXPECT_THAT(error_of(file, {"", {{"nmae", "north"}}}), HasSubstr("Did you mean name"));
  EXPECT_THAT(error_of(file, {"", {{"name", "west"}}}), HasSubstr("no polygon with these attributes"));
  EXPECT_THAT(error_of(place(
                  "p.geojson",
                  collection(R"({"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,2]}})"))),
              HasSubstr("holds no polygon"));
}

}  // namespace
}  // namespace blockrand::importers::polygons
