// Rings and parts of whole real extracts: nothing invalid leaves, nothing is lost. Prints what was done and how long it
// took; set BLOCKRAND_EXTRACT to look at one file.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include "importers/osm/read_extract.h"
#include "pipeline/base/random.h"
#include "pipeline/footprints/area.h"
#include "pipeline/footprints/load.h"
#include "pipeline/footprints/repair/parts.h"
#include "pipeline/footprints/repair/rings.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/projection.h"

namespace blockrand::repair {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds(Clock::time_point from) { return std::chrono::duration<double>(Clock::now() - from).count(); }

struct Figures {
  std::uint64_t buildings = 0, parts = 0, bodies = 0, points_in = 0, points_out = 0, failed = 0;
  double rings_s = 0, parts_s = 0;
  std::map<std::string, int> codes;
};

void check(const std::vector<model::Polygon>& polygons, const std::string& id) {
  for (const model::Polygon& p : polygons) EXPECT_TRUE(geometry::strictly_simple(p)) << id;
}

void run(const fs::path& file) {
  const model::Extract extract = importers::osm::read_extract(file.string());
  const auto area = footprints::area_of(extract);
  ASSERT_TRUE(area.has_value());
  const georef::Projection projection(
      georef::open_crs(georef::choose_crs(area->centre.lon, area->centre.lat), area->box), area->box);
  model::Report sharding;
  const auto shards = footprints::make_shards(extract, sharding);
  const auto kept_from = Clock::now();
  const KeptNodes kept(extract);
  const double kept_s = seconds(kept_from);
  const RepairOptions options;
  Figures f;
  for (const footprints::Shard& shard : shards) {
    model::Region tile = footprints::load_region(extract, shard, projection);
    for (model::Building& b : tile.buildings) {
      ++f.buildings;
      f.parts += b.parts.size();
      for (const auto& ring : b.rings.rings) f.points_in += ring.size();
      const bool has_rings = !b.rings.rings.empty();
      const std::size_t failures_before = tile.part_failures.size();
      auto from = Clock::now();
      if (has_rings) {
        RepairedRings r = repair_rings(std::move(b.rings), b.osm, kept, options, tile.report);
        b.outline = std::move(r.polygons);
        b.failure = r.failure;
      }
      f.rings_s += seconds(from);
      const std::vector<model::Polygon> before = b.outline;
      std::set<std::uint32_t> mapped;
      for (const auto& p : b.parts) mapped.insert(p.mapped_index);
      from = Clock::now();
      fit_parts(b, before, kept, options, tile.part_failures, tile.settled_parts, tile.report);
      f.parts_s += seconds(from);
      // Nothing lost: every mapped part is a body, a failure or represented by another, every building has a body or a reason.
      for (const auto& p : b.parts) mapped.erase(p.mapped_index);
      for (std::size_t i = failures_before; i < tile.part_failures.size(); ++i)
        mapped.erase(tile.part_failures[i].mapped_index);
      for (const model::SettledPart& p : tile.settled_parts) mapped.erase(p.mapped_index);
      EXPECT_TRUE(mapped.empty()) << b.id();
      EXPECT_EQ(b.parts.empty(), b.failure != model::IssueCode::none) << b.id();
      f.failed += b.parts.empty();
      if (b.parts.empty()) ++f.codes["failure " + std::string(model::info(b.failure).text)];
      check(b.outline, b.id());
      f.bodies += b.parts.size();
      for (const auto& p : b.parts) check({p.plan}, p.id);
      for (const auto& p : b.outline) {
        f.points_out += p.outer.size();
        for (const auto& hole : p.holes) f.points_out += hole.size();
      }
    }
    for (const auto& row : tile.report.rows) ++f.codes[std::string(model::info(row.code).text)];
    if (std::getenv("BLOCKRAND_ROWS"))
      for (const auto& row : tile.report.rows)
        std::printf("  row %s %s %s\n", row.object.text().c_str(), std::string(model::info(row.code).text).c_str(),
                    row.detail.c_str());
  }
  std::printf(
      "%-40s %7llu buildings %6llu parts %7llu bodies %4llu without body, points %llu to %llu, rings %.2f us each, "
      "parts %.2f us each, kept nodes %.3f s\n",
      file.filename().c_str(), static_cast<unsigned long long>(f.buildings), static_cast<unsigned long long>(f.parts),
      static_cast<unsigned long long>(f.bodies), static_cast<unsigned long long>(f.failed),
      static_cast<unsigned long long>(f.points_in), static_cast<unsigned long long>(f.points_out),
      1e6 * f.rings_s / static_cast<double>(f.buildings), 1e6 * f.parts_s / static_cast<double>(f.buildings), kept_s);
  for (const auto& [code, n] : f.codes) std::printf("    %-20s %d\n", code.c_str(), n);
}

TEST(RealRepair, NothingInvalidLeavesAndNothingIsLost) {
  const fs::path folder = fs::path(BLOCKRAND_SHARED_DIR) / "data/osm";
  if (!fs::exists(folder)) GTEST_SKIP() << "no extracts at " << folder;
  const char* one = std::getenv("BLOCKRAND_EXTRACT");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && (!one || entry.path().filename() == one)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_FALSE(files.empty());
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename().string());
    run(file);
  }
}

