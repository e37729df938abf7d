// Derivations: seeds, attributes, limits, orders, blocks, and what is told when something is wrong.
#include "styles/grammar/evaluation/derive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "derive_support.h"
#include "styles/grammar/evaluation/run.h"
#include "styles/grammar/shapes/measure.h"

namespace blockrand::grammar {
namespace {

using namespace testing_support;
using testing::ElementsAre;
using testing::HasSubstr;

/// Symbols, sizes and seeds of the leaves, and what was printed.
std::string whole(const Derivation& d) {
  std::string out = prints_text(d);
  for (const Leaf& l : d.leaves) out += "\n" + l.symbol + " " + size_text(l.shape) + " " + std::to_string(l.shape.seed);
  return out;
}
std::string prints(const std::string& rules, const DeriveOptions& options = {}) {
  return prints_text(derive_text(rules, rectangle(10, 20), options));
}
/// The diagnostics with this code; their places as "line:column".
std::vector<std::string> places(const Derivation& d, std::string_view code) {
  std::vector<std::string> out;
  for (const Diagnostic& one : d.diagnostics)
    if (one.code == code) out.push_back(std::to_string(one.location.line) + ":" + std::to_string(one.location.column));
  return out;
}
DeriveOptions seeded(std::uint64_t seed) {
  DeriveOptions options;
  options.seed = seed;
  return options;
}

constexpr const char* kTown = R"(
attr height = rand(9, 21)
attr tone = 50% : "light" else : "dark"
floors = rint(height / 3)
Lot --> extrude(height) comp(f){ side : Facade | top : Roof. | bottom : NIL }
Facade --> split(y){ ~3 : Floor }*
Floor --> split(x){ 0.5 : Wall. | { ~2 : Tile }* | 0.5 : Wall. }
Tile --> 40% : Window("wide") 30% : Window("narrow") else : Wall.
Window(kind) --> case p(0.5) : print(kind) W. else : s('rand(0.4, 0.9), '1, '1) center(x) V.
)";

TEST(Attributes, ParametersOfOneAreRefusedAndReadByNobody) {
  const Program program = load_text("attr u(index) = case index == 1 : 2 else : 3\nLot --> print(u)");
  EXPECT_THAT(all_diagnostics(program.diagnostics), HasSubstr("attribute_parameters"));
  // A rule file with mistakes is derived as far as it goes.
  const Derivation run = derive(program, rectangle(10, 10), {});
  EXPECT_EQ(run.attributes, (std::vector<std::pair<std::string, Value>>{{"u", 3.0}}));
}

TEST(Seeds, TheSameSeedGivesTheSameModelAndAnotherOneAnother) {
  const auto one = whole(derive_text(kTown, rectangle(10, 20), seeded(1)));
  EXPECT_EQ(one, whole(derive_text(kTown, rectangle(10, 20), seeded(1))));
  std::set<std::string> different;
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    different.insert(whole(derive_text(kTown, rectangle(10, 20), seeded(seed))));
  EXPECT_EQ(different.size(), 20u);
}

TEST(Seeds, RulesOfOneSubtreeDoNotTouchTheOther) {
  const auto right = [](const std::string& left_rules, std::uint64_t seed) {
    const auto d = derive_text(
        "Lot --> split(x){ '0.5 : A | '0.5 : B }\nB --> split(x){ ~1 : C }*\nC --> print(rand) C2\nC2 --> 50% : D. "
        "else : E.\n" +
            left_rules,
        rectangle(10, 20), seeded(seed));
    std::string out = prints_text(d);
    for (const Leaf& l : d.leaves)
      if (l.symbol != "X.") out += l.symbol + std::to_string(l.shape.seed);
    return out;
  };
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const std::string plain = right("A --> X.", seed);
    EXPECT_EQ(plain, right("f = rand + rand\nA --> t(f, rand, 0) split(x){ ~1 : s('rand,'1,'1) X. | 1 : NIL }*", seed));
    EXPECT_EQ(plain, right("A --> 50% : X. X. X. else : NIL", seed));
  }
}

TEST(Seeds, SiblingsDifferAndGroupsDrawOnce) {
  EXPECT_EQ(
      derive_text("Lot --> extrude(3) comp(f){ all : P }\nP --> print(rand) NIL", rectangle(10, 20)).prints.size(), 6u);
  const auto each = derive_text("Lot --> extrude(3) comp(f){ all : print(rand) NIL }", rectangle(10, 20)).prints;
  EXPECT_EQ(std::set<std::string>(each.begin(), each.end()).size(), 6u);
  EXPECT_EQ(derive_text("Lot --> extrude(3) comp(f){ all = print(rand) NIL }", rectangle(10, 20)).prints.size(), 1u);
}

TEST(Seeds, BracketsGoOnDrawing) {
  const auto d = derive_text("Lot --> [ print(rand) NIL ] print(rand) NIL", rectangle(10, 20));
  ASSERT_EQ(d.prints.size(), 2u);
  EXPECT_NE(d.prints[0], d.prints[1]);
}

TEST(Seeds, SeedianReplacesTheSeed) {
  const std::string rules =
      "Lot --> split(x){ '0.5 : set(seedian, 7) P | '0.5 : set(seedian, 7) P }\nP --> print(seedian) NIL";
  const auto d = derive_text(rules, rectangle(10, 20));
  ASSERT_EQ(d.prints.size(), 2u);
  EXPECT_EQ(d.prints[0], d.prints[1]) << "children number 0 of shapes with one seed";
}

TEST(Consistency, OneBranchInAWholeBuildingOrRow) {
  const std::string rules =
      "Lot --> split(x){ ~0.5 : Tile | ~0.5 : Free | ~0.5 : Row }*\n"
      "@Consistent(\"building\")\nTile --> 50% : A. else : B.\n"
      "@Consistent(\"row\")\nRow --> case p(0.5) : E. else : F.\n"
      "Free --> 50% : C. else : D.";
  int a_first = 0;
  std::set<std::string> rows;
  for (std::uint64_t building = 0; building < 100; ++building) {
    DeriveOptions options;
    options.seed = 1000 + building;
    options.building_seed = building;
    options.row_seed = 5;
    const auto d = derive_text(rules, rectangle(20, 20), options);
    std::set<std::string> symbols;
    for (const Leaf& l : d.leaves) symbols.insert(l.symbol);
    EXPECT_NE(symbols.count("A."), symbols.count("B."));
    EXPECT_EQ(symbols.count("C.") + symbols.count("D."), 2u) << "others are free";
    a_first += static_cast<int>(symbols.count("A."));
    rows.insert(symbols.count("E.") > 0 ? "E" : "F");
  }
  EXPECT_GT(a_first, 30);
  EXPECT_LT(a_first, 70);
  EXPECT_EQ(rows.size(), 1u) << "one row seed: one branch for all its buildings";
}

TEST(Attributes, ComeFromOutsideInTheirOwnType) {
  const std::string rules =
      "attr building__levels = 3\nattr height = building__levels * 3\nattr name = \"a\"\nattr lit = false\nconst k = "
      "1\n"
      "Lot --> print(building__levels) print(height) print(name) print(lit) print(k)";
  EXPECT_EQ(prints(rules), "3 9 a false 1");
  DeriveOptions options;
  options.attributes = {
      {"building:levels", std::string("5 floors")}, {"name", 7.0}, {"lit", std::string("yes")}, {"k", 2.0}};
  EXPECT_EQ(prints(rules, options), "5 15 7 true 1") << "defaults that depend on them follow; constants do not";
  options.attributes = {{"building:levels", std::string("many")}, {"colour", std::string("red")}};
  const auto wrong = derive_text(rules, rectangle(10, 20), options);
  EXPECT_EQ(prints_text(wrong), "3 9 a false 1");
  EXPECT_THAT(places(wrong, "value"), ElementsAre("1:6"));
  EXPECT_EQ(places(wrong, "unused_value").size(), 1u);
}

TEST(Attributes, AreDrawnWithoutDisturbingOneAnother) {
  const auto first =
      derive_text("attr a = rand\nattr b = rand\nLot --> print(a) print(b) print(rand)", rectangle(1, 1));
  const auto second = derive_text(
      "attr c = rand + rand\nattr b = rand\nattr a = rand\nLot --> print(a) print(b) print(rand)", rectangle(1, 1));
  EXPECT_EQ(first.prints, second.prints);
  EXPECT_NE(first.prints[0], first.prints[1]);
}

TEST(Attributes, ThatDependOnThemselvesAreErrors) {
  const Program program = load_text("attr a = f\nattr b = a + 1\nf = b\nattr c = 4\nLot --> print(c) X.");
  const auto d = derive(program, rectangle(1, 1));
  EXPECT_TRUE(has_errors(program.diagnostics) || !places(d, "cycle").empty());
  EXPECT_THAT(d.prints, ElementsAre("4")) << "the rest runs";
}

TEST(Attributes, ThatTheProgramGives) {
  int asked = 0;
  DeriveOptions options;
  options.source = [&](std::string_view name) -> std::optional<Value> {
    ++asked;
    if (name == "building.storeys") return 5.0;
    if (name == "edge.kind") return std::string("street");
    if (name == "edgeAttr.partyWall") return true;
    return std::nullopt;
  };
  const auto d = derive_text(
      "Lot --> print(building.storeys) print(building.storeys * 3) print(edge.kind) "
      "print(edgeAttr.getBool(\"partyWall\"))\n"
      "print(edgeAttr.getFloat(\"none\")) print(roof.shape)",
      rectangle(10, 20), options);
  EXPECT_EQ(prints_text(d), "5 15 street true 0 0");
  EXPECT_EQ(asked, 5) << "each name once";
  EXPECT_THAT(places(d, "unknown_name"), ElementsAre("2:40"));
}

/// What derivations share changes nothing, and what is a derivation's own is not shared.
TEST(Attributes, AreEvaluatedOnceForAllThatShareThem) {
  const Program program = load_text(R"(
attr storeys = building.storeys * 2
attr wide = edge.length > 5
attr tall = storeys > 3 && p(0.5)
attr tone = case wide : "w" else : "n"
attr drawn = rand(0, 1)
attr lot = scope.sx
@Consistent("building")
const joinery = rand(0, 1)
const of_others = storeys + joinery
const bad = missing.name + 1
twice(x) = x * storeys
const called = twice(3)
Lot --> print(storeys) print(wide) print(tall) print(tone) print(drawn) print(lot) print(joinery) print(of_others) print(bad) print(called) X.
)");
  AttributeMemo memo;
  std::size_t asked = 0;
  for (int wall = 0; wall < 6; ++wall) {
    DeriveOptions options = seeded(static_cast<std::uint64_t>(wall));
    options.building_seed = 7;
    options.source = [&](std::string_view name) -> std::optional<Value> {
      if (name == "building.storeys") return ++asked, Value(2.0);
      if (name == "edge.length") return Value(static_cast<double>(wall * 2));
      return std::nullopt;
    };
    const Derivation alone = derive(program, rectangle(3 + wall, 10), options);
    asked = 0;
    options.memo = &memo;
    options.is_shared = [](std::string_view name) { return name.starts_with("building."); };
    const Derivation shared = derive(program, rectangle(3 + wall, 10), options);
    EXPECT_EQ(shared.prints, alone.prints) << wall;
    EXPECT_EQ(shared.attributes, alone.attributes) << wall;
    EXPECT_EQ(all_diagnostics(shared.diagnostics), all_diagnostics(alone.diagnostics)) << wall;
    EXPECT_EQ(asked, wall == 0 ? 1u : 0u) << wall;
  }
}

TEST(Functions, AreEvaluatedAtEachCallAndRecurse) {
  EXPECT_EQ(prints("f(n) = case n <= 0 : 0 else : 1 + f(n - 1)\nLot --> print(f(1000))"), "1000");
  EXPECT_EQ(prints("fib(n) = case n < 2 : n else : fib(n-1) + fib(n-2)\nLot --> print(fib(15))"), "610");
  EXPECT_EQ(prints("find2(max) = case max <= 1 : floatArray else : sieve(sqrt(max), [2 : max], floatArray)\n"
                   "sieve(limit, a, primes) = case a[0] <= limit : sieve(limit, a[a .% a[0] .!= 0], [primes, a[0]])\n"
                   "else : [primes, a]\nLot --> print(find2(20))"),
            "(8)[2,3,5,7,11,13,17,19]");
  EXPECT_EQ(prints("g(a) = a + \"!\"\nLot(x) --> print(x)\nInit --> Lot(g(\"hey\"))"), "hey!");
}

TEST(Functions, BindingsAreEvaluatedOnce) {
  const auto d = derive_text("Init --> R(2)\nR(a) with ( x := rand y := a + x ) --> print(x) print(x) print(y - x)",
                             rectangle(10, 20));
  ASSERT_EQ(d.prints.size(), 3u);
  EXPECT_EQ(d.prints[0], d.prints[1]);
  EXPECT_EQ(d.prints[2], "2");
}

TEST(Rules, OverloadByCountAndType) {
  EXPECT_EQ(
      prints("Lot --> R R(1) R(\"a\") R(1,2)\nR --> print(\"none\")\nR(a) --> print(a) NIL\nR(a,b) --> print(a+b)"),
      "none 1 a 3");
  EXPECT_EQ(prints("Lot --> R(1) R(\"a\")\nR(n) --> print(n + 1)\nR(s) --> print(len(s))").substr(0, 1), "2");
}

TEST(Rules, CasesAreEvaluatedLazily) {
  EXPECT_EQ(prints("Lot --> case true : A case 1/0 > print(3) : B else : C\nA --> print(\"a\")"), "a");
  EXPECT_EQ(prints("Lot --> print(case false : print(1) else : 2) print(true || print(true))"), "2 true");
}

TEST(Rules, NilAndLeaves) {
  EXPECT_EQ(lengths(derive_text("Lot --> A. NIL B.", rectangle(10, 20))), "A 10");
  EXPECT_EQ(lengths(derive_text("Lot --> [ NIL ] B.", rectangle(10, 20))), "B 10");
  EXPECT_EQ(lengths(derive_text("Lot --> split(x){ ~1 : NIL }", rectangle(10, 20))), "");
  EXPECT_EQ(lengths(derive_text("Lot --> split(x){ 4 : color(\"#ff0000\") | ~1 : B. }", rectangle(10, 20))),
            "Lot 4, B 6")
      << "a piece without child is a leaf";
  EXPECT_EQ(lengths(derive_text("Lot --> X. [ A ] s('0.5,'1,'1)\nA --> s(2,'1,'1)", rectangle(10, 20))), "X 10, A 2");
}

TEST(Rules, BlocksRelateToTheirPiece) {
  EXPECT_EQ(lengths(derive_text("Lot --> split(x){ 4 : s('0.5,'1,'1) center(x) A. | ~1 : B. }", rectangle(10, 20))),
            "A 2, B 6");
  const auto d = derive_text("Lot --> split(x){ 4 : s('0.5,'1,'1) center(x) A. | ~1 : B. }", rectangle(10, 20));
  EXPECT_NEAR(leaf(d, "A.").scope.origin.x, 1, 1e-9);
}

TEST(Rules, SelectorsMayBeExpressions) {
  const auto count = [](const std::string& block, const char* symbol) {
    return leaves_of(derive_text("attr n = 1\nLot --> extrude(5) comp(f)" + block, rectangle(10, 20)), symbol).size();
  };
  EXPECT_EQ(count("{ top || bottom : X. | all : Y. }", "X."), 2u);
  EXPECT_EQ(count("{ side && !front : X. | all : Y. }", "X."), 3u);
  EXPECT_EQ(count("{ 0 : X. | n + 1 : Y. | all = Z. }", "X."), 1u);
  EXPECT_EQ(count("{ 0 : X. | n + 1 : Y. | all = Z. }", "Y."), 1u);
  EXPECT_EQ(count("{ geometry.area > 75 : X. | all = Z. }", "X."), 4u);
  EXPECT_EQ(count("{ sel(\"front\") : X. | all = Z. }", "X."), 1u);
}

TEST(Rules, ComponentsAsFunction) {
  EXPECT_EQ(prints("Lot --> extrude(5) print(comp(f){ top : geometry.area | front : scope.sx })"),
            "(6)[0,200,10,0,0,0]");
  EXPECT_EQ(prints("Lot --> extrude(5) print(sum(comp(f){ side : geometry.area }))"), "300");
  EXPECT_EQ(prints("Lot --> extrude(5) print(comp(f){ top : \"t\" | bottom : \"b\" })"), "(6)[b,t,,,,]");
  EXPECT_EQ(prints("Lot --> extrude(5) print(size(comp(e){ all = rand }))"), "12");
}

TEST(Names, WhatTheTableSaysIsTrue) {
  const BuiltInActions& actions = built_in_actions();
  for (const BuiltIn& entry : built_ins()) {
    const std::uint32_t number = built_in_number(entry);
    if (entry.kind == NameKind::operation) {
      const bool runs = actions.operations[number] != nullptr || actions.special_steps[number] != &Run::step_not_yet;
      EXPECT_TRUE(runs || entry.status == Status::not_yet) << entry.name;
    }
    if (entry.kind == NameKind::function && entry.status != Status::not_yet) {
      EXPECT_TRUE(actions.special_functions[number] != nullptr || !actions.functions[number].empty()) << entry.name;
    }
  }
}

TEST(Orders, CarryTheirArgumentsAndTheShape) {
  const auto d = derive_text(
      "Lot --> split(x){ 4 : blockrand.window(\"double_casement\", \"head\", \"segmental\", \"bars\", 1 + 1) | ~1 : B. "
      "}",
      rectangle(10, 20));
  ASSERT_EQ(d.leaves.size(), 2u);
  const Leaf& window = d.leaves[0].order ? d.leaves[0] : d.leaves[1];
  ASSERT_NE(window.order, nullptr);
  EXPECT_EQ(window.order->name, "window");
  EXPECT_THAT(window.order->arguments,
              ElementsAre(Value(std::string("double_casement")), Value(std::string("head")),
                          Value(std::string("segmental")), Value(std::string("bars")), Value(2.0)));
  EXPECT_EQ(window.order->location.line, 1u);
  EXPECT_NEAR(window.shape.size.x, 4, 1e-9);
}

TEST(Telling, ReportsByKeyAndType) {
  const auto d = derive_text(
      "Lot --> split(x){ ~1 : report(\"n.a\", scope.sx) report(\"ok\", scope.sx > 1) report(\"n.a\", \"text\") NIL }*",
      rectangle(10, 20));
  ASSERT_EQ(d.reports.size(), 3u);
  EXPECT_EQ(d.reports[0].key, "n.a");
  EXPECT_EQ(d.reports[0].count, 10u);
  EXPECT_NEAR(d.reports[0].sum, 10, 1e-9);
  EXPECT_NEAR(d.reports[0].mean, 1, 1e-9);
  EXPECT_EQ(d.reports[1].type, Type::text);
  EXPECT_EQ(d.reports[1].count, 10u);
  EXPECT_EQ(d.reports[2].key, "ok");
  EXPECT_EQ(d.reports[2].type, Type::truth);
  EXPECT_EQ(d.report("nothing"), nullptr);
}

TEST(Limits, ShapesDoNotGrowWithoutEnd) {
  DeriveOptions options;
  options.limits.faces = 1000;
  const auto d = derive_text("Lot --> extrude(1) Lot", rectangle(10, 20), options);
  EXPECT_THAT(places(d, "too_many_faces"), ElementsAre("1:9"));
}

TEST(Telling, CyclesThatNoRunTakesHaveValues) {
  const std::string rules =
      "attr on = false\nattr a = case on : b else : 1\nattr b = case on : 2 else : a\nLot --> print(a) print(b) X.";
  EXPECT_EQ(prints(rules), "1 1");
  DeriveOptions options;
  options.attributes = {{"on", true}};
  EXPECT_EQ(prints_text(derive_text(rules, rectangle(10, 20), options)), "2 2");
}

TEST(Telling, ContextAnswersAsIfNothingWereNear) {
  EXPECT_EQ(prints("Lot --> label(\"a\") print(touches) print(inside(intra)) print(overlaps) "
                   "print(minimumDistance(intra, \"a\"))\n"
                   "print(contextCount(intra, \"a\"))"),
            "false false false inf 0");
}

TEST(Telling, ConvertsCoordinates) {
  EXPECT_EQ(prints("Lot --> t(1,2,3) print(convert(x, scope, object, pos, 1, 0, 0)) print(convert(z, scope, world, "
                   "pos, 0, 0, 0))\n"
                   "print(convert(y, object, scope, pos, 0, 0, 0))"),
            "2 -17 -2");
  EXPECT_EQ(prints("Lot --> r(0,30,0) print(rint(convert(y, scope, object, orient, 0, 0, 0))) "
                   "print(rint(convert(y, object, scope, orient, 0, 0, 0)))"),
            "30 -30");
}

TEST(Telling, TheTreeIsKeptOnDemand) {
  DeriveOptions options;
  options.keep_tree = true;
  const auto d = derive_text("Lot --> split(x){ '0.5 : A | '0.5 : B. }\nA --> C. D.", rectangle(10, 20), options);
  ASSERT_EQ(d.tree.size(), 5u);
  EXPECT_EQ(d.tree[0].symbol, "Lot");
  EXPECT_EQ(d.tree[0].parent, kNone);
  EXPECT_EQ(d.tree[1].symbol, "A");
  EXPECT_NE(d.tree[1].definition, kNone);
  EXPECT_NEAR(d.tree[1].shape.size.x, 5, 1e-9);
  ASSERT_EQ(leaves_of(d, "D.").size(), 1u);
  const std::uint32_t node = leaves_of(d, "D.")[0]->node;
  EXPECT_EQ(d.tree[node].symbol, "D.");
  EXPECT_EQ(tree_key(d, node), "0;0;1;");
  EXPECT_EQ(d.shapes, 5u);
  EXPECT_TRUE(derive_text("Lot --> A.", rectangle(10, 20)).tree.empty());
}

TEST(Errors, EndlessRulesEndAndTheRestIsKept) {
  const auto deep = derive_text("Lot --> A B.\nA --> t(1,0,0)\n A", rectangle(10, 20));
  EXPECT_THAT(places(deep, "depth"), ElementsAre("3:2"));
  EXPECT_EQ(lengths(deep), "B 10");
  const auto wide = derive_text("Lot --> B. A\nA --> A A", rectangle(10, 20));
  EXPECT_EQ(places(wide, "too_many_shapes").size(), 1u);
  EXPECT_EQ(leaves_of(wide, "B.").size(), 1u);
  EXPECT_EQ(wide.shapes, DeriveLimits().shapes);
}

TEST(Errors, EndlessFunctionsEnd) {
  const auto d =
      derive_text("f(n) = f(n + 1) + 1\ng = h\nh = g\nLot --> print(f(0) > 0) print(g) B.", rectangle(10, 20));
  EXPECT_FALSE(places(d, "function_depth").empty());
  EXPECT_EQ(lengths(d), "B 10");
  const auto nested = derive_text("f(n) = [f([n+1][0])+1][0]\nLot --> print(f(0)) B.", rectangle(10, 20));
  EXPECT_EQ(lengths(nested), "B 10");
}

/// Rule files that were typed carelessly: letters lost, doubled, exchanged, lines moved.
TEST(Errors, DamagedRulesNeitherCrashNorHang) {
  const std::string whole_text =
      std::string(kTown) +
      "Extra(n) --> [ t(1,'0.5,0) r(0,45,0) roofHip(30) comp(e){ ridge : X. | all = Y. } ]\n"
      "  setback(1){ front : A. | remainder : scatter(surface, 3, uniform){ P. } }\n"
      "g(a) = [1:3; a, 2, size([a])] .* 2\n"
      "Roof --> roofGable(40, 0.5) split(y){ '0.5 : offset(-1) Extra(1) | ~1 : Extra(rand) }\n";
  std::uint64_t state = 1;
  const auto next = [&](std::size_t below) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>((state >> 33) % below);
  };
  DeriveOptions options;
  options.limits.shapes = 500;
  options.limits.pieces = 2000;
  options.limits.calls = 10000;
  options.limits.depth = 60;
  std::size_t leaves = 0;
  for (int round = 0; round < 600; ++round) {
    std::string text = whole_text;
    for (std::size_t edit = 0; edit <= next(3); ++edit) {
      const std::size_t at = next(text.size());
      switch (next(4)) {
        case 0:
          text.erase(at, 1 + next(3));
          break;
        case 1:
          text.insert(at, text.substr(next(text.size()), 1 + next(12)));
          break;
        case 2:
          text[at] = "(){}[]|:~'*%+-/.,\"=<>aT0 1\n"[next(29)];
          break;
        default:
          std::swap(text[at], text[next(text.size())]);
          break;
      }
    }
    options.seed = static_cast<std::uint64_t>(round);
    leaves += derive(load_text(text), rectangle(6, 8), options).leaves.size();
  }
  EXPECT_GT(leaves, 10000u) << "most of each file still runs";
}

