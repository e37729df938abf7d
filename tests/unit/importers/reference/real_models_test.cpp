// Real models: every count against an independent one made by looking for tags in the text, every footprint against the
// map of its place. Skipped where the data is absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "importers/osm/read_extract.h"
#include "importers/reference/affine_transform.h"
#include "importers/reference/footprints.h"
#include "importers/reference/read_model.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/georef/projection.h"
#include "tests/unit/importers/reference/level_of_detail.h"
#include "tests/unit/importers/reference/support.h"

namespace blockrand::importers::reference::test {
namespace {

namespace fs = std::filesystem;
const fs::path kData = fs::path(BLOCKRAND_SHARED_DIR) / "data";

std::vector<fs::path> models_in(const std::string& folder) {
  std::vector<fs::path> out;
  if (!fs::exists(kData / "reference" / folder)) return out;
  for (const auto& entry : fs::recursive_directory_iterator(kData / "reference" / folder))
    if (entry.path().extension() == ".gml" || entry.path().extension() == ".xml") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// How often a tag with the local name opens, with any prefix; as grep counts, knowing nothing of XML.
/// \param with_text  only those followed by text: not <tag/>, not <tag></tag>
std::size_t tags(const std::string& text, const std::string& name, bool with_text = false) {
  std::size_t count = 0;
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const std::size_t after = at + name.size();
    if (after >= text.size() || (text[after] != ' ' && text[after] != '>' && text[after] != '/' && text[after] != '\n'))
      continue;
    std::size_t before = at;
    while (before > 0 && (std::isalnum(static_cast<unsigned char>(text[before - 1])) != 0 || text[before - 1] == '_'))
      --before;
    if (before > 0 && text[before - 1] == ':' && before == at) {
      --before;
      while (before > 0 && std::isalnum(static_cast<unsigned char>(text[before - 1])) != 0) --before;
    } else if (before != at) {
      continue;
    }
    if (before == 0 || text[before - 1] != '<') continue;
    if (with_text) {
      const std::size_t close = text.find('>', at);
      if (close == std::string::npos || text[close - 1] == '/' || text[close + 1] == '<') continue;
    }
    ++count;
  }
  return count;
}

/// What a model has, by the same names as the tags.
std::map<std::string, std::size_t> counts(const ReferenceModel& m) {
  std::map<std::string, std::size_t> c;
  for (const Building& b : m.buildings) {
    ++c[b.parent < 0 ? "Building" : "BuildingPart"];
    c["measuredHeight"] += b.measured_height.has_value();
    c["storeysAboveGround"] += b.storeys_above_ground.has_value();
    c["yearOfConstruction"] += b.year_of_construction.has_value();
    c["roofType"] += !b.roof_type.empty();
    for (const Geometry& g : b.geometries) c["Solid"] += g.kind == GeometryKind::solid;
    for (const Surface& s : b.surfaces) {
      for (const Geometry& g : s.geometries) c["Solid"] += g.kind == GeometryKind::solid;
      switch (s.surface_class) {
        case SurfaceClass::ground:
          ++c["GroundSurface"];
          break;
        case SurfaceClass::wall:
          ++c["WallSurface"];
          break;
        case SurfaceClass::roof:
          ++c["RoofSurface"];
          break;
        case SurfaceClass::closure:
          ++c["ClosureSurface"];
          break;
        case SurfaceClass::outer_ceiling:
          ++c["OuterCeilingSurface"];
          break;
        case SurfaceClass::outer_floor:
          ++c["OuterFloorSurface"];
          break;
        case SurfaceClass::interior_wall:
          ++c["InteriorWallSurface"];
          break;
        case SurfaceClass::installation:
          ++c["BuildingInstallation"];
          break;
        case SurfaceClass::floor:
        case SurfaceClass::ceiling:
        case SurfaceClass::room:
        case SurfaceClass::furniture:
        default:
          break;
      }
      for (const Opening& o : s.openings) ++c[o.door ? "Door" : "Window"];
    }
  }
  for (const Polygon3& p : m.polygons) c["interior"] += p.holes.size();
  c["Polygon"] = m.polygons.size();
  return c;
}

/// Every file of the folder: counts as the text has them.
void expect_counts(const fs::path& path, const ReferenceModel& m) {
  const std::string text = text_of(path);
  auto found = counts(m);
  for (const char* name : {"Building", "BuildingPart", "GroundSurface", "WallSurface", "RoofSurface", "ClosureSurface",
                           "OuterCeilingSurface", "OuterFloorSurface", "InteriorWallSurface", "BuildingInstallation",
                           "Window", "Door", "Solid"})
    EXPECT_EQ(found[name], tags(text, name)) << name;
  for (const char* name : {"measuredHeight", "storeysAboveGround", "yearOfConstruction", "roofType"})
    EXPECT_EQ(found[name], tags(text, name, true)) << name;
  if (m.other_objects.empty()) {
    EXPECT_EQ(found["Polygon"], tags(text, "Polygon"));
    EXPECT_EQ(found["interior"], tags(text, "interior"));
  }
  EXPECT_EQ(m.count(NoteKind::unresolved_link), 0u);
  EXPECT_EQ(m.count(NoteKind::malformed_xml), 0u);
  EXPECT_EQ(m.count(NoteKind::incomplete_building), 0u);
}

/// Area of all ground surfaces in m², from the numbers between the tags: outer rings less inner ones.
double ground_area(const std::string& text) {
  double sum = 0;
  for (std::size_t at = text.find("GroundSurface "); at != std::string::npos;
       at = text.find("GroundSurface ", at + 1)) {
    if (text[at - 1] != ':') continue;
    const std::string block = text.substr(at, text.find("GroundSurface>", at) - at);
    for (std::size_t list = block.find("<gml:posList"); list != std::string::npos;
         list = block.find("<gml:posList", list + 1)) {
      std::istringstream numbers(block.substr(block.find('>', list) + 1));
      std::vector<std::array<double, 2>> ring;
      for (double x = 0, y = 0, z = 0; numbers >> x >> y >> z;) ring.push_back({x, y});
      double twice = 0;
      for (std::size_t i = 0; i + 1 < ring.size(); ++i)
        twice += (ring[i][0] - ring[0][0]) * (ring[i + 1][1] - ring[0][1]) -
                 (ring[i + 1][0] - ring[0][0]) * (ring[i][1] - ring[0][1]);
      const bool inner = block.rfind("<gml:interior>", list) != std::string::npos &&
                         (block.rfind("</gml:interior>", list) == std::string::npos ||
                          block.rfind("<gml:interior>", list) > block.rfind("</gml:interior>", list));
      sum += (inner ? -0.5 : 0.5) * std::abs(twice);
    }
  }
  return sum;
}

/// An OSM extract as polygons of its buildings in a CRS.
struct Map {
  explicit Map(const fs::path& file) : extract(osm::read_extract(file.string())) {
    georef::GeoBox box{180, 90, -180, -90};
    for (const model::Location v : extract.vertices) {
      box.west = std::min(box.west, v.lon_degrees()), box.east = std::max(box.east, v.lon_degrees());
      box.south = std::min(box.south, v.lat_degrees()), box.north = std::max(box.north, v.lat_degrees());
    }
    extent = box;
    const georef::LonLat c = box.centre();
    crs = georef::choose_crs(c.lon, c.lat);
    const georef::Projection projection(georef::open_crs(crs, box), box);
    for (const auto& b : extract.buildings) {
      std::vector<model::Ring> rings;
      std::vector<bool> inner;
      for (const auto& r : extract.rings_of(b.rings)) {
        rings.emplace_back();
        inner.push_back(r.inner);
        for (const model::Location v : extract.vertices_of(r))
          rings.back().points.push_back(model::snap(projection.forward(v)));
        rings.back().nodes.assign(rings.back().points.size(), 0);
      }
      for (auto& p : geometry::make_valid(rings, inner, 0.01, 0.02).polygons) polygons.push_back(std::move(p));
    }
  }

