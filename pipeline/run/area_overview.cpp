#include "pipeline/run/area_overview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <tuple>

#include "pipeline/base/assets.h"
#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/template.h"
#include "pipeline/base/text.h"
#include "pipeline/base/version.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/model/issue_codes.h"
#include "pipeline/outputs/output.h"
#include "pipeline/outputs/tileset/nested_tileset.h"
#include "pipeline/run/area_surroundings.h"
#include "pipeline/run/assets.h"
#include "pipeline/run/configuration.h"
#include "pipeline/run/documents.h"
#include "pipeline/run/tile_choice.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using base::Values;
using model::TileId;

/// Adds numbers to numbers of the same name, at any depth. What is no sum is left out by the caller.
void add_numbers(Json& sum, const Json& more) {
  for (const auto& [key, value] : more.items()) {
    if (value.is_object()) {
      if (!sum.contains(key)) sum[key] = Json::object();
      add_numbers(sum[key], value);
    } else if (value.is_number()) {
      if (!sum.contains(key))
        sum[key] = value;
      else if (key.ends_with("_most_m"))
        sum[key] = std::max(sum[key].get<double>(), value.get<double>());
      else if (value.is_number_integer())
        sum[key] = sum[key].get<std::int64_t>() + value.get<std::int64_t>();
      else
        sum[key] = std::nearbyint((sum[key].get<double>() + value.get<double>()) * 100) / 100;
    }
  }
}

Json read_document(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Json j = Json::parse(file, nullptr, false);
  if (!j.is_object()) throw base::OutputError(path + ": cannot be read back");
  return j;
}

struct Entry {
  TileId tile;
  std::string record_sha256;
  std::uint64_t files = 0, bytes = 0, objects = 0, models = 0, reported = 0, simpler = 0;
  std::optional<outputs::RegionVolume> volume;  ///< of its tileset; empty: it has none, or an empty one
  double error = 0;                             ///< m, of its tileset's root
  bool has_geopackage = false;
};

}  // namespace

std::string area_path(const TileId& area) { return "areas/" + text_of(area); }

struct Overview::State {
  const BuildOptions& options;
  const RegionFacts& facts;
  const importers::osm::StoreFigures& data;
  std::vector<Entry> entries;
  Json common;  ///< of the first record: what is the same in all
  std::vector<model::ReportRow> elsewhere;
  Json counts = Json::object(), issues = Json::object(), statistics = Json::object(), surroundings = Json::object();

  /// By path.
  std::map<std::string, std::string> tilesets() const {
    std::vector<outputs::NestedTileset> nested;
    for (const Entry& e : entries)
      if (e.volume) nested.push_back({e.tile, area_path(e.tile) + "/tileset.json", *e.volume, e.error});
    const Json asset = {
        {"version", "1.1"},
        {"extras",
         {{"generator", outputs::generator()},
          {"crs", common.value("crs", Json::object()).value("code", "")},
          {"height_reference", common.value("crs", Json::object()).value("height_reference_of_tiles", "")},
          {"attribution", outputs::kAttribution}}}};
    return outputs::nested_tilesets(nested, asset);
  }

  /// All buildings as one layer for GIS programs: GDAL's union of the areas' layers.
  std::string vrt() const {
    std::string out = "<OGRVRTDataSource>\n  <!-- " + std::string(outputs::kAttribution) +
                      " -->\n  <OGRVRTUnionLayer name=\"buildings\">\n";
    for (const Entry& e : entries)
      if (e.has_geopackage)
        out += "    <OGRVRTLayer name=\"buildings\"><SrcDataSource relativeToVRT=\"1\">" + area_path(e.tile) +
               "/buildings.gpkg</SrcDataSource></OGRVRTLayer>\n";
    return out + "  </OGRVRTUnionLayer>\n</OGRVRTDataSource>\n";
  }