TEST(Errors, NothingTakesForeverOrAllMemory) {
  DeriveOptions options;
  options.limits.calls = 10000;
  options.limits.pieces = 1000;
  const auto calls = derive_text("f(n) = f(n - 1) + f(n - 1)\nLot --> print(f(1)) B.", rectangle(10, 20), options);
  EXPECT_EQ(places(calls, "too_many_calls").size(), 1u);
  for (const Diagnostic& d : calls.diagnostics)
    EXPECT_TRUE(d.code != "too_many_calls" || d.location.line == 1u) << "where the call stands";
  EXPECT_EQ(lengths(calls), "B 10");
  const auto pieces =
      derive_text("Lot --> split(x){ ~0.1 : split(z){ ~0.1 : s('1,1,'1) }* }* B.", rectangle(10, 20), options);
  EXPECT_FALSE(places(pieces, "too_many_pieces").empty());
  EXPECT_LE(pieces.leaves.size(), 1001u);
  const auto text = derive_text(
      "double(s, n) = case n == 0 : s else : double(s + s, n - 1)\nLot --> print(len(double(\"ab\", 100))) B.",
      rectangle(10, 20));
  EXPECT_FALSE(places(text, "type").empty());
  EXPECT_EQ(lengths(text), "B 10");
  const auto array = derive_text(
      "double(s, n) = case n == 0 : s else : double([s, s], n - 1)\nLot --> print(size(double([1], 100))) B.",
      rectangle(10, 20));
  EXPECT_EQ(lengths(array), "B 10");
}

