// Texts of the map as people may write them: without case, accents, and what stands for them.
#pragma once

#include <string>
#include <string_view>

namespace blockrand::base {

/// Lower case without accents, so that equal texts are those which people take for the same: "Straße", "STRASSE" and
/// "Strase" become "strase", "Müller", "Mueller" and "Muller" "muller", "İstiklâl" and "ISTIKLAL" "istiklal" (Turkish ı, i, I and
/// İ are one letter), "Жуковского" "жуковского". Latin, Cyrillic, Greek and Armenian letters; others stay as they are. Letters
/// that are written as two (ä as ae, å as aa, ß as ss) and such pairs end as the first of them: a search may find too much,
/// never too little. Apostrophes vanish, other punctuation becomes a space; '-' and '/' stay. Bytes that are no UTF-8 become
/// spaces.
std::string folded(std::string_view text);

}  // namespace blockrand::base
