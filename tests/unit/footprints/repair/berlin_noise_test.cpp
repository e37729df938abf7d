// The noise experiment on surveyed footprints: ground surfaces of Berlin's LoD2 model. Skipped where the data is absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "importers/reference/citygml.h"
#include "importers/reference/footprints.h"
#include "pipeline/footprints/repair/repair_terrace_row.h"
#include "pipeline/footprints/repair/rings.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "tests/unit/footprints/repair/noise_scene.h"

namespace blockrand::repair::test {
namespace {

namespace fs = std::filesystem;

/// Footprints as repair gets them: straight walls without points in the middle.
Footprints surveyed() {
  Footprints out;
  const fs::path folder = fs::path(BLOCKRAND_SHARED_DIR) / "data/reference/berlin-lod2";
  if (!fs::exists(folder)) return out;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".gml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  model::Report report;
  std::int64_t number = 0;
  for (const fs::path& file : files) {
    const auto model = importers::reference::read_citygml(file.string());
    for (const auto& footprint : importers::reference::ground_footprints(model)) {
      model::MappedRings rings;
      for (const model::Polygon& p : footprint.polygons) {
        rings.rings.push_back(p.outer);
        rings.inner.push_back(false);
        for (const model::Ring& hole : p.holes) {
          rings.rings.push_back(hole);
          rings.inner.push_back(true);
        }
      }
      if (rings.rings.empty()) continue;
      auto repaired = repair_rings(std::move(rings), {model::OsmType::way, ++number}, {}, {}, report);
      if (!repaired.polygons.empty()) out.push_back(std::move(repaired.polygons));
    }
  }
  // Tiles of different years model some ground twice: what lies over another building is no truth to come back to.
  std::vector<bool> drop(out.size(), false);
  for (std::size_t i = 0; i < out.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!drop[i] && !drop[j] && geometry::common_area(out[i], out[j]) > 0.5)
        drop[geometry::area(out[i][0]) > geometry::area(out[j][0]) ? i : j] = true;
  Footprints apart;
  for (std::size_t i = 0; i < out.size(); ++i)
    if (!drop[i]) apart.push_back(std::move(out[i]));
  return apart;
}

struct Bar {
  double radius;  ///< m
  double walls;   ///< share of shared walls that must come back
  double error;   ///< of the mean vertex error, squared: what may be left
};

// The survey's buildings stand mostly alone (one shared wall for four of them), and 60 % of their corners are no right
// angle of two walls of a metre: nothing says where those were before the noise. Of the others right angles alone cannot
// take more than 29 % off the error (the place of a wall is said twice). The bars are what is reached, with a margin.
class BerlinNoise : public testing::TestWithParam<Bar> {};

TEST_P(BerlinNoise, VerticesComeNearerToTheSurvey) {
  const Footprints truth = surveyed();
  if (truth.empty()) GTEST_SKIP() << "no reference model";
  ASSERT_GT(truth.size(), 100u);
  const Footprints noisy = with_noise(truth, GetParam().radius, 17);
  for (const bool square : {false, true}) {
    RepairOptions options;
    options.square = square;
    TerraceRow all = row_of(noisy);
    model::Report report;
    for (const auto& members : rows_of(noisy, 1)) {
      TerraceRow row;
      for (const std::size_t i : members) row.buildings.push_back(all.buildings[i]);
      repair_terrace_row(row, options, report);
      for (std::size_t k = 0; k < members.size(); ++k) all.buildings[members[k]] = row.buildings[k];
    }
    const Score s = score(truth, noisy, all);
    std::printf("noise %.1f m%s, %zu surveyed buildings: %s\n", GetParam().radius, square ? ", squared" : "",
                truth.size(), s.text().c_str());
    EXPECT_EQ(s.invalid, 0);
    EXPECT_LE(s.overlap, 0.1);
    EXPECT_LE(s.largest_shift, 0.5 + 0.001);
    EXPECT_GE(s.walls_recovered, GetParam().walls * s.walls);
    EXPECT_LE(s.oblique_squared, 0.005 * s.oblique);
    EXPECT_LE(s.error_after, (square ? GetParam().error : 1.01) * s.error_before);
  }
}

INSTANTIATE_TEST_SUITE_P(ByRadius, BerlinNoise,
                         testing::Values(Bar{0.1, 0.995, 1.06}, Bar{0.2, 0.97, 0.95}, Bar{0.3, 0.85, 0.92}));

}  // namespace
}  // namespace blockrand::repair::test
