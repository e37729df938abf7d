// Counts the members of an aggregate, so that a test sees a member that nobody declared as an option.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

namespace blockrand {

/// Initialises a member of any type but std::optional, which would take it for its content as well.
struct AnyMember {
  template <class T>
  operator T() const;
};

/// \tparam Given  initialisers of the members that were found so far
template <class Struct, class... Given>
constexpr std::size_t member_count() {
  if constexpr (requires { Struct{std::declval<Given>()..., std::declval<AnyMember>()}; })
    return member_count<Struct, Given..., AnyMember>();
  else if constexpr (requires { Struct{std::declval<Given>()..., std::nullopt}; })
    return member_count<Struct, Given..., std::nullopt_t>();
  else
    return sizeof...(Given);
}

}  // namespace blockrand
