#include "importers/reference/height_words.h"

#include "importers/reference/coordinate_text.h"
#include "importers/reference/reference_crs.h"
#include "pipeline/georef/transform.h"

namespace blockrand::importers::reference {
namespace {

bool has(std::string_view text, std::string_view piece) { return text.find(piece) != std::string_view::npos; }

/// "EPSG:7837" of "… above DHHN2016 height (EPSG:7837)"; empty without a code.
std::string code_in_brackets(std::string_view words) {
  const std::size_t open = words.rfind("(EPSG:"), close = words.rfind(')');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) return "";
  return std::string(words.substr(open + 1, close - open - 1));
}

}  // namespace

std::string height_words_in(std::string_view description) {
  constexpr std::string_view kLabel = "heights: ";
  const std::size_t at = description.find(kLabel);
  if (at == std::string_view::npos) return "";
  const std::string_view rest = description.substr(at + kLabel.size());
  return std::string(trimmed(rest.substr(0, rest.find(';'))));
}

void decide_heights(ReferenceCrs& crs, std::string_view words) {
  crs.height_words = words;
  if (!crs.vertical.empty()) {
    crs.height_reference = HeightReference::vertical_crs;
    return;
  }
  // One height for all is no terrain, whatever it is above.
  if (has(words, "local ground") || has(words, "one ground height")) {
    crs.height_reference = HeightReference::above_local_ground;
  } else if (has(words, "ellipsoid") && !has(words, "taken for ellipsoidal")) {
    crs.height_reference = HeightReference::ellipsoidal;
  } else if (const std::string code = code_in_brackets(words); !code.empty()) {
    crs.vertical = code;
    crs.height_reference = HeightReference::vertical_crs;
  } else if (has(words, "sea level")) {
    crs.height_reference = HeightReference::sea_level;
  } else if (!crs.stated.empty() && !crs.from_options &&
             georef::vertical_crs_of(parse_srs_name(crs.stated).horizontal).ellipsoidal) {
    crs.height_reference = HeightReference::ellipsoidal;
  }
}

}  // namespace blockrand::importers::reference
