// What ElementCatalogue::make() refuses and how it says so; what single elements look like in numbers.
#include "styles/elements/element_catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "styles/elements/mesh_builder.h"
#include "tests/unit/elements/element_checks.h"
#include "tests/unit/elements/mesh_measures.h"
#include "tests/unit/elements/shipped_elements.h"

namespace blockrand::elements {
namespace {

using model::Point2;
using testing::HasSubstr;

Element made(std::string_view kind, double width, double height, const std::vector<Parameter>& parameters = {}) {
  const auto element = shipped().make(kind, width, height, parameters);
  EXPECT_TRUE(element.has_value()) << (element ? "" : element.error());
  return element ? *element : Element{};
}

std::string error(std::string_view kind, double width, double height, const std::vector<Parameter>& parameters = {}) {
  const auto element = shipped().make(kind, width, height, parameters);
  return element ? std::string() : element.error();
}

std::size_t faces_of(const Element& element, Part part) {
  std::size_t n = 0;
  for (const ElementFace& f : element.mesh.faces) n += f.part == part;
  return n;
}

double front_area(const Element& element, Part part) {
  double area = 0;
  for (const ElementFace& f : element.mesh.faces) {
    if (f.part != part) continue;
    Outline flat;
    for (std::uint32_t i = 0; i < f.count; ++i) {
      const auto& v = element.mesh.vertices[element.mesh.indices[f.first + i]];
      flat.push_back({v.x, v.y});
    }
    const double a = signed_area(flat);
    if (a > 0) area += a;
  }
  return area;
}

TEST(MakeElement, TellsTheNearestKnownName) {
  EXPECT_THAT(error("double_casment", 1, 2), HasSubstr("did you mean \"double_casement\"?"));
  EXPECT_THAT(error("spaceship", 1, 2), HasSubstr("known: casement_window, double_casement"));
  EXPECT_THAT(error("double_casement", 1.1, 2.2, {{"leafs", 2.0}}),
              HasSubstr("double_casement has no parameter \"leafs\"; did you mean \"leaf\"?"));
  EXPECT_THAT(error("casement_window", 1.1, 2.2, {{"head", "segmentl"}}),
              HasSubstr("\"head\" cannot be \"segmentl\"; did you mean \"segmental\"?"));
  EXPECT_THAT(error("string_course", 4, 0.26, {{"profile", "cima"}}),
              HasSubstr("there is no profile \"cima\"; did you mean \"cyma\"?"));
}

TEST(MakeElement, TellsTheRange) {
  EXPECT_EQ(error("casement_window", 9, 2), "casement_window: the width is 9 m; it goes from 0.4 to 3.5 m");
  EXPECT_THAT(error("casement_window", 1, std::numeric_limits<double>::quiet_NaN()), HasSubstr("the height is nan"));
  EXPECT_EQ(error("casement_window", 1.1, 2.2, {{"reveal", 0.5}}),
            "casement_window: \"reveal\" is 0.5 m; it goes from 0 to 0.4 m");
  EXPECT_THAT(error("casement_window", 1.1, 2.2, {{"leaves", 1.5}}), HasSubstr("whole number"));
  EXPECT_THAT(error("casement_window", 1.1, 2.2, {{"leaves", "two"}}), HasSubstr("wants a number"));
  EXPECT_THAT(error("casement_window", 1.1, 2.2, {{"head", 1.0}}), HasSubstr("wants a word; known: straight"));
  EXPECT_THAT(error("casement_window", 1.1, 2.2, {{"leaves", 1.0}, {"leaves", 2.0}}), HasSubstr("given twice"));
}

TEST(MakeElement, TellsWhatDoesNotFit) {
  EXPECT_THAT(error("casement_window", 1.1, 0.6, {{"head", "round"}}), HasSubstr("wants at least 0.65 m"));
  EXPECT_THAT(error("casement_window", 0.5, 1.2, {{"leaves", 3.0}, {"frame", 0.15}}),
              HasSubstr("no room for the panes"));
  EXPECT_THAT(error("casement_window", 1.1, 1.2, {{"bars", 6.0}, {"transom", 0.4}}), HasSubstr("level bars"));
  EXPECT_THAT(error("double_casement", 1.1, 2.2, {{"surround", "double_cornice"}, {"pediment", "straight"}}),
              HasSubstr("brings its own pediment"));
  EXPECT_THAT(error("main_cornice", 4, 0.8, {{"bracket_spacing", 0.1}}), HasSubstr("do not fit every 0.10 m"));
}

TEST(MakeFittingElement, WhatFitsIsMadeAsAsked) {
  const auto made = shipped().make_fitting("casement_window", 1.1, 1.6);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->told, "");
  EXPECT_EQ(made->element.name, shipped().make("casement_window", 1.1, 1.6)->name);
}

TEST(MakeFittingElement, WhatDoesNotFitIsMadeSimplerAndTold) {
  const auto shop = shipped().make_fitting("shop_window", 3.0, 2.2, std::vector<Parameter>{{"door", "middle"}});
  ASSERT_TRUE(shop) << shop.error();
  EXPECT_THAT(shop->told, HasSubstr("no room for its door below the transom; made instead: shop window 3.00 x 2.20"));
  const auto pilaster = shipped().make_fitting("pilaster", 0.5, 900);
  ASSERT_TRUE(pilaster) << pilaster.error();
  EXPECT_THAT(pilaster->told, HasSubstr("the height is 900 m"));
  const auto needle = shipped().make_fitting("plinth", 4, 0.8, std::vector<Parameter>{{"left_turn", 180.0}});
  ASSERT_TRUE(needle) << needle.error();
  EXPECT_THAT(needle->told, HasSubstr("\"left_turn\" is 180 degrees"));
  EXPECT_EQ(needle->element.mesh.vertices.size(), shipped().make("plinth", 4, 0.8)->mesh.vertices.size())
      << "cut square";
}

TEST(MakeFittingElement, WhatHasNoRoomAtAllIsLeftOut) {
  EXPECT_FALSE(shipped().make_fitting("casement_window", 0.2, 1.6));
  EXPECT_FALSE(shipped().make_fitting("spaceship", 1, 1));
  EXPECT_FALSE(shipped().make_fitting("casement_window", 1.1, 1.6, std::vector<Parameter>{{"leafs", 2.0}}));
}

/// Anything from a hand's breadth to a tower is asked of every kind: what is not made is too small for it.
TEST(MakeFittingElement, SizesAboveTheRangeAlwaysGiveSomething) {
  for (const ElementKind& kind : shipped().kinds())
    for (const double width : {kind.width.usual, kind.width.most, kind.width.most * 3, 200.0})
      for (const double height : {kind.height.usual, kind.height.most, kind.height.most * 3, 300.0}) {
        if (width < kind.width.least || height < kind.height.least) continue;
        const auto made = shipped().make_fitting(kind.name, width, height);
        EXPECT_TRUE(made) << kind.name << " " << width << " x " << height << ": " << made.error();
      }
}

TEST(MakeElement, ProfilesMayBePrograms) {
  const Element e = made(
      "string_course", 2, 0.3,
      {{"profile", "Modifications { line, abs, 90, 1; line, abs, 0, 3; line, abs, -90, 1; }"}, {"projection", 0.5}});
  EXPECT_EQ(e.mesh.faces.size(), 6u);
  const Bounds3 box = bounds_of(e.mesh);
  EXPECT_NEAR(box.most.z, 0.1, 1e-3);
  EXPECT_NEAR(box.most.y, 0.3, 1e-3);
  EXPECT_THAT(error("string_course", 2, 0.3, {{"profile", "Modifications { line, abs 90, 1; }"}}),
              HasSubstr("line 1, column 27"));
  EXPECT_THAT(error("string_course", 2, 0.3, {{"profile", "Modifications { line, abs, 0, 1; }"}}),
              HasSubstr("does not stand out"));
}

TEST(MakeElement, WithoutProfilesOnlyWhatNeedsNoneIsMade) {
  const ElementCatalogue none;
  EXPECT_TRUE(none.profiles().empty());
  EXPECT_THAT(none.make("string_course", 2, 0.3).error(), HasSubstr("the library lacks the profile \"string_course\""));
  EXPECT_TRUE(none.make("console", 0.2, 0.3));
}

TEST(MakeElement, NamesWhatItMade) {
  EXPECT_EQ(made("double_casement", 1.1, 2.2, {{"head", "segmental"}}).name,
            "double casement 1.10 x 2.20, segmental head, moulded surround");
  EXPECT_EQ(made("double_casement", 1.1, 2.2).kind, "double_casement");
  EXPECT_EQ(made("house_door", 1.5, 3).semantic, ElementClass::door);
}

TEST(MakeElement, GivesTheSameBytes) {
  const auto a = made("double_casement", 1.1, 2.2, {{"head", "segmental"}, {"pediment", "segmental"}});
  const auto b = made("double_casement", 1.1, 2.2, {{"head", "segmental"}, {"pediment", "segmental"}});
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.indices, b.mesh.indices);
}

