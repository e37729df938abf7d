// Errors, signals, configs and help: the parts of the program around its commands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <new>
#include <sstream>
#include <thread>

#include "pipeline/base/error.h"
#include "pipeline/base/publish.h"
#include "pipeline/cli/build_command.h"
#include "pipeline/cli/command.h"
#include "pipeline/cli/configs_folder.h"
#include "pipeline/cli/errors.h"
#include "pipeline/cli/help.h"
#include "pipeline/cli/info_command.h"
#include "pipeline/cli/signals.h"

namespace blockrand::cli {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

struct Outcome {
  int code = 0;
  std::string out, err;
};

template <class F>
Outcome outcome(F&& f, base::LogFormat format = base::LogFormat::text) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Outcome o;
  o.code = guarded(format, f);
  std::fflush(stdout);
  o.out = testing::internal::GetCapturedStdout();
  o.err = testing::internal::GetCapturedStderr();
  return o;
}

TEST(Errors, BecomeMessagesAndExitCodes) {
  const auto run = [](auto error) { return outcome([&]() -> int { throw error; }); };
  Outcome o = run(base::UsageError("bad option."));
  EXPECT_EQ(o.code, 1);
  EXPECT_EQ(o.err, "blockrand: error: bad option.\n");
  o = run(base::InputError("a.osm", "3", "broken", "Mend it."));
  EXPECT_EQ(o.code, 2);
  EXPECT_EQ(o.err, "blockrand: error: a.osm:3: broken. Mend it.\n");
  EXPECT_EQ(run(base::OutputError("disk full")).code, 4);
  o = run(std::bad_alloc());
  EXPECT_EQ(o.code, 4);
  EXPECT_THAT(o.err, HasSubstr("--jobs"));
  o = run(std::logic_error("index"));
  EXPECT_EQ(o.code, 4);
  EXPECT_THAT(o.err, HasSubstr("internal error: index"));
}

TEST(Errors, AreJsonWhereLogsAre) {
  EXPECT_EQ(early_log_format({"in.osm", "--log-format", "json", "--bogus"}), base::LogFormat::json);
  EXPECT_EQ(early_log_format({"--log-format=json"}), base::LogFormat::json);
  EXPECT_EQ(early_log_format({"--log-format"}), base::LogFormat::text);
  const Outcome o = outcome([]() -> int { throw base::UsageError("x"); }, base::LogFormat::json);
  EXPECT_THAT(o.err, AllOf(StartsWith("{\"time\":"), HasSubstr("\"level\":\"error\",\"message\":\"x\"}\n")));
}

TEST(Help, EveryCommandHasExamplesAndExitCodes) {
  EXPECT_GE(commands().size(), 3u);
  for (const Command& command : commands()) {
    const std::string help = settings::command_help(command.text);
    EXPECT_THAT(help, StartsWith("Usage: blockrand " + command.text.name + " "));
    EXPECT_THAT(help, HasSubstr("\nExamples:\n  blockrand " + command.text.name));
    EXPECT_THAT(help, HasSubstr("\nExit codes: 0 all well"));
    EXPECT_THAT(general_help(), HasSubstr("\n  " + command.text.name + " "));
    EXPECT_LE(command.text.summary.size(), 80u);
    EXPECT_EQ(outcome([&] { return run_help({command.text.name}); }).out, help);
    EXPECT_EQ(outcome([&] { return command.run({"--help"}); }).out, help);
    EXPECT_EQ(outcome([&] { return command.run({"-h"}); }).out, help);
    EXPECT_EQ(find_command(command.text.name), &command);
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  }
  EXPECT_EQ(find_command("biuld"), nullptr);
  EXPECT_THAT(general_help(), HasSubstr("Exit codes: 0 all well, 1 wrong usage, 2 "));
  EXPECT_THAT(version_text(), StartsWith("blockrand "));
}

