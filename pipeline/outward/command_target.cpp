#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "pipeline/base/error.h"
#include "pipeline/outward/target.h"
#include "pipeline/run/region_folder.h"

extern char** environ;

namespace blockrand::outward {
namespace {

namespace fs = std::filesystem;

/// A folder that is gone at the end.
struct WorkFolder {
  explicit WorkFolder(std::string p) : path(std::move(p)) {
    std::error_code error;
    fs::remove_all(path, error);
    fs::create_directories(path, error);
    if (error) throw base::OutputError(path + ": cannot be made: " + error.message());
  }
  ~WorkFolder() {
    std::error_code error;
    fs::remove_all(path, error);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  std::string path;
};

/// What a command is told by its environment.
struct Task {
  std::string action, step, source;
  int number = 0, of = 0;
};

class Caller {
 public:
  Caller(std::string build, std::string command, std::string name, const std::string& work)
      : build_(std::move(build)),
        command_(std::move(command)),
        name_(std::move(name)),
        work_(fs::absolute(work).string()) {}

  std::vector<std::string> put(const Batch& batch, const MakeVariant& variant) {
    std::vector<std::string> paths, variants;
    for (const BuildFile& file : batch.files) check_there(build_, file), paths.push_back(file.path);
    std::string source = build_;
    std::unique_ptr<WorkFolder> links;
    if (variant) {
      links = std::make_unique<WorkFolder>(work_.path + "/files");
      source = links->path;
      for (const BuildFile& file : batch.files) {
        link(file.path, source);
        const std::string bytes = variant(file);
        if (bytes.empty()) continue;
        run::write_whole(source + "/" + file.path + ".gz", bytes);
        variants.push_back(file.path + ".gz");
      }
      paths.insert(paths.end(), variants.begin(), variants.end());
    }
    call({"put", std::string(outward::name(batch.step)), source, batch.number, batch.of}, paths);
    return variants;
  }

  void remove(std::span<const std::string> paths, int number, int of) {
    call({"delete", "deletions", build_, number, of}, paths);
  }

 private:
  /// One file on disk with that of the build where the file system can, else a copy.
  void link(const std::string& path, const std::string& folder) const {
    const std::string from = build_ + "/" + path, to = folder + "/" + path;
    std::error_code error;
    fs::create_directories(fs::path(to).parent_path(), error);
    if (::link(from.c_str(), to.c_str()) == 0) return;
    fs::copy_file(from, to, error);
    if (error) throw base::OutputError(to + ": cannot be written: " + error.message());
  }

  void call(const Task& task, std::span<const std::string> paths) {
    std::string lines, zeros;
    for (const std::string& path : paths) lines += path + '\n', (zeros += path) += '\0';
    const std::string list = work_.path + "/list", list0 = work_.path + "/list0";
    run::write_whole(list, lines);
    run::write_whole(list0, zeros);
    std::vector<std::string> environment;
    for (char** e = environ; *e != nullptr; ++e)
      if (!std::string_view(*e).starts_with("BLOCKRAND_")) environment.emplace_back(*e);
    for (const auto& [key, value] : {std::pair<const char*, std::string>{"ACTION", task.action},
                                     {"STEP", task.step},
                                     {"SOURCE", task.source},
                                     {"LIST", list},
                                     {"LIST0", list0},
                                     {"TARGET", name_},
                                     {"CALL", std::to_string(task.number)},
                                     {"CALLS", std::to_string(task.of)}})
      environment.push_back(std::string("BLOCKRAND_") + key + "=" + value);
    const int status = run_shell(environment, list);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    throw base::OutputError(
        fmt::format("the command that publishes ended with {} ({} of {} files, call {} of {}). What lies there leads "
                    "to no missing file; "
                    "publish again, and it goes on with this call",
                    WIFEXITED(status) ? fmt::format("exit code {}", WEXITSTATUS(status))
                                      : fmt::format("signal {}", WTERMSIG(status)),
                    task.action, paths.size(), task.number, task.of));
  }

  /// Its process ends with this one. \returns  as waitpid has it
  int run_shell(std::vector<std::string>& environment, const std::string& input) const {
    std::vector<char*> pointers;
    for (std::string& e : environment) pointers.push_back(e.data());
    pointers.push_back(nullptr);
    std::string shell = "/bin/sh", dash = "-c", command = command_;
    char* const arguments[] = {shell.data(), dash.data(), command.data(), nullptr};
    const int list = ::open(input.c_str(), O_RDONLY | O_CLOEXEC);
    const pid_t parent = ::getpid(), child = list < 0 ? -1 : ::fork();
    if (child < 0)
      throw base::OutputError(std::string("the command that publishes could not be run: ") + std::strerror(errno));
    if (child == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGTERM);
      if (::getppid() != parent) ::_exit(127);
      // The thread that waits for signals is not here.
      sigset_t none;
      ::sigemptyset(&none);
      for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) ::signal(number, SIG_DFL);
      ::sigprocmask(SIG_SETMASK, &none, nullptr);
      ::dup2(list, STDIN_FILENO);
      ::dup2(STDERR_FILENO, STDOUT_FILENO);  // what this program prints may be read by others
      ::execve("/bin/sh", arguments, pointers.data());
      ::_exit(127);
    }
    ::close(list);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
  }

  std::string build_, command_, name_;
  WorkFolder work_;
};

}  // namespace

Target command_target(const std::string& build, const std::string& command, const std::string& name,
                      const std::string& work) {
  const auto caller = std::make_shared<Caller>(build, command, name, work);
  Target target;
  target.put = [caller](const Batch& batch, const MakeVariant& variant) { return caller->put(batch, variant); };
  target.remove = [caller](std::span<const std::string> paths, int number, int of) {
    caller->remove(paths, number, of);
  };
  return target;
}

}  // namespace blockrand::outward
