#include "pipeline/run/area_record.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <set>

#include "pipeline/base/sha256.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/run/data_identity.h"

namespace blockrand::run {
namespace {

using footprints::kTileLevel;
using model::kNoIndex;
using model::OsmId;
using model::TileId;

/// What has no place.
constexpr TileId kNowhere{kTileLevel + 1, ~0u, ~0u};
/// m around a tile's buildings: what a plan of them shows of streets (their half width, their ends).
constexpr double kShownAround = 60;

class Recorder {
 public:
  Recorder(const RecordInputs& in, const std::function<bool(const TileId&)>& wanted) : in_(in), wanted_(wanted) {}

  AreaRecord record() {
    find_owners();
    take_objects();
    take_buildings();
    take_things();
    take_rows();
    take_context();
    take_lines();
    return std::move(out_);
  }

 private:
  bool is_here(const TileId& tile) const {
    return tile == kNowhere ? in_.area.placeless && wanted_(tile)
                            : georef::contains(in_.area.id, tile) && wanted_(tile);
  }

  TileId tile_at(model::Location place) const { return georef::tile_of(place, kTileLevel); }

  void find_owners() {
    owner_.resize(in_.extract.buildings.size());
    for (std::size_t i = 0; i < owner_.size(); ++i) {
      const model::MappedBuilding& b = in_.extract.buildings[i];
      const std::optional<model::Location> place =
          b.rings.count > 0 ? std::optional(footprints::box_centre(in_.extract, b)) : b.place;
      owner_[i] = place ? tile_at(*place) : kNowhere;
    }
    for (const footprints::Shard& shard : in_.shards)
      for (const footprints::Seed& seed : shard.seeds) {
        if (seed.outline != kNoIndex) owner_[seed.outline] = shard.tile;
        for (const std::uint32_t part : seed.parts) owner_[part] = shard.tile;
      }
  }

  void take_objects() {
    index_.assign(owner_.size(), kNoIndex);
    std::map<TileId, std::vector<std::uint32_t>> objects;
    for (std::uint32_t i = 0; i < owner_.size(); ++i) {
      if (!is_here(owner_[i])) continue;
      const model::MappedBuilding& b = in_.extract.buildings[i];
      TileRecord& tile = out_[owner_[i]];
      index_[i] = static_cast<std::uint32_t>(tile.objects.size());
      RecordedObject object{b.id, b.kind, b.state, b.code, b.related, b.place, b.edited, false, false};
      if (b.rings.count > 0) object.place = footprints::box_centre(in_.extract, b);
      for (const model::MappedRing& ring : in_.extract.rings_of(b.rings)) object.has_holes |= ring.inner;
      object.old_style = b.rings.count > 0 && b.geometry_from != b.id;
      tile.objects.push_back(object);
      objects[owner_[i]].push_back(i);
    }
    for (const auto& [tile, indices] : objects) out_[tile].data_sha256 = data_sha256(in_.extract, indices);
  }

  void take_buildings() {
    for (std::size_t s = 0; s < in_.shards.size(); ++s) {
      const footprints::Shard& shard = in_.shards[s];
      if (!is_here(shard.tile)) continue;
      TileRecord& tile = out_[shard.tile];
      tile.is_tile = true;
      tile.terrace_rows = in_.repaired.rows_begun[s];
      for (std::size_t i = 0; i < shard.seeds.size(); ++i) {
        const footprints::Seed& seed = shard.seeds[i];
        const std::uint32_t number = in_.repaired.first[s] + static_cast<std::uint32_t>(i);
        RecordedBuilding b;
        if (seed.outline != kNoIndex) b.outline = index_[seed.outline];
        for (const std::uint32_t part : seed.parts) b.parts.push_back(index_[part]);
        b.footprint = in_.repaired.footprints[number];
        b.footprint.rings = {}, b.footprint.lead = kNoIndex;
        b.polygons = in_.repaired.footprints.polygons(number);
        tile.buildings.push_back(std::move(b));
      }
      for (const RecordedBuilding& b : tile.buildings) {
        const auto [from, to] =
            std::ranges::equal_range(in_.repaired.rows, b.footprint.id, {}, &model::ReportRow::object);
        tile.at_cuts += std::ranges::any_of(
            from, to, [](const model::ReportRow& row) { return row.code == model::IssueCode::reach_cut; });
      }
    }
  }