TEST(Help, KnowsItsTopics) {
  EXPECT_THAT(outcome([] { return run_help({"codes"}); }).out, HasSubstr("OPEN_WAY"));
  EXPECT_THAT(outcome([] { return run_help({"options", "--toml"}); }).out, HasSubstr("[build]"));
  EXPECT_THAT(outcome([] { return run_help({"options", "--markdown"}); }).out, StartsWith("# Options"));
  const Outcome o = outcome([] { return run_help({"optoins"}); });
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(o.err, HasSubstr("Did you mean options?"));
  EXPECT_EQ(outcome([] { return run_help({"build", "x"}); }).code, 1);
  EXPECT_THAT(outcome([] { return run_help({"man"}); }).out, HasSubstr(".TH BLOCKRAND 1"));
  for (const char* shell : {"bash", "zsh", "fish"})
    EXPECT_THAT(outcome([&] { return run_help({"completion", shell}); }).out, HasSubstr("for " + std::string(shell)));
  EXPECT_THAT(outcome([] { return run_help({"completion"}); }).err, HasSubstr("Known: bash, zsh, fish."));
  EXPECT_THAT(outcome([] { return run_help({"completion", "tcsh"}); }).err, HasSubstr("unknown tcsh"));
  EXPECT_THAT(outcome([] { return run_help({"options", "--html"}); }).err, HasSubstr("Known: --markdown, --toml."));
}

TEST(Info, AMissingFileIsInvalidInput) {
  const Outcome o = outcome([] { return run_info({"/nowhere/x.osm.pbf", "--progress=none"}); });
  EXPECT_EQ(o.code, 2);
  EXPECT_THAT(o.err, HasSubstr("/nowhere/x.osm.pbf"));
}

class Configs : public testing::Test {
 protected:
  Configs() {
    std::string pattern = testing::TempDir() + "configs.XXXXXX";
    here = mkdtemp(pattern.data());
  }
  ~Configs() override { fs::remove_all(here); }
  fs::path place(const fs::path& folder) const {
    for (const char* file : {"defaults/uses.toml", "materials/materials.toml"}) {
      fs::create_directories((here / folder / file).parent_path());
      std::ofstream(here / folder / file) << "";
    }
    return here / folder;
  }
  fs::path here;
};

TEST_F(Configs, LieBesideTheProgramOrBelowItsPrefix) {
  const fs::path program = here / "usr/bin/blockrand";
  const fs::path installed = place("usr/share/blockrand/configs");
  EXPECT_EQ(configs_folder("", program), installed);
  const fs::path mine = place("mine");
  EXPECT_EQ(configs_folder(mine, program), mine) << "--configs is stronger";
  const fs::path beside = place("usr/bin/configs");
  EXPECT_EQ(configs_folder("", program), beside) << "a build tree's link to the source tree is stronger";
}

TEST_F(Configs, AreNotSoughtAnywhereElse) {
  place("configs");
  place("usr/configs");
  try {
    configs_folder("", here / "usr/bin/blockrand");
    FAIL() << "a folder above the prefix was taken";
  } catch (const base::UsageError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr((here / "usr/bin/configs").string()),
                      HasSubstr((here / "usr/share/blockrand/configs").string()), HasSubstr("--configs")));
  }
  EXPECT_THROW(configs_folder("/nowhere", program_file()), base::UsageError) << "no fallback for a wrong --configs";
  EXPECT_EQ(program_file().filename(), "test_cli");
}

class Signals : public testing::TestWithParam<int> {};

TEST_P(Signals, RemoveTheUnfinishedBuildAndKeepTheOldOne) {
  std::string pattern = testing::TempDir() + "signals.XXXXXX";
  const fs::path here = mkdtemp(pattern.data()), target = here / "out";
  {
    base::StagedFolder old(target, false);
    old.write("build.json", "old");
    old.publish();
  }
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    if (!freopen("/dev/null", "w", stderr)) _exit(99);
    signal(GetParam(), SIG_DFL);
    clean_up_on_signals(base::LogFormat::text);
    base::StagedFolder folder(target, true);
    folder.write("half", "x");
    if (write(ready[1], "r", 1) != 1) _exit(98);
    for (int i = 0;; ++i) folder.write(std::to_string(i % 100), "y");
  }
  char c = 0;
  ASSERT_EQ(read(ready[0], &c, 1), 1);
  kill(child, GetParam());
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 128 + GetParam());
  EXPECT_EQ(std::distance(fs::directory_iterator(here), {}), 1);
  EXPECT_TRUE(fs::exists(target / "build.json"));
  fs::remove_all(here);
  close(ready[0]);
  close(ready[1]);
}

INSTANTIATE_TEST_SUITE_P(All, Signals, testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST(IgnoredSignals, ThatTheEnvironmentIgnoresStayIgnored) {
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGHUP, SIG_IGN);  // nohup
    clean_up_on_signals(base::LogFormat::text);
    raise(SIGHUP);
    kill(getpid(), SIGHUP);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    _exit(7);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

}  // namespace
}  // namespace blockrand::cli
