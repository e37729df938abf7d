#include "pipeline/cli/view_command.h"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "pipeline/base/error.h"
#include "pipeline/base/markup.h"
#include "pipeline/base/text.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/settings/command_line.h"
#include "pipeline/view/export_site.h"
#include "pipeline/view/server.h"

extern char** environ;

namespace blockrand::cli {
namespace {

constexpr int kUsualPort = 8712;

/// SIGINT, SIGTERM and SIGHUP, unless the caller's environment ignores them: blocked here and in every thread to come.
struct Signals {
  sigset_t watched{}, before{};
};
Signals take_over_signals() {
  Signals signals;
  sigemptyset(&signals.watched);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    if (sigaction(number, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) sigaddset(&signals.watched, number);
  }
  pthread_sigmask(SIG_BLOCK, &signals.watched, &signals.before);
  return signals;
}

/// Some desktops' opener is the browser itself: nobody waits for it but the thread that started it.
void open_in_browser(std::string url, const sigset_t& before) {
  std::string program = "xdg-open";
  char* const arguments[] = {program.data(), url.data(), nullptr};
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setsigmask(&attributes, &before);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t child = 0;
  int status = 0;
  const bool started = ::posix_spawnp(&child, program.c_str(), nullptr, &attributes, arguments, environ) == 0;
  posix_spawnattr_destroy(&attributes);
  if (!started || ::waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    std::fprintf(stderr, "blockrand: warning: no browser could be started: open %s yourself\n", url.c_str());
}

int bind(view::Server& server, int asked) {
  if (asked > 0) {
    if (const int port = server.bind(asked)) return port;
    throw base::UsageError(
        fmt::format("--port {} is taken, or may not be used. Choose another one, or leave it out.", asked));
  }
  for (const int port : {kUsualPort, 0})
    if (const int bound = server.bind(port)) return bound;
  throw base::OutputError("127.0.0.1 has no free port");
}

void tell(const settings::Settings& s, std::string_view key, const std::string& value, const std::string& text) {
  if (s.log_format == base::LogFormat::json) {
    std::string line = fmt::format("{{\"level\":\"info\",\"{}\":", key);
    base::append_json(line, value);
    std::printf("%s}\n", line.c_str());
  } else {
    std::printf("%s\n", text.c_str());
  }
  std::fflush(stdout);
}

}  // namespace

settings::CommandText view_text() {
  return {
      .name = "view",
      .summary = "shows a build in the browser, on this machine",
      .usage = "FOLDER [options]",
      .description =
          "Serves a page on which one flies over the model or walks through its streets, sees why a house looks as it "
          "does, colours houses by style, era or source, and searches them by address. FOLDER is a build, or a region, "
          "whose published build is shown. Nobody but this machine is answered, nothing is loaded from elsewhere, and "
          "no file outside of the build is read. Ctrl-C ends it.",
      .options = settings::kView,
      .examples = {{"blockrand view out/leipzig", ""},
                   {"blockrand view out/leipzig --open", "in the browser of this desktop"},
                   {"blockrand view out/leipzig --export site", "files for any web server"}},
      .exit_codes = {{"0", "all well"},
                     {"1", "wrong usage"},
                     {"2", "unreadable or invalid input"},
                     {"4", "output could not be written or internal error"}}};
}

int run_view(const std::vector<std::string>& arguments) {
  const settings::CommandLine line = settings::read_command_line(settings::kView, arguments);
  if (line.help) {
    std::fputs(settings::command_help(view_text()).c_str(), stdout);
    return kSuccess;
  }
  const settings::Settings& s = line.settings;
  if (!s.site.empty() && (s.open || s.port > 0))
    throw base::UsageError(
        fmt::format("--export writes files and serves nothing: leave out {}", s.open ? "--open" : "--port"));
  if (s.site.empty() && s.build.force)
    throw base::UsageError("--force replaces what --export wrote: without --export nothing is written");
  const view::Site site(s.folder);
  site.description();  // a damaged build is told now, not by the page
  if (!s.site.empty()) {
    const view::ExportFigures figures = view::export_site(site, s.site, s.build.force);
    if (!s.quiet)
      tell(s, "site", s.site,
           fmt::format(
               "{}: {} files, {}. It needs a web server, any will do; for a mail, report.html of the build is right.",
               s.site, base::with_thousands(figures.files), base::with_byte_unit(figures.bytes)));
    return kSuccess;
  }
  const Signals signals = take_over_signals();
  view::Server server(site);
  const std::string url = fmt::format("http://127.0.0.1:{}/", bind(server, s.port));
  std::thread([watched = signals.watched, &server] {
    int number = 0;
    if (sigwait(&watched, &number) != 0) return;
    std::thread([&server] { server.stop(); }).detach();
    // Clients may hold connections open for long. Nothing is written that could be left half done.
    std::this_thread::sleep_for(std::chrono::seconds(2));
    _exit(kSuccess);
  }).detach();
  tell(s, "url", url, fmt::format("{} is at {}\nCtrl-C ends it.", s.folder, url));
  if (s.open) std::thread(open_in_browser, url, signals.before).detach();
  server.run();
  return kSuccess;
}

}  // namespace blockrand::cli