  /// Area that a footprint shares with mapped buildings.
  double shared(const Footprint2D& f) const {
    std::vector<model::Polygon> near;
    for (const auto& p : polygons) {
      const auto overlaps = [&](const model::Polygon& q) {
        const auto [ax, bx] =
            std::minmax_element(p.outer.points.begin(), p.outer.points.end(), [](auto a, auto b) { return a.x < b.x; });
        const auto [cx, dx] =
            std::minmax_element(q.outer.points.begin(), q.outer.points.end(), [](auto a, auto b) { return a.x < b.x; });
        const auto [ay, by] =
            std::minmax_element(p.outer.points.begin(), p.outer.points.end(), [](auto a, auto b) { return a.y < b.y; });
        const auto [cy, dy] =
            std::minmax_element(q.outer.points.begin(), q.outer.points.end(), [](auto a, auto b) { return a.y < b.y; });
        return ax->x < dx->x && cx->x < bx->x && ay->y < dy->y && cy->y < by->y;
      };
      if (std::any_of(f.polygons.begin(), f.polygons.end(), overlaps)) near.push_back(p);
    }
    return geometry::common_area(f.polygons, near);
  }

  model::Extract extract;
  std::string crs;
  georef::GeoBox extent;
  std::vector<model::Polygon> polygons;
};

/// What a folder showed, for the test's record.
struct Totals {
  std::size_t buildings = 0, breaches = 0;
  double area = 0, shared = 0;
};

/// Reads a folder, compares counts, and lays every footprint on the map.
Totals lay_on_map(const std::string& folder, const Map& map) {
  Totals totals;
  for (const fs::path& path : models_in(folder)) {
    SCOPED_TRACE(path.filename());
    ReferenceModel m = read_citygml(path.string());
    expect_counts(path, m);
    if (const double expected = ground_area(text_of(path)); expected > 0) {
      double area = 0;
      for (const Footprint2D& f : ground_footprints(m)) area += f.area;
      EXPECT_LE(area, expected * 1.0001);  // the same, but for polygons of a building that overlap
      EXPECT_GE(area, expected * 0.99);
    }
    transform_to(m, map.crs);
    const auto extent = extent_of(m);
    EXPECT_TRUE(extent && extent->west >= map.extent.west && extent->east <= map.extent.east &&
                extent->south >= map.extent.south && extent->north <= map.extent.north);
    totals.breaches += m.breaches();
    for (const Footprint2D& f : ground_footprints(m)) {
      ++totals.buildings;
      EXPECT_GT(f.area, 0) << m.buildings[f.building].id;
      for (const auto& p : f.polygons) EXPECT_TRUE(geometry::strictly_simple(p)) << m.buildings[f.building].id;
      totals.area += f.area;
      totals.shared += map.shared(f);
    }
  }
  testing::Test::RecordProperty(folder + "_shared_percent", static_cast<int>(100 * totals.shared / totals.area));
  return totals;
}

TEST(RealModels, Ingolstadt) {
  if (models_in("ingolstadt-lod3").empty()) GTEST_SKIP() << "no reference/ingolstadt-lod3";
  const Map map(kData / "osm/ingolstadt-altstadt.osm");
  const Totals totals = lay_on_map("ingolstadt-lod3", map);
  EXPECT_EQ(totals.buildings, 27u);
  EXPECT_EQ(totals.breaches, 53470u);  // gml:ids that start with a digit: grep -ohE 'gml:id="[0-9][^"]*"' | wc -l
  EXPECT_GT(totals.shared / totals.area, 0.85);
}

TEST(RealModels, BerlinLod2) {
  if (models_in("berlin-lod2").empty()) GTEST_SKIP() << "no reference/berlin-lod2";
  const Map map(kData / "osm/berlin-mitte-2014.osm.pbf");
  const Totals totals = lay_on_map("berlin-lod2", map);
  EXPECT_EQ(totals.buildings, 158u);
  EXPECT_EQ(totals.breaches, 402u);  // gml:ids given twice in one file
  EXPECT_GT(totals.shared / totals.area, 0.85);
}

TEST(RealModels, PariserPlatz) {
  if (models_in("berlin-pariser-platz").empty()) GTEST_SKIP() << "no reference/berlin-pariser-platz";
  const Map map(kData / "osm/berlin-pariser-platz-2014.osm.pbf");
  const Totals totals = lay_on_map("berlin-pariser-platz", map);
  EXPECT_EQ(totals.buildings, 18u);
  EXPECT_EQ(totals.breaches, 0u);
  // On the map only if the axes are the right way round and the change of datum was made.
  EXPECT_GT(totals.shared / totals.area, 0.9);
}

TEST(RealModels, TheTextbookHouseInEveryLevel) {
  const auto files = models_in("fzk-haus");
  if (files.empty()) GTEST_SKIP() << "no reference/fzk-haus";
  for (const fs::path& path : files) {
    SCOPED_TRACE(path.filename());
    const ReferenceModel m = read_citygml(path.string());
    EXPECT_EQ(m.crs.horizontal, "EPSG:25832");
    expect_counts(path, m);
    const auto footprints = ground_footprints(m);
    ASSERT_EQ(footprints.size(), 1u);
    // "Building": 10 m x 5 m in all levels; with its garage 10 m² more. "FZK-House": 12 m x 10 m.
    const std::string name = path.filename().string();
    const double expected = name.find("FZK") == 0 ? 120 : name.find("garage") != std::string::npos ? 60 : 50;
    EXPECT_NEAR(footprints[0].area, expected, 0.01);
    const std::size_t level = name.find("LOD");
    if (level != std::string::npos) {
      EXPECT_EQ(lod_of(m.buildings[0]), name[level + 3] - '0');
    }
  }
}

TEST(RealModels, LevelFourHasItsRoomsInside) {
  const fs::path path = kData / "reference/fzk-haus/Building_LOD4-EPSG25832.gml";
  if (!fs::exists(path)) GTEST_SKIP() << "no " << path;
  const ReferenceModel m = read_model(path.string());
  std::map<std::string, std::size_t> inside, outside;
  for (const Surface& s : m.buildings[0].surfaces)
    ++(s.interior ? inside : outside)[std::string(name_of(s.surface_class))];
  EXPECT_EQ(outside, (std::map<std::string, std::size_t>{{"ground", 1}, {"roof", 2}, {"wall", 4}}));
  EXPECT_EQ(inside, (std::map<std::string, std::size_t>{
                        {"ceiling", 2}, {"floor", 1}, {"furniture", 1}, {"interior_wall", 4}, {"room", 1}}));
}

TEST(RealModels, DenHaag) {
  const fs::path path = kData / "reference/cityjson/DenHaag_01.json";
  if (!fs::exists(path)) GTEST_SKIP() << "no " << path;
  const ReferenceModel m = read_model(path.string());
  EXPECT_EQ(m.format, "CityJSON 1.0");
  EXPECT_EQ(m.bytes, fs::file_size(path));
  EXPECT_EQ(m.crs.horizontal, "EPSG:28992");
  EXPECT_EQ(m.crs.vertical, "EPSG:5709");
  EXPECT_EQ(m.crs.height_reference, HeightReference::vertical_crs);
  EXPECT_EQ(m.breaches(), 0u);
  // Counted once more, straight from the text.
  const auto json = nlohmann::json::parse(text_of(path));
  std::size_t buildings = 0, parts = 0, solids = 0, polygons = 0;
  std::map<std::string, std::size_t> classes;
  for (const auto& object : json["CityObjects"]) {
    if (object["type"] != "Building" && object["type"] != "BuildingPart") continue;
    ++(object["type"] == "Building" ? buildings : parts);
    for (const auto& geometry : object["geometry"]) {
      ++solids;
      for (const auto& shell : geometry["boundaries"]) polygons += shell.size();
      for (const auto& s : geometry["semantics"]["surfaces"]) ++classes[s["type"]];
    }
  }
  const auto found = counts(m);
  EXPECT_EQ(found.at("Building"), buildings);
  EXPECT_EQ(found.at("BuildingPart"), parts);
  EXPECT_EQ(found.at("Solid"), solids);
  EXPECT_EQ(found.at("Polygon"), polygons);
  for (const auto& [name, count] : classes) EXPECT_EQ(found.at(name), count) << name;
  EXPECT_THAT(m.other_objects, testing::ElementsAre(testing::Pair("TINRelief", 1u)));
  const auto extent = extent_of(m);
  ASSERT_TRUE(extent);
  EXPECT_TRUE(extent->west > 4.2 && extent->east < 4.3 && extent->south > 52.09 && extent->north < 52.12);
}

TEST(RealModels, EveryBuildingHasGeometryAndAFootprint) {
  if (!fs::exists(kData / "reference")) GTEST_SKIP() << "no reference";
  std::map<std::string, std::size_t> buildings;
  for (const std::string& path : model_files((kData / "reference").string())) {
    SCOPED_TRACE(path);
    const ReferenceModel m = read_model(path);
    EXPECT_FALSE(m.crs.horizontal.empty());
    EXPECT_EQ(m.bytes, fs::file_size(path));
    for (const Building& b : m.buildings) EXPECT_EQ(b.implicit_geometries, 0u) << b.id;
    for (const Footprint2D& f : ground_footprints(m)) {
      EXPECT_GT(f.area, 0) << m.buildings[f.building].id;
      ++buildings[m.format];
    }
  }
  EXPECT_EQ(buildings, (std::map<std::string, std::size_t>{
                           {"CityGML 0.4", 18}, {"CityGML 1.0", 237}, {"CityGML 2.0", 148}, {"CityJSON 1.0", 844}}));
}

/// The document with the first two of every three coordinates swapped.
std::string with_swapped_axes(const std::string& text) {
  std::string out;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t open = text.find('<', at), close = text.find('>', at);
    if (close == std::string::npos) break;
    const std::string tag = text.substr(open, close - open);
    out += text.substr(at, close + 1 - at);
    at = close + 1;
    if (tag.find("<gml:pos") != 0 && tag.find("Corner") == std::string::npos) continue;
    if (tag.find("/gml") != std::string::npos) continue;
    const std::size_t end = text.find('<', at);
    std::istringstream numbers(text.substr(at, end - at));
    for (std::string x, y, z; numbers >> x >> y >> z;) out += y + " " + x + " " + z + "\n";
    at = end;
  }
  return out;
}

TEST(RealModels, AreTheSameWhereverTheAxesStand) {
  const auto files = models_in("fzk-haus");
  if (files.empty()) GTEST_SKIP() << "no reference/fzk-haus";
  for (const fs::path& path : files) {
    SCOPED_TRACE(path.filename());
    const ReferenceModel m = read_citygml(path.string()), swapped = read(with_swapped_axes(text_of(path)));
    EXPECT_EQ(swapped.crs.axis_order, AxisOrder::north_first);
    EXPECT_EQ(swapped.count(NoteKind::outside_envelope), m.count(NoteKind::outside_envelope));
    ASSERT_EQ(m.polygons.size(), swapped.polygons.size());
    for (std::size_t i = 0; i < m.polygons.size(); ++i) {
      EXPECT_EQ(m.polygons[i].outer, swapped.polygons[i].outer);
      EXPECT_EQ(m.polygons[i].holes, swapped.polygons[i].holes);
    }
  }
}

}  // namespace
}  // namespace blockrand::importers::reference::test
