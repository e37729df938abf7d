#include "styles/grammar/language/source.h"

#include <fmt/format.h>

#include <algorithm>

namespace blockrand::grammar {

std::string format(const Diagnostic& diagnostic, std::span<const SourceFile> files) {
  std::string line;
  if (diagnostic.location.file < files.size()) line = files[diagnostic.location.file].path;
  if (diagnostic.location.line > 0)
    line += fmt::format("{}{}:{}", line.empty() ? "" : ":", diagnostic.location.line, diagnostic.location.column);
  constexpr const char* kSeverities[] = {"note", "warning", "error"};
  line += fmt::format("{}{}: {}", line.empty() ? "" : ": ", kSeverities[static_cast<std::size_t>(diagnostic.severity)],
                      diagnostic.message);
  if (!diagnostic.text.empty()) line += fmt::format(" '{}'", diagnostic.text);
  if (!diagnostic.suggestion.empty()) line += fmt::format("; did you mean '{}'?", diagnostic.suggestion);
  return line + fmt::format(" [{}]", diagnostic.code);
}

bool has_errors(std::span<const Diagnostic> diagnostics) {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& d) { return d.severity == Severity::error; });
}

}  // namespace blockrand::grammar