  /// The tile of the first vertex.
  TileId tile_of(const model::Feature& feature) const {
    for (const model::MappedRing& ring : in_.extract.rings_of(feature.rings))
      if (const auto vertices = in_.extract.vertices_of(ring); !vertices.empty()) return tile_at(vertices.front());
    return kNowhere;
  }

  void take_things() {
    if (!in_.thing_of) return;
    for (const model::Feature& feature : in_.extract.features) {
      const TileId tile = tile_of(feature);
      if (!is_here(tile)) continue;
      if (const std::optional<RecordedThing> thing = in_.thing_of(feature)) out_[tile].things.push_back(*thing);
    }
  }

  /// Rows of objects stand with these, others in the tile of the first vertex.
  void take_rows() {
    std::map<OsmId, TileId> features;
    for (const model::Feature& f : in_.extract.features)
      if (const TileId tile = tile_of(f); tile != kNowhere) features.emplace(f.id, tile);
    const auto& buildings = in_.extract.buildings;
    for (const model::ReportRow& row : in_.rows) {
      const auto object = std::ranges::lower_bound(buildings, row.object, {}, &model::MappedBuilding::id);
      TileId tile;
      if (object != buildings.end() && object->id == row.object) {
        tile = owner_[static_cast<std::size_t>(object - buildings.begin())];
      } else {
        const auto feature = features.find(row.object);
        if (feature == features.end()) continue;
        tile = feature->second;
      }
      if (is_here(tile)) out_[tile].rows.push_back(row);
    }
    for (auto& [id, tile] : out_) std::ranges::sort(tile.rows);
  }

  void take_context() {
    const footprints::FootprintStore& store = in_.repaired.footprints;
    const context::ContextExtract& c = in_.context;
    std::vector<const TileId*> tile_of(store.size());
    for (std::size_t s = 0; s < in_.shards.size(); ++s)
      if (is_here(in_.shards[s].tile))
        for (std::size_t i = 0; i < in_.shards[s].seeds.size(); ++i)
          tile_of[in_.repaired.first[s] + i] = &in_.shards[s].tile;
    std::vector<std::set<TileId>> blocks(c.blocks.size());
    for (std::uint32_t b = 0; b < store.size(); ++b) {
      if (!tile_of[b]) continue;
      if (c.block_of[b] != kNoIndex) blocks[c.block_of[b]].insert(*tile_of[b]);
      if (store[b].box.empty()) continue;
      const context::CellIndex cell = context::cell_of_building(store, b);
      if (const auto sums = c.cells.find(cell); sums != c.cells.end()) out_[*tile_of[b]].cells.insert(*sums);
    }
    for (const context::ExtractCourtyard& yard : c.courtyards) {
      std::set<TileId> tiles;
      RecordedCourtyard recorded;
      for (const std::uint32_t b : yard.courtyard.buildings) {
        if (tile_of[b]) tiles.insert(*tile_of[b]);
        recorded.buildings.push_back(store[b].id);
      }
      if (tiles.empty()) continue;
      if (yard.block != kNoIndex) {
        recorded.block = c.blocks[yard.block].id;
        blocks[yard.block].insert(tiles.begin(), tiles.end());
      }
      recorded.courtyard = yard.courtyard;
      recorded.courtyard.buildings.clear();
      for (const TileId& tile : tiles) out_[tile].courtyards.push_back(recorded);
    }
    for (std::uint32_t b = 0; b < c.blocks.size(); ++b) {
      // What is too large is another one with every window.
      if (c.blocks[b].too_large) continue;
      for (const std::uint32_t building : c.figures[b].buildings)
        if (tile_of[building]) blocks[b].insert(*tile_of[building]);
      if (c.figures[b].buildings.empty()) {
        const georef::LonLat corner = in_.projection.inverse(c.blocks[b].polygon.outer.points.front());
        constexpr double kUnits = 1e7;
        const TileId tile = tile_at({static_cast<std::int32_t>(std::lround(corner.lon * kUnits)),
                                     static_cast<std::int32_t>(std::lround(corner.lat * kUnits))});
        if (is_here(tile)) blocks[b].insert(tile);
      }
      if (blocks[b].empty()) continue;
      RecordedBlock recorded{c.blocks[b], {}, c.figures[b], {}};
      recorded.figures.buildings.clear();
      for (const context::BlockBorder& border : c.blocks[b].borders) recorded.lines.push_back(c.lines[border.line].id);
      for (context::BlockBorder& border : recorded.block.borders) border.line = 0;
      for (const std::uint32_t building : c.figures[b].buildings) recorded.buildings.push_back(store[building].id);
      for (const TileId& tile : blocks[b]) out_[tile].blocks.push_back(recorded);
    }
  }

