// grammar run and grammar test as the program calls them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "pipeline/base/error.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/grammar_command.h"

namespace blockrand::cli {
namespace {

using testing::HasSubstr;

class GrammarRun : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / "blockrand_grammar_run";
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  std::string read(const std::string& path) const {
    std::ostringstream out;
    out << std::ifstream(path, std::ios::binary).rdbuf();
    return out.str();
  }
  /// What the command prints; its exit code in `code`.
  std::string run(const std::vector<std::string>& arguments) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    code = run_grammar(arguments);
    errors = testing::internal::GetCapturedStderr();
    return testing::internal::GetCapturedStdout();
  }
  std::filesystem::path folder_;
  int code = 0;
  std::string errors;
};

constexpr const char* kHouse =
    "// expect: lot 10x20; volume 1000; report h sum 5\n"
    "// expect: lot 10x20; attr height=3; volume 600\n"
    "attr height = 5\n"
    "Lot --> report(\"h\", height) print(building.storeys) color(\"#ff0000\") extrude(height) House.\n";

TEST_F(GrammarRun, PrintsReportsLeavesAndWritesTheModel) {
  const std::string file = write("house.cga", kHouse), glb = (folder_ / "house.glb").string();
  const std::string out =
      run({"run", file, "--lot", "10x20", "--storeys", "4", "--attr", "height=6", "-o", glb, "--tree"});
  EXPECT_EQ(code, kSuccess) << errors;
  EXPECT_THAT(out, HasSubstr("4\n"));
  EXPECT_THAT(out, HasSubstr("6.000"));
  EXPECT_THAT(out, HasSubstr("1 leaves of 2 shapes"));
  EXPECT_THAT(out, HasSubstr("0;0; House. (10 x 6 x 20)"));
  const std::string model = read(glb);
  EXPECT_EQ(model.substr(0, 4), "glTF");
  EXPECT_THAT(model, HasSubstr("\"count\":36")) << "a box has twelve triangles";
  EXPECT_THAT(model, HasSubstr("\"max\":[10"));
  EXPECT_THAT(model, HasSubstr("#ff0000ff"));
}

TEST_F(GrammarRun, TellsWhatIsWrong) {
  const std::string file = write("wrong.cga", "Lot --> color(\"red\") X.");
  run({"run", file});
  EXPECT_EQ(code, kInvalidInput);
  EXPECT_THAT(errors, HasSubstr(":1:9"));
  run({"run", (folder_ / "nothing.cga").string()});
  EXPECT_EQ(code, kInvalidInput);
  EXPECT_THROW(run_grammar({"run", file, "--lot", "3"}), base::UsageError);
  EXPECT_THROW(run_grammar({"run", file, "--seed", "x"}), base::UsageError);
  EXPECT_THROW(run_grammar({"run", file, "--attr", "x"}), base::UsageError);
  EXPECT_THROW(run_grammar({"run", file, "--colour"}), base::UsageError);
  EXPECT_THROW(run_grammar({"run", file, "--lot"}), base::UsageError);
  EXPECT_THROW(run_grammar({"run"}), base::UsageError);
  EXPECT_THROW(run_grammar({"test"}), base::UsageError);
  EXPECT_THROW(run_grammar({"run", file, "-o", (folder_ / "none" / "a.glb").string()}), base::OutputError);
}

TEST_F(GrammarRun, ReadsFilesBesideTheRules) {
  write("heights.csv", "3,4\n5,6\n");
  std::filesystem::create_directories(folder_ / "assets");
  write("assets/brick.jpg", "");
  write("assets/stone.jpg", "");
  const std::string file =
      write("files.cga",
            "Lot --> print(readFloatTable(\"heights.csv\")[1, 0]) print(fileExists(\"brick.jpg\"))\n"
            "print(fileSearch(\"*.jpg\")) print(fileExists(\"../files.cga\")) X.");
  EXPECT_THAT(run({"run", file}), HasSubstr("5\ntrue\nbrick.jpg;stone.jpg;\nfalse\n"));
  EXPECT_EQ(code, kSuccess) << errors;
}

