#include "pipeline/outputs/report/report_sections.h"

#include <algorithm>
#include <utility>

#include "pipeline/model/building.h"
#include "pipeline/outputs/report/html_text.h"

namespace blockrand::outputs {
namespace {

using base::with_thousands;

std::string count_of(std::uint64_t n, std::string_view one, std::string_view many) {
  return with_thousands(n) + " " + std::string(n == 1 ? one : many);
}

/// "storey_height" → "Storey height"; some names say more in other words.
std::string label(std::string_view name) {
  if (name == "min_height") return "Underside above ground";
  if (name == "roof_storeys") return "Storeys in the roof";
  if (name == "use") return "Use of the building";
  std::string out(name);
  std::replace(out.begin(), out.end(), '_', ' ');
  if (!out.empty() && out[0] >= 'a' && out[0] <= 'z') out[0] = static_cast<char>(out[0] - 'a' + 'A');
  return out;
}

constexpr std::string_view kSourceMeaning[model::kSourceCount] = {
    "given by the user: a correction, or an option for all",
    "a tag of the object",
    "follows from another tag",
    "taken from the building\u2019s parts",
    "seen in an aerial image",
    "measured in an elevation model",
    "read from the footprint\u2019s shape",
    "like tagged neighbours",
    "like the rest of its block",
    "like its surroundings",
    "usual in its district",
    "usual in the region",
    "usual for this kind of building",
    "nothing known: a general value"};

/// The number of a source as CSS class, or 0 for a name that no list knows.
int source_number(std::string_view name) {
  for (int i = 0; i < model::kSourceCount; ++i)
    if (model::name(static_cast<model::Source>(i)) == name) return i + 1;
  return 0;
}

Values picture(const ReportPicture& p) {
  std::string png;
  append_base64(png, p.png);
  Values values;
  values.set("width", std::to_string(p.width)).set("height", std::to_string(p.height));
  values.set("caption", p.caption).set("png", std::move(png));
  return values;
}

}  // namespace

Values bar_values(const std::vector<BarPart>& parts, std::uint64_t all, std::uint64_t sum) {
  Values values;
  Values::List rects;
  std::string words;
  std::uint64_t before = 0;
  for (const BarPart& part : parts) {
    if (part.count == 0) continue;
    // Borders are rounded, not widths: together they are as long as the sum.
    const std::uint64_t from = before * 10000 / all, to = (before + part.count) * 10000 / all;
    before += part.count;
    const std::string text = part.name + " " + with_thousands(part.count) + " (" + percent(part.count, sum) + ")";
    words += (words.empty() ? "" : ", ") + text;
    Values rect;
    rect.set("class", part.css_class).set("x", std::to_string(from)).set("width", std::to_string(to - from));
    rect.set("text", text);
    rects.push_back(std::move(rect));
  }
  values.set("words", words.empty() ? std::string("none") : words).set("rects", std::move(rects));
  return values;
}

Values head_values(const ReportFacts& f) {
  Values v;
  v.set("buildings_built", count_of(f.buildings_built, "building", "buildings"));
  v.set("bodies", count_of(f.bodies, "body", "bodies"));
  v.set("objects", with_thousands(f.buildings_in + f.parts_in)).set("models", with_thousands(f.models));
  v.set("represented", with_thousands(f.represented + f.duplicates)).set("reported", with_thousands(f.reported));
  v.set("buildings_in", count_of(f.buildings_in, "building", "buildings"));
  v.set("parts_in", count_of(f.parts_in, "part", "parts"));
  v.set("duplicates", f.duplicates > 0 ? with_thousands(f.duplicates) : std::string());
  std::string levels;
  constexpr std::string_view kLevels[] = {"LoD\u00a00 (footprint)", "LoD\u00a01 (block)", "LoD\u00a02 (with roof)",
                                          "LoD\u00a03 (with facades)"};
  for (int lod = 3; lod >= 0; --lod) {
    const std::uint64_t n = f.models_by_lod[static_cast<std::size_t>(lod)];
    if (n == 0 && lod != f.lod) continue;
    if (!levels.empty()) levels += ", ";
    levels += std::string(kLevels[lod]) + ": " + with_thousands(n);
  }
  v.set("levels", levels).set("data_time", f.data_time);
  std::string crs = f.crs_code + (f.crs_name.empty() ? "" : ", " + f.crs_name);
  if (f.crs_accuracy >= 0) crs += " (datum accuracy " + rounded(f.crs_accuracy, 1) + "\u00a0m)";
  v.set("crs", crs).set("heights", f.height_reference + (f.vertical_crs.empty() ? "" : ", " + f.vertical_crs));
  std::string lon, lat;
  if (f.centre_longitude != 0 || f.centre_latitude != 0) {
    append_number(lon, static_cast<double>(static_cast<std::int64_t>(f.centre_longitude * 1e5)) / 1e5);
    append_number(lat, static_cast<double>(static_cast<std::int64_t>(f.centre_latitude * 1e5)) / 1e5);
  }
  v.set("longitude", lon).set("latitude", lat);
  return v;
}

std::optional<Values> picture_values(const ReportFacts& f) {
  if (f.pictures.empty()) return std::nullopt;
  Values v;
  v.set("note", f.pictures_note).add("first", picture(f.pictures[0]));
  Values others;
  for (std::size_t i = 1; i < f.pictures.size(); ++i) others.add("figures", picture(f.pictures[i]));
  if (f.pictures.size() > 1)
    v.add("others", std::move(others));
  else
    v.set("others", false);
  return v;
}

Values source_values(const ReportFacts& f) {
  Values v;
  v.set("rows", Values::List());
  std::array<bool, model::kSourceCount + 1> present{};
  bool any = false;
  const auto add = [&](const std::string& attribute, const std::map<std::string, std::uint64_t>& by_source) {
    std::array<std::uint64_t, model::kSourceCount + 1> counts{};
    std::uint64_t all = 0;
    for (const auto& [source, n] : by_source) {
      counts[static_cast<std::size_t>(source_number(source))] += n;
      all += n;
    }
    if (all == 0) return;
    std::vector<BarPart> parts;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      if (counts[k] == 0) continue;
      present[k] = true;
      const auto source = static_cast<model::Source>(k - 1);
      parts.push_back({"b" + std::to_string(k), k == 0 ? "other" : std::string(model::name(source)), counts[k]});
    }
    // What a user gave, by a correction or an option, is stated, but not by the map.
    const std::uint64_t given = counts[1 + static_cast<std::size_t>(model::Source::override_)];
    std::uint64_t mapped = 0;
    for (const model::Source source : {model::Source::tag, model::Source::implied, model::Source::part})
      mapped += counts[1 + static_cast<std::size_t>(source)];
    Values row = bar_values(parts, all, all);
    row.set("label", label(attribute)).set("mapped", percent(mapped, all));
    row.set("given", given > 0 ? percent(given, all) : std::string());
    // Attributes that only some bodies have say of how many they speak.
    row.set("some", all < f.bodies ? with_thousands(all) : std::string());
    v.add("rows", std::move(row));
    any = true;
  };
  std::vector<std::string> known;
  const model::Attributes order;
  const auto next = [&](const char* name) {
    known.emplace_back(name);
    if (const auto found = f.sources.find(name); found != f.sources.end()) add(found->first, found->second);
  };
  model::for_each_attribute(
      order, [&](const char* name, const char*, const auto&) { next(name); },
      [&](const char* name, const char*) { next(name); });
  for (const auto& [attribute, by_source] : f.sources)
    if (std::find(known.begin(), known.end(), attribute) == known.end()) add(attribute, by_source);
  v.set("any", any);
  for (std::size_t k = 1; k < present.size(); ++k) {
    if (!present[k]) continue;
    const std::string_view name = model::name(static_cast<model::Source>(k - 1));
    v.add("key",
          Values().set("swatch", "b" + std::to_string(k)).set("name", name).set("meaning", kSourceMeaning[k - 1]));
    v.add("columns", Values().set("name", name));
  }
  for (const auto& [attribute, by_source] : f.sources) {
    Values row;
    row.set("label", label(attribute)).set("counts", Values::List());
    for (std::size_t k = 1; k < present.size(); ++k) {
      if (!present[k]) continue;
      const auto found = by_source.find(std::string(model::name(static_cast<model::Source>(k - 1))));
      row.add("counts",
              Values().set("count", found == by_source.end() ? std::string() : with_thousands(found->second)));
    }
    v.add("numbers", std::move(row));
  }
  return v;
}

