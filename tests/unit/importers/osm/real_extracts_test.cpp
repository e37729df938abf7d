// Real extracts: numbers that were counted by other means, and books that balance. Skipped where the data is absent.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/unit/importers/osm/support.h"

namespace blockrand::importers::osm::test {
namespace {

namespace fs = std::filesystem;
const fs::path kData = fs::path(BLOCKRAND_SHARED_DIR) / "data/osm";

TEST(RealExtracts, Berlin2014) {
  const fs::path file = kData / "berlin-2014-06.osm.pbf";
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file;
  const auto e = read_extract(file.string());
  // osmium tags-count, and the data's README: 238,404 ways and relations; nodes with `building` but not `no`.
  EXPECT_EQ(e.counts.building_ways + e.counts.building_relations, 238404u);
  EXPECT_EQ(e.counts.building_relations, 914u);
  EXPECT_EQ(e.counts.building_nodes, 1511u);
  EXPECT_EQ(e.counts.nodes, 2087414u);
  EXPECT_EQ(e.counts.ways, 387295u);
  EXPECT_EQ(e.counts.relations, 6801u);
  // 1,146 multipolygons without building tags have an outer way with some; two of these share their ways with another.
  EXPECT_EQ(e.counts.old_style_multipolygons, 1144u);
  EXPECT_GE(e.counts.areas_with_holes, 1700u);
  std::uint64_t open = 0, whole = 0, pending = 0;
  for (const auto& b : e.buildings) {
    open += b.code == model::IssueCode::open_way;
    pending += b.state == model::ObjectState::pending;
    whole += b.state == model::ObjectState::pending || b.code == model::IssueCode::lifecycle ||
             b.code == model::IssueCode::underground;
  }
  EXPECT_EQ(open, 45u);  // of 54 unclosed ways: the others are pieces of a multipolygon
  EXPECT_GE(static_cast<double>(pending), 0.999 * static_cast<double>(whole));
}

TEST(RealExtracts, EveryObjectHasOneAccount) {
  if (!fs::exists(kData)) GTEST_SKIP() << "no " << kData;
  int files = 0;
  for (const auto& entry : fs::directory_iterator(kData)) {
    if (!entry.is_regular_file() || entry.file_size() > 5'000'000) continue;
    SCOPED_TRACE(entry.path().filename());
    ++files;
    const auto e = read_extract(entry.path().string());
    EXPECT_EQ(e.counts.buildings() + e.counts.parts(), e.buildings.size());
    EXPECT_TRUE(std::is_sorted(e.buildings.begin(), e.buildings.end(), [](auto& a, auto& b) { return a.id < b.id; }));
    EXPECT_TRUE(std::is_sorted(e.features.begin(), e.features.end(), [](auto& a, auto& b) { return a.id < b.id; }));
    EXPECT_EQ(e.vertices.size(), e.vertex_nodes.size());
    std::uint64_t reported = 0;
    for (const auto& b : e.buildings) {
      EXPECT_EQ(b.state == model::ObjectState::pending, b.rings.count > 0) << b.id.text();
      reported += b.state == model::ObjectState::reported;
      if (b.state == model::ObjectState::duplicate || b.state == model::ObjectState::represented) {
        model::MappedBuilding related;
        related.id = b.related;
        EXPECT_TRUE(std::binary_search(e.buildings.begin(), e.buildings.end(), related, [](auto& x, auto& y) {
          return x.id < y.id;
        })) << b.id.text();
      }
      for (const auto& ring : e.rings_of(b.rings)) EXPECT_GE(ring.vertices.count, 3u) << b.id.text();
    }
    EXPECT_EQ(static_cast<std::uint64_t>(std::count_if(
                  e.report.rows.begin(), e.report.rows.end(),
                  [](const auto& row) { return info(row.code).issue_class == model::IssueClass::reported; })),
              reported);
  }
  EXPECT_GT(files, 10);
}

TEST(RealExtracts, PbfAndXmlOfARealTownGiveTheSame) {
  const fs::path file = kData / "berlin-zionskirchplatz-2020.osm";
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file;
  const TempFolder folder;
  const std::string expected = dump(read_extract(file.string()));
  for (const char* name : {"z.osm.pbf", "z.osm.gz", "z.osm.bz2"}) {
    convert(file.string(), folder.path(name));
    EXPECT_EQ(dump(read_extract(folder.path(name))), expected) << name;
  }
}

}  // namespace
}  // namespace blockrand::importers::osm::test
