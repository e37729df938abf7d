// The program's version, set by the build.
#pragma once

#include <string_view>

#ifndef BLOCKRAND_VERSION
#define BLOCKRAND_VERSION "0.0.0-unconfigured"
#endif

namespace blockrand::base {

inline constexpr std::string_view kVersion = BLOCKRAND_VERSION;

}  // namespace blockrand::base
