#include "importers/osm/store_layout.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <osmium/osm/node.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>

#include "importers/osm/read_file.h"
#include "importers/osm/selection.h"
#include "pipeline/base/error.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/sha256.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/model/osm_keys.h"

namespace blockrand::importers::osm::store_layout {

using osmium::OSMObject;

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

Box box_of(const std::array<double, 4>& window) {
  const auto unit = [](double degrees, double most, double add) {
    return static_cast<std::int32_t>(std::clamp(std::floor(degrees / kUnit) + add, -most, most));
  };
  return {unit(window[0], 1.8e9, -1), unit(window[1], 9e8, -1), unit(window[2], 1.8e9, 2), unit(window[3], 9e8, 2)};
}

namespace {

/// The cells that a line leads through, which may go around the globe.
void find_along(std::span<const model::Location> line, std::set<model::TileId>& out) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const model::Location a = line[i], b = line[std::min(i + 1, line.size() - 1)];
    const double dx = static_cast<double>(b.lon) - a.lon, dy = static_cast<double>(b.lat) - a.lat;
    const int pieces = 1 + static_cast<int>(kUnit * std::max(std::abs(dx), std::abs(dy)) / kLineStep);
    for (int k = 0; k < pieces; ++k)
      out.insert(georef::tile_of(model::Location{static_cast<std::int32_t>(a.lon + dx * (k + 0.5) / pieces),
                                                 static_cast<std::int32_t>(a.lat + dy * (k + 0.5) / pieces)},
                                 kLineLevel));
  }
}

void pack_places(const OSMObject& object, base::Packer& p) {
  if (object.type() == osmium::item_type::node) {
    const osmium::Location l = static_cast<const osmium::Node&>(object).location();
    p << l.x() << l.y();
  } else if (object.type() == osmium::item_type::way) {
    for (const osmium::NodeRef& n : static_cast<const osmium::Way&>(object).nodes())
      p << n.ref() << n.location().x() << n.location().y();
  } else {
    for (const osmium::RelationMember& m : static_cast<const osmium::Relation&>(object).members())
      p << m.ref() << static_cast<int>(m.type()) << std::string(m.role());
  }
}

}  // namespace

model::TileId home_of(const Box& box) {
  int level = kFinest;
  while (level > kCoarsest && box.span() > size_of(level)) --level;
  const auto middle = [](std::int64_t a, std::int64_t b) { return static_cast<std::int32_t>((a + b) / 2); };
  return georef::tile_of(model::Location{middle(box.west, box.east), middle(box.south, box.north)}, level);
}

void find_way(const Box& box, std::span<const model::Location> line, std::set<model::TileId>& cells) {
  if (box.empty())
    cells.insert(nowhere());
  else if (box.span() <= kWholeSpan)
    cells.insert(home_of(box));
  else
    find_along(line, cells);
}

void Members::place() {
  late.clear();
  for (auto& [id, r] : relations) r.box = r.reach = {}, r.cells.clear();
  for (auto& [id, r] : relations)
    for (const std::int64_t way : r.ways) r.box.add(ways[way].box);
  for (auto& [id, r] : relations) {
    Box& box = r.reach;
    box = r.box;
    for (const std::int64_t member : r.relations)
      if (const auto found = relations.find(member); found != relations.end()) box.add(found->second.box);
    if (box.empty()) {
      r.cells.insert(nowhere());
    } else if (box.span() <= kWholeSpan) {
      r.cells.insert(home_of(box));
    } else {
      for (const std::int64_t way : r.ways) r.cells.insert(ways[way].cells.begin(), ways[way].cells.end());
    }
  }
  // Members of relations that are relations: buildings of parts that are multipolygons.
  for (auto& [id, r] : relations)
    for (const std::int64_t member : r.relations)
      if (const auto found = relations.find(member); found != relations.end())
        found->second.cells.insert(r.cells.begin(), r.cells.end()), found->second.reach.add(r.reach);
  for (const auto& [id, r] : relations)
    for (const std::int64_t way : r.ways) {
      const MemberWay& known = ways[way];
      if (!known.there) continue;
      if (r.cells == known.cells && r.reach == known.box) continue;
      // In its own cell it is found where its own box is: with the relation it is wherever that reaches.
      LateWay& its = late[way];
      its.cells.insert(r.cells.begin(), r.cells.end());
      its.box.add(r.reach);
    }
}

void write_packed(const std::string& path, std::string bytes) {
  bytes += base::sha256_of(bytes);
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw base::OutputError(path + ": cannot be written. Free some space");
}

std::optional<std::string> read_packed(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return std::nullopt;
  const std::streamoff size = file.tellg();
  if (size < static_cast<std::streamoff>(kHashLength)) return std::nullopt;
  std::string bytes(static_cast<std::size_t>(size), '\0');
  file.seekg(0);
  if (!file.read(bytes.data(), size)) return std::nullopt;
  const std::string hash = bytes.substr(bytes.size() - kHashLength);
  bytes.resize(bytes.size() - kHashLength);
  return base::sha256_of(bytes) == hash ? std::optional(std::move(bytes)) : std::nullopt;
}

std::string sha256_of_cells(std::span<const CellEntry> cells) {
  base::Sha256 hash;
  for (const CellEntry& cell : cells)
    hash.add(std::to_string(cell.tile.level) + "/" + std::to_string(cell.tile.x) + "/" + std::to_string(cell.tile.y) +
             " " + cell.sha256 + "\n");
  return hash.finish();
}

std::string told(const OSMObject& object) {
  base::Packer p;
  p << static_cast<int>(object.type()) << object.id() << object.version()
    << static_cast<std::uint32_t>(object.timestamp());
  for_each_tag(object,
               [&](std::string_view key, std::string_view value) { p << std::string(key) << std::string(value); });
  p << std::string();
  pack_places(object, p);
  return std::move(p.bytes);
}

std::string told_place(const OSMObject& object) {
  base::Packer p;
  p << static_cast<int>(object.type()) << object.id();
  // Storeys of what lies on a layer of its own say whether it stands above the ground.
  bool layered = false;
  for_each_tag(object,
               [&](std::string_view key, std::string_view) { layered = layered || key == model::osm_key::kLayer; });
  for_each_tag(object, [&](std::string_view key, std::string_view value) {
    p << std::string(key);
    if (layered || !tells_look(key)) p << std::string(value);
  });
  p << std::string();
  pack_places(object, p);
  return std::move(p.bytes);
}

}  // namespace blockrand::importers::osm::store_layout

namespace blockrand::importers::osm {

bool tells_look(std::string_view key) {
  using namespace model::osm_key;
  // Not heights: they say which outlines lie above each other.
  constexpr std::array kKeys = {kBuildingLevels,
                                kLevels,
                                kRoofLevels,
                                kBuildingRoofLevels,
                                kRoofShape,
                                kRoofHeight,
                                kRoofAngle,
                                kRoofDirection,
                                kRoofOrientation,
                                kRoofMaterial,
                                kRoofColour,
                                kStartDate,
                                kBuildingMaterial,
                                kBuildingColour,
                                kBuildingRoofShape,
                                kFacadeColour,
                                kFacadeMaterial,
                                kBuildingFacadeMaterial,
                                kBuildingFacadeColour,
                                kBuildingArchitecture};
  return std::ranges::find(kKeys, key) != kKeys.end();
}

}  // namespace blockrand::importers::osm
