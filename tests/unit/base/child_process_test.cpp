// Work in processes of their own: results, warnings and errors come back in words, and a death is told.
#include "pipeline/base/child_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <map>
#include <set>

#include "pipeline/base/error.h"
#include "pipeline/base/progress.h"

namespace blockrand::base {
namespace {

std::string named(std::size_t i) { return "piece " + std::to_string(i); }

TEST(ChildProcess, EveryPieceSendsItsResultOnce) {
  for (const std::size_t at_once : {0, 1, 3, 50}) {
    std::map<std::size_t, std::string> results;
    run_in_children(
        20, at_once, [](std::size_t i, Progress&) { return std::string(i * 10'000, static_cast<char>('a' + i)); },
        [&](std::size_t i, ChildResult r) { EXPECT_TRUE(results.emplace(i, std::move(r.bytes)).second); }, named);
    ASSERT_EQ(results.size(), 20u);
    for (const auto& [i, bytes] : results) EXPECT_EQ(bytes, std::string(i * 10'000, static_cast<char>('a' + i)));
  }
}

TEST(ChildProcess, NoneIsNoWork) {
  run_in_children(
      0, 2, [](std::size_t, Progress&) { return std::string(); }, [](std::size_t, ChildResult) { FAIL(); }, named);
}

TEST(ChildProcess, ItIsAnotherProcess) {
  const ChildResult result = run_in_child("one", [](Progress&) { return std::to_string(::getpid()); });
  EXPECT_NE(result.bytes, std::to_string(::getpid()));
  EXPECT_GT(result.peak_rss_bytes, 0u);
}

TEST(ChildProcess, WarningsComeBackInTheirOrder) {
  const ChildResult result = run_in_child("one", [](Progress& progress) {
    progress.begin("phase");
    progress.warn("first");
    progress.warn("second, of\ntwo lines");
    return std::string("done");
  });
  EXPECT_EQ(result.bytes, "done");
  EXPECT_EQ(result.warnings, (std::vector<std::string>{"first", "second, of\ntwo lines"}));
}

template <class Error>
void throws(const ChildWork& work, const std::string& words) {
  try {
    run_in_child("the piece", work);
    FAIL() << words;
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), words);
  }
}

TEST(ChildProcess, ErrorsKeepTheirKindAndWords) {
  throws<UsageError>([](Progress&) -> std::string { throw UsageError("wrong"); }, "wrong");
  throws<InputError>([](Progress&) -> std::string { throw InputError("f.osm", "byte 3", "is cut off", "Fetch it"); },
                     "f.osm:byte 3: is cut off. Fetch it");
  throws<OutputError>([](Progress&) -> std::string { throw OutputError("disk full"); }, "disk full");
  throws<OutputError>([](Progress&) -> std::string { throw std::bad_alloc(); }, "the piece: not enough memory");
  throws<std::runtime_error>([](Progress&) -> std::string { throw std::logic_error("a bug"); }, "the piece: a bug");
}

TEST(ChildProcess, ADeathIsTold) {
  for (const int number : {SIGKILL, SIGSEGV}) try {
      run_in_child("the piece", [&](Progress&) -> std::string {
        ::signal(number, SIG_DFL);
        ::raise(number);
        return "";
      });
      FAIL();
    } catch (const OutputError& error) {
      EXPECT_NE(std::string(error.what()).find("the piece: its process was ended by signal " + std::to_string(number)),
                std::string::npos)
          << error.what();
    }
  EXPECT_THROW(run_in_child("the piece", [](Progress&) -> std::string { ::_exit(3); }), OutputError);
}

TEST(ChildProcess, OneThatFailsStopsTheOthers) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THROW(run_in_children(
                   3, 3,
                   [](std::size_t i, Progress&) -> std::string {
                     if (i == 1) throw InputError("x");
                     ::sleep(60);
                     return "";
                   },
                   [](std::size_t, ChildResult) {}, named),
               InputError);
  // Not a measure: waiting for the sleepers would take a minute.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(50));
}

}  // namespace
}  // namespace blockrand::base
