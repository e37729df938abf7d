// Deterministic ZIP archive.
#pragma once

#include <string>
#include <string_view>

namespace blockrand::outputs {

/// A ZIP archive (PKWARE APPNOTE 6.3.3) of one deflated file, dated 1980-01-01, so that equal input gives equal output (with
/// the same zlib).
/// \param name   of the file in it: ASCII, without folders
/// \param bytes  less than 4 GB
std::string zip_file(std::string_view name, std::string_view bytes);

}  // namespace blockrand::outputs
