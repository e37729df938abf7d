#include "pipeline/base/template.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace blockrand::base {
namespace {

std::string_view sample(std::string_view name) {
  if (name == "page")
    return "<p title=\"{{title}}\">{{title}}</p>{{{markup}}}\n{{#rows}}\n{{> row}}\n{{/rows}}\n{{^rows}}none{{/rows}}";
  if (name == "row") return "<li>{{name}}{{#note}} ({{note}}){{/note}}</li>\n";
  if (name == "open") return "{{#rows}}";
  throw std::logic_error(std::string(name) + " is no part of the program");
}

TEST(Template, TextIsEscapedUnlessItIsMarkup) {
  Values v;
  v.set("title", "a < b & \"c\"\x01").set("markup", "<b>1 < 2</b>");
  EXPECT_EQ(
      filled(sample, "page", v),
      "<p title=\"a &lt; b &amp; &quot;c&quot;\uFFFD\">a &lt; b &amp; &quot;c&quot;\uFFFD</p><b>1 < 2</b>\n\nnone");
}

TEST(Template, EntriesOfAListEachFillTheirPiece) {
  Values v;
  v.set("title", "t").set("markup", "").set("note", "of the page");
  v.add("rows", Values().set("name", "one").set("note", ""));
  v.add("rows", Values().set("name", "<two>").set("note", "mine"));
  EXPECT_EQ(filled(sample, "page", v), "<p title=\"t\">t</p>\n<li>one</li>\n<li>&lt;two&gt; (mine)</li>\n");
}

TEST(Template, AValueIsSetOnceMoreAndAnEmptyListIsNone) {
  Values v;
  v.set("title", "old").set("title", "new").set("rows", Values::List());
  EXPECT_EQ(filled(sample, "page", v), "<p title=\"new\">new</p>\n\nnone");
}

TEST(Template, WhatCannotBeFilledIsAMistakeOfOurs) {
  EXPECT_THROW(filled(sample, "open", {}), std::logic_error);
  EXPECT_THROW(filled(sample, "nowhere", {}), std::logic_error);
}

}  // namespace
}  // namespace blockrand::base
