#include <gtest/gtest.h>

#include "pipeline/context/tagged_neighbours.h"

namespace blockrand::context {
namespace {

using model::OsmId;
using model::OsmType;
using model::RoofShape;

TaggedBuilding tagged(std::int64_t number, double x, double y, float storeys, std::uint8_t group = 0) {
  return {{OsmType::way, number}, {x, y}, group, storeys, std::nullopt};
}

const OsmId kNobody{OsmType::way, 999};

TEST(TaggedNeighbours, MedianWithinTheReachOnly) {
  const TaggedNeighbours n({tagged(1, 0, 0, 3), tagged(2, 50, 0, 5), tagged(3, -60, 20, 4), tagged(4, 101, 0, 20)},
                           100);
  const auto vote = n.storeys({0, 0}, 0, kNobody, 3);
  ASSERT_TRUE(vote);
  EXPECT_DOUBLE_EQ(vote->value, 4);
  EXPECT_EQ(vote->voices, 3);
}

TEST(TaggedNeighbours, AnEvenNumberGivesAMappedValue) {
  const TaggedNeighbours n({tagged(1, 0, 0, 3), tagged(2, 1, 0, 4), tagged(3, 2, 0, 6), tagged(4, 3, 0, 7)}, 100);
  EXPECT_DOUBLE_EQ(n.storeys({0, 0}, 0, kNobody, 3)->value, 4);
}

TEST(TaggedNeighbours, OneselfAndOtherGroupsHaveNoVoice) {
  const TaggedNeighbours n({tagged(1, 0, 0, 3), tagged(2, 1, 0, 4), tagged(3, 2, 0, 5), tagged(4, 3, 0, 9, 1)}, 100);
  EXPECT_FALSE(n.storeys({0, 0}, 0, {OsmType::way, 1}, 3));
  EXPECT_TRUE(n.storeys({0, 0}, 0, kNobody, 3));
  EXPECT_FALSE(n.storeys({0, 0}, 1, kNobody, 2));
}

TEST(TaggedNeighbours, AcrossCellBordersAndNegativeCoordinates) {
  const TaggedNeighbours n({tagged(1, -1, -1, 3), tagged(2, 1, 1, 3), tagged(3, -99, 1, 3)}, 100);
  EXPECT_TRUE(n.storeys({0, 0}, 0, kNobody, 3));
  EXPECT_FALSE(n.storeys({1e7, 1e7}, 0, kNobody, 1));
}

TEST(TaggedNeighbours, MajorityOfRoofs) {
  std::vector<TaggedBuilding> b;
  for (int i = 0; i < 5; ++i) {
    b.push_back({{OsmType::way, i}, {i * 1.0, 0}, 0, std::nullopt, i < 3 ? RoofShape::hipped : RoofShape::flat});
  }
  const TaggedNeighbours n(b, 100);
  const auto vote = n.roof_shape({0, 0}, 0, kNobody, 3);
  ASSERT_TRUE(vote);
  EXPECT_EQ(vote->value, RoofShape::hipped);
  EXPECT_DOUBLE_EQ(vote->share, 0.6);
  EXPECT_FALSE(n.storeys({0, 0}, 0, kNobody, 1)) << "nobody tagged storeys";
}

}  // namespace
}  // namespace blockrand::context
