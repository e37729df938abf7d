#include "pipeline/cli/signals.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <string>
#include <thread>

#include "pipeline/base/publish.h"
#include "pipeline/cli/exit_codes.h"

namespace blockrand::cli {

void clean_up_on_signals(base::LogFormat format) {
  signal(SIGXFSZ, SIG_IGN);
  signal(SIGPIPE, SIG_IGN);
  sigset_t watched;
  sigemptyset(&watched);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    if (sigaction(number, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) sigaddset(&watched, number);
  }
  // Threads inherit the mask: only the one that waits below ever sees these signals, and may do anything.
  pthread_sigmask(SIG_BLOCK, &watched, nullptr);
  std::thread([watched, format] {
    int number = 0;
    if (sigwait(&watched, &number) != 0) return;
    pthread_sigmask(SIG_UNBLOCK, &watched, nullptr);
    base::abandon_staged_folders();
    const char text[] = "interrupted; the unfinished build was removed, an earlier one is as it was";
    const std::string line = format == base::LogFormat::json
                                 ? std::string("{\"level\":\"error\",\"message\":\"") + text + "\"}\n"
                                 : std::string(isatty(STDERR_FILENO) ? "\r\x1b[K" : "") + "blockrand: " + text + "\n";
    if (write(STDERR_FILENO, line.data(), line.size()) < 0) {
      // Nobody listens: the exit code says it.
    }
    _exit(kSignalBase + number);
  }).detach();
}

}  // namespace blockrand::cli
