// Buffer views that EXT_meshopt_compression packed.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "pipeline/validate/checked_json.h"

namespace blockrand::validate {

/// The bytes of a buffer view, unpacked.
/// \param view  the buffer view; \param extension  its EXT_meshopt_compression; \param bin  the binary chunk's buffer
/// \param why   set where nothing is returned: the rule that is broken
std::optional<std::string> unpack_view(const Json& view, const Json& extension, std::string_view bin, std::string& why);

}  // namespace blockrand::validate
