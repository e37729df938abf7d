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

void call_hook(const std::string& hook, bool dry_run, const RegionFolder& region, std::string_view state, int number,
               base::Progress& progress) {
  if (hook.empty() || dry_run) return;
  std::vector<std::string> environment;
  for (char** e = environ; *e != nullptr; ++e)
    if (!std::string_view(*e).starts_with("BLOCKRAND_")) environment.emplace_back(*e);
  environment.push_back("BLOCKRAND_STATE=" + std::string(state));
  environment.push_back("BLOCKRAND_REGION=" + fs::absolute(region.path()).string());
  environment.push_back("BLOCKRAND_BUILD=" + fs::absolute(region.build(number)).string());
  environment.push_back("BLOCKRAND_CHANGES=" + fs::absolute(region.changes(number)).string() + ".json");
  std::vector<char*> pointers;
  for (std::string& e : environment) pointers.push_back(e.data());
  pointers.push_back(nullptr);
  std::string shell = "/bin/sh", dash = "-c", command = hook;
  char* const arguments[] = {shell.data(), dash.data(), command.data(), nullptr};
  pid_t child = 0;
  if (const int error = ::posix_spawn(&child, "/bin/sh", nullptr, nullptr, arguments, pointers.data()); error != 0) {
    progress.warn(std::string("the hook could not be run: ") + std::strerror(error));
    return;
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    progress.warn(fmt::format("the hook ended with {}", WIFEXITED(status)
                                                            ? fmt::format("exit code {}", WEXITSTATUS(status))
                                                            : fmt::format("signal {}", WTERMSIG(status))));
}

}  // namespace blockrand::run
