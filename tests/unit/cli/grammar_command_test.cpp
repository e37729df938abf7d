// The command `grammar`: exit codes, what it prints, files it writes.
#include "pipeline/cli/grammar_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "pipeline/base/error.h"
#include "pipeline/cli/exit_codes.h"

namespace blockrand::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class GrammarCommand : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("blockrand_grammar_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "project" / "rules");
    fs::create_directories(folder_ / "project" / "assets");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    const fs::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }
  static std::string read(const fs::path& path) {
    std::ostringstream out;
    out << std::ifstream(path, std::ios::binary).rdbuf();
    return out.str();
  }
  /// Exit code; what was printed is in out_ and error_.
  int run(const std::vector<std::string>& arguments) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_grammar(arguments);
    out_ = testing::internal::GetCapturedStdout();
    error_ = testing::internal::GetCapturedStderr();
    return code;
  }

  fs::path folder_;
  std::string out_, error_;
};

TEST_F(GrammarCommand, CheckIsQuietAboutGoodFiles) {
  write("project/assets/lib.cga", "Roof --> roofHip(30)");
  const std::string file = write("project/rules/good.cga", "import lib : \"lib.cga\"\nLot --> extrude(3) lib.Roof");
  EXPECT_EQ(run({"check", file}), kSuccess);
  EXPECT_EQ(error_, "");
  EXPECT_EQ(out_, "1 file checked: 0 errors, 0 warnings\n");
}

TEST_F(GrammarCommand, CheckTellsLikeACompiler) {
  const std::string bad = write("project/rules/bad.cga", "Lot --> extrude(3\n\nB --> s(1,\t\u00e4 + 2)");
  EXPECT_EQ(run({"check", bad, write("good.cga", "A --> exturde(3)")}), kInvalidInput);
  EXPECT_THAT(
      error_,
      HasSubstr(bad + ":3:1: error: expected ',' or ')', found 'B' [syntax]\n  B --> s(1,\t\u00e4 + 2)\n  ^\n"));
  EXPECT_THAT(error_, HasSubstr("good.cga:1:7: warning: "));
  EXPECT_EQ(out_, "2 files checked: 3 errors, 1 warning\n");
  EXPECT_EQ(run({"check", (folder_ / "none.cga").string()}), kInvalidInput);
}

TEST_F(GrammarCommand, RootsAreSearched) {
  const std::string file = write("main.cga", "import e : \"/ESRI.lib/e.cga\"\nimport l : \"l.cga\"\nA --> e.E l.L");
  write("project/e.cga", "E --> NIL");
  write("project/rules/l.cga", "L --> NIL");
  EXPECT_EQ(run({"check", file}), kInvalidInput);
  EXPECT_EQ(
      run({"check", "--roots", (folder_ / "project").string() + ",/ESRI.lib=" + (folder_ / "project").string(), file}),
      kSuccess)
      << error_;
}

TEST_F(GrammarCommand, ImportWritesAFileThatChecks) {
  const std::string xml =
      write("rules.xml",
            "<Rulefile name=\"r\"><Rule><Predecessor>FrontFacade</Predecessor><Rules><Probability value=\"1\">"
            "<Repeat axis=\"r\" size=\"3\"/><Symbol>Window1.wrl</Symbol></Probability></Rules></Rule></Rulefile>");
  const std::string target = (folder_ / "rules.cga").string();
  EXPECT_EQ(run({"import", xml, "-o", target}), kSuccess);
  EXPECT_THAT(read(target), HasSubstr("@StartRule\nFrontFacade -->"));
  EXPECT_EQ(run({"check", target}), kSuccess) << error_;
  EXPECT_THROW(run_grammar({"import", xml, "-o", target}), base::UsageError);
  EXPECT_EQ(run({"import", xml, "-o", target, "--force"}), kSuccess);
  EXPECT_EQ(run({"import", xml}), kSuccess);
  EXPECT_EQ(out_, read(target));
  EXPECT_THROW(run_grammar({"import", write("no.xml", "<a/>")}), base::InputError);
}

TEST_F(GrammarCommand, UsageIsTold) {
  EXPECT_THROW(run_grammar({}), base::UsageError);
  EXPECT_THROW(run_grammar({"check"}), base::UsageError);
  EXPECT_THROW(run_grammar({"chek", "a"}), base::UsageError);
  EXPECT_EQ(run({"--help"}), kSuccess);
  EXPECT_THAT(out_, HasSubstr("blockrand grammar"));
}

}  // namespace
}  // namespace blockrand::cli
