// The multipolygon test grid of osm-testdata (Jochen Topf, public domain), from the file through the importer to valid
// polygons.
#include <geos_c.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "pipeline/footprints/repair/rings.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "tests/unit/importers/osm/support.h"

namespace blockrand::repair {
namespace {

namespace fs = std::filesystem;
using importers::osm::test::read_bytes;
using importers::osm::test::TempFolder;

/// m per unit of 1e-7 degrees, a whole number of grid steps: the test's shapes are some hundred metres large.
constexpr double kScale = 8 / 1024.0;

double area_of_wkt(const std::string& wkt) {
  GEOSContextHandle_t context = GEOS_init_r();
  GEOSWKTReader* reader = GEOSWKTReader_create_r(context);
  GEOSGeometry* geometry = GEOSWKTReader_read_r(context, reader, wkt.c_str());
  double area = 0;
  GEOSArea_r(context, geometry, &area);
  GEOSGeom_destroy_r(context, geometry);
  GEOSWKTReader_destroy_r(context, reader);
  GEOS_finish_r(context);
  return area * 1e14 * kScale * kScale;
}

model::MappedRings rings_of(const model::Extract& e, model::Range range) {
  model::MappedRings out;
  for (const auto& mapped : e.rings_of(range)) {
    model::Ring ring;
    for (const auto p : e.vertices_of(mapped)) ring.points.push_back({p.lon * kScale, p.lat * kScale});
    const auto nodes = e.nodes_of(mapped);
    ring.nodes.assign(nodes.begin(), nodes.end());
    out.rings.push_back(std::move(ring));
    out.inner.push_back(mapped.inner);
  }
  return out;
}

/// Do the areas equal those of the expectation, to 1e-6 of their size?
bool matches(const nlohmann::json& expected, const std::vector<double>& ours) {
  std::vector<double> wanted;
  for (const auto& area : expected)
    if (area["wkt"] != "INVALID") wanted.push_back(area_of_wkt(area["wkt"]));
  std::sort(wanted.begin(), wanted.end());
  return std::equal(wanted.begin(), wanted.end(), ours.begin(), ours.end(),
                    [](double a, double b) { return std::fabs(a - b) <= 1e-6 * a; });
}

/// Cases whose areas are in none of the grid's expectations, which call them invalid: what is built all the same.
const std::map<int, const char*> kBuiltAllTheSame = {
    {710, "two outer rings overlap: united"},
    {740, "the outer ring crosses itself: both loops"},
    {746, "two ways that cannot be one area, kept as mapped"},
    {768, "two overlapping ways: united"},
    {771, "outer rings touch without a common node: as valid as it gets"},
    {773, "inner rings touch without a common node: as valid as it gets"},
    {900, "neither relation nor way has a tag beside the test's own: nothing is kept"},
};

TEST(Multipolygons, All130CasesOfTheGridSurvive) {
  const fs::path grid = fs::path(BLOCKRAND_SHARED_DIR) / "data/osm/multipolygon-testdata/grid/data";
  if (!fs::exists(grid)) GTEST_SKIP() << "no test grid at " << grid;
  const TempFolder folder;
  int cases = 0, compared = 0, areas_seen = 0;
  std::vector<int> others;
  for (const auto& category : fs::directory_iterator(grid)) {
    if (!category.is_directory()) continue;
    for (const auto& entry : fs::directory_iterator(category.path())) {
      if (!entry.is_directory()) continue;
      const int id = std::stoi(entry.path().filename().string());
      SCOPED_TRACE(id);
      ++cases;
      std::string xml = read_bytes((entry.path() / "data.osm").string());
      const std::string plain = "k=\"area\" v=\"yes\"";
      for (auto at = xml.find(plain); at != std::string::npos; at = xml.find(plain, at))
        xml.replace(at, plain.size(), "k=\"landuse\" v=\"forest\"");
      const model::Extract e = importers::osm::read_extract(folder.write("data.osm", xml));
      std::vector<double> areas;
      bool said_why = false;
      const auto take = [&](model::OsmId object, model::Range range) {
        model::Report report;
        // The grid's edges are kilometres long: two centimetres beside one are more than a millionth of the area.
        RepairOptions options;
        options.simplify = false;
        const RepairedRings r = repair_rings(rings_of(e, range), object, {}, options, report);
        EXPECT_EQ(r.failure, model::IssueCode::none) << object.text();
        double area = 0;
        for (const auto& p : r.polygons) {
          EXPECT_TRUE(geometry::strictly_simple(p)) << object.text();
          area += geometry::area(p);
        }
        areas.push_back(area);
        for (const auto& row : report.rows) said_why = said_why || row.code == model::IssueCode::ring_repaired;
      };
      for (const auto& b : e.buildings)
        if (b.rings.count > 0) take(b.id, b.rings);
      for (const auto& f : e.features)
        if (f.area) take(f.id, f.rings);
      for (const auto& row : e.report.rows) said_why = said_why || row.code == model::IssueCode::relation_repaired;
      areas_seen += static_cast<int>(areas.size());
      std::sort(areas.begin(), areas.end());
      std::ifstream in(entry.path() / "test.json");
      const nlohmann::json test = nlohmann::json::parse(in);
      if (!test.contains("areas")) continue;
      ++compared;
      bool expected = false;
      for (const auto& [name, list] : test["areas"].items()) expected = expected || matches(list, areas);
      if (expected) continue;
      others.push_back(id);
      EXPECT_TRUE(kBuiltAllTheSame.contains(id)) << areas.size() << " areas";
      EXPECT_TRUE(said_why || areas.empty()) << "no row tells what was done";
    }
  }
  EXPECT_EQ(cases, 130);
  EXPECT_EQ(compared, 102);
  EXPECT_EQ(areas_seen, 99);
  EXPECT_EQ(others.size(), kBuiltAllTheSame.size());
}

}  // namespace
}  // namespace blockrand::repair
