// Options from a TOML file: the same keys in sections [build], [repair] and [generate].
#pragma once

#include <string>

#include "pipeline/settings/options.h"

namespace blockrand::settings {

/// Sets what the file says; everything else stays as it is. Relative paths in the file start at the file's folder.
/// \throws base::InputError with file, line, column, the key and the nearest known key
/// \param commands  whose tables the file may have; bits
void read_config(const std::string& path, Settings& settings, unsigned commands = kBuild);

/// A config file with every key, its meaning and its default, all commented out.
/// \param commands  as read_config() has them
std::string config_template(unsigned commands = kBuild);

}  // namespace blockrand::settings
