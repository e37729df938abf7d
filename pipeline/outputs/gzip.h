// Deterministic gzip.
#pragma once

#include <string>
#include <string_view>

namespace blockrand::outputs {

/// `bytes` as one gzip member: no file name, time 0, unknown operating system, so that equal input gives equal output
/// (with the same libdeflate).
/// \param level    1 (fast) to 12 (small)
/// \param comment  for the header (RFC 1952, in ISO 8859-1: other letters become '?'); empty: none
/// \throws std::bad_alloc there is no memory
std::string gzip(std::string_view bytes, int level = 6, std::string_view comment = {});

/// The content of a gzip file of any number of members. \throws std::runtime_error when it is damaged or cut off
std::string gunzip(std::string_view bytes);

}  // namespace blockrand::outputs
