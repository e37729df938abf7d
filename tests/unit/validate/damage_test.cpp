// Whatever happens to the files of a build, validate ends with findings: it neither crashes nor throws.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "pipeline/base/error.h"
#include "pipeline/run/build.h"
#include "pipeline/validate/validate_build.h"

namespace blockrand::validate {
namespace {

namespace fs = std::filesystem;

/// Three houses, one of them in two parts, and one that cannot be built.
constexpr const char* kTown = R"(<osm version="0.6">
<node id="1" lat="51.4700" lon="11.0300"/><node id="2" lat="51.4700" lon="11.0302"/>
<node id="3" lat="51.4701" lon="11.0302"/><node id="4" lat="51.4701" lon="11.0300"/>
<node id="5" lat="51.4700" lon="11.0304"/><node id="6" lat="51.4701" lon="11.0304"/>
<node id="7" lat="51.4703" lon="11.0300"/><node id="8" lat="51.4703" lon="11.0303"/>
<node id="9" lat="51.4705" lon="11.0303"/><node id="10" lat="51.4705" lon="11.0300"/>
<node id="11" lat="51.4705" lon="11.03015"/><node id="12" lat="51.4703" lon="11.03015"/>
<way id="21"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/><tag k="building" v="house"/><tag k="building:levels" v="2"/></way>
<way id="22"><nd ref="2"/><nd ref="5"/><nd ref="6"/><nd ref="3"/><nd ref="2"/><tag k="building" v="house"/></way>
<way id="23"><nd ref="7"/><nd ref="12"/><nd ref="8"/><nd ref="9"/><nd ref="11"/><nd ref="10"/><nd ref="7"/><tag k="building" v="yes"/></way>
<way id="24"><nd ref="7"/><nd ref="12"/><nd ref="11"/><nd ref="10"/><nd ref="7"/><tag k="building:part" v="yes"/><tag k="building:levels" v="5"/></way>
<way id="25"><nd ref="12"/><nd ref="8"/><nd ref="9"/><nd ref="11"/><nd ref="12"/><tag k="building:part" v="yes"/></way>
<way id="26"><nd ref="1"/><nd ref="9"/><tag k="building" v="yes"/></way>
</osm>)";

std::string bytes_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void write(const fs::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

class Damage : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / ("blockrand-damage-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    write(folder_ / "town.osm", kTown);
    run::BuildOptions options;
    options.input = (folder_ / "town.osm").string();
    options.output = out().string();
    options.configs = BLOCKRAND_SOURCE_DIR "/configs";
    options.lod = 2;
    options.outputs.single_glb = options.outputs.single_cityjson = true;
    options.jobs = 1;
    base::Progress quiet;
    run::build(options, quiet);
    for (const auto& entry : fs::recursive_directory_iterator(out()))
      if (entry.is_regular_file() && entry.path().filename() != "run.json") files_.push_back(entry.path());
    std::sort(files_.begin(), files_.end());
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static fs::path out() { return folder_ / "out"; }

  static Validation validated() {
    ValidateOptions options;
    options.folder = out().string();
    options.jobs = 1;
    base::Progress quiet;
    return validate(options, quiet);
  }

  /// Validates with one file's bytes replaced.
  static void expect_findings(const fs::path& file, const std::string& bytes, const std::string& what) {
    const std::string sound = bytes_of(file);
    if (bytes == sound) return;
    write(file, bytes);
    try {
      EXPECT_FALSE(validated().sound()) << file << ": " << what;
    } catch (const std::exception& error) {
      ADD_FAILURE() << file << ": " << what << ": " << error.what();
    }
    write(file, sound);
  }

  static fs::path folder_;
  static std::vector<fs::path> files_;
};
fs::path Damage::folder_;
std::vector<fs::path> Damage::files_;

TEST_F(Damage, NoneIsFoundWhereNoneIs) {
  ASSERT_GE(files_.size(), 11u);
  const Validation v = validated();
  for (const Finding& f : v.findings.kept())
    ADD_FAILURE() << info(f.check).text << " " << f.file << " " << f.object << ": " << f.detail;
  EXPECT_GT(v.positions, 4u);
}

TEST_F(Damage, TruncatedFiles) {
  for (const fs::path& file : files_) {
    const std::string bytes = bytes_of(file);
    for (const double share : {0.0, 0.01, 0.3, 0.6, 0.9, 0.99}) {
      const auto length = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
      expect_findings(file, bytes.substr(0, length), "cut to " + std::to_string(length));
    }
    // Nobody can say how long build.json should be: without its last line break it is the same document.
    if (file.filename() != "build.json")
      expect_findings(file, bytes.substr(0, bytes.size() - 1), "without its last byte");
    expect_findings(file, bytes + bytes, "twice");
  }
}

TEST_F(Damage, FlippedBytes) {
  std::mt19937 random(1);
  for (const fs::path& file : files_) {
    const std::string bytes = bytes_of(file);
    // One byte somewhere; then many at once.
    for (const int count : {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 20, 20, 1000}) {
      std::string damaged = bytes;
      for (int i = 0; i < count; ++i) damaged[random() % damaged.size()] ^= static_cast<char>(1u << random() % 8);
      // build.json has texts that nobody compares: the name of an operation, a time.
      if (file.filename() == "build.json" && count == 1) continue;
      expect_findings(file, damaged, std::to_string(count) + " bits");
    }
  }
}

TEST_F(Damage, DigitsReplaced) {
  // What a byte flip seldom gives: well-formed files with other numbers.
  std::mt19937 random(2);
  for (const fs::path& file : files_) {
    if (file.extension() == ".gz" || file.filename() == "build.json") continue;
    const std::string bytes = bytes_of(file);
    std::vector<std::size_t> digits;
    for (std::size_t i = 0; i < bytes.size(); ++i)
      if (bytes[i] >= '0' && bytes[i] <= '9') digits.push_back(i);
    if (digits.empty()) continue;
    for (int round = 0; round < 15; ++round) {
      std::string damaged = bytes;
      for (int i = 0; i <= round; ++i) damaged[digits[random() % digits.size()]] = "0123456789e-."[random() % 13];
      expect_findings(file, damaged, "other digits");
    }
  }
}

TEST_F(Damage, WhatIsNoBuild) {
  ValidateOptions options;
  base::Progress quiet;
  for (const fs::path& path : {folder_, folder_ / "nowhere", folder_ / "town.osm"}) {
    options.folder = path.string();
    EXPECT_THROW(validate(options, quiet), base::UsageError) << path;
  }
}

}  // namespace
}  // namespace blockrand::validate
