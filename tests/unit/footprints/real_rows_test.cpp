// Repair of whole real extracts, judged by other means than its own: GEOS measures what overlaps.
//
// Prints a line per extract: the table of what repair did.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>

#include "importers/osm/read_extract.h"
#include "pipeline/base/parallel.h"
#include "pipeline/footprints/area.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/terrace_rows.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/projection.h"
#include "tests/unit/geometry/find_slivers.h"

namespace blockrand::footprints {
namespace {

using model::Polygon;

struct Validated {
  std::size_t invalid = 0, unreported_overlaps = 0, reported = 0, missing = 0, slivers = 0, collapsed = 0;
  double worst = 0;
};

/// m. Shorter slivers are corners that rounding to the grid has bent.
constexpr double kLeastNeedle = 0.1;

std::size_t slivers_of(const Polygon& polygon, const repair::RepairOptions& options, const std::string& id) {
  std::size_t count = 0;
  const auto look = [&](const model::Ring& ring) {
    for (const geometry::Sliver& sliver : geometry::find_slivers(ring, options.spike_width)) {
      if (sliver.length <= kLeastNeedle) continue;
      ++count;
      std::printf("    %s at a corner of %s, %.2f m\n", sliver.outward ? "needle" : "crack", id.c_str(), sliver.length);
    }
  };
  look(polygon.outer);
  for (const model::Ring& hole : polygon.holes) look(hole);
  return count;
}

Validated judge(const RepairedExtract& repaired, const repair::RepairOptions& options) {
  Validated out;
  const FootprintStore& store = repaired.footprints;
  std::set<model::OsmId> said;
  for (const model::ReportRow& row : repaired.rows)
    if (row.code == model::IssueCode::overlap_kept || row.code == model::IssueCode::reach_cut) said.insert(row.object);
  for (std::uint32_t b = 0; b < store.size(); ++b) {
    if (store[b].box.empty()) {
      out.missing += store[b].failure == model::IssueCode::none && store[b].settled == model::ObjectState::pending;
      continue;
    }
    for (const Polygon& p : store.polygons(b)) {
      out.invalid += !geometry::strictly_simple(p);
      out.collapsed += geometry::area(p) < options.min_piece_area / 2;
      out.slivers += slivers_of(p, options, store[b].id.text());
    }
  }
  std::set<std::uint32_t> reported;
  for (const auto& [a, b] : index_of(store).pairs(0)) {
    if (!repair::same_level(store[a].level, store[b].level)) continue;
    const double common = geometry::common_area(store.polygons(a), store.polygons(b));
    if (common <= options.min_overlap_area) continue;
    if (said.contains(store[a].id) && said.contains(store[b].id)) {
      reported.insert(a);
      reported.insert(b);
      continue;
    }
    ++out.unreported_overlaps;
    out.worst = std::max(out.worst, common);
    if (out.unreported_overlaps < 10)
      std::printf("    overlap %s %s %.2f m2\n", store[a].id.text().c_str(), store[b].id.text().c_str(), common);
  }
  out.reported = reported.size();
  return out;
}

class RealExtracts : public ::testing::TestWithParam<const char*> {};

TEST_P(RealExtracts, AreRepaired) {
  const std::string path = std::string(BLOCKRAND_SHARED_DIR) + "/data/osm/" + GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const model::Extract extract = importers::osm::read_extract(path);
  const auto area = area_of(extract);
  ASSERT_TRUE(area);
  const georef::Crs crs = georef::open_crs(georef::choose_crs(area->centre.lon, area->centre.lat), area->box);
  const georef::Projection projection(crs, area->box);
  model::Report report;
  const std::vector<Shard> shards = make_shards(extract, report);
  base::Progress progress;
  const repair::KeptNodes kept(extract);
  const repair::RepairOptions options;
  const auto start = std::chrono::steady_clock::now();
  const RepairedExtract repaired =
      repair_extract(extract, shards, projection, kept, options, base::worker_count(0), progress);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const RepairTotals& t = repaired.totals;
  const Validated validated = judge(repaired, options);
  std::printf(
      "| %s | %llu | moved %llu of %llu, mean %.3f m, max %.3f m | area changed %llu, median %.4f %%, max %.2f %% | "
      "shared walls %llu | gaps closed %llu | overlaps resolved %llu, left %zu | cut %llu | squared %llu | arcs %llu | "
      "%.2f s |\n",
      GetParam(), static_cast<unsigned long long>(t.outlines), static_cast<unsigned long long>(t.moved),
      static_cast<unsigned long long>(t.vertices), t.mean_shift, t.max_shift,
      static_cast<unsigned long long>(t.area_changed), 100 * t.median_area_change, 100 * t.max_area_change,
      static_cast<unsigned long long>(t.shared_walls), static_cast<unsigned long long>(t.gaps_closed),
      static_cast<unsigned long long>(t.overlaps_resolved), validated.reported,
      static_cast<unsigned long long>(t.at_cuts), static_cast<unsigned long long>(t.squared),
      static_cast<unsigned long long>(t.arcs), seconds);
  EXPECT_EQ(validated.invalid, 0u);
  EXPECT_EQ(validated.collapsed, 0u) << "pieces that repair has squeezed to nothing";
  // A court that moved corners would turn inside out goes back, and what its neighbour fitted to it may leave a crack:
  // one in the 238,000 footprints of Berlin.
  EXPECT_LE(validated.slivers, repaired.footprints.size() / 200000);
  EXPECT_EQ(validated.missing, 0u) << "buildings without an outline and without a reason";
  EXPECT_EQ(validated.unreported_overlaps, 0u) << "largest " << validated.worst << " m2";
  EXPECT_LE(static_cast<double>(validated.reported), std::max(2.0, 0.001 * static_cast<double>(t.outlines)));
  EXPECT_LE(t.max_shift, options.max_shift + 0.002);
}

INSTANTIATE_TEST_SUITE_P(
    Small, RealExtracts,
    ::testing::Values("berlin-luisenstadt-2021.osm", "berlin-mitte-2014.osm.pbf", "berlin-pariser-platz-2014.osm.pbf",
                      "berlin-unter-den-linden-clipped.osm.gz", "berlin-zionskirchplatz-2020.osm",
                      "berlin_frankfurter_allee.osm.pbf", "berlin_karl_marx_allee.osm.pbf",
                      "dortmund-innenstadt.osm.gz", "helsinki-centre-2019.osm.pbf", "husum_altstadt.osm.pbf",
                      "ingolstadt-altstadt.osm", "lauf-2020-clipped.osm.pbf", "liechtenstein-2013-08-03.osm.pbf",
                      "liechtenstein-2022-12.osm.pbf", "monaco-2021.osm.pbf", "volgograd-south-2024.osm.gz"));
INSTANTIATE_TEST_SUITE_P(City, RealExtracts, ::testing::Values("berlin-2014-06.osm.pbf"));

}  // namespace
}  // namespace blockrand::footprints