  /// Streets that bound the blocks of a tile, or that a plan of its buildings shows.
  void take_lines() {
    std::vector<geometry::PlanBox> boxes;
    for (const context::NetworkLine& line : in_.context.lines) boxes.push_back(geometry::box_of(line.points));
    const geometry::BoxIndex index(std::move(boxes));
    std::map<OsmId, std::vector<std::uint32_t>> by_id;
    for (std::uint32_t i = 0; i < in_.context.lines.size(); ++i) by_id[in_.context.lines[i].id].push_back(i);
    for (auto& [id, tile] : out_) {
      std::set<std::uint32_t> lines;
      for (const RecordedBlock& block : tile.blocks)
        for (const OsmId line : block.lines) lines.insert(by_id[line].begin(), by_id[line].end());
      geometry::PlanBox box;
      for (const RecordedBuilding& b : tile.buildings) box.include(b.footprint.box);
      if (!box.empty())
        for (const std::uint32_t i : index.near(box, kShownAround)) lines.insert(i);
      for (const std::uint32_t i : lines)
        if (const context::NetworkLine& line = in_.context.lines[i]; line.kind != context::LineClass::other)
          tile.lines.push_back(line), tile.lines.back().nodes.clear();
    }
  }

  const RecordInputs& in_;
  const std::function<bool(const TileId&)>& wanted_;
  AreaRecord out_;
  std::vector<TileId> owner_;         ///< by object
  std::vector<std::uint32_t> index_;  ///< by object: in its tile's record
};

bool line_before(const context::NetworkLine& a, const context::NetworkLine& b) {
  const auto point = [](const model::Point2& p) { return std::pair(p.x, p.y); };
  if (a.id != b.id) return a.id < b.id;
  return std::ranges::lexicographical_compare(a.points, b.points, {}, point, point);
}

}  // namespace

AreaRecord record_area(const RecordInputs& inputs, const std::function<bool(const TileId&)>& wanted) {
  return Recorder(inputs, wanted).record();
}

AreaReach reaches_in(const AreaRecord& record) {
  AreaReach out;
  for (const auto& [tile, told] : record) out.emplace(tile, told.reach);
  return out;
}

AreaAsTold told_area(const AreaRecord& record, std::span<const model::Point2> coverage) {
  AreaAsTold out;
  std::vector<std::pair<OsmId, std::pair<const TileRecord*, std::uint32_t>>> objects;
  std::uint32_t newest = 0;
  base::Sha256 data;
  for (const auto& [id, tile] : record) {
    for (std::uint32_t i = 0; i < tile.objects.size(); ++i) objects.push_back({tile.objects[i].id, {&tile, i}});
    data.add(tile.data_sha256);
    out.things.insert(out.things.end(), tile.things.begin(), tile.things.end());
    out.rows.insert(out.rows.end(), tile.rows.begin(), tile.rows.end());
  }
  out.data_sha256 = data.finish();
  std::ranges::sort(out.things, {}, &RecordedThing::id);
  std::ranges::sort(objects, {}, [](const auto& o) { return o.first; });
  std::map<const TileRecord*, std::vector<std::uint32_t>> place_of;  // of a tile's objects in the extract
  for (const auto& [id, where] : objects) {
    const RecordedObject& o = where.first->objects[where.second];
    std::vector<std::uint32_t>& places = place_of[where.first];
    places.resize(where.first->objects.size());
    places[where.second] = static_cast<std::uint32_t>(out.extract.buildings.size());
    model::MappedBuilding b;
    b.id = o.id, b.kind = o.kind, b.state = o.state, b.code = o.code, b.related = o.related, b.geometry_from = o.id;
    b.place = o.place, b.edited = o.edited;
    out.extract.buildings.push_back(b);
    out.counts.areas_with_holes += o.has_holes, out.counts.old_style_multipolygons += o.old_style;
    newest = std::max(newest, o.edited);
  }
  if (newest > 0) out.data_time = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(newest)));

  // Buildings by their tiles, then those that are known by name alone.
  std::map<OsmId, std::uint32_t> numbers;
  std::uint32_t count = 0;
  for (const auto& [id, tile] : record) {
    if (!tile.is_tile) continue;
    out.repaired.first.push_back(count);
    out.repaired.rows_begun.push_back(tile.terrace_rows);
    footprints::Shard& shard = out.shards.emplace_back(footprints::Shard{id, {}});
    const std::vector<std::uint32_t>& places = place_of[&tile];
    for (const RecordedBuilding& b : tile.buildings) {
      footprints::Seed& seed = shard.seeds.emplace_back();
      if (b.outline != kNoIndex) seed.outline = places[b.outline];
      for (const std::uint32_t part : b.parts) seed.parts.push_back(places[part]);
      numbers.emplace(b.footprint.id, count++);
    }
  }
  std::map<std::string, const RecordedBlock*> blocks;
  std::map<std::string, const RecordedCourtyard*> courtyards;
  std::vector<const context::NetworkLine*> lines;
  for (const auto& [id, tile] : record) {
    for (const RecordedBlock& block : tile.blocks) blocks.emplace(block.block.id, &block);
    for (const RecordedCourtyard& yard : tile.courtyards) courtyards.emplace(yard.courtyard.id, &yard);
    for (const context::NetworkLine& line : tile.lines) lines.push_back(&line);
    out.context.cells.insert(tile.cells.begin(), tile.cells.end());
  }
  std::vector<OsmId> elsewhere;
  const auto number = [&](OsmId id) {
    const auto [found, added] = numbers.emplace(id, count);
    if (added) ++count, elsewhere.push_back(id);
    return found->second;
  };
  std::ranges::sort(lines, [](const auto* a, const auto* b) { return line_before(*a, *b); });
  std::map<OsmId, std::uint32_t> line_of;
  for (const context::NetworkLine* line : lines) {
    if (!out.context.lines.empty() && !line_before(out.context.lines.back(), *line)) continue;
    line_of.emplace(line->id, static_cast<std::uint32_t>(out.context.lines.size()));
    out.context.lines.push_back(*line);
  }
  std::map<std::string, std::uint32_t> block_of;
  for (const auto& [id, recorded] : blocks) {
    block_of.emplace(id, static_cast<std::uint32_t>(out.context.blocks.size()));
    context::Block& block = out.context.blocks.emplace_back(recorded->block);
    for (std::size_t i = 0; i < block.borders.size(); ++i) block.borders[i].line = line_of.at(recorded->lines[i]);
    context::BlockFigures& figures = out.context.figures.emplace_back(recorded->figures);
    for (const OsmId building : recorded->buildings) figures.buildings.push_back(number(building));
  }
  for (const auto& [id, recorded] : courtyards) {
    context::ExtractCourtyard& yard = out.context.courtyards.emplace_back();
    yard.courtyard = recorded->courtyard;
    if (!recorded->block.empty()) yard.block = block_of.at(recorded->block);
    for (const OsmId building : recorded->buildings) yard.courtyard.buildings.push_back(number(building));
  }
  out.context.block_of.assign(count, kNoIndex);
  for (std::uint32_t i = 0; i < out.context.blocks.size(); ++i)
    if (!out.context.blocks[i].too_large)
      for (const std::uint32_t building : out.context.figures[i].buildings) out.context.block_of[building] = i;
  out.context.coverage.assign(coverage.begin(), coverage.end());

  footprints::FootprintStore& store = out.repaired.footprints;
  store = footprints::FootprintStore(count);
  std::uint32_t at = 0;
  std::vector<footprints::StoredFootprint> outlines;
  for (const auto& [id, tile] : record)
    for (const RecordedBuilding& b : tile.buildings) {
      store.set(at++, b.footprint, b.polygons);
      outlines.push_back(b.footprint);
    }
  out.repaired.totals = footprints::totals_of(outlines);
  for (const auto& [id, tile] : record)
    out.repaired.totals.rows += tile.terrace_rows, out.repaired.totals.at_cuts += tile.at_cuts;
  for (const OsmId id : elsewhere) {
    footprints::StoredFootprint by_name;  // a building elsewhere: nothing but its id is told
    by_name.id = id;
    store.set(at++, by_name, {});
  }
  return out;
}

}  // namespace blockrand::run
