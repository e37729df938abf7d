// A build read back through each of its formats: the same buildings, footprints, volumes and corners.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <unordered_map>

#include "importers/reference/footprints.h"
#include "importers/reference/read_model.h"
#include "pipeline/base/progress.h"
#include "pipeline/run/build.h"
#include "tests/unit/importers/reference/level_of_detail.h"

namespace blockrand::importers::reference::test {
namespace {

namespace fs = std::filesystem;
using model::Point3;

/// A Building or part as every format tells it.
struct Told {
  std::string parent;
  double area = 0, volume = 0;  ///< m²; m³ of the highest level
  std::optional<double> height;
  std::vector<Point3> corners;  ///< of the highest level
};

/// Six times the volume under a face, against a point near the building.
double cone(const Polygon3& p, bool reversed, const Point3& o) {
  double sum = 0;
  const auto fan = [&](const std::vector<Point3>& ring) {
    const auto d = [&](std::size_t i) { return Point3{ring[i].x - o.x, ring[i].y - o.y, ring[i].z - o.z}; };
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      const Point3 a = d(0), b = d(i), c = d(i + 1);
      sum += a.x * (b.y * c.z - b.z * c.y) - a.y * (b.x * c.z - b.z * c.x) + a.z * (b.x * c.y - b.y * c.x);
    }
  };
  fan(p.outer);
  for (const auto& hole : p.holes) fan(hole);
  return reversed ? -sum : sum;
}

using Town = std::map<std::string, Told>;

void add(const ReferenceModel& m, Town& town) {
  const auto footprints = ground_footprints(m);
  for (const Footprint2D& f : footprints) town[m.buildings[f.building].id].area = f.area;
  for (const Building& b : m.buildings) {
    Told& told = town[b.id];
    if (b.parent >= 0) told.parent = m.buildings[static_cast<std::size_t>(b.parent)].id;
    told.height = b.measured_height;
    for (const Geometry& g : b.geometries) {
      if (g.lod != lod_of(b) || g.kind == GeometryKind::footprint) continue;
      const Point3 o = m.polygons[g.faces[0].polygon].outer[0];
      for (const Face& f : g.faces) {
        const Polygon3& p = m.polygons[f.polygon];
        told.volume += cone(p, f.reversed, o) / 6;
        told.corners.insert(told.corners.end(), p.outer.begin(), p.outer.end());
      }
    }
  }
}

Town read_town(const std::string& path, const std::string& format, const ReadOptions& options = {}) {
  Town town;
  for (const std::string& file : model_files(path)) {
    const ReferenceModel m = read_model(file, options);
    EXPECT_TRUE(m.format.starts_with(format)) << m.format;
    EXPECT_EQ(m.breaches(), 0u) << file;
    EXPECT_EQ(m.crs.height_reference, HeightReference::above_local_ground) << m.crs.height_words;
    EXPECT_EQ(m.bytes == 0, false);
    add(m, town);
  }
  return town;
}

/// m from a corner to the nearest one of the other.
double distance(const std::vector<Point3>& from, const std::vector<Point3>& to) {
  std::vector<Point3> sorted = to;
  std::sort(sorted.begin(), sorted.end());
  double furthest = 0;
  for (const Point3& p : from) {
    constexpr double kReach = 0.01;
    double nearest = kReach;
    for (auto q = std::lower_bound(sorted.begin(), sorted.end(), Point3{p.x - kReach, -1e9, -1e9});
         q != sorted.end() && q->x <= p.x + kReach; ++q)
      nearest = std::min(nearest, std::hypot(p.x - q->x, p.y - q->y, p.z - q->z));
    furthest = std::max(furthest, nearest);
  }
  return furthest;
}

/// \param reach  m that a corner may lie off: formats round differently
void expect_same(const Town& a, const Town& b, double reach) {
  ASSERT_EQ(a.size(), b.size());
  double furthest = 0, solids = 0;
  for (auto i = a.begin(), j = b.begin(); i != a.end(); ++i, ++j) {
    ASSERT_EQ(i->first, j->first);
    const Told &p = i->second, &q = j->second;
    EXPECT_EQ(p.parent, q.parent) << i->first;
    const double side = std::sqrt(std::max(1.0, p.area));
    EXPECT_NEAR(p.area, q.area, 8 * side * reach + 0.05) << i->first;
    ASSERT_EQ(p.corners.empty(), q.corners.empty()) << i->first;
    // A GLB has no row for a building of several parts.
    if (p.corners.empty()) continue;
    EXPECT_EQ(p.height.has_value(), q.height.has_value()) << i->first;
    EXPECT_NEAR(p.height.value_or(0), q.height.value_or(0), 1e-3) << i->first;
    EXPECT_NEAR(p.volume, q.volume, 5e-5 * p.volume + 8 * p.area * reach + 0.05) << i->first;
    EXPECT_GE(p.volume, 0) << i->first;
    furthest = std::max({furthest, distance(p.corners, q.corners), distance(q.corners, p.corners)});
    ++solids;
  }
  EXPECT_LT(furthest, reach);
  testing::Test::RecordProperty("solids", static_cast<int>(solids));
  testing::Test::RecordProperty("furthest_um", static_cast<int>(furthest * 1e6));
}

/// Builds an extract and reads it five ways.
void expect_same_in_all_formats(const fs::path& input, std::size_t least, bool gzip,
                                std::optional<std::array<double, 4>> bbox = {}) {
  const fs::path folder = fs::temp_directory_path() / ("blockrand-reference-" + std::to_string(::getpid()));
  struct Gone {
    fs::path path;
    ~Gone() { fs::remove_all(path); }
  } gone{folder};
  run::BuildOptions options;
  options.input = input.string();
  options.output = folder.string();
  options.configs = BLOCKRAND_SOURCE_DIR "/configs";
  options.lod = 2;
  options.outputs.formats = {"gltf", "citygml", "cityjson"};
  options.outputs.report = options.outputs.explain = false;
  options.outputs.profile = outputs::AttributeProfile::all;  // people get rounded heights
  options.outputs.single_glb = options.outputs.single_cityjson = true;
  options.outputs.gzip = gzip;
  options.bbox = bbox;
  options.jobs = 2;
  options.force = true;
  base::Progress quiet;
  run::build(options, quiet);
  const auto in = [&](const char* name) { return (folder / name).string(); };

  const Town gml = read_town(folder.string(), "CityGML 2.0");
  EXPECT_GE(gml.size(), least);
  constexpr double kGml = 1e-4, kGltf = 1e-3;  // four decimals; floats, and steps of 1/4096 m
  {
    SCOPED_TRACE("CityJSON sequences");
    expect_same(gml, read_town(in("cityjson"), "CityJSON sequence 2.0"), kGml);
  }
  {
    SCOPED_TRACE("one CityJSON document");
    expect_same(gml, read_town(in("model.city.json"), "CityJSON 2.0"), kGml);
  }
  {
    SCOPED_TRACE("tileset");
    expect_same(gml, read_town(in("tileset.json"), "3D Tiles 1.1"), kGltf);
  }
  {
    SCOPED_TRACE("GLB after GLB");
    expect_same(gml, read_town(in("tiles"), "glTF 2.0"), kGltf);
  }
  {
    SCOPED_TRACE("one GLB");
    expect_same(gml, read_town(in("model.glb"), "glTF 2.0"), kGltf);
  }
}

TEST(Builds, TheSampleIsTheSameInAllFormats) {
  expect_same_in_all_formats(fs::path(BLOCKRAND_SOURCE_DIR) / "samples/blockrand-viertel.osm", 150, false);
}

TEST(Builds, ARealQuarterIsTheSameInAllFormats) {
  const fs::path input = fs::path(BLOCKRAND_SHARED_DIR) / "data/osm/berlin-pariser-platz-2014.osm.pbf";
  if (!fs::exists(input)) GTEST_SKIP() << "no " << input;
  expect_same_in_all_formats(input, 3000, true);
}

TEST(Builds, OldTownHousesAreTheSameInAllFormats) {
  const fs::path input = fs::path(BLOCKRAND_SHARED_DIR) / "data/osm/husum_altstadt.osm.pbf";
  if (!fs::exists(input)) GTEST_SKIP() << "no " << input;
  expect_same_in_all_formats(input, 600, false);
}

}  // namespace
}  // namespace blockrand::importers::reference::test
