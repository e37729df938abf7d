#include "pipeline/cli/build_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "pipeline/base/text.h"
#include "pipeline/model/issue_codes.h"
#include "pipeline/outputs/output.h"

namespace blockrand::cli {
namespace {

using base::with_byte_unit;
using base::with_thousands;
using model::IssueClass;

const model::IssueInfo* find_code(const std::string& text) {
  for (const model::IssueInfo& info : model::kIssueInfo)
    if (info.text == text) return &info;
  return nullptr;
}

std::string row(const std::string& name, std::uint64_t count, const std::string& remark) {
  std::string line = fmt::format("  {:<24}{:>12}  {}", name, with_thousands(count), remark);
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

/// Rows of one class of codes, most frequent first.
std::string code_rows(const run::BuildSummary& summary, IssueClass wanted, const std::string& title) {
  std::vector<std::pair<std::string, std::uint64_t>> codes;
  for (const auto& [code, count] : summary.issues) {
    const model::IssueInfo* info = find_code(code);
    if (count > 0 && (info ? info->issue_class : IssueClass::notice) == wanted) codes.emplace_back(code, count);
  }
  if (codes.empty()) return {};
  std::stable_sort(codes.begin(), codes.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text = "\n" + title + "\n";
  for (const auto& [code, count] : codes) {
    const model::IssueInfo* info = find_code(code);
    text += row(code, count, info ? std::string(info->meaning) : "");
  }
  return text;
}

/// How sloped roofs stand in their rows; nothing where there are no rows.
std::string roofscape_rows(const masses::Roofscape& r) {
  if (r.mid_row + r.corner_houses + r.meetings + r.party_eaves == 0) return {};
  std::string text = "\nSloped roofs in rows\n";
  const auto share = [](std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? std::string("-")
                      : fmt::format("{:.1f} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
  };
  text += row("mid-row houses", r.mid_row,
              fmt::format("eaves to the street {}, to the rear {}", share(r.eaves_to_street, r.mid_row),
                          share(r.eaves_to_rear, r.with_rear)));
  text += row("corner houses", r.corner_houses, fmt::format("the ridge turns in {}", share(r.turned, r.corner_houses)));
  text += row("eaves at neighbours", r.party_eaves,
              fmt::format("{} of them as mapped", with_thousands(r.party_eaves_mapped)));
  text += row("slopes that meet", r.meetings, fmt::format("{} of them more than 1 cm apart", with_thousands(r.apart)));
  return text;
}

std::string folder_of(const run::BuildOptions& options, const run::BuildSummary& s) {
  return s.folder.empty() ? options.output : s.folder;
}

/// As a shell takes it.
std::string for_shell(const std::string& path) {
  if (!path.empty() &&
      path.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/._-+,:@%") ==
          std::string::npos)
    return path;
  std::string out = "'";
  for (const char c : path) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

double rate(const run::BuildSummary& s) {
  return s.seconds > 0 ? static_cast<double>(s.buildings_in + s.parts_in) / s.seconds : 0;
}

}  // namespace

std::string unaccounted_text(const run::BuildOptions& options, const run::BuildSummary& s) {
  constexpr std::size_t kNamed = 20;
  std::vector<std::string> named = s.unaccounted;
  if (named.size() > kNamed) named.resize(kNamed);
  const std::string rest =
      named.size() < s.unaccounted.size() ? fmt::format(" and {} more", s.unaccounted.size() - kNamed) : "";
  return fmt::format(
      "internal error: no stage decided on {} of the extract: {}{} (UNACCOUNTED in report.json). {} This is a bug: "
      "please "
      "report it with the command.",
      s.unaccounted.size() == 1 ? "an object" : with_thousands(s.unaccounted.size()) + " objects",
      fmt::join(named, ", "), rest,
      s.folder == options.output ? "The build lies in " + s.folder + "."
                                 : "The earlier build stays as it was, the new one lies in " + s.folder + ".");
}

std::string build_report(const run::BuildOptions& options, const run::BuildSummary& s, bool verbose) {
  const std::string folder = folder_of(options, s);
  std::string text = "Objects\n";
  text += row("in", s.buildings_in + s.parts_in,
              fmt::format("{} buildings, {} parts", with_thousands(s.buildings_in), with_thousands(s.parts_in)));
  text += row("modelled", s.models, "");
  text += row("represented", s.represented, "by their parts or by another object");
  text += row("duplicate", s.duplicates, "the same object mapped twice");
  text += row("reported", s.reported, "not modelled; reasons below, objects in report.json");
  text += "\nModels by level of detail\n";
  for (std::size_t lod = s.models_by_lod.size(); lod-- > 0;)
    if (static_cast<int>(lod) <= options.lod || s.models_by_lod[lod] > 0)
      text += row(fmt::format("LoD {}", lod), s.models_by_lod[lod], "");
  if (verbose) text += roofscape_rows(s.roofscape);
  text += code_rows(s, IssueClass::reported, "Not modelled, because");
  text += code_rows(s, IssueClass::fallback, "Simpler than asked");
  text += code_rows(s, IssueClass::notice, "Notices");
  text += fmt::format("\n{}, peak memory {}", base::with_time_unit(s.seconds), with_byte_unit(s.peak_rss_bytes));
  text += s.areas > 0
              ? fmt::format(" of one area; the extract took {} on disk meanwhile\n", with_byte_unit(s.store_bytes))
              : "\n";
  if (verbose) {
    text += fmt::format("{} buildings and parts/s", with_thousands(static_cast<std::uint64_t>(rate(s))));
    if (s.areas == 0)
      text += fmt::format("; of the memory {} store, the rest {} tiles in flight", with_byte_unit(s.store_bytes),
                          s.tiles_in_flight);
    text += "\n";
  }
  text += fmt::format("{} in {} files:\n", with_byte_unit(s.bytes), with_thousands(s.files));
  std::vector<std::pair<std::string, std::string>> places;
  const auto place = [&](std::string_view name, std::string_view what) {
    const auto figures = s.figures.find(name);
    places.emplace_back((std::filesystem::path(folder) / name).string(),
                        std::string(what) + (figures == s.figures.end() ? "" : ": " + figures->second));
  };
  if (s.areas > 0) {
    place("areas/", fmt::format("{} areas, each a build of its own: tiles, files, report", with_thousands(s.areas)));
    if (std::filesystem::exists(folder + "/tileset.json"))
      place("tileset.json", "3D Tiles of all areas, for CesiumJS, QGIS 3.34+, Unreal, ...");
    if (std::filesystem::exists(folder + "/buildings.vrt"))
      place("buildings.vrt", "buildings of all areas as one layer, for QGIS and GDAL");
    if (options.outputs.report) place("report.html", "sums, and the way to each area's report");
  }
  for (const outputs::OutputFormat& format : outputs::all_outputs()) {
    if (s.areas > 0) break;
    if (!format.asked(options.outputs)) continue;
    for (const outputs::OutputPlace& p : format.places)
      if (!p.written || p.written(options.outputs, s.models)) place(p.path, p.about);
  }
  place("build.json", "inputs, coordinate system, counts, hashes");
  std::size_t width = 0;
  for (const auto& [path, what] : places) width = std::max(width, path.size());
  for (const auto& [path, what] : places) text += fmt::format("  {:<{}}  {}\n", path, width, what);
  if (options.outputs.writes("gltf") && options.outputs.compression != outputs::Compression::none)
    text += "tiles are compressed by meshopt; for programs that cannot read that: --compress none\n";
  if (options.outputs.explain)
    text += fmt::format("why a building looks as it does: blockrand explain {} w123\n", for_shell(folder));
  return text + fmt::format("to look at it: blockrand view {}\n", for_shell(folder));
}

std::string build_report_json(const run::BuildOptions& options, const run::BuildSummary& s) {
  nlohmann::ordered_json j;
  j["output"] = folder_of(options, s);
  j["buildings_in"] = s.buildings_in;
  j["parts_in"] = s.parts_in;
  j["models"] = s.models;
  j["represented"] = s.represented;
  j["duplicates"] = s.duplicates;
  j["reported"] = s.reported;
  j["models_by_lod"] = s.models_by_lod;
  j["issues"] = s.issues;
  j["files"] = s.files;
  j["bytes"] = s.bytes;
  j["seconds"] = s.seconds;
  j["objects_per_second"] = rate(s);
  j["peak_rss_bytes"] = s.peak_rss_bytes;
  j["below_quality"] = s.below_quality;
  return j.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace blockrand::cli