TEST_F(GrammarRun, SearchesForFilesEndAndTellWhatTheyDoNotUnderstand) {
  std::filesystem::create_directories(folder_ / "assets");
  write("assets/" + std::string(60, 'a') + ".jpg", "");
  write("assets/stone(1).JPG", "");
  // A matcher that goes back would try each way to share the letters.
  const std::string rules =
      "Lot --> print(fileSearch(\"$(a+)+b\")) print(fileRandom(\"$(a|aa)+$b\"))\n"
      "print(len(filesSearch(\"*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*b\")[0]))\n"
      "print(fileSearch(\"STONE(?).jpg\")) print(fileSearch(\"$sto.*[(]1[)].jpg\")) X.";
  EXPECT_THAT(run({"run", write("ends.cga", rules)}),
              HasSubstr("placeholder;\nplaceholder\n11\nstone(1).JPG;\nstone(1).JPG;\n"));
  EXPECT_EQ(code, kSuccess) << errors;
  for (const std::string name : {"fileSearch", "filesSearch", "fileRandom"}) {
    run({"run", write("wrong.cga", "Lot -->\n  print(" + name + "(\"$(a\")) X.")});
    EXPECT_EQ(code, kInvalidInput) << name;
    EXPECT_THAT(errors, HasSubstr("wrong.cga:2:9: error: '(a' is no pattern that is understood here")) << name;
  }
}

TEST_F(GrammarRun, SeveralAttributesAndTheirOrder) {
  const std::string file = write("a.cga", "attr a = 1\nattr b = 2\nLot --> print(a + b) X.");
  EXPECT_THAT(run({"run", "--attr", "a=10", "--attr", "b=20", file}), HasSubstr("30\n"));
  EXPECT_THAT(run({"run", file, "--attr", "a=10"}), HasSubstr("12\n"));
}

TEST_F(GrammarRun, TheSeedReachesConsistentChoices) {
  for (const std::string kind : {"building", "row"}) {
    const std::string file = write("tiles.cga", "@Consistent(\"" + kind + "\")\nLot --> 50% : A. else : B.");
    std::set<std::string> seen;
    for (int seed = 0; seed < 40; ++seed) seen.insert(run({"run", file, "--seed", std::to_string(seed)}));
    EXPECT_EQ(seen.size(), 2u) << kind;
  }
}

TEST_F(GrammarRun, ChecksNamesThatTheProgramGives) {
  run({"check", write("context.cga", "Lot --> case building.storys > 3 && edge.kind == \"street\" : A. else : B.")});
  EXPECT_EQ(code, kInvalidInput);
  EXPECT_THAT(errors, HasSubstr("'building.storys'; did you mean 'building.storeys'? [unknown_context]"));
  EXPECT_THAT(errors, testing::Not(HasSubstr("edge.kind'")));
  run({"check", write("own.cga", "Lot --> blockrand.window(\"caesment\")")});
  EXPECT_EQ(code, kInvalidInput);
  EXPECT_THAT(errors, HasSubstr("unknown_kind"));
}

TEST_F(GrammarRun, TestsExpectations) {
  const std::string file = write("house.cga", std::string(kHouse) + "// expect: attr building.storeys=1; leaves 2\n");
  const std::string out = run({"test", file});
  EXPECT_EQ(code, kInvalidInput);
  EXPECT_THAT(out, HasSubstr("house.cga:5: the number of leaves is 1, not 2"));
  const std::string good = write("good.cga", "// expect: leaves 1\nLot --> X.");
  EXPECT_THAT(run({"test", good}), HasSubstr("1 of 1 expectations hold"));
  EXPECT_EQ(code, kSuccess);
}

}  // namespace
}  // namespace blockrand::cli