  Json area_list() const {
    Json list = Json::object();
    for (const Entry& e : entries)
      list[text_of(e.tile)] = {{"build_sha256", e.record_sha256},
                               {"files", e.files},
                               {"bytes", e.bytes},
                               {"objects", e.objects},
                               {"models", e.models},
                               {"reported", e.reported},
                               {"simpler", e.simpler}};
    return list;
  }

  std::string report_json(const std::vector<std::string>& unmatched) const {
    Json j;
    j["attribution"] = outputs::kAttribution;
    j["counts"] = counts;
    j["issues"] = issues;
    j["statistics"] = statistics;
    j["overrides_unmatched"] = unmatched;
    j["codes"] = Json::object();
    for (const auto& [code, count] : issues.items())
      for (const model::IssueInfo& info : model::kIssueInfo)
        if (info.text == code) j["codes"][code] = info.meaning;
    j["areas"] = area_list();
    j["elsewhere"] = Json::array();
    for (const model::ReportRow& row : elsewhere)
      j["elsewhere"].push_back(
          {{"object", row.object.text()}, {"code", model::info(row.code).text}, {"detail", row.detail}});
    return j.dump(1) + "\n";
  }

  void add_map(Values& page) const {
    if (entries.empty()) return;
    double west = 1e9, south = 1e9, east = -1e9, north = -1e9;
    std::uint64_t most = 1;
    for (const Entry& e : entries) {
      const georef::GeoBox b = georef::bounds(e.tile);
      west = std::min(west, b.west), south = std::min(south, b.south);
      east = std::max(east, b.east), north = std::max(north, b.north);
      most = std::max(most, e.models);
    }
    const georef::GeoBox first = georef::bounds(entries.front().tile);  // of the coarsest
    // Pixels for one area; a tile of the quadtree is as high as it is wide in degrees.
    const double scale = std::clamp(900.0 / ((east - west) / first.width()), 8.0, 90.0) / first.width();
    const double squash = 1.6;  // degrees of longitude are shorter than those of latitude
    Values map;
    map.set("width", fmt::format("{:.0f}", (east - west) * scale));
    map.set("height", fmt::format("{:.0f}", (north - south) * scale * squash));
    for (const Entry& e : entries) {
      const georef::GeoBox b = georef::bounds(e.tile);
      const double share = static_cast<double>(e.models) / static_cast<double>(most);
      Values cell;
      cell.set("link", link_of(e)).set("name", text_of(e.tile)).set("models", base::with_thousands(e.models));
      cell.set("x", fmt::format("{:.1f}", (b.west - west) * scale));
      cell.set("y", fmt::format("{:.1f}", (north - b.north) * scale * squash));
      cell.set("cell_width", fmt::format("{:.1f}", b.width() * scale));
      cell.set("cell_height", fmt::format("{:.1f}", b.width() * scale * squash));
      cell.set("opacity", fmt::format("{:.2f}", 0.08 + 0.9 * std::sqrt(share)));
      map.add("cells", std::move(cell));
    }
    page.add("map", std::move(map));
  }

  std::string link_of(const Entry& e) const {
    return area_path(e.tile) + (options.outputs.report ? "/report.html" : "/build.json");
  }

  std::string page(const std::string& name, const std::vector<std::string>& unmatched) const {
    Values page;
    const auto count = [&](const char* key) { return base::with_thousands(counts.value(key, std::uint64_t{0})); };
    page.set("title", name).set("version", base::kVersion).set("page_css", base::asset("page.css"));
    page.set("buildings", count("buildings_in")).set("parts", count("parts_in"));
    page.set("areas", base::with_thousands(entries.size())).set("models", count("models"));
    page.set("reported", count("reported")).set("data_time", data.data_time);
    page.set("attribution", outputs::kAttribution);
    add_map(page);
    page.set("rows", Values::List());
    for (const Entry& e : entries) {
      Values row;
      row.set("link", link_of(e)).set("name", text_of(e.tile)).set("models", base::with_thousands(e.models));
      row.set("simpler", base::with_thousands(e.simpler)).set("reported", base::with_thousands(e.reported));
      row.set("bytes", base::with_byte_unit(e.bytes));
      page.add("rows", std::move(row));
    }
    if (!issues.empty()) {
      std::vector<std::pair<std::string, std::uint64_t>> rows;
      for (const auto& [code, n] : issues.items()) rows.emplace_back(code, n.get<std::uint64_t>());
      std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
      Values list;
      for (const auto& [code, n] : rows) {
        std::string_view meaning;
        for (const model::IssueInfo& info : model::kIssueInfo)
          if (info.text == code) meaning = info.meaning;
        list.add("codes", Values().set("code", code).set("count", base::with_thousands(n)).set("meaning", meaning));
      }
      page.add("issues", std::move(list));
    }
    if (!unmatched.empty()) {
      Values list;
      for (const std::string& order : unmatched) list.add("orders", Values().set("order", order));
      page.add("unmatched", std::move(list));
    }
    return base::filled(asset, "overview.html", std::move(page));
  }
};

