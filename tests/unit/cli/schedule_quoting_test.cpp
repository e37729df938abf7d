// Each scheduler reads back what was written: sh by sh itself, systemd and cron by their documented rules.
#include "pipeline/cli/schedule_quoting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>

#include "pipeline/base/error.h"

namespace blockrand::cli {
namespace {

using testing::ElementsAre;

constexpr std::array kOdd = {
    "/srv/leipzig",   "/srv/two words/it's",   "/srv/a\"b\\c",   "/srv/100% $HOME `id` ;&|<>()*?[x]#~",
    "/srv/Köln/東京", "/srv/ends with space ", "/srv/%h/${x}/$$"};

std::string by_sh(const std::string& word) {
  const std::string command = "printf %s " + word;
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  std::string out;
  for (int c; (c = std::fgetc(pipe.get())) != EOF;) out += static_cast<char>(c);
  return out;
}

TEST(ScheduleQuoting, ShReadsWordsBack) {
  for (const char* text : kOdd) EXPECT_EQ(by_sh(quoted_for_sh(text)), text);
  EXPECT_EQ(quoted_for_sh("/srv/leipzig"), "/srv/leipzig");
  EXPECT_EQ(quoted_for_sh(""), "''");
}

/// Words of systemd.service(5): double quotes, backslash escapes in them, then %% for a percent sign.
std::vector<std::string> by_systemd(const std::string& line) {
  std::vector<std::string> words;
  std::string word;
  bool inside = false, any = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\\' && i + 1 < line.size()) {
      word += line[++i], any = true;
    } else if (line[i] == '"') {
      inside = !inside, any = true;
    } else if (line[i] == ' ' && !inside) {
      if (any) words.push_back(word);
      word.clear(), any = false;
    } else {
      word += line[i], any = true;
      if (line[i] != '%') continue;
      EXPECT_EQ(line.at(++i), '%') << "a specifier in " << line;
    }
  }
  if (any) words.push_back(word);
  EXPECT_FALSE(inside) << line;
  return words;
}

TEST(ScheduleQuoting, SystemdReadsWordsBack) {
  for (const char* text : kOdd) EXPECT_THAT(by_systemd(quoted_for_systemd(text)), ElementsAre(text));
  EXPECT_EQ(exec_line({"/bin/sh", "-c", "true"}), "/bin/sh -c true");
  EXPECT_THAT(by_systemd(exec_line({"/srv/a b/blockrand", "", "50%"})), ElementsAre("/srv/a b/blockrand", "", "50%"));
}

TEST(ScheduleQuoting, VariablesOfSystemdAreSwitchedOffWhereADollarStands) {
  EXPECT_EQ(exec_line({"/bin/sh", "-c", "echo $X"}), ":/bin/sh -c \"echo $X\"");
  EXPECT_EQ(exec_line({"/srv/it's/blockrand", "x"}),
            ":/bin/sh -c \"exec \\\"$0\\\" \\\"$@\\\"\" \"/srv/it's/blockrand\" x")
      << "systemd takes no program whose name has quotes";
  EXPECT_EQ(exec_line({"/bin/echo", ";"}), "/bin/echo \\;") << "a lone semicolon would begin another command";
}

TEST(ScheduleQuoting, WholeLinesOfSystemdRefuseWhatTheyCannotHold) {
  EXPECT_EQ(plain_for_systemd("/srv/100%/two words"), "/srv/100%%/two words");
  EXPECT_THROW(plain_for_systemd("/srv/space "), base::UsageError);
  EXPECT_THROW(plain_for_systemd("/srv/back\\"), base::UsageError);
}

TEST(ScheduleQuoting, UnitNamesAreEscapedAsSystemdDoes) {
  EXPECT_EQ(unit_name("leipzig-2.x"), "leipzig-2.x");
  EXPECT_EQ(unit_name("a b%ö"), "a\\x20b\\x25\\xc3\\xb6");  // systemd-escape
}

TEST(ScheduleQuoting, CronTakesPercentSignsBehindABackslash) {
  EXPECT_EQ(cron_command("date +%F"), "date +\\%F");
  EXPECT_EQ(cron_command("a\\b"), "a\\b");
  EXPECT_THROW(cron_command("a\\%b"), base::UsageError);
  EXPECT_THROW(cron_command("a\\\\b"), base::UsageError);
  EXPECT_NO_THROW(cron_command(std::string(990, 'x')));
  EXPECT_THROW(cron_command(std::string(991, 'x')), base::UsageError);
}

TEST(ScheduleQuoting, NamesOfKubernetesAreLabelsAndStayApart) {
  EXPECT_EQ(kubernetes_name("leipzig-2"), "leipzig-2");
  const std::string upper = kubernetes_name("Leipzig"), lower = kubernetes_name("leipzig");
  EXPECT_TRUE(upper.starts_with("leipzig-")) << upper;
  EXPECT_NE(upper, lower);
  EXPECT_NE(kubernetes_name("a b"), kubernetes_name("a_b"));
  for (const std::string& text :
       {std::string("東京"), std::string("-x-"), std::string(200, 'y'), std::string("a.b/c")}) {
    const std::string name = kubernetes_name(text);
    EXPECT_LE(name.size(), 40u);
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string::npos) << name;
    EXPECT_TRUE(name.front() != '-' && name.back() != '-') << name;
  }
}

TEST(ScheduleQuoting, ControlCharactersAndBrokenBytesAreRefused) {
  for (const char* text : kOdd) EXPECT_NO_THROW(check_text("path", text));
  for (const char* text : {"/srv/new\nline", "/srv/tab\t", "/srv/\xff", "/srv/\x7f"})
    EXPECT_THROW(check_text("path", text), base::UsageError);
}

}  // namespace
}  // namespace blockrand::cli
