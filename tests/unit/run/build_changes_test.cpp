// What nights tell of builds in areas, and what of them must not be read again.
#include "pipeline/run/build_changes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/base/sha256.h"
#include "pipeline/outputs/gzip.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;

/// By area, tile and building: the height in metres.
using Town = std::map<std::string, std::map<std::string, std::map<std::string, double>>>;

void write(const fs::path& path, const std::string& bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string tile_file(const std::string& area, const std::string& tile) {
  return "areas/" + area + "/explain/" + tile + ".jsonl.gz";
}

/// As a build in areas writes it, as far as builds are compared.
void write_build(const fs::path& folder, const Town& town) {
  nlohmann::json whole = {{"configuration", {{"lod", 2}}}, {"areas", nlohmann::json::object()}};
  for (const auto& [area, tiles] : town) {
    nlohmann::json record = {{"configuration", {{"lod", 2}}}, {"files", nlohmann::json::object()}};
    for (const auto& [tile, houses] : tiles) {
      std::string lines;
      for (const auto& [id, height] : houses)
        lines += nlohmann::ordered_json{{"id", id},
                                        {"state", "modelled"},
                                        {"lod", 2},
                                        {"tags", {{"attributes", "a key of OSM"}}},
                                        {"attributes",
                                         {{{"name", "height"}, {"value", height}, {"source", "tag"}, {"why", ""}}}}}
                     .dump() +
                 "\n";
      const std::string bytes = outputs::gzip(lines);
      write(folder / tile_file(area, tile), bytes);
      record["files"]["explain/" + tile + ".jsonl.gz"] = {{"sha256", base::sha256_of(bytes)}};
    }
    write(folder / "areas" / area / "build.json", record.dump());
    whole["areas"][area] = {{"build_sha256", base::sha256_of(record.dump())}};
  }
  write(folder / "build.json", whole.dump());
}

/// Keeps what a night asked for, as a region's cache does.
class Nights {
 public:
  BuildChanges compare(const std::string& before, const std::string& after) {
    std::set<std::string> used;
    base::Memo memo;
    memo.find = [&](std::string_view kind, const std::string& key) -> std::optional<std::string> {
      const auto found = kept_.find(std::string(kind) + key);
      if (found == kept_.end()) return std::nullopt;
      used.insert(found->first);
      return found->second;
    };
    memo.keep = [&](std::string_view kind, const std::string& key, std::string_view bytes) {
      const std::string name = std::string(kind) + key;
      kept_[name] = std::string(bytes);
      used.insert(name);
    };
    const BuildChanges changes = compare_builds(before, after, &memo);
    std::erase_if(kept_, [&](const auto& entry) { return !used.contains(entry.first); });
    return changes;
  }

 private:
  std::map<std::string, std::string> kept_;
};

TEST(BuildChanges, TilesThatBothBuildsHaveAlikeAreReadOnce) {
  const fs::path folder = fs::path(testing::TempDir()) / "build_changes_test";
  fs::remove_all(folder);
  Town town = {{"11/1/1", {{"15_16_16", {{"w1", 10}, {"w2", 14}}}, {"15_17_16", {{"w3", 6}}}}},
               {"11/2/1", {{"15_32_16", {{"w4", 20}}}, {"15_33_16", {{"w5", 8}, {"w6", 12}}}}}};
  const auto build = [&](int night) { return (folder / std::to_string(night)).string(); };
  Nights nights;
  write_build(build(1), town);
  EXPECT_EQ(nights.compare("", build(1)).after, 6u);

  // A night in which the second area is as it was: what is known of its tiles must outlive it.
  town["11/1/1"]["15_16_16"]["w1"] = 16;
  write_build(build(2), town);
  const BuildChanges second = nights.compare(build(1), build(2));
  ASSERT_EQ(second.attributes.size(), 1u);
  EXPECT_EQ(second.attributes[0].id, "w1");
  EXPECT_EQ(second.all_after, 6u);
  EXPECT_DOUBLE_EQ(second.height_before, 70.0 / 6);
  EXPECT_DOUBLE_EQ(second.height_after, 76.0 / 6);

  // Then one of its tiles changes; the other one cannot be read any more, and need not be.
  town["11/2/1"]["15_32_16"]["w4"] = 26;
  write_build(build(3), town);
  for (const int night : {2, 3}) write(fs::path(build(night)) / tile_file("11/2/1", "15_33_16"), "damaged");
  const BuildChanges third = nights.compare(build(2), build(3));
  ASSERT_EQ(third.attributes.size(), 1u);
  EXPECT_EQ(third.attributes[0].id, "w4");
  EXPECT_EQ(third.before, 6u);
  EXPECT_EQ(third.after, 6u);
  EXPECT_DOUBLE_EQ(third.height_after, 82.0 / 6);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace blockrand::run
