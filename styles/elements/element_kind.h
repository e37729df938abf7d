// What kinds of elements are, and what may be asked of them.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "styles/elements/built_element.h"

namespace blockrand::elements {

/// A parameter as a rule file gives it. Metres, degrees, shares; words and names of profiles are texts.
struct Parameter {
  std::string name;
  std::variant<double, std::string> value;
};

/// What a parameter of a kind is.
struct ParameterInfo {
  enum class Type : std::uint8_t {
    number,
    whole,    ///< a whole number
    word,     ///< one of `words`
    profile,  ///< the name of a moulding in the library, or a program of the profile language
    edge,     ///< a shape of an opening's edge by its name (edge_shapes()), or a program of the profile language
  };
  std::string name;
  std::string unit = {};  ///< "m", "degrees", "of the width"; empty for words and counts
  Type type = Type::number;
  double initial = 0, least = 0, most = 0;  ///< of numbers; of words `initial` is the index
  std::vector<std::string> words = {};      ///< allowed words; of profiles and edges the default's name alone
  std::string meaning;
};

/// What the width or the height of an element may be.
struct SizeRange {
  std::string measures;       ///< what of the element: "opening", "run"
  double least, usual, most;  ///< m
};

struct ElementKind {
  std::string name;
  ElementClass semantic = ElementClass::installation;
  std::string meaning;
  SizeRange width, height;
  std::vector<ParameterInfo> parameters = {};
};

/// m. No element reaches farther into the wall than this from its front (leaves of gateways that stand open apart,
/// which reach into the passage by their width).
inline constexpr double kDeepest = 0.80;

}  // namespace blockrand::elements
