// Checks: each tells what is wrong, where, and keeps quiet about what is right.
#include "styles/grammar/language/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

namespace blockrand::grammar {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Program program_of(const std::string& text, const std::map<std::string, std::string>& others = {}) {
  LoadOptions options;
  options.read = [&](const std::string& path) -> std::optional<std::string> {
    if (path == "main.cga") return text;
    const auto found = others.find(path);
    return found == others.end() ? std::nullopt : std::optional(found->second);
  };
  return load("main.cga", options);
}

std::vector<std::string> lines(const std::vector<Diagnostic>& all) {
  std::vector<std::string> out;
  for (const Diagnostic& d : all)
    out.push_back(std::to_string(d.location.line) + ":" + std::to_string(d.location.column) + " " + d.code +
                  (d.suggestion.empty() ? "" : " → " + d.suggestion));
  return out;
}

std::vector<std::string> told(const std::string& text, const std::map<std::string, std::string>& others = {},
                              const CheckOptions& options = {}) {
  const Program program = program_of(text, others);
  EXPECT_THAT(lines(program.diagnostics), IsEmpty());
  return lines(check(program, options));
}

TEST(Check, SaysNothingOfWhatIsRight) {
  EXPECT_THAT(
      told(
          "version \"2021.0\"\nattr h = 3.5\nconst w = 2\n@StartRule\nLot --> extrude(h) comp(f){ side : Facade | top "
          ": Roof }\n"
          "Facade --> split(x){ ~w : Tile(1) }*\nTile(n) --> case n > 0 : 30% : Window else : Wall. else : Wall.\n"
          "Window --> s('1,'1,0.1) primitiveCube() color(\"#ff0000\")\nRoof --> roofGable(byAngle, 30, 0.5) "
          "set(material.color.r, 1)\n"
          "List(s) --> case s == \"\" : NIL else : List(substring(s,1,9))\n@Hidden\n@StartRule Other --> List(\"ab\")"),
      IsEmpty());
}

TEST(Check, Probabilities) {
  EXPECT_THAT(told("A --> 60% : X. 50% : Y. else : Z."), ElementsAre("1:16 probability"));
  EXPECT_THAT(told("A --> -5% : X. else : Z."), ElementsAre("1:7 probability"));
  EXPECT_THAT(told("f = 33.3333% : 1 33.3333% : 2 33.3334% : 3 else : 4"), ElementsAre("1:44 never"));
  EXPECT_THAT(told("const p1 = 70\nA --> p1% : X. p1% : Y. else : Z."), ElementsAre("2:16 probability"));
  EXPECT_THAT(told("A(q) --> q% : X. 99% : Y. else : Z."), IsEmpty());
}

TEST(Check, ConditionsThatAreAlwaysTheSame) {
  EXPECT_THAT(told("A --> case 1 > 2 : X. else : Y."), ElementsAre("1:7 never"));
  EXPECT_THAT(told("A --> case true : X. else : Y."), ElementsAre("1:22 never"));
  EXPECT_THAT(told("attr h = 2\nA --> case h > 1 : X. else : Y."), IsEmpty());
}

TEST(Check, SizesThatCannotFit) {
  EXPECT_THAT(told("A --> s(10,3,0) split(x){ 6 : X. | 5 : Y. }"), ElementsAre("1:27 size"));
  EXPECT_THAT(told("A --> s(10,3,0) t(1,0,0) split(x){ 6 : X. | ~1 : Z. | 4 : Y. }"), ElementsAre("1:36 size"));
  EXPECT_THAT(told("A --> split(y){ 2 : split(y){ 3 : X. | ~1 : Y. } | ~1 : Z. }"), ElementsAre("1:31 size"));
  EXPECT_THAT(told("A --> split(x){ '0.6 : X. | '0.5 : Y. }"), ElementsAre("1:17 size"));
  EXPECT_THAT(told("A --> extrude(3) split(y){ 4 : X. }"), ElementsAre("1:28 size"));
  EXPECT_THAT(told("A --> split(x){ 0 : X. | ~1 : Y. }"), ElementsAre("1:17 size"));
  EXPECT_THAT(told("A --> s(10,3,0) split(x){ 6 : X. | 5 : Y. }*"), IsEmpty());
  EXPECT_THAT(told("A --> s(10,3,0) extrude(2) split(x){ 6 : X. | 5 : Y. }"), IsEmpty());
  EXPECT_THAT(told("A --> s(10,3,0) comp(f){ all : split(x){ 11 : X. } }"), IsEmpty());
}

TEST(Check, Types) {
  EXPECT_THAT(told("attr s = \"a\"\nA --> extrude(s)"), ElementsAre("2:15 type"));
  EXPECT_THAT(told("f = \"a\" - 1"), ElementsAre("1:5 type"));
  EXPECT_THAT(told("f = \"a\" + 1"), IsEmpty());
  EXPECT_THAT(told("f = true + 1"), ElementsAre("1:10 type"));
  EXPECT_THAT(told("attr n = 1\nA --> case n : X. else : Y."), ElementsAre("2:12 type"));
  EXPECT_THAT(told("f = case true == false : 1 else : \"b\""), testing::Contains("1:35 type"));
  EXPECT_THAT(told("f = scope.sx == \"1\""), ElementsAre("1:14 type"));
  EXPECT_THAT(told("f = 3[0]"), ElementsAre("1:5 type"));
  EXPECT_THAT(told("f = [1,2] * 2\ng = [1,2] .* 2"), ElementsAre("1:5 type"));
  EXPECT_THAT(told("A --> B(\"x\")\nB(n) --> extrude(n)"), ElementsAre("1:7 type"));
  EXPECT_THAT(told("A --> split(x){ \"2\" : X. }"), ElementsAre("1:17 type"));
  EXPECT_THAT(told("import i : \"i.cga\" (h = \"x\")", {{"i.cga", "attr h = 3"}}), ElementsAre("1:25 type"));
}

TEST(Check, RulesThatNothingReaches) {
  EXPECT_THAT(told("@StartRule\nA --> B\nB --> C.\nD --> E\nE --> NIL"),
              ElementsAre("4:1 unreachable", "5:1 unreachable"));
  EXPECT_THAT(told("A --> NIL\nB --> NIL"), IsEmpty());  // a library
  EXPECT_THAT(told("start A --> split(x){ 1 : case true == false : B else : C }\nB --> NIL\nC --> comp(f){ all = D "
                   "}\nD --> NIL"),
              testing::Not(testing::Contains(testing::HasSubstr("unreachable"))));
}

TEST(Check, RecursionWithoutCondition) {
  EXPECT_THAT(told("A --> extrude(1) A"), ElementsAre("1:1 endless"));
  EXPECT_THAT(told("A --> B\nB --> [ t(0,1,0) A ]"), ElementsAre("1:1 endless"));
  EXPECT_THAT(told("A --> case scope.sx > 1 : A else : X."), IsEmpty());
  EXPECT_THAT(told("A --> split(x){ 1 : X. | ~1 : A }"), IsEmpty());
  EXPECT_THAT(told("f(n) = f(n-1)"), ElementsAre("1:1 endless"));
  EXPECT_THAT(told("f(n) = case n > 0 : f(n-1) else : 0"), IsEmpty());
}

TEST(Check, ValuesThatTheProgramGives) {
  CheckOptions options;
  options.context = {"building.height", "building.storeys", "edge.kind"};
  EXPECT_THAT(told("A --> extrude(building.storys) X.", {}, options),
              ElementsAre("1:15 unknown_context → building.storeys"));
  EXPECT_THAT(told("A --> extrude(building.storeys) X.", {}, options), IsEmpty());
  EXPECT_THAT(told("f = storey.use\nA --> print(f) X.", {}, options), ElementsAre("1:5 unknown_context"));
  EXPECT_THAT(told("A --> building.storys X.", {}, options), ElementsAre("1:7 unknown_context → building.storeys"))
      << "the same where a rule is meant to be";
  EXPECT_THAT(told("A --> building.storeys X.", {}, options), ElementsAre("1:7 no_rule"));
  EXPECT_THAT(told("A --> building.storeys. X.", {}, options), IsEmpty());
  EXPECT_THAT(told("import building : \"b.cga\"\nA --> building.B", {{"b.cga", "B --> NIL"}}, options), IsEmpty());
  EXPECT_THAT(told("A --> extrude(building.storys) X."), IsEmpty()) << "nobody says what there is";
}

TEST(Check, Styles) {
  EXPECT_THAT(told("Lot --> X.\nstyle Green\nLot --> Y.\nstyle Blue extends Grren\nLot --> Z."),
              ElementsAre("4:1 unknown_style → Green"));
  EXPECT_THAT(told("Lot --> X.\nstyle Green extends Default\nLot --> Y.\nstyle Blue extends Green\nLot --> Z."),
              IsEmpty());
  EXPECT_THAT(told("attr h = 3\nLot --> X.\nstyle Green\nattr h = \"high\""), ElementsAre("4:6 style_type"));
  EXPECT_THAT(told("attr h = 3\nLot --> X.\nstyle A\nattr w = true\nstyle B extends A\nattr h = 4\nattr w = 1"),
              ElementsAre("7:6 style_type"));
  EXPECT_THAT(told("attr h = 3\nLot --> X.\nstyle A\nattr w = true\nstyle B\nattr w = 1\nattr h = rand(3)"), IsEmpty())
      << "styles side by side";
  EXPECT_THAT(told("Lot --> X.\nstyle Green\nstart Lot --> Y."), ElementsAre("3:7 style_section"));
  EXPECT_THAT(told("Lot --> X.\nstyle Green\n@StartRule\nLot --> Y."), ElementsAre("3:1 style_section"));
  EXPECT_THAT(told("attr h = 3\nLot --> X.\nstyle A extends B\nattr h = 1\nstyle B extends A"), IsEmpty());
}

TEST(Check, WhatDoesNotRun) {
  EXPECT_THAT(told("A --> insertAlongUV(0, \"a.obj\", 1)"), ElementsAre("1:7 not_yet"));
  EXPECT_THAT(told("A --> case getGeoCoord(lon) > 3 : X. else : Y."), ElementsAre("1:12 default_answer"));
  EXPECT_THAT(told("A --> inline B\nB --> NIL"), ElementsAre("1:7 not_yet"));
  CheckOptions quiet;
  quiet.tell_status = false;
  EXPECT_THAT(told("A --> insertAlongUV(0, \"a.obj\", 1)", {}, quiet), IsEmpty());
}

TEST(Check, OurOwnOperations) {
  CheckOptions options;
  options.extensions = {{"window", {"casement", "double_casement"}, {"head", "bars"}}, {"cornice", {}, {"height"}}};
  EXPECT_THAT(told("A --> blockrand.window(\"double_casement\", \"head\", \"arch\", \"bars\", 2)\nB --> "
                   "blockrand.cornice(\"height\", 0.4)",
                   {}, options),
              IsEmpty());
  EXPECT_THAT(told("A --> blockrand.windw(\"x\")", {}, options), ElementsAre("1:7 unknown_extension → window"));
  EXPECT_THAT(told("A --> blockrand.window(\"casment\")", {}, options), ElementsAre("1:24 unknown_kind → casement"));
  EXPECT_THAT(told("A --> blockrand.window(\"casement\", \"bar\", 2)", {}, options),
              ElementsAre("1:36 unknown_parameter → bars"));
  EXPECT_THAT(told("A --> blockrand.cornice(2, 3)", {}, options), ElementsAre("1:25 type"));
}

TEST(Check, Blocks) {
  EXPECT_THAT(told("A --> split(x)"), ElementsAre("1:7 missing_block"));
  EXPECT_THAT(told("A --> comp(f){}"), ElementsAre("1:7 empty_block"));
}

TEST(Check, DeclarationsThatHideOneAnother) {
  EXPECT_THAT(told("A --> NIL\nA --> X."), ElementsAre("2:1 duplicate"));
  EXPECT_THAT(told("A(n) --> extrude(n)\nA(s) --> texture(s)"), IsEmpty());
  EXPECT_THAT(told("A(n) --> extrude(n)\nA(m) --> extrude(m)"), ElementsAre("2:1 duplicate"));
  EXPECT_THAT(told("attr h = 1\nh --> NIL"), ElementsAre("2:1 name_clash"));
  EXPECT_THAT(told("convexify --> NIL\nA --> X."), ElementsAre("1:1 hidden_by_operation"));
  EXPECT_THAT(told("attr a = 1\nR --> NIL\nstyle Old\nattr a = 2\nR --> X."), IsEmpty());
}

TEST(Check, Annotations) {
  EXPECT_THAT(told("@Hiddden\nattr h = 1"), ElementsAre("1:1 unknown_annotation → Hidden"));
  EXPECT_THAT(told("@Consistent(\"building\")\nA --> NIL\n@Consistent(\"row\")\nB --> NIL"), IsEmpty());
  EXPECT_THAT(told("@Consistent(\"buiding\")\nA --> NIL"), ElementsAre("1:1 annotation_value → building"));
}

TEST(Check, ConstantsThatMultiplyAreBounded) {
  std::string text = "const c0 = 1\n";
  for (int i = 1; i < 30; ++i) {
    text += "const c" + std::to_string(i) + " = 0";
    for (int j = 0; j < 300; ++j) text += " + c" + std::to_string(i - 1);
    text += "\n";
  }
  EXPECT_THAT(told(text + "A --> split(x){ c29 : X. }"), IsEmpty());
}

}  // namespace
}  // namespace blockrand::grammar
