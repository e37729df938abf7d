// `blockrand grammar run` and `blockrand grammar test`: a rule file on a rectangular lot.
#pragma once

#include <string>
#include <vector>

namespace blockrand::cli {

/// FILE --lot 20x12 [--storeys N] [--seed N] [--attr NAME=VALUE]… [--rule NAME] [--roots LIST] [--tree] [-o FILE.glb]
/// \param arguments  after the word run
/// \returns the exit code: 0, or 2 where the rule file has errors
int run_grammar_run(const std::vector<std::string>& arguments);

/// FILE… [--roots LIST]: the expectations in the files' comments (docs/grammar_tests.md).
/// \returns the exit code: 0 all hold, 2 not
int run_grammar_test(const std::vector<std::string>& arguments);

}  // namespace blockrand::cli
