#include <cmath>
#include <random>

#include "tests/unit/grammar/shapes/shapes_support.h"

namespace blockrand::grammar {
namespace {

constexpr Mark relative = Mark::relative, floating = Mark::floating;

TEST(SplitSizes, AbsoluteSizesFillUp) {  // docs/rule_language.md §7.4, 7
  EXPECT_EQ(pieces_text({item('A', 2), item('B', 1), item('C', 1), item('D', 2), item('E', 1)}, false, 5),
            "A 2 B 1 C 1 D 1");
}
TEST(SplitSizes, NegativeAndZeroSizesAreNothing) {  // 8
  EXPECT_EQ(pieces_text({item('A', 1.5), item('B', -2), item('C', 1.5), item('D', 1.5), item('E', 0), item('F', 1.5)},
                        false, 5),
            "A 1.5 C 1.5 D 1.5 F 0.5");
}
TEST(SplitSizes, RelativeSizes) {  // 9, 12
  EXPECT_EQ(pieces_text({item('A', 0.5, relative), item('B', 0.1, relative), item('C', 0.2, relative)}, false, 10),
            "A 5 B 1 C 2");
  EXPECT_EQ(pieces_text({item('A', 0.5, relative), item('B', 0.6, relative), item('C', 3)}, false, 10), "A 5 B 5");
}
TEST(SplitSizes, FloatingSizesShareTheRest) {  // 10, 11, 12
  EXPECT_EQ(pieces_text({item('A', 0.5, floating), item('B', 0.1, floating), item('C', 0.2, floating)}, false, 10),
            "A 6.25 B 1.25 C 2.5");
  EXPECT_EQ(pieces_text({item('A', 3.3), item('B', 3, floating), item('C', 5)}, false, 10), "A 3.3 B 1.7 C 5");
  EXPECT_EQ(pieces_text({item('A', 3), item('B', 1, floating), item('C', 2)}, false, 5), "A 3 C 2");
}
TEST(SplitSizes, RepeatCutsTheLast) {  // 13
  EXPECT_EQ(pieces_text({item('A', 2), item('B', 1)}, true, 10), "A 2 B 1 A 2 B 1 A 2 B 1 A 1");
}
TEST(SplitSizes, RepeatOfFloatingSizesTakesTheNearestStretch) {  // 14
  EXPECT_EQ(pieces_text({item('A', 2, floating), item('B', 1, floating)}, true, 10),
            "A 2.222 B 1.111 A 2.222 B 1.111 A 2.222 B 1.111");
  EXPECT_EQ(pieces_text({item('A', 2.1, floating)}, true, 10), "A 2 A 2 A 2 A 2 A 2");
}
TEST(SplitSizes, InterleavedRepeats) {  // 15, 16
  EXPECT_EQ(pieces_text({item('A', 1), block(3, true), item('B', 1, floating), item('C', 0.2), item('B', 1, floating),
                         item('A', 1)},
                        false, 10),
            "A 1 B 0.9 C 0.2 B 0.9 B 0.9 C 0.2 B 0.9 B 0.9 C 0.2 B 0.9 B 0.9 C 0.2 B 0.9 A 1");
  EXPECT_EQ(pieces_text({block(2, true), item('A', 1), item('B', 2.7, floating), item('A', 1)}, false, 10),
            "A 1 B 2 A 1 B 2 A 1 B 2 A 1");
}
TEST(SplitSizes, TenTimesATenthIsTen) {  // 17
  EXPECT_EQ(split_sizes(std::vector<SplitItem>{item('A', 0.1, relative), item('B', 0.1, relative)}, true, 10).size(),
            10u);
  EXPECT_EQ(split_sizes(std::vector<SplitItem>{item('A', 0.1)}, true, 1).size(), 10u);
}
TEST(SplitSizes, FloatingSizesBesideARepeatAreSolvedTogether) {
  // { ~1 : X | 0.5 : Y }* | ~1 : X: three X and two Y on 4, all X alike.
  EXPECT_EQ(pieces_text({block(2, true), item('X', 1, floating), item('Y', 0.5), item('X', 1, floating)}, false, 4),
            "X 1 Y 0.5 X 1 Y 0.5 X 1");
  EXPECT_EQ(pieces_text({item('L', 1, floating), block(1, true), item('W', 1.5), item('R', 1, floating)}, false, 10),
            "L 1.25 W 1.5 W 1.5 W 1.5 W 1.5 W 1.5 R 1.25");
}
TEST(SplitSizes, RepeatWithoutFloatingSizesFillsWhatIsLeft) {
  EXPECT_EQ(pieces_text({item('A', 1), block(1, true), item('B', 2), item('C', 1)}, false, 10),
            "A 1 B 2 B 2 B 2 B 2 C 1");
}
TEST(SplitSizes, NestedBlocksWithoutRepeatAreFlat) {
  EXPECT_EQ(pieces_text({item('A', 1), block(2, false), item('B', 1, floating), item('C', 1, floating), item('D', 1)},
                        false, 10),
            "A 1 B 4 C 4 D 1");
}
TEST(SplitSizes, BadInputGivesFewPiecesNotMany) {
  EXPECT_TRUE(split_sizes(std::vector<SplitItem>{item('A', 0)}, true, 10).empty());
  EXPECT_TRUE(split_sizes(std::vector<SplitItem>{item('A', -1, floating)}, true, 10).empty());
  EXPECT_TRUE(split_sizes(std::vector<SplitItem>{item('A', 1)}, true, 0).empty());
  EXPECT_TRUE(split_sizes(std::vector<SplitItem>{item('A', 1)}, true, std::nan("")).empty());
  EXPECT_TRUE(split_sizes(std::vector<SplitItem>{item('A', std::nan(""))}, false, 10).empty());
  EXPECT_TRUE(split_sizes({}, true, 10).empty());
  EXPECT_LE(split_sizes(std::vector<SplitItem>{item('A', 1e-9, floating)}, true, 10).size(), kMostPieces);
  EXPECT_EQ(split_sizes(std::vector<SplitItem>{block(7, true), item('A', 1)}, false, 10).size(),
            10u);  // head reaches too far
}

TEST(SplitSizes, PiecesNeverLeaveTheLengthAndNeverOverlap) {
  std::mt19937 random(7);
  const auto number = [&](double low, double high) { return low + (high - low) * (random() % 10000) / 10000.0; };
  for (int round = 0; round < 20000; ++round) {
    std::vector<SplitItem> items;
    const int count = 1 + static_cast<int>(random() % 6);
    for (int i = 0; i < count; ++i) {
      if (random() % 4 == 0) items.push_back(block(1 + static_cast<int>(random() % 3), random() % 2 == 0));
      items.push_back(item('A', number(-0.2, 3), static_cast<Mark>(random() % 3)));
    }
    const double length = number(0.01, 20);
    double at = 0;
    for (const SplitPiece& piece : split_sizes(items, random() % 2 == 0, length)) {
      ASSERT_GE(piece.from, at - 1e-12);
      ASSERT_GT(piece.to, piece.from);
      ASSERT_LE(piece.to, length);
      at = piece.to;
    }
  }
}

TEST(Split, HalfAHouseIsCapped) {  // 6
  const Shape house = after(rectangle(10, 20), "extrude", {plain(10)});
  const auto pieces = split(house, 0, {item('X', 1, floating), item('N', 1, floating)});
  ASSERT_EQ(pieces.size(), 2u);
  for (const Shape& piece : pieces) {
    EXPECT_EQ(piece.size, (Vector3{5, 10, 20}));
    EXPECT_NEAR(volume(piece), 1000, 1e-9);
    EXPECT_EQ(geometry_face_count(piece), 6);
    EXPECT_EQ(geometry_vertex_count(piece), 8);
    EXPECT_EQ(geometry_edge_count(piece), 12);
    expect_sound(piece, true);
  }
  EXPECT_EQ(pieces[1].split.index, 1);
  EXPECT_EQ(pieces[1].split.total, 2);
  EXPECT_EQ(pieces[1].scope.origin, (Vector3{5, 0, -20}));
}

TEST(Split, AdjustRefitsNoAdjustTiles) {  // 18
  const std::vector<SplitItem> half{item('A', 0.5, Mark::relative), item('B', 0.5, Mark::relative)};
  const auto slabs = split(triangle(), 0, half, false, false);
  ASSERT_EQ(slabs.size(), 2u);
  EXPECT_DOUBLE_EQ(slabs[0].size.z, 10);
  EXPECT_DOUBLE_EQ(slabs[1].size.z, 10);
  EXPECT_NEAR(geometry_area(slabs[0]), 37.5, 1e-9);
  const auto fitted = split(triangle(), 0, half);
  EXPECT_DOUBLE_EQ(fitted[0].size.z, 10);
  EXPECT_DOUBLE_EQ(fitted[1].size.z, 5);
  EXPECT_NEAR(geometry_area(fitted[1]), 12.5, 1e-9);
  EXPECT_DOUBLE_EQ(fitted[1].scope.origin.z, -5);
}

TEST(Split, KeepsTheFirstEdge) {
  // Along x the first edge is cut; the piece of it leads. Along z the front piece keeps it; in the other the
  // edge of the cut takes its place.
  for (const Shape& piece : split(rectangle(10, 20), 0, {item('A', 1, floating), item('B', 1, floating)})) {
    const Mesh& mesh = mesh_of(piece);
    const Loop& loop = mesh.faces[0].loops[0];
    const Vector3 way = mesh.vertices[loop[1].vertex] - mesh.vertices[loop[0].vertex];
    EXPECT_EQ(way, (Vector3{5, 0, 0}));
    EXPECT_EQ(mesh.vertices[loop[0].vertex].z, 20);
  }
  const auto pieces = split(rectangle(10, 20), 2, {item('A', 1, floating), item('B', 1, floating)});
  const auto first = [](const Shape& s) {
    const Loop& loop = mesh_of(s).faces[0].loops[0];
    return mesh_of(s).vertices[loop[1].vertex] - mesh_of(s).vertices[loop[0].vertex];
  };
  EXPECT_EQ(first(pieces[0]), (Vector3{10, 0, 0}));  // the back
  EXPECT_EQ(first(pieces[1]), (Vector3{10, 0, 0}));
}

TEST(Split, ConcaveSolidsFallApartAndStayClosed) {
  const Shape house = after(u_shape(), "extrude", {plain(3)});
  const auto pieces = split(house, 2, {item('A', 12), item('B', 8)});
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_NEAR(volume(pieces[0]), 3 * (20 * 10 + 2 * 2 * 5), 1e-9);
  EXPECT_NEAR(volume(pieces[1]), 3 * 8 * 10, 1e-9);
  for (const Shape& piece : pieces) expect_sound(piece, true);
  EXPECT_EQ(geometry_face_count(pieces[1]), 12);  // two legs
}

TEST(Split, ThroughTheInnerCornerOfAnL) {
  const Shape house = after(l_shape(), "extrude", {plain(3)});
  for (const int axis : {0, 2}) {
    const auto pieces = split(house, axis, {item('A', 10), item('B', 10)});
    ASSERT_EQ(pieces.size(), 2u);
    for (const Shape& piece : pieces) expect_sound(piece, true);
    EXPECT_NEAR(volume(pieces[0]) + volume(pieces[1]), 900, 1e-9);
  }
}

TEST(Split, HolesAreCutOpen) {
  const std::vector<InitialPolygon> polygon{
      {{{0, 0, 0}, {10, 0, 0}, {10, 0, -10}, {0, 0, -10}}, {{{3, 0, -3}, {7, 0, -3}, {7, 0, -7}, {3, 0, -7}}}}};
  const Shape court = initial_shape(polygon);
  EXPECT_NEAR(geometry_area(court), 84, 1e-9);
  EXPECT_EQ(geometry_hole_count(court), 1);
  const Shape house = after(court, "extrude", {plain(2)});
  expect_sound(house, true);
  EXPECT_NEAR(volume(house), 168, 1e-9);
  const auto pieces = split(house, 0, {item('A', 2), item('B', 3), item('C', 5)});
  ASSERT_EQ(pieces.size(), 3u);
  for (const Shape& piece : pieces) expect_sound(piece, true);
  EXPECT_NEAR(volume(pieces[1]), 2 * (30 - 8), 1e-9);
  const auto floors = split(house, 1, {item('A', 1), item('B', 1)});
  for (const Shape& piece : floors) {
    expect_sound(piece, true);
    EXPECT_NEAR(volume(piece), 84, 1e-9);
    EXPECT_EQ(geometry_face_count(piece), 10);
    EXPECT_EQ(geometry_hole_count(piece), 2);
  }
}

TEST(Split, NegativeSizesCountFromTheOrigin) {
  Shape house = after(rectangle(10, 20), "extrude", {plain(-4)});
  EXPECT_EQ(house.size, (Vector3{10, -4, 20}));
  expect_sound(house, true);
  const auto pieces = split(house, 1, {item('A', 1), item('B', 3)});
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_NEAR(volume(pieces[0]), 200, 1e-9);
  EXPECT_NEAR(volume(pieces[1]), 600, 1e-9);
  EXPECT_EQ(pieces[1].scope.origin.y, -1);
  EXPECT_EQ(pieces[1].size.y, -3);
}

TEST(Split, UvAndTagsAreKept) {
  Shape cube = rectangle(4, 4);
  run(cube, "primitiveCube", {plain(4), plain(4), plain(4)});
  const auto pieces = split(cube, 0, {item('A', 1), item('B', 3)});
  expect_sound(pieces[0], true);
  expect_sound(pieces[1], true);
  EXPECT_NEAR(geometry_uv_extent(components(pieces[0], ComponentKind::groups).parent, false, false, 0), 1, 1e-9);
  const auto front = taken(pieces[0], ComponentKind::faces, {"front"})[0];
  ASSERT_EQ(front.size(), 1u);
  EXPECT_NEAR(geometry_uv_extent(front[0], false, false, 0), 0.25, 1e-12);
}

TEST(Split, RandomPrismsKeepVolumeAndStayClosed) {
  std::mt19937 random(11);
  const auto number = [&](double low, double high) { return low + (high - low) * (random() % 100000) / 100000.0; };
  for (int round = 0; round < 300; ++round) {
    // A star-shaped outline: often concave.
    std::vector<std::pair<double, double>> outline;
    const int n = 3 + static_cast<int>(random() % 9);
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * 3.14159265358979 * (i + 0.4 * number(0, 1)) / n, r = number(2, 12);
      outline.emplace_back(r * std::cos(angle), -r * std::sin(angle));
    }
    if (round % 3 == 0)  // on a coarse raster: many corners in one plane
      for (auto& [x, z] : outline) x = std::round(x / 2) * 2, z = std::round(z / 2) * 2;
    const Shape plan = lot(outline);
    if (!plan.mesh || geometry_area(plan) < 1) continue;
    Shape solid = after(plan, "extrude", {plain(number(1, 9))});
    const double whole = volume(solid);
    if (!geometry_is_closed(solid) || whole <= 0) continue;
    for (int step = 0; step < 3; ++step) {
      const int axis = static_cast<int>(random() % 3);
      const double length = split_length(solid, axis);
      std::vector<SplitItem> items;
      const double part = round % 3 == 0 && axis != 1 ? 2 : number(0.1, 0.9) * length;
      items.push_back(item('A', part));
      items.push_back(item('B', 1, floating));
      double sum = 0;
      const auto pieces = split(solid, axis, items, round % 5 == 0);
      for (const Shape& piece : pieces) {
        if (!piece.mesh) continue;
        EXPECT_TRUE(geometry_is_closed(piece)) << "round " << round << " step " << step;
        sum += volume(piece);
      }
      EXPECT_NEAR(sum, volume(solid), 1e-6 * whole) << "round " << round << " step " << step << " axis " << axis;
      if (pieces.empty() || !pieces.back().mesh) break;
      solid = pieces.back();
    }
  }
}

TEST(Split, SplitAreaSharesTheArea) {
  const Shape plan = triangle();
  const auto sizes =
      split_sizes(std::vector<SplitItem>{item('A', 20), item('B', 1, floating)}, false, split_area_total(plan));
  const auto pieces = split_area(plan, 0, sizes);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_NEAR(geometry_area(pieces[0]), 20, 1e-6);
  EXPECT_NEAR(geometry_area(pieces[1]), 30, 1e-6);
}

}  // namespace
}  // namespace blockrand::grammar
