// SHA-256 of files and bytes (OpenSSL).
#pragma once

#include <string>
#include <string_view>

namespace blockrand::base {

/// Lower-case hex digest of `bytes`.
std::string sha256(std::string_view bytes);

/// Lower-case hex digest of a file's content. \throws InputError when it cannot be read.
std::string sha256_file(const std::string& path);

}  // namespace blockrand::base
