// Where a writer puts its bytes.
#pragma once

#include <functional>
#include <string_view>

namespace blockrand::outputs {

/// Takes the next bytes of a file. May throw; writers let the exception through.
using Sink = std::function<void(std::string_view)>;

}  // namespace blockrand::outputs
