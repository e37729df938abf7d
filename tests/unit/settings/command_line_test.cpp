#include "pipeline/settings/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "pipeline/base/error.h"
#include "pipeline/settings/command_text.h"
#include "pipeline/settings/config_file.h"

namespace blockrand::settings {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Settings build(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"in.osm", "-o", "out"});
  return read_command_line(kBuild, arguments).settings;
}

template <class F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const base::UsageError& error) {
    return std::string("usage: ") + error.what();
  } catch (const base::InputError& error) {
    return std::string("input: ") + error.what();
  }
  return "no error";
}
std::string build_error(const std::vector<std::string>& arguments) {
  return error_of([&] { build(arguments); });
}

TEST(CommandLine, FillsTheOptions) {
  const Settings s = build({"--lod=1", "--bbox", "-0.5,51,0.1,52", "-j", "4", "--ground-height", "-3.5", "--gzip", "-q",
                            "--formats", "citygml", "--repair-spike-width", "0.1", "--progress=plain"});
  EXPECT_EQ(s.build.input, "in.osm");
  EXPECT_EQ(s.build.output, "out");
  EXPECT_EQ(s.build.lod, 1);
  EXPECT_EQ((*s.build.bbox)[0], -0.5) << "a value may start with a minus";
  EXPECT_EQ(s.build.jobs, 4);
  EXPECT_EQ(s.build.ground_height, -3.5);
  EXPECT_TRUE(s.build.outputs.gzip);
  EXPECT_TRUE(s.quiet);
  EXPECT_FALSE(s.build.outputs.writes("gltf"));
  EXPECT_EQ(s.build.repair.spike_width, 0.1);
  EXPECT_EQ(s.progress, base::ProgressStyle::plain);
}

TEST(CommandLine, TheLastOfARepeatedOptionCounts) {
  EXPECT_EQ(build({"--jobs", "2", "--jobs", "3"}).build.jobs, 3);
  EXPECT_FALSE(build({"--force", "--no-force"}).build.force);
  EXPECT_TRUE(build({"--no-force", "--force"}).build.force);
}

TEST(CommandLine, FileNamesAreTakenAsTheyAre) {
  const Settings s = read_command_line(kBuild, {"[a,b]", "-o", "[x, y]"}).settings;
  EXPECT_EQ(s.build.input, "[a,b]");
  EXPECT_EQ(s.build.output, "[x, y]");
  EXPECT_EQ(read_command_line(kInfo, {"--", "--odd.osm"}).settings.build.input, "--odd.osm");
}

TEST(CommandLine, UnknownOptionsSuggestTheNearest) {
  EXPECT_THAT(build_error({"--fromats", "gltf"}),
              StartsWith("usage: unknown option --fromats. Did you mean --formats? Try 'blockrand build --help'."));
  EXPECT_THAT(build_error({"--job=3"}), StartsWith("usage: unknown option --job. Did you mean --jobs?"));
  EXPECT_EQ(build_error({"--somethingelse"}), "usage: unknown option --somethingelse. Try 'blockrand build --help'.");
  EXPECT_THAT(build_error({"-z"}), StartsWith("usage: unknown option -z. Try"));
  EXPECT_THAT(
      error_of([] {
        read_command_line(kInfo, {"in.osm", "--force"});
      }),
      AllOf(HasSubstr("--force is an option of build, compare, districts, grammar, view, which info does not read"),
            HasSubstr("'blockrand info --help'")));
}

TEST(CommandLine, OptionsThatAnActionWouldNotReadAreTold) {
  const CommandLine line = read_command_line(kGrammar, {"check", "a.cga", "--lot", "3x4"});
  const std::vector<Reader> readers = {{"lot", {"run", "test"}}, {"seed", {"run"}}};
  EXPECT_EQ(
      error_of([&] { refuse_unread(line, kGrammar, "check", readers); }),
      "usage: --lot is read by grammar run and grammar test, not by grammar check. Try 'blockrand grammar --help'.");
  EXPECT_EQ(error_of([&] { refuse_unread(line, kGrammar, "run", readers); }), "no error");
}