TEST(Windows, OpeningsHaveTheirHeads) {
  EXPECT_EQ(made("casement_window", 1, 2).opening.outline, (Outline{{-0.5, 0}, {0.5, 0}, {0.5, 2}, {-0.5, 2}}));
  const Outline gabled = made("casement_window", 1, 2, {{"head", "gabled"}, {"rise", 0.25}}).opening.outline;
  EXPECT_EQ(gabled, (Outline{{-0.5, 0}, {0.5, 0}, {0.5, 1.75}, {0, 2}, {-0.5, 1.75}}));
  const Outline round = made("casement_window", 1, 2, {{"head", "round"}, {"detail", 2.0}}).opening.outline;
  EXPECT_EQ(round.size(), 3u + 16u);
  for (std::size_t i = 2; i < round.size(); ++i) {
    const double dx = round[i].x, dy = round[i].y - 1.5;
    EXPECT_NEAR(dx * dx + dy * dy, 0.25, 0.002) << "on the circle";
  }
  EXPECT_NEAR(made("casement_window", 1, 2, {{"reveal", 0.2}}).opening.reveal, 0.2, 0);
  const Outline pointed = made("casement_window", 1, 3, {{"head", "pointed"}, {"detail", 2.0}}).opening.outline;
  double top = 0;
  for (const model::Point2 p : pointed) top = std::max(top, p.y);
  EXPECT_EQ(top, 3);
  for (const model::Point2 p : pointed) {  // about the opposite springing, as far as the width
    if (p.y > 3 - 0.866 && p.x != 0) {
      EXPECT_NEAR(std::hypot(p.x + (p.x > 0 ? 0.5 : -0.5), p.y - (3 - 0.866)), 1, 0.002);
    }
  }
  const Outline basket = made("casement_window", 1.5, 2, {{"head", "basket"}}).opening.outline;
  for (std::size_t i = 2; i < basket.size(); ++i)
    EXPECT_NEAR(std::hypot(basket[i].x / 0.75, (basket[i].y - 1.5) / 0.5), 1, 0.003) << "on the ellipse";
}

