#include "pipeline/surroundings/ground_surfaces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::surroundings {
namespace {

using model::FlatPolygon;
using model::GroundClass;
using model::Point2;
using model::Point3;

constexpr SquareIndex kSquare{3128, 46560};  // 391000, 5820000

GroundLabel label(GroundClass ground, float offset) { return {.ground = ground, .object = {}, .offset = offset}; }

void add(GroundClaims& claims, GroundLabel label, double x0, double y0, double x1, double y1) {
  const Point2 o = box_of(kSquare).minimum;
  geometry::AreaClaim claim;
  claim.label = static_cast<std::uint32_t>(claims.labels.size());
  claims.labels.push_back(label);
  claim.rings = {{{o.x + x0, o.y + y0}, {o.x + x1, o.y + y0}, {o.x + x1, o.y + y1}, {o.x + x0, o.y + y1}}};
  for (const Point2 p : claim.rings[0]) claim.box.include(p);
  claims.claims.push_back(std::move(claim));
}

/// m² and where it is seen from, as the area vector of a polygon.
Point3 area_vector(const FlatPolygon& face) {
  Point3 n{};
  const Point3& o = face.outer[0];
  for (std::size_t i = 1; i + 1 < face.outer.size(); ++i) {
    const Point3 &a = face.outer[i], &b = face.outer[i + 1];
    const Point3 u{a.x - o.x, a.y - o.y, a.z - o.z}, v{b.x - o.x, b.y - o.y, b.z - o.z};
    n = {n.x + (u.y * v.z - u.z * v.y) / 2, n.y + (u.z * v.x - u.x * v.z) / 2, n.z + (u.x * v.y - u.y * v.x) / 2};
  }
  return n;
}

const SquareSurface& of_label(const std::vector<SquareSurface>& surfaces, std::uint32_t label) {
  for (const SquareSurface& s : surfaces)
    if (s.label == label) return s;
  throw std::runtime_error("no such surface");
}

TEST(GroundSurfaces, AStreetLiesBetweenKerbsOfWhatIsBesideIt) {
  GroundClaims claims;
  add(claims, label(GroundClass::carriageway, -0.125f), -200, 50, 300, 56);
  add(claims, label(GroundClass::grass, 0), -200, 0, 300, 125);
  const auto surfaces = ground_surfaces(kSquare, SquareGround(kSquare, {}, 30), claims, {});
  ASSERT_EQ(surfaces.size(), 2u);
  EXPECT_TRUE(of_label(surfaces, 0).surface.edges.empty());
  const auto& lawn = of_label(surfaces, 1).surface;
  ASSERT_EQ(lawn.edges.size(), 2u);
  double north = 0, south = 0;
  for (const FlatPolygon& kerb : lawn.edges) {
    const Point3 n = area_vector(kerb);
    (n.y > 0 ? north : south) += std::fabs(n.y);
    EXPECT_EQ(n.z, 0);
    // Seen from the street: the kerb in the south looks north.
    EXPECT_EQ(n.y > 0, kerb.outer[0].y < box_of(kSquare).minimum.y + 53);
  }
  EXPECT_NEAR(north, 125 * 0.125, 1e-9);
  EXPECT_NEAR(south, 125 * 0.125, 1e-9);
  for (const FlatPolygon& face : of_label(surfaces, 0).surface.faces)
    for (const Point3& p : face.outer) EXPECT_EQ(p.z, 29.875);
}

TEST(GroundSurfaces, TheFootOfAWallBelongsToTheLowerGround) {
  GroundClaims claims;
  GroundLabel house;
  house.building = true;
  add(claims, house, 20, 50, 40, 60);
  add(claims, label(GroundClass::carriageway, -0.125f), 40, 0, 50, 125);
  const auto surfaces = ground_surfaces(kSquare, SquareGround(kSquare, {}, 0), claims, {});
  ASSERT_EQ(surfaces.size(), 2u);  // no surface for the house
  const auto& street = of_label(surfaces, 1).surface;
  ASSERT_EQ(street.edges.size(), 1u);
  EXPECT_NEAR(area_vector(street.edges[0]).x, 10 * 0.125, 1e-9);  // seen from the street, in the east
  for (const SquareSurface& s : surfaces)
    for (const model::Polygon& p : s.plan)
      EXPECT_FALSE(holds(p, {box_of(kSquare).minimum.x + 30, box_of(kSquare).minimum.y + 55}));
}

TEST(GroundSurfaces, OverTerrainFacesAreFlatAndNeighboursMeet) {
  const Point2 o = box_of(kSquare).minimum;
  const HeightAt hill = [&](Point2 p) -> std::optional<double> {
    const double x = (p.x - o.x) / 40, y = (p.y - o.y) / 30;
    return 40 + 3 * x - 0.4 * x * x + y * y * 0.7;
  };
  GroundClaims claims;
  add(claims, label(GroundClass::carriageway, -0.125f), 3, 50, 300, 56);
  add(claims, label(GroundClass::grass, 0), 60, 20, 300, 90);
  std::map<std::pair<double, double>, std::set<double>> heights;  // of grounds without an offset
  for (const std::int32_t step : {0, 1}) {
    const SquareIndex square{kSquare.x + step, kSquare.y};
    double area = 0;
    for (const SquareSurface& s : ground_surfaces(square, SquareGround(square, hill, 0), claims, {}))
      for (const FlatPolygon& face : s.surface.faces) {
        const Point3 n = area_vector(face);
        EXPECT_GT(n.z, 0);
        const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
        for (const Point3& p : face.outer) {
          const Point3& a = face.outer[0];
          EXPECT_LT(std::fabs((p.x - a.x) * n.x + (p.y - a.y) * n.y + (p.z - a.z) * n.z) / length, 0.002);
          if (s.surface.offset == 0) heights[{p.x, p.y}].insert(p.z);
        }
        for (const auto& hole : face.holes) EXPECT_GE(hole.size(), 3u);
      }
    for (const SquareSurface& s : ground_surfaces(square, SquareGround(square, hill, 0), claims, {}))
      for (const model::Polygon& p : s.plan) area += geometry::area(p);
    EXPECT_NEAR(area, kSquareSize * kSquareSize, 1e-6);
  }
  std::size_t on_border = 0;
  for (const auto& [place, z] : heights) {
    EXPECT_EQ(z.size(), 1u) << place.first << ' ' << place.second;
    on_border += place.first == o.x + kSquareSize;
  }
  EXPECT_GE(on_border, kTerrainSteps + 1u);
}

TEST(GroundSurfaces, AStepAtTheBorderOfASquareIsMadeOnce) {
  GroundClaims claims;
  add(claims, label(GroundClass::carriageway, -0.125f), 125, -50, 135, 300);  // begins where the square ends
  add(claims, label(GroundClass::grass, 0), 0, 0, 125, 125);
  const SquareIndex east{kSquare.x + 1, kSquare.y};
  double kerbs = 0;
  for (const SquareIndex square : {kSquare, east})
    for (const SquareSurface& s : ground_surfaces(square, SquareGround(square, {}, 0), claims, {}))
      for (const FlatPolygon& face : s.surface.edges)
        if (face.outer[0].x == box_of(east).minimum.x) kerbs += std::fabs(area_vector(face).x);
  EXPECT_NEAR(kerbs, 125 * 0.125, 1e-9);
}

TEST(SquareGround, WithoutTerrainItIsLevel) {
  const SquareGround ground(kSquare, {}, 12);
  EXPECT_TRUE(ground.is_level());
  EXPECT_TRUE(ground.lines().empty());
  EXPECT_EQ(ground.at(box_of(kSquare).minimum), 12);
}

TEST(SquareGround, WhereTheTerrainIsNotKnownTheLevelIs) {
  const SquareGround ground(
      kSquare, [](Point2) { return std::optional<double>(); }, 7);
  EXPECT_EQ(ground.at(box_of(kSquare).minimum), 7);
}

}  // namespace
}  // namespace blockrand::surroundings
