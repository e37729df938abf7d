// Our own LoD3, read as anybody's: CityJSON has the windows and doors of CityGML.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "importers/reference/read_model.h"
#include "pipeline/outputs/citygml/citygml_writer.h"
#include "pipeline/outputs/cityjson/cityjson_writer.h"
#include "tests/unit/outputs/facade_region.h"

namespace blockrand::importers::reference {
namespace {

namespace fs = std::filesystem;

struct Counted {
  int windows = 0, doors = 0, walls_with_openings = 0;
  std::size_t lod3_faces = 0;
  friend bool operator==(const Counted&, const Counted&) = default;
};

/// By building.
std::map<std::string, Counted> counted(const std::string& path) {
  ReadOptions options;
  options.reference_crs = "EPSG:25833";
  const ReferenceModel m = read_model(path, options);
  std::map<std::string, Counted> out;
  for (const Building& b : m.buildings) {
    Counted& c = out[b.id];
    for (const Surface& s : b.surfaces) {
      for (const Opening& o : s.openings) (o.door ? c.doors : c.windows) += 1;
      c.walls_with_openings += !s.openings.empty();
    }
    for (const Geometry& g : b.geometries)
      if (g.lod == 3 && g.kind == GeometryKind::solid) c.lod3_faces += g.faces.size();
    EXPECT_EQ(b.implicit_geometries, 0u) << b.id << " in " << path;
  }
  return out;
}

TEST(OwnDetail, CityJsonHasTheOpeningsOfCityGml) {
  const auto s = outputs::test::facade_region();
  const fs::path folder = fs::temp_directory_path() / ("blockrand_own_detail_" + std::to_string(getpid()));
  fs::create_directories(folder);
  outputs::CityGmlOptions gml;
  gml.lod = 3;
  gml.srs_name = "urn:ogc:def:crs:EPSG::25833";
  outputs::CityJsonOptions json;
  json.lod = 3;
  json.crs_code = "EPSG:25833";
  std::ofstream(folder / "a.gml", std::ios::binary) << outputs::write_citygml(s.region(), gml);
  std::ofstream(folder / "a.city.jsonl", std::ios::binary) << outputs::write_cityjson_sequence(s.region(), json);
  const auto a = counted((folder / "a.gml").string()), b = counted((folder / "a.city.jsonl").string());
  fs::remove_all(folder);
  EXPECT_EQ(a.size(), s.region().buildings.size());
  ASSERT_EQ(a.size(), b.size());
  for (const model::Building& building : s.region().buildings) {
    const Counted &x = a.at(building.id()), &y = b.at(building.id());
    int windows = 0, doors = 0;
    for (const auto& part : building.parts)
      for (const model::Opening& o : part.lod3.openings) (o.kind == model::OpeningKind::door ? doors : windows) += 1;
    EXPECT_EQ(x.windows, windows);
    EXPECT_EQ(y.windows, windows);
    EXPECT_EQ(x.doors, doors);
    EXPECT_EQ(y.doors, doors);
    EXPECT_EQ(x.walls_with_openings, y.walls_with_openings);
    EXPECT_EQ(x.lod3_faces, y.lod3_faces);
  }
}

}  // namespace
}  // namespace blockrand::importers::reference
