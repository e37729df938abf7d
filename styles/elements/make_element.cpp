// Finds the kind, checks size and parameters, and names what was made.
#include "styles/elements/make_element.h"

#include <fmt/format.h>

#include "pipeline/base/text.h"
#include "pipeline/base/toml_file.h"
#include "styles/elements/parameters.h"

namespace blockrand::elements {
namespace {

/// "double casement 1.10 x 2.20, segmental head"
std::string title(const ElementKind& kind, double width, double height, const Values& values) {
  std::string out = kind.name;
  for (char& c : out)
    if (c == '_') c = ' ';
  out += fmt::format(" {:.2f} x {:.2f}", width, height);
  if (values.has("head") && !values.is("head", "straight")) out += ", " + values.word("head") + " head";
  for (const char* trim : {"surround", "pediment"})
    if (values.has(trim) && kind.name != trim && !values.is(trim, "none")) {
      std::string text = values.word(trim);
      for (char& c : text)
        if (c == '_') c = ' ';
      out += ", " + text + " " + trim;
    }
  return out;
}

}  // namespace

tl::expected<Element, std::string> make_element(std::string_view name, double width, double height,
                                                std::span<const Parameter> parameters, const ProfileLibrary& profiles) {
  const auto kinds = element_kinds();
  std::size_t k = 0;
  while (k < kinds.size() && kinds[k].name != name) ++k;
  if (k == kinds.size()) {
    std::vector<std::string> known;
    for (const ElementKind& kind : kinds) known.push_back(kind.name);
    const std::string near = base::nearest(name, known);
    std::string list;
    for (const std::string& n : known) list += (list.empty() ? "" : ", ") + n;
    return tl::unexpected(fmt::format("there is no element \"{}\"; {}", name,
                                      near.empty() ? "known: " + list : fmt::format("did you mean \"{}\"?", near)));
  }
  const ElementKind& kind = kinds[k];
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
  if (const Made made = generators()[k](request, element); !made)
    return tl::unexpected(fmt::format("{} {:.2f} x {:.2f}: {}", kind.name, width, height, made.error()));
  element.name = title(kind, width, height, *values);
  return element;
}

}  // namespace blockrand::elements
