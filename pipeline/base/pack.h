// Values as bytes and back, on one machine: what a run keeps for the next one, and what is hashed to see whether it still
// holds. No format for others: a version of the program reads what the same version wrote.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "pipeline/base/fields.h"

namespace blockrand::base {

/// For types that are no aggregates: `static void pack(Packer&, const T&)`, and `static void unpack(Unpacker&, T&)` where it is
/// read back.
template <class T>
struct PackTraits;

namespace pack_detail {
template <class T>
concept HasTraits = requires {
  sizeof(PackTraits<T>);
};
template <class T>
concept Scalar = std::is_arithmetic_v<T> || std::is_enum_v<T>;
/// May be copied as they lie: numbers alone have no padding.
template <class T>
concept Plain = Scalar<T> && !std::is_same_v<T, bool> && sizeof(T) <= 8;
}  // namespace pack_detail

/// Appends values to a text of bytes: numbers as they lie in memory, lists with their length, aggregates field by field,
/// maps and sets in their order. Different values of one type give different bytes.
class Packer {
 public:
  template <class T>
  Packer& operator<<(const T& value) {
    if constexpr (pack_detail::HasTraits<T>) {
      PackTraits<T>::pack(*this, value);
    } else if constexpr (std::is_same_v<T, bool>) {
      bytes.push_back(value ? '\1' : '\0');
    } else if constexpr (pack_detail::Scalar<T>) {
      raw(&value, sizeof value);
    } else {
      put(value);
    }
    return *this;
  }
  void raw(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }

  std::string bytes;

 private:
  void size(std::size_t n) { *this << static_cast<std::uint64_t>(n); }
  void put(std::string_view text) { size(text.size()), bytes.append(text); }
  void put(const std::string& text) { put(std::string_view(text)); }
  template <class T>
  void put(std::span<T> list) {
    size(list.size());
    if constexpr (pack_detail::Plain<std::remove_const_t<T>>)
      raw(list.data(), list.size_bytes());
    else
      for (const auto& value : list) *this << value;
  }
  template <class T>
  void put(const std::vector<T>& list) {
    if constexpr (std::is_same_v<T, bool>) {
      size(list.size());
      for (const bool b : list) *this << b;
    } else {
      put(std::span<const T>(list));
    }
  }
  template <class T, std::size_t N>
  void put(const std::array<T, N>& list) {
    for (const T& value : list) *this << value;
  }
  template <class T>
  void put(const std::optional<T>& value) {
    *this << value.has_value();
    if (value) *this << *value;
  }
  template <class A, class B>
  void put(const std::pair<A, B>& value) {
    *this << value.first << value.second;
  }
  template <class... T>
  void put(const std::tuple<T...>& value) {
    std::apply([this](const auto&... v) { ((void)(*this << v), ...); }, value);
  }
  template <class... T>
  void put(const std::map<T...>& map) {
    size(map.size());
    for (const auto& [key, value] : map) *this << key << value;
  }
  template <class... T>
  void put(const std::set<T...>& set) {
    size(set.size());
    for (const auto& value : set) *this << value;
  }
  template <class... T>
  void put(const std::variant<T...>& value) {
    size(value.index());
    std::visit([this](const auto& v) { *this << v; }, value);
  }
  void put(const std::monostate&) {}
  template <class T>
  requires std::is_aggregate_v<T>
  void put(const T& value) {
    with_fields(value, [this](const auto&... f) { ((void)(*this << f), ...); });
  }
};

/// The bytes are none that a Packer made of such a value: cut off, or of another version.
struct UnpackError : std::runtime_error {
  UnpackError() : std::runtime_error("kept bytes are damaged") {}
};

/// Reads what a Packer wrote, in the same order. \throws UnpackError
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}
  bool at_end() const { return bytes_.empty(); }

  template <class T>
  Unpacker& operator>>(T& value) {
    if constexpr (pack_detail::HasTraits<T>) {
      PackTraits<T>::unpack(*this, value);
    } else if constexpr (std::is_same_v<T, bool>) {
      char c = 0;
      raw(&c, 1);
      if (c != 0 && c != 1) throw UnpackError();
      value = c == 1;
    } else if constexpr (pack_detail::Scalar<T>) {
      raw(&value, sizeof value);
    } else {
      get(value);
    }
    return *this;
  }
  void raw(void* to, std::size_t size) {
    if (size > bytes_.size()) throw UnpackError();
    if (size > 0) std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }

 private:
  /// Of a list: every element takes a byte at least, so that damage asks for no memory that is not there.
  std::size_t size() {
    std::uint64_t n = 0;
    *this >> n;
    if (n > bytes_.size()) throw UnpackError();
    return static_cast<std::size_t>(n);
  }
  void get(std::string& text) {
    const std::size_t n = size();
    text.assign(bytes_.substr(0, n));
    bytes_.remove_prefix(n);
  }
  template <class T>
  void get(std::vector<T>& list) {
    const std::size_t n = size();
    list.clear();
    if constexpr (pack_detail::Plain<T>) {
      if (n > bytes_.size() / sizeof(T)) throw UnpackError();
      list.resize(n);
      raw(list.data(), n * sizeof(T));
    } else {
      for (std::size_t i = 0; i < n; ++i) {
        T value = T();
        *this >> value;
        list.push_back(std::move(value));
      }
    }
  }
  template <class T, std::size_t N>
  void get(std::array<T, N>& list) {
    for (T& value : list) *this >> value;
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool there = false;
    *this >> there;
    value.reset();
    if (!there) return;
    T inside{};  // clang finds no emplace() for structures within a class
    *this >> inside;
    value = std::move(inside);
  }
  template <class A, class B>
  void get(std::pair<A, B>& value) {
    *this >> value.first >> value.second;
  }
  template <class K, class V, class... Rest>
  void get(std::map<K, V, Rest...>& map) {
    map.clear();
    for (std::size_t n = size(); n > 0; --n) {
      K key = K();
      *this >> key;
      *this >> map[std::move(key)];
    }
  }
  template <class... T>
  void get(std::set<T...>& set) {
    set.clear();
    for (std::size_t n = size(); n > 0; --n) {
      typename std::set<T...>::value_type value{};
      *this >> value;
      set.insert(set.end(), std::move(value));
    }
  }
  void get(std::monostate&) {}
  template <class T>
  requires std::is_aggregate_v<T>
  void get(T& value) {
    with_fields(value, [this](auto&... f) { ((void)(*this >> f), ...); });
  }

  std::string_view bytes_;
};

template <class T>
std::string packed(const T& value) {
  Packer out;
  out << value;
  return std::move(out.bytes);
}

/// \throws UnpackError  also where bytes are left
template <class T>
T unpacked(std::string_view bytes) {
  Unpacker in(bytes);
  T value = T();
  in >> value;
  if (!in.at_end()) throw UnpackError();
  return value;
}

}  // namespace blockrand::base
