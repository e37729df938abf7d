// What becomes of models when they are read as cities: which bodies count, once, and with which class.
#include "pipeline/compare/read_city.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/compare/body.h"

namespace blockrand::compare {
namespace {

namespace reference = importers::reference;
using reference::GeometryKind;
using reference::ReferenceModel;
using reference::SurfaceClass;

ReferenceModel empty_model() {
  ReferenceModel m;
  m.path = "test";
  m.format = "test";
  m.crs.horizontal = "EPSG:25833";
  return m;
}

std::uint32_t add_polygon(ReferenceModel& m, std::vector<Point3> ring) {
  m.polygons.push_back({"", std::move(ring), {}});
  return static_cast<std::uint32_t>(m.polygons.size() - 1);
}

/// Ground, roof and four walls of a box; indices in that order.
std::vector<std::uint32_t> add_box(ReferenceModel& m, Point3 low, Point3 high) {
  const auto [x, y, z] = low;
  const auto [X, Y, Z] = high;
  return {add_polygon(m, {{x, y, z}, {x, Y, z}, {X, Y, z}, {X, y, z}}),
          add_polygon(m, {{x, y, Z}, {X, y, Z}, {X, Y, Z}, {x, Y, Z}}),
          add_polygon(m, {{x, y, z}, {X, y, z}, {X, y, Z}, {x, y, Z}}),
          add_polygon(m, {{X, y, z}, {X, Y, z}, {X, Y, Z}, {X, y, Z}}),
          add_polygon(m, {{X, Y, z}, {x, Y, z}, {x, Y, Z}, {X, Y, Z}}),
          add_polygon(m, {{x, Y, z}, {x, y, z}, {x, y, Z}, {x, Y, Z}})};
}

reference::Geometry geometry_of(int lod, GeometryKind kind, const std::vector<std::uint32_t>& polygons) {
  reference::Geometry g;
  g.lod = lod;
  g.kind = kind;
  for (const std::uint32_t p : polygons) g.faces.push_back({p, false});
  g.outer_faces = g.faces.size();
  return g;
}

reference::Surface surface_of(SurfaceClass c, int lod, std::uint32_t polygon) {
  reference::Surface s;
  s.surface_class = c;
  s.geometries = {geometry_of(lod, GeometryKind::surfaces, {polygon})};
  return s;
}

/// A house of thematic surfaces, with its solid.
reference::Building house(ReferenceModel& m, const std::string& id, Point3 low, Point3 high, int lod = 2) {
  reference::Building b;
  b.id = id;
  const auto box = add_box(m, low, high);
  b.geometries = {geometry_of(lod, GeometryKind::solid, box)};
  b.surfaces = {surface_of(SurfaceClass::ground, lod, box[0]), surface_of(SurfaceClass::roof, lod, box[1])};
  for (std::size_t i = 2; i < 6; ++i) b.surfaces.push_back(surface_of(SurfaceClass::wall, lod, box[i]));
  return b;
}

double area_of(const Building& b) {
  double area = 0;
  for (const Face& f : b.faces) area += f.area;
  return area;
}

TEST(ReadCity, FacesWithoutAClassStayBesideThoseThatHaveOne) {
  ReferenceModel m = empty_model();
  m.buildings = {house(m, "a", {0, 0, 0}, {10, 8, 6})};
  m.buildings[0].surfaces.pop_back();  // a wall of the solid that no surface names
  const City city = city_of(m, {});
  ASSERT_EQ(city.buildings.size(), 1u);
  EXPECT_EQ(city.buildings[0].faces.size(), 6u);
  EXPECT_EQ(std::count_if(city.buildings[0].faces.begin(), city.buildings[0].faces.end(),
                          [](const Face& f) { return !f.stated && f.hull == Hull::wall; }),
            1);
}

TEST(ReadCity, WhatIsSaidTwiceCountsOnce) {
  // The solid's polygons are copies of the surfaces', not links to them.
  ReferenceModel m = empty_model();
  m.buildings = {house(m, "a", {0, 0, 0}, {10, 8, 6})};
  m.buildings[0].geometries = {geometry_of(2, GeometryKind::solid, add_box(m, {0, 0, 0}, {10, 8, 6}))};
  const City city = city_of(m, {});
  EXPECT_EQ(city.buildings[0].faces.size(), 6u);
  EXPECT_NEAR(area_of(city.buildings[0]), 376, 1e-9);
}

TEST(ReadCity, AnInstallationDoesNotChooseTheLevel) {
  ReferenceModel m = empty_model();
  m.buildings = {house(m, "a", {0, 0, 0}, {10, 8, 6})};
  reference::Surface balcony =
      surface_of(SurfaceClass::installation, 3, add_polygon(m, {{2, -1, 3}, {4, -1, 3}, {4, 0, 3}, {2, 0, 3}}));
  m.buildings[0].surfaces.push_back(balcony);
  City city = city_of(m, {});
  EXPECT_EQ(city.buildings[0].lod, 2);
  EXPECT_NEAR(area_of(city.buildings[0]), 376, 1e-9) << "the balcony is of a finer level than the house";
  m.buildings[0].surfaces.back().geometries[0].lod = 1;
  city = city_of(m, {});
  EXPECT_NEAR(area_of(city.buildings[0]), 378, 1e-9) << "what there is of it up to the house's level";
}

TEST(ReadCity, ACoarseBodyBesideItsPartsIsLeftOut) {
  ReferenceModel m = empty_model();
  reference::Building whole;
  whole.id = "whole";
  whole.geometries = {geometry_of(1, GeometryKind::solid, add_box(m, {0, 0, 0}, {20, 8, 6}))};
  reference::Building left = house(m, "left", {0, 0, 0}, {10, 8, 6}), right = house(m, "right", {10, 0, 0}, {20, 8, 6});
  left.parent = right.parent = 0;
  m.buildings = {whole, left, right};
  City city = city_of(m, {});
  ASSERT_EQ(city.buildings.size(), 1u);
  EXPECT_NEAR(*volume_of(city.buildings[0]), 960, 1e-9);
  EXPECT_EQ(city.buildings[0].bodies, 2);
  // A composite of the parts' solids counts once.
  m.buildings[0].geometries = {geometry_of(2, GeometryKind::solid, {})};
  for (const std::size_t i : {1u, 2u})
    for (const reference::Face& f : m.buildings[i].geometries[0].faces) m.buildings[0].geometries[0].faces.push_back(f);
  m.buildings[0].geometries[0].outer_faces = 12;
  city = city_of(m, {});
  EXPECT_NEAR(*volume_of(city.buildings[0]), 960, 1e-9);
  EXPECT_EQ(city.buildings[0].shells.size(), 2u);
}

TEST(ReadCity, APartWithoutASolidIsNotForgotten) {
  ReferenceModel m = empty_model();
  reference::Building whole;
  whole.id = "whole";
  reference::Building left = house(m, "left", {0, 0, 0}, {10, 8, 6}), right = house(m, "right", {30, 0, 0}, {40, 8, 6});
  left.parent = right.parent = 0;
  right.geometries.clear();
  m.buildings = {whole, left, right};
  const City city = city_of(m, {});
  EXPECT_FALSE(city.buildings[0].all_in_shells);
  EXPECT_NEAR(*volume_of(city.buildings[0]), 960, 1e-9) << "of the faces, which close";
}

TEST(ReadCity, ABodyThatLooksInwardsKeepsItsRoof) {
  ReferenceModel m = empty_model();
  reference::Building b;
  b.id = "inwards";
  auto solid = geometry_of(2, GeometryKind::solid, add_box(m, {0, 0, 0}, {10, 8, 6}));
  for (reference::Face& f : solid.faces) f.reversed = true;
  b.geometries = {solid};
  m.buildings = {b};
  const City city = city_of(m, {});
  EXPECT_EQ(std::count_if(city.buildings[0].faces.begin(), city.buildings[0].faces.end(),
                          [](const Face& f) { return f.hull == Hull::roof; }),
            1);
}

TEST(ReadCity, InteriorsAndPolygonsWithoutAreaDoNotCount) {
  ReferenceModel m = empty_model();
  m.buildings = {house(m, "a", {0, 0, 0}, {10, 8, 6})};
  reference::Surface inside =
      surface_of(SurfaceClass::interior_wall, 2, add_polygon(m, {{1, 1, 0}, {5, 1, 0}, {5, 1, 3}}));
  inside.interior = true;
  m.buildings[0].surfaces.push_back(inside);
  m.buildings[0].surfaces.push_back(surface_of(SurfaceClass::wall, 2, add_polygon(m, {{1, 1, 0}, {5, 1, 0}})));
  m.buildings[0].surfaces.push_back(surface_of(SurfaceClass::wall, 2, add_polygon(m, {})));
  const City city = city_of(m, {});
  EXPECT_EQ(city.buildings[0].faces.size(), 6u);
}

}  // namespace
}  // namespace blockrand::compare
