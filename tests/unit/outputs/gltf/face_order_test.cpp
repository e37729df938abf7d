// The order of triangles along faces: what is drawn stays, columns of vertices follow each other.
#include "pipeline/outputs/gltf/face_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace blockrand::outputs {
namespace {

using Steps = std::array<std::int64_t, 3>;

/// A wall to the south of columns of vertices, and a roof; triangles from right to left.
struct Wall {
  std::vector<FaceCorner> corners;
  std::vector<std::uint16_t> indices;
};

Wall wall(std::uint16_t columns, std::uint16_t rows) {
  Wall out;
  for (std::uint16_t c = 0; c < columns; ++c)
    for (std::uint16_t r = 0; r < rows; ++r) out.corners.push_back({{c * 1000 + r % 2, 0, r * 700}, {0, -127, 0}});
  for (std::uint16_t c = columns - 1; c > 0; --c)
    for (std::uint16_t r = 0; r + 1 < rows; ++r) {
      const auto at = [&](int column, int row) { return static_cast<std::uint16_t>(column * rows + row); };
      out.indices.insert(out.indices.end(), {at(c - 1, r), at(c, r), at(c, r + 1)});
      out.indices.insert(out.indices.end(), {at(c - 1, r), at(c, r + 1), at(c - 1, r + 1)});
    }
  const auto first = static_cast<std::uint16_t>(out.corners.size());
  for (const Steps& s : {Steps{0, 0, 5000}, Steps{4000, 0, 5000}, Steps{4000, 3000, 5000}})
    out.corners.push_back({s, {0, 0, 127}});
  out.indices.insert(out.indices.end(), {first, std::uint16_t(first + 1), std::uint16_t(first + 2)});
  return out;
}

using Corner = std::pair<Steps, std::array<std::int8_t, 3>>;
std::multiset<std::array<Corner, 3>> triangles(const std::vector<FaceCorner>& corners,
                                               const std::vector<std::uint16_t>& indices) {
  std::multiset<std::array<Corner, 3>> out;
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    std::array<Corner, 3> c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = {corners.at(indices[t + k]).steps, corners.at(indices[t + k]).normal};
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());  // the same winding
    out.insert(c);
  }
  return out;
}

TEST(FaceOrder, ColumnsFollowEachOther) {
  const Wall before = wall(4, 5);
  std::vector<std::uint16_t> indices = before.indices;
  const std::vector<std::uint32_t> numbers = order_along_faces(indices, before.corners, 20);
  ASSERT_EQ(numbers.size(), before.corners.size());
  std::vector<FaceCorner> after(before.corners.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) after.at(numbers[i]) = before.corners[i];
  EXPECT_EQ(triangles(after, indices), triangles(before.corners, before.indices));
  // Vertices come as triangles ask for them, and after the first two columns each is in the column of the one before.
  std::uint16_t next = 0;
  for (const std::uint16_t i : indices) {
    ASSERT_LE(i, next);
    if (i == next) ++next;
  }
  for (const std::size_t i : {11u, 12u, 13u, 14u, 16u, 17u, 18u, 19u})
    EXPECT_NEAR(after[i].steps[0], after[i - 1].steps[0], 1) << i;
  EXPECT_LT(after[0].steps[0], after[19].steps[0]) << "to the right, as seen from outside";
  EXPECT_EQ(after[20].normal[2], 127) << "faces stay in their order";
}

TEST(FaceOrder, WhatNoTriangleUsesHasNoNumber) {
  Wall w = wall(2, 2);
  w.corners.push_back({{1, 2, 3}, {0, 0, 127}});
  const std::vector<std::uint32_t> numbers = order_along_faces(w.indices, w.corners, 20);
  EXPECT_EQ(numbers.back(), ~0u);
  EXPECT_EQ(*std::max_element(numbers.begin(), numbers.end() - 1), w.corners.size() - 2);
  std::vector<std::uint16_t> none;
  EXPECT_EQ(order_along_faces(none, w.corners, 20), std::vector<std::uint32_t>(w.corners.size(), ~0u));
}

}  // namespace
}  // namespace blockrand::outputs
