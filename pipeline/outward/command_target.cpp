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

/// A descriptor that is closed at the end.
struct OpenFile {
  explicit OpenFile(int d) : descriptor(d) {}
  ~OpenFile() {
    if (descriptor >= 0) ::close(descriptor);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int descriptor;
};

/// While it lives processes that end can be waited for, though the caller's environment ignores SIGCHLD.
struct WaitedFor {
  WaitedFor() {
    struct sigaction normal {};
    normal.sa_handler = SIG_DFL;
    ::sigaction(SIGCHLD, &normal, &before);
  }
  ~WaitedFor() { ::sigaction(SIGCHLD, &before, nullptr); }
  WaitedFor(const WaitedFor&) = delete;
  WaitedFor& operator=(const WaitedFor&) = delete;
  struct sigaction before {};
};

/// Whether a person at a terminal has this program before them: it may ask for passwords there, and Ctrl-C reaches all that it started.
bool has_terminal() {
  const OpenFile terminal(::open("/dev/tty", O_RDWR | O_NOCTTY | O_CLOEXEC));
  return terminal.descriptor >= 0 && ::tcgetpgrp(terminal.descriptor) == ::getpgrp();
}

/// \returns  as waitpid has it; -1, with errno, where nobody knows
int status_of(pid_t child) {
  int status = 0;
  pid_t ended = -1;
  while ((ended = ::waitpid(child, &status, 0)) < 0 && errno == EINTR) {
  }
  return ended == child ? status : -1;
}

extern "C" void end_own_group(int) {
  ::signal(SIGTERM, SIG_IGN);  // this one stays to wait for its shell
  ::kill(0, SIGTERM);
}

/// In the child: becomes a process group with the shell in it, which gets SIGTERM as a whole when the program ends, however it does.
/// \returns  in the shell's process alone
void begin_group() {
  sigset_t end;
  ::sigemptyset(&end);
  ::sigaddset(&end, SIGTERM);
  if (::setpgid(0, 0) != 0) return;         // the caller's group is not this one's to end
  ::sigprocmask(SIG_BLOCK, &end, nullptr);  // until the shell is in the group
  ::signal(SIGTERM, end_own_group);
  const pid_t shell = ::fork();
  if (shell == 0) ::signal(SIGTERM, SIG_DFL);
  ::sigprocmask(SIG_UNBLOCK, &end, nullptr);
  if (shell == 0) return;
  const int status = shell < 0 ? -1 : status_of(shell);
  if (status >= 0 && WIFSIGNALED(status)) {
    ::signal(WTERMSIG(status), SIG_DFL);
    ::kill(::getpid(), WTERMSIG(status));
  }
  constexpr int kUnknown = 127;
  ::_exit(status >= 0 && WIFEXITED(status) ? WEXITSTATUS(status) : kUnknown);
}

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

  /// Without a terminal the command and all that it starts are one process group, which ends with this program; at a terminal its shell
  /// ends with this program.
  /// \returns  as waitpid has it
  int run_shell(std::vector<std::string>& environment, const std::string& input) const {
    std::vector<char*> pointers;
    for (std::string& e : environment) pointers.push_back(e.data());
    pointers.push_back(nullptr);
    std::string shell = "/bin/sh", dash = "-c", command = command_;
    char* const arguments[] = {shell.data(), dash.data(), command.data(), nullptr};
    const OpenFile list(::open(input.c_str(), O_RDONLY | O_CLOEXEC));
    const WaitedFor waited;
    const bool terminal = has_terminal();
    const pid_t parent = ::getpid(), child = list.descriptor < 0 ? -1 : ::fork();
    if (child < 0)
      throw base::OutputError(std::string("the command that publishes could not be run: ") + std::strerror(errno));
    if (child == 0) become_shell(parent, terminal, list.descriptor, arguments, pointers.data());
    const int status = status_of(child);
    if (status < 0)
      throw base::OutputError(std::string("nobody knows how the command that publishes ended: ") +
                              std::strerror(errno) + ". Publish again, and it goes on with this call");
    return status;
  }

  [[noreturn]] static void become_shell(pid_t parent, bool terminal, int input, char* const* arguments,
                                        char* const* environment) {
    // The thread that waits for signals is not here.
    sigset_t none;
    ::sigemptyset(&none);
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) ::signal(number, SIG_DFL);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    constexpr int kNotRun = 127;  // as shells have it
    if (::getppid() != parent) ::_exit(kNotRun);
    if (!terminal) begin_group();
    ::dup2(input, STDIN_FILENO);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);  // what this program prints may be read by others
    ::execve(arguments[0], arguments, environment);
    ::_exit(kNotRun);
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