Overview::Overview(const BuildOptions& options, const RegionFacts& facts, const importers::osm::StoreFigures& data)
    : state_(new State{options, facts, data, {}, {}, {}}) {}
Overview::~Overview() = default;

void Overview::add(const TileId& area, const std::string& folder) {
  State& s = *state_;
  const Json record = read_document(folder + "/build.json");
  Entry entry;
  entry.tile = area;
  entry.record_sha256 = base::sha256_file(folder + "/build.json");
  const Json& counts = record.at("counts");
  entry.objects = counts.value("buildings_in", std::uint64_t{0}) + counts.value("parts_in", std::uint64_t{0});
  entry.models = counts.value("models", std::uint64_t{0});
  entry.reported = counts.value("reported", std::uint64_t{0});
  for (int lod = 0; lod < s.options.lod; ++lod)
    entry.simpler += counts.value(fmt::format("models_lod{}", lod), std::uint64_t{0});
  for (const auto& [path, file] : record.at("files").items()) {
    ++entry.files;
    entry.bytes += file.value("bytes", std::uint64_t{0});
    entry.has_geopackage = entry.has_geopackage || path == "buildings.gpkg";
  }
  entry.files += 2;  // build.json and run.json
  if (std::error_code error; fs::exists(folder + "/tileset.json", error)) {
    const Json root = read_document(folder + "/tileset.json").at("root");
    if (root.at("boundingVolume").contains("region"))
      entry.volume = root.at("boundingVolume").at("region").get<outputs::RegionVolume>();
    entry.error = root.value("geometricError", 0.0);
  }
  add_numbers(s.counts, counts);
  add_numbers(s.issues, record.at("issues"));
  add_numbers(s.statistics, record.at("statistics"));
  if (record.contains("surroundings")) add_numbers(s.surroundings, record.at("surroundings"));
  if (s.common.is_null()) {
    for (const char* key : {"inputs", "crs", "terrain"})
      if (record.contains(key)) s.common[key] = record.at(key);
  }
  const auto after = std::upper_bound(s.entries.begin(), s.entries.end(), area,
                                      [](const TileId& t, const Entry& e) { return t < e.tile; });
  s.entries.insert(after, std::move(entry));
}

void Overview::add(std::vector<model::ReportRow> rows) {
  std::ranges::sort(rows);
  for (const model::ReportRow& row : rows) {
    Json& count = state_->issues[std::string(model::info(row.code).text)];
    count = (count.is_null() ? 0 : count.get<std::int64_t>()) + 1;
  }
  state_->elsewhere = std::move(rows);
}

void Overview::settle_around(const std::vector<surroundings::SharedOutcome>& shared,
                             const surroundings::SurroundingCounts& elsewhere) {
  add_numbers(state_->surroundings, surroundings_json(elsewhere));
  settle_surroundings(shared, state_->surroundings);
}

