#include "pipeline/footprints/repair_extract.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/base/memo.h"
#include "pipeline/base/parallel.h"
#include "pipeline/footprints/load.h"
#include "pipeline/footprints/repair/nested_outlines.h"
#include "pipeline/footprints/repair/parts.h"
#include "pipeline/footprints/repair/repair_terrace_row.h"
#include "pipeline/footprints/repair/rings.h"
#include "pipeline/footprints/terrace_rows.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/slivers.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::footprints {

namespace {

using model::Extract;
using model::MappedBuilding;
using model::Point2;
using model::Polygon;

/// Of the mapped area: less is the rounding of coordinates.
constexpr double kAreaChanged = 0.001;

/// m. Where a lowest storey is tagged and no height: the usual storey.
constexpr double kStoreyHeight = 3;

repair::Level level_of(const Extract& extract, const MappedBuilding& b, bool has_parts) {
  repair::Level level;
  const model::MappedAttributes& a = b.attributes;
  level.layer = static_cast<int>(std::lround(a.layer.value_or(0)));
  level.canopy = extract.strings.view(a.use) == "roof";
  if (has_parts) return level;  // parts may reach to the ground whatever the outline says
  if (a.min_height)
    level.low = *a.min_height;
  else if (a.min_storey)
    level.low = *a.min_storey * kStoreyHeight;
  if (a.height && *a.height > level.low) level.high = *a.height;
  return level;
}

double longer_side(const PlanBox& box) {
  return std::max(box.maximum.x - box.minimum.x, box.maximum.y - box.minimum.y);
}

/// m. The largest buildings are 2 km wide. One over a whole country would be everybody's neighbour.
constexpr double kWidestBuilding = 10'000;

bool is_too_large(const model::MappedRings& rings) {
  PlanBox box;
  for (const model::Ring& ring : rings.rings)
    for (const Point2 p : ring.points) box.include(p);
  return !box.empty() && longer_side(box) > kWidestBuilding;
}

struct RingsOfShard {
  std::vector<repair::RepairedRings> outlines;
  model::Report report;
};

void repair_all_rings(const Extract& extract, std::span<const Shard> shards, const georef::Projection& projection,
                      const repair::KeptNodes& kept, const repair::RepairOptions& options, int workers,
                      const base::Memo* memo, RepairedExtract& out, FootprintStore& store) {
  const std::size_t in_flight = static_cast<std::size_t>(workers) * 2 + 2;
  std::vector<RingsOfShard> slots(in_flight);
  const auto reads = [&](std::size_t i, base::Packer& packer) {
    const auto object = [&](std::uint32_t index) {
      const MappedBuilding& mapped = extract.buildings[index];
      packer << mapped.id << mapped.rings.count;
      for (const model::MappedRing& ring : extract.rings_of(mapped.rings)) {
        packer << ring.inner << extract.vertices_of(ring) << extract.nodes_of(ring);
        for (const std::int64_t node : extract.nodes_of(ring)) packer << kept.contains(node);
      }
    };
    for (const Seed& seed : shards[i].seeds) {
      packer << (seed.outline != model::kNoIndex) << static_cast<std::uint64_t>(seed.parts.size());
      if (seed.outline != model::kNoIndex) object(seed.outline);
      for (const std::uint32_t part : seed.parts) object(part);
    }
  };
  const auto repaired_rings = [&](std::size_t i) {
    RingsOfShard result;
    model::Region region = load_region(extract, shards[i], projection);
    for (model::Building& building : region.buildings) {
      if (is_too_large(building.rings)) {
        result.outlines.emplace_back().failure = model::IssueCode::too_large;
        continue;
      }
      if (!building.rings.rings.empty()) {
        result.outlines.push_back(
            repair::repair_rings(std::move(building.rings), building.osm, kept, options, result.report));
        continue;
      }
      // Touching parts without an outline are one building: what they cover together.
      repair::RepairedRings outline;
      outline.polygons = repair::outline_of_parts(building, kept, options);
      if (outline.polygons.empty()) outline.failure = model::IssueCode::zero_area;
      for (const Polygon& p : outline.polygons) outline.mapped_area += geometry::area(p);
      result.outlines.push_back(std::move(outline));
    }
    return result;
  };
  const auto work = [&](std::size_t i) {
    slots[i % in_flight] = base::remembered<RingsOfShard>(
        memo, "rings", [&](base::Packer& packer) { reads(i, packer); }, [&] { return repaired_rings(i); });
  };
  const auto consume = [&](std::size_t i) {
    RingsOfShard result = std::move(slots[i % in_flight]);
    for (std::size_t k = 0; k < result.outlines.size(); ++k) {
      const Seed& seed = shards[i].seeds[k];
      const MappedBuilding& lead = extract.buildings[seed.lead()];
      StoredFootprint f;
      f.id = lead.id;
      f.lead = seed.lead();
      f.has_parts = seed.outline != model::kNoIndex && !seed.parts.empty();
      f.level = level_of(extract, lead, !seed.parts.empty());
      f.failure = result.outlines[k].failure;
      f.record.mapped_area = result.outlines[k].mapped_area;
      store.set(out.first[i] + static_cast<std::uint32_t>(k), f, result.outlines[k].polygons);
    }
    std::move(result.report.rows.begin(), result.report.rows.end(), std::back_inserter(out.rows));
  };
  base::ordered_parallel(shards.size(), workers, in_flight, work, consume);
}

/// For each building of a row: m of its rings that another one at its level has point for point, the other way round.
std::vector<double> shared_lengths(const repair::TerraceRow& row) {
  struct Wall {
    Point2 a, b;
    std::uint32_t building = 0;
    bool forward = true;  ///< from a to b
    auto operator<=>(const Wall&) const = default;
  };
  std::vector<Wall> walls;
  for (std::uint32_t i = 0; i < row.buildings.size(); ++i)
    for (const Polygon& polygon : row.buildings[i].polygons) {
      const auto add = [&](const model::Ring& ring) {
        for (std::size_t k = 0; k < ring.size(); ++k) {
          const Point2 a = ring.points[k], b = ring.points[(k + 1) % ring.size()];
          walls.push_back(a < b ? Wall{a, b, i, true} : Wall{b, a, i, false});
        }
      };
      add(polygon.outer);
      for (const model::Ring& hole : polygon.holes) add(hole);
    }
  std::sort(walls.begin(), walls.end());
  std::vector<double> out(row.buildings.size(), 0);
  for (std::size_t i = 0; i < walls.size();) {
    std::size_t j = i;
    while (j < walls.size() && walls[j].a == walls[i].a && walls[j].b == walls[i].b) ++j;
    const double x = walls[i].b.x - walls[i].a.x, y = walls[i].b.y - walls[i].a.y;
    const auto is_shared = [&](const Wall& wall) {
      return std::any_of(&walls[i], &walls[i] + (j - i), [&](const Wall& other) {
        return other.building != wall.building && other.forward != wall.forward &&
               repair::same_level(row.buildings[other.building].level, row.buildings[wall.building].level);
      });
    };
    for (std::size_t k = i; k < j; ++k)
      if (is_shared(walls[k])) out[walls[k].building] += std::sqrt(x * x + y * y);
    i = j;
  }
  return out;
}

struct RepairedRow {
  repair::TerraceRow row;
  std::vector<double> shared;
};

/// Rows, parallel to the plans of a batch.
struct TerraceRowBatch {
  std::vector<RepairedRow> rows;
  model::Report report;
};

repair::TerraceRow mapped_row(const Extract& extract, const FootprintStore& store, const TerraceRowPlan& plan) {
  repair::TerraceRow row;
  for (const std::uint32_t b : plan.buildings) {
    repair::TerraceBuilding building;
    building.id = store[b].id;
    building.polygons = store.polygons(b);
    building.level = store[b].level;
    building.has_parts = store[b].has_parts;
    building.tags = static_cast<int>(extract.buildings[store[b].lead].tags.count);
    building.record = store[b].record;
    row.buildings.push_back(std::move(building));
  }
  for (const std::uint32_t b : plan.beyond) {
    std::vector<Polygon> polygons = store.polygons(b);
    std::move(polygons.begin(), polygons.end(), std::back_inserter(row.beyond_cut));
  }
  return row;
}

RepairedRow repaired_row(repair::TerraceRow row, const repair::RepairOptions& options, model::Report& report) {
  RepairedRow out;
  out.row = std::move(row);
  if (options.settle_coverings) repair::settle_coverings(out.row, options, report);
  repair::TerraceRow standing;  // what is settled has no polygons left to repair
  standing.beyond_cut = std::move(out.row.beyond_cut);
  for (repair::TerraceBuilding& b : out.row.buildings)
    if (!b.polygons.empty()) standing.buildings.push_back(std::move(b));
  repair::repair_terrace_row(standing, options, report);
  auto repaired = standing.buildings.begin();
  for (std::size_t k = 0; k < out.row.buildings.size(); ++k)
    if (out.row.buildings[k].settled == model::ObjectState::pending) out.row.buildings[k] = std::move(*repaired++);
  out.shared = shared_lengths(out.row);
  return out;
}

bool is_wide(const PlanBox& box) { return longer_side(box) > kMaxTerraceRowExtent; }

/// m. What stands in a wider outline is not all within reach of its tile alone (kHalo): its overlaps stay, and are said.
constexpr double kWidestYielding = 5'000;

/// An outline wider than a row is mostly an area that somebody took for a building: it is cut off from all rows, and
/// gives way to what stands in it, after those were repaired.
void yield_to_neighbours(std::uint32_t b, std::span<const std::uint32_t> beyond, const repair::RepairOptions& options,
                         RepairedExtract& out) {
  StoredFootprint here = out.footprints[b];
  if (!is_wide(here.box) || longer_side(here.box) > kWidestYielding || here.has_parts) return;
  const std::vector<Polygon> outline = out.footprints.polygons(b);
  std::vector<Polygon> taken;
  double most = 0;
  for (const std::uint32_t other : beyond) {
    const StoredFootprint& there = out.footprints[other];
    if (there.box.empty() || is_wide(there.box) || !repair::same_level(here.level, there.level)) continue;
    std::vector<Polygon> polygons = out.footprints.polygons(other);
    const double common = geometry::common_area(outline, polygons);
    if (common <= options.min_overlap_area) continue;
    if (common > most) here.related = there.id;
    most = std::max(most, common);
    std::move(polygons.begin(), polygons.end(), std::back_inserter(taken));
    ++here.record.overlaps_resolved;
  }
  if (taken.empty()) return;
  const std::vector<Polygon> ground = geometry::unite(taken, 0, options.ring_clearance).polygons;
  std::vector<Polygon> rest =
      geometry::difference(outline, ground, options.parts_free_area, options.ring_clearance).polygons;
  geometry::cut_slivers(rest, options.spike_width);
  std::erase_if(rest, [&](const Polygon& p) { return geometry::equivalent_width(p) < options.parts_free_width; });
  here.record.area = 0;
  for (const Polygon& p : rest) here.record.area += geometry::area(p);
  if (rest.empty())
    here.settled = model::ObjectState::represented;
  else
    here.related = {};
  out.rows.push_back({here.id, model::IssueCode::covered_outline,
                      fmt::format("{} within it; {:.2f} m2 of {:.2f} m2 left", here.record.overlaps_resolved,
                                  here.record.area, here.record.mapped_area)});
  out.footprints.set(b, here, rest);
}

/// Rows are repaired apart: what a cut of a long row leaves of overlaps is said.
void report_overlaps_at_cuts(std::span<const TerraceRowPlan> plans, const repair::RepairOptions& options,
                             RepairedExtract& out, RepairTotals& totals) {
  for (const TerraceRowPlan& plan : plans)
    for (const std::uint32_t b : plan.buildings)
      for (const std::uint32_t other : plan.beyond) {
        const StoredFootprint &here = out.footprints[b], &there = out.footprints[other];
        if (here.box.empty() || there.box.empty() || !here.box.near(there.box, 0) ||
            !repair::same_level(here.level, there.level))
          continue;
        const double common = geometry::common_area(out.footprints.polygons(b), out.footprints.polygons(other));
        if (common <= options.min_overlap_area) continue;
        totals.overlaps_left += here.record.overlap_left == 0;
        out.footprints.add_overlap(b, common);
        out.rows.push_back({here.id, model::IssueCode::overlap_kept,
                            fmt::format("{:.2f} m2 with {}, at a cut", common, there.id.text())});
      }
}

class Totals {
 public:
  void add(const StoredFootprint& f) {
    const model::RepairRecord& r = f.record;
    ++totals_.outlines;
    totals_.vertices += r.vertices;
    totals_.moved += r.moved;
    shift_ += r.mean_shift * r.moved;
    totals_.max_shift = std::max(totals_.max_shift, r.max_shift);
    const double change = r.mapped_area > 0 ? std::fabs(r.area - r.mapped_area) / r.mapped_area : 0;
    totals_.area_changed += change > kAreaChanged;
    if (change > kAreaChanged) changes_.push_back(static_cast<float>(change));
    totals_.shared_walls += r.shared_walls;
    totals_.gaps_closed += r.gaps_closed;
    totals_.overlaps_resolved += r.overlaps_resolved;
    totals_.overlaps_left += r.overlap_left > 0;
    totals_.squared += r.direction >= 0;
    totals_.arcs += f.arcs.count;
    totals_.party_wall_length += f.party_wall_length;
  }
  RepairTotals finish() {
    // Both neighbours count what they share; of an overlap only who gave way.
    totals_.shared_walls /= 2;
    totals_.gaps_closed /= 2;
    totals_.party_wall_length /= 2;
    if (totals_.moved > 0) totals_.mean_shift = shift_ / static_cast<double>(totals_.moved);
    if (!changes_.empty()) {
      std::sort(changes_.begin(), changes_.end());
      totals_.median_area_change = static_cast<double>(changes_[changes_.size() / 2]);
      totals_.max_area_change = static_cast<double>(changes_.back());
    }
    return totals_;
  }
  RepairTotals totals_;

