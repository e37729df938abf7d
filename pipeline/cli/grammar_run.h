// `blockrand grammar run` and `blockrand grammar test`: a rule file on a rectangular lot.
#pragma once

#include "pipeline/settings/options.h"

namespace blockrand::cli {

/// Derives Settings::rule_files on Settings::rule_lot, prints what came out and writes the model.
/// \returns the exit code: 0, or 2 where the rule file has errors
/// \throws base::UsageError, base::OutputError
int run_grammar_run(const settings::Settings& settings);

/// The expectations in the files' comments (docs/grammar_tests.md).
/// \returns the exit code: 0 all hold, 2 not
int run_grammar_test(const settings::Settings& settings);

}  // namespace blockrand::cli
