// Files that lie packed beside themselves, for web servers.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "pipeline/validate/finding_log.h"

namespace blockrand::validate {

/// Of files `NAME.gz` that are listed beside `NAME`: they hold the same (GZIP_DIFFERS). \param files  those of build.json
/// \return how many there are
std::uint64_t check_packed_beside(const std::string& folder, std::span<const std::string> files, FindingLog& log);

}  // namespace blockrand::validate
