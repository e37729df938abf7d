#include "pipeline/run/work_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;

const std::string kKey(64, 'a'), kOther = "b" + std::string(63, 'c');

class WorkCaches : public testing::Test {
 protected:
  WorkCaches() { fs::create_directories(build_); }
  ~WorkCaches() override { fs::remove_all(root_); }

  base::PublishedFile file(const std::string& name, const std::string& text) {
    std::ofstream(build_ + "/" + name) << text;
    return {name, text.size(), base::sha256_file(build_ + "/" + name)};
  }
  std::string read(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  std::string root_ = testing::TempDir() + "blockrand-cache-" + std::to_string(::getpid());
  std::string build_ = root_ + "/build", folder_ = root_ + "/cache";
  base::Progress quiet_{base::ProgressStyle::none, base::LogFormat::text, true};
};

TEST_F(WorkCaches, GivesBackWhatWasKept) {
  {
    WorkCache cache(folder_, "p", quiet_);
    EXPECT_FALSE(cache.find("tiles", kKey));
    cache.keep("tiles", kKey, "bytes", std::vector{file("a.glb", "mesh"), file("b.txt", "")}, build_);
    cache.keep("rows", kKey, "of another kind", {}, "");
  }
  fs::remove_all(build_);
  WorkCache cache(folder_, "p", quiet_);
  const auto found = cache.find("tiles", kKey);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->bytes, "bytes");
  ASSERT_EQ(found->files.size(), 2U);
  EXPECT_EQ(found->files[0].path, "a.glb");
  EXPECT_EQ(read(found->places[0]), "mesh");
  EXPECT_EQ(cache.find("rows", kKey)->bytes, "of another kind");
  EXPECT_FALSE(cache.find("tiles", kOther));
  EXPECT_EQ(cache.used(), (std::set<std::string>{"rows/" + kKey, "tiles/" + kKey}));
}

TEST_F(WorkCaches, DamageIsFoundAndRemoved) {
  WorkCache cache(folder_, "p", quiet_);
  cache.keep("tiles", kKey, "bytes", std::vector{file("a.glb", "mesh")}, build_);
  const std::string entry = folder_ + "/tiles/aa/" + kKey;
  fs::remove(build_ + "/a.glb");
  std::ofstream(entry + "/0") << "mush";
  EXPECT_FALSE(cache.find("tiles", kKey));
  EXPECT_FALSE(fs::exists(entry));
  EXPECT_EQ(cache.damaged(), 1U);
}

TEST_F(WorkCaches, OneRunAtATime) {
  const WorkCache cache(folder_, "p", quiet_);
  EXPECT_THROW(WorkCache(folder_, "p", quiet_), base::UsageError);
  EXPECT_NO_THROW(WorkCache(folder_, "p", quiet_, WorkCache::Mode::look));
}

TEST_F(WorkCaches, WhoLooksChangesNothing) {
  { WorkCache(folder_, "p", quiet_).keep("tiles", kKey, "bytes", {}, ""); }
  const std::string entry = folder_ + "/tiles/aa/" + kKey + "/entry";
  fs::resize_file(entry, 3);
  WorkCache cache(folder_, "another", quiet_, WorkCache::Mode::look);
  EXPECT_FALSE(cache.find("tiles", kKey));
  cache.keep("tiles", kOther, "bytes", {}, "");
  EXPECT_TRUE(fs::exists(entry));
  EXPECT_FALSE(fs::exists(folder_ + "/tiles/bc"));
  EXPECT_EQ(read(folder_ + "/program"), "blockrand kept work\np");
}

TEST_F(WorkCaches, FoldersOfOthersAreRefused) {
  std::ofstream(build_ + "/letter.txt") << "dear";
  EXPECT_THROW(WorkCache(build_, "p", quiet_), base::UsageError);
  EXPECT_THROW(cache_figures(build_), base::InputError);
}

TEST_F(WorkCaches, KeepsWhatTheNamedBuildsUsed) {
  {
    WorkCache cache(folder_, "p", quiet_);
    cache.keep("tiles", kKey, "old", {}, "");
    keep_work_of(folder_, "000001", cache.used(), {"000001"});
  }
  {
    WorkCache cache(folder_, "p", quiet_);
    cache.keep("tiles", kOther, "new", {}, "");
    keep_work_of(folder_, "000002", cache.used(), {"000001", "000002"});
    EXPECT_TRUE(cache.find("tiles", kKey)) << "build 1 is still there";
  }
  WorkCache cache(folder_, "p", quiet_);
  EXPECT_TRUE(cache.find("tiles", kOther));
  keep_work_of(folder_, "000002", cache.used(), {"000002"});
  EXPECT_FALSE(cache.find("tiles", kKey));
  EXPECT_TRUE(cache.find("tiles", kOther));
}

TEST_F(WorkCaches, PartsAreToldToTheNextRun) {
  {
    WorkCache cache(folder_, "p", quiet_);
    EXPECT_FALSE(cache.parts_before("15_1_2"));
    cache.note_parts("15_1_2", std::vector<std::uint64_t>{1, 2, 3});
    EXPECT_FALSE(cache.parts_before("15_1_2")) << "of this run";
  }
  const WorkCache cache(folder_, "p", quiet_);
  EXPECT_EQ(cache.parts_before("15_1_2"), (std::vector<std::uint64_t>{1, 2, 3}));
}

TEST_F(WorkCaches, TheOldestGoesFirst) {
  {
    WorkCache cache(folder_, "p", quiet_);
    cache.keep("tiles", kKey, std::string(1000, 'x'), {}, "");
    cache.keep("tiles", kOther, std::string(1000, 'y'), {}, "");
  }
  const std::string older = folder_ + "/tiles/bc/" + kOther;
  fs::last_write_time(older, fs::last_write_time(older) - std::chrono::hours(1));
  const CacheFigures figures = prune_cache(folder_, 1500, quiet_);
  EXPECT_EQ(figures.entries, 1U);
  EXPECT_EQ(figures.removed, 1U);
  EXPECT_FALSE(fs::exists(older));
}

}  // namespace
}  // namespace blockrand::run
