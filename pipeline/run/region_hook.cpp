#include "pipeline/run/region_hook.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

namespace blockrand::run {

namespace fs = std::filesystem;

std::string one_line(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < ' ' || c == '\x7f';
    if (!control)
      out += c;
    else if (!out.empty() && out.back() != ' ')
      out += ' ';
  }
  while (out.ends_with(' ')) out.pop_back();
  return out;
}

void call_hook(std::string_view what, const std::string& hook, const std::string& folder, const RunEnd& end,
               base::Progress& progress) {
  if (hook.empty()) return;
  const std::string place = fs::absolute(folder).string(), digits = fmt::format("{:06}", end.number);
  std::vector<std::string> environment;
  for (char** e = environ; *e != nullptr; ++e)
    if (!std::string_view(*e).starts_with("BLOCKRAND_")) environment.emplace_back(*e);
  environment.push_back("BLOCKRAND_STATE=" + std::string(end.state));
  environment.push_back("BLOCKRAND_REASON=" + end.reason);
  environment.push_back("BLOCKRAND_REGION=" + place);
  environment.push_back("BLOCKRAND_BUILD=" + (end.number > 0 ? place + "/builds/" + digits : std::string()));
  environment.push_back("BLOCKRAND_CHANGES=" +
                        (end.number > 0 ? place + "/log/" + digits + ".changes.json" : std::string()));
  std::vector<char*> pointers;
  for (std::string& e : environment) pointers.push_back(e.data());
  pointers.push_back(nullptr);
  std::string shell = "/bin/sh", dash = "-c", command = hook;
  char* const arguments[] = {shell.data(), dash.data(), command.data(), nullptr};
  pid_t child = 0;
  if (const int error = ::posix_spawn(&child, "/bin/sh", nullptr, nullptr, arguments, pointers.data()); error != 0) {
    progress.warn(fmt::format("the {} could not be run: {}", what, std::strerror(error)));
    return;
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    progress.warn(fmt::format("the {} ended with {}", what,
                              WIFEXITED(status) ? fmt::format("exit code {}", WEXITSTATUS(status))
                                                : fmt::format("signal {}", WTERMSIG(status))));
}

}  // namespace blockrand::run
