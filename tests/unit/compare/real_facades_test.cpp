// Facades of real models: FZK house, whose openings were counted by reading the files, and Ingolstadt. Skipped where
// the data is absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "pipeline/compare/read_city.h"
#include "tests/unit/compare/facade_scene.h"

namespace blockrand::compare::test {
namespace {

namespace fs = std::filesystem;
const fs::path kModels = fs::path(BLOCKRAND_SHARED_DIR) / "data/reference";

/// Windows, doors, storeys, axes of each facade.
using Row = std::tuple<std::size_t, std::size_t, int, int>;
std::vector<Row> rows(const std::vector<Facade>& facades) {
  std::vector<Row> out;
  for (const Facade& f : facades) {
    const auto doors = static_cast<std::size_t>(
        std::count_if(f.openings.begin(), f.openings.end(), [](const auto& o) { return o.door; }));
    out.emplace_back(f.openings.size() - doors, doors, f.storeys, f.axes);
  }
  return out;
}

TEST(RealFacades, OfTheFzkHouse) {
  const fs::path path = kModels / "fzk-haus/FZK-House-LoD3-KIT-IAI-KHH-V2.gml";
  if (!fs::exists(path)) GTEST_SKIP() << "no " << path;
  const City city = read_city({path}, {});
  ASSERT_EQ(city.buildings.size(), 1U);
  std::size_t loose = 99;
  const auto found = facades_of(city, all_of(city), ground_of(city), {}, &loose);
  EXPECT_EQ(loose, 0U);
  // Gable with door, two windows below and a round one above; the other gable without a door; eaves side with a door of
  // two leaves between two windows; eaves side with three windows.
  EXPECT_THAT(rows(found),
              testing::UnorderedElementsAre(Row{3, 1, 2, 3}, Row{3, 0, 2, 2}, Row{2, 1, 1, 3}, Row{3, 0, 1, 3}));
  // 10 x 12 m, eaves at 3.43, ridge at 6.32 less half the roof's thickness, ground at -0.2; holes and reveals filled.
  EXPECT_NEAR(found[0].width(), 10, 0.001);
  EXPECT_NEAR(found[2].width(), 12, 0.001);
  EXPECT_NEAR(found[2].area, 12 * 3.63, 0.1);
  EXPECT_TRUE(std::none_of(found.begin(), found.end(), [](const Facade& f) { return f.blank; }));
}

TEST(RealFacades, OfTheSmallFzkHouse) {
  const fs::path path = kModels / "fzk-haus/Building_LOD3-EPSG25832.gml";
  if (!fs::exists(path)) GTEST_SKIP() << "no " << path;
  const City city = read_city({path}, {});
  const auto found = facades(city);
  EXPECT_THAT(rows(found),
              testing::UnorderedElementsAre(Row{2, 0, 1, 2}, Row{0, 0, 0, 0}, Row{0, 1, 1, 1}, Row{0, 0, 0, 0}));
  EXPECT_NEAR(found[0].area, 30, 1e-6);
  EXPECT_NEAR(found[2].area, 20, 1e-6);
}

TEST(RealFacades, OfIngolstadt) {
  const fs::path path = kModels / "ingolstadt-lod3";
  if (!fs::exists(path)) GTEST_SKIP() << "no " << path;
  City city = read_city({path}, {});
  std::size_t openings = 0, in = 0, loose = 0, facade_count = 0;
  double area = 0, blank = 0;
  std::vector<std::vector<std::uint32_t>> groups;
  for (std::uint32_t b = 0; b < city.buildings.size(); ++b) {
    groups.push_back({b});
    std::size_t loose_here = 0, in_here = 0;
    for (const Facade& f : facades_of(city, groups.back(), city.buildings[b].ground, {}, &loose_here)) {
      ++facade_count;
      in_here += f.openings.size();
      area += f.area;
      if (f.blank) blank += f.area;
      EXPECT_EQ(f.storeys > 0, !f.openings.empty());
      EXPECT_EQ(f.axes > 0, !f.openings.empty());
      EXPECT_LE(f.storeys, 6);
    }
    const std::size_t here = city.buildings[b].openings.size();
    openings += here;
    in += in_here;
    loose += loose_here;
    // The worst has its openings in dormers and in a glazed bay.
    EXPECT_GE(in_here * 3, here * 2) << city.buildings[b].id;
  }
  RecordProperty("openings", static_cast<int>(openings));
  RecordProperty("in_facades", static_cast<int>(in));
  RecordProperty("facades", static_cast<int>(facade_count));
  RecordProperty("blank_share", std::to_string(blank / area));
  // 636 windows and 33 doors stand in the files; 16 of them belong to a repetition or have no area.
  EXPECT_GE(openings, 650U);
  EXPECT_GE(static_cast<double>(in), 0.96 * static_cast<double>(openings));
  EXPECT_LE(openings - in - loose, 2U) << "drawn twice";
  // The street sides are modelled, courtyards and party walls are not: about half of all walls.
  EXPECT_NEAR(blank / area, 0.48, 0.03);
  const std::size_t marked = mark_blank(city, groups);
  EXPECT_NEAR(static_cast<double>(marked), 83, 5);
  // Against itself all is ideal, blank sides and all.
  for (const auto& group : groups) {
    MeasureValues values;
    measure_facades(compare_facades(city, group, 0, city, group, 0), city, group, city, group, values);
    const MeasureValue& recall = value(values, Measure::opening_recall);
    if (!recall.counted) continue;
    EXPECT_EQ(recall.counted, 1.0);
    EXPECT_EQ(value(values, Measure::opening_precision).all, 1.0);
    EXPECT_EQ(value(values, Measure::axes_error).counted, 0.0);
    EXPECT_EQ(value(values, Measure::window_to_wall_error).counted, 0.0);
  }
}

}  // namespace
}  // namespace blockrand::compare::test
