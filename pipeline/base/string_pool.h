// Interned strings: a tag key or value is stored once and travels as a 32-bit number.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <unordered_map>

namespace blockrand::base {

using StringId = std::uint32_t;

/// Ids are given in order of first use; id 0 is the empty string. Views stay valid as long as the pool lives.
/// Not for concurrent writing; concurrent reading is safe.
class StringPool {
 public:
  StringPool() { intern(""); }
  StringPool(const StringPool&) = delete;
  StringPool& operator=(const StringPool&) = delete;
  StringPool(StringPool&&) = default;
  StringPool& operator=(StringPool&&) = default;

  StringId intern(std::string_view text) {
    if (const auto found = ids_.find(text); found != ids_.end()) return found->second;
    const auto id = static_cast<StringId>(texts_.size());
    texts_.emplace_back(text);
    ids_.emplace(texts_.back(), id);
    return id;
  }
  /// The id of `text`, or 0 (the empty string's) when it was never interned.
  StringId find(std::string_view text) const {
    const auto found = ids_.find(text);
    return found == ids_.end() ? 0 : found->second;
  }
  std::string_view view(StringId id) const { return texts_[id]; }
  std::size_t size() const { return texts_.size(); }

 private:
  std::deque<std::string> texts_;  // a deque never moves its strings, so the views in ids_ stay valid
  std::unordered_map<std::string_view, StringId> ids_;
};

}  // namespace blockrand::base
