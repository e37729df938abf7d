// What a user orders for a piece of a building: kept with it for the grammar, which decides what it understands.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blockrand::model {

enum class DetailKind : std::uint8_t { storey, edge, bay };
inline constexpr std::string_view kDetailKindNames[] = {"storey", "edge", "bay"};
constexpr std::string_view name(DetailKind kind) { return kDetailKindNames[static_cast<int>(kind)]; }

struct DetailOverride {
  std::string body;  ///< "w123", "w123.w456"
  DetailKind kind = DetailKind::storey;
  std::string name;  ///< storeys and bays: a number; storey 0 is the ground floor. Edges: "e11_12", as in outputs
  std::vector<std::pair<std::string, std::string>> values;  ///< by key
  std::string from;                                         ///< "overrides.toml:12"
};

}  // namespace blockrand::model
