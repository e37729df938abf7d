// Bodies of whole small towns: steps, stop lines, wires, portals, cliffs.
#include <gtest/gtest.h>

#include <set>

#include "tests/unit/surroundings/surroundings_town.h"

namespace blockrand::surroundings::test {
namespace {

using model::BodyClass;
using model::OsmId;
using model::OsmType;
using model::Point2;
using model::Point3;
using model::SurroundingState;

const Town::Tags kHouse{{"building", "yes"}};

/// A house somewhere: a town has one at least.
Town town_with_a_house() {
  Town town;
  town.box(1, 400, 400, 410, 410, kHouse);
  return town;
}

OsmId way(std::int64_t id) { return {OsmType::way, id}; }

// ---- ground

TEST(SurroundingGround, ASquareWithNothingButAHouseHasGroundAroundIt) {
  const BuiltTown built(town_with_a_house());
  ASSERT_FALSE(built.all().surfaces.empty());
  const double squares = std::round(built.ground_area() / (kSquareSize * kSquareSize));
  EXPECT_GE(squares, 1);
  EXPECT_NEAR(built.ground_area(), squares * kSquareSize * kSquareSize - 100, 1);
}

// ---- steps

double slope(Point2 p) { return 0.3 * p.x; }

TEST(Stairs, RiseWithTheTerrainInTreadsThatLieOnIt) {
  Town town = town_with_a_house();
  town.way(2, {{0, 0}, {10, 0}}, {{"highway", "steps"}});
  const BuiltTown built(town, slope);
  const std::vector<Point3> corners = built.corners(BodyClass::stairs);
  ASSERT_FALSE(corners.empty());
  std::set<double> tops;
  for (const model::SurroundingBody& body : built.all().bodies)
    if (body.body == BodyClass::stairs)
      for (const model::FlatPolygon& face : body.faces)
        if (face.outer[0].z == face.outer[1].z && face.outer[1].z == face.outer[2].z) tops.insert(face.outer[0].z);
  EXPECT_NEAR(static_cast<double>(tops.size()), 20, 1.1);  // 3 m of risers of 15 cm
  double before = -1;
  for (const double z : tops) {
    if (before >= 0) {
      EXPECT_NEAR(z - before, 0.15, 0.01);
    }
    before = z;
  }
  // Nowhere below the ground, and nowhere a riser above it.
  for (const Point3& p : corners) {
    EXPECT_LT(p.z, slope({p.x, p.y}) + 0.2);
    EXPECT_LE(std::fabs(p.y), 1.01);
  }
  EXPECT_NEAR(built.top_area(BodyClass::stairs), 20, 0.3);
}

TEST(Stairs, HaveTheCountThatIsTold) {
  Town town = town_with_a_house();
  town.way(2, {{10, 0}, {0, 0}}, {{"highway", "steps"}, {"step_count", "15"}});  // from above
  const BuiltTown built(town, slope);
  std::set<double> tops;
  for (const model::SurroundingBody& body : built.all().bodies)
    if (body.body == BodyClass::stairs)
      for (const model::FlatPolygon& face : body.faces)
        if (face.outer[0].z == face.outer[1].z && face.outer[1].z == face.outer[2].z) tops.insert(face.outer[0].z);
  EXPECT_EQ(tops.size(), 15u);
}

TEST(Stairs, OnLevelGroundLeadToBuildingsOnly) {
  Town free = town_with_a_house();
  free.way(2, {{0, 0}, {4, 0}}, {{"highway", "steps"}, {"step_count", "6"}, {"incline", "up"}});
  EXPECT_TRUE(BuiltTown(free).corners(BodyClass::stairs).empty());

  Town untold = town_with_a_house();
  untold.box(3, 4, -5, 14, 5, kHouse);
  untold.way(2, {{0, 0}, {4, 0}}, {{"highway", "steps"}});
  EXPECT_TRUE(BuiltTown(untold).corners(BodyClass::stairs).empty());

  Town told = town_with_a_house();
  told.box(3, 4, -5, 14, 5, kHouse);
  told.way(2, {{0, 0}, {4, 0}}, {{"highway", "steps"}, {"step_count", "6"}});
  const BuiltTown built(told);
  const auto corners = built.corners(BodyClass::stairs);
  ASSERT_FALSE(corners.empty());
  EXPECT_NEAR(heights_of(corners).second, 0.9, 0.02);
  for (const Point3& p : corners) EXPECT_LE(p.x, 4.05) << "nothing enters the building";
}

TEST(Stairs, AreNoneWhereTheWayRisesAndFalls) {
  Town town = town_with_a_house();
  town.way(2, {{0, 0}, {100, 0}}, {{"highway", "steps"}});
  const BuiltTown built(town, [](Point2 p) { return 5 - std::fabs(p.x - 50) / 10 + p.x / 50; });
  EXPECT_TRUE(built.corners(BodyClass::stairs).empty());
}

// ---- streets

TEST(Streets, OnTheBedOfAnAbandonedRailwayAreThere) {
  Town town = town_with_a_house();
  town.way(2, {{-80, 0}, {80, 0}}, {{"highway", "primary"}, {"railway", "abandoned"}, {"width", "6"}});
  town.way(3, {{-80, 40}, {80, 40}}, {{"railway", "abandoned"}});
  const BuiltTown built(town);
  EXPECT_EQ(built.state(way(2)), SurroundingState::modelled);
  EXPECT_EQ(built.state(way(3)), std::nullopt);
}

TEST(Streets, SignalsThatAreMappedInTheMiddleStandAtTheKerb) {
  Town town = town_with_a_house();
  town.point({0, 0}, {{"highway", "traffic_signals"}});
  town.way(2, {{-80, 0}, {0, 0}, {80, 0}}, {{"highway", "primary"}, {"width", "16"}});
  const BuiltTown built(town);
  const auto& objects = built.all().objects;
  const auto signal = std::ranges::find_if(objects, [](const auto& o) {
    return catalogue().shown().shapes[o.shape].kind.find("signal") != std::string::npos;
  });
  ASSERT_NE(signal, objects.end());
  const Point2 at = built.in_town({signal->place.x, signal->place.y});
  EXPECT_GT(std::fabs(at.y), 8);
  EXPECT_LT(std::fabs(at.y), 10) << "at the kerb, not farther";
}

TEST(Streets, PavementsReachToHousesThatStandALittleFartherAway) {
  // A pavement of 2.5 m ends at 5.25 m; the house stands 1.2 m behind it, the next 4 m.
  for (const auto& [wall, paved] : {std::pair(6.5, true), std::pair(9.5, false)}) {
    Town town;
    town.way(2, {{-80, 0}, {80, 0}}, {{"highway", "residential"}, {"width", "5.5"}, {"sidewalk", "both"}});
    town.box(3, -60, wall, 60, wall + 10, kHouse);
    const BuiltTown built(town);
    double end = 0;
    for (const model::GroundSurface& s : built.all().surfaces)
      if (s.ground == model::GroundClass::pavement)
        for (const model::FlatPolygon& face : s.faces)
          for (const Point3& p : face.outer)
            if (const Point2 at = built.in_town({p.x, p.y}); std::fabs(at.x) < 50) end = std::max(end, at.y);
    EXPECT_NEAR(end, paved ? wall : 7.25, 0.06);
  }
}

// ---- what a night looks at

/// A town with a long fence, wires and a bridge; `edit` changes something of it.
Town long_lines(const std::string& edit = {}) {
  Town town = town_with_a_house();
  const auto tags = [&](const char* name, Town::Tags there) { return edit == name ? there : Town::Tags{}; };
  town.point({900, 400}, tags("gate", {{"barrier", "gate"}}));
  town.way(2, {{0, 400}, {900, 400}}, {{"barrier", "fence"}});
  const double far = edit == "tower" ? 1210 : 1200;
  for (const double x : {0.0, far}) town.point({x, 640}, {{"power", "tower"}});
  town.way(3, {{0, 640}, {far, 640}}, {{"power", "line"}});
  town.way(4, {{-300, -200}, {0, -200}}, {{"highway", "primary"}, {"bridge", "yes"}, {"layer", "1"}});
  town.way(5, {{0, -200}, {900, -200}, {1000, edit == "bridge" ? -190.0 : -200.0}},
           {{"highway", "primary"}, {"bridge", "yes"}, {"layer", "1"}});
  town.way(6, {{-60, 60}, {60, 60}}, {{"highway", "residential"}});
  if (edit == "lamp") town.point({20, 100}, {{"highway", "street_lamp"}});
  if (edit == "house") town.box(7, 20, 75, 40, 90, kHouse);
  return town;
}

TEST(SurroundingsReach, HoldsWhateverMakesATileAnotherOne) {
  const BuiltTown before(long_lines());
  constexpr double kUnits = 1e7;
  const model::TileId middle = georef::tile_of(
      {static_cast<std::int32_t>(13.4 * kUnits), static_cast<std::int32_t>(52.5 * kUnits)}, footprints::kTileLevel);
  const auto key = [](const BuiltTown& town, const model::TileId& tile) {
    base::Packer out;
    town.finder().pack(tile, out);
    return out.bytes;
  };
  const auto made = [](const BuiltTown& town, const model::TileId& tile) {
    base::Packer out;
    const model::Surroundings around = town.finder().around(tile);
    out << around.surfaces << around.bodies << around.objects;
    return out.bytes;
  };
  const std::pair<const char*, Point2> edits[] = {
      {"gate", {900, 400}}, {"tower", {1200, 640}}, {"bridge", {1000, -200}}, {"lamp", {20, 100}}, {"house", {30, 82}}};
  for (const auto& [edit, place] : edits) {
    const BuiltTown after(long_lines(edit));
    const Point2 p = before.from_town(place);
    geometry::PlanBox changed;
    changed.include(Point2{p.x - 15, p.y - 15}), changed.include(Point2{p.x + 15, p.y + 15});
    int others = 0;
    for (int x = -4; x <= 4; ++x)
      for (int y = -1; y <= 1; ++y) {
        model::TileId tile = middle;
        tile.x += static_cast<decltype(tile.x)>(x), tile.y += static_cast<decltype(tile.y)>(y);
        const bool another = made(before, tile) != made(after, tile);
        if (key(before, tile) == key(after, tile)) {
          EXPECT_FALSE(another) << "a tile that would be taken for the same: " << edit << ' ' << x << ' ' << y;
          continue;
        }
        ++others;
        const SurroundingsReach reach = before.finder().reach(tile);
        EXPECT_TRUE(std::ranges::any_of(reach.things, [&](const auto& box) { return box.near(changed, 0); }))
            << edit << ' ' << x << ' ' << y;
      }
    EXPECT_GT(others, 0) << edit;
  }
}

// ---- stop lines

/// A street from west to east that ends at one from south to north.
Town junction(const Town::Tags& control, Point2 at = {-12, 0},
              const Town::Tags& of_street = {{"highway", "residential"}, {"width", "6"}}) {
  Town town = town_with_a_house();
  town.point(at, control);
  std::vector<Point2> line{{-80, 0}};
  if (at.x < 0) line.push_back(at);
  line.push_back({0, 0});
  town.way(2, line, of_street);
  town.way(3, {{0, -80}, {0, 0}, {0, 80}}, {{"highway", "residential"}, {"width", "6"}});
  return town;
}

TEST(StopLines, LieAcrossTheLanesOfTheDirection) {
  const auto corners = BuiltTown(junction({{"highway", "stop"}, {"direction", "forward"}})).corners(BodyClass::marking);
  ASSERT_FALSE(corners.empty());
  for (const Point3& p : corners) {
    EXPECT_NEAR(p.x, -12, 0.3);
    EXPECT_LT(p.y, 0.2);  // who comes from the west keeps to the south
    EXPECT_GT(p.y, -3.1);
  }
  const auto back = BuiltTown(junction({{"highway", "stop"}, {"direction", "backward"}})).corners(BodyClass::marking);
  ASSERT_FALSE(back.empty());
  for (const Point3& p : back) EXPECT_GT(p.y, -0.2);
  const auto left = BuiltTown(junction({{"highway", "stop"}, {"direction", "forward"}}, {-12, 0},
                                       {{"highway", "residential"}, {"width", "6"}, {"driving_side", "left"}}))
                        .corners(BodyClass::marking);
  ASSERT_FALSE(left.empty());
  for (const Point3& p : left) EXPECT_GT(p.y, -0.2);
}

TEST(StopLines, WithoutADirectionAreThoseOfTheNearJunction) {
  const auto corners = BuiltTown(junction({{"highway", "stop"}})).corners(BodyClass::marking);
  ASSERT_FALSE(corners.empty());
  for (const Point3& p : corners) EXPECT_LT(p.y, 0.2);
  EXPECT_TRUE(BuiltTown(junction({{"highway", "stop"}}, {-60, 0})).corners(BodyClass::marking).empty());
}

TEST(StopLines, AreBrokenWhereWayIsGiven) {
  const BuiltTown solid(junction({{"highway", "stop"}})), broken(junction({{"highway", "give_way"}}));
  EXPECT_NEAR(solid.top_area(BodyClass::marking), 0.5 * 2.7, 0.05);
  EXPECT_GT(broken.top_area(BodyClass::marking), 0.5 * 1.4);
  EXPECT_LT(broken.top_area(BodyClass::marking), 0.5 * 2.1);
}

TEST(StopLines, OfSignalsOfAJunctionLieWhereItsWaysComeToIt) {
  const BuiltTown built(junction({{"highway", "traffic_signals"}}, {0, 0}));
  bool west = false, south = false, north = false;
  for (const Point3& p : built.corners(BodyClass::marking)) {
    EXPECT_GT(std::max(std::fabs(p.x), std::fabs(p.y)), 3.2) << "not within the junction";
    EXPECT_LT(std::max(std::fabs(p.x), std::fabs(p.y)), 12);
    west |= p.x < -3.2, south |= p.y<-3.2, north |= p.y> 3.2;
  }
  EXPECT_TRUE(west && south && north);
  EXPECT_NEAR(built.top_area(BodyClass::marking), 3 * 0.5 * 2.7, 0.2);
}

TEST(StopLines, LieBeforeCrossings) {
  Town crossed = town_with_a_house();
  crossed.point({-12, 0}, {{"highway", "traffic_signals"}, {"crossing", "traffic_signals"}});
  crossed.way(2, {{-80, 0}, {-12, 0}, {0, 0}}, {{"highway", "residential"}, {"width", "6"}, {"oneway", "yes"}});
  crossed.way(3, {{0, -80}, {0, 0}, {0, 80}}, {{"highway", "residential"}, {"width", "6"}});
  const auto corners = BuiltTown(crossed).corners(BodyClass::marking);
  ASSERT_FALSE(corners.empty());
  for (const Point3& p : corners) EXPECT_NEAR(p.x, -14.75, 0.3);
}

// ---- wires

Town power_line(const Town::Tags& last) {
  Town town = town_with_a_house();
  town.point({0, 0}, {{"power", "pole"}});
  town.point({40, 0}, {{"power", "pole"}});
  town.point({80, 0}, last);
  town.way(2, {{0, 0}, {40, 0}, {80, 0}}, {{"power", "minor_line"}});
  return town;
}

TEST(Wires, HangBetweenThePlacesThatHoldThem) {
  const BuiltTown built(power_line({{"power", "pole"}}));
  const auto corners = built.corners(BodyClass::power_line);
  ASSERT_FALSE(corners.empty());
  const auto [low, high] = heights_of(corners);
  EXPECT_NEAR(high, 9, 0.05);         // the top of a pole
  EXPECT_NEAR(low, 8.7 - 0.6, 0.05);  // its arm, and 1.5 % of 40 m
  double west = 1e9, east = -1e9;
  for (const Point3& p : corners) west = std::min(west, p.x), east = std::max(east, p.x);
  EXPECT_NEAR(west, 0, 0.2);
  EXPECT_NEAR(east, 80, 0.2);
  for (const model::PlacedObject& o : built.all().objects)
    EXPECT_NEAR(std::fabs(std::sin(static_cast<double>(o.turn))), 0, 0.05) << "arms lie across the line";
  EXPECT_EQ(built.state(way(2)), SurroundingState::modelled);
}

TEST(Wires, EndWhereNoSupportIsMapped) {
  const BuiltTown built(power_line({}));
  for (const Point3& p : built.corners(BodyClass::power_line)) EXPECT_LT(p.x, 40.2);
  Town none = town_with_a_house();
  none.way(2, {{0, 0}, {40, 0}}, {{"power", "line"}});
  const BuiltTown bare(none);
  EXPECT_TRUE(bare.corners(BodyClass::power_line).empty());
  EXPECT_EQ(bare.state(way(2)), SurroundingState::not_modelled) << "it is told";
}

TEST(Wires, KeepOffRoofs) {
  Town town = power_line({{"power", "pole"}});
  town.box(3, 15, -5, 25, 5, kHouse);
  for (const Point3& p : BuiltTown(town).corners(BodyClass::power_line)) EXPECT_GT(p.x, 39.8);
}

TEST(Wires, OfAerialwaysLeadFromStationToStation) {
  Town town = town_with_a_house();
  town.point({100, 0}, {{"aerialway", "pylon"}});
  town.way(2, {{0, 0}, {100, 0}, {200, 0}}, {{"aerialway", "chair_lift"}});
  const BuiltTown built(town);
  const auto corners = built.corners(BodyClass::power_line);
  ASSERT_FALSE(corners.empty());
  EXPECT_NEAR(heights_of(corners).second, 11.93, 0.1);
  EXPECT_EQ(built.state(way(2)), SurroundingState::modelled);
}

// ---- portals

TEST(Portals, StandWhereATunnelBeginsInTheOpen) {
  Town town = town_with_a_house();
  town.way(2, {{-80, 0}, {0, 0}}, {{"highway", "residential"}, {"width", "6"}});
  town.way(3, {{0, 0}, {60, 0}}, {{"highway", "residential"}, {"width", "6"}, {"tunnel", "yes"}, {"layer", "-1"}});
  const BuiltTown built(town);
  const auto corners = built.corners(BodyClass::other);
  ASSERT_FALSE(corners.empty());
  double left = 1e9, right = -1e9;
  for (const Point3& p : corners) {
    EXPECT_LT(std::fabs(p.x), 1) << "none where nothing goes on";
    left = std::min(left, p.y), right = std::max(right, p.y);
  }
  EXPECT_GT(right - left, 6.5);
  EXPECT_NEAR(heights_of(corners).second, 5.3 - 0.12, 0.01);  // it stands on the carriageway
  EXPECT_EQ(built.state(way(3)), SurroundingState::modelled);
}

TEST(Portals, AreNoneInBuildingsAndBelowStreets) {
  Town house = town_with_a_house();
  house.way(2, {{-80, 0}, {0, 0}}, {{"highway", "residential"}, {"width", "6"}});
  house.way(3, {{0, 0}, {60, 0}}, {{"highway", "residential"}, {"width", "6"}, {"tunnel", "yes"}});
  house.box(4, 1, -20, 30, 20, kHouse);
  const BuiltTown built(house);
  EXPECT_TRUE(built.corners(BodyClass::other).empty());
  EXPECT_EQ(built.state(way(3)), SurroundingState::below_ground);

  Town street = town_with_a_house();
  street.way(2, {{-80, 0}, {0, 0}}, {{"highway", "footway"}});
  street.way(3, {{0, 0}, {60, 0}}, {{"highway", "footway"}, {"tunnel", "yes"}});
  street.way(4, {{4, -80}, {4, 80}}, {{"highway", "residential"}, {"width", "6"}});
  EXPECT_TRUE(BuiltTown(street).corners(BodyClass::other).empty());
}

// ---- cliffs

TEST(Cliffs, StandAsHighAsTheyAreTold) {
  Town town = town_with_a_house();
  town.way(2, {{0, 0}, {50, 0}}, {{"natural", "cliff"}, {"height", "7"}});
  town.way(3, {{0, 60}, {50, 60}}, {{"natural", "earth_bank"}});
  const BuiltTown built(town);
  double cliff = 0, bank = 0;
  for (const Point3& p : built.corners(BodyClass::cliff))
    (p.y < 30 ? cliff : bank) = std::max(p.y < 30 ? cliff : bank, p.z);
  EXPECT_NEAR(cliff, 7, 0.01);
  EXPECT_NEAR(bank, 2, 0.01);
  EXPECT_EQ(built.state(way(2)), SurroundingState::modelled);
}

TEST(Cliffs, CountWhatTheTerrainFalls) {
  Town town = town_with_a_house();
  town.way(2, {{0, 0}, {50, 0}}, {{"natural", "cliff"}, {"height", "7"}});
  // The lower ground is on the right, in the south: 12.5 m further it lies 5 m lower.
  const BuiltTown built(town, [](Point2 p) { return 0.4 * p.y; });
  for (const Point3& p : built.corners(BodyClass::cliff)) EXPECT_LT(p.z, 0.4 * p.y + 2.4);
}

}  // namespace
}  // namespace blockrand::surroundings::test
