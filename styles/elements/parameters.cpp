// Checks parameters against what a kind knows.
#include "styles/elements/parameters.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "pipeline/base/text.h"
#include "pipeline/base/toml_file.h"

namespace blockrand::elements {
namespace {

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
  const std::string near = base::nearest(word, known);
  if (!near.empty()) return fmt::format("; did you mean \"{}\"?", near);
  std::string list;
  for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
  return "; known: " + list;
}

std::string with_unit(double v, const std::string& unit) {
  return base::shortest(v) + (unit.empty() ? "" : " " + unit);
}

/// What the name of a moulding, or a program, means.
tl::expected<ProfileProgram, std::string> profile_program(const ElementKind& kind, const std::string& parameter,
                                                          const std::string& text, const ProfileLibrary& profiles) {
  if (text.find('{') != std::string::npos) {
    auto program = parse_profile(text);
    if (!program) return tl::unexpected(fmt::format("{}: \"{}\": {}", kind.name, parameter, program.error().text()));
    for (const int steps : {arc_steps_at(1), arc_steps_at(2)})
      if (const auto section = section_of(scaled_to_height(trace(*program, steps), 1, 10)); !section)
        return tl::unexpected(fmt::format("{}: \"{}\": {}", kind.name, parameter, section.error()));
    return std::move(*program);
  }
  if (const auto found = profiles.find(text); found != profiles.end()) return found->second.program;
  std::vector<std::string> known;
  for (const auto& [name, preset] : profiles) known.push_back(name);
  return tl::unexpected(fmt::format("{}: there is no profile \"{}\"{}", kind.name, text, suggestion(text, known)));
}

/// What the name of an edge's shape, or a program, means; empty: straight.
tl::expected<ProfileProgram, std::string> edge_program(const ElementKind& kind, const std::string& parameter,
                                                       const std::string& text) {
  std::string_view program = text;
  if (text.find('{') == std::string::npos) {
    std::vector<std::string> known;
    const EdgeShape* shape = nullptr;
    for (const EdgeShape& s : edge_shapes()) {
      known.emplace_back(s.name);
      if (s.name == text) shape = &s;
    }
    if (!shape)
      return tl::unexpected(
          fmt::format("{}: there is no shape of an edge \"{}\"{}", kind.name, text, suggestion(text, known)));
    program = shape->program;
  }
  if (program.empty()) return ProfileProgram{};
  auto parsed = parse_profile(program);
  if (!parsed) return tl::unexpected(fmt::format("{}: \"{}\": {}", kind.name, parameter, parsed.error().text()));
  return std::move(*parsed);
}

}  // namespace

