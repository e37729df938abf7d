#include "pipeline/base/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

namespace blockrand::base {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::Not;

struct Output {
  std::string text;
  Progress::Sink sink() {
    return [this](std::string_view part) { text += part; };
  }
};

TEST(Progress, PlainShowsOneLinePerEndedPhase) {
  Output out;
  Progress progress(ProgressStyle::plain, LogFormat::text, false, out.sink());
  progress.begin("read", 2000, "objects");
  progress.advance_to(2000);
  progress.begin("write");
  progress.end();
  EXPECT_THAT(out.text, MatchesRegex("read +2,000 objects.*s\nwrite +[0-9.]+ s\n"));
  ASSERT_EQ(progress.times().size(), 2u);
  EXPECT_EQ(progress.times()[0].name, "read");
  EXPECT_GE(progress.times()[0].seconds, 0);
}

TEST(Progress, BarIsRedrawnInPlaceAndWipedForMessages) {
  Output out;
  Progress progress(ProgressStyle::bar, LogFormat::text, false, out.sink());
  progress.begin("build", 10, "tiles");
  EXPECT_THAT(out.text, HasSubstr("\rbuild"));
  EXPECT_THAT(out.text, HasSubstr("0 %"));
  EXPECT_THAT(out.text, Not(HasSubstr("\n")));
  progress.warn("no terrain");
  EXPECT_THAT(out.text, HasSubstr("\x1b[Kblockrand: warning: no terrain\n"));
}

TEST(Progress, JsonIsOneObjectPerLine) {
  Output out;
  Progress progress(ProgressStyle::automatic, LogFormat::json, false, out.sink());
  progress.begin("read", 5, "objects");
  progress.advance_to(5);
  progress.end();
  progress.error("a \"bad\" file");
  EXPECT_THAT(out.text, MatchesRegex("\\{\"time\":\"[0-9TZ:-]+\",\"level\":\"progress\",\"phase\":\"read\",\"done\":5,"
                                     "\"total\":5,\"unit\":\"objects\",\"seconds\":[0-9.]+,\"ended\":true\\}\n"
                                     "\\{\"time\":\"[0-9TZ:-]+\",\"level\":\"error\",\"message\":\"a \\\\\"bad\\\\\" "
                                     "file\"\\}\n"));
}

TEST(Progress, NoneKeepsMessagesAndTimes) {
  Output out;
  Progress progress(ProgressStyle::none, LogFormat::text, false, out.sink());
  progress.begin("read", 5, "objects");
  progress.advance_to(5);
  progress.end();
  EXPECT_THAT(out.text, IsEmpty());
  EXPECT_EQ(progress.times().size(), 1u);
  progress.error("gone");
  EXPECT_EQ(out.text, "blockrand: error: gone\n");
}

TEST(Progress, QuietDropsPhasesButNoWarning) {
  Output out;
  Progress progress(ProgressStyle::plain, LogFormat::text, true, out.sink());
  progress.begin("read", 5, "objects");
  progress.end();
  progress.warn("careful");
  EXPECT_EQ(out.text, "blockrand: warning: careful\n");
}

TEST(Progress, TakesCallsFromSeveralThreads) {
  Output out;
  Progress progress(ProgressStyle::plain, LogFormat::text, false, out.sink());
  progress.begin("build", 4000, "tiles");
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&progress, t] {
      for (int i = 1; i <= 1000; ++i) progress.advance_to(static_cast<std::uint64_t>(t * 1000 + i));
    });
  for (auto& thread : threads) thread.join();
  progress.end();
  EXPECT_THAT(out.text, HasSubstr("4,000 tiles")) << "late smaller numbers do not count";
}

}  // namespace
}  // namespace blockrand::base
