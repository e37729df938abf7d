// libFuzzer target: whatever a rule file holds, reading, resolving and checking it ends, without a crash.
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "styles/grammar/check.h"
#include "styles/grammar/program.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand::grammar;
  const std::string text(reinterpret_cast<const char*>(data), size);
  // What follows a line of dashes is the file that imports find.
  const std::size_t cut = text.find("\n----\n");
  LoadOptions options;
  options.read = [&](const std::string& path) -> std::optional<std::string> {
    if (path == "main.cga") return text.substr(0, cut);
    if (cut == std::string::npos || !path.ends_with(".cga")) return std::nullopt;
    return text.substr(cut + 6);
  };
  const Program program = load("main.cga", options);
  for (const Diagnostic& d : program.diagnostics)
    if (d.location.file >= program.files.size() || d.message.empty()) std::abort();
  for (const Diagnostic& d : check(program, {}))
    if (format(d, program.files).empty()) std::abort();
  return 0;
}
