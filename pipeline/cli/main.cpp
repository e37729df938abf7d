// The program: finds the command and turns errors into exit codes.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"
#include "pipeline/cli/command.h"
#include "pipeline/cli/errors.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/help.h"

namespace {

using namespace blockrand;

int run(const std::string& command, const std::vector<std::string>& arguments) {
  if (const cli::Command* known = cli::find_command(command)) return known->run(arguments);
  if (command == "--help" || command == "-h") return cli::run_help({});
  if (command == "--version" || command == "-V") {
    std::fputs(cli::version_text().c_str(), stdout);
    return cli::kSuccess;
  }
  if (command.empty()) throw base::UsageError("no command is given. Try 'blockrand --help'.");
  std::vector<std::string> names;
  for (const cli::Command& known : cli::commands()) names.push_back(known.text.name);
  const std::string near = base::nearest(command, names);
  throw base::UsageError("unknown command " + command + "." + (near.empty() ? "" : " Did you mean " + near + "?") +
                         " Try 'blockrand --help'.");
}

}  // namespace

int main(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  const std::vector<std::string> arguments(argv + std::min(argc, 2), argv + argc);
  int code = cli::guarded(cli::early_log_format(arguments), [&] { return run(command, arguments); });
  // A full disk behind a redirection shows here, or did when a longer text filled the buffer.
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
    std::fprintf(stderr, "blockrand: error: cannot write to standard output: %s\n", std::strerror(errno));
    if (code == cli::kSuccess) code = cli::kInternalError;
  }
  return code;
}
