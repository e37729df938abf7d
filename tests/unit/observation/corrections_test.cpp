#include "pipeline/observation/corrections.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace blockrand::observation {
namespace {

using footprints::FootprintStore;
using testing::ElementsAre;

model::Polygon box(double x, double y, double width, double depth) {
  model::Polygon p;
  p.outer.points = {{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}};
  p.outer.nodes.assign(4, 0);
  return p;
}

/// Houses of 10 m x 10 m with their lower left corners at `x` on a line, each a row of its own.
struct Street {
  explicit Street(const std::vector<double>& x) : store(x.size()) {
    for (std::uint32_t b = 0; b < x.size(); ++b) {
      footprints::StoredFootprint f;
      f.id = {model::OsmType::way, b + 1};
      f.record.area = 100;
      const model::Polygon polygon = box(x[b], 0, 10, 10);
      store.set(b, f, {&polygon, 1});
    }
    seen.outlines.resize(x.size());
    for (std::uint32_t b = 0; b < x.size(); ++b) seen.outlines[b].row = b, seen.outlines[b].image = 0;
  }
  void show(std::uint32_t b, double east, double confidence = 0.9, double turn = 0) {
    seen.outlines[b].state = RowState::corrected;
    seen.outlines[b].shift = {east, 0};
    seen.outlines[b].turn = turn;
    seen.outlines[b].confidence = confidence;
  }
  /// The wall to the east of house b is seen farther out.
  void widen(std::uint32_t b, double by, double confidence = 0.9) {
    RefinedOutline& r = seen.outlines[b].refined;
    r.state = RefinementState::refined, r.walls = 1, r.largest = by, r.confidence = confidence;
    r.from = {store.polygons(b)[0].outer.points}, r.to = r.from;
    for (model::Point2& p : r.to[0]) {
      if (p.x > r.from[0][0].x) p.x += by;
      if (seen.outlines[b].state == RowState::corrected) p.x += seen.outlines[b].shift.x;
    }
  }
  std::vector<std::uint32_t> moved(const std::function<bool(std::uint32_t)>& keeps = [](std::uint32_t) {
    return false;
  }) {
    refuse_corrections(seen, store, keeps);
    std::vector<std::uint32_t> out;
    for (const footprints::MovedBuilding& m : movements(seen, store)) out.push_back(m.building);
    return out;
  }
  FootprintStore store;
  ImageryObservations seen;
};

TEST(Corrections, AHouseIsNotMovedOntoItsNeighbour) {
  Street street({0, 12, 40});
  street.show(0, 4);
  street.show(2, 4);
  EXPECT_THAT(street.moved(), ElementsAre(2));
  EXPECT_EQ(street.seen.outlines[0].state, RowState::refused);
  EXPECT_EQ(street.seen.outlines[0].reason, "it would stand on a neighbour");
}

TEST(Corrections, RoomThatANeighbourLeavesMayBeTaken) {
  Street street({0, 12});
  street.show(0, 4);
  street.show(1, 4);
  EXPECT_THAT(street.moved(), ElementsAre(0, 1));
}

TEST(Corrections, WhoStaysIsInTheWayOfTheNext) {
  // The last cannot move, so the middle one cannot, so the first cannot.
  Street street({0, 11, 22, 33});
  street.show(0, 4, 0.9);
  street.show(1, 4, 0.8);
  street.show(2, 4, 0.95);
  EXPECT_THAT(street.moved(), ElementsAre());
}

TEST(Corrections, OfTwoThatMeetTheLessSureOneStays) {
  Street street({0, 14});
  street.show(0, 3.5, 0.8);
  street.show(1, -3.5, 0.95);
  EXPECT_THAT(street.moved(), ElementsAre(1));
}

TEST(Corrections, WhatOverlappedBeforeMayStillDoSo) {
  Street street({0, 8});  // 20 m2 in common
  street.show(0, -1);
  street.show(1, 0.6);
  EXPECT_THAT(street.moved(), ElementsAre(0, 1));
}

TEST(Corrections, AWallIsNotShiftedIntoANeighbour) {
  Street street({0, 10.5, 40});
  street.widen(0, 0.8);
  street.widen(2, 0.8);
  EXPECT_THAT(street.moved(), ElementsAre(2));
  EXPECT_EQ(street.seen.outlines[0].refined.state, RefinementState::refused);
  EXPECT_EQ(street.seen.outlines[0].refined.reason, "it would stand on a neighbour");
  EXPECT_NEAR(movements(street.seen, street.store)[0].movement({50, 5}).x, 50.8, 1e-9);
  EXPECT_NEAR(movements(street.seen, street.store)[0].movement({45, 0}).x, 45.4, 1e-9);
}

TEST(Corrections, WallsGoWithTheirRowAndAreRefusedWithIt) {
  Street street({0, 12, 40});
  street.show(0, 4);
  street.widen(0, 0.5);
  street.show(2, 3);
  street.widen(2, 0.5);
  EXPECT_THAT(street.moved(), ElementsAre(2));
  EXPECT_EQ(street.seen.outlines[0].refined.state, RefinementState::refused);
  EXPECT_NEAR(movements(street.seen, street.store)[0].movement({50, 0}).x, 53.5, 1e-9);
  EXPECT_NEAR(movements(street.seen, street.store)[0].movement({40, 10}).x, 43, 1e-9);
}

TEST(Corrections, AUserKeepsWallsToo) {
  Street street({0, 30});
  street.widen(0, 0.5);
  street.widen(1, 0.5);
  EXPECT_THAT(street.moved([](std::uint32_t b) { return b == 0; }), ElementsAre(1));
  EXPECT_EQ(street.seen.outlines[0].refined.reason, "an override keeps it where it is mapped");
}

TEST(Corrections, ARowStaysWhereAUserKeepsOneOfItsHouses) {
  Street street({0, 10, 40});
  for (const std::uint32_t b : {0, 1, 2}) street.show(b, 3);
  street.seen.outlines[1].row = 0;
  EXPECT_THAT(street.moved([](std::uint32_t b) { return b == 1; }), ElementsAre(2));
  EXPECT_EQ(street.seen.outlines[0].reason, "an override keeps it where it is mapped");
}

}  // namespace
}  // namespace blockrand::observation
