// Who an object is in OpenStreetMap.
#pragma once

#include <compare>
#include <cstdint>
#include <string>

namespace blockrand::model {

enum class OsmType : std::uint8_t { node, way, relation };

/// An OSM object: type and number. Its text form is `n1`, `w123` or `r45`; editors' new objects have negative numbers.
struct OsmId {
  OsmType type = OsmType::node;
  std::int64_t number = 0;

  friend auto operator<=>(const OsmId&, const OsmId&) = default;

  char letter() const { return type == OsmType::node ? 'n' : type == OsmType::way ? 'w' : 'r'; }
  std::string text() const { return letter() + std::to_string(number); }
  /// Key for base::random_bits and hash tables: distinct for distinct ids (numbers below 2^62).
  std::uint64_t key() const { return (static_cast<std::uint64_t>(number) << 2) | static_cast<std::uint64_t>(type); }
};

}  // namespace blockrand::model