TEST(Windows, LeavesTransomAndBarsAreWhatWasAskedFor) {
  const std::vector<Parameter> bare{{"surround", "none"}, {"sill", "none"}};
  const auto with = [&](std::vector<Parameter> more) {
    more.insert(more.end(), bare.begin(), bare.end());
    return made("casement_window", 1.2, 2, more);
  };
  EXPECT_EQ(faces_of(with({{"leaves", 1.0}}), Part::glass), 1u);
  EXPECT_EQ(faces_of(with({{"leaves", 3.0}}), Part::glass), 3u);
  EXPECT_EQ(faces_of(with({{"leaves", 2.0}, {"transom", 0.66}}), Part::glass), 4u);
  EXPECT_EQ(faces_of(with({{"leaves", 2.0}, {"transom", 0.66}, {"upper_leaves", 1.0}}), Part::glass), 3u);
  EXPECT_EQ(faces_of(with({{"leaves", 2.0}, {"bars", 2.0}}), Part::frame),
            faces_of(with({{"leaves", 2.0}}), Part::frame) + 2 * 2 * 3)
      << "a bar is its front and two sides";
  // Panes: 1.2 - 2 * 0.07 wide between the frame, two leaves with stiles of 0.05.
  EXPECT_NEAR(front_area(with({{"leaves", 2.0}}), Part::glass), 2 * (0.53 - 0.1) * (1.86 - 0.1), 2e-3);
}

