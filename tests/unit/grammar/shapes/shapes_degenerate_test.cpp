#include <cmath>
#include <random>

#include "styles/grammar/shapes/pieces.h"
#include "tests/unit/grammar/shapes/shapes_support.h"

namespace blockrand::grammar {
namespace {

/// Lots as they should not be.
std::vector<Shape> bad_lots() {
  std::vector<Shape> out{
      lot({{0, 0}, {10, 0}, {10, -10}, {0, -10}, {10, -5}}),                      // crosses itself
      lot({{0, 0}, {10, -10}, {10, 0}, {0, -10}}),                                // a bow tie
      lot({{0, 0}, {10, 0}, {10, -0.0005}, {0, -0.0005}}),                        // a sliver
      lot({{0, 0}, {20, 0}, {10, -0.01}}),                                        // a needle
      lot({{0, 0}, {5, 0}, {10, 0}, {10, -5}, {10, -10}, {5, -10}, {0, -10}}),    // straight corners
      lot({{0, 0}, {10, 0}, {10, -10}, {5, -10}, {5, -15}, {5, -10}, {0, -10}}),  // a spike
      lot({{0, 0}, {1e-3, 0}, {1e-3, -1e-3}, {0, -1e-3}}),                        // tiny
      lot({{0, 0}, {1e6, 0}, {1e6, -1e6}, {0, -1e6}}),                            // huge
      lot({{0, 0}, {0, -10}, {10, -10}, {10, 0}}),                                // clockwise: looks down
      initial_shape({{0, 0, 0}, {10, 0, 0}, {10, 3, -10}, {0, -3, -10}}),         // not plane
      initial_shape({{1e7, 0, 0}, {1e7 + 10, 0, 0}, {1e7 + 10, 0, -10}, {1e7, 0, -10}}),
  };
  const std::vector<Vector3> outline{{0, 0, 0}, {10, 0, 0}, {10, 0, -10}, {0, 0, -10}};
  for (const std::vector<Vector3>& hole : {std::vector<Vector3>{{0, 0, 0}, {4, 0, -4}, {0, 0, -4}},      // touches
                                           std::vector<Vector3>{{20, 0, 0}, {24, 0, 0}, {24, 0, -4}},    // outside
                                           std::vector<Vector3>{{3, 0, -3}, {15, 0, -3}, {15, 0, -7}},   // crosses
                                           std::vector<Vector3>{{3, 0, -3}, {5, 0, -3}, {7, 0, -3}}}) {  // no area
    const std::vector<InitialPolygon> polygon{{outline, {hole}}};
    out.push_back(initial_shape(polygon));
  }
  return out;
}

void expect_finite(const Shape& shape) {
  for (const Vector3 p : mesh_of(shape).vertices)
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  ASSERT_TRUE(std::isfinite(shape.size.x) && std::isfinite(shape.size.y) && std::isfinite(shape.size.z));
  for (const MeshFace& face : mesh_of(shape).faces)
    for (const Loop& loop : face.loops)
      for (const Corner c : loop) {
        ASSERT_LT(c.vertex, mesh_of(shape).vertices.size());
        ASSERT_LT(c.edge_tags, mesh_of(shape).tag_sets.size());
      }
}

TEST(Degenerate, EveryOperationOnBadLots) {
  const std::vector<std::pair<std::string, std::vector<Argument>>> calls{
      {"extrude", {plain(3)}},
      {"extrude", {word("world.up"), plain(-2)}},
      {"extrude", {word("vertex.normal"), plain(1)}},
      {"extrude", {word("world.up.flatTop"), plain(2)}},
      {"taper", {plain(4)}},
      {"roofHip", {plain(30), plain(0.5)}},
      {"roofGable", {plain(30), plain(0.5), plain(0.2), plain(1)}},
      {"roofGable", {word("byHeight"), plain(3)}},
      {"roofShed", {plain(20), plain(2)}},
      {"roofPyramid", {plain(20)}},
      {"roofRidge", {plain(20)}},
      {"offset", {plain(-1)}},
      {"offset", {plain(2)}},
      {"offset", {plain(-1), word("inside")}},
      {"innerRect", {}},
      {"convexify", {}},
      {"cleanupGeometry", {word("all"), plain(0.5)}},
      {"rectify", {plain(10)}},
      {"footprint", {}},
      {"reverseNormals", {}},
      {"deleteHoles", {}},
      {"s", {plain(0), plain(1), relative(-1)}},
      {"rotateScope", {plain(30), plain(40), plain(50)}},
      {"alignScopeToAxes", {}},
      {"alignScopeToGeometry", {word("zUp"), word("any"), word("longest")}},
      {"alignScopeToGeometryBBox", {word("xz")}},
      {"mirror", {plain(1), plain(0), plain(1)}},
      {"mirrorScope", {plain(1), plain(1), plain(0)}},
      {"setPivot", {word("yzx"), plain(6)}},
      {"envelope", {word("normal"), plain(9), plain(3), plain(60)}},
      {"primitiveCylinder", {}},
      {"i", {text_of("a.obj")}},
      {"setupProjection", {plain(0), word("scope.xz"), floating(0), relative(0)}}};
  for (const Shape& shape : bad_lots())
    for (const auto& [name, arguments] : calls) {
      SCOPED_TRACE(name);
      const Shape once = after(shape, name, arguments);
      expect_finite(once);
      for (const auto& [next, more] : calls) expect_finite(after(once, next, more));
    }
}

TEST(Degenerate, PiecesAndComponentsOfBadLots) {
  for (const Shape& start : bad_lots())
    for (const Shape& shape : {start, after(start, "extrude", {plain(3)}), after(start, "roofHip", {plain(40)})}) {
      for (const auto kind :
           {ComponentKind::faces, ComponentKind::edges, ComponentKind::face_edges, ComponentKind::vertices,
            ComponentKind::face_vertices, ComponentKind::groups, ComponentKind::materials, ComponentKind::holes}) {
        const ComponentSplit parts = components(shape, kind);
        std::vector<std::size_t> all;
        for (std::size_t i = 0; i < parts.items.size(); ++i) {
          expect_finite(component_shape(parts, i));
          for (const char* name : {"top", "street.left", "object.side", "ridge", "uv.left", "nutant", "border"})
            (void)selected(parts, i, *selector_of_word(name));
          all.push_back(i);
        }
        if (const auto together = component_group(parts, all)) expect_finite(*together);
        (void)connected_sets(parts, all);
      }
      for (int axis = 0; axis < 3; ++axis)
        for (const Shape& piece :
             split(shape, axis, {item('A', 0.3, Mark::relative), item('B', 1, Mark::floating)}, true))
          expect_finite(piece);
      const std::vector<double> distances(setback_edges(shape).items.size(), 1.5);
      const SetbackPieces pieces = setback_pieces(shape, distances);
      for (const auto& piece : pieces.pieces)
        if (piece) expect_finite(*piece);
      for (const Shape& s : shape_lu_o_pieces(shape, 1, 2, 3, 4).shapes) expect_finite(s);
      for (const bool by_edge : {false, true})
        for (const Shape& s : inner_rectangle_pieces(shape, by_edge).shapes) expect_finite(s);
      for (const Shape& s : scatter(shape, ScatterDomain::volume, 3, ScatterDistribution::gaussian, "top", {0, 1, 0}))
        expect_finite(s);
      (void)geometry_angle(shape, "azimuth");
      (void)geometry_is_rectangular(shape, 5);
      (void)geometry_volume(shape);
      (void)split_area(
          shape, 0, split_sizes(std::vector<SplitItem>{item('A', 0.5, Mark::relative)}, true, split_area_total(shape)));
    }
}

TEST(Degenerate, NegativeSizesAllTheWay) {
  Shape house = after(rectangle(10, 20), "extrude", {plain(5)});
  for (const Vector3 k : {Vector3{-1, 1, 1}, Vector3{1, -1, 1}, Vector3{-1, -1, -1}}) {
    Shape x = house;
    run(x, "s", {relative(k.x), relative(k.y), relative(k.z)});
    for (int axis = 0; axis < 3; ++axis) {
      double sum = 0;
      for (const Shape& piece : split(x, axis, {item('A', 0.3, Mark::relative), item('B', 1, Mark::floating)})) {
        EXPECT_TRUE(geometry_is_closed(piece));
        sum += geometry_volume(piece);
        expect_sound(piece, false);
      }
      EXPECT_NEAR(sum, 1000, 1e-6);
    }
  }
}

TEST(Degenerate, DeepSplitsStayExact) {
  // A facade split again and again keeps its area.
  Shape wall = taken(after(rectangle(17.3, 20), "extrude", {plain(9.1)}), ComponentKind::faces, {"front"})[0].at(0);
  double sum = 0;
  for (const Shape& floor : split(wall, 1, {item('F', 2.9, Mark::floating)}, true))
    for (const Shape& tile : split(floor, 0, {item('T', 1.31, Mark::floating), item('W', 0.2)}, true))
      for (const Shape& part : split(tile, 1, {item('A', 0.7), item('B', 1, Mark::floating)}))
        sum += geometry_area(part);
  EXPECT_NEAR(sum, 17.3 * 9.1, 1e-9);
}

}  // namespace
}  // namespace blockrand::grammar
