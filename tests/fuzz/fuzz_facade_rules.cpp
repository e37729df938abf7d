// libFuzzer target: whatever the XML of facade rules holds, it becomes rule text that can be read, or an InputError.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "importers/facade_rules/read_facade_rules.h"
#include "pipeline/base/error.h"
#include "styles/grammar/language/bilke_import.h"
#include "styles/grammar/language/program.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand;
  try {
    const grammar::ImportedRules rules = grammar::rule_text_of(importers::facade_rules::parse_facade_rules(
        std::string_view(reinterpret_cast<const char*>(data), size), "rules.xml"));
    grammar::LoadOptions options;
    options.read = [&](const std::string& path) {
      return path == "main.cga" ? std::optional(rules.text) : std::nullopt;
    };
    grammar::load("main.cga", options);
  } catch (const base::InputError&) {
  }
  return 0;
}
