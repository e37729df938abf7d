#include "pipeline/base/publish.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "pipeline/base/error.h"

namespace blockrand::base {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr char kSha256OfAbc[] = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";  // FIPS 180-4

std::string slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

template <class Error, class F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error of this type";
}

class Publish : public testing::Test {
 protected:
  Publish() {
    std::string pattern = testing::TempDir() + "publish.XXXXXX";
    here = fs::canonical(mkdtemp(pattern.data()));
    target = here / "out";
  }
  ~Publish() override { fs::remove_all(here); }

  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(here)) all.push_back(entry.path().filename());
    return all;
  }
  void make_build(const std::string& content) const {
    StagedFolder folder(target, true);
    folder.write("build.json", content);
    folder.publish();
  }

  fs::path here, target;
};

TEST_F(Publish, FilesAppearUnderTheTargetAtTheEndOnly) {
  StagedFolder folder(target, false);
  const PublishedFile file = folder.write("tiles/15/a.glb", "abc");
  EXPECT_EQ(file.path, "tiles/15/a.glb");
  EXPECT_EQ(file.bytes, 3u);
  EXPECT_EQ(file.sha256, kSha256OfAbc);
  EXPECT_FALSE(fs::exists(target));
  EXPECT_EQ(folder.publish(), "");
  EXPECT_EQ(slurp(target / "tiles/15/a.glb"), "abc");
  EXPECT_THAT(names(), UnorderedElementsAre("out"));
}

TEST_F(Publish, AFolderThatOnlyCountsLeavesNothing) {
  {
    StagedFolder folder((here / "deep/er/out").string(), false, {.counts_only = true});
    const PublishedFile file = folder.write("tiles/15/a.glb", "abc");
    EXPECT_EQ(file.bytes, 3u);
    EXPECT_EQ(file.sha256, kSha256OfAbc);
    StagedFile piecewise = folder.create("b.gml");
    piecewise.append("ab");
    piecewise.append("c");
    EXPECT_EQ(piecewise.close().bytes, 3u);
    EXPECT_GT(folder.free_bytes(), 0u);
    EXPECT_THAT(names(), IsEmpty());
  }
  EXPECT_THAT(names(), IsEmpty());
  make_build("old");
  EXPECT_THAT(error_of<UsageError>([&] { StagedFolder(target, false, {.counts_only = true}); }), HasSubstr("--force"));
  { StagedFolder over(target, true, {.counts_only = true}); }
  EXPECT_EQ(slurp(target / "build.json"), "old");
}

TEST_F(Publish, ForeignFilesKeepAFolderFromBeingReplaced) {
  make_build("old");
  FolderKind kind;
  kind.foreign = [](const std::string&) { return std::vector<std::string>(12, "a.txt"); };
  EXPECT_THAT(error_of<UsageError>([&] { StagedFolder(target, true, kind); }),
              AllOf(HasSubstr("a.txt, a.txt"), HasSubstr("and 2 more files"), HasSubstr("did not write")));
  kind.foreign = [](const std::string&) { return std::vector<std::string>(); };
  StagedFolder folder(target, true, kind);
  folder.write("build.json", "new");
  folder.publish();
  EXPECT_EQ(slurp(target / "build.json"), "new");
}

TEST_F(Publish, AResultThatMustNotReplaceLiesBeside) {
  make_build("old");
  for (const char* text : {"new", "newer"}) {
    StagedFolder folder(target, true);
    folder.write("build.json", text);
    EXPECT_EQ(folder.publish_beside("unaccounted"), target.string() + ".unaccounted");
    EXPECT_EQ(slurp(here / "out.unaccounted/build.json"), text);
  }
  EXPECT_EQ(slurp(target / "build.json"), "old");
  EXPECT_THAT(names(), UnorderedElementsAre("out", "out.unaccounted"));
  fs::remove_all(target);
  StagedFolder folder(target, true);
  folder.write("build.json", "first");
  EXPECT_EQ(folder.publish_beside("unaccounted"), target.string());
  EXPECT_EQ(slurp(target / "build.json"), "first");
}

TEST_F(Publish, PiecewiseFilesAreHashedAsAWhole) {
  StagedFolder folder(target, false);
  StagedFile file = folder.create("model.glb");
  file.append("ab");
  file.append("");
  file.append("c");
  const PublishedFile result = file.close();
  EXPECT_EQ(result.bytes, 3u);
  EXPECT_EQ(result.sha256, kSha256OfAbc);
  { StagedFile unfinished = folder.create("unfinished"); }
  folder.publish();
  EXPECT_EQ(slurp(target / "model.glb"), "abc");
  EXPECT_FALSE(fs::exists(target / "unfinished"));
}

