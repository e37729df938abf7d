#include "pipeline/outputs/explain/find_explanation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "pipeline/base/error.h"
#include "pipeline/outputs/explain/explanation.h"
#include "pipeline/outputs/gzip.h"

namespace blockrand::outputs {
namespace {

using model::OsmId;
using model::OsmType;

constexpr OsmId way(std::int64_t n) { return {OsmType::way, n}; }

TEST(ObjectId, IsReadAsPeopleWriteIt) {
  for (const char* text :
       {"w123", "way/123", "way 123", "https://www.openstreetmap.org/way/123", "https://www.openstreetmap.org/way/123/",
        "openstreetmap.org/way/123#map=19/52/13", "https://www.openstreetmap.org/way/123/history", "W123", " w123 ",
        "w123.w456", "w123.rest", "w123.2"})
    EXPECT_EQ(parse_object_id(text), way(123)) << text;
  EXPECT_EQ(parse_object_id("r45"), (OsmId{OsmType::relation, 45}));
  EXPECT_EQ(parse_object_id("relation/45"), (OsmId{OsmType::relation, 45}));
  EXPECT_EQ(parse_object_id("n-7"), (OsmId{OsmType::node, -7}));
  for (const char* text :
       {"", "w", "123", "x1", "w12x", "way", "way/", "way/x", "ways/1", "w99999999999999999999", "w 1"})
    EXPECT_FALSE(parse_object_id(text)) << text;
}

/// A build of two tiles, made by hand.
class FindExplanation : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = ::testing::TempDir() + "find_explanation";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ + "/explain");
    write("build.json", "{}");
    // Ids of all lengths, so that lines differ in size; even ones are there.
    std::vector<std::pair<OsmId, std::string>> objects;
    std::string lines[2];
    for (std::int64_t n = 2; n < 2'000'000; n = n * 3 / 2 / 2 * 2 + 2) ids_.push_back(n);
    for (const OsmType type : {OsmType::way, OsmType::relation})
      for (const std::int64_t n : ids_) {
        const OsmId id{type, n};
        lines[n / 2 % 2] += "{\"id\":\"" + id.text() + "\",\"files\":[]}\n";
        index_ += outputs::index_line(id, n / 2 % 2 ? "15_1_1" : "15_0_0", id);
        if (type == OsmType::way && n == 2) index_ += outputs::index_line(way(3), "15_1_1", way(2));
      }
    write("explain/15_0_0.jsonl.gz", outputs::gzip(lines[0]));
    write("explain/15_1_1.jsonl.gz", outputs::gzip(lines[1]));
    write("explain/index.txt", index_);
    write("report.json",
          R"({"objects":[{"id":"n5","kind":"building","state":"reported","code":"NODE_ONLY"},)"
          R"({"id":"w7","kind":"building","state":"duplicate","related":"w2"}],"codes":{"NODE_ONLY":"A point."}})");
  }
  void write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ + "/" + name, std::ios::binary) << bytes;
  }

  std::string folder_, index_;
  std::vector<std::int64_t> ids_;
};

TEST_F(FindExplanation, BisectionFindsEveryLineAndNothingElse) {
  for (const OsmType type : {OsmType::way, OsmType::relation})
    for (const std::int64_t n : ids_) {
      const OsmId id{type, n};
      const auto found = find_explanation(folder_, id);
      ASSERT_TRUE(found) << id.text();
      EXPECT_THAT(found->json, ::testing::StartsWith("{\"id\":\"" + id.text() + "\""));
      EXPECT_TRUE(found->in_model);
      EXPECT_FALSE(find_explanation(folder_, {type, n + 9'000'001}));
    }
  for (const std::int64_t n : {std::int64_t{0}, std::int64_t{1}, std::int64_t{-4}, std::int64_t{999'999'999}})
    EXPECT_FALSE(find_explanation(folder_, way(n))) << n;
}

TEST_F(FindExplanation, PartsAndDuplicatesLeadToTheirBuilding) {
  const auto part = find_explanation(folder_, way(3));
  ASSERT_TRUE(part);
  EXPECT_EQ(part->asked, way(3));
  EXPECT_EQ(part->explained, way(2));
  const auto duplicate = find_explanation(folder_, way(7));
  ASSERT_TRUE(duplicate);
  EXPECT_EQ(duplicate->asked, way(7));
  EXPECT_EQ(duplicate->explained, way(2));
  EXPECT_TRUE(duplicate->in_model);
}

TEST_F(FindExplanation, DuplicatesOfEachOtherEnd) {
  write("report.json",
        R"({"objects":[{"id":"w7","state":"duplicate","related":"w9"},{"id":"w9","state":"duplicate","related":"w7"},)"
        R"({"id":5},7],"codes":3})");
  const auto found = find_explanation(folder_, way(7));
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->in_model);
}

TEST_F(FindExplanation, ReportedObjectsComeWithTheirReason) {
  const auto found = find_explanation(folder_, {OsmType::node, 5});
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->in_model);
  EXPECT_THAT(found->json, ::testing::HasSubstr("\"meaning\":\"A point.\""));
}

TEST_F(FindExplanation, DamageIsNamed) {
  const auto error = [&](OsmId id) -> std::string {
    try {
      find_explanation(folder_, id);
    } catch (const base::InputError& e) {
      return e.what();
    } catch (const base::UsageError& e) {
      return e.what();
    }
    return "no error";
  };
  write("explain/15_1_1.jsonl.gz", "no gzip");
  EXPECT_THAT(error(way(2)), ::testing::HasSubstr("15_1_1.jsonl.gz"));
  std::string cut = index_;
  for (char& c : cut)
    if (c == ' ') c = '-';
  write("explain/index.txt", cut);
  EXPECT_THAT(error(way(2)), ::testing::HasSubstr("line of the index"));
  std::filesystem::remove(folder_ + "/explain/index.txt");
  EXPECT_THAT(error(way(2)), ::testing::HasSubstr("index.txt: is missing"));
  write("build.json", R"({"configuration":{"explain":false}})");
  EXPECT_THAT(error(way(2)), ::testing::HasSubstr("--no-explain"));
  std::filesystem::remove(folder_ + "/build.json");
  EXPECT_THAT(error(way(2)), ::testing::HasSubstr("is no build"));
}

}  // namespace
}  // namespace blockrand::outputs
