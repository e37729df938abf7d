// A small square of surroundings made by hand: a street with kerbs, a lawn with a hole, water, a wall, a track, trees, a lamp.
#pragma once

#include <utility>
#include <vector>

#include "pipeline/model/surroundings.h"

namespace blockrand::outputs::test {

inline constexpr double kWest = 391000, kSouth = 5819000, kGround = 35;  // m

inline model::Point3 at(double x, double y, double z = 0) { return {kWest + x, kSouth + y, kGround + z}; }

inline model::FlatPolygon rectangle(double west, double south, double east, double north, double z = 0) {
  return {{at(west, south, z), at(east, south, z), at(east, north, z), at(west, north, z)}, {}};
}

/// A cuboid, seen from outside.
inline std::vector<model::FlatPolygon> cuboid(double west, double south, double east, double north, double top) {
  const auto side = [&](double x0, double y0, double x1, double y1) {
    return model::FlatPolygon{{at(x0, y0), at(x1, y1), at(x1, y1, top), at(x0, y0, top)}, {}};
  };
  model::FlatPolygon floor = rectangle(west, south, east, north);
  std::swap(floor.outer[1], floor.outer[3]);
  return {rectangle(west, south, east, north, top), floor,
          side(west, south, east, south),           side(east, south, east, north),
          side(east, north, west, north),           side(west, north, west, south)};
}

inline model::SurroundingCatalogue sample_catalogue() {
  model::SurroundingCatalogue out;
  out.materials = {{"asphalt", {90, 90, 92}}, {"grass", {110, 150, 70}},           {"water", {70, 100, 120}, 0.1f},
                   {"brick", {150, 80, 60}},  {"steel", {140, 140, 145}, 0.4f, 1}, {"leaves & <bark>", {80, 120, 60}}};
  model::ObjectShape tree;
  tree.name = "tree_broadleaved_medium";
  tree.kind = "tree";
  tree.theme = model::ObjectTheme::vegetation;
  tree.parts = {{3, {{-0.2, -0.2, 0}, {0.2, -0.2, 0}, {0, 0, 4}, {0.2, -0.2, 0}, {0.2, -0.2, 0}, {0, 0, 4}}},
                {5, {{-3, -2, 4}, {3, -2, 4}, {0, 0, 10}}}};
  tree.min = {-3, -2, 0};
  tree.max = {3, 2, 10};
  model::ObjectShape lamp;
  lamp.name = "lamp_pole";
  lamp.kind = "street_lamp";
  lamp.parts = {{4, {{-0.1, 0, 0}, {0.1, 0, 0}, {0, 0, 6}}}};
  lamp.min = {-0.1, 0, 0};
  lamp.max = {0.1, 0, 6};
  model::ObjectShape mast;
  mast.name = "mast";
  mast.kind = "mast";
  mast.theme = model::ObjectTheme::other;
  mast.max = {0, 0, 12};
  out.shapes = {tree, lamp, mast};
  return out;
}

inline model::Surroundings sample_surroundings() {
  using enum model::OsmType;
  model::Surroundings out;
  // The street lies in two squares of the grid, which meet at y = 10.
  for (const double south : {0.0, 10.0}) {
    model::GroundSurface street{model::GroundClass::carriageway, {way, 10}, 0, -0.125f, {}, {}};
    street.faces = {rectangle(0, south, 6, south + 10, -0.125)};
    model::GroundSurface pavement{model::GroundClass::pavement, {way, 10}, 0, 0, {}, {}};
    pavement.faces = {rectangle(6, south, 8, south + 10)};
    pavement.edges = {{{at(6, south + 10), at(6, south + 10, -0.125), at(6, south, -0.125), at(6, south)}, {}}};
    out.surfaces.push_back(street);
    out.surfaces.push_back(pavement);
  }
  model::GroundSurface lawn{model::GroundClass::grass, {relation, 20}, 1, 0.03125f, {}, {}};
  lawn.faces = {rectangle(8, 0, 20, 20)};
  std::vector<model::Point3> hole = rectangle(10, 5, 14, 9).outer;
  lawn.faces.front().holes = {{hole.rbegin(), hole.rend()}};
  out.surfaces.push_back(lawn);
  // Two triangles hang together, the third lies apart.
  model::GroundSurface pond{model::GroundClass::water, {way, 30}, 2, 0, {}, {}};
  pond.faces = {{{at(10, 5), at(14, 5), at(14, 9)}, {}},
                {{at(10, 5), at(14, 9), at(10, 9)}, {}},
                {{at(16, 12), at(18, 12), at(18, 14)}, {}}};
  out.surfaces.push_back(pond);
  model::GroundSurface land{model::GroundClass::land, {}, 1, 0, {rectangle(20, 0, 22, 20)}, {}};
  out.surfaces.push_back(land);
  land.faces = {rectangle(22, 0, 24, 20)};
  out.surfaces.push_back(land);
  model::GroundSurface bed{model::GroundClass::rail_bed, {way, 50}, 3, 0, {rectangle(24, 0, 28, 20)}, {}};
  out.surfaces.push_back(bed);
  model::GroundSurface wood{model::GroundClass::wood, {way, 60}, 1, 0, {rectangle(28, 0, 30, 20)}, {}};
  out.surfaces.push_back(wood);
  // Nothing is left of it on the grid.
  model::GroundSurface sliver{model::GroundClass::sand, {way, 61}, 1, 0, {rectangle(30, 0, 30.0001, 20)}, {}};
  out.surfaces.push_back(sliver);

  out.bodies.push_back({model::BodyClass::wall, {way, 40}, 3, true, cuboid(8, 0, 8.25, 20, 2)});
  out.bodies.push_back({model::BodyClass::hedge, {way, 41}, 1, true, cuboid(19, 0, 20, 20, 1.5)});
  out.bodies.push_back({model::BodyClass::rail, {way, 50}, 4, true, cuboid(25, 0, 25.125, 20, 0.125)});
  out.bodies.push_back({model::BodyClass::bridge, {way, 70}, 0, true, cuboid(0, 30, 10, 34, 1)});
  out.bodies.push_back({model::BodyClass::bridge, {way, 70}, 3, true, cuboid(0, 30, 10, 30.5, 2)});
  out.bodies.push_back({model::BodyClass::bridge, {way, 71}, 3, true, cuboid(20, 30, 30, 34, 2)});
  out.bodies.push_back(
      {model::BodyClass::fence, {way, 42}, 4, false, {{{at(0, 25), at(5, 25), at(5, 25, 1), at(0, 25, 1)}, {}}}});
  out.bodies.push_back(
      {model::BodyClass::power_line, {way, 43}, 4, false, {{{at(0, 26), at(5, 26), at(5, 26, 1)}, {}}}});
  out.bodies.push_back({model::BodyClass::marking, {way, 10}, 4, false, {rectangle(3, 0, 3.125, 2, -0.12)}});

  out.objects.push_back({0, {way, 60}, at(29, 5), 0, 1, 1});
  out.objects.push_back({0, {node, 80}, at(12, 15, 0.0625), 1.5707964f, 0.5f, 1.25f});
  out.objects.push_back({1, {node, 81}, at(7, 3), 0, 1, 1});
  out.objects.push_back({2, {node, 82}, at(21, 3), 0, 1, 1});
  return out;
}

}  // namespace blockrand::outputs::test
