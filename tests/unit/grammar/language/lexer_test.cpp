// Tokens: encodings, comments, numbers, names with dots.
#include "styles/grammar/language/lexer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace blockrand::grammar {
namespace {

using K = TokenKind;

struct Read {
  std::vector<Token> tokens;
  std::vector<Diagnostic> diagnostics;
  std::vector<std::string> slices;
};

Read read(std::string_view text) {
  Read r;
  r.tokens = tokens_of(text, 0, r.diagnostics);
  for (const Token& t : r.tokens) r.slices.emplace_back(text.substr(t.offset, t.length));
  r.slices.pop_back();
  return r;
}

TEST(Lexer, NamesHoldTheirParts) {
  EXPECT_THAT(read("scope.sx material.color.r $a_1").slices,
              testing::ElementsAre("scope.sx", "material.color.r", "$a_1"));
}

TEST(Lexer, ADotAfterANameMakesATerminal) {
  const Read r = read("House. Wall.(2) A.}* X.// comment");
  EXPECT_TRUE(r.tokens[0].trailing_dot);
  EXPECT_TRUE(r.tokens[1].trailing_dot);
  EXPECT_EQ(r.tokens[5].kind, K::name);
  EXPECT_TRUE(r.tokens[5].trailing_dot);
  EXPECT_EQ(r.tokens[7].kind, K::times);
  EXPECT_TRUE(r.tokens[8].trailing_dot);
  EXPECT_TRUE(r.diagnostics.empty());
}

TEST(Lexer, ElementWiseOperatorsAreNoTerminals) {
  const Read r = read("a.+b c .== d 1.==1");
  EXPECT_FALSE(r.tokens[0].trailing_dot);
  EXPECT_EQ(r.tokens[1].kind, K::each_plus);
  EXPECT_EQ(r.tokens[4].kind, K::each_equal);
  EXPECT_EQ(r.slices[6], "1");
  EXPECT_EQ(r.tokens[7].kind, K::each_equal);
}

TEST(Lexer, NumbersInAllSpellings) {
  EXPECT_THAT(read("12 1.5 .5 1. 001 2e3 2.5E-2 1e").slices,
              testing::ElementsAre("12", "1.5", ".5", "1.", "001", "2e3", "2.5E-2", "1", "e"));
}

TEST(Lexer, CommentsOfAllKinds) {
  EXPECT_THAT(read("a // b\n# c\n/* d\n e */ f \"#ff0000 // no\" g").slices,
              testing::ElementsAre("a", "f", "\"#ff0000 // no\"", "g"));
}

TEST(Lexer, TextsResolveEscapesAndMaySpanLines) {
  EXPECT_EQ(text_value("\"a\\n\\\"b\\\" c:\\dir\\\\x\""), "a\n\"b\" c:\\dir\\x");
  const Read r = read("\"one\ntwo\" x");
  ASSERT_EQ(r.slices.size(), 2U);
  EXPECT_EQ(r.tokens[1].line, 2U);
}

TEST(Lexer, PlacesCountCharacters) {
  const Read r = read("a\r\n  \"\u00e4\u00f6\u00fc\" b\rc");
  EXPECT_EQ(r.tokens[1].line, 2U);
  EXPECT_EQ(r.tokens[1].column, 3U);
  EXPECT_EQ(r.tokens[2].column, 9U);
  EXPECT_EQ(r.tokens[3].line, 3U);
  EXPECT_TRUE(r.tokens[3].line_start);
}

TEST(Lexer, ReadsEncodings) {
  EXPECT_EQ(to_utf8("\xef\xbb\xbf"
                    "attr"),
            "attr");
  EXPECT_EQ(to_utf8("gr\xfcn"), "gr\u00fcn");
  EXPECT_EQ(to_utf8("gr\u00fcn"), "gr\u00fcn");
  EXPECT_EQ(to_utf8("\x92"
                    "1"),
            "\u2019"
            "1");
  EXPECT_EQ(to_utf8("\xe2\x82"), "\u00e2\u0082");
}

TEST(Lexer, TypographicQuotesAreReadAsRelative) {
  const Read r = read("s(\u20191,2)");
  EXPECT_EQ(r.tokens[2].kind, K::relative);
  ASSERT_EQ(r.diagnostics.size(), 1U);
  EXPECT_EQ(r.diagnostics[0].severity, Severity::warning);
  EXPECT_EQ(r.diagnostics[0].location.column, 3U);
}

TEST(Lexer, TellsWhatIsNeverClosed) {
  EXPECT_EQ(read("a /* b").diagnostics.at(0).code, "unclosed_comment");
  const Read text = read("a \"b\nc d");
  EXPECT_EQ(text.diagnostics.at(0).code, "unclosed_text");
  EXPECT_THAT(text.slices, testing::ElementsAre("a", "\"b", "c", "d"));
}

TEST(Lexer, BracketsKnowTheirPartners) {
  const Read r = read("( [ ) ] { }");
  EXPECT_EQ(r.tokens[0].partner, 2U);
  EXPECT_EQ(r.tokens[1].partner, 0xffffffffU);
  EXPECT_EQ(r.tokens[3].partner, 0xffffffffU);
  EXPECT_EQ(r.tokens[4].partner, 5U);
}

TEST(Lexer, DigitsAfterDotsAreToldOnce) {
  const Read r = read("Tile.1 Tile.2");
  EXPECT_THAT(r.slices, testing::ElementsAre("Tile.1", "Tile.2"));
  EXPECT_EQ(r.diagnostics.size(), 1U);
}

}  // namespace
}  // namespace blockrand::grammar