/// Corners moved by up to 0.25 m each way, the same for the same place; empty where that breaks a polygon.
std::vector<model::Polygon> shaken(std::vector<model::Polygon> polygons) {
  const auto shake = [](model::Ring& ring) {
    for (model::Point2& p : ring.points) {
      const auto offset = [&](const char* axis) {
        const auto place = static_cast<std::uint64_t>(p.x * 1024) * 1000003 + static_cast<std::uint64_t>(p.y * 1024);
        return 0.5 * base::random_unit(1, place, axis) - 0.25;
      };
      p = model::snap(model::Point2{p.x + offset("x"), p.y + offset("y")});
    }
  };
  for (model::Polygon& p : polygons) {
    shake(p.outer);
    for (model::Ring& hole : p.holes) shake(hole);
    if (!geometry::strictly_simple(p)) return {};
  }
  return polygons;
}

double area_of(const std::vector<model::Polygon>& polygons) {
  double sum = 0;
  for (const model::Polygon& p : polygons) sum += geometry::area(p);
  return sum;
}

struct Fit {
  std::size_t bodies = 0;
  double uncovered = 0, outside = 0;  ///< m2, between the outline and the union of its mapped parts
};

Fit fit_of(model::Building b, const std::vector<model::Polygon>& before, const KeptNodes& kept) {
  std::vector<model::PartFailure> failures;
  model::Report report;
  std::vector<model::SettledPart> settled;
  fit_parts(b, before, kept, {}, failures, settled, report);
  std::vector<model::Polygon> plans;
  for (const model::BuildingPart& part : b.parts) {
    EXPECT_TRUE(geometry::strictly_simple(part.plan)) << part.id;
    if (!part.rest) plans.push_back(part.plan);
  }
  return {b.parts.size(), area_of(geometry::difference(b.outline, plans, 0.001, 0.03).polygons),
          area_of(geometry::difference(plans, b.outline, 0.001, 0.03).polygons)};
}

TEST(RealRepair, PartsFollowOutlinesThatMove) {
  const fs::path file = fs::path(BLOCKRAND_SHARED_DIR) / "data/osm/helsinki-centre-2019.osm.pbf";
  if (!fs::exists(file)) GTEST_SKIP() << "no extract " << file;
  const model::Extract extract = importers::osm::read_extract(file.string());
  const auto area = footprints::area_of(extract);
  ASSERT_TRUE(area.has_value());
  const georef::Projection projection(
      georef::open_crs(georef::choose_crs(area->centre.lon, area->centre.lat), area->box), area->box);
  model::Report sharding;
  const KeptNodes kept(extract);
  int buildings = 0, same_bodies = 0;
  Fit still, moved;
  double perimeter = 0;
  for (const footprints::Shard& shard : footprints::make_shards(extract, sharding)) {
    for (model::Building& b : footprints::load_region(extract, shard, projection).buildings) {
      if (!b.has_mapped_parts || b.rings.rings.empty()) continue;
      model::Report report;
      b.outline = repair_rings(b.rings, b.osm, kept, {}, report).polygons;
      const auto target = shaken(b.outline);
      if (target.empty()) continue;
      ++buildings;
      const std::vector<model::Polygon> before = b.outline;
      const Fit as_mapped = fit_of(b, before, kept);
      b.outline = target;
      const Fit after = fit_of(b, before, kept);
      same_bodies += after.bodies == as_mapped.bodies;
      still.uncovered += as_mapped.uncovered, still.outside += as_mapped.outside;
      moved.uncovered += after.uncovered, moved.outside += after.outside;
      for (const auto& p : before) perimeter += geometry::perimeter(p);
      if (after.bodies != as_mapped.bodies || std::getenv("BLOCKRAND_ROWS"))
        std::printf("  %s: bodies %zu to %zu, uncovered %.1f to %.1f, outside %.1f to %.1f\n", b.id().c_str(),
                    as_mapped.bodies, after.bodies, as_mapped.uncovered, after.uncovered, as_mapped.outside,
                    after.outside);
    }
  }
  std::printf(
      "%d buildings, %d with the same bodies; uncovered %.1f to %.1f m2, outside %.1f to %.1f m2, walls %.0f m\n",
      buildings, same_bodies, still.uncovered, moved.uncovered, still.outside, moved.outside, perimeter);
  EXPECT_GT(buildings, 50);
  // Walls that moved without their parts would leave strips of a tenth of a metre along half of all walls.
  EXPECT_LT(moved.uncovered - still.uncovered, 0.01 * perimeter);
  EXPECT_LT(moved.outside - still.outside, 0.01 * perimeter);
  EXPECT_GE(same_bodies, 95 * buildings / 100);
}

}  // namespace
}  // namespace blockrand::repair
