// Facade rules of Bilke's CityGenerator (2009) as text of the rule language (docs/sources.md, Bilke 3.6 to 3.7, 4.7 to
// §4.9, §9).
#pragma once

#include <string>
#include <vector>

#include "pipeline/model/facade_rules.h"

namespace blockrand::grammar {

struct ImportedRules {
  std::string text;                ///< of a .cga file that the parser reads without a word
  std::vector<std::string> notes;  ///< what had to be decided or added: "file:12: …"
};

/// Start shapes are facade faces: x along the wall, y up, z out of it; so r becomes x, u becomes y.
/// * Split: sizes in metres, times their variable, shrunk together where they do not fit (D4); shares become floating
/// sizes.
/// * Repeat: as many pieces as fit whole, at least one, all alike (§4.8, D5).
/// * Substitution: all symbols in the same scope.
/// * Probabilities are divided by their sum (D11). A rule that chooses is annotated @Consistent("building"): it takes
/// the
///   same branch everywhere in one building (§4.7). The annotation knows another value, "row": the same in a row of
///   houses.
/// * scale and translate move a piece about its bottom middle; depth (z_scale, the third number of scale) and uv are
///   inherited by what is derived, so they travel as attributes.
/// * "Name.wrl" becomes the rule NamePiece that inserts the asset. Symbols without rule have no geometry: `Name -->
/// NIL`.
/// * Variables become attributes: the file's own values, else the thesis' defaults, else ours (each told); upper and
/// lower
///   case are the same (D9). The rules that the thesis uses and never prints are added where they are known (§5.9, D8).
/// * Symbols that no rule produces are start rules.
ImportedRules rule_text_of(const model::FacadeRules& rules);

}  // namespace blockrand::grammar
