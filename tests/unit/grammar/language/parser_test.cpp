// The parser: every form of the language, every decision of docs/rule_language.md §1.3, and what it says about
// mistakes.
#include "styles/grammar/language/parser.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/grammar/language/tree_text.h"

namespace blockrand::grammar {
namespace {

struct Read {
  Unit unit;
  std::vector<Diagnostic> diagnostics;
};

Read read(std::string_view text) {
  Read r;
  r.unit = parse(text, 0, r.diagnostics);
  return r;
}

/// The tree of a text without anything to tell.
std::string tree(std::string_view text) {
  const Read r = read(text);
  for (const Diagnostic& d : r.diagnostics) ADD_FAILURE() << format(d, {});
  return test::tree_text(r.unit);
}

/// "line:column code" of the only thing told.
std::string told(std::string_view text) {
  const Read r = read(text);
  if (r.diagnostics.size() != 1) {
    std::string all = std::to_string(r.diagnostics.size()) + " told";
    for (const Diagnostic& d : r.diagnostics) all += "\n" + format(d, {});
    return all;
  }
  const Diagnostic& d = r.diagnostics[0];
  return std::to_string(d.location.line) + ":" + std::to_string(d.location.column) + " " + d.code;
}

TEST(Parser, ReadsTheDeclarations) {
  EXPECT_EQ(tree("version \"2021.0\" attr h = 10 const c = \"x\" f(a,b) = a + b Lot(x) --> extrude(h) Mass(x)"),
            "attr h = 10; const c = \"x\"; f(a,b) = (a + b); Lot(x) --> extrude(h) Mass(x)");
  EXPECT_EQ(read("version \"2021.0\"").unit.version, "2021.0");
  EXPECT_EQ(read("").unit.version, "2009.1");
  EXPECT_EQ(tree("start Lot --> A extension B --> C"), "start Lot --> A; extension B --> C");
  EXPECT_EQ(tree("Lot --> A\nimp.Roof(h) --> B"), "Lot --> A; imp.Roof(h) --> B");
  EXPECT_EQ(tree("Empty -->\nB --> NIL"), "Empty --> ; B --> NIL");
}

TEST(Parser, ReadsBindings) {
  EXPECT_EQ(tree("R(a) with ( x := a * 2 y := x + 1, z := 3 ) --> A(x,y) f with (q := 1) = q"),
            "R(a) with x := (a * 2) with y := (x + 1) with z := 3 --> A(x, y); f with q := 1 = q");
}

TEST(Parser, FindsTheNextDeclarationWithoutSeparators) {
  EXPECT_EQ(tree("A --> B\nC(x) --> D\nf(x) = x == 2\nE --> F"), "A --> B; C(x) --> D; f(x) = (x == 2); E --> F");
  EXPECT_EQ(tree("attr a = b\nconst c = a\nX = 3"), "attr a = b; const c = a; X = 3");
  EXPECT_EQ(tree("A --> B @Range(0,1) attr x = 1"), "A --> B; attr x = 1");
}

TEST(Parser, WordsOfTheLanguageMayBeNames) {
  EXPECT_EQ(tree("attr style = 1\nstart --> style\nattr start = 2\nf = style + start"),
            "attr style = 1; start --> style; attr start = 2; f = (style + start)");
  EXPECT_EQ(tree("A --> start\nB --> inline"), "A --> start; B --> inline");
}

TEST(Parser, Precedence) {
  EXPECT_EQ(tree("f = a || b && c == d < e + g * -h % 2"), "f = (a || (b && (c == (d < (e + ((g * (-h)) % 2))))))");
  EXPECT_EQ(tree("f = a - b - c"), "f = ((a - b) - c)");
  EXPECT_EQ(tree("f = !a && !(b || c)"), "f = ((!a) && (!(b || c)))");
  EXPECT_EQ(tree("f = a .+ b .* c .== d"), "f = ((a .+ (b .* c)) .== d)");
}

TEST(Parser, CaseAndChancesInExpressions) {
  EXPECT_EQ(tree("f = case a > 1 : 2 case b : 3 else : 4"), "f = {case (a > 1): 2 case b: 3 else: 4}");
  EXPECT_EQ(tree("f = 30% : \"a\" 20% : \"b\" else : \"c\""), "f = {30%: \"a\" 20%: \"b\" else: \"c\"}");
  EXPECT_EQ(tree("f = 10 * a % : 1 else : x % 3"), "f = {(10 * a)%: 1 else: (x % 3)}");
  EXPECT_EQ(tree("f = case a : case b : 1 else : 2 else : 3"), "f = {case a: {case b: 1 else: 2} else: 3}");
}

TEST(Parser, Arrays) {
  EXPECT_EQ(tree("f = [1,2;3,4][1,0]"), "f = [1, 2; 3, 4][1, 0]");
  EXPECT_EQ(tree("f = [1:2:5]"), "f = [1:2:5]");
  EXPECT_EQ(tree("f = a[0:2]"), "f = a[0:2]");
  EXPECT_EQ(tree("f = []"), "f = []");
  EXPECT_EQ(tree("f = comp(fe){ front : 1 | all = 2 }"), "f = comp(fe){front : 1 | all = 2}");
}

TEST(Parser, MarksBelongToWholeArguments) {
  EXPECT_EQ(tree("A --> s('1/3, ~rand(1,2), '-0.5)"), "A --> s('(1 / 3), ~rand(1, 2), '(-0.5))");
}

TEST(Parser, Steps) {
  EXPECT_EQ(tree("A --> t(0,1,0) [ B. ] House.(2) C(x)"), "A --> t(0, 1, 0) [B.] House.(2) C(x)");
  EXPECT_EQ(tree("A --> a[ t(1,0,0) B ]"), "A --> a [t(1, 0, 0) B]");
  EXPECT_EQ(tree("A --> inline B inline(unify) { C D } inline { E }"), "A --> inline B inline(unify) {C D} inline {E}");
}

TEST(Parser, CaseAndChancesInRules) {
  EXPECT_EQ(tree("A --> case x == 1 : B C case y : D else : E"), "A --> {case (x == 1): B C case y: D else: E}");
  EXPECT_EQ(tree("A --> 25% : B 25 % : C else : NIL D --> E"), "A --> {25%: B 25%: C else: NIL}; D --> E");
  EXPECT_EQ(tree("A --> p % : B else : C"), "A --> {p%: B else: C}");
  EXPECT_EQ(tree("A --> case x : case y : B else : C else : D"), "A --> {case x: {case y: B else: C} else: D}");
  EXPECT_EQ(tree("A --> case x : 50% : B else : C else : D"), "A --> {case x: {50%: B else: C} else: D}");
}

TEST(Parser, Splits) {
  EXPECT_EQ(tree("A --> split(x){ 1 : B | ~2*a : C D | '0.5 : NIL }*"),
            "A --> split(x){1 : B | ~(2 * a) : C D | '0.5 : NIL}*");
  EXPECT_EQ(tree("A --> split(x, noAdjust){ {~1 : B | 2 : C}* | ~1 : B | { 1 : D } }"),
            "A --> split(x, noAdjust){{~1 : B | 2 : C}* | ~1 : B | {1 : D}}");
  EXPECT_EQ(tree("A --> split(y){ case a : 1 else : 2 : B | 1 : case c : D else : E }"),
            "A --> split(y){{case a: 1 else: 2} : B | 1 : {case c: D else: E}}");
  EXPECT_EQ(tree("A --> split(x){ 1 : s('1,2,3) split(y){ ~1 : B }* C | 2 : D }"),
            "A --> split(x){1 : s('1, 2, 3) split(y){~1 : B}* C | 2 : D}");
}

TEST(Parser, ComponentBlocks) {
  EXPECT_EQ(tree("A --> comp(f){ front : B | side = C | 5 : D | i+1 : E | all =: F }"),
            "A --> comp(f){front : B | side = C | 5 : D | (i + 1) : E | all =: F}");
  EXPECT_EQ(tree("A --> comp(f){ isTagged(\"a\") && front : B }"), "A --> comp(f){(isTagged(\"a\") && front) : B}");
  EXPECT_EQ(tree("A --> setback(3){ street.front : B | remainder : C }"),
            "A --> setback(3){street.front : B | remainder : C}");
}

TEST(Parser, OtherBlocks) {
  EXPECT_EQ(tree("A --> splitAndSetbackPerimeter(0){ 1 : 2 : B | ~3 : 4 : C }*{ remainder : D }"),
            "A --> splitAndSetbackPerimeter(0){1 : 2 : B | ~3 : 4 : C}*{remainder : D}");
  EXPECT_EQ(tree("A --> scatter(surface, 10, uniform){ B C }"), "A --> scatter(surface, 10, uniform){B C}");
  EXPECT_EQ(tree("A --> union{ B | C D }"), "A --> union{B | C D}");
}

TEST(Parser, Imports) {
  const Read r = read(
      "import a : \"a.cga\" import b(Modern, Old) : \"b.cga\" ( h, w = 2*x, R(q) --> A B, S --> C )\n"
      "import c : \"c.cga\" ()");
  EXPECT_TRUE(r.diagnostics.empty());
  ASSERT_EQ(r.unit.imports.size(), 3U);
  EXPECT_FALSE(r.unit.imports[0].parentheses);
  EXPECT_EQ(r.unit.imports[1].styles.count, 2U);
  ASSERT_EQ(r.unit.imports[1].overrides.count, 4U);
  EXPECT_EQ(r.unit.overrides[0].kind, OverrideKind::protect);
  EXPECT_EQ(r.unit.overrides[1].kind, OverrideKind::attribute);
  EXPECT_EQ(r.unit.overrides[2].kind, OverrideKind::rule);
  EXPECT_EQ(r.unit.declarations[r.unit.overrides[2].declaration].parameters.count, 1U);
  EXPECT_TRUE(r.unit.imports[2].parentheses);
  EXPECT_EQ(r.unit.imports[2].overrides.count, 0U);
}

TEST(Parser, DynamicImports) {
  EXPECT_EQ(tree("A --> imp( h = 40, R --> X ).Lot(3) B"), "A --> imp(h = 40, R --> X).Lot(3) B");
  EXPECT_EQ(tree("A --> imp().Lot imp.Lot"), "A --> imp().Lot imp.Lot");
}

TEST(Parser, Styles) {
  const Read r = read("attr a = 1 \nstyle Old extends Base attr a = 2\nstyle Base attr a = 3\nstyle Old A --> B");
  ASSERT_EQ(r.unit.styles.size(), 3U);
  EXPECT_EQ(r.unit.declarations[0].style, 0U);
  EXPECT_EQ(r.unit.declarations[1].style, 1U);
  EXPECT_EQ(r.unit.declarations[2].style, 2U);
  EXPECT_EQ(r.unit.declarations[3].style, 1U);
}

TEST(Parser, AnnotationsStayWithWhatFollows) {
  const Read r = read(
      "@Group(\"Size\", 1) @Range(min=0, max=(1+2))\nattr h = 1\n@StartRule\nLot --> A\n@Hidden import x : \"x.cga\"");
  EXPECT_TRUE(r.diagnostics.empty());
  ASSERT_EQ(r.unit.annotations.size(), 4U);
  EXPECT_EQ(r.unit.annotations[1].arguments, "min=0, max=(1+2)");
  EXPECT_EQ(r.unit.declarations[0].annotations.count, 2U);
  EXPECT_EQ(r.unit.annotations[r.unit.declarations[1].annotations.first].name, "StartRule");
  EXPECT_EQ(r.unit.imports[0].annotations.count, 1U);
}

TEST(Parser, LegacyFormsAreReadWithAWarning) {
  Read r = read("import a : \"a.cga\" b : \"b.cga\"\nA --> B");
  EXPECT_EQ(r.unit.imports.size(), 2U);
  ASSERT_EQ(r.diagnostics.size(), 1U);
  EXPECT_EQ(r.diagnostics[0].code, "legacy_import");
  r = read("A --> split(x){ B }");
  EXPECT_EQ(test::tree_text(r.unit), "A --> split(x){~1 : B}");
  ASSERT_EQ(r.diagnostics.size(), 1U);
  EXPECT_EQ(r.diagnostics[0].code, "item_without_size");
  EXPECT_EQ(r.diagnostics[0].severity, Severity::warning);
}

TEST(Parser, NodesKnowTheirPlaces) {
  const Read r = read("attr h = 1\n\nLot -->\n  extrude(h + 2)");
  EXPECT_EQ(r.unit.declarations[1].location, (Location{0, 3, 1}));
  EXPECT_EQ(r.unit.calls[0].location, (Location{0, 4, 3}));
  EXPECT_EQ(r.unit.expressions.back().location, (Location{0, 4, 13}));
}

TEST(Parser, TellsWhatIsMissing) {
  EXPECT_EQ(told("A --> case x : B"), "1:7 missing_else");
  EXPECT_EQ(told("f = 20% : 1"), "1:5 missing_else");
  EXPECT_EQ(told("A --> t(0,1\nB --> C"), "2:1 syntax");
  EXPECT_EQ(told("A --> split(x){ 1 : B\nC --> D"), "1:15 unclosed");
  EXPECT_EQ(told("A --> split(x){ 1 : B\nattr c = 1"), "1:15 unclosed");
  EXPECT_EQ(told("attr a =\nB --> C"), "2:1 syntax");
  EXPECT_EQ(told("attr a 5\nB --> C"), "1:8 syntax");
  EXPECT_EQ(told("import file\nB --> C"), "2:1 syntax");
  EXPECT_EQ(told("import f : other.cga\nB --> C"), "1:12 syntax");
  EXPECT_EQ(told("A --> B }\nC --> D"), "1:9 unopened");
  EXPECT_EQ(told("A --> comp(f){ front B }"), "1:22 syntax");
}

TEST(Parser, TellsWhatStandsInTheWrongPlace) {
  EXPECT_EQ(told("A --> s(1,1,1) case x : B else : C\nD --> E"), "1:16 operation_before_choice");
  EXPECT_EQ(told("A --> B else : C"), "1:9 syntax");
  EXPECT_EQ(told("f = 1 + '2"), "1:9 syntax");
  EXPECT_EQ(told("A. --> B"), "1:1 terminal_rule");
  EXPECT_EQ(told("A --> split(x){ 50% : B }"), "1:19 syntax");
  EXPECT_EQ(told("A --> comp(f){ all : B }*"), "1:25 unexpected_repeat");
  EXPECT_EQ(told("A --> extrude(3){ 1 : B } C"), "1:7 unexpected_block");
}

TEST(Parser, SuggestsWhatWasMeant) {
  const Read arrow = read("A -- > B\nC --> D");
  ASSERT_EQ(arrow.diagnostics.size(), 1U);
  EXPECT_EQ(arrow.diagnostics[0].suggestion, "-->");
  EXPECT_EQ(test::tree_text(arrow.unit), "C --> D");
  const Read spilt = read("A --> spilt(x){ 1 : B } C");
  ASSERT_EQ(spilt.diagnostics.size(), 1U);
  EXPECT_EQ(spilt.diagnostics[0].code, "unknown_operation");
  EXPECT_EQ(spilt.diagnostics[0].suggestion, "split");
  EXPECT_EQ(test::tree_text(spilt.unit), "A --> spilt(x) C");
}

TEST(Parser, GoesOnAtTheNextDeclaration) {
  const Read r = read("A --> B )\nattr h = = 3\nf(x) = x + \nC --> comp(f){ top = D\nE --> F\n??\nG --> H");
  EXPECT_EQ(r.diagnostics.size(), 5U);
  EXPECT_EQ(test::tree_text(r.unit), "broken A; broken attr h; broken f; broken C; E --> F; G --> H");
}

TEST(Parser, NestingHasALimitThatIsTold) {
  for (const std::string& open :
       {std::string("("), std::string("["), std::string("-"), std::string("f("), std::string("case a : ")}) {
    std::string text = "f = ";
    for (int i = 0; i < 100000; ++i) text += open;
    const Read r = read(text + "1\nA --> B");
    EXPECT_EQ(r.diagnostics.front().code, "too_deep") << open;
    EXPECT_EQ(r.unit.declarations.back().successor != kNone, true);
  }
  std::string blocks = "A --> ";
  for (int i = 0; i < 100000; ++i) blocks += i % 2 == 0 ? "split(x){ 1 : " : "[ ";
  EXPECT_EQ(read(blocks).diagnostics.front().code, "too_deep");
  std::string sum = "f = 1";
  for (int i = 0; i < 5000; ++i) sum += "+1";
  EXPECT_EQ(told(sum), "1:" + std::to_string(4 + 2 * kMaximumHeight + 2) + " too_deep");
}

}  // namespace
}  // namespace blockrand::grammar
