#include "pipeline/outputs/report/report_sections.h"

#include <algorithm>

#include "pipeline/model/building.h"
#include "pipeline/outputs/report/html_text.h"

namespace blockrand::outputs {
namespace {

using base::with_thousands;

std::string count_of(std::uint64_t n, std::string_view one, std::string_view many) {
  return with_thousands(n) + " " + std::string(n == 1 ? one : many);
}

void fact(std::string& out, std::string_view name, std::string_view escaped_value) {
  if (escaped_value.empty()) return;
  out += "<dt>" + std::string(name) + "</dt><dd>" + std::string(escaped_value) + "</dd>\n";
}

/// "storey_height" → "Storey height"; some names say more in other words.
std::string label(std::string_view name) {
  if (name == "min_height") return "Underside above ground";
  if (name == "roof_storeys") return "Storeys in the roof";
  if (name == "use") return "Use of the building";
  std::string out(name);
  std::replace(out.begin(), out.end(), '_', ' ');
  if (!out.empty() && out[0] >= 'a' && out[0] <= 'z') out[0] = static_cast<char>(out[0] - 'a' + 'A');
  return escaped(out);
}

constexpr std::string_view kSourceMeaning[model::kSourceCount] = {"said by the user: a correction, or an option",
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

std::string swatch(const std::string& css_class) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 10 10\" aria-hidden=\"true\"><rect class=\"" +
         css_class + "\" width=\"10\" height=\"10\" rx=\"2\"/></svg>";
}

}  // namespace

std::string head_section(const ReportFacts& f, bool styles) {
  std::string out = "<header>\n<p class=\"kicker\">Blockrand report</p>\n<h1>" + escaped(f.name) + "</h1>\n";
  out += "<p class=\"lead\">" + count_of(f.buildings_built, "building", "buildings") + " rebuilt in 3D as " +
         count_of(f.bodies, "body", "bodies") +
         ", from what OpenStreetMap says about them and, where it is silent, from " +
         "assumptions that this page shows.</p>\n";
  const auto box = [&](std::uint64_t n, std::string_view text) {
    return "<div><b>" + with_thousands(n) + "</b><span>" + std::string(text) + "</span></div>";
  };
  out += "<div class=\"sum\">" + box(f.buildings_in + f.parts_in, "mapped objects") + "<i>=</i>" +
         box(f.models, "modelled") + "<i>+</i>" + box(f.represented + f.duplicates, "represented by others") +
         "<i>+</i>" + box(f.reported, "not modelled") + "</div>\n";
  out +=
      "<p class=\"soft small\">Nothing mapped is lost: every object with <code>building</code> or "
      "<code>building:part</code> (" +
      count_of(f.buildings_in, "building", "buildings") + ", " + count_of(f.parts_in, "part", "parts") +
      ") is modelled, stands for another one, or is listed below with a reason.";
  if (f.duplicates > 0) out += " Of those represented, " + with_thousands(f.duplicates) + " are mapped twice.";
  out += "</p>\n<dl class=\"facts\">\n";
  std::string levels;
  constexpr std::string_view kLevels[] = {"LoD\u00a00 (footprint)", "LoD\u00a01 (block)", "LoD\u00a02 (with roof)",
                                          "LoD\u00a03 (with facades)"};
  for (int lod = 3; lod >= 0; --lod) {
    const std::uint64_t n = f.models_by_lod[static_cast<std::size_t>(lod)];
    if (n == 0 && lod != f.lod) continue;
    if (!levels.empty()) levels += ", ";
    levels += std::string(kLevels[lod]) + ": " + with_thousands(n);
  }
  fact(out, "Level of detail", levels);
  fact(out, "Data as of", f.data_time.empty() ? "not stated in the file" : escaped(f.data_time));
  std::string crs = escaped(f.crs_code) + (f.crs_name.empty() ? "" : ", " + escaped(f.crs_name));
  if (f.crs_accuracy >= 0) crs += " (datum accuracy " + rounded(f.crs_accuracy, 1) + "\u00a0m)";
  fact(out, "Coordinates", crs);
  fact(out, "Heights", escaped(f.height_reference) + (f.vertical_crs.empty() ? "" : ", " + escaped(f.vertical_crs)));
  if (f.centre_longitude != 0 || f.centre_latitude != 0) {
    std::string lon, lat;
    append_number(lon, static_cast<double>(static_cast<std::int64_t>(f.centre_longitude * 1e5)) / 1e5);
    append_number(lat, static_cast<double>(static_cast<std::int64_t>(f.centre_latitude * 1e5)) / 1e5);
    fact(out, "Place",
         "<a href=\"https://www.openstreetmap.org/#map=15/" + lat + "/" + lon + "\">" + lat + ", " + lon +
             "</a> (latitude, longitude)");
  }
  fact(out, "Built by", "Blockrand " + escaped(f.program_version));
  out += "</dl>\n<nav>" + std::string(f.pictures.empty() ? "" : "<a href=\"#pictures\">Pictures</a>") +
         "<a href=\"#map\">Map</a>" + (has_context(f) ? "<a href=\"#context\">Footprints and context</a>" : "") +
         (styles ? "<a href=\"#styles\">Styles</a>" : "") +
         "<a href=\"#sources\">Where values come from</a><a href=\"#issues\">Fallbacks and issues</a>"
         "<a href=\"#statistics\">Statistics</a><a href=\"#files\">Files</a></nav>\n</header>\n";
  return out;
}

std::string picture_section(const ReportFacts& f) {
  if (f.pictures.empty()) return {};
  std::string out = "<section id=\"pictures\">\n<h2>Pictures</h2>\n";
  if (!f.pictures_note.empty()) out += "<p>" + escaped(f.pictures_note) + "</p>\n";
  const auto figure = [&](const ReportPicture& p) {
    out += "<figure><img width=\"" + std::to_string(p.width) + "\" height=\"" + std::to_string(p.height) + "\" alt=\"" +
           escaped(p.caption) + "\" src=\"data:image/png;base64,";
    append_base64(out, p.png);
    out += "\"/><figcaption>" + escaped(p.caption) + "</figcaption></figure>\n";
  };
  figure(f.pictures[0]);
  if (f.pictures.size() > 1) {
    out += "<div class=\"pair\">\n";
    for (std::size_t i = 1; i < f.pictures.size(); ++i) figure(f.pictures[i]);
    out += "</div>\n";
  }
  return out + "</section>\n";
}

std::string source_section(const ReportFacts& f) {
  std::string out =
      "<section id=\"sources\">\n<h2>Where values come from</h2>\n"
      "<p>Maps say little about most buildings. Each bar shows, for one attribute of all bodies, which share of the "
      "values "
      "was mapped and which was inferred, and from what. Every single value with its source and confidence is in the "
      "files.</p>\n";
  std::array<bool, model::kSourceCount + 1> present{};
  std::string rows;
  const auto add = [&](const std::string& attribute, const std::map<std::string, std::uint64_t>& by_source) {
    std::array<std::uint64_t, model::kSourceCount + 1> counts{};
    std::uint64_t all = 0;
    for (const auto& [source, n] : by_source) {
      counts[static_cast<std::size_t>(source_number(source))] += n;
      all += n;
    }
    if (all == 0) return;
    std::string bar, words;
    std::uint64_t before = 0, mapped = 0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      if (counts[k] == 0) continue;
      present[k] = true;
      const std::string name = k == 0 ? "other" : std::string(model::name(static_cast<model::Source>(k - 1)));
      // Borders are rounded, not widths: together they fill the bar.
      const std::uint64_t from = before * 10000 / all, to = (before + counts[k]) * 10000 / all;
      before += counts[k];
      // Not what the user said, in corrections or by an option (the height of the ground).
      if (k >= 2 && k <= 4) mapped += counts[k];
      const std::string text = name + " " + with_thousands(counts[k]) + " (" + percent(counts[k], all) + ")";
      bar += "<rect class=\"b" + std::to_string(k) + "\" x=\"" + std::to_string(from) + "\" width=\"" +
             std::to_string(to - from) + "\" height=\"10\"><title>" + text + "</title></rect>";
      words += (words.empty() ? "" : ", ") + text;
    }
    // Attributes that only some bodies have say of how many they speak.
    const std::string some = all < f.bodies ? " <span class=\"soft small\">of " + with_thousands(all) + "</span>" : "";
    rows += "<tr><td>" + label(attribute) + some +
            "</td><td class=\"bar\"><svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 10000 10\" "
            "preserveAspectRatio=\"none\" role=\"img\" aria-label=\"" +
            words + "\">" + bar + "</svg></td><td class=\"n\">" + percent(mapped, all) + "</td></tr>\n";
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
  if (rows.empty()) return out + "<p>No body was built.</p>\n</section>\n";
  out += "<ul class=\"key\">";
  for (std::size_t k = 1; k < present.size(); ++k)
    if (present[k])
      out += "<li>" + swatch("b" + std::to_string(k)) + std::string(model::name(static_cast<model::Source>(k - 1))) +
             " <span class=\"soft\">" + std::string(kSourceMeaning[k - 1]) + "</span></li>";
  out +=
      "</ul>\n<table class=\"sources\"><thead><tr><th>Attribute</th><th>Share of bodies</th><th class=\"n\">From the "
      "map</th></tr></thead><tbody>\n" +
      rows +
      "</tbody></table>\n<details><summary>The same in numbers</summary>\n<div "
      "class=\"wide\"><table><thead><tr><th>Attribute</th>";
  for (std::size_t k = 1; k < present.size(); ++k)
    if (present[k]) out += "<th class=\"n\">" + std::string(model::name(static_cast<model::Source>(k - 1))) + "</th>";
  out += "</tr></thead><tbody>\n";
  for (const auto& [attribute, by_source] : f.sources) {
    out += "<tr><td>" + label(attribute) + "</td>";
    for (std::size_t k = 1; k < present.size(); ++k) {
      if (!present[k]) continue;
      const auto found = by_source.find(std::string(model::name(static_cast<model::Source>(k - 1))));
      out += "<td class=\"n\">" + (found == by_source.end() ? "" : with_thousands(found->second)) + "</td>";
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div></details>\n</section>\n";
}

std::string statistics_section(const ReportFacts& f) {
  std::string out =
      "<section id=\"statistics\">\n<h2>Statistics</h2>\n<div class=\"pair\"><div>\n<h3>Sizes</h3>\n<table><tbody>\n";
  const auto row = [&](std::string_view name, const std::string& value) {
    out += "<tr><td>" + std::string(name) + "</td><td class=\"n\">" + value + "</td></tr>\n";
  };
  const std::string square = "\u00a0m\u00b2";
  row("Footprints", rounded(f.footprint_area) + square);
  row("Volume", rounded(f.volume) + "\u00a0m\u00b3");
  row("Outer walls", rounded(f.outer_wall_area) + square);
  row("Party walls", with_thousands(f.party_walls));
  row("\u2026 length", rounded(f.party_wall_length) + "\u00a0m");
  row("\u2026 area", rounded(f.party_wall_area) + square);
  out += "</tbody></table></div>\n<div><h3>Roofs as built</h3>\n<table><tbody>\n";
  std::vector<std::pair<std::string, std::uint64_t>> roofs(f.roofs.begin(), f.roofs.end());
  std::stable_sort(roofs.begin(), roofs.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::uint64_t all = 0;
  for (const auto& [shape, n] : roofs) all += n;
  for (const auto& [shape, n] : roofs)
    out += "<tr><td>" + label(shape) + "</td><td class=\"n\">" + with_thousands(n) + "</td><td class=\"n soft\">" +
           percent(n, all) + "</td></tr>\n";
  return out + "</tbody></table></div></div>\n</section>\n";
}

std::string file_section(const ReportFacts& f) {
  struct Kind {
    std::string_view prefix, name, how;
    bool folder;
    std::uint64_t files = 0, bytes = 0;
  };
  Kind kinds[] = {
      {"tileset.json", "3D Tiles 1.1", "CesiumJS, QGIS 3.34 or newer, Unreal, Unity: open <code>tileset.json</code>",
       false, 0, 0},
      {"tiles/", "\u2026 its tiles", "single GLB files, for Blender and other editors", true, 0, 0},
      {"model.glb", "glTF, whole build", "Blender and other editors, 3D viewers", false, 0, 0},
      {"citygml/", "CityGML 2.0", "FME, 3DCityDB, KIT ModelViewer, azul; one file per tile", true, 0, 0},
      {"cityjson/", "CityJSON 2.0", "text sequence, one file per tile: cjio, cjseq", true, 0, 0},
      {"model.city.json", "CityJSON, whole build", "ninja.cityjson.org, azul, QGIS with its plugin", false, 0, 0},
      {"buildings.gpkg", "GeoPackage", "any GIS: every attribute and its source", false, 0, 0},
      {"buildings.qgz", "QGIS project", "QGIS: the GeoPackage as a map, coloured and labelled", false, 0, 0},
      {"explain/", "What <code>explain</code> reads", "<code>blockrand explain</code>", true, 0, 0},
      {"report.json", "Every report row", "any editor or script", false, 0, 0},
  };
  for (const ReportFile& file : f.files)
    for (Kind& kind : kinds)
      if (kind.folder ? file.path.rfind(kind.prefix, 0) == 0 : file.path == kind.prefix) {
        ++kind.files;
        kind.bytes += file.bytes;
      }
  std::string out =
      "<section id=\"files\">\n<h2>Files</h2>\n<p>All paths are relative to this page.</p>\n<div "
      "class=\"wide\"><table><thead><tr><th>What</th><th>Where</th>"
      "<th class=\"n\">Files</th><th class=\"n\">Size</th><th>Open with</th></tr></thead><tbody>\n";
  const auto row = [&](std::string_view name, std::string_view path, const std::string& files, const std::string& size,
                       std::string_view how) {
    out += "<tr><td>" + std::string(name) + "</td><td><a href=\"" + std::string(path) + "\">" + std::string(path) +
           "</a></td><td class=\"n\">" + files + "</td><td class=\"n\">" + size + "</td><td>" + std::string(how) +
           "</td></tr>\n";
  };
  for (const Kind& kind : kinds)
    if (kind.files > 0)
      row(kind.name, kind.prefix, with_thousands(kind.files), base::with_byte_unit(kind.bytes), kind.how);
  row("Inputs, settings, counts, hashes", "build.json", "1", "", "any editor or script");
  row("Times, memory, host", "run.json", "1", "", "any editor or script");
  out +=
      "</tbody></table></div>\n<h3>Why does this building look as it does?</h3>\n<p>Ask for any building of the map by "
      "its id; "
      "OUT is the folder of this page:</p>\n<pre><code>blockrand explain OUT w123</code></pre>\n"
      "<p>To check every written file again:</p>\n<pre><code>blockrand validate OUT</code></pre>\n</section>\n";
  return out;
}

}  // namespace blockrand::outputs