TEST(CommandLine, HelpOfACommandSaysWhatAnOptionIsToIt) {
  EXPECT_THAT(option_help(kBuild), Not(HasSubstr("districts diff")));
  EXPECT_THAT(option_help(kInfo), HasSubstr("of the build whose cost is told"));
  EXPECT_THAT(option_help(kUpdate), Not(HasSubstr("nothing is written")));
  // Each command of several that have an option hears of it, in one way or another, and of no other command.
  for (const Option& o : options())
    for (const auto& [commands, help] : o.help_of) {
      EXPECT_EQ(commands & ~o.commands, 0u) << o.name << ": help for a command that does not have it";
      EXPECT_FALSE(help.empty()) << o.name;
    }
}

TEST(CommandLine, WrongValuesNameTheOption) {
  EXPECT_THAT(build_error({"--jobs", "1025"}), StartsWith("usage: --jobs: 1025 is out of range. Write a whole"));
  EXPECT_THAT(build_error({"--progress", "bars"}), HasSubstr("Did you mean bar?"));
  EXPECT_THAT(build_error({"--jobs"}), HasSubstr("--jobs"));
  EXPECT_THAT(build_error({"second.osm"}), HasSubstr("unexpected argument second.osm: INPUT is in.osm already"));
  EXPECT_THAT(error_of([] { read_command_line(kBuild, {"-o", "x"}); }), HasSubstr("no INPUT"));
  EXPECT_THAT(error_of([] { read_command_line(kBuild, {"in.osm"}); }), HasSubstr("--output FOLDER"));
  EXPECT_EQ(error_of([] { read_command_line(kInfo, {"in.osm"}); }), "no error") << "info writes nothing";
}

TEST(CommandLine, CommandsHavePositionalArgumentsOfTheirOwn) {
  const Settings s = read_command_line(kExplain, {"out/town", "w123", "--json"}).settings;
  EXPECT_EQ(s.folder, "out/town");
  EXPECT_EQ(s.id, "w123");
  EXPECT_TRUE(s.json);
  EXPECT_THAT(error_of([] { read_command_line(kExplain, {"out"}); }),
              AllOf(HasSubstr("no building is named"), HasSubstr("'blockrand explain --help'")));
  EXPECT_THAT(error_of([] { read_command_line(kValidate, {}); }), HasSubstr("no FOLDER is given"));
  EXPECT_THAT(error_of([] { read_command_line(kValidate, {"out", "w1"}); }), HasSubstr("unexpected argument w1"));
}

TEST(CommandLine, HelpWinsOverEverything) {
  EXPECT_TRUE(read_command_line(kBuild, {"--help"}).help);
  EXPECT_TRUE(read_command_line(kBuild, {"-h", "--unknown"}).help);
}

TEST(CommandLine, HelpListsWhatTheCommandKnows) {
  EXPECT_THAT(option_help(kBuild), AllOf(HasSubstr("-o, --output FOLDER"), HasSubstr("[gltf,citygml,"),
                                         HasSubstr("--log-format"), testing::Not(HasSubstr("--json"))));
  EXPECT_THAT(option_help(kInfo), AllOf(HasSubstr("--json"), testing::Not(HasSubstr("--output"))));
  EXPECT_THAT(option_help(kBuild),
              AllOf(HasSubstr("      --no-report           no report.html"), testing::Not(HasSubstr("--report"))))
      << "what is on by default is shown by the name that changes something";
  for (std::size_t start = 0; start < option_help(kBuild).size();) {
    const std::string help = option_help(kBuild);
    const std::size_t end = help.find('\n', start);
    EXPECT_LE(end - start, 100u);
    start = end + 1;
  }
}

class Config : public testing::Test {
 protected:
  Config() : folder(fs::path(testing::TempDir()) / ("config." + std::to_string(getpid()))) {
    fs::create_directories(folder);
    path = folder / "c.toml";
  }
  ~Config() override { fs::remove_all(folder); }
  void write(const std::string& text) const { std::ofstream(path) << text; }
  std::string error(const std::string& text) const {
    write(text);
    return error_of([&] {
      Settings s;
      read_config(path, s);
    });
  }
  fs::path folder, path;
};