tl::expected<Values, std::string> Values::check(const ElementKind& kind, std::span<const Parameter> given,
                                                const ProfileLibrary& profiles) {
  Values out;
  out.kind_ = &kind;
  out.profiles_ = &profiles;
  const std::size_t n = kind.parameters.size();
  out.numbers_.resize(n);
  out.programs_.resize(n);
  for (std::size_t i = 0; i < n; ++i) out.numbers_[i] = kind.parameters[i].initial;
  std::vector<bool> set(n, false);
  for (const Parameter& p : given) {
    std::size_t i = 0;
    while (i < n && kind.parameters[i].name != p.name) ++i;
    if (i == n) {
      std::vector<std::string> known;
      for (const ParameterInfo& info : kind.parameters) known.push_back(info.name);
      return tl::unexpected(fmt::format("{} has no parameter \"{}\"{}", kind.name, p.name, suggestion(p.name, known)));
    }
    const ParameterInfo& info = kind.parameters[i];
    if (set[i]) return tl::unexpected(fmt::format("{}: \"{}\" is given twice", kind.name, p.name));
    set[i] = true;
    const double* const number = std::get_if<double>(&p.value);
    const std::string* const text = std::get_if<std::string>(&p.value);
    switch (info.type) {
      case ParameterInfo::Type::number:
      case ParameterInfo::Type::whole:
        if (!number)
          return tl::unexpected(
              fmt::format("{}: \"{}\" wants a number, not the text \"{}\"", kind.name, p.name, *text));
        if (!(*number >= info.least && *number <= info.most))
          return tl::unexpected(fmt::format("{}: \"{}\" is {}; it goes from {} to {}", kind.name, p.name,
                                            with_unit(*number, info.unit), base::shortest(info.least),
                                            with_unit(info.most, info.unit)));
        if (info.type == ParameterInfo::Type::whole && *number != std::floor(*number))
          return tl::unexpected(
              fmt::format("{}: \"{}\" is {}; it wants a whole number", kind.name, p.name, base::shortest(*number)));
        out.numbers_[i] = *number;
        break;
      case ParameterInfo::Type::word: {
        if (!text)
          return tl::unexpected(
              fmt::format("{}: \"{}\" wants a word{}", kind.name, p.name, suggestion("", info.words)));
        std::size_t w = 0;
        while (w < info.words.size() && info.words[w] != *text) ++w;
        if (w == info.words.size())
          return tl::unexpected(
              fmt::format("{}: \"{}\" cannot be \"{}\"{}", kind.name, p.name, *text, suggestion(*text, info.words)));
        out.numbers_[i] = static_cast<double>(w);
        break;
      }
      case ParameterInfo::Type::profile: {
        if (!text)
          return tl::unexpected(fmt::format("{}: \"{}\" wants the name of a profile or a program", kind.name, p.name));
        auto program = profile_program(kind, p.name, *text, profiles);
        if (!program) return tl::unexpected(program.error());
        out.programs_[i] = std::move(*program);
        break;
      }
      case ParameterInfo::Type::edge: {
        if (!text)
          return tl::unexpected(
              fmt::format("{}: \"{}\" wants the name of an edge's shape or a program", kind.name, p.name));
        auto program = edge_program(kind, p.name, *text);
        if (!program) return tl::unexpected(program.error());
        out.programs_[i] = std::move(*program);
        break;
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const ParameterInfo& info = kind.parameters[i];
    if (set[i]) continue;
    // Variants of a kind may have programs as defaults.
    if (info.type == ParameterInfo::Type::profile) {
      const std::string& name = info.words.at(0);
      if (name.find('{') == std::string::npos && !profiles.contains(name))
        return tl::unexpected(fmt::format("{}: the library lacks the profile \"{}\" that \"{}\" is by default",
                                          kind.name, name, info.name));
      auto program = profile_program(kind, info.name, name, profiles);
      if (!program) return tl::unexpected(program.error());
      out.programs_[i] = std::move(*program);
    } else if (info.type == ParameterInfo::Type::edge) {
      auto program = edge_program(kind, info.name, info.words.at(0));
      if (!program) return tl::unexpected(program.error());
      out.programs_[i] = std::move(*program);
    }
  }
  return out;
}

std::size_t Values::index(std::string_view name) const {
  std::size_t i = 0;
  while (i < kind_->parameters.size() && kind_->parameters[i].name != name) ++i;
  assert(i < kind_->parameters.size() && "a generator asks for a parameter that its kind lacks");
  return i;
}

bool Values::has(std::string_view name) const {
  for (const ParameterInfo& info : kind_->parameters)
    if (info.name == name) return true;
  return false;
}

bool Values::has_word(std::string_view name) const {
  return has(name) && kind_->parameters[index(name)].type == ParameterInfo::Type::word;
}

const std::string& Values::word(std::string_view name) const {
  const std::size_t i = index(name);
  return kind_->parameters[i].words[static_cast<std::size_t>(numbers_[i])];
}

Profile Values::traced(const ProfileProgram& program) const {
  const int detail = this->detail();
  const Profile p = trace(program, arc_steps_at(detail));
  return detail == 0 ? silhouette(p) : p;
}

std::optional<Profile> Values::edge(std::string_view name) const {
  const ProfileProgram& program = programs_[index(name)];
  if (program.commands.empty()) return std::nullopt;
  constexpr int kEdgeSteps[] = {2, 4, 6};  // straight pieces of a quarter circle by detail
  return trace(program, kEdgeSteps[this->detail()]);
}

Profile Values::profile(std::string_view name) const { return traced(programs_[index(name)]); }

Profile Values::preset(std::string_view name) const {
  const auto found = profiles_->find(name);
  return found == profiles_->end() ? Profile{} : traced(found->second.program);
}

}  // namespace blockrand::elements
