#include "pipeline/base/option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "pipeline/base/toml_file.h"

namespace blockrand::base {

std::string_view name(Commands command) {
  switch (command) {
    case kBuild:
      return "build";
    case kInfo:
      return "info";
    case kExplain:
      return "explain";
    case kValidate:
      return "validate";
    case kCompare:
      return "compare";
    case kDistricts:
      return "districts";
    case kGrammar:
      return "grammar";
    case kUpdate:
      return "update";
    case kStatus:
      return "status";
    case kRollback:
      return "rollback";
    case kRegion:
      return "region";
    case kView:
      return "view";
    case kCache:
      return "cache";
    case kPublish:
      return "publish";
    case kSchedule:
      return "schedule";
  }
  return "";
}

std::string in_quotes(std::string_view text) { return fmt::format("'{}'", text); }

std::string range_remedy(const OptionDescription& option, const char* kind) {
  std::string text = std::string("Write a ") + kind;
  if (option.maximum < 1e15)
    return text + " from " + shortest(option.minimum) + " to " + shortest(option.maximum) + ".";
  return text + " of at least " + shortest(option.minimum) + ".";
}

double parse_number(std::string_view text, const std::string& remedy) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw ValueError(in_quotes(text) + " is not a number", remedy);
  return value;
}

double parse_in_range(const OptionDescription& option, const std::string& text, const char* kind) {
  const std::string remedy = range_remedy(option, kind);
  const double value = parse_number(text, remedy);
  if (value < option.minimum || value > option.maximum) throw ValueError(text + " is out of range", remedy);
  return value;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    std::string_view part = text.substr(0, end);
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    parts.emplace_back(part);
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::string joined(const std::vector<std::string>& texts, std::string_view separator) {
  return fmt::format("{}", fmt::join(texts, separator));
}

void unknown_word(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = nearest(word, known);
  throw ValueError(in_quotes(word) + " is unknown",
                   (near.empty() ? "" : "Did you mean " + near + "? ") + "Known: " + joined(known, ", ") + ".");
}

}  // namespace blockrand::base