TEST_F(Config, SetsOptionsAndTheCommandLineIsStronger) {
  write(R"([build]
lod = 1
jobs = 7
gzip = true
formats = ["citygml"]
bbox = [12.3, 51.3, 12.4, 51.4]
terrain = "dem/a.tif"
[repair]
spike_width = 0.125
[generate]
neighbour_minimum = 5
)");
  const Settings s = build({"--config", path, "--lod", "0", "--no-gzip"});
  EXPECT_EQ(s.build.lod, 0);
  EXPECT_FALSE(s.build.outputs.gzip);
  EXPECT_EQ(s.build.jobs, 7);
  EXPECT_TRUE(s.build.outputs.writes("citygml"));
  EXPECT_FALSE(s.build.outputs.writes("gltf"));
  EXPECT_EQ((*s.build.bbox)[3], 51.4);
  EXPECT_EQ(s.build.terrain, folder / "dem/a.tif") << "relative paths start at the file's folder";
  EXPECT_EQ(s.build.repair.spike_width, 0.125);
  EXPECT_EQ(s.build.generate.neighbour_minimum, 5);
  EXPECT_EQ(s.config, path);
}

TEST_F(Config, MayNameInputAndOutput) {
  write("[build]\ninput = \"a.osm\"\noutput = \"/x/out\"\n");
  const Settings s = read_command_line(kBuild, {"--config", path}).settings;
  EXPECT_EQ(s.build.input, folder / "a.osm");
  EXPECT_EQ(s.build.output, "/x/out");
}

TEST_F(Config, ErrorsNameThePlaceAndTheNearestKey) {
  const std::string file = "input: " + path.string();
  EXPECT_THAT(error("[build]\nlodd = 1\n"), StartsWith(file + ":2:1: unknown key build.lodd. Did you mean build.lod?"));
  EXPECT_THAT(error("[biuld]\nlod = 1\n"), StartsWith(file + ":1:2: unknown key biuld. Did you mean build?"));
  EXPECT_THAT(error("lod = 1\n"), HasSubstr("Known keys here: build generate image repair."));
  EXPECT_THAT(error("[build]\nlod = 7\n"), StartsWith(file + ":2:7: build.lod is out of range: 7"));
  EXPECT_THAT(error("[build]\nlod = \"1\"\n"), HasSubstr("build.lod must be a whole number, not a text"));
  EXPECT_THAT(error("[build]\nformats = \"glft\"\n"),
              AllOf(StartsWith(file + ":2:11: build.formats is wrong: 'glft' is unknown"), HasSubstr("mean gltf?")));
  EXPECT_THAT(error("[build]\nbbox = [1, 2]\n"), HasSubstr("four numbers"));
  EXPECT_THAT(error("[build]\nforce = true\n"), HasSubstr("unknown key build.force")) << "force is asked for by hand";
  EXPECT_THAT(error("[build\n"), HasSubstr("not valid TOML"));
  EXPECT_THAT(build_error({"--config", "/nowhere.toml"}), StartsWith("input: /nowhere.toml: No such file"));
}

TEST_F(Config, TheTemplateIsAFileThatChangesNothing) {
  write(config_template());
  Settings s;
  read_config(path, s);
  std::string active = config_template();
  // With its keys taken out of their comments it sets every default.
  std::string text;
  std::istringstream lines(active);
  for (std::string line; std::getline(lines, line);) {
    const bool is_key =
        line.starts_with("# ") && line.find(" = ") != std::string::npos && line.find(' ', 2) == line.find(" = ");
    const bool empty_value = line.ends_with("\"\"");
    text += (is_key && !empty_value ? line.substr(2) : line) + "\n";
  }
  write(text);
  Settings set;
  read_config(path, set);
  const Settings fresh;
  for (const Option& o : options())
    if (o.type != OptionType::path) {
      EXPECT_EQ(o.show(set), o.show(fresh)) << o.name;
    }
  EXPECT_THAT(text, HasSubstr("\nneighbour_reach = 100\n"));
}

}  // namespace
}  // namespace blockrand::settings
