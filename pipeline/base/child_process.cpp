#include "pipeline/base/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <map>
#include <new>
#include <string_view>

#include "pipeline/base/error.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/progress.h"

namespace blockrand::base {
namespace {

/// How a child's work ended.
enum class Ending : std::uint8_t { returned, usage, input, output, memory, bug };

struct Message {
  Ending ending = Ending::bug;
  std::string text;  ///< the result, or what was thrown
  std::vector<std::string> warnings;
};

void write_all(int to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(to, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;  // the parent is gone
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

[[noreturn]] void be_child(int to, pid_t parent, const ChildWork& work) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  // The thread that waited for signals is not here.
  sigset_t none;
  ::sigemptyset(&none);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) ::signal(number, SIG_DFL);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  Message message;
  constexpr std::string_view kWarning = "blockrand: warning: ";
  Progress progress(ProgressStyle::none, LogFormat::text, false, [&](std::string_view line) {
    if (!line.starts_with(kWarning)) return;
    line.remove_prefix(kWarning.size());
    while (line.ends_with('\n')) line.remove_suffix(1);
    message.warnings.emplace_back(line);
  });
  try {
    message.text = work(progress);
    message.ending = Ending::returned;
  } catch (const UsageError& error) {
    message.ending = Ending::usage, message.text = error.what();
  } catch (const InputError& error) {
    message.ending = Ending::input, message.text = error.what();
  } catch (const OutputError& error) {
    message.ending = Ending::output, message.text = error.what();
  } catch (const std::bad_alloc&) {
    message.ending = Ending::memory;
  } catch (const std::exception& error) {
    message.ending = Ending::bug, message.text = error.what();
  }
  write_all(to, packed(message));
  ::_exit(0);
}

struct Child {
  std::size_t index = 0;
  pid_t pid = 0;
  std::string bytes;
};

/// Kills those that still run.
struct Children {
  std::map<int, Child> by_pipe;
  ~Children() {
    for (const auto& [pipe, child] : by_pipe) {
      ::kill(child.pid, SIGKILL);
      ::waitpid(child.pid, nullptr, 0);
      ::close(pipe);
    }
  }
};

OutputError no_child(const std::string& name) {
  return OutputError(name + ": no process could be started: " + std::strerror(errno));
}

ChildResult result_of(const Child& child, const std::string& name) {
  int status = 0;
  rusage usage{};
  while (::wait4(child.pid, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status))
    throw OutputError(name + ": its process was ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
                      ::strsignal(WTERMSIG(status)) + ")" +
                      (WTERMSIG(status) == SIGKILL
                           ? ". Perhaps the machine had too little memory: give --memory-limit, or "
                             "fewer --jobs"
                           : ". Run again; what is done is kept"));
  Message message;
  try {
    message = unpacked<Message>(child.bytes);
  } catch (const UnpackError&) {
    throw OutputError(name + ": its process ended without a result");
  }
  switch (message.ending) {
    case Ending::usage:
      throw UsageError(message.text);
    case Ending::input:
      throw InputError(message.text);
    case Ending::output:
      throw OutputError(message.text);
    case Ending::memory:
      throw OutputError(name + ": not enough memory");
    case Ending::bug:
      throw std::runtime_error(name + ": " + message.text);
    case Ending::returned:
      break;
  }
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {std::move(message.text), std::move(message.warnings), static_cast<std::uint64_t>(usage.ru_maxrss) * 1024,
          seconds(usage.ru_utime) + seconds(usage.ru_stime)};
}

}  // namespace

void run_in_children(std::size_t count, std::size_t at_once,
                     const std::function<std::string(std::size_t, Progress&)>& work,
                     const std::function<void(std::size_t, ChildResult)>& done,
                     const std::function<std::string(std::size_t)>& name) {
  Children running;
  std::size_t next = 0;
  while (next < count || !running.by_pipe.empty()) {
    while (next < count && running.by_pipe.size() < std::max<std::size_t>(at_once, 1)) {
      int ends[2];
      if (::pipe2(ends, O_CLOEXEC) != 0) throw no_child(name(next));
      const pid_t parent = ::getpid(), pid = ::fork();
      if (pid < 0) throw no_child(name(next));
      if (pid == 0) {
        ::close(ends[0]);
        be_child(ends[1], parent, [&](Progress& progress) { return work(next, progress); });
      }
      ::close(ends[1]);
      running.by_pipe[ends[0]] = {next++, pid, {}};
    }
    std::vector<pollfd> waiting;
    for (const auto& [pipe, child] : running.by_pipe) waiting.push_back({pipe, POLLIN, 0});
    if (::poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR)
      throw OutputError(std::string("waiting for processes: ") + std::strerror(errno));
    for (const pollfd& ready : waiting) {
      if ((ready.revents & (POLLIN | POLLHUP | POLLERR)) == 0) continue;
      Child& child = running.by_pipe[ready.fd];
      char piece[1 << 16];
      const ssize_t n = ::read(ready.fd, piece, sizeof piece);
      if (n > 0) {
        child.bytes.append(piece, static_cast<std::size_t>(n));
      } else if (n == 0) {
        const Child ended = std::move(child);
        ::close(ready.fd);
        running.by_pipe.erase(ready.fd);
        done(ended.index, result_of(ended, name(ended.index)));
      } else if (errno != EINTR && errno != EAGAIN) {
        throw OutputError(std::string("reading from a process: ") + std::strerror(errno));
      }
    }
  }
}

ChildResult run_in_child(const std::string& name, const ChildWork& work) {
  ChildResult result;
  run_in_children(
      1, 1, [&](std::size_t, Progress& progress) { return work(progress); },
      [&](std::size_t, ChildResult r) { result = std::move(r); }, [&](std::size_t) { return name; });
  return result;
}

}  // namespace blockrand::base