TEST_F(Publish, AnUnpublishedFolderLeavesNothing) {
  {
    StagedFolder folder(here / "new" / "deeper" / "out", false);
    folder.write("a/b", "c");
  }
  EXPECT_THAT(names(), IsEmpty());
}

TEST_F(Publish, AnOldBuildIsReplacedWithForceAndStaysUntilThen) {
  make_build("old");
  EXPECT_THAT(error_of<UsageError>([&] { StagedFolder(target, false); }), HasSubstr("--force"));
  {
    StagedFolder given_up(target, true);
    given_up.write("build.json", "half");
  }
  EXPECT_EQ(slurp(target / "build.json"), "old");
  make_build("new");
  EXPECT_EQ(slurp(target / "build.json"), "new");
  EXPECT_THAT(names(), UnorderedElementsAre("out"));
}

TEST_F(Publish, AFolderThatIsNoBuildIsNeverReplaced) {
  fs::create_directory(target);
  std::ofstream(target / "diary.txt") << "dear diary";
  for (const bool force : {false, true})
    EXPECT_THAT(error_of<UsageError>([&] { StagedFolder(target, force); }), HasSubstr("no build.json"));
  EXPECT_THAT(names(), UnorderedElementsAre("out"));
}

TEST_F(Publish, AnEmptyFolderNeedsNoForce) {
  fs::create_directory(target);
  StagedFolder folder(target.string() + "/", false);
  folder.write("build.json", "x");
  folder.publish();
  EXPECT_EQ(slurp(target / "build.json"), "x");
}

TEST_F(Publish, ALinkStandsForItsFolder) {
  fs::create_directory(here / "real");
  fs::create_directory_symlink("real", target);
  StagedFolder folder(target, false);
  folder.write("build.json", "x");
  folder.publish();
  EXPECT_TRUE(fs::is_symlink(target));
  EXPECT_EQ(slurp(here / "real" / "build.json"), "x");
}

TEST_F(Publish, PlacesThatCannotBeUsedAreUsageErrors) {
  std::ofstream(here / "file") << "x";
  EXPECT_THAT(error_of<UsageError>([&] { StagedFolder(here / "file", true); }), HasSubstr("is a file"));
  EXPECT_THAT(error_of<UsageError>([&] { StagedFolder(here / "file" / "out", true); }), HasSubstr("is a file"));
  EXPECT_THAT(error_of<UsageError>([&] { StagedFolder(here / "file" / "deep" / "out", true); }),
              HasSubstr("is a file"));
  EXPECT_THAT(error_of<UsageError>([] { StagedFolder("/", true); }), HasSubstr("root folder"));
  EXPECT_THAT(error_of<UsageError>([] { StagedFolder("", true); }), HasSubstr("--output"));
  const fs::path before = fs::current_path();
  fs::create_directory(target);
  fs::current_path(target);
  EXPECT_THAT(error_of<UsageError>([] { StagedFolder(".", true); }), HasSubstr("current folder"));
  fs::current_path(before);
}

TEST_F(Publish, LinksToNothingAreOutputErrors) {
  fs::create_symlink("nowhere", here / "broken");
  EXPECT_THAT(error_of<OutputError>([&] { StagedFolder(here / "broken", true); }), HasSubstr("broken"));
  EXPECT_THAT(error_of<OutputError>([&] { StagedFolder(here / "broken" / "x", true); }), HasSubstr("broken"));
  EXPECT_THAT(names(), UnorderedElementsAre("broken"));
}

TEST_F(Publish, NoPermissionIsAnOutputError) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::create_directory(here / "closed");
  fs::permissions(here / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(error_of<OutputError>([&] { StagedFolder(here / "closed" / "out", false); }), HasSubstr("permissions"));
}

