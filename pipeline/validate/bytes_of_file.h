// Whole files in memory, and what is compressed in them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace blockrand::validate {

/// The bytes of a regular file, or nothing where it cannot be read.
std::optional<std::string> file_bytes(const std::string& path);

/// The content of a gzip file (RFC 1952; several members are one after the other), or nothing where it is damaged,
/// truncated, or larger than 4 GB.
std::optional<std::string> gunzip(std::string_view bytes);

/// file_bytes(), decompressed where the name ends in ".gz". `why` says what went wrong.
std::optional<std::string> content_of(const std::string& path, std::string& why);

}  // namespace blockrand::validate
