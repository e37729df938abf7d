// What a file says in words about its heights. Internal to this folder.
#pragma once

#include <string>
#include <string_view>

#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

/// The part after "heights: " of a description as Blockrand writes it ("…; heights: heights above local ground; data:
/// …"); empty without one.
std::string height_words_in(std::string_view description);

/// Decides what the heights are: a vertical CRS that is stated, else what the words say, else nothing. Sets
/// `height_reference`, `height_words`, and `vertical` where the words name a code.
void decide_heights(ReferenceCrs& crs, std::string_view words);

}  // namespace blockrand::importers::reference
