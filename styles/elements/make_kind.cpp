// Checks size and parameters, has the element made, and names it.
#include "styles/elements/make_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "pipeline/base/text.h"

namespace blockrand::elements {
namespace {

/// "double casement 1.10 x 2.20, segmental head"
std::string title(const ElementKind& kind, double width, double height, const Values& values) {
  std::string out = kind.name;
  for (char& c : out)
    if (c == '_') c = ' ';
  out += fmt::format(" {:.2f} x {:.2f}", width, height);
  if (values.has_word("head") && !values.is("head", "straight")) out += ", " + values.word("head") + " head";
  for (const char* trim : {"surround", "pediment"})
    if (values.has_word(trim) && kind.name != trim && !values.is(trim, "none")) {
      std::string text = values.word(trim);
      for (char& c : text)
        if (c == '_') c = ' ';
      out += ", " + text + " " + trim;
    }
  return out;
}

const ParameterInfo* find_parameter(const ElementKind& kind, std::string_view name) {
  for (const ParameterInfo& info : kind.parameters)
    if (info.name == name) return &info;
  return nullptr;
}

/// Numbers out of range brought back into it.
std::vector<Parameter> in_range(const ElementKind& kind, std::span<const Parameter> given) {
  std::vector<Parameter> out(given.begin(), given.end());
  for (Parameter& p : out) {
    const ParameterInfo* info = find_parameter(kind, p.name);
    double* const number = std::get_if<double>(&p.value);
    if (!info || !number || info->type == ParameterInfo::Type::word || info->type == ParameterInfo::Type::profile ||
        info->type == ParameterInfo::Type::edge)
      continue;
    if (*number >= info->least && *number <= info->most) continue;
    *number = info->unit == "degrees" ? info->initial : std::clamp(*number, info->least, info->most);
  }
  return out;
}

/// Parameters under which an element lacks all that it may lack.
std::vector<Parameter> bare(const ElementKind& kind, std::vector<Parameter> given) {
  const auto set = [&](const ParameterInfo& info, std::variant<double, std::string> value) {
    for (Parameter& p : given)
      if (p.name == info.name) {
        p.value = std::move(value);
        return;
      }
    given.push_back({info.name, std::move(value)});
  };
  constexpr std::array<std::string_view, 4> kOptionalLengths = {"transom", "top_light", "sign", "bracket_spacing"};
  for (const ParameterInfo& info : kind.parameters) {
    const bool none = std::find(info.words.begin(), info.words.end(), "none") != info.words.end();
    if (info.type == ParameterInfo::Type::word && none && info.name != "filling") set(info, "none");
    if (info.type == ParameterInfo::Type::whole && info.least == 0 && info.name != "detail") set(info, 0.0);
    if (info.name == "leaves" && info.type == ParameterInfo::Type::whole) set(info, 1.0);
    if (std::find(kOptionalLengths.begin(), kOptionalLengths.end(), info.name) != kOptionalLengths.end())
      set(info, 0.0);
  }
  return given;
}

}  // namespace

tl::expected<FittedElement, std::string> make_fitting_kind(const ElementKind& kind, const Maker& maker, double width,
                                                           double height, std::span<const Parameter> parameters,
                                                           const ProfileLibrary& profiles) {
  auto asked = make_kind(kind, maker, width, height, parameters, profiles);
  if (asked) return FittedElement{std::move(*asked), {}};
  width = std::min(width, kind.width.most);
  height = std::min(height, kind.height.most);
  const std::vector<Parameter> limited = in_range(kind, parameters);
  auto made = make_kind(kind, maker, width, height, limited, profiles);
  if (!made) made = make_kind(kind, maker, width, height, bare(kind, limited), profiles);
  if (!made) return tl::unexpected(asked.error());
  std::string told = asked.error() + "; made instead: " + made->name;
  return FittedElement{std::move(*made), std::move(told)};
}

tl::expected<Element, std::string> make_kind(const ElementKind& kind, const Maker& maker, double width, double height,
                                             std::span<const Parameter> parameters, const ProfileLibrary& profiles) {
  const auto in_range = [&](double v, double least, double most, const char* what) -> std::string {
    if (v >= least && v <= most) return {};
    return fmt::format("{}: the {} is {} m; it goes from {} to {} m", kind.name, what, base::shortest(v),
                       base::shortest(least), base::shortest(most));
  };
  if (auto e = in_range(width, kind.width.least, kind.width.most, "width"); !e.empty()) return tl::unexpected(e);
  if (auto e = in_range(height, kind.height.least, kind.height.most, "height"); !e.empty()) return tl::unexpected(e);
  const auto values = Values::check(kind, parameters, profiles);
  if (!values) return tl::unexpected(values.error());
  Element element;
  element.kind = kind.name;
  element.semantic = kind.semantic;
  const Request request{model::snap(width), model::snap(height), *values};
  if (const Made made = maker(request, element); !made)
    return tl::unexpected(fmt::format("{} {:.2f} x {:.2f}: {}", kind.name, width, height, made.error()));
  element.name = title(kind, width, height, *values);
  return element;
}

}  // namespace blockrand::elements
