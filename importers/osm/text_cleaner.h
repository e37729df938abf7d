// Text that every output format may hold: valid UTF-8 without the characters that XML forbids.
#pragma once

#include <string>
#include <string_view>

namespace blockrand::importers::osm {

/// Whether `text` is valid UTF-8 and consists of characters of XML 1.0 (production 2, Char).
bool is_clean_text(std::string_view text);

/// `text` with every malformed sequence and every forbidden character replaced by U+FFFD. Malformed sequences are cut
/// as the Unicode standard recommends (section 3.9, substitution of maximal subparts).
std::string clean_text(std::string_view text);

}  // namespace blockrand::importers::osm
