#include "pipeline/surroundings/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "pipeline/base/error.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/base/toml_file.h"

namespace blockrand::surroundings {
namespace {

using model::GroundClass;
using model::ObjectShape;
using model::Point3;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kFile = std::string(BLOCKRAND_SOURCE_DIR) + "/configs/surroundings.toml";

const Catalogue& shipped() {
  static const Catalogue read(kFile);
  return read;
}

using Tags = std::map<std::string, std::string, std::less<>>;

TagOf tag_of(const Tags& tags) {
  return [&tags](std::string_view key) -> std::string_view {
    const auto found = tags.find(key);
    return found == tags.end() ? std::string_view() : std::string_view(found->second);
  };
}

ChosenShape choose(std::string_view kind, const Tags& tags, double random = 0.5) {
  return choose_shape(shipped(), kind, tag_of(tags), [random](std::string_view) { return random; });
}
const ObjectShape& shape_of(const ChosenShape& chosen) { return shipped().shown().shapes[chosen.shape]; }
double height_of(const ChosenShape& chosen) { return chosen.height * shape_of(chosen).max.z; }
double width_of(const ChosenShape& chosen) {
  const ObjectShape& s = shape_of(chosen);
  return chosen.width * std::max(s.max.x - s.min.x, s.max.y - s.min.y);
}

std::size_t triangles(const ObjectShape& shape) {
  std::size_t n = 0;
  for (const auto& part : shape.parts) n += part.corners.size() / 3;
  return n;
}

const GroundRule* ground(const Tags& tags) { return shipped().ground_of(tag_of(tags)); }
const ObjectRule* object(const Tags& tags, bool area = false) { return shipped().object_of(tag_of(tags), area); }

TEST(SurroundingCatalogue, HoldsWhatCodeAndOtherRowsAskFor) {
  const Catalogue& c = shipped();
  EXPECT_EQ(c.sha256().size(), 64U);
  std::set<std::string> names;
  for (const auto& m : c.shown().materials) {
    EXPECT_TRUE(names.insert(m.name).second) << m.name;
    EXPECT_EQ(c.shown().materials[c.material(m.name)].name, m.name);
  }
  for (const char* name : {"asphalt", "paving_stones", "grass", "land", "yard", "kerb_stone", "ballast", "rail_steel",
                           "water", "marking_white", "hedge", "stone", "wood", "metal", "concrete", "brick"})
    EXPECT_TRUE(names.contains(name)) << name;
  EXPECT_EQ(c.shown().materials.front().name, "land");  // in the order of the file
  EXPECT_EQ(c.surface("sett"), c.material("sett"));
  EXPECT_EQ(c.surface("unhewn_cobblestone"), c.material("cobblestone"));
  EXPECT_EQ(c.surface("asphalt;gravel"), c.material("asphalt"));
  EXPECT_EQ(c.surface("grade2"), c.material("compacted"));
  EXPECT_EQ(c.surface("cheese"), std::nullopt);
}

TEST(SurroundingCatalogue, KnowsWhereVehiclesKeepToTheLeft) {
  const auto left = [](double lon, double lat) {
    return shipped().keeps_left(
        {static_cast<std::int32_t>(std::lround(lon * 1e7)), static_cast<std::int32_t>(std::lround(lat * 1e7))});
  };
  const std::pair<double, double> lefts[] = {
      {-76.8, 18.0},    {-77.35, 25.06}, {-59.6, 13.1},  {-61.5, 10.65}, {-58.16, 6.8},   {113.54, 22.19},
      {57.5, -20.16},   {178.4, -18.1},  {-0.13, 51.51}, {-8.63, 52.66}, {-5.93, 54.6},   {1.31, 51.13},
      {-2.1, 49.19},    {14.51, 35.9},   {33.36, 35.17}, {139.7, 35.68}, {141.35, 43.06}, {114.17, 22.32},
      {100.5, 13.75},   {98.99, 18.79},  {103.85, 1.29}, {106.85, -6.2}, {151.2, -33.87}, {115.86, -31.95},
      {174.76, -36.85}, {170.5, -45.87}, {77.21, 28.61}, {79.86, 6.93},  {90.4, 23.8},    {67.0, 24.87},
      {73.05, 33.68},   {36.82, -1.29},  {28.05, -26.2}, {32.58, 0.35},  {32.57, -25.97}};
  for (const auto& [lon, lat] : lefts) EXPECT_TRUE(left(lon, lat)) << lon << ", " << lat;
  const std::pair<double, double> rights[] = {
      {-82.37, 23.1}, {-78.3, 21.9},   {-52.3, 4.9},   {113.58, 22.27}, {-66.9, 10.5},   {13.4, 52.5},
      {7.42, 43.73},  {1.85, 50.95},   {2.35, 48.86},  {-9.14, 38.71},  {-1.62, 49.64},  {4.9, 52.37},
      {28.96, 41.01}, {126.98, 37.57}, {114.06, 22.6}, {102.6, 17.98},  {104.92, 11.56}, {121.0, 14.6},
      {69.2, 34.5},   {96.16, 16.8},   {13.23, -8.84}, {30.06, -1.95},  {45.34, 2.04},   {-74, 40.7}};
  for (const auto& [lon, lat] : rights) EXPECT_FALSE(left(lon, lat)) << lon << ", " << lat;
}

TEST(SurroundingCatalogue, HasMeasuresOfStreets) {
  const Catalogue& c = shipped();
  EXPECT_EQ(c.street("motorway").width, 12);
  // Where vehicles go from one to the other, there is no step across.
  for (const char* highway : {"motorway", "residential", "living_street", "service", "track"})
    EXPECT_TRUE(c.street(highway).kerbed) << highway;
  EXPECT_TRUE(c.ground_of([](std::string_view key) {
                 return key == "amenity" ? std::string_view("parking") : std::string_view();
               })->kerbed);
  EXPECT_FALSE(c.street("footway").kerbed);
  EXPECT_GT(c.street("primary").width, c.street("residential").width);
  EXPECT_GT(c.street("residential").pavement, 0);
  EXPECT_EQ(&c.street("what_nobody_maps"), &c.street("other"));
  EXPECT_NE(&c.street("residential"), &c.street("other"));
  for (const char* highway : {"trunk", "secondary", "tertiary", "unclassified", "living_street", "service", "track",
                              "path", "footway", "cycleway", "steps", "pedestrian", "motorway_link"})
    EXPECT_NE(&c.street(highway), &c.street("other")) << highway;
}

TEST(SurroundingCatalogue, TellsGroundsByTheFirstRowThatFits) {
  EXPECT_EQ(ground({{"leisure", "park"}})->ground, GroundClass::grass);
  EXPECT_GT(ground({{"leisure", "park"}})->trees_per_hectare, 0);
  EXPECT_EQ(ground({{"landuse", "forest"}})->ground, GroundClass::wood);
  EXPECT_EQ(ground({{"natural", "water"}, {"landuse", "grass"}})->ground, GroundClass::water);
  EXPECT_EQ(ground({{"highway", "pedestrian"}, {"place", "square"}})->ground, GroundClass::square);
  EXPECT_EQ(ground({{"amenity", "parking"}})->ground, GroundClass::parking);
  EXPECT_EQ(ground({{"amenity", "parking"}, {"parking", "street_side"}})->ground, GroundClass::parking_lane);
  EXPECT_EQ(ground({{"amenity", "parking"}, {"parking", "underground"}}), nullptr);
  EXPECT_EQ(ground({{"leisure", "pitch"}, {"sport", "tennis"}})->material, "clay");
  EXPECT_EQ(ground({{"leisure", "pitch"}, {"sport", "soccer; basketball"}})->material, "tartan");
  EXPECT_EQ(ground({{"leisure", "pitch"}, {"sport", "soccer"}})->material, "lawn");
  EXPECT_EQ(ground({{"sport", "tennis"}}), nullptr);
  EXPECT_EQ(ground({{"area:highway", "emergency"}})->ground, GroundClass::carriageway);
  EXPECT_EQ(ground({{"area:highway", "no"}}), nullptr);
  for (const char* use : {"residential", "commercial", "retail", "industrial", "military"})
    EXPECT_EQ(ground({{"landuse", use}}), nullptr) << use;
  EXPECT_EQ(ground({{"man_made", "bridge"}}), nullptr);
  EXPECT_EQ(ground({}), nullptr);
}

TEST(SurroundingCatalogue, TellsObjectsByTheFirstRowThatFits) {
  EXPECT_EQ(object({{"natural", "tree"}})->kind, "tree");
  EXPECT_EQ(object({{"highway", "bus_stop"}, {"public_transport", "platform"}})->kind, "bus_stop");
  EXPECT_EQ(object({{"highway", "bus_stop"}, {"shelter", "yes"}})->kind, "bus_shelter");
  EXPECT_EQ(object({{"highway", "bus_stop"}, {"shelter", "no"}})->kind, "bus_stop");
  EXPECT_EQ(object({{"power", "generator"}, {"generator:source", "wind"}})->kind, "wind_turbine");
  EXPECT_EQ(object({{"power", "generator"}, {"generator:source", "solar"}})->kind, "");
  EXPECT_EQ(object({{"emergency", "fire_hydrant"}})->kind, "fire_hydrant");
  EXPECT_EQ(object({{"emergency", "fire_hydrant"}, {"fire_hydrant:type", "underground"}})->kind, "");
  EXPECT_EQ(object({{"historic", "memorial"}, {"memorial", "stolperstein"}})->kind, "");
  EXPECT_EQ(object({{"historic", "memorial"}, {"memorial", "bust"}})->kind, "statue");
  EXPECT_EQ(object({{"traffic_sign", "DE:274"}})->kind, "traffic_sign");
  EXPECT_EQ(object({{"playground", "slide"}})->kind, "playground_slide");
  EXPECT_EQ(object({{"playground", "swing"}}, true)->kind, "playground_swing");
  EXPECT_EQ(object({{"playground", "sandpit"}})->kind, "playground_sandpit");
  EXPECT_EQ(object({{"playground", "sandpit"}}, true)->kind, "") << "it has ground of its own";
  EXPECT_EQ(object({{"playground", "map"}})->kind, "");
  EXPECT_EQ(object({{"traffic_sign", "no"}}), nullptr);
  EXPECT_EQ(object({{"amenity", "restaurant"}}), nullptr);
  EXPECT_EQ(object({{"natural", "tree"}}, true), nullptr);
  EXPECT_EQ(object({{"amenity", "fountain"}}, true)->kind, "fountain");
}

TEST(SurroundingCatalogue, EveryKindOfARuleHasAShapeAndEveryShapeARule) {
  base::TomlTable file = base::TomlTable::read(kFile);
  std::set<std::string> asked;
  std::size_t rules = 0;
  for (base::TomlTable& row : file.tables("object")) {
    const auto kind = row.text("kind");
    ASSERT_TRUE(kind.has_value());
    if (kind->empty()) continue;
    EXPECT_FALSE(shipped().shapes_of(*kind).empty()) << *kind;
    asked.insert(*kind);
    ++rules;
  }
  EXPECT_GT(rules, 80U);
  for (const ObjectShape& shape : shipped().shown().shapes) EXPECT_TRUE(asked.contains(shape.kind)) << shape.kind;
  EXPECT_TRUE(shipped().shapes_of("unicorn").empty());
}

// Wires hang on the shape, on both sides alike: their line may come from either side.
TEST(SurroundingShapes, HoldWiresWhereTheyReach) {
  for (const char* kind : {"power_pole", "power_tower", "power_portal", "aerialway_pylon"})
    for (const std::uint16_t s : shipped().shapes_of(kind)) {
      const ObjectShape& shape = shipped().shown().shapes[s];
      const auto& wires = shipped().wires_of(s);
      EXPECT_FALSE(wires.empty()) << shape.name;
      for (const auto& [across, up] : wires) {
        EXPECT_LE(std::fabs(across), shape.max.y + 0.01) << shape.name;
        EXPECT_LE(up, shape.max.z + 0.4) << shape.name;
        EXPECT_NE(std::find(wires.begin(), wires.end(), std::pair(-across, up)), wires.end()) << shape.name;
      }
    }
  EXPECT_TRUE(shipped().wires_of(shipped().shapes_of("bench").front()).empty());
}

TEST(SurroundingShapes, StandOnTheGroundWithoutFlatTriangles) {
  std::set<std::string> names;
  for (const ObjectShape& shape : shipped().shown().shapes) {
    SCOPED_TRACE(shape.name);
    EXPECT_TRUE(names.insert(shape.name).second);
    ASSERT_FALSE(shape.parts.empty());
    Point3 min{1e9, 1e9, 1e9}, max{-1e9, -1e9, -1e9};
    std::set<model::SurroundingMaterial> materials;
    for (const auto& part : shape.parts) {
      EXPECT_LT(part.material, shipped().shown().materials.size());
      EXPECT_TRUE(materials.insert(part.material).second);
      ASSERT_EQ(part.corners.size() % 3, 0U);
      for (std::size_t i = 0; i < part.corners.size(); i += 3) {
        const Point3 a = part.corners[i], b = part.corners[i + 1], c = part.corners[i + 2];
        const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
        const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
        EXPECT_GT(std::sqrt(nx * nx + ny * ny + nz * nz), 1e-4) << i;
      }
      for (const Point3 p : part.corners) {
        EXPECT_EQ(p, model::snap(p));
        min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
        max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
      }
    }
    EXPECT_EQ(shape.min, min);
    EXPECT_EQ(shape.max, max);
    EXPECT_LE(min.z, 0.1);
    EXPECT_GE(min.z, -0.15);
    EXPECT_GT(max.z, 0.25);  // the frame of a sandpit
    EXPECT_TRUE(min.x < 0 && max.x > 0 && min.y < 0 && max.y > 0) << "the foot is not within";
  }
}

// Six times the volume between the middle of a shape and its triangles: a negative one would be inside out.
TEST(SurroundingShapes, AreSeenFromOutside) {
  for (const ObjectShape& shape : shipped().shown().shapes) {
    const Point3 middle{(shape.min.x + shape.max.x) / 2, (shape.min.y + shape.max.y) / 2,
                        (shape.min.z + shape.max.z) / 2};
    double six_volumes = 0;
    for (const auto& part : shape.parts)
      for (std::size_t i = 0; i < part.corners.size(); i += 3) {
        Point3 c[3];
        for (std::size_t j = 0; j < 3; ++j) {
          const Point3 p = part.corners[i + j];
          c[j] = {p.x - middle.x, p.y - middle.y, p.z - middle.z};
        }
        six_volumes += c[0].x * (c[1].y * c[2].z - c[1].z * c[2].y) - c[0].y * (c[1].x * c[2].z - c[1].z * c[2].x) +
                       c[0].z * (c[1].x * c[2].y - c[1].y * c[2].x);
      }
    EXPECT_GT(six_volumes, 0) << shape.name;
  }
}

// Every edge of a crown is that of two of its triangles, in opposite senses.
TEST(SurroundingShapes, CrownsAreClosed) {
  for (const ObjectShape& shape : shipped().shown().shapes) {
    if (shape.kind != "tree" && shape.kind != "shrub") continue;
    for (const auto& part : shape.parts) {
      if (shipped().shown().materials[part.material].name == "bark") continue;
      std::map<std::pair<Point3, Point3>, int> edges;
      for (std::size_t i = 0; i < part.corners.size(); i += 3)
        for (std::size_t j = 0; j < 3; ++j) ++edges[{part.corners[i + j], part.corners[i + (j + 1) % 3]}];
      for (const auto& [edge, n] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        ASSERT_NE(back, edges.end()) << shape.name;
        EXPECT_EQ(back->second, n) << shape.name;
      }
    }
  }
}

TEST(SurroundingShapes, HaveFewTriangles) {
  const auto most = [](const ObjectShape& shape) -> std::size_t {
    const std::string& kind = shape.kind;
    if (shape.name.starts_with("tree_conifer")) return 50;
    if (kind == "tree") return 60;
    if (kind == "street_lamp" || kind == "bench") return 40;
    if (kind == "bollard") return 20;
    if (kind.ends_with("_sign") || kind == "bus_stop" || kind == "city_limit") return 16;
    if (kind == "wind_turbine" || kind == "power_tower") return 120;
    return 100;
  };
  for (const ObjectShape& shape : shipped().shown().shapes) {
    EXPECT_LE(triangles(shape), most(shape)) << shape.name;
    EXPECT_LE(shape.parts.size(), 5U) << shape.name;
  }
}

TEST(ChooseShape, KnowsTheHabitOfSpecies) {
  const auto name = [](const Tags& tags) { return shape_of(choose("tree", tags)).name; };
  EXPECT_THAT(name({}), StartsWith("tree_broadleaved"));
  EXPECT_THAT(name({{"leaf_type", "needleleaved"}}), StartsWith("tree_conifer"));
  EXPECT_THAT(name({{"species", "Picea abies"}}), StartsWith("tree_conifer"));
  EXPECT_THAT(name({{"genus", "Pinus"}, {"leaf_type", "broadleaved"}}), StartsWith("tree_conifer"));
  EXPECT_THAT(name({{"taxon", "Larix decidua"}, {"leaf_cycle", "deciduous"}}), StartsWith("tree_conifer"));
  EXPECT_THAT(name({{"species", "Tilia cordata"}}), StartsWith("tree_broadleaved"));
  EXPECT_THAT(name({{"genus", "Quercus"}, {"leaf_cycle", "evergreen"}}), StartsWith("tree_broadleaved"));
  EXPECT_THAT(name({{"leaf_cycle", "evergreen"}}), StartsWith("tree_conifer"));
  EXPECT_THAT(name({{"species", "Populus nigra 'Italica'"}}), StartsWith("tree_columnar"));
  EXPECT_THAT(name({{"genus", "Populus"}, {"species", "Populus nigra var. italica"}}), StartsWith("tree_columnar"));
  EXPECT_THAT(name({{"genus", "Quercus"}, {"taxon", "Quercus robur Fastigiata"}}), StartsWith("tree_columnar"));
  EXPECT_THAT(name({{"species", "Cupressus sempervirens"}}), StartsWith("tree_cypress"));
  EXPECT_THAT(name({{"genus", "Phoenix"}}), StartsWith("tree_palm"));
  EXPECT_THAT(name({{"leaf_type", "palm"}}), StartsWith("tree_palm"));
  EXPECT_THAT(name({{"species", "Fichte"}, {"leaf_type", "needleleaved"}}), StartsWith("tree_conifer"));
  const Tags mixed = {{"leaf_type", "mixed"}};
  EXPECT_THAT(shape_of(choose("tree", mixed, 0.1)).name, StartsWith("tree_conifer"));
  EXPECT_THAT(shape_of(choose("tree", mixed, 0.9)).name, StartsWith("tree_broadleaved"));
}

TEST(ChooseShape, GivesTreesTheMeasuresThatAreTagged) {
  for (const char* height : {"3", "7.5", "12 m", "17", "31"}) {
    const ChosenShape chosen = choose("tree", {{"height", height}});
    EXPECT_NEAR(height_of(chosen), std::stod(height), 1e-3) << height;
  }
  EXPECT_EQ(shape_of(choose("tree", {{"height", "6"}})).name, "tree_broadleaved_small");
  EXPECT_EQ(shape_of(choose("tree", {{"height", "24"}})).name, "tree_broadleaved_large");
  EXPECT_NEAR(width_of(choose("tree", {{"height", "15"}, {"diameter_crown", "9"}})), 9, 1e-3);
  EXPECT_NEAR(width_of(choose("tree", {{"diameter_crown", "4"}})), 4, 1e-3);
  EXPECT_LT(height_of(choose("tree", {{"diameter_crown", "4"}})), 10);
  // A height that no tree has is none.
  EXPECT_LT(height_of(choose("tree", {{"height", "1200"}})), 30);
  // Thicker trunks are those of higher trees; centimetres are known by their size.
  const double thin = height_of(choose("tree", {{"circumference", "0.5"}}));
  const double thick = height_of(choose("tree", {{"circumference", "1.25"}}));
  EXPECT_GT(thin, 6);
  EXPECT_LT(thin, 12);
  EXPECT_GT(thick, 15);
  EXPECT_LT(thick, 21);
  EXPECT_NEAR(height_of(choose("tree", {{"circumference", "125"}})), thick, 1e-3);
}

TEST(ChooseShape, SpreadsWhatNobodyMeasured) {
  std::set<std::string> names;
  for (int i = 0; i < 20; ++i) {
    const ChosenShape chosen = choose("tree", {}, i / 20.0);
    names.insert(shape_of(chosen).name);
    EXPECT_GE(chosen.height, 0.8F);
    EXPECT_LE(chosen.height, 1.2F);
    EXPECT_GT(chosen.width, 0.7F);
    EXPECT_LT(chosen.width, 1.35F);
    EXPECT_EQ(chosen.turn, std::nullopt);
  }
  EXPECT_EQ(names, (std::set<std::string>{"tree_broadleaved_medium", "tree_broadleaved_large"}));
  EXPECT_EQ(shape_of(choose("tree", {{"landuse", "orchard"}})).name, "tree_broadleaved_small");
}

TEST(ChooseShape, TurnsToTheDirection) {
  const auto turn = [](const std::string& direction) { return choose("bench", {{"direction", direction}}).turn; };
  const auto degrees = [&](const std::string& direction) { return *turn(direction) * base::kDegreesPerRadian; };
  EXPECT_NEAR(degrees("0"), 90, 1e-9);
  EXPECT_NEAR(degrees("N"), 90, 1e-9);
  EXPECT_NEAR(degrees("90"), 0, 1e-9);
  EXPECT_NEAR(degrees("east"), 0, 1e-9);
  EXPECT_NEAR(degrees("180°"), 270, 1e-9);
  EXPECT_NEAR(degrees("w"), 180, 1e-9);
  EXPECT_NEAR(degrees("NNE"), 67.5, 1e-9);
  EXPECT_NEAR(degrees("south-west"), 225, 1e-9);
  EXPECT_NEAR(degrees("-45"), 135, 1e-9);
  for (const char* direction : {"", "forward", "both", "10-20", "90;270", "clockwise", "north pole", "1e9", "nan"})
    EXPECT_EQ(turn(direction), std::nullopt) << direction;
  EXPECT_NEAR(*choose("surveillance", {{"direction", "N"}, {"camera:direction", "90"}}).turn, 0, 1e-9);
}

TEST(ChooseShape, ChoosesAmongShapesOfAKindByTagsAndHeight) {
  const auto name = [](std::string_view kind, const Tags& tags) { return shape_of(choose(kind, tags)).name; };
  EXPECT_EQ(name("street_lamp", {}), "street_lamp");
  EXPECT_EQ(name("street_lamp", {{"height", "4"}}), "street_lamp_straight");
  EXPECT_EQ(name("street_lamp", {{"light:method", "gas"}}), "street_lamp_gas");
  EXPECT_EQ(name("bench", {{"backrest", "no"}}), "bench_backless");
  EXPECT_EQ(name("bench", {{"backrest", "yes"}}), "bench");
  EXPECT_EQ(name("power_tower", {{"height", "60"}}), "power_tower_large");
  EXPECT_EQ(name("power_tower", {{"structure", "tubular"}}), "power_tower_tubular");
  EXPECT_NEAR(height_of(choose("power_tower", {{"height", "60"}})), 60, 1e-3);
  EXPECT_NEAR(height_of(choose("wind_turbine", {{"height:hub", "80"}, {"rotor:diameter", "82"}})), 121, 1e-3);
  EXPECT_EQ(choose("bench", {{"height", "25"}}).height, 1);  // that of the house behind it
  EXPECT_EQ(choose("unicorn", {{"direction", "N"}}).turn, std::nullopt);
}

/// What reading the shipped file says where the first `from` of it is `to`; empty when it reads well.
std::string complaint(const std::string& from, const std::string& to) {
  std::ostringstream read;
  read << std::ifstream(kFile).rdbuf();
  std::string text = read.str();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at == std::string::npos) return {};
  text.replace(at, from.size(), to);
  const std::string path = (std::filesystem::path(testing::TempDir()) / "blockrand_surroundings.toml").string();
  std::ofstream(path) << text;
  std::string message;
  try {
    const Catalogue catalogue(path);
  } catch (const base::InputError& error) {
    message = error.what();
  }
  std::filesystem::remove(path);
  return message;
}

TEST(SurroundingCatalogue, RefusesWhatItDoesNotKnowAndSaysWhere) {
  EXPECT_EQ(complaint("lane = 2.75", "lane = 2.8"), "");
  const auto at_line = testing::ContainsRegex("surroundings\\.toml:[0-9]+");
  EXPECT_THAT(complaint("trees_per_hectare = 25", "tree_per_hectare = 25"),
              AllOf(at_line, HasSubstr("tree_per_hectare"), HasSubstr("trees_per_hectare?")));
  EXPECT_THAT(complaint("roughness = 0.95", "roughnes = 0.95"), AllOf(at_line, HasSubstr("roughness?")));
  EXPECT_THAT(complaint("kerbed = false", "kerb = false"), AllOf(at_line, HasSubstr("kerb")));
  EXPECT_THAT(complaint("copies = 4", "copys = 4"), AllOf(at_line, HasSubstr("copies?")));
  EXPECT_THAT(complaint("material = \"pool_water\"", "material = \"pol_water\""),
              AllOf(at_line, HasSubstr("Did you mean `pool_water`?")));
  EXPECT_THAT(complaint("ground = \"swimming_pool\"", "ground = \"swiming_pool\""),
              AllOf(at_line, HasSubstr("Did you mean `swimming_pool`?")));
  EXPECT_THAT(complaint("kind = \"boulder\"", "kind = \"bolder\""), AllOf(at_line, HasSubstr("`bol")));
  EXPECT_THAT(complaint("form = \"lump\"", "form = \"lmup\""), AllOf(at_line, HasSubstr("Did you mean `lump`?")));
  EXPECT_THAT(complaint("theme = \"vegetation\"", "theme = \"plants\""), AllOf(at_line, HasSubstr("vegetation")));
  EXPECT_THAT(complaint("colour = \"#8c8a72\"", "colour = \"brown\""), AllOf(at_line, HasSubstr("#rrggbb")));
  EXPECT_THAT(complaint("\"sett\"", "\"asphalt\""), AllOf(at_line, HasSubstr("stands twice")));
  EXPECT_THAT(complaint("\nother = {", "\nothers = {"), HasSubstr("`other`"));
  EXPECT_THAT(complaint("[[0, 2.9], [2.7", "[[0, 2.9], [0, 3], [2.7"), AllOf(at_line, HasSubstr("two tips")));
  EXPECT_THAT(complaint("radius = 0.07, sides = 5", "radius = 0.07, sides = 50"), at_line);
  EXPECT_THAT(complaint("[street]", "[street"), at_line);
  EXPECT_THROW(Catalogue("/nowhere/surroundings.toml"), base::InputError);
  EXPECT_THROW(Catalogue(std::string(BLOCKRAND_SOURCE_DIR) + "/configs"), base::InputError);
}

}  // namespace
}  // namespace blockrand::surroundings
