// Buffer views that EXT_meshopt_compression packed. Internal to this folder.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "importers/reference/json_access.h"

namespace blockrand::importers::reference {

/// \param packed  the extension of the buffer view; \param buffers  the file's
/// \param why  set where nothing comes back: the bytes are not there, or packed in a way that is not known
/// \return the bytes of the view
std::optional<std::string> unpacked_view(const Json& packed, std::span<const std::string> buffers, std::string& why);

}  // namespace blockrand::importers::reference