TEST(Windows, BoxWindowsHaveTwoLayersAndTheGap) {
  const Element e =
      made("double_casement", 1.1, 2.2, {{"gap", 0.15}, {"surround", "none"}, {"sill", "none"}, {"transom", 0.0}});
  std::set<double> depths;
  for (const ElementFace& f : e.mesh.faces)
    if (f.part == Part::glass) depths.insert(e.mesh.vertices[e.mesh.indices[f.first]].z);
  ASSERT_EQ(depths.size(), 2u);
  EXPECT_NEAR(*depths.rbegin() - *depths.begin(), 0.15, 0.02);
}

TEST(Windows, TheUsualBoxWindowIsCheap) {
  // With its surround and sill, at the usual detail: what a facade repeats a hundred times.
  EXPECT_LE(triangle_count(made("double_casement", 1.1, 2.2).mesh), 250u);
  EXPECT_LE(
      triangle_count(
          made("double_casement", 1.1, 2.2, {{"surround", "plain"}, {"head", "segmental"}, {"sill", "plain"}}).mesh),
      260u);
  EXPECT_LE(triangle_count(made("casement_window", 1.1, 1.6).mesh), 100u);
}

TEST(AllKinds, DetailLowersTheCountOfFaces) {
  for (const ElementKind& kind : shipped().kinds()) {
    std::size_t before = 0;
    for (const double detail : {0.0, 1.0, 2.0}) {
      const Element e = made(kind.name, kind.width.usual, kind.height.usual, {{"detail", detail}});
      const std::size_t triangles = triangle_count(e.mesh);
      EXPECT_GE(triangles, before) << kind.name << detail;
      before = triangles;
    }
  }
}

TEST(AllKinds, ParametersAreNamedOnceAndKeepTheirRanges) {
  std::set<std::string> kinds;
  for (const ElementKind& kind : shipped().kinds()) {
    EXPECT_TRUE(kinds.insert(kind.name).second);
    EXPECT_TRUE(kind.width.least <= kind.width.usual && kind.width.usual <= kind.width.most) << kind.name;
    EXPECT_TRUE(kind.height.least <= kind.height.usual && kind.height.usual <= kind.height.most) << kind.name;
    std::set<std::string> names;
    for (const ParameterInfo& p : kind.parameters) {
      EXPECT_TRUE(names.insert(p.name).second) << kind.name << p.name;
      EXPECT_FALSE(p.meaning.empty());
      const bool number = p.type == ParameterInfo::Type::number || p.type == ParameterInfo::Type::whole;
      EXPECT_TRUE(!number || (p.least <= p.initial && p.initial <= p.most)) << kind.name << p.name;
      EXPECT_TRUE(p.type != ParameterInfo::Type::word || p.initial < static_cast<double>(p.words.size())) << p.name;
      EXPECT_TRUE(p.type != ParameterInfo::Type::profile || shipped().profiles().contains(p.words.at(0))) << p.name;
    }
    EXPECT_TRUE(names.contains("detail")) << kind.name;
  }
}

