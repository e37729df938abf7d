// Help, manual page and completion scripts from the option table and command descriptions. How foreign programs read
// them (groff, mandoc, bash, zsh, fish) is tested in tests/end_to_end/install_test.py.
#include "pipeline/settings/manual.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "pipeline/settings/completion.h"
#include "pipeline/settings/options.h"

namespace blockrand::settings {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<CommandText> commands() {
  return {{.name = "build",
           .summary = "makes it",
           .usage = "INPUT -o FOLDER [options]",
           .description = "First sentence. Second one's here.\nAnother paragraph.",
           .options = kBuild,
           .examples = {{"blockrand build a.osm -o b", "that's all"}},
           .exit_codes = {{"0", "all well"}, {"3", "below quality"}, {"128 + N", "ended by signal N"}}},
          {.name = "help",
           .summary = "tells it",
           .usage = "[TOPIC]",
           .description = "Helps.",
           .topics = {{"words", "it's the words", {"--all", "--few"}}, {"shell", "for a shell", {"one", "two"}, true}},
           .takes_command = true,
           .exit_codes = {{"0", "all well"}, {"1", "wrong usage"}, {"3", "nothing found"}}}};
}

std::string page() {
  const ManualText text = {.version = "1.2.3",
                           .summary = "does what it does",
                           .description = ".starts with a dot\n'and with a quote",
                           .outputs = {{"a\\b", "a back slash"}},
                           .files = {{"~/x", "at home"}}};
  return manual(text, commands());
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Wrapped, BreaksAtSpaces) {
  EXPECT_THAT(wrapped("one two three", 7), ElementsAre("one two", "three"));
  EXPECT_THAT(wrapped("one two three", 8), ElementsAre("one two", "three"));
  EXPECT_THAT(wrapped("one", 3), ElementsAre("one"));
  EXPECT_THAT(wrapped("", 3), ElementsAre(""));
  EXPECT_THAT(wrapped("unbreakable", 4), Not(testing::IsEmpty())) << "and ends";
}

TEST(CommandHelp, HasEverythingInItsOrder) {
  const std::vector<CommandText> all = commands();
  const std::string build = command_help(all[0]);
  EXPECT_THAT(build, testing::StartsWith("Usage: blockrand build INPUT -o FOLDER [options]\n\nFirst sentence."));
  EXPECT_LT(build.find("Another paragraph."), build.find("\nWhat is built:\n"));
  EXPECT_LT(build.find("\nWhat is built:\n"), build.find("\nMessages:\n"));
  EXPECT_LT(build.find("\nMessages:\n"), build.find("blockrand help options\n"));
  EXPECT_THAT(build, HasSubstr("\nExamples:\n  blockrand build a.osm -o b\n      that's all\n"));
  EXPECT_THAT(build, testing::EndsWith("\nExit codes: 0 all well, 3 below quality, 128 + N ended by signal N.\n"));
  const std::string help = command_help(all[1]);
  EXPECT_THAT(help, AllOf(HasSubstr("  words [--all|--few]"), HasSubstr("  shell one|two "), HasSubstr("  COMMAND "),
                          Not(HasSubstr("help options"))));
}

TEST(ExitCodes, AreMergedAndNameTheirCommandsWhereTheyDiffer) {
  const std::vector<CommandText> all = commands();
  const std::vector<ExitCode> merged = merged_exit_codes(all);
  std::vector<std::string> rows;
  for (const ExitCode& code : merged) rows.push_back(code.code + ": " + code.meaning);
  EXPECT_THAT(rows, ElementsAre("0: all well", "1: wrong usage", "3: build: below quality; help: nothing found",
                                "128 + N: ended by signal N"));
}

TEST(Manual, EscapesWhatRoffWouldTakeForItself) {
  EXPECT_THAT(page(), HasSubstr("\n\\&.starts with a dot\n"));
  EXPECT_THAT(page(), HasSubstr("\n\\(aqand with a quote\n"));
  EXPECT_THAT(page(), HasSubstr("\\fBa\\eb\\fR"));
  EXPECT_THAT(page(), HasSubstr("\\fI\\(ti/x\\fR"));
  EXPECT_THAT(page(), HasSubstr("\\fB\\-o\\fR, \\fB\\-\\-output\\fR \\fIFOLDER\\fR"));
  const std::set<std::string> known = {".TH", ".SH", ".SS", ".TP", ".PP", ".br", ".ad", ".nh", ".\\\""};
  for (const std::string& line : lines_of(page())) {
    if (line[0] == '.') {
      EXPECT_TRUE(known.contains(line.substr(0, line.find(' ')))) << line;
    }
    EXPECT_NE(line[0], '\'') << line;
  }
}

TEST(Manual, HasEveryOptionOfItsCommandsWithDefaultRangeAndKey) {
  for (const Option& o : options())
    if (o.commands & kBuild) {
      std::string name = shown_name(o);
      for (std::size_t at = 0; (at = name.find('-', at)) != std::string::npos; at += 2) name.insert(at, 1, '\\');
      EXPECT_THAT(page(), HasSubstr(name)) << o.name;
    }
  EXPECT_THAT(page(), Not(HasSubstr("\\-\\-json"))) << "no command of these knows it";
  const std::string flat = [] {
    std::string text = page();
    for (char& c : text)
      if (c == '\n') c = ' ';
    return text;
  }();
  EXPECT_THAT(flat, HasSubstr("Default: 3. Range: 0 to 3. Key: lod. Commands: build."));
  EXPECT_THAT(flat, HasSubstr("Key: report = false."));
  EXPECT_THAT(page(), HasSubstr(".TH BLOCKRAND 1 \"\" \"blockrand 1.2.3\""));
}

TEST(Completion, KnowsCommandsTopicsOptionsAndValues) {
  for (const std::string& shell : completion_shells()) {
    const std::string script = completion(shell, commands());
    const std::string dashes = shell == "fish" ? "-l " : "--";
    EXPECT_THAT(script, AllOf(HasSubstr(dashes + "formats"), HasSubstr(dashes + "no-report"),
                              Not(HasSubstr(dashes + "json")), HasSubstr("gltf citygml"),
                              HasSubstr("auto bar plain none"), HasSubstr("shell"), HasSubstr("one two")))
        << shell;
    EXPECT_THAT(script, Not(HasSubstr(dashes + "report"))) << shell << ": it is on already";
    EXPECT_EQ(script, completion(shell, commands()));
  }
  EXPECT_THAT(completion("zsh", commands()), HasSubstr("'words:it'\\''s the words'"));
  EXPECT_THAT(completion("fish", commands()), HasSubstr("'it\\'s the words'"));
  EXPECT_THROW(completion("tcsh", commands()), std::invalid_argument);
}

}  // namespace
}  // namespace blockrand::settings
