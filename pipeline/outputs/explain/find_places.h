// Finds buildings of a build by address or name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipeline/outputs/explain/places.h"

namespace blockrand::outputs {

struct FoundPlaces {
  std::vector<Place> places;         ///< all that answer equally well, by area and id
  bool exact = true;                 ///< false: with a number beside the one that was asked for ("5" for "5a", "3-7")
  std::vector<std::string> nearest;  ///< what may have been meant, where `places` is empty
};

/// Buildings that `text` names: an address in either order, with or without postcode and town ("Arkonaplatz 5",
/// "5 arkonapl., Berlin"), a street, or a name ("Zionskirche"). Case, accents and short forms of "street" do not count
/// (place_words.h). The best kind of answer alone: the whole address or name; a number beside it; words of it. Buildings
/// without a body only where no other answers.
/// \param folder  the output folder of a build; one in areas is looked through area by area
/// \throws base::UsageError  `folder` is no build, or was built without explanations
/// \throws base::InputError  a file is missing, because an older program made the build, or damaged
FoundPlaces find_places(const std::string& folder, std::string_view text);

}  // namespace blockrand::outputs
