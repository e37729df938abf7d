#include "pipeline/cli/extract_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "pipeline/base/text.h"
#include "pipeline/cli/plan_report.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/model/osm_keys.h"

namespace blockrand::cli {
namespace {

namespace osm_key = model::osm_key;
using base::with_byte_unit;
using base::with_thousands;
using model::FeatureKind;
using model::ObjectKind;
using model::ObjectState;

// The keys that decide what a building looks like; https://wiki.openstreetmap.org/wiki/Simple_3D_Buildings.
constexpr std::string_view kKeys[] = {osm_key::kHeight,
                                      osm_key::kMinHeight,
                                      osm_key::kBuildingLevels,
                                      osm_key::kBuildingMinLevel,
                                      osm_key::kRoofShape,
                                      osm_key::kRoofLevels,
                                      osm_key::kRoofHeight,
                                      osm_key::kRoofAngle,
                                      osm_key::kRoofDirection,
                                      osm_key::kRoofOrientation,
                                      osm_key::kBuildingColour,
                                      osm_key::kBuildingMaterial,
                                      osm_key::kRoofColour,
                                      osm_key::kRoofMaterial,
                                      osm_key::kAddrHousenumber,
                                      osm_key::kStartDate,
                                      osm_key::kBuildingLevelsUnderground};

constexpr std::pair<FeatureKind, const char*> kFeatureNames[] = {{FeatureKind::street, "streets"},
                                                                 {FeatureKind::land_use, "land use"},
                                                                 {FeatureKind::water, "water"},
                                                                 {FeatureKind::railway, "railways"},
                                                                 {FeatureKind::barrier, "barriers"},
                                                                 {FeatureKind::tree, "trees"},
                                                                 {FeatureKind::entrance, "entrances"},
                                                                 {FeatureKind::address, "addresses"},
                                                                 {FeatureKind::shop, "shops"},
                                                                 {FeatureKind::amenity, "amenities"},
                                                                 {FeatureKind::passage, "passages"},
                                                                 {FeatureKind::roof_line, "roof lines"},
                                                                 {FeatureKind::roof_apex, "roof apices"},
                                                                 {FeatureKind::place, "places"},
                                                                 {FeatureKind::boundary, "boundaries"}};

constexpr std::size_t kShownValues = 12;

using IdCounts = std::unordered_map<base::StringId, std::uint64_t>;

std::vector<Frequency> by_frequency(const IdCounts& counts, const base::StringPool& strings) {
  std::vector<Frequency> all;
  for (const auto& [id, count] : counts)
    if (id != 0) all.emplace_back(strings.view(id), count);
  std::sort(all.begin(), all.end(), [](const Frequency& a, const Frequency& b) {
    return a.second != b.second ? a.second > b.second : a.first < b.first;
  });
  return all;
}

std::int64_t median(std::vector<std::int64_t>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Degrees in [-180, 180] of a longitude in 1e-7 degrees that may have left the range by one turn.
double wrapped_degrees(std::int64_t lon) {
  constexpr std::int64_t kTurn = 3'600'000'000;
  if (lon > kTurn / 2) lon -= kTurn;
  if (lon < -kTurn / 2) lon += kTurn;
  return static_cast<double>(lon) * 1e-7;
}

void locate(const model::Extract& extract, ExtractSummary& summary) {
  constexpr std::int64_t kTurn = 3'600'000'000;
  std::vector<std::int64_t> lons, lats;
  for (const model::MappedBuilding& b : extract.buildings) {
    if (b.rings.count == 0 || b.state != ObjectState::pending) continue;
    const model::Location centre = footprints::box_centre(extract, b);
    std::int64_t lon = centre.lon;
    // Extracts across 180 degrees: everything on one side of the first building.
    if (!lons.empty() && lon - lons.front() > kTurn / 2) lon -= kTurn;
    if (!lons.empty() && lons.front() - lon > kTurn / 2) lon += kTurn;
    lons.push_back(lon);
    lats.push_back(centre.lat);
  }
  if (lons.empty()) return;
  const auto [west, east] = std::minmax_element(lons.begin(), lons.end());
  const auto [south, north] = std::minmax_element(lats.begin(), lats.end());
  summary.extent = georef::GeoBox{wrapped_degrees(*west), static_cast<double>(*south) * 1e-7, wrapped_degrees(*east),
                                  static_cast<double>(*north) * 1e-7};
  const std::int64_t lon = median(lons), lat = median(lats);
  summary.centre = georef::LonLat{wrapped_degrees(lon), static_cast<double>(lat) * 1e-7};
}

std::string percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? "-" : fmt::format("{:.1f} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string frequencies_text(const std::string& title, const std::vector<Frequency>& all) {
  if (all.empty()) return {};
  std::string text = "\n" + title + "\n";
  for (std::size_t i = 0; i < std::min(all.size(), kShownValues); ++i)
    text += fmt::format("  {:<28}{:>12}\n", all[i].first, with_thousands(all[i].second));
  if (all.size() > kShownValues) {
    std::uint64_t rest = 0;
    for (std::size_t i = kShownValues; i < all.size(); ++i) rest += all[i].second;
    text += fmt::format("  {:<28}{:>12}\n", fmt::format("{} others", with_thousands(all.size() - kShownValues)),
                        with_thousands(rest));
  }
  return text;
}

std::string codes_text(const std::string& title, const std::map<std::string, std::uint64_t>& codes) {
  if (codes.empty()) return {};
  std::string text = "\n" + title + "\n";
  for (const auto& [code, count] : codes) {
    std::string_view meaning;
    for (const model::IssueInfo& info : model::kIssueInfo)
      if (info.text == code) meaning = info.meaning;
    text += fmt::format("  {:<28}{:>12}  {}\n", code, with_thousands(count), meaning);
  }
  return text;
}

}  // namespace

ExtractSummary summarise(const model::Extract& extract, std::vector<footprints::Shard>* shards) {
  ExtractSummary s;
  s.file = extract.file;
  s.data_time = extract.data_time;
  s.counts = extract.counts;

  std::unordered_map<base::StringId, std::size_t> key_index;
  for (const std::string_view key : kKeys) {
    if (const base::StringId id = extract.strings.find(key); id != 0) key_index.emplace(id, s.keys.size());
    s.keys.push_back({std::string(key)});
  }
  const base::StringId roof_shape = extract.strings.find(osm_key::kRoofShape);
  IdCounts building_values, part_values, roof_shapes;
  for (const model::MappedBuilding& b : extract.buildings) {
    const bool is_part = b.kind == ObjectKind::building_part;
    if (b.state == ObjectState::pending) ++s.to_build;
    if (b.state == ObjectState::represented) ++s.represented;
    if (b.state == ObjectState::duplicate) ++s.duplicates;
    if (b.state == ObjectState::reported) ++s.reported[std::string(model::info(b.code).text)];
    ++(is_part ? part_values : building_values)[b.attributes.use];
    for (const model::Tag& tag : extract.tags_of(b.tags)) {
      if (roof_shape != 0 && tag.key == roof_shape) ++roof_shapes[tag.value];
      const auto key = key_index.find(tag.key);
      if (key != key_index.end()) ++(is_part ? s.keys[key->second].parts : s.keys[key->second].buildings);
    }
  }
  s.building_values = by_frequency(building_values, extract.strings);
  s.part_values = by_frequency(part_values, extract.strings);
  s.roof_shapes = by_frequency(roof_shapes, extract.strings);

  std::array<std::uint64_t, std::size(kFeatureNames)> features{};
  for (const model::Feature& f : extract.features)
    for (std::size_t i = 0; i < features.size(); ++i) features[i] += f.is(kFeatureNames[i].first) ? 1 : 0;
  for (std::size_t i = 0; i < features.size(); ++i) s.features.emplace_back(kFeatureNames[i].second, features[i]);

  for (const model::ReportRow& row : extract.report.rows)
    if (model::info(row.code).issue_class != model::IssueClass::reported)
      ++s.notices[std::string(model::info(row.code).text)];

  locate(extract, s);
  model::Report unused;
  std::vector<footprints::Shard> all = footprints::make_shards(extract, unused);
  s.size = run::town_size(extract, all);
  if (shards != nullptr) *shards = std::move(all);
  return s;
}

std::string summary_text(const ExtractSummary& s, const std::optional<CrsChoice>& crs, const BuildEstimate& e) {
  const model::ExtractCounts& c = s.counts;
  std::string text = fmt::format("{}: {}{}\n", s.file, with_byte_unit(s.file_bytes),
                                 s.data_time.empty() ? "" : ", data of " + s.data_time);
  text += fmt::format("  {} nodes, {} ways, {} relations\n", with_thousands(c.nodes), with_thousands(c.ways),
                      with_thousands(c.relations));
  text += fmt::format("\n{:<18}{:>12}{:>12}{:>12}{:>12}\n", "Objects", "nodes", "ways", "relations", "in all");
  const auto objects = [&](const char* name, std::uint64_t nodes, std::uint64_t ways, std::uint64_t relations) {
    text += fmt::format("  {:<16}{:>12}{:>12}{:>12}{:>12}\n", name, with_thousands(nodes), with_thousands(ways),
                        with_thousands(relations), with_thousands(nodes + ways + relations));
  };
  objects("buildings", c.building_nodes, c.building_ways, c.building_relations);
  objects("building parts", c.part_nodes, c.part_ways, c.part_relations);
  text += fmt::format("  {} with an outline to build from, {} represented by another object, {} duplicates\n",
                      with_thousands(s.to_build), with_thousands(s.represented), with_thousands(s.duplicates));
  text += fmt::format("  {} with courtyards or holes, {} old-style multipolygons, {} nodes and {} ways missing\n",
                      with_thousands(c.areas_with_holes), with_thousands(c.old_style_multipolygons),
                      with_thousands(c.missing_nodes), with_thousands(c.missing_ways));
  text += codes_text("Cannot be built, because", s.reported);
  text += codes_text("Notices", s.notices);
  if (c.buildings() + c.parts() > 0) {
    text += fmt::format("\n{:<30}{:>12}{:>12}\n", "Tagged", "buildings", "parts");
    for (const KeyUse& k : s.keys)
      text += fmt::format("  {:<28}{:>12}{:>12}\n", k.key, percent(k.buildings, c.buildings()),
                          percent(k.parts, c.parts()));
  }
  text += frequencies_text("building=", s.building_values);
  text += frequencies_text("building:part=", s.part_values);
  text += frequencies_text("roof:shape=", s.roof_shapes);
  std::string features;
  for (const auto& [kind, count] : s.features)
    if (count > 0) features += fmt::format("  {:<28}{:>12}\n", kind, with_thousands(count));
  if (!features.empty()) text += "\nOther objects\n" + features;
  if (!s.extent) return text + "\nNo building with an outline: a build would be empty.\n";
  text += fmt::format("\nExtent  {:.5f},{:.5f},{:.5f},{:.5f} (west,south,east,north), {} tiles\n", s.extent->west,
                      s.extent->south, s.extent->east, s.extent->north, with_thousands(s.size.tiles));
  if (crs)
    text += fmt::format("CRS     {} {} ({}{})\n", crs->code, crs->name, crs->operation,
                        crs->accuracy_m > 0 ? fmt::format(", accuracy {:.1f} m", crs->accuracy_m) : "");
  text += fmt::format("A build would take {}, about {} of memory and about {} of disk\n", rough_time(e.seconds),
                      with_byte_unit(e.memory_bytes), with_byte_unit(e.disk_bytes));
  return text;
}

std::string summary_json(const ExtractSummary& s, const std::optional<CrsChoice>& crs, const BuildEstimate& e) {
  using Json = nlohmann::ordered_json;
  const model::ExtractCounts& c = s.counts;
  const auto frequencies = [](const std::vector<Frequency>& all) {
    Json list = Json::array();
    for (const auto& [value, count] : all) list.push_back({{"value", value}, {"count", count}});
    return list;
  };
  Json j;
  j["file"] = s.file;
  j["bytes"] = s.file_bytes;
  j["data_time"] = s.data_time;
  j["objects"] = {{"nodes", c.nodes}, {"ways", c.ways}, {"relations", c.relations}};
  j["buildings"] = {{"nodes", c.building_nodes},
                    {"ways", c.building_ways},
                    {"relations", c.building_relations},
                    {"count", c.buildings()}};
  j["parts"] = {{"nodes", c.part_nodes}, {"ways", c.part_ways}, {"relations", c.part_relations}, {"count", c.parts()}};
  j["to_build"] = s.to_build;
  j["represented"] = s.represented;
  j["duplicates"] = s.duplicates;
  j["reported"] = s.reported;
  j["notices"] = s.notices;
  j["areas_with_holes"] = c.areas_with_holes;
  j["old_style_multipolygons"] = c.old_style_multipolygons;
  j["missing"] = {{"nodes", c.missing_nodes}, {"ways", c.missing_ways}};
  j["keys"] = Json::array();
  for (const KeyUse& k : s.keys) j["keys"].push_back({{"key", k.key}, {"buildings", k.buildings}, {"parts", k.parts}});
  j["building_values"] = frequencies(s.building_values);
  j["part_values"] = frequencies(s.part_values);
  j["roof_shapes"] = frequencies(s.roof_shapes);
  j["features"] = Json::object();
  for (const auto& [kind, count] : s.features) j["features"][kind] = count;
  j["extent"] = s.extent ? Json{s.extent->west, s.extent->south, s.extent->east, s.extent->north} : Json();
  j["crs"] = crs ? Json{{"code", crs->code},
                        {"name", crs->name},
                        {"operation", crs->operation},
                        {"accuracy_m", crs->accuracy_m}}
                 : Json();
  j["tiles"] = s.size.tiles;
  j["outer_walls_m2"] = std::round(s.size.all.walls);
  j["outer_walls_of_the_largest_tile_m2"] = std::round(s.size.tile.walls);
  j["estimate"] = {{"seconds", e.seconds}, {"memory_bytes", e.memory_bytes}, {"disk_bytes", e.disk_bytes}};
  // Tags may hold anything; JSON may not.
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace blockrand::cli
