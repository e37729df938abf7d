// Smaller variants of files that a web server hands out instead (gzip_static of nginx and its like).
#pragma once

#include <string>

#include "pipeline/outward/build_files.h"

namespace blockrand::outward {

/// A variant must save so much of a file to be worth a second one.
inline constexpr double kLeastSaving = 0.1;

/// Whether a file is of a kind that may become smaller: texts, GLB, GeoPackages; not pictures and what is packed already.
bool may_shrink(const std::string& path);

/// A file as gzip (RFC 1952): no name and no time in it, the same bytes each time. Empty where it saves less than kLeastSaving.
/// \throws base::InputError  it cannot be read, or is not the file that the record names
std::string gzip_variant(const std::string& build, const BuildFile& file);

}  // namespace blockrand::outward
