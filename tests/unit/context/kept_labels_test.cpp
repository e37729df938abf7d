#include <gtest/gtest.h>

#include "pipeline/context/vicinity_finder.h"

namespace blockrand::context {
namespace {

TEST(KeptLabels, AreHandedOverOnce) {
  const auto kept = KeptLabels::of(3);
  ASSERT_TRUE(kept);
  model::Building building;
  building.edges.resize(2);
  building.edges[1].street_name = "Lange Straße";
  building.trees.resize(1);
  building.situation.fronts = {1};
  building.situation.block = "b7";
  kept->put(2, building);
  model::Building other, again;
  EXPECT_FALSE(kept->take(1, other)) << "nobody labelled it";
  ASSERT_TRUE(kept->take(2, other));
  EXPECT_EQ(other.edges.size(), 2u);
  EXPECT_EQ(other.edges[1].street_name, "Lange Straße");
  EXPECT_EQ(other.trees.size(), 1u);
  EXPECT_EQ(other.situation.fronts, building.situation.fronts);
  EXPECT_EQ(other.situation.block, "b7");
  EXPECT_FALSE(kept->take(2, again)) << "a neighbouring tile looks for itself";
  EXPECT_TRUE(again.edges.empty());
}

TEST(KeptLabels, CitiesAreNotKept) {
  EXPECT_TRUE(KeptLabels::of(KeptLabels::kMostBuildings));
  EXPECT_FALSE(KeptLabels::of(KeptLabels::kMostBuildings + 1));
}

}  // namespace
}  // namespace blockrand::context
