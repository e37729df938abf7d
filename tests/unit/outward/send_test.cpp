// In which order files are sent, what is noted of it, and how a publishing that was broken off goes on.
#include "pipeline/outward/send.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "pipeline/base/error.h"
#include "pipeline/outward/part_file.h"
#include "pipeline/outward/variants.h"
#include "tests/unit/outward/build_folder.h"

namespace blockrand::outward {
namespace {

/// A place that remembers what it has and in which order it came.
struct Place {
  std::map<std::string, std::string> files;  // path → hash
  std::vector<std::string> log;
  int calls_left = 1000;  // then it fails, half-way through the batch

  Target target() {
    Target t;
    t.put = [this](const Batch& batch, const MakeVariant& variant) {
      std::vector<std::string> variants;
      for (const BuildFile& file : batch.files) {
        if (--calls_left < 0) throw std::runtime_error("the line is down");
        files[file.path] = file.sha256, log.push_back("+" + file.path);
        if (variant && !variant(file).empty()) files[file.path + ".gz"] = "gzip", variants.push_back(file.path + ".gz");
      }
      return variants;
    };
    t.remove = [this](std::span<const std::string> paths, int, int) {
      for (const std::string& path : paths) {
        if (--calls_left < 0) throw std::runtime_error("the line is down");
        files.erase(path), log.push_back("-" + path);
      }
    };
    return t;
  }
};

class Send : public TestFolder {
 protected:
  SendSummary send(const std::string& folder, Place& place, SendOptions options = {.keep_deleted_hours = 0}) {
    TargetState state(path("state"));
    base::Progress progress;
    return send_build(folder, files_of_build(folder), place.target(), state, options, progress);
  }
  /// What should lie there.
  static std::map<std::string, std::string> hashes(const std::string& folder) {
    std::map<std::string, std::string> out;
    for (const auto& [path, file] : files_of_build(folder)) out[path] = file.sha256;
    return out;
  }
  /// Whether all that the tileset leads to lies there, at every moment of the log.
  static void expect_no_moment_without_a_tile(const std::string& before, const std::string& after, const Place& place) {
    std::set<std::string> there;
    for (const auto& [path, file] : files_of_build(before)) there.insert(path);
    bool fresh = false;
    for (const std::string& line : place.log) {
      const std::string path = line.substr(1);
      if (line[0] == '+')
        there.insert(path);
      else
        there.erase(path);
      if (path == "tileset.json") fresh = true;
      for (const std::string& tile : contents_of_tileset(fresh ? after : before, "tileset.json"))
        EXPECT_TRUE(there.contains(tile)) << tile << " is missing after " << line;
    }
  }
  std::string first() {
    return build("one", {{"tileset.json", tileset({"tiles/a.glb", "tiles/b.glb"})},
                         {"tiles/a.glb", "A1"},
                         {"tiles/b.glb", "B1"},
                         {"textures/t.png", "T"},
                         {"report.html", "R1"}});
  }
  std::string second() {
    return build("two", {{"tileset.json", tileset({"tiles/a.glb", "tiles/b_q0.glb"})},
                         {"tiles/a.glb", "A2"},
                         {"tiles/b_q0.glb", "B2"},
                         {"textures/t.png", "T"},
                         {"textures/u.png", "U"},
                         {"report.html", "R2"}});
  }
};

TEST_F(Send, ContentsComeBeforeTilesBeforeTilesetsBeforeTheRecord) {
  Place place;
  send(first(), place);
  EXPECT_EQ(place.log, (std::vector<std::string>{"+textures/t.png", "+tiles/a.glb", "+tiles/b.glb", "+tileset.json",
                                                 "+report.html", "+build.json"}));
}

TEST_F(Send, OnlyWhatDiffersIsSentAndWhatIsNotNamedGoesLast) {
  Place place;
  send(first(), place);
  place.log.clear();
  const SendSummary summary = send(second(), place);
  EXPECT_EQ(place.log, (std::vector<std::string>{"+textures/u.png", "+tiles/a.glb", "+tiles/b_q0.glb", "+tileset.json",
                                                 "+report.html", "+build.json", "-tiles/b.glb"}));
  EXPECT_EQ(summary.unchanged, 1U);
  EXPECT_EQ(place.files, hashes(second()));
  expect_no_moment_without_a_tile(first(), second(), place);
  place.log.clear();
  EXPECT_EQ(send(second(), place).files, 0U);
  EXPECT_TRUE(place.log.empty()) << "nothing is to do";
}

TEST_F(Send, WhatIsNotNamedStaysForItsTime) {
  const auto one = files_of_build(first()), two = files_of_build(second());
  TargetState state(path("state"));
  for (const auto& [path, file] : one) state.put(path, file.sha256);
  const SendRules rules{.now = 1000, .keep_deleted = 60};
  SendPlan plan = plan_to_send(two, state, rules);
  EXPECT_EQ(plan.leave, (std::vector<std::string>{"tiles/b.glb"}));
  EXPECT_TRUE(plan.remove.empty());
  EXPECT_EQ(plan.later, plan.leave);
  state.leaves("tiles/b.glb", 1000);
  EXPECT_TRUE(plan_to_send(two, state, {.now = 1059, .keep_deleted = 60}).remove.empty());
  EXPECT_EQ(plan_to_send(two, state, {.now = 1060, .keep_deleted = 60}).remove, plan.leave);
  // The build before comes back: the tile is there still, and is named again.
  plan = plan_to_send(one, state, {.now = 1060, .keep_deleted = 60});
  EXPECT_EQ(plan.stay, (std::vector<std::string>{"tiles/b.glb"}));
  EXPECT_TRUE(plan.remove.empty());
}

TEST_F(Send, GoesOnWhereItWasBrokenOff) {
  const std::string one = first(), two = second();
  for (int broken = 0; broken < 7; ++broken) {
    std::filesystem::remove(path("state"));
    Place place;
    send(one, place);
    place.log.clear(), place.calls_left = broken;
    EXPECT_THROW(send(two, place, {.keep_deleted_hours = 0, .batch = 2}), std::runtime_error);
    expect_no_moment_without_a_tile(one, two, place);
    place.calls_left = 1000;
    send(two, place, {.keep_deleted_hours = 0, .batch = 2});
    expect_no_moment_without_a_tile(one, two, place);
    EXPECT_EQ(place.files, hashes(two)) << "broken off after " << broken;
  }
}

TEST_F(Send, GoesOnWhereItWasBrokenOffWithVariants) {
  const std::string much(5000, 'a');
  const std::string one = build("one", {{"tileset.json", tileset({"tiles/a.glb", "tiles/b.glb"})},
                                        {"tiles/a.glb", much},
                                        {"tiles/b.glb", much},
                                        {"goes.csv", much},
                                        {"shrinks.csv", much}});
  const std::string two = build("two", {{"tileset.json", tileset({"tiles/a.glb", "tiles/b.glb"})},
                                        {"tiles/a.glb", "has no variant any more"},
                                        {"tiles/b.glb", much + "b"},
                                        {"shrinks.csv", "neither has this"}});
  std::map<std::string, std::string> wanted = hashes(two);
  for (const auto& [path, file] : files_of_build(two))
    if (!gzip_variant(two, file).empty()) wanted[path + ".gz"] = "gzip";
  ASSERT_TRUE(wanted.contains("tiles/b.glb.gz"));
  ASSERT_FALSE(wanted.contains("tiles/a.glb.gz"));
  const SendOptions with{.keep_deleted_hours = 0, .batch = 1, .gzip = true};
  constexpr int kSteps = 8;  // files that are sent and removed
  for (int broken = 0; broken < kSteps; ++broken) {
    std::filesystem::remove(path("state"));
    Place place;
    send(one, place, with);
    place.calls_left = broken;
    EXPECT_THROW(send(two, place, with), std::runtime_error) << broken;
    place.calls_left = 1000;
    send(two, place, with);
    EXPECT_EQ(place.files, wanted) << "broken off after " << broken;
  }
}

TEST_F(Send, PackedFilesOfTheBuildStayBesideTheirPlainOnes) {
  const auto packed = [&](const std::string& name, const std::string& bytes) {
    return build(
        name,
        {{"tileset.json", tileset({"tiles/a.glb"})}, {"tiles/a.glb", bytes}, {"tiles/a.glb.gz", "packed " + bytes}});
  };
  const std::string one = packed("one", "A1"), two = packed("two", "A2");
  Place place;
  const SendOptions with{.keep_deleted_hours = 0, .gzip = true};
  send(one, place, with);
  send(two, place, with);
  EXPECT_EQ(place.files.at("tiles/a.glb.gz"), hashes(two).at("tiles/a.glb.gz"));
}

TEST_F(Send, ADryRunSeesThatVariantsAreMissing) {
  const std::string folder = build("v", {{"a.csv", std::string(5000, 'a')}});
  Place place;
  send(folder, place);
  const SendOptions with{.gzip = true};
  TargetState state(path("state"));
  EXPECT_EQ(look_ahead(files_of_build(folder), state, with, unix_time()).files, 0U);
  settle_variants(state, with);
  EXPECT_EQ(look_ahead(files_of_build(folder), state, with, unix_time()).files, 2U);
  EXPECT_EQ(send(folder, place, with).files, 2U) << "as a real run does";
}

TEST_F(Send, AnotherBuildAfterABrokenOffOneLeavesNothingBehind) {
  const std::string one = first(), two = second();
  Place place;
  send(one, place);
  place.calls_left = 3;  // u.png, a.glb and b_q0.glb came
  EXPECT_THROW(send(two, place), std::runtime_error);
  place.calls_left = 1000;
  send(one, place);
  EXPECT_EQ(place.files, hashes(one)) << "a.glb is sent again, whatever is there; the two new ones go";
}

TEST_F(Send, BatchesHaveFilesOfOneStep) {
  Place place;
  std::vector<std::pair<Step, std::size_t>> batches;
  Target target = place.target();
  const auto put = target.put;
  target.put = [&](const Batch& batch, const MakeVariant& variant) {
    batches.emplace_back(batch.step, batch.files.size());
    EXPECT_EQ(batch.number, static_cast<int>(batches.size()));
    return put(batch, variant);
  };
  TargetState state(path("state"));
  base::Progress progress;
  const std::string folder = first();
  send_build(folder, files_of_build(folder), target, state, {.batch = 1}, progress);
  EXPECT_EQ(batches.size(), 6U);
  for (const auto& [step, files] : batches) EXPECT_EQ(files, 1U);
  EXPECT_TRUE(std::ranges::is_sorted(batches, {}, [](const auto& b) { return b.first; }));
}

TEST_F(Send, VariantsComeAndGoWithTheirFiles) {
  const std::string folder =
      build("v", {{"a.csv", std::string(5000, 'a')}, {"b.csv", "xyz"}, {"c.png", std::string(5000, 'a')}});
  Place place;
  const SendOptions with{.keep_deleted_hours = 0, .gzip = true};
  EXPECT_EQ(send(folder, place, with).variants, 2U) << "a.csv and build.json";
  EXPECT_TRUE(place.files.contains("a.csv.gz"));
  EXPECT_FALSE(place.files.contains("b.csv.gz")) << "not smaller";
  EXPECT_FALSE(place.files.contains("c.png.gz")) << "packed already";
  // A file that changes and has none any more: servers would go on handing out the old one.
  const std::string other = build("w", {{"a.csv", "short"}, {"b.csv", "xyz"}, {"c.png", std::string(5000, 'a')}});
  send(other, place, {.keep_deleted_hours = 1000, .gzip = true});
  EXPECT_FALSE(place.files.contains("a.csv.gz"));
  send(folder, place, with);
  EXPECT_TRUE(place.files.contains("a.csv.gz"));
  send(folder, place, {.keep_deleted_hours = 1000});
  EXPECT_FALSE(place.files.contains("a.csv.gz")) << "not asked for any more";
  EXPECT_EQ(send(folder, place, with).variants, 2U) << "asked for again: files are sent with them";
}

TEST_F(Send, VariantsAreTheSameEachTime) {
  const std::string folder = build("v", {{"a.csv", std::string(5000, 'a')}});
  const BuildFile file = files_of_build(folder).at("a.csv");
  EXPECT_EQ(gzip_variant(folder, file), gzip_variant(folder, file));
  EXPECT_EQ(gzip_variant(folder, file).substr(4, 4), std::string(4, '\0')) << "no time in it";
}

TEST_F(Send, StateOutlivesALineThatWasCutOff) {
  {
    TargetState state(path("state"));
    state.put("a", "1"), state.put("b", "2"), state.save();
    const std::vector<std::string> some{"b", "c"};
    state.begin(some);
  }
  std::ofstream(path("state"), std::ios::app | std::ios::binary) << "here 3 c";  // no end of line: killed there
  const TargetState state(path("state"));
  EXPECT_EQ(state.here(), (std::map<std::string, std::string>{{"a", "1"}}));
  EXPECT_EQ(state.in_doubt(), (std::set<std::string>{"b", "c"}));
}

TEST_F(Send, AStateOfAnotherProgramIsRefused) {
  write(path("state"), "something else\n");
  EXPECT_THROW(TargetState(path("state")), std::runtime_error);
}

TEST_F(Send, AFolderGetsWholeFilesAndLosesEmptyFolders) {
  const std::string one = first(), two = second(), root = path("www");
  TargetState state(path("state"));
  base::Progress progress;
  send_build(one, files_of_build(one), folder_target(one, root), state, {.keep_deleted_hours = 0}, progress);
  send_build(two, files_of_build(two), folder_target(two, root), state, {.keep_deleted_hours = 0}, progress);
  std::set<std::string> there;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
    if (entry.is_regular_file()) there.insert(std::filesystem::relative(entry.path(), root).string());
  std::set<std::string> wanted;
  for (const auto& [path, hash] : hashes(two)) wanted.insert(path);
  EXPECT_EQ(there, wanted);
  // A damaged file of the build is not handed on.
  write(path("two/tiles/a.glb"), "A3");
  state.forget();
  std::filesystem::remove(root + "/tiles/a.glb");
  EXPECT_THROW(send_build(two, files_of_build(two), folder_target(two, root), state, {}, progress), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(root + "/tiles/a.glb"));
  EXPECT_FALSE(std::filesystem::exists(root + "/tiles/a.glb.blockrand-part"));
}

TEST_F(Send, PlacesWithinBuildsAndRegionsAreRefused) {
  const std::string folder = first();
  write(folder + "/run.json", "{}");
  for (const std::string& inside : {folder, folder + "/areas", folder + "/areas/deep/down"}) {
    EXPECT_THROW(folder_target(folder, inside), base::UsageError) << inside;
    EXPECT_THROW(refuse_own_folders("--archive", inside + "/a.3tz"), base::UsageError) << inside;
  }
  write(path("region/region.toml"), "");
  EXPECT_THROW(folder_target(folder, path("region/www")), base::UsageError);
  EXPECT_NO_THROW(folder_target(folder, path("www")));
  EXPECT_NO_THROW(refuse_own_folders("--archive", folder + ".3tz"));
  // What was sent to a web root has no run.json: it may be sent to again.
  write(path("www/build.json"), "{}");
  EXPECT_NO_THROW(folder_target(folder, path("www")));
}

}  // namespace
}  // namespace blockrand::outward