 private:
  double shift_ = 0;
  std::vector<float> changes_;
};

}  // namespace

RepairTotals totals_of(std::span<const StoredFootprint> outlines) {
  Totals totals;
  for (const StoredFootprint& f : outlines)
    if (!f.box.empty() && f.settled == model::ObjectState::pending) totals.add(f);
  return totals.finish();
}

RepairedExtract repair_extract(const Extract& extract, std::span<const Shard> shards,
                               const georef::Projection& projection, const repair::KeptNodes& kept,
                               const repair::RepairOptions& options, int workers, base::Progress& progress,
                               const base::Memo* memo) {
  RepairedExtract out;
  std::uint32_t count = 0;
  for (const Shard& shard : shards) {
    out.first.push_back(count);
    count += static_cast<std::uint32_t>(shard.seeds.size());
  }
  progress.begin("repair", count, "buildings");
  FootprintStore mapped(count);
  repair_all_rings(extract, shards, projection, kept, options, workers, memo, out, mapped);

  // Two corners that come towards each other by max_shift each must know of each other.
  const std::vector<TerraceRowPlan> plans = find_terrace_rows(mapped, 2 * options.max_shift);
  // Rows that begin in one shard are one piece of work: which they are does not hang on what was mapped elsewhere.
  const auto shard_of = [&](const TerraceRowPlan& plan) {
    const std::uint32_t least = *std::min_element(plan.buildings.begin(), plan.buildings.end());
    return std::upper_bound(out.first.begin(), out.first.end(), least);
  };
  std::vector<std::size_t> batches{0};
  for (std::size_t i = 1; i < plans.size(); ++i)
    if (shard_of(plans[i]) != shard_of(plans[i - 1])) batches.push_back(i);
  batches.push_back(plans.size());
  out.rows_begun.assign(shards.size(), 0);
  out.row_boxes.assign(count, {});
  for (const TerraceRowPlan& plan : plans) {
    if (plan.buildings.size() > 1) ++out.rows_begun[static_cast<std::size_t>(shard_of(plan) - out.first.begin()) - 1];
    PlanBox box;
    for (const std::vector<std::uint32_t>* buildings : {&plan.buildings, &plan.beyond})
      for (const std::uint32_t b : *buildings) box.include(mapped[b].box);
    // That the row goes on for so long is known from what lies within this distance.
    const double more = plan.beyond.empty() ? 2 * options.max_shift : kMaxTerraceRowExtent;
    box.minimum = {box.minimum.x - more, box.minimum.y - more},
    box.maximum = {box.maximum.x + more, box.maximum.y + more};
    for (const std::uint32_t b : plan.buildings) out.row_boxes[b] = box;
  }
  out.footprints = FootprintStore(count);
  for (std::uint32_t b = 0; b < count; ++b)  // those without an outline are in no row
    if (mapped[b].box.empty()) out.footprints.set(b, mapped[b], {});
  Totals totals;
  const std::size_t in_flight = static_cast<std::size_t>(workers) * 2 + 2;
  std::vector<TerraceRowBatch> slots(in_flight);
  std::uint64_t done = 0;
  const auto work = [&](std::size_t i) {
    std::vector<repair::TerraceRow> rows;
    for (std::size_t k = batches[i]; k < batches[i + 1]; ++k) rows.push_back(mapped_row(extract, mapped, plans[k]));
    slots[i % in_flight] = base::remembered<TerraceRowBatch>(
        memo, "rows", [&](base::Packer& packer) { packer << rows; },
        [&] {
          TerraceRowBatch batch;
          for (repair::TerraceRow& row : rows)
            batch.rows.push_back(repaired_row(std::move(row), options, batch.report));
          return batch;
        });
  };
  const auto consume = [&](std::size_t i) {
    TerraceRowBatch batch = std::move(slots[i % in_flight]);
    for (std::size_t r = 0; r < batch.rows.size(); ++r) {
      RepairedRow& row = batch.rows[r];
      const TerraceRowPlan& plan = plans[batches[i] + r];
      totals.totals_.rows += row.row.buildings.size() > 1;
      std::vector<bool> cut(row.row.buildings.size(), false);
      for (std::size_t k = 0; k < row.row.buildings.size(); ++k) {
        const std::uint32_t b = plan.buildings[k];
        repair::TerraceBuilding& building = row.row.buildings[k];
        StoredFootprint f = mapped[b];
        f.record = building.record;
        f.settled = building.settled;
        f.related = building.related;
        f.record.area = 0;
        for (const Polygon& p : building.polygons) f.record.area += geometry::area(p);
        f.party_wall_length = row.shared[k];
        out.footprints.set(b, f, building.polygons, building.arcs);
        if (building.settled == model::ObjectState::pending) totals.add(out.footprints[b]);
        for (const std::uint32_t other : plan.beyond)
          cut[k] = cut[k] || mapped[b].box.near(mapped[other].box, 2 * options.max_shift);
        if (cut[k]) {
          ++totals.totals_.at_cuts;
          out.rows.push_back({f.id, model::IssueCode::reach_cut, "a row longer than 1 km"});
        }
      }
      done += row.row.buildings.size();
    }
    std::move(batch.report.rows.begin(), batch.report.rows.end(), std::back_inserter(out.rows));
    progress.advance_to(done);
  };
  if (!plans.empty()) base::ordered_parallel(batches.size() - 1, workers, in_flight, work, consume);
  if (options.resolve_overlaps)
    for (const TerraceRowPlan& plan : plans)
      for (const std::uint32_t b : plan.buildings) yield_to_neighbours(b, plan.beyond, options, out);
  report_overlaps_at_cuts(plans, options, out, totals.totals_);
  out.footprints.shrink_to_fit();
  std::sort(out.rows.begin(), out.rows.end());
  out.totals = totals.finish();
  return out;
}

}  // namespace blockrand::footprints
