#include "pipeline/view/file_beneath.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace blockrand::view {
namespace {

namespace fs = std::filesystem;

TEST(PlainPath, NamesFilesAndNothingElse) {
  for (const char* path : {"a", "a.glb", "tiles/15/1/2.glb", "a b", "..a/b", "a..b"})
    EXPECT_EQ(is_plain_path(path), path[0] != '.') << path;
  using namespace std::string_view_literals;
  for (const std::string_view path : {""sv, "/"sv, "/a"sv, "a/"sv, "a//b"sv, "."sv, ".."sv, "a/../b"sv, "a/./b"sv,
                                      ".a"sv, "a/.b"sv, "a\\b"sv, "a\0b"sv, "a\0"sv, "a\nb"sv, "\x7F"sv})
    EXPECT_FALSE(is_plain_path(path)) << path;
}

class Beneath : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "blockrand-beneath-XXXXXX").string();
    outside_ = fs::canonical(mkdtemp(name.data())).string();
    folder_ = outside_ + "/build";
    fs::create_directories(folder_ + "/tiles");
    std::ofstream(outside_ + "/secret") << "secret";
    std::ofstream(folder_ + "/tiles/1.glb") << "glTF tile";
    std::ofstream(folder_ + "/empty") << "";
  }
  void TearDown() override { fs::remove_all(outside_); }
  std::string outside_, folder_;
};

TEST_F(Beneath, ReadsPieces) {
  const auto file = FileBeneath::open(folder_, "tiles/1.glb");
  ASSERT_TRUE(file);
  EXPECT_EQ(file->size(), 9u);
  EXPECT_EQ(file->read(0, 4), "glTF");
  EXPECT_EQ(file->read(5, 100), "tile");
  EXPECT_EQ(file->read(9, 1), "");
  ASSERT_TRUE(FileBeneath::open(folder_, "empty"));
  EXPECT_EQ(FileBeneath::open(folder_, "empty")->size(), 0u);
  EXPECT_FALSE(FileBeneath::open(folder_, "missing"));
  EXPECT_FALSE(FileBeneath::open(outside_ + "/nowhere", "a"));
}

TEST_F(Beneath, FollowsNoLinkThatLeadsOut) {
  fs::create_symlink(outside_ + "/secret", folder_ + "/absolute");
  fs::create_symlink("../secret", folder_ + "/relative");
  fs::create_symlink("..", folder_ + "/up");
  fs::create_symlink("tiles", folder_ + "/within");
  fs::create_symlink("loop", folder_ + "/loop");
  for (const char* path : {"absolute", "relative", "up/secret", "up/build/tiles/1.glb", "loop"})
    EXPECT_FALSE(FileBeneath::open(folder_, path)) << path;
  EXPECT_TRUE(FileBeneath::open(folder_, "within/1.glb"));
}

TEST_F(Beneath, OpensRegularFilesOnly) {
  ASSERT_EQ(mkfifo((folder_ + "/pipe").c_str(), 0600), 0);
  EXPECT_FALSE(FileBeneath::open(folder_, "pipe")) << "it must not wait for a writer";
  EXPECT_FALSE(FileBeneath::open(folder_, "tiles"));
}

TEST_F(Beneath, AnotherContentIsAnotherVersion) {
  const std::string before = FileBeneath::open(folder_, "tiles/1.glb")->version();
  EXPECT_EQ(FileBeneath::open(folder_, "tiles/1.glb")->version(), before);
  std::ofstream(folder_ + "/tiles/1.glb") << "another tile";
  EXPECT_NE(FileBeneath::open(folder_, "tiles/1.glb")->version(), before);
}

}  // namespace
}  // namespace blockrand::view
