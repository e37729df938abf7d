// Where the configs lie that came with the program.
#pragma once

#include <filesystem>
#include <string>

namespace blockrand::cli {

/// The folder with defaults/ and materials/.
///
/// `given` (option --configs) if it is not empty. Else it is found from the program's own place, so that a moved prefix
/// or an unpacked archive works and no path of the machine that built it is ever tried: `configs` beside the program
/// (in a build tree a link to the source tree), then share/blockrand/configs below the prefix whose bin holds it.
/// \param program  file of the running program, links resolved
/// \throws base::UsageError when the folder given or found holds no configs
std::string configs_folder(const std::string& given, const std::filesystem::path& program);

/// File of the running program, links resolved; empty where the system does not say.
std::filesystem::path program_file();

}  // namespace blockrand::cli
