#include "importers/osm/text_cleaner.h"

#include <gtest/gtest.h>

namespace blockrand::importers::osm {
namespace {

using namespace std::string_literals;
constexpr const char* kBad = "\xEF\xBF\xBD";

TEST(CleanText, LeavesGoodTextAlone) {
  for (const std::string& text : {""s, "Straße"s, "東京\t\r\n"s, "\xF0\x9F\x8F\xA0"s, "\xEF\xBF\xBD"s, "\x7F"s}) {
    EXPECT_TRUE(is_clean_text(text)) << text;
    EXPECT_EQ(clean_text(text), text);
  }
}

TEST(CleanText, ReplacesWhatXmlForbids) {
  EXPECT_EQ(clean_text("a\0b"s), "a"s + kBad + "b");
  EXPECT_EQ(clean_text("\x01\x1F"s), std::string(kBad) + kBad);
  EXPECT_EQ(clean_text("\xEF\xBF\xBE"s), kBad);  // U+FFFE
  EXPECT_FALSE(is_clean_text("a\0b"s));
}

TEST(CleanText, ReplacesMalformedUtf8BySubparts) {
  EXPECT_EQ(clean_text("Stra\xDF"s
                       "e"),
            "Stra"s + kBad + "e");                                                     // Latin-1
  EXPECT_EQ(clean_text("\xE2\x82"s), kBad);                                            // cut off
  EXPECT_EQ(clean_text("\xC0\x80"s), std::string(kBad) + kBad);                        // overlong NUL
  EXPECT_EQ(clean_text("\xED\xA0\x80"s), std::string(kBad) + kBad + kBad);             // surrogate
  EXPECT_EQ(clean_text("\xF4\x90\x80\x80"s), std::string(kBad) + kBad + kBad + kBad);  // beyond U+10FFFF
  EXPECT_TRUE(is_clean_text(clean_text("\xFF\xFE\x80 x"s)));
}

}  // namespace
}  // namespace blockrand::importers::osm
