// Facade rules in XML become rule text: read, translated, and the text read again.
#include "styles/grammar/language/bilke_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "importers/facade_rules/read_facade_rules.h"
#include "pipeline/base/error.h"
#include "styles/grammar/language/check.h"
#include "styles/grammar/language/program.h"

namespace blockrand::grammar {
namespace {

using importers::facade_rules::parse_facade_rules;
using testing::HasSubstr;
using testing::IsEmpty;

/// A file around rules.
std::string file(const std::string& rules) { return "<Rulefile name=\"Test\">\n" + rules + "\n</Rulefile>\n"; }
std::string rule(const std::string& predecessor, const std::string& branches) {
  return "<Rule><Predecessor>" + predecessor + "</Predecessor><Rules>" + branches + "</Rules></Rule>";
}

ImportedRules imported(const std::string& xml) { return rule_text_of(parse_facade_rules(xml, "test.xml")); }

/// Everything that reading and checking the text tells.
std::vector<std::string> told(const std::string& text) {
  LoadOptions options;
  options.read = [&](const std::string&) { return std::optional(text); };
  const Program program = load("test.cga", options);
  std::vector<std::string> all;
  CheckOptions quiet;
  quiet.tell_status = false;
  for (const Diagnostic& d : program.diagnostics) all.push_back(format(d, program.files));
  for (const Diagnostic& d : check(program, quiet)) all.push_back(format(d, program.files));
  return all;
}

/// "3: what" of the error.
std::string error_of(const std::string& xml) {
  try {
    parse_facade_rules(xml, "test.xml");
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

/// Written for this test, in the manner of the thesis: every element and attribute of its format.
const char* const kFacade = R"(<?xml version="1.0" encoding="UTF-8"?>
<Rulefile name="FacadeStructure" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="Rules.xsd">
  <Rule><Predecessor>FrontFacade</Predecessor><Rules><Probability value="1">
    <Split axis="u"/>
    <Symbol size="1" property="GroundfloorHeight">Groundfloor</Symbol>
    <Symbol size="1r">Floors</Symbol>
    <Symbol size="1" property="TopfloorHeight">TopFloor</Symbol>
  </Probability></Rules></Rule>
  <Rule><Predecessor>Floors</Predecessor><Rules><Probability value="1">
    <Repeat axis="u" size="1" property="FloorHeight"/><Symbol>Floor</Symbol>
  </Probability></Rules></Rule>
  <Rule><Predecessor>Floor</Predecessor><Rules><Probability value="1">
    <Repeat axis="r" size="3"/><Symbol>FloorTiles</Symbol>
  </Probability></Rules></Rule>
  <Rule><Predecessor>FloorTileChoice</Predecessor><Rules><Probability value="0.5">
    <Split axis="u"/><Symbol size="0.34" scale="1 1 0.1">Cornice1.wrl</Symbol><Symbol size="1r">Window</Symbol>
  </Probability></Rules></Rule>
  <Rule><Predecessor>Groundfloor</Predecessor><Rules>
    <Probability value="0.333333"><Split axis="r"/><Symbol size="1r">Window</Symbol><Symbol size="2">Entrance1</Symbol></Probability>
    <Probability value="0.333333"><Split axis="r"/><Symbol size="2">Entrance1</Symbol><Symbol size="1r">Window</Symbol></Probability>
    <Probability value="0.333333"><Symbol>Window</Symbol></Probability>
  </Rules></Rule>
  <Rule><Predecessor>Window</Predecessor><Rules><Probability value="1">
    <Symbol>Window1.wrl</Symbol>
    <Symbol translate="0 0 -0.1" scale="0.8 0.85 1" texture="misc/glass.png" uv="0.25 1" z_scale="none">
      Glass0
      .wrl</Symbol>
  </Probability></Rules></Rule>
  <Rule><Predecessor>Entrance1</Predecessor><Rules><Probability value="1"><Symbol>Entrance1.wrl</Symbol></Probability></Rules></Rule>
  <BuildingSettings><FloorHeight>3.4</FloorHeight><TopFloorHeight>2.8</TopFloorHeight></BuildingSettings>
</Rulefile>
)";

TEST(BilkeImport, TranslatesAFacadeThatReadsWithoutAWord) {
  const ImportedRules rules = imported(kFacade);
  EXPECT_THAT(told(rules.text), IsEmpty()) << rules.text;
  EXPECT_THAT(rules.text, HasSubstr("@StartRule\nFrontFacade -->"));
  EXPECT_THAT(rules.text, HasSubstr("attr FloorHeight = 3.4\n"));
}

TEST(BilkeImport, SplitsKeepSizesSharesAndVariables) {
  EXPECT_THAT(
      imported(kFacade).text,
      HasSubstr("split(y){ GroundfloorHeight * fitting(scope.sy, GroundfloorHeight + TopFloorHeight) : Groundfloor | "
                "~1 : Floors | TopFloorHeight * fitting(scope.sy, GroundfloorHeight + TopFloorHeight) : TopFloor }"));
}

TEST(BilkeImport, RepeatsFillWithWholePieces) {
  const std::string text = imported(kFacade).text;
  EXPECT_THAT(text, HasSubstr("split(y){ ~(scope.sy / piecesIn(scope.sy, FloorHeight)) : Floor }*"));
  EXPECT_THAT(text, HasSubstr("split(x){ ~(scope.sx / piecesIn(scope.sx, 3)) : FloorTiles }*"));
}

TEST(BilkeImport, ProbabilitiesAreNormalisedAndConsistent) {
  const std::string text = imported(kFacade).text;
  EXPECT_THAT(text, HasSubstr("@Consistent(\"building\")\nGroundfloor -->\n  33.333333% : split(x){"));
  EXPECT_THAT(text, HasSubstr("  else : Window\n"));
  // A single branch of 0.5 always happens.
  EXPECT_THAT(
      text,
      HasSubstr("\nFloorTileChoice -->\n  split(y){ 0.34 * fitting(scope.sy, 0.34) : set(depthScale, depthScale * 0.1) "
                "Cornice1Piece | ~1 : Window }"));
  const ImportedRules uneven = imported(file(rule("A",
                                                  "<Probability value=\"1\"><Symbol>B</Symbol></Probability>"
                                                  "<Probability value=\"3\"><Symbol>C</Symbol></Probability>")));
  EXPECT_THAT(uneven.text, HasSubstr("  25% : B\n  else : C\n"));
  EXPECT_THAT(uneven.notes,
              testing::Contains("test.xml:2: the probabilities of 'A' sum to 4; they are divided by that"));
}

TEST(BilkeImport, PiecesAreInserted) {
  const std::string text = imported(kFacade).text;
  EXPECT_THAT(text, HasSubstr("Window1Piece [ s('0.8, '0.85, '1) center(x) t(0, 0, -0.1) set(zScale, \"none\") "
                              "texture(\"misc/glass.png\") set(uvRight, 0.25) set(uvUp, 1) Glass0Piece ]"));
  EXPECT_THAT(
      text,
      HasSubstr(
          "Glass0Piece --> s('1, '1, pieceDepth(\"Glass0.wrl\")) i(\"Glass0.wrl\") scaleUV(0, 1 / uvRight, 1 / uvUp)"));
  EXPECT_THAT(text, HasSubstr("\nEntrance1 -->\n  Entrance1Piece\n"));
}

TEST(BilkeImport, SuppliesWhatTheThesisNeverPrints) {
  const ImportedRules rules = imported(kFacade);
  EXPECT_THAT(rules.text, HasSubstr("FloorTiles -->\n  FloorTileChoice\n"));
  EXPECT_THAT(rules.text, HasSubstr("TopFloor --> NIL\n"));
  EXPECT_THAT(rules.notes,
              testing::IsSupersetOf({
                  "test.xml:7: variable 'TopFloorHeight' is also written 'TopfloorHeight'; both are taken for one",
                  "test.xml:5: variable 'GroundfloorHeight' has no value in the file; 4.2 m is used",
                  "test.xml:13: symbol 'FloorTiles' has no rule; 'FloorTileChoice' stands for it",
                  "test.xml:7: symbol 'TopFloor' has no rule: nothing is built there",
              }));
}

TEST(BilkeImport, NamesNeverClash) {
  const ImportedRules rules =
      imported(file(rule("split",
                         "<Probability value=\"1\"><Symbol>Wall+1.wrl</Symbol><Symbol>2nd-Floor</Symbol>"
                         "<Symbol>Wall_1.wrl</Symbol><Symbol>max</Symbol></Probability>")));
  EXPECT_THAT(told(rules.text), IsEmpty()) << rules.text;
  EXPECT_THAT(rules.text, HasSubstr("\nsplit_2 -->\n  Wall_1Piece Rule2nd_Floor Wall_1Piece_2 max_2\n"));
  EXPECT_THAT(rules.text, HasSubstr("i(\"Wall+1.wrl\")"));
}

TEST(BilkeImport, ErrorsAreLocated) {
  EXPECT_THAT(error_of("<a>"), HasSubstr("test.xml:1: not valid XML"));
  EXPECT_THAT(error_of("<CityData/>"), HasSubstr("test.xml:1: the outermost element must be 'Rulefile'"));
  EXPECT_THAT(error_of(file("")), HasSubstr("no rule"));
  const auto branch = [](const std::string& content) {
    return file("\n" + rule("A", "\n<Probability value=\"1\">" + content + "</Probability>"));
  };
  EXPECT_THAT(error_of(branch("<Symbl>B</Symbl>")),
              HasSubstr("test.xml:4: unknown element 'Symbl'. Did you mean 'Symbol'?"));
  EXPECT_THAT(error_of(branch("<Symbol siz=\"1\">B</Symbol>")),
              HasSubstr("test.xml:4: unknown attribute 'siz'. Did you mean 'size'?"));
  EXPECT_THAT(error_of(branch("<Symbol size=\"1m\">B</Symbol>")), HasSubstr("test.xml:4: size=\"1m\" is not a number"));
  EXPECT_THAT(error_of(branch("<Symbol scale=\"1 1\">B</Symbol>")), HasSubstr("is not 3 numbers"));
  EXPECT_THAT(error_of(branch("<Symbol z_scale=\"upp\">B</Symbol>")), HasSubstr("Did you mean 'up'?"));
  EXPECT_THAT(error_of(branch("<Split axis=\"x\"/><Symbol>B</Symbol>")), HasSubstr("test.xml:4: axis=\"x\""));
  EXPECT_THAT(error_of(branch("<Repeat axis=\"r\" size=\"0\"/><Symbol>B</Symbol>")), HasSubstr("must be above 0"));
  EXPECT_THAT(error_of(branch("<Repeat axis=\"r\" size=\"1\"/><Symbol>B</Symbol><Symbol>C</Symbol>")),
              HasSubstr("exactly one symbol follows a repeat"));
  EXPECT_THAT(error_of(branch("<Symbol>B</Symbol><Split axis=\"r\"/>")), HasSubstr("stands once, before the symbols"));
  EXPECT_THAT(error_of(branch("")), HasSubstr("no symbol"));
  EXPECT_THAT(error_of(file(rule("A", "<Probability value=\"1\"><Symbol>B</Symbol></Probability>") + "\n" +
                            rule("A", "<Probability value=\"1\"><Symbol>B</Symbol></Probability>"))),
              HasSubstr("test.xml:3: a second rule of 'A'; the first stands in line 2"));
  EXPECT_THAT(error_of("<!DOCTYPE Rulefile [<!ENTITY a \"b\">]><Rulefile>&a;</Rulefile>"),
              HasSubstr("entities are not read"));
}

}  // namespace
}  // namespace blockrand::grammar
