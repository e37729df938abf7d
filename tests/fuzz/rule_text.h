// Rule files from the bytes of an input: what follows a line of dashes is the file that imports find.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "styles/grammar/language/program.h"

namespace blockrand::fuzz {

inline grammar::Program load_rules(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::size_t cut = text.find("\n----\n");
  grammar::LoadOptions options;
  options.read = [&](const std::string& path) -> std::optional<std::string> {
    if (path == "main.cga") return text.substr(0, cut);
    if (cut == std::string::npos || !path.ends_with(".cga")) return std::nullopt;
    return text.substr(cut + 6);
  };
  grammar::Program program = grammar::load("main.cga", options);
  for (const grammar::Diagnostic& d : program.diagnostics)
    if (d.location.file >= program.files.size() || d.message.empty()) std::abort();
  return program;
}

}  // namespace blockrand::fuzz