TEST(Errors, HaveTheirPlace) {
  const auto d = derive_text(
      "Lot --> split(x){ 3 : extrude(0/0) A. | 3 : extrude(\"a\" + 1) B. | 1 : color(\"red\") C. | ~1 : print(\"a\" < "
      "1) D. }",
      rectangle(10, 20));
  EXPECT_EQ(d.leaves.size(), 4u) << "what is wrong leaves the shape as it is";
  EXPECT_EQ(places(d, "not_finite").size(), 1u);
  EXPECT_EQ(places(d, "operation").size(), 2u);
  EXPECT_EQ(places(d, "type").size(), 1u);
}

TEST(Errors, WhatIsNotThereYetIsToldByName) {
  const auto d = derive_text("Lot --> setMaterial([\"a\"]) inline A\nA --> B.", rectangle(10, 20));
  EXPECT_EQ(places(d, "not_yet").size(), 2u);
  EXPECT_THAT(all_diagnostics(d.diagnostics), HasSubstr("'setMaterial'"));
  EXPECT_EQ(lengths(d), "B 10");
}

TEST(Errors, ComparingShapesIsBounded) {
  DeriveOptions options;
  const std::string rules =
      "Lot --> [ extrude(3) Box. ] split(x){ ~0.5 : split(z){ ~0.5 : extrude(2) Ask }* }*\n"
      "Ask --> case overlaps(intra) : Over. else : Free.";
  const auto all = derive_text(rules, rectangle(4, 4), options);
  EXPECT_EQ(places(all, "too_many_calls").size(), 0u);
  options.limits.calls = 2000;
  const auto few = derive_text(rules, rectangle(4, 4), options);
  ASSERT_EQ(places(few, "too_many_calls"), std::vector<std::string>{"2:14"});
  EXPECT_EQ(few.leaves.size(), all.leaves.size()) << "the rest is kept";
  options.limits.calls = 100;
  for (const char* query : {"contextCount(intra, \"\")", "minimumDistance(intra)"}) {
    const auto d = derive_text("Lot --> split(x){ ~0.2 : extrude(1) A }*\nA --> print(" + std::string(query) + ") B.",
                               rectangle(10, 4), options);
    EXPECT_EQ(places(d, "too_many_calls"), std::vector<std::string>{"2:13"}) << query;
  }
}

