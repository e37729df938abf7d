// The table of names: complete against the counted features, signatures readable, suggestions near.
#include "styles/grammar/language/known_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace blockrand::grammar {
namespace {

TEST(Names, FindsWhatFilesUseMost) {
  for (const char* name : {"s", "split", "t", "setupProjection", "projectUV", "texture", "extrude", "NIL", "comp",
                           "color", "set", "alignScopeToGeometry", "i", "center", "roofHip", "offset", "setupUV"})
    EXPECT_NE(find_built_in(NameKind::operation, name), nullptr) << name;
  for (const char* name :
       {"rand", "geometry.area", "fileRandom", "rint", "p", "listItem", "getRange", "atan2", "clamp"})
    EXPECT_NE(find_built_in(NameKind::function, name), nullptr) << name;
  EXPECT_NE(find_built_in(NameKind::attribute, "scope.sx"), nullptr);
  EXPECT_NE(find_built_in(NameKind::attribute, "material.colormap.su"), nullptr);
  EXPECT_NE(find_built_in(NameKind::selector, "street.front"), nullptr);
  EXPECT_NE(find_built_in(NameKind::word, "world.up.flatTop"), nullptr);
  EXPECT_EQ(find_built_in(NameKind::operation, "exturde"), nullptr);
}

TEST(Names, HoldAtLeastTheCountedFeatures) {
  const auto counted = std::count_if(built_ins().begin(), built_ins().end(), [](const BuiltIn& b) {
    return b.kind != NameKind::annotation && b.kind != NameKind::keyword && b.kind != NameKind::word;
  });
  EXPECT_GE(counted, 246);
}

TEST(Names, AreDistinctAndNumberedByPlace) {
  for (std::uint32_t i = 0; i < built_ins().size(); ++i) {
    const BuiltIn& entry = built_ins()[i];
    EXPECT_EQ(find_built_in(entry.kind, entry.name), &entry) << entry.name;
    EXPECT_EQ(built_in_number(entry), i);
  }
}

TEST(Names, SignaturesAreReadable) {
  const std::string types = "nbsNBSvVareiw";
  for (const BuiltIn& entry : built_ins()) {
    for (const Signature& s : signatures(entry)) {
      EXPECT_LE(s.least, s.most) << entry.name;
      const bool has_value = entry.kind == NameKind::function || entry.kind == NameKind::attribute;
      EXPECT_EQ(s.result != 0, has_value) << entry.name;
      for (const Signature::Item& item : s.items) {
        EXPECT_NE(types.find(item.type), std::string::npos) << entry.name << " " << entry.signature;
        EXPECT_FALSE(item.type == 'w' && item.words.empty()) << entry.name << " " << entry.signature;
      }
    }
  }
}

TEST(Names, ExtrudeTakesAHeightOrADirectionAndAHeight) {
  const auto all = signatures(*find_built_in(NameKind::operation, "extrude"));
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].least, 1U);
  EXPECT_EQ(all[0].most, 1U);
  EXPECT_EQ(all[1].most, 2U);
  EXPECT_THAT(all[1].items[0].words, testing::Contains(std::string_view("world.up")));
  const auto random = signatures(*find_built_in(NameKind::function, "rand"));
  ASSERT_EQ(random.size(), 3U);
  EXPECT_EQ(random[0].most, 0U);
  EXPECT_EQ(random[2].least, 2U);
}

TEST(Names, BlocksBelongToOperations) {
  EXPECT_EQ(find_built_in(NameKind::operation, "split")->block, BlockKind::split);
  EXPECT_EQ(find_built_in(NameKind::operation, "comp")->block, BlockKind::selectors);
  EXPECT_EQ(find_built_in(NameKind::operation, "scatter")->block, BlockKind::scatter);
  EXPECT_EQ(find_built_in(NameKind::operation, "union")->block, BlockKind::boolean);
  EXPECT_EQ(find_built_in(NameKind::operation, "extrude")->block, BlockKind::none);
}

TEST(Names, SuggestsTheNearest) {
  EXPECT_EQ(nearest_built_in(NameKind::operation, "exturde"), "extrude");
  EXPECT_EQ(nearest_built_in(NameKind::operation, "alighScopeToAxes"), "alignScopeToAxes");
  EXPECT_EQ(nearest_built_in(NameKind::attribute, "scope.Sx"), "scope.sx");
  EXPECT_EQ(nearest_built_in(NameKind::operation, "Facade"), "");
}

TEST(Names, ReservesPrefixes) {
  EXPECT_TRUE(is_reserved_prefix("scope"));
  EXPECT_TRUE(is_reserved_prefix("blockrand"));
  EXPECT_FALSE(is_reserved_prefix("Tree"));
}

TEST(Diagnostics, ReadLikeACompilers) {
  const SourceFile files[] = {{"roof.cga", ""}};
  const Diagnostic d{Severity::warning, "unknown_operation", {0, 12, 5}, "no such operation", "exturde", "extrude"};
  EXPECT_EQ(format(d, files),
            "roof.cga:12:5: warning: no such operation 'exturde'; did you mean 'extrude'? [unknown_operation]");
  EXPECT_FALSE(has_errors(std::span(&d, 1)));
}

}  // namespace
}  // namespace blockrand::grammar
