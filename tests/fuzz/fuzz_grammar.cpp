// libFuzzer target: whatever a rule file holds, reading, resolving, checking and deriving it ends, without a crash.
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "styles/grammar/evaluation/derive.h"
#include "styles/grammar/language/check.h"
#include "styles/grammar/language/program.h"
#include "styles/grammar/shapes/initial_shape.h"

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
  // Few shapes, so that inputs stay fast; the limits themselves are tried, too.
  DeriveOptions run;
  run.limits = {200, 40, 40, 2000, 20000, 50, 2000};
  derive(program, initial_shape({{0, 0, 0}, {12, 0, 0}, {12, 0, -9}, {7, 0, -9}, {7, 0, -5}, {0, 0, -5}}), run);
  return 0;
}
