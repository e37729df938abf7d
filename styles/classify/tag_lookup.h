// How classification asks for the tags of an object without knowing how they are stored.
#pragma once

#include <functional>
#include <string_view>

namespace blockrand::classify {

/// The value of a key of the object's tags, empty where it has none. The text must live as long as the object.
using TagLookup = std::function<std::string_view(std::string_view key)>;

}  // namespace blockrand::classify