void Overview::settle(std::vector<outputs::PartySide> open) {
  // Areas end in any order; sums of fractions must not show it.
  std::ranges::sort(open, {}, [](const outputs::PartySide& s) { return std::tuple(s.wall, s.length, s.base, s.top); });
  outputs::Statistics found;
  for (const outputs::PartySide& side : open) found.outer_wall_area -= side.length * (side.top - side.base);
  outputs::settle_party_walls(std::move(open), found);
  const auto hundredths = [](double v) { return std::nearbyint(v * 100) / 100; };
  add_numbers(state_->statistics, {{"outer_wall_area_m2", hundredths(found.outer_wall_area)},
                                   {"party_walls", found.party_walls},
                                   {"party_wall_length_m", hundredths(found.party_wall_length)},
                                   {"party_wall_area_m2", hundredths(found.party_wall_area)}});
}

void Overview::sum_up(BuildSummary& summary) const {
  const auto count = [&](const std::string& key) { return state_->counts.value(key, std::uint64_t{0}); };
  summary.buildings_in = count("buildings_in"), summary.parts_in = count("parts_in");
  summary.models = count("models"), summary.reported = count("reported");
  summary.duplicates = count("represented_as_duplicates");
  summary.represented = count("represented") - summary.duplicates;
  for (std::size_t lod = 0; lod < summary.models_by_lod.size(); ++lod)
    summary.models_by_lod[lod] = count(fmt::format("models_lod{}", lod));
  for (const auto& [code, n] : state_->issues.items()) summary.issues[code] = n.get<std::uint64_t>();
  summary.files = summary.bytes = 0;
  for (const Entry& e : state_->entries) summary.files += e.files, summary.bytes += e.bytes;
}

void Overview::write(base::StagedFolder& folder, const std::vector<std::string>& unmatched,
                     BuildSummary& summary) const {
  const State& s = *state_;
  sum_up(summary);
  std::vector<base::PublishedFile> files;
  bool tilesets = false, geopackages = false;
  for (const Entry& e : s.entries) {
    std::error_code error;
    tilesets = tilesets || fs::exists(folder.staging_path() + "/" + area_path(e.tile) + "/tileset.json", error);
    geopackages = geopackages || e.has_geopackage;
  }
  if (tilesets)
    for (const auto& [path, text] : s.tilesets()) outputs::write_served(path, text, s.options.outputs, folder, files);
  if (geopackages) files.push_back(folder.write("buildings.vrt", s.vrt()));
  files.push_back(folder.write("report.json", s.report_json(unmatched)));
  if (s.options.outputs.report) files.push_back(folder.write("report.html", s.page(s.options.name, unmatched)));
  std::ranges::sort(files, {}, &base::PublishedFile::path);
  Json j;
  j["program"] = {{"name", "blockrand"}, {"version", base::kVersion}};
  j["attribution"] = outputs::kAttribution;
  j["data"] = {{"sha256", s.data.sha256}};
  if (s.common.contains("inputs")) j["inputs"] = s.common["inputs"];
  j["data_time"] = s.data.data_time;
  j["configuration"] = configuration(s.options);
  j["crs"] = s.common.value("crs", Json{{"code", s.facts.crs}});
  if (s.common.contains("terrain")) j["terrain"] = s.common["terrain"];
  j["region"] = region_json(s.facts);
  Json counts = s.counts;
  // Counted otherwise than in a build at once.
  for (const char* of_windows : {"areas_with_holes", "old_style_multipolygons"}) counts.erase(of_windows);
  counts["missing_nodes"] = s.data.missing_nodes, counts["missing_ways"] = s.data.missing_ways;
  j["counts"] = std::move(counts);
  j["issues"] = s.issues;
  j["statistics"] = s.statistics;
  if (!s.surroundings.empty()) j["surroundings"] = s.surroundings;
  j["areas"] = s.area_list();
  j["files"] = Json::object();
  for (const base::PublishedFile& f : files) {
    j["files"][f.path] = {{"bytes", f.bytes}, {"sha256", f.sha256}};
    ++summary.files, summary.bytes += f.bytes;
  }
  folder.write("build.json", j.dump(1) + "\n");
  summary.files += 2;
}

}  // namespace blockrand::run
