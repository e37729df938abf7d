// The built-in functions of rule files that need no shape: one table of name, parameters and implementation.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "styles/grammar/language/value.h"
#include "styles/grammar/shapes/shape_mesh.h"

namespace blockrand::grammar {

/// Most elements of an array (docs/rule_language.md §4.2).
inline constexpr std::size_t kMostArrayItems = 100000;

/// Most bytes of a text, and of all texts of an array together: beyond, joining is told as an error.
inline constexpr std::size_t kMostTextBytes = std::size_t{1} << 20;

/// Size and lowest corner of an asset, in metres.
struct AssetBox {
  Vector3 size{1, 1, 1};
  Vector3 offset;
};

/// The way to a rule file's assets. What is not set answers as if no file existed; then the placeholder policy of
/// docs/rule_language.md §2.2 holds.
struct FileAccess {
  std::function<bool(const std::string& path)> exists;
  /// The error says why the query is none.
  std::function<tl::expected<std::vector<std::string>, std::string>(const std::string& query)> search;
  std::function<std::optional<std::string>(const std::string& path)> read;
  std::function<std::optional<AssetBox>(const std::string& path)> asset;
  std::function<std::optional<Vector2>(const std::string& path)> image;  ///< pixels
};

/// What a function may use besides its arguments.
struct FunctionContext {
  std::uint64_t seed = 0;          ///< of the shape's generator
  std::uint32_t* draws = nullptr;  ///< how many numbers were drawn from it; advanced by each draw
  const FileAccess* files = nullptr;
  std::vector<std::string>* warnings = nullptr;  ///< the caller knows the place

  /// Uniform in [0, 1): a function of (seed, number of the draw) alone (docs/rule_language.md §4.3).
  double draw();
  void warn(std::string message) const;
};

/// An error's text says what is wrong with the arguments.
using FunctionResult = tl::expected<Value, std::string>;
using Function = FunctionResult (*)(std::span<const Value> arguments, FunctionContext& context);

/// A function with one list of parameter types.
struct FunctionEntry {
  std::string_view name;
  /// One letter a parameter: n number, b truth, s text, N B S arrays of them (as in known_names.h);
  /// "a+": one value or more, of any type.
  std::string_view parameters;
  Function run = nullptr;
  bool takes_nan = false;  ///< sees nan and inf as they are; otherwise they become 0 with a warning
                           ///< (docs/rule_language.md §4.7)
};

/// Every function, sorted by name.
std::span<const FunctionEntry> functions();

/// The overloads of one name; empty where there is none.
std::span<const FunctionEntry> find_functions(std::string_view name);

/// \returns nullptr where no overload takes these arguments
const FunctionEntry* choose_overload(std::span<const FunctionEntry> overloads, std::span<const Value> arguments);

/// Calls `entry`, with nan and inf among the arguments replaced as docs/rule_language.md §4.7 says.
FunctionResult call(const FunctionEntry& entry, std::span<const Value> arguments, FunctionContext& context);

/// Finds the overload and calls it. For tests and tools; evaluation resolves names once.
FunctionResult call(std::string_view name, std::span<const Value> arguments, FunctionContext& context);

}  // namespace blockrand::grammar