/// Every parameter does something: at another value the mesh or the opening is another.
TEST(AllKinds, EveryParameterCounts) {
  // What a parameter needs to be seen.
  const std::map<std::string, std::vector<Parameter>> needs{
      {"rise", {{"head", "segmental"}}},
      {"stone_length", {{"surround", "brick"}}},
      {"stone_gap", {{"surround", "brick"}}},
      {"surround_width", {{"surround", "plain"}}},
      {"surround_projection", {{"surround", "plain"}}},
      {"surround_profile", {{"surround", "moulded"}}},
      {"sill_height", {{"sill", "plain"}}},
      {"sill_projection", {{"sill", "plain"}}},
      {"sill_overhang", {{"sill", "plain"}}},
      {"sill_profile", {{"sill", "moulded"}}},
      {"pediment_height", {{"pediment", "triangular"}}},
      {"pediment_projection", {{"pediment", "triangular"}}},
      {"pediment_rise", {{"pediment", "triangular"}}},
      {"pediment_overhang", {{"pediment", "triangular"}}},
      {"pediment_frieze", {{"pediment", "triangular"}}},
      {"pediment_profile", {{"pediment", "triangular"}}},
      {"pediment_consoles", {{"pediment", "triangular"}}},
      {"upper_leaves", {{"transom", 0.6}}},
      {"upper_bars", {{"transom", 0.6}}},
      {"upper_upright_bars", {{"transom", 0.6}}},
      {"bar", {{"bars", 1.0}, {"upright_bars", 1.0}}},
      {"door_width", {{"door", "left"}}},
      {"fanlight", {{"rise", 0.3}}},
      {"detail", {{"head", "round"}, {"outline", "circular"}}},
      {"bottom", {{"bottom_size", 0.2}}},
      {"right", {{"right_size", 0.2}}},
      {"top", {{"top_size", 0.2}}},
      {"left", {{"left_size", 0.2}}},
      {"dominant", {{"top", "round"}, {"top_size", 0.2}, {"right", "round"}, {"right_size", 0.2}}},
      {"upright_bars", {{"rise", 0.3}}},
  };
  for (const ElementKind& kind : shipped().kinds())
    for (const ParameterInfo& p : kind.parameters) {
      std::vector<Parameter> base;
      const auto has = [&](const std::string& name) {
        return std::any_of(kind.parameters.begin(), kind.parameters.end(),
                           [&](const auto& q) { return q.name == name; });
      };
      const auto add = [&](const Parameter& q) {
        const bool known = q.name != p.name && has(q.name) &&
                           std::none_of(base.begin(), base.end(), [&](const auto& b) { return b.name == q.name; });
        if (known) base.push_back(q);
      };
      if (const auto n = needs.find(p.name); n != needs.end())
        for (const Parameter& q : n->second) add(q);
      if (kind.name == "plinth" && p.name == "detail") add({"profile", "plinth_moulded"});
      if (kind.name == "carriage_gateway" && (p.name == "bar" || p.name == "upright_bars")) add({"rise", 0.3});
      if (kind.name == "shop_window" && p.name != "sign")
        add({"sign", p.name == "sign_projection" || p.name == "sign_overhang" ? 0.5 : 0.0});
      std::vector<Parameter> other = base;
      const double half = p.initial + (p.most - p.initial) / 2;
      switch (p.type) {
        case ParameterInfo::Type::number:
          // Towards the roomier end.
          other.push_back({p.name, p.name == "transom"      ? 0.6
                                   : p.name == "rise"       ? 0.3
                                   : p.name == "projection" ? 0.5 * p.initial
                                                            : p.initial + (half - p.initial) * 0.3});
          break;
        case ParameterInfo::Type::whole:
          // As many lights as leaves is the default.
          other.push_back({p.name, p.name == "upper_leaves" ? 3
                                   : p.initial == p.least   ? p.initial + 1
                                                            : p.initial - 1});
          break;
        case ParameterInfo::Type::word:
          other.push_back({p.name, p.words[p.initial == 0 ? 1 : 0]});
          break;
        case ParameterInfo::Type::profile:
          other.push_back({p.name, p.words[0] == "cyma" ? "drip" : "cyma"});
          break;
        case ParameterInfo::Type::edge:
          other.push_back({p.name, "round"});
          break;
      }
      const double w = kind.name == "shop_window" ? 5 : kind.width.usual, h = kind.height.usual * 1.2;
      const double height = std::min(h, kind.height.most);
      const Element a = made(kind.name, w, height, base), b = made(kind.name, w, height, other);
      const bool same = a.mesh.vertices == b.mesh.vertices && a.opening.outline == b.opening.outline &&
                        a.opening.reveal == b.opening.reveal;
      EXPECT_FALSE(same) << kind.name << " does not heed " << p.name;
    }
}

