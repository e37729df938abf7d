// What looks wrong in a program that was read: told before anything runs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "styles/grammar/language/program.h"

namespace blockrand::grammar {

/// One of our own operations: blockrand.NAME("kind", "parameter", value, "parameter", value …).
struct ExtensionOperation {
  std::string name;                     ///< without the prefix
  std::vector<std::string> kinds;       ///< what the first argument may be; empty: anything
  std::vector<std::string> parameters;  ///< names of the pairs that follow
};

struct CheckOptions {
  std::vector<ExtensionOperation> extensions;  ///< empty: calls of our own operations are not checked
  /// Values that the program gives: "building.storeys". Empty: names below building, edge, storey, roof and row are not
  /// checked.
  std::vector<std::string> context;
  /// Operations and functions that run with a fixed answer or not at all are told (as notes and warnings).
  bool tell_status = true;
};

/// Beside what Program::diagnostics tells already: probabilities beyond 100 % or below 0, choices that can never
/// happen, sizes that cannot fit, wrong types, rules that nothing reaches, recursion without condition, operations
/// without their block, what does not run yet, wrong calls of our own operations, values
/// about the building that the program does not give, declarations that hide one another.
/// Ordered by file and line, each thing once. Codes: docs of Diagnostic::code are the names in the tests.
std::vector<Diagnostic> check(const Program& program, const CheckOptions& options);

}  // namespace blockrand::grammar
