// Ids of buildings and bodies as every format writes them.
#pragma once

#include <string>
#include <string_view>

namespace blockrand::validate {

/// "w123", "n-1", "r5".
inline bool is_osm_id(std::string_view id) {
  if (id.size() < 2 || (id[0] != 'n' && id[0] != 'w' && id[0] != 'r')) return false;
  id.remove_prefix(id[1] == '-' ? 2 : 1);
  return !id.empty() && id.find_first_not_of("0123456789") == std::string_view::npos;
}

/// "w123", "w123.w456", "w123.rest", "w123.w456.2".
inline bool is_body_id(std::string_view id) {
  const std::size_t dot = id.find('.');
  if (!is_osm_id(id.substr(0, dot))) return false;
  while (!id.empty()) {
    const std::size_t end = id.find('.');
    const std::string_view piece = id.substr(0, end);
    if (!is_osm_id(piece) && piece != "rest" &&
        (piece.empty() || piece.find_first_not_of("0123456789") != std::string_view::npos))
      return false;
    if (end == std::string_view::npos) break;
    id.remove_prefix(end + 1);
    if (id.empty()) return false;
  }
  return true;
}

/// The object that a body belongs to: the last OSM id in "w1", "w1.2", "w1.rest", "w1.w2", "w1.w2.3".
inline std::string owner(std::string_view id) {
  std::string_view last = id;
  for (std::string_view rest = id; !rest.empty();) {
    const std::size_t end = rest.find('.');
    if (is_osm_id(rest.substr(0, end))) last = rest.substr(0, end);
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  return std::string(last);
}

/// The building that a body belongs to: what stands before the first dot.
inline std::string building_of(std::string_view id) { return std::string(id.substr(0, id.find('.'))); }

}  // namespace blockrand::validate
