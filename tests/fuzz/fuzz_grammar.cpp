// libFuzzer target: whatever a rule file holds, reading, resolving and checking it ends, and what is told of it has a
// place.
#include <cstdint>
#include <cstdlib>

#include "styles/grammar/language/check.h"
#include "tests/fuzz/rule_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace blockrand;
  const grammar::Program program = fuzz::load_rules(data, size);
  for (const grammar::Diagnostic& d : grammar::check(program, {}))
    if (grammar::format(d, program.files).empty()) std::abort();
  return 0;
}
