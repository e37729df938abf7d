#include "pipeline/base/folded_text.h"

#include <gtest/gtest.h>

namespace blockrand::base {
namespace {

TEST(FoldedText, IsTheSameForWhatPeopleTakeForTheSame) {
  const std::initializer_list<std::initializer_list<const char*>> same = {
      {"Straße", "STRASSE", "strasse", "Strase", "STRAẞE"},
      {"Müller", "Mueller", "Muller", "MÜLLER", "Mu\u0308ller"},
      {"İstiklâl", "ISTIKLAL", "istiklal", "ıstıklal"},
      {"Жуковского", "ЖУКОВСКОГО"},
      {"Королёва", "КОРОЛЕВА", "Королева"},
      {"Mánesova", "MANESOVA"},
      {"Århus", "Aarhus", "arhus"},
      {"Ærø", "aero"},
      {"Piața Unirii", "Piaţa Unirii", "PIATA UNIRII"},
      {"O’Connell", "O'Connell", "oconnell"},
      {"Αθηνάς", "ΑΘΗΝΑΣ"},
      {"Nguyễn Huệ", "nguyen hue"},
  };
  for (const auto& texts : same)
    for (const char* text : texts) EXPECT_EQ(folded(text), folded(*texts.begin())) << text;
}

TEST(FoldedText, KeepsApartWhatDiffers) {
  for (const auto& [a, b] :
       {std::pair("Weg 5", "Weg 6"), {"Ленина", "Лекина"}, {"Haus", "Hans"}, {"5a", "5b"}, {"Ořechovka", "Orechova"}})
    EXPECT_NE(folded(a), folded(b)) << a;
}

TEST(FoldedText, PunctuationAndBrokenBytesBecomeSpaces) {
  EXPECT_EQ(folded("Haupt-Str. 5–7, 12/14"), "haupt-str  5-7  12/14");
  EXPECT_EQ(folded("a\xC3"), "a ");
  EXPECT_EQ(folded("a\xFF\x80"
                   "b\t"),
            "a  b ");
  EXPECT_EQ(folded(""), "");
}

}  // namespace
}  // namespace blockrand::base