Values statistics_values(const ReportFacts& f, const ReportMap& map) {
  Values v;
  Values storeys;
  const std::vector<std::uint64_t>& classes = map.counts[static_cast<std::size_t>(MapTheme::storeys)];
  std::uint64_t built = 0;
  for (std::size_t k = 1; k < classes.size(); ++k) built += classes[k];
  for (std::size_t k = 1; k < classes.size(); ++k)
    if (classes[k] > 0)
      storeys.add("rows", Values()
                              .set("label", class_name(MapTheme::storeys, k))
                              .set("count", with_thousands(classes[k]))
                              .set("share", percent(classes[k], built)));
  if (built > 0)
    v.add("storeys", std::move(storeys));
  else
    v.set("storeys", false);
  const auto size = [&](std::string_view name, const std::string& value) {
    v.add("sizes", Values().set("label", name).set("value", value));
  };
  const std::string square = "\u00a0m\u00b2";
  size("Footprints", rounded(f.footprint_area) + square);
  size("Volume", rounded(f.volume) + "\u00a0m\u00b3");
  size("Outer walls", rounded(f.outer_wall_area) + square);
  size("Party walls", with_thousands(f.party_walls));
  size("\u2026 length", rounded(f.party_wall_length) + "\u00a0m");
  size("\u2026 area", rounded(f.party_wall_area) + square);
  std::vector<std::pair<std::string, std::uint64_t>> roofs(f.roofs.begin(), f.roofs.end());
  std::stable_sort(roofs.begin(), roofs.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::uint64_t all = 0;
  for (const auto& [shape, n] : roofs) all += n;
  v.set("roofs", Values::List());
  for (const auto& [shape, n] : roofs)
    v.add("roofs", Values().set("label", label(shape)).set("count", with_thousands(n)).set("share", percent(n, all)));
  return v;
}

Values file_values(const ReportFacts& f) {
  struct Kind {
    std::string_view prefix, name, how;
    bool folder;
    std::uint64_t files = 0, bytes = 0;
  };
  Kind kinds[] = {
      {"tileset.json", "3D Tiles 1.1", "CesiumJS, QGIS 3.34 or newer, Unreal, Unity: open tileset.json", false, 0, 0},
      {"tiles/", "\u2026 its tiles", "single GLB files, for Blender and other editors", true, 0, 0},
      {"model.glb", "glTF, whole build", "Blender and other editors, 3D viewers", false, 0, 0},
      {"citygml/", "CityGML 2.0", "FME, 3DCityDB, KIT ModelViewer, azul; one file per tile", true, 0, 0},
      {"cityjson/", "CityJSON 2.0", "text sequence, one file per tile: cjio, cjseq", true, 0, 0},
      {"model.city.json", "CityJSON, whole build", "ninja.cityjson.org, azul, QGIS with its plugin", false, 0, 0},
      {"buildings.csv", "Table of all buildings", "Excel, LibreOffice, any statistics program", false, 0, 0},
      {"buildings.gpkg", "GeoPackage", "any GIS: every attribute and its source", false, 0, 0},
      {"buildings.qgz", "QGIS project", "QGIS: the GeoPackage as a map, coloured and labelled", false, 0, 0},
      {"explain/", "What blockrand explain reads", "blockrand explain", true, 0, 0},
      {"plan.png", "Plan", "any viewer of pictures", false, 0, 0},
      {"report.json", "Every report row", "any editor or script", false, 0, 0},
  };
  for (const ReportFile& file : f.files)
    for (Kind& kind : kinds)
      if (kind.folder ? file.path.rfind(kind.prefix, 0) == 0 : file.path == kind.prefix) {
        ++kind.files;
        kind.bytes += file.bytes;
      }
  Values v;
  const auto row = [&](std::string_view name, std::string_view path, const std::string& files, const std::string& size,
                       std::string_view how) {
    v.add("rows", Values().set("name", name).set("path", path).set("files", files).set("size", size).set("how", how));
  };
  for (const Kind& kind : kinds)
    if (kind.files > 0)
      row(kind.name, kind.prefix, with_thousands(kind.files), base::with_byte_unit(kind.bytes), kind.how);
  row("Inputs, settings, counts, hashes", "build.json", "1", "", "any editor or script");
  row("Times, memory, host", "run.json", "1", "", "any editor or script");
  return v;
}

}  // namespace blockrand::outputs