TEST(Errors, RulesThatCouldNotBeReadAreToldOnce) {
  for (const char* rules : {"Lot --> extrude(5 X.", "Lot -> extrude(5) X.", "attr h = 1\nLot --> split(x){ 1 : X."}) {
    const Program program = load_text(rules);
    EXPECT_TRUE(has_errors(program.diagnostics)) << rules;
    EXPECT_EQ(all_diagnostics(derive(program, rectangle(1, 1)).diagnostics), "") << rules;
  }
  EXPECT_EQ(places(derive(load_text("attr h = 1"), rectangle(1, 1)), "no_start_rule").size(), 1u);
  DeriveOptions named;
  named.start_rule = "Other";
  EXPECT_EQ(places(derive(load_text("Lot --> s(1 X."), rectangle(1, 1), named), "no_start_rule").size(), 1u);
}

TEST(Errors, SymbolsWithoutRuleAreLeavesWithAWarning) {
  const auto d = derive_text("Lot --> split(x){ ~1 : exturde(3) }*", rectangle(10, 20));
  EXPECT_EQ(d.leaves.size(), 10u);
  ASSERT_EQ(places(d, "no_rule").size(), 1u);
  EXPECT_EQ(d.diagnostics[0].suggestion, "extrude");
}

TEST(Errors, StartRules) {
  DeriveOptions options;
  EXPECT_EQ(
      prints(
          "attr name = initialShape.startRule\nFirst --> print(name) Second\nSecond --> print(initialShape.startRule)"),
      "First First");
  options.start_rule = "Second";
  EXPECT_EQ(prints("First --> print(1)\nSecond --> print(2)", options), "2");
  options.start_rule = "Third";
  EXPECT_EQ(places(derive_text("First --> print(1)", rectangle(1, 1), options), "no_start_rule").size(), 1u);
  EXPECT_TRUE(derive(load_text("attr a = 1"), rectangle(1, 1)).leaves.empty());
  EXPECT_TRUE(derive(Program{}, rectangle(1, 1)).leaves.empty());
}

}  // namespace
}  // namespace blockrand::grammar
