// Houses whose measures are known: boxes, with what a comparison needs of them.
#pragma once

#include <string>
#include <vector>

#include "pipeline/compare/city.h"

namespace blockrand::compare::test {

/// A block with a flat roof: plan of `width` by `depth` around a centre, turned counter-clockwise.
struct Block {
  std::string id = "b";
  Point2 centre{};
  double width = 10, depth = 8, height = 6, ground = 0;  ///< m
  double turned = 0;                                     ///< rad
  std::vector<Point2> corners() const;                   ///< counter-clockwise
};

/// A building with faces for ground, roof and each wall, one footprint and one sound shell.
Building building_of(const Block& block);

/// A building on any plan (counter-clockwise), with a flat roof.
Building prism(const std::string& id, const std::vector<Point2>& plan, double ground, double height);

City city_of_blocks(std::vector<Building> buildings, bool absolute_heights = false);

/// Every face cut into `n` × `n` pieces of two triangles each (of faces with four corners).
Building tessellated(Building building, int n);

}  // namespace blockrand::compare::test
