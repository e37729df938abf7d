// Styles: what may stand after the first `style` (docs/rule_language.md §1.6), also in styles that are not in force.
#include <algorithm>

#include "styles/grammar/language/check_parts.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar::detail {

namespace {

bool is_value(const Declaration& d) {
  return !d.override_rule && !d.broken && d.prefix == kNone &&
         (d.kind == DeclarationKind::attribute || d.kind == DeclarationKind::constant);
}

/// Number of the style that `style` extends; 0: Default, also where there is no such style (told).
std::uint32_t base_of(const Unit& unit, std::uint32_t style) {
  const NameId base = unit.styles[style].base;
  for (std::uint32_t i = 1; base != kNone && i < unit.styles.size(); ++i)
    if (unit.styles[i].name == base) return i;
  return 0;
}

/// The attribute that one of a style takes the place of: of the nearest base that has it.
const Declaration* replaced_by(const Unit& unit, const Declaration& own) {
  std::uint32_t style = own.style;
  // No chain is longer than there are styles, unless it is a cycle.
  for (std::size_t step = 0; style != 0 && step < unit.styles.size(); ++step) {
    style = base_of(unit, style);
    for (const Declaration& other : unit.declarations)
      if (other.style == style && other.name == own.name && is_value(other)) return &other;
  }
  return nullptr;
}

void check_bases(const Checked& c) {
  std::vector<std::string_view> known;
  for (std::size_t i = 1; i < c.unit.styles.size(); ++i) known.push_back(c.unit.name(c.unit.styles[i].name));
  for (std::size_t i = 1; i < c.unit.styles.size(); ++i) {
    const Style& style = c.unit.styles[i];
    if (style.base == kNone) continue;
    const std::string_view base = c.unit.name(style.base);
    if (base == "Default" || std::find(known.begin(), known.end(), base) != known.end()) continue;
    c.tell(Severity::error, "unknown_style", style.location, "no such style", base, nearest_name(base, known));
  }
}

bool is_start(std::string_view annotation) { return annotation == "StartRule" || annotation == "Startrule"; }

void check_declaration(const Checked& c, const Declaration& d) {
  if (d.start || d.extension)
    c.tell(Severity::error, "style_section", d.location, "start and extension rules stand before the first style",
           c.unit.name(d.name));
  for (const Annotation& a : Unit::slice(c.unit.annotations, d.annotations))
    if (is_start(a.name))
      c.tell(Severity::error, "style_section", a.location, "the start rule is told before the first style", a.name);
  if (!is_value(d) || d.value == kNone) return;
  const Declaration* other = replaced_by(c.unit, d);
  if (other == nullptr || other->value == kNone) return;
  const auto own = c.module.types[d.value], before = c.module.types[other->value];
  if (own && before && *own != *before)
    c.tell(Severity::error, "style_type", d.location,
           "this attribute is a " + std::string(type_name(*before)) + " in the style that this one extends, not a " +
               std::string(type_name(*own)),
           c.unit.name(d.name));
}

}  // namespace

void check_styles(const Checked& c) {
  check_bases(c);
  for (const Declaration& d : c.unit.declarations)
    if (d.style != 0 && !d.override_rule && !d.broken) check_declaration(c, d);
}

}  // namespace blockrand::grammar::detail
