// Holtmeier's rules on generated roofs, and every element on every kind of roof.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/roofs/element_houses.h"
#include "tests/unit/roofs/placed_dormer.h"

namespace blockrand::roofs {
namespace {

using model::RoofElementKind;
using model::RoofShape;
using namespace roof_checks;

constexpr RoofShape kShapes[] = {RoofShape::gabled,      RoofShape::hipped,
                                 RoofShape::mansard,     RoofShape::gambrel,
                                 RoofShape::half_hipped, RoofShape::double_saltbox,
                                 RoofShape::saltbox,     RoofShape::skillion,
                                 RoofShape::side_hipped, RoofShape::hipped_and_gabled,
                                 RoofShape::pyramidal,   RoofShape::gabled_height_moved};

/// A house as they stand in towns: a rectangle, an L or a T, or one of the nasty plans.
Polygon house(Random& random) {
  const double length = 8 + 22 * random.unit(), depth = 6 + 9 * random.unit();
  Polygon plan = polygon({{0, 0}, {length, 0}, {length, depth}, {0, depth}});
  switch (random.next(5)) {
    case 0: {
      const double wing = 5 + 0.3 * (length - 8), out = 4 + 8 * random.unit();
      plan = polygon({{0, 0}, {length, 0}, {length, depth}, {wing, depth}, {wing, depth + out}, {0, depth + out}});
      break;
    }
    case 1: {
      const double a = length * 0.35, b = length * 0.7, out = 0.5 + 6 * random.unit();
      plan = polygon({{0, 0}, {a, 0}, {a, -out}, {b, -out}, {b, 0}, {length, 0}, {length, depth}, {0, depth}});
      break;
    }
    case 2:
      return random_plan(random);
    default:
      break;
  }
  const double angle = random.next(3) == 0 ? 90.0 * static_cast<double>(random.next(4)) : 360 * random.unit();
  return moved(plan, angle, kPlaces[random.next(3)]);
}

// ---- the tape measure finds what breaks a rule
// -----------------------------------------------------------------------

DormerParameters flat_dormer(double width = 1.3) {
  DormerParameters p;
  p.kind = DormerKind::flat;
  p.width = width;
  return p;
}

/// Complaints about dormers at these places, put there by laxer rules.
std::vector<std::string> complaints(const Polygon& plan, RoofShape shape, std::initializer_list<Point2> places) {
  Roof roof = roof_on(plan, shape, 5);
  for (const Point2 place : places)
    EXPECT_TRUE(
        add_dormer(roof, 0, flat_dormer(), place, {}, {.eaves = 0.2, .between = 0.2, .side = 0.2, .fold = 0.1}));
  EXPECT_EQ(validity(plan, roof), "none");
  return broken_rules(roof, {});
}

TEST(TapeMeasure, FindsWhatBreaksARule) {
  using testing::ElementsAre;
  using testing::HasSubstr;
  const Polygon plan = rectangle(20, 10);
  EXPECT_THAT(complaints(plan, RoofShape::gabled, {{10, 1}}), ElementsAre());
  EXPECT_THAT(complaints(plan, RoofShape::gabled, {{10, 0.99}}), ElementsAre(HasSubstr("from the eaves")));
  EXPECT_THAT(complaints(plan, RoofShape::gabled, {{1.64, 1}}), ElementsAre(HasSubstr("from the outer side")));
  EXPECT_THAT(complaints(plan, RoofShape::gabled, {{10, 1}, {12.79, 1}}), ElementsAre(HasSubstr("from dormer 1")));
  EXPECT_THAT(complaints(plan, RoofShape::gabled, {{10, 1}, {12.8, 1}}), ElementsAre());
  EXPECT_THAT(complaints(plan, RoofShape::hipped, {{3, 1}}), ElementsAre(HasSubstr("from a fold")));
  // An element turned out of its slope, one in another's place, a chimney in the air, one in the roof.
  GabledHouse house(1);
  ASSERT_TRUE(add_dormer(house.roof, house.south(), flat_dormer(), {10, 1}));
  Roof bent = house.roof;
  for (Point3& p : bent.surfaces[house.south()].loops[1]) p.z += 0.02;
  EXPECT_THAT(broken_rules(bent, {}), testing::Not(ElementsAre()));
  auto stack = chimney(house.roof, {{5, 5}, {1, 0}}).value();
  EXPECT_THAT(broken_rules(house.roof, {stack}), ElementsAre());
  for (Point3& p : stack.solid.vertices) p.z += 0.05;
  EXPECT_THAT(broken_rules(house.roof, {stack}), testing::Contains(HasSubstr("off its slope")));
  for (Point3& p : stack.solid.vertices) p.z -= 0.055;
  EXPECT_THAT(broken_rules(house.roof, {stack}), testing::Contains(HasSubstr("cuts")));
  for (Point3& p : stack.solid.vertices) p = {p.x + 5, p.y - 3.5, p.z};
  EXPECT_THAT(broken_rules(house.roof, {stack}), testing::Contains(HasSubstr("stands over dormer")));
}

// ---- rules ----------------------------------------------------------------------------------------------------------

TEST(ElementRules, HoldOnGeneratedRoofs) {
  constexpr int kRoofs = 1200;
  Random random(22);
  std::map<RoofElementKind, int> built;
  int roofs = 0;
  for (int i = 0; i < kRoofs; ++i) {
    const Polygon plan = house(random);
    RoofRequest request;
    request.shape = kShapes[random.next(std::size(kShapes))];
    const double height = random.next(8) == 0 ? 0.5 : 1.5 + 6.5 * random.unit();
    request.measures = {40, height};
    Fitting with;
    with.dormer = usual_dormer(kDormerKinds[random.next(6)]);
    if (random.next(2) == 0) with.dormer.width = 0.8 + 2.2 * random.unit();
    with.cross_gable.kind = kDormerKinds[random.next(5)];
    with.cross_gable.width = 1.2 + 1.8 * random.unit();
    with.cross_gable.wall_height = random.next(3) == 0 ? 0 : 1.2 * random.unit();
    if (with.cross_gable.kind == DormerKind::shed) with.cross_gable.roof_pitch = 10;
    with.cross_gable.rise = with.cross_gable.width / 5;
    with.most_dormers = 1 + static_cast<int>(random.next(8));
    with.cross_gables = random.next(2) == 0;
    std::optional<BuiltRoof> bare;
    for (const double coarseness : kCoarseness) {
      request.coarseness = coarseness;
      bare = build_roof(plan, request);
      if (bare && validity(plan, bare->roof) == "none") break;
      bare.reset();
    }
    if (!bare) continue;
    ++roofs;
    const auto edges = random.next(2) == 0 ? gables_as_party_walls(bare->roof) : std::vector<model::RoofEdge>{};
    const Fitted fitted = fit_out(plan, edges, bare->roof, with);
    const std::string where = "roof " + std::to_string(i) + ", " + std::string(model::name(request.shape));
    ASSERT_EQ(validity(plan, fitted.roof), "none") << where;
    ASSERT_EQ(installations_validity(fitted.installations), "none") << where;
    ASSERT_EQ(broken_rules(fitted.roof, fitted.installations), std::vector<std::string>{}) << where;
    ASSERT_EQ(fitted.faults, std::vector<std::string>{}) << where;
    ASSERT_NEAR(covered_area(fitted.roof), covered_area(bare->roof), 0.02) << where;
    for (const auto& [kind, n] : fitted.built) built[kind] += n;
  }
  EXPECT_GE(roofs, 1000);
  // The rules are not kept by building nothing.
  EXPECT_GT(built[RoofElementKind::dormer], 1500);
  EXPECT_GT(built[RoofElementKind::cross_gable], 400);
  EXPECT_GT(built[RoofElementKind::roof_window], 3000);
  EXPECT_GT(built[RoofElementKind::chimney], 1500);
  std::printf("%d roofs: %d dormers, %d cross gables, %d roof windows, %d chimneys\n", roofs,
              built[RoofElementKind::dormer], built[RoofElementKind::cross_gable], built[RoofElementKind::roof_window],
              built[RoofElementKind::chimney]);
}

TEST(ElementRules, HoldInRows) {
  Random random(7);
  int dormers = 0, cross_gables = 0, windows = 0, stacks = 0;
  for (int row = 0; row < 40; ++row) {
    const double angle = 360 * random.unit(), depth = 9 + 4 * random.unit();
    const Point2 place = kPlaces[random.next(3)];
    const RoofShape shape =
        std::vector{RoofShape::gabled, RoofShape::gambrel, RoofShape::double_saltbox}[random.next(3)];
    double left = 0;
    for (int house = 0; house < 6; ++house) {
      // No deeper than wide, so that ridges run from party wall to party wall.
      const double width = depth + 6 * random.unit();
      const Polygon plan =
          moved(polygon({{left, 0}, {left + width, 0}, {left + width, depth}, {left, depth}}), angle, place);
      left += width;
      const Roof bare = roof_on(plan, shape, 3 + 3 * random.unit());
      const std::vector<model::RoofEdge> edges{model::RoofEdge::street, model::RoofEdge::party_wall,
                                               model::RoofEdge::courtyard, model::RoofEdge::party_wall};
      Fitting with;
      with.dormer = usual_dormer(kDormerKinds[random.next(6)]);
      with.frontage = width;
      with.cross_gables = random.next(2) == 0;
      with.most_dormers = 1 + static_cast<int>(random.next(3));
      const Fitted fitted = fit_out(plan, edges, bare, with);
      ASSERT_EQ(validity(plan, fitted.roof), "none") << row;
      ASSERT_EQ(installations_validity(fitted.installations), "none") << row;
      ASSERT_EQ(broken_rules(fitted.roof, fitted.installations), std::vector<std::string>{}) << row;
      // Off the party walls on the plan: 1 m, chimneys 5 cm.
      const auto off_party_walls = [&](Point2 p) {
        double least = 1e9;
        for (const std::size_t e : {1u, 3u})
          least =
              std::min(least, geometry::distance_to_segment(p, plan.outer.points[e], plan.outer.points[(e + 1) % 4]));
        return least;
      };
      for (const auto& surface : fitted.roof.surfaces) {
        if (surface.element == -1) continue;
        for (const Point3& p : surface.loops[0]) ASSERT_GE(off_party_walls(p.xy()), 1 - 0.003);
      }
      for (const auto& body : fitted.installations)
        for (const Point3& p : body.solid.vertices) {
          const bool chimney = body.kind == RoofElementKind::chimney;
          ASSERT_GE(off_party_walls(p.xy()), (chimney ? 0.05 : 1) - 0.003);
          ASSERT_TRUE(geometry::contains(plan, p.xy()));
        }
      const auto built = [&](RoofElementKind kind) {
        const auto found = fitted.built.find(kind);
        return found == fitted.built.end() ? 0 : found->second;
      };
      dormers += built(RoofElementKind::dormer);
      cross_gables += built(RoofElementKind::cross_gable);
      windows += built(RoofElementKind::roof_window);
      stacks += built(RoofElementKind::chimney);
    }
  }
  EXPECT_GT(dormers, 500);
  EXPECT_GT(cross_gables, 150);
  EXPECT_GT(windows, 500);
  EXPECT_GE(stacks, 240);
}

}  // namespace
}  // namespace blockrand::roofs
