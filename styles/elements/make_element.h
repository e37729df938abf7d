// Makes any element from the name of its kind, its size and named parameters: what rule files call.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "styles/elements/built_element.h"
#include "styles/elements/profile_library.h"

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

/// What the width or the height of make_element() may be.
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

/// Every kind, in the order of docs/elements.md.
std::span<const ElementKind> element_kinds();
/// Null when there is none of that name.
const ElementKind* find_element_kind(std::string_view name);

/// m. No element reaches farther into the wall than this from its front (leaves of gateways that stand open apart,
/// which reach into the passage by their width).
inline constexpr double kDeepest = 0.80;

/// Makes an element. Pure: the same arguments give the same bytes.
///
/// \param width, height  m, what they measure is in ElementKind
/// \param parameters     those that are not named keep their defaults
/// \param profiles       mouldings by name
/// Error: unknown kinds, parameters and words, each with the nearest known; values out of range, with the range; sizes
/// that leave no room for what is asked for.
tl::expected<Element, std::string> make_element(std::string_view kind, double width, double height,
                                                std::span<const Parameter> parameters = {},
                                                const ProfileLibrary& profiles = built_in_profiles());

/// An element that may be simpler than what was asked for.
struct FittedElement {
  Element element;
  std::string told;  ///< what was asked for and why it cannot be made; empty where it was
};

/// The same for rules that do not know every limit, so that one measure costs no more than itself: where an element cannot be
/// made as asked, sizes above their range get its end, numbers out of range their nearest, angles out of range their default;
/// where that does not do, what it may lack is left off as well (doors of shop windows, pediments, bars).
/// Error: as make_element() as asked, where all of that leaves nothing: unknown names, sizes below their range.
tl::expected<FittedElement, std::string> make_fitting_element(std::string_view kind, double width, double height,
                                                              std::span<const Parameter> parameters = {},
                                                              const ProfileLibrary& profiles = built_in_profiles());

}  // namespace blockrand::elements
