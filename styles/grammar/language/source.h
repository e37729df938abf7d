// Where something stands in a rule file, and what is told about it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace blockrand::grammar {

/// A place in a rule file. Lines and columns count from 1; columns count characters (code points), not bytes; a tab is
/// one. Line 0: the file as a whole.
struct Location {
  std::uint32_t file = 0;  ///< index into Program::files
  std::uint32_t line = 0, column = 0;
  bool operator==(const Location&) const = default;
};

enum class Severity : std::uint8_t { note, warning, error };

/// Something that is wrong, or looks wrong, in a rule file.
struct Diagnostic {
  Severity severity = Severity::error;
  std::string code;  ///< snake_case and stable: "syntax", "unknown_operation" …; docs and tests know them by it
  Location location;
  std::string message;     ///< without a full stop
  std::string text;        ///< the offending text, as the file writes it; may be empty
  std::string suggestion;  ///< what may have been meant; may be empty
};

/// A rule file that was read.
struct SourceFile {
  std::string path;  ///< as the search found it
  std::string text;  ///< UTF-8 without byte order mark, whatever the file's encoding was
};

/// "roof.cga:12:5: warning: message 'text'; did you mean 'suggestion'? [code]"
std::string format(const Diagnostic& diagnostic, std::span<const SourceFile> files);

/// Whether one of them is an error.
bool has_errors(std::span<const Diagnostic> diagnostics);

}  // namespace blockrand::grammar
