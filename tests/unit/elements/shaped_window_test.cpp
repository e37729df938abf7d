// Windows whose edges are drawn one by one: what rule files get by blockrand.window("shaped_window", …).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "styles/elements/element_catalogue.h"
#include "tests/unit/elements/element_checks.h"
#include "tests/unit/elements/shipped_elements.h"

namespace blockrand::elements {
namespace {

using model::Point2;
using testing::HasSubstr;

constexpr double kPi = 3.14159265358979;

Element made(double width, double height, const std::vector<Parameter>& parameters) {
  const auto element = shipped().make("shaped_window", width, height, parameters);
  EXPECT_TRUE(element.has_value()) << (element ? "" : element.error());
  return element ? *element : Element{};
}

std::string error(const std::vector<Parameter>& parameters) {
  const auto element = shipped().make("shaped_window", 1, 2, parameters);
  return element ? std::string() : element.error();
}

double area_of(const Element& element, Part part) {
  double sum = 0;
  for (const ElementFace& f : element.mesh.faces) {
    if (f.part != part) continue;
    Outline flat;
    for (std::uint32_t i = 0; i < f.count; ++i) {
      const auto& v = element.mesh.vertices[element.mesh.indices[f.first + i]];
      flat.push_back({v.x, v.y});
    }
    sum += std::max(0.0, signed_area(flat));
  }
  return sum;
}

int reflex_corners(const Outline& outline) {
  int n = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point2 a = outline[i], b = outline[(i + 1) % outline.size()], c = outline[(i + 2) % outline.size()];
    n += (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) < -1e-9;
  }
  return n;
}

TEST(ShapedWindow, AnOgeeIsHollowBelowItsTip) {
  const Element window = made(1.2, 3, {{"top", "ogee"}, {"top_size", 0.4}, {"detail", 2.0}});
  const Outline& outline = window.opening.outline;
  EXPECT_THAT(outline, testing::Contains(Point2{0, 3}));
  EXPECT_THAT(outline, testing::Contains(Point2{model::snap(-0.6), model::snap(1.8)}));
  EXPECT_GE(reflex_corners(outline), 4) << "an ogee bends both ways";
  for (const Point2 p : outline)
    EXPECT_THAT(outline, testing::Contains(Point2{-p.x, p.y})) << "it is its own mirror image";
  // Glass all over but for the frame of 0.06 m.
  const double opening = signed_area(outline), glass = area_of(window, Part::glass);
  EXPECT_LT(glass, opening);
  EXPECT_GT(glass, opening - 0.06 * (1.2 + 2 * 3 + 2.2));
  EXPECT_EQ(checks::open_place(window), "");
  EXPECT_EQ(checks::faces_wrong(window.mesh), "");
}

TEST(ShapedWindow, CirclesAreRound) {
  const Element window = made(1, 1, {{"outline", "circular"}, {"bars", 1.0}, {"upright_bars", 1.0}});
  for (const Point2 p : window.opening.outline) EXPECT_NEAR(std::hypot(p.x, p.y - 0.5), 0.5, 0.002);
  EXPECT_NEAR(signed_area(window.opening.outline), kPi / 4, 0.03);
  EXPECT_EQ(reflex_corners(window.opening.outline), 0);
  EXPECT_GE(window.opening.outline.size(), 16u);
  EXPECT_EQ(checks::open_place(window), "");
  // The bars cross and end at the frame.
  for (const auto& v : window.mesh.vertices) EXPECT_LE(std::hypot(v.x, v.y - 0.5), 0.502);
}

TEST(ShapedWindow, EdgesMoveAndCornersAreCut) {
  const Element window = made(2, 4, {{"left_inward", 0.125}, {"right_inward", 0.0625}, {"top_size", 0.25}});
  const Bounds2 box = bounds_of(window.opening.outline);
  EXPECT_EQ(box.least, (Point2{-0.75, 0}));
  EXPECT_EQ(box.most, (Point2{0.875, 3}));
  // Edges that stop before the corner cut it off.
  const Element cut =
      made(2, 4, {{"top_left", 0.25}, {"top_right", 0.25}, {"left_above", 0.25}, {"right_above", 0.25}});
  EXPECT_EQ(cut.opening.outline, (Outline{{-1, 0}, {1, 0}, {1, 3}, {0.5, 4}, {-0.5, 4}, {-1, 3}}));
}

TEST(ShapedWindow, BandsAndSillsGoRoundIt) {
  for (const char* surround : {"plain", "moulded", "brick"}) {
    const Element window =
        made(1.2, 3, {{"top", "basket"}, {"top_size", 0.2}, {"surround", surround}, {"sill", "plain"}});
    EXPECT_GT(window.mesh.faces.size(), made(1.2, 3, {{"top", "basket"}, {"top_size", 0.2}}).mesh.faces.size());
    EXPECT_EQ(checks::open_place(window), "") << surround;
  }
}

TEST(ShapedWindow, SaysWhatCannotBe) {
  EXPECT_THAT(error({{"top", "ogge"}, {"top_size", 0.3}}), HasSubstr("did you mean \"ogee\"?"));
  EXPECT_THAT(error({{"top", "ogee"}}), HasSubstr("give top_size"));
  EXPECT_THAT(error({{"outline", "circular"}, {"sill", "plain"}}), HasSubstr("a sill wants a straight lower edge"));
  EXPECT_THAT(error({{"top", "Modifications { arc, abs, 0, 180; }"}, {"top_size", 0.3}}), HasSubstr("\"top\""));
  EXPECT_THAT(error({{"left_inward", 0.5}, {"right_inward", 0.5}}), HasSubstr("nothing is left"));
  EXPECT_THAT(error({{"bars", 8.0},
                     {"top", "gabled"},
                     {"top_size", 0.9},
                     {"bar", 0.1},
                     {"bottom_inward", 0.7},
                     {"top_inward", 0.05}}),
              HasSubstr("no"));
}

}  // namespace
}  // namespace blockrand::elements
