// Named mouldings: text files under configs/profiles.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "styles/elements/profile.h"

namespace blockrand::elements {

struct ProfilePreset {
  std::string meaning;
  double least = 0, typical = 0, most = 0;  ///< m, heights in which it is used
  ProfileProgram program;
};

/// By name: the file's name without its ending.
using ProfileLibrary = std::map<std::string, ProfilePreset, std::less<>>;

/// Adds one preset from the text of a file; a name that is there already is replaced.
/// \throws base::InputError  with file, line, column: unknown keys, programs that do not parse or draw no section
void parse_profile_preset(std::string_view text, const std::string& file, const std::string& name,
                          ProfileLibrary& library);

}  // namespace blockrand::elements