TEST_F(Publish, AFileOverTheSizeLimitIsAnOutputErrorWithARemedy) {
  StagedFolder folder(target, false);
  const auto old_handler = signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const rlimit small{4096, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string error = error_of<OutputError>([&] { folder.write("tiles/big.glb", std::string(100'000, 'x')); });
  setrlimit(RLIMIT_FSIZE, &old);
  signal(SIGXFSZ, old_handler);
  EXPECT_THAT(error, AllOf(HasSubstr("tiles/big.glb"), HasSubstr("ulimit -f")));
  EXPECT_FALSE(fs::exists(fs::path(folder.staging_path()) / "tiles/big.glb"));
}

TEST_F(Publish, AFullDiskIsAnOutputErrorWithARemedy) {
  fs::create_directory(here / "small");
  if (mount("tmpfs", (here / "small").c_str(), "tmpfs", 0, "size=64k") != 0) GTEST_SKIP() << "cannot mount a tmpfs";
  std::string error;
  {
    StagedFolder folder(here / "small" / "out", false);
    EXPECT_LE(folder.free_bytes(), 65536u);
    error = error_of<OutputError>([&] { folder.write("big", std::string(100'000, 'x')); });
  }
  EXPECT_TRUE(fs::is_empty(here / "small"));
  umount((here / "small").c_str());
  EXPECT_THAT(error, AllOf(HasSubstr("big: cannot write"), HasSubstr("disk is full"), HasSubstr("left")));
}

TEST_F(Publish, AMountPointIsRefusedBeforeTheWork) {
  fs::create_directory(target);
  if (mount("tmpfs", target.c_str(), "tmpfs", 0, "size=64k") != 0) GTEST_SKIP() << "cannot mount a tmpfs";
  EXPECT_THAT(error_of<UsageError>([&] { StagedFolder(target, false); }), HasSubstr("mount point"));
  umount(target.c_str());
}

/// The pid of a process that has ended.
pid_t dead_pid() {
  const pid_t pid = fork();
  if (pid == 0) _exit(0);
  waitpid(pid, nullptr, 0);
  return pid;
}

TEST_F(Publish, LeftoversOfDeadProcessesAreRemovedAndThoseOfLivingOnesKept) {
  const std::string dead = std::to_string(dead_pid());
  fs::create_directories(here / (".out.part-" + dead) / "tiles");
  fs::create_directories(here / (".out.part-" + dead + ".2"));
  fs::create_directories(here / (".out.part-" + std::to_string(getppid())));
  fs::create_directories(here / (".other.part-" + dead));
  fs::create_directories(here / ".out.part-mine");
  { StagedFolder folder(target, false); }
  EXPECT_THAT(names(),
              UnorderedElementsAre(".out.part-" + std::to_string(getppid()), ".other.part-" + dead, ".out.part-mine"));
}

TEST_F(Publish, ABuildSetAsideByADeadProcessIsPutBack) {
  const fs::path aside = here / (".out.old-" + std::to_string(dead_pid()));
  fs::create_directory(aside);
  std::ofstream(aside / "build.json") << "yesterday";
  EXPECT_THAT(error_of<UsageError>([&] { StagedFolder(target, false); }), HasSubstr("holds a build already"));
  EXPECT_EQ(slurp(target / "build.json"), "yesterday");
}

TEST_F(Publish, TwoFoldersForOneTargetDoNotMix) {
  StagedFolder first(target, true), second(target, true);
  EXPECT_NE(first.staging_path(), second.staging_path());
  first.write("build.json", "first");
  second.write("build.json", "second");
  first.publish();
  second.publish();
  EXPECT_EQ(slurp(target / "build.json"), "second");
  EXPECT_THAT(names(), UnorderedElementsAre("out"));
}

TEST_F(Publish, SomebodyElsesBuildOfTheMeantimeIsNotReplacedWithoutForce) {
  StagedFolder folder(target, false);
  folder.write("build.json", "mine");
  make_build("theirs");
  EXPECT_THAT(error_of<OutputError>([&] { folder.publish(); }), HasSubstr("holds a build already"));
  EXPECT_EQ(slurp(target / "build.json"), "theirs");
}

TEST_F(Publish, ThreadsWriteDistinctFiles) {
  StagedFolder folder(target, false);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&folder, t] {
      for (int i = 0; i < 50; ++i) folder.write("tiles/" + std::to_string(i) + "/" + std::to_string(t), "x");
    });
  for (auto& thread : threads) thread.join();
  folder.publish();
  EXPECT_TRUE(fs::exists(target / "tiles/49/3"));
}

TEST_F(Publish, AbandoningRemovesEverythingWhileThreadsStillWrite) {
  make_build("old");
  const pid_t pid = fork();
  if (pid == 0) {
    StagedFolder folder(target, true), other(here / "deep" / "er" / "out", false);
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&folder, t] {
        for (int i = 0;; ++i) folder.write("tiles/" + std::to_string(t) + "/" + std::to_string(i), "x");
      });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    abandon_staged_folders();
    _exit(42);
  }
  int status = 0;
  waitpid(pid, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 42);
  EXPECT_THAT(names(), UnorderedElementsAre("out"));
  EXPECT_EQ(slurp(target / "build.json"), "old");
}

}  // namespace
}  // namespace blockrand::base
