#include <random>

#include "styles/grammar/shapes/pieces.h"
#include "tests/unit/grammar/shapes/shapes_support.h"

namespace blockrand::grammar {
namespace {

std::vector<double> distances(const Shape& shape, std::string_view selector, double d) {
  const ComponentSplit edges = setback_edges(shape);
  std::vector<double> out;
  for (std::size_t i = 0; i < edges.items.size(); ++i)
    out.push_back(selected(edges, i, *selector_of_word(selector)) ? d : 0);
  return out;
}

Vector3 first_edge(const Shape& shape, bool end = false) {
  const Mesh& mesh = mesh_of(shape);
  return place(scope_in_world(shape), mesh.vertices[mesh.faces[0].loops[0][end ? 1 : 0].vertex]);
}

double total(const std::vector<Shape>& shapes) {
  double sum = 0;
  for (const Shape& s : shapes) sum += geometry_area(s);
  return sum;
}

TEST(Offset, InsideAndBorder) {  // docs/rule_language.md §7.4, 25
  const Shape ring = after(rectangle(10, 20), "offset", {plain(-1)});
  const ComponentSplit parts = components(ring, ComponentKind::faces);
  double inner = 0, border = 0;
  for (std::size_t i = 0; i < parts.items.size(); ++i)
    (selected(parts, i, *selector_of_word("inside")) ? inner : border) += geometry_area(component_shape(parts, i));
  EXPECT_NEAR(inner, 144, 1e-4);
  EXPECT_NEAR(border, 56, 1e-4);
  EXPECT_EQ(parts.items.size(), 5u);
  const Shape inside = after(rectangle(10, 20), "offset", {plain(-1), word("inside")});
  EXPECT_NEAR(inside.size.x, 8, 1e-5);
  EXPECT_NEAR(inside.size.z, 18, 1e-5);
  EXPECT_NEAR(first_edge(inside).z, -1, 1e-5);
  EXPECT_NEAR(first_edge(inside, true).x - first_edge(inside).x, 8, 1e-5);
  EXPECT_NEAR(geometry_area(after(rectangle(10, 20), "offset", {plain(-1), word("border")})), 56, 1e-4);
  EXPECT_NE(error_of(inside, "offset", {plain(-1), word("outside")}), "");
}

TEST(Offset, OutwardsTheBorderLooksDown) {
  const Shape ring = after(rectangle(10, 20), "offset", {plain(1)});
  EXPECT_EQ(geometry_face_count(ring), 5);
  EXPECT_NEAR(ring.size.x, 12, 1e-5);
  double sum = 0;
  const Mesh& mesh = mesh_of(ring);
  for (const MeshFace& face : mesh.faces) sum += area_vector(mesh, face).y / 2;
  EXPECT_NEAR(sum, 200, 1e-3);
  const ComponentSplit parts = components(ring, ComponentKind::faces);
  EXPECT_TRUE(selected(parts, 0, *selector_of_word("inside")));
  for (std::size_t i = 1; i < 5; ++i) EXPECT_TRUE(selected(parts, i, *selector_of_word("border")));
}

TEST(Offset, NothingLeftKeepsTheFace) {
  const Shape kept = after(rectangle(10, 20), "offset", {plain(-6)});
  EXPECT_EQ(geometry_face_count(kept), 1);
  EXPECT_NEAR(geometry_area(kept), 200, 1e-9);
}

TEST(Offset, AUFallsIntoParts) {
  const Shape inside = after(u_shape(), "offset", {plain(-2.6), word("inside")});
  EXPECT_EQ(geometry_face_count(inside), 1);  // the legs of 5 m are gone
  const Shape two = after(lot({{0, 0},
                               {10, 0},
                               {10, -4},
                               {20, -4},
                               {20, 0},
                               {30, 0},
                               {30, -10},
                               {20, -10},
                               {20, -6},
                               {10, -6},
                               {10, -10},
                               {0, -10}}),
                          "offset", {plain(-2), word("inside")});
  EXPECT_EQ(geometry_face_count(two), 2);
  EXPECT_NEAR(geometry_area(two), 72, 1e-3);
}

TEST(Setback, FrontStrip) {  // 26
  const Shape shape = rectangle(10, 20);
  const SetbackPieces pieces = setback_pieces(shape, distances(shape, "front", 3));
  ASSERT_EQ(pieces.pieces.size(), 4u);
  ASSERT_TRUE(pieces.pieces[0].has_value());
  EXPECT_FALSE(pieces.pieces[1].has_value());
  EXPECT_NEAR(geometry_area(*pieces.pieces[0]), 30, 1e-6);
  ASSERT_TRUE(pieces.remainder.has_value());
  EXPECT_NEAR(geometry_area(*pieces.remainder), 170, 1e-6);
  EXPECT_NEAR(first_edge(*pieces.pieces[0]).z, 0, 1e-9);
  EXPECT_NEAR(first_edge(*pieces.pieces[0], true).x, 10, 1e-9);
  EXPECT_NEAR(first_edge(*pieces.remainder).z, -3, 1e-5);
  EXPECT_NEAR(first_edge(*pieces.remainder, true).x, 10, 1e-5);
  EXPECT_TRUE(geometry_is_tagged(*pieces.pieces[0], "setback.front"));
}

TEST(Setback, OfAllEdgesDifferently) {
  const Shape shape = rectangle(10, 20);
  const SetbackPieces pieces = setback_pieces(shape, std::vector<double>{1, 2, 3, 4});
  double sum = 0;
  for (const auto& piece : pieces.pieces) sum += geometry_area(*piece);
  EXPECT_NEAR(geometry_area(*pieces.remainder), 4 * 16, 1e-3);
  EXPECT_NEAR(sum + geometry_area(*pieces.remainder), 200, 1e-3);
  // Wider than the lot: nothing remains.
  EXPECT_FALSE(setback_pieces(shape, distances(shape, "front", 30)).remainder.has_value());
  // Nothing set back: all remains.
  EXPECT_NEAR(geometry_area(*setback_pieces(shape, distances(shape, "front", 0)).remainder), 200, 1e-9);
}

TEST(Setback, OfAFacade) {
  const Shape wall = taken(after(rectangle(10, 20), "extrude", {plain(6)}), ComponentKind::faces, {"front"})[0].at(0);
  const SetbackPieces pieces = setback_pieces(wall, distances(wall, "top", 1));
  EXPECT_NEAR(geometry_area(*pieces.remainder), 50, 1e-4);
  EXPECT_NEAR(pieces.remainder->size.y, 5, 1e-5);
  EXPECT_NEAR(scope_in_world(*pieces.remainder).axes[2].z, 1, 1e-12);
}

TEST(Setback, ToArea) {  // 28
  const Shape shape = rectangle(20, 20);
  const std::vector<std::size_t> all{0, 1, 2, 3};
  const auto d = setback_to_area(shape, all, 100, {}, {});
  const SetbackPieces pieces = setback_pieces(shape, d);
  EXPECT_NEAR(geometry_area(*pieces.remainder), 100, 1e-3);
  EXPECT_NEAR(pieces.remainder->size.x, 10, 1e-4);
  EXPECT_NEAR(pieces.remainder->size.z, 10, 1e-4);
  const auto bounded =
      setback_to_area(shape, all, 100, std::vector<double>{1, 0, 0, 0}, std::vector<double>{9, 2, 9, 9});
  EXPECT_NEAR(bounded[0] - bounded[2], 1, 1e-9);
  EXPECT_LE(bounded[1], 2);
}

TEST(ShapeLUO, Areas) {  // 27
  const Shape shape = rectangle(10, 20);
  const auto l = shape_lu_o_pieces(shape, 4, 0, 0, 5);
  EXPECT_NEAR(total(l.shapes), 120, 1e-3);
  EXPECT_NEAR(total(l.remainders), 80, 1e-3);
  ASSERT_EQ(l.shapes.size(), 1u);
  EXPECT_EQ(geometry_face_count(l.shapes[0]), 1);
  EXPECT_EQ(geometry_vertex_count(l.shapes[0]), 6);
  EXPECT_NEAR(first_edge(l.shapes[0]).z, 0, 1e-9);
  const auto u = shape_lu_o_pieces(shape, 4, 3, 0, 2);
  EXPECT_NEAR(total(u.shapes), 120, 1e-3);
  EXPECT_NEAR(total(u.remainders), 80, 1e-3);
  const auto o = shape_lu_o_pieces(shape, 4, 3, 2, 1);
  EXPECT_NEAR(total(o.shapes), 116, 1e-3);
  EXPECT_NEAR(total(o.remainders), 84, 1e-3);
  EXPECT_EQ(geometry_hole_count(o.shapes[0]), 1);
}

TEST(InnerRectangle, OfAnL) {  // 29
  const auto pieces = inner_rectangle_pieces(l_shape(), false);
  EXPECT_NEAR(total(pieces.shapes), 200, 1e-6);
  EXPECT_NEAR(total(pieces.remainders), 100, 1e-6);
  EXPECT_TRUE(geometry_is_rectangular(pieces.shapes[0], 0));
  EXPECT_NEAR(geometry_area(after(l_shape(), "innerRect")), 200, 1e-6);
}

TEST(InnerRectangle, OfATriangleAndAlongEdges) {
  EXPECT_NEAR(total(inner_rectangle_pieces(triangle(), false).shapes), 25, 0.6);
  const double c = std::cos(0.4), s = std::sin(0.4);
  const Shape turned =
      lot({{0, 0}, {1, 0}, {1 + 10 * c, -10 * s}, {1 + 10 * c - 5 * s, -10 * s - 5 * c}, {1 - 5 * s, -5 * c}});
  const auto pieces = inner_rectangle_pieces(turned, true);
  EXPECT_GT(total(pieces.shapes), 49.9);
  EXPECT_NEAR(total(pieces.shapes) + total(pieces.remainders), geometry_area(turned), 1e-6);
}

TEST(MergePieces, KeepsPlaces) {
  const Shape shape = rectangle(10, 20);
  const SetbackPieces pieces = setback_pieces(shape, std::vector<double>{1, 0, 1, 0});
  const std::vector<Shape> both{*pieces.pieces[0], *pieces.pieces[2]};
  const Shape merged = *merge_pieces(both);
  EXPECT_EQ(geometry_face_count(merged), 2);
  EXPECT_NEAR(merged.size.z, 20, 1e-5);
  EXPECT_NEAR(geometry_area(merged), 20, 1e-4);
  EXPECT_FALSE(merge_pieces({}).has_value());
}

TEST(Setback, RandomLotsKeepTheirArea) {
  std::mt19937 random(17);
  const auto number = [&](double low, double high) { return low + (high - low) * (random() % 100000) / 100000.0; };
  for (int round = 0; round < 200; ++round) {
    std::vector<std::pair<double, double>> outline;
    const int n = 3 + static_cast<int>(random() % 8);
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * 3.14159265358979 * (i + 0.4 * number(0, 1)) / n, r = number(5, 15);
      outline.emplace_back(r * std::cos(angle), -r * std::sin(angle));
    }
    const Shape plan = lot(outline);
    const double area = geometry_area(plan);
    std::vector<double> d;
    for (int i = 0; i < n; ++i) d.push_back(random() % 3 == 0 ? 0 : number(0.2, 4));
    const SetbackPieces pieces = setback_pieces(plan, d);
    double sum = pieces.remainder ? geometry_area(*pieces.remainder) : 0;
    for (const auto& piece : pieces.pieces)
      if (piece) sum += geometry_area(*piece);
    EXPECT_NEAR(sum, area, 1e-4 * area) << "round " << round;
    EXPECT_NEAR(geometry_area(after(plan, "offset", {plain(-number(0.1, 3))})), area, 1e-4 * area) << "round " << round;
  }
}

}  // namespace
}  // namespace blockrand::grammar