TEST(Doors, LeavesOfGatewaysStandAsAsked) {
  const std::vector<Parameter> bare{{"surround", "none"}, {"head", "straight"}};
  const auto with = [&](const char* leaves) {
    std::vector<Parameter> p = bare;
    p.push_back({"leaves", leaves});
    return made("carriage_gateway", 2.8, 3.4, p);
  };
  EXPECT_EQ(checks::open_place(with("closed")), "");
  EXPECT_NE(checks::open_place(with("open")), "");
  EXPECT_TRUE(with("absent").mesh.faces.empty());
  const Bounds3 open = bounds_of(with("open").mesh);
  EXPECT_LT(open.least.z, -0.30 - 1.3) << "leaves reach into the passage";
  EXPECT_FALSE(with("absent").opening.outline.empty());
}

TEST(Trim, SurroundsKeepClearOfTheOpening) {
  for (const char* type : {"plain", "moulded", "brick"}) {
    const Element e =
        made("surround", 1.2, 2, {{"surround", type}, {"surround_width", 0.2}, {"surround_projection", 0.05}});
    double outer = 0, inner = 9;
    for (const auto& p : e.mesh.vertices) {
      outer = std::max(outer, p.x);
      if (p.y < 1 && p.x > 0) inner = std::min(inner, p.x);
    }
    EXPECT_NEAR(outer, 0.6 + kApart + 0.2, 2e-3) << type;
    EXPECT_NEAR(inner, 0.6 + kApart, 1e-3) << type;
    EXPECT_NEAR(bounds_of(e.mesh).most.z, 0.05, 0.002) << type;
  }
}

TEST(Trim, TriangularPedimentsRiseByTheirShareOfTheSpan) {
  const Element e = made("pediment", 2, 0.2, {{"pediment_rise", 0.25}, {"pediment_projection", 0.2}});
  const Bounds3 box = bounds_of(e.mesh);
  EXPECT_NEAR(box.most.x, 1.2, 0.01);
  EXPECT_NEAR(box.most.z, 0.2, 0.002);
  EXPECT_GT(box.most.y, 0.25 * 2.4 + 0.2);
  EXPECT_LT(box.most.y, 0.25 * 2.4 + 0.45);
}

TEST(Trim, SillsDripClearOfTheWallAndReachTheFrame) {
  const Element e =
      made("casement_window", 1.1, 1.6, {{"reveal", 0.15}, {"sill_projection", 0.1}, {"sill_overhang", 0.06}});
  double front = 0, back = 0, side = 0;
  for (const ElementFace& f : e.mesh.faces)
    if (f.part == Part::sill)
      for (std::uint32_t i = 0; i < f.count; ++i) {
        const auto& v = e.mesh.vertices[e.mesh.indices[f.first + i]];
        front = std::max(front, v.z);
        back = std::min(back, v.z);
        side = std::max(side, v.x);
      }
  EXPECT_NEAR(front, 0.1, 1e-9);
  EXPECT_NEAR(back, -0.15 - kApart, 1e-9);
  EXPECT_NEAR(side, 0.55 + 0.06, 1e-3);
}

}  // namespace
}  // namespace blockrand::elements
