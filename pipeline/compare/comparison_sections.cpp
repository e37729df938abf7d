#include "pipeline/compare/comparison_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "pipeline/base/markup.h"
#include "pipeline/base/text.h"
#include "pipeline/compare/report_charts.h"
#include "pipeline/compare/report_numbers.h"
#include "pipeline/compare/report_places.h"
#include "pipeline/compare/report_words.h"

namespace blockrand::compare {
namespace {

using base::escaped;
using base::with_thousands;

std::string count_of(std::size_t n, std::string_view one, std::string_view many) {
  return with_thousands(n) + " " + std::string(n == 1 ? one : many);
}

std::string last_part(std::string_view path) {
  while (path.size() > 1 && path.back() == '/') path.remove_suffix(1);
  const std::size_t slash = path.find_last_of('/');
  return std::string(slash == std::string_view::npos ? path : path.substr(slash + 1));
}

/// A model by the last part of its path; several paths stand one after the other in its name.
std::string title_of(const City& city) {
  if (city.files.size() < 2 || city.name.find(", ") == std::string::npos) return last_part(city.name);
  return last_part(city.files.front().path) + " and " + std::to_string(city.files.size() - 1) + " more";
}

std::string cell(std::string_view text, std::string_view style = "n") {
  return fmt::format("<td class=\"{}\">{}</td>", style, text);
}

std::string tile(const Comparison& c, Measure measure, std::string_view label) {
  const MeasureInfo& what = info(measure);
  const std::optional<double> value = headline(what, summary_of(c.summaries, measure).counted);
  if (!value) return {};
  const std::string_view unit = unit_of(what);
  return fmt::format("<div><b>{}{}{}</b><span>{}</span></div>\n", value_text(what, value, false),
                     unit.empty() ? "" : "\u00a0", unit, label);
}

void append_files(std::string& out, const City& city, std::string_view side) {
  out += fmt::format(
      "<h3>{}</h3>\n<dl class=\"facts\"><dt>Path</dt><dd>{}</dd><dt>Heights</dt><dd>{}{}</dd>"
      "<dt>Buildings</dt><dd>{} compared",
      side, escaped(short_name(city, 200)), city.height_reference.empty() ? "unknown" : escaped(city.height_reference),
      city.absolute_heights ? " (absolute)" : "", with_thousands(city.buildings.size()));
  if (city.out_of_reach > 0)
    out += fmt::format(", {} out of reach of the other model", with_thousands(city.out_of_reach));
  if (city.without_geometry > 0) out += fmt::format(", {} without a surface", with_thousands(city.without_geometry));
  if (city.repetitions > 0) out += fmt::format(", {} once more in another file", with_thousands(city.repetitions));
  out += "</dd></dl>\n";
  if (city.files.empty()) return;
  constexpr std::size_t kListed = 40;
  out += fmt::format("<div class=\"wide\" role=\"region\" aria-label=\"Files: {}\" tabindex=\"0\">", side) +
         "<table><thead><tr><th>file</th><th>format</th><th>CRS</th><th class=\"n\">size</th>"
         "<th class=\"n\">buildings</th><th class=\"n\">breaches</th><th></th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < std::min(kListed, city.files.size()); ++i) {
    const CityFile& f = city.files[i];
    out += "<tr>" + cell(escaped(last_part(f.path)), "") + cell(escaped(f.format), "") + cell(escaped(f.crs), "") +
           cell(base::with_byte_unit(f.bytes)) + cell(with_thousands(f.buildings)) +
           cell(f.breaches > 0 ? with_thousands(f.breaches) : "none") + "<td class=\"about\">";
    if (!f.notes.empty()) {
      out += "<details><summary>what was found</summary><ul class=\"small\">";
      for (const importers::reference::Note& note : f.notes) {
        out +=
            fmt::format("<li>{}{}: {}", escaped(importers::reference::name_of(note.kind)),
                        importers::reference::is_breach(note.kind) ? "" : " (no breach)", with_thousands(note.count));
        for (const std::string& example : note.examples)
          out += "<br/><span class=\"soft\">" + escaped(example) + "</span>";
        out += "</li>";
      }
      out += "</ul></details>";
    }
    out += "</td></tr>\n";
  }
  if (city.files.size() > kListed)
    out += fmt::format("<tr><td colspan=\"7\" class=\"soft\">and {} more; all are in compare.json</td></tr>\n",
                       with_thousands(city.files.size() - kListed));
  out += "</tbody></table></div>\n";
}

void append_registration(std::string& out, const Comparison& c) {
  const Registration& r = c.registration;
  out += "<h3>Where the models lie to each other</h3>\n";
  if (r.matches == 0) {
    out += "<p>No offset could be estimated: no buildings stand for each other.</p>\n";
    return;
  }
  out += "<div class=\"sum\">";
  const auto part = [&](double value, double spread, std::string_view what) {
    out += fmt::format("<div><b>{}\u00a0m</b><span>{}, ±\u00a0{}\u00a0m</span></div>", with_sign(value, 2), what,
                       fixed(spread, 2));
  };
  part(r.east, r.east_spread, "to the east");
  part(r.north, r.north_spread, "to the north");
  if (r.up) part(*r.up, r.up_spread, "up");
  out += fmt::format(
      "</div>\n<p>The model against the reference: the median over {}, with the median deviation from it. "
      "The horizontal offset was <b>{}</b>, the vertical one <b>{}</b> before measuring. {}</p>\n",
      count_of(r.matches, "match", "matches"), r.horizontal_removed ? "removed" : "not removed",
      r.vertical_removed ? "removed" : "not removed", escaped(r.rule));
}

/// "1" for the first note and so on: an explanation for each measure.
std::string measure_row(std::size_t m, const MeasureSummary& s) {
  const MeasureInfo& measure = kMeasures[m];
  const Summary& counted = s.counted;
  const auto value = [&](const Summary& of, double v, bool sign = true) {
    return of.count > 0 ? value_text(measure, v, sign) : std::string("–");
  };
  const bool error = measure.better == Better::zero;
  const std::string_view unit = unit_of(measure);
  std::string out = fmt::format(
      "<tr><td><span class=\"tip\" title=\"{0}\">{1}</span><a class=\"note\" "
      "href=\"#note-{2}\">{2}</a></td><td>{3}</td>",
      escaped(measure.text), escaped(measure.title), m + 1, unit);
  out += cell("<b>" + value(counted, counted.pooled) + "</b>") + cell(value(s.all, s.all.pooled)) +
         cell(counted.count + s.all.count == 0                                     ? "–"
              : measure.scope == Scope::surface || measure.scope == Scope::facades ? percent(s.left_out)
                                                                                   : "nothing");
  out += cell(value(counted, counted.mean)) + cell(error ? value(counted, counted.mean_abs, false) : "") +
         cell(error ? value(counted, counted.rms, false) : "") + cell(value(counted, counted.median)) +
         cell(value(counted, counted.p95_abs, false)) + cell(with_thousands(counted.count)) + "</tr>\n";
  return out;
}

void append_side(std::string& out, const SideFacts& side, std::string_view name) {
  out += fmt::format("<tr><th>{}</th>", name);
  out +=
      cell(with_thousands(side.solids)) + cell(with_thousands(side.valid_solids)) +
      cell(side.solids > 0 ? percent(static_cast<double>(side.valid_solids) / static_cast<double>(side.solids)) : "–");
  std::string defects;
  for (const auto& [defect, count] : side.defects)
    defects += (defects.empty() ? "" : "<br/>") + escaped(defect) + ": " + with_thousands(count);
  out += cell(side.solids == 0 ? "no solids" : defects.empty() ? "none" : defects, "") + "</tr>\n";
}

}  // namespace

std::string head_section(const Comparison& c) {
  const Words words = words_of(c);
  std::string out = fmt::format(
      "<header>\n<p class=\"kicker\">Blockrand comparison</p>\n<h1><span class=\"side m\">{}</span> against "
      "<span class=\"side r\">{}</span></h1>\n",
      escaped(title_of(c.model)), escaped(title_of(c.reference)));
  out += fmt::format("<p class=\"soft\">Measured in {}, heights {}; the model against the reference.</p>\n",
                     escaped(c.reference.crs.empty() ? c.model.crs : c.reference.crs), heights_text(c));
  out += "<p class=\"lead\">" + words.matching + "</p>\n";
  if (!words.agrees.empty()) out += "<p><b class=\"good\">Agrees:</b> " + words.agrees + ".</p>\n";
  if (!words.between.empty()) out += "<p><b class=\"fair\">In between:</b> " + words.between + ".</p>\n";
  if (!words.differs.empty()) out += "<p><b class=\"bad\">Differs:</b> " + words.differs + ".</p>\n";
  if (!c.matches.empty()) {
    std::string tiles = tile(c, Measure::footprint_iou, "footprint IoU") +
                        tile(c, Measure::eaves_error, "eaves, mean error") +
                        tile(c, Measure::ridge_error, "ridge, mean error") +
                        tile(c, Measure::roof_volume_ratio, "volume under roofs, factor off") +
                        tile(c, Measure::distance_rms, "surface distance, RMS") +
                        tile(c, Measure::completeness_050, "complete within 0.5\u00a0m") +
                        tile(c, Measure::opening_recall, "openings found");
    if (!tiles.empty()) out += "<div class=\"sum\">\n" + tiles + "</div>\n";
    out +=
        "<details class=\"small soft\"><summary>When the page says that something agrees or "
        "differs</summary><p>“Agrees” from the "
        "first value on, “differs” from the second: " +
        escaped(words.limits) +
        ". Ratios count alike above and below 1. The words are for reading; the numbers below are what was "
        "measured.</p></details>\n";
  }
  out +=
      "<nav><a href=\"#measures\">Measures</a><a href=\"#distributions\">Distributions</a><a href=\"#roofs\">Roofs</a>"
      "<a href=\"#surfaces\">Surfaces</a><a href=\"#input\">Files and offset</a><a href=\"#unmatched\">Unmatched</a>"
      "<a href=\"#matches\">Matches</a></nav>\n</header>\n";
  return out;
}

std::string measure_section(const Comparison& c) {
  std::string out =
      "<section id=\"measures\"><h2>All measures</h2>\n"
      "<p>“Value” is pooled over all matches without what is left out of the reference; “with all” is the same with "
      "it; “left out” is the share of the reference’s surface (or facades) that makes the difference. Bias, MAE, RMSE, "
      "median and 95\u00a0% are of matches, each alike, of what is counted.</p>\n"
      "<div class=\"wide\" role=\"region\" aria-label=\"All measures\" tabindex=\"0\"><table "
      "class=\"measures\"><thead><tr><th>measure</th><th>unit</th><th class=\"n\">value</th>"
      "<th class=\"n\">with all</th><th class=\"n\">left out</th><th class=\"n\">mean, bias</th><th "
      "class=\"n\">MAE</th>"
      "<th class=\"n\">RMSE</th><th class=\"n\">median</th><th class=\"n\">95\u00a0%</th><th "
      "class=\"n\">n</th></tr></thead>\n<tbody>\n";
  static constexpr std::array<std::string_view, 4> kScopes{"Footprints", "Heights, volume, roofs, validity", "Surface",
                                                           "Facades and openings"};
  for (const Scope scope : {Scope::plan, Scope::body, Scope::surface, Scope::facades}) {
    out +=
        fmt::format("<tr class=\"group\"><th colspan=\"11\">{}</th></tr>\n", kScopes[static_cast<std::size_t>(scope)]);
    for (std::size_t m = 0; m < kMeasureCount; ++m)
      if (kMeasures[m].scope == scope) out += measure_row(m, c.summaries[m]);
  }
  out += "</tbody></table></div>\n<details><summary>What each measure is</summary><ol class=\"notes small\">\n";
  static constexpr std::array<std::string_view, 4> kPools{"mean of the matches by their weight",
                                                          "root of the mean of squares by weight",
                                                          "largest of the matches", "sum over the matches"};
  static constexpr std::array<std::string_view, 5> kBetter{
      "higher is better, 1 is ideal", "lower is better, 0 is ideal", "0 is ideal; model minus reference",
      "1 is ideal; model : reference", "tells, does not judge"};
  for (std::size_t m = 0; m < kMeasureCount; ++m)
    out += fmt::format("<li id=\"note-{}\"><b>{}</b>: {}. <span class=\"soft\">Pooled: {}; {}.</span></li>\n", m + 1,
                       escaped(kMeasures[m].title), escaped(kMeasures[m].text),
                       kPools[static_cast<std::size_t>(kMeasures[m].pool)],
                       kBetter[static_cast<std::size_t>(kMeasures[m].better)]);
  return out + "</ol></details></section>\n";
}

std::string distribution_section(const Comparison& c) {
  std::string out = "<section id=\"distributions\"><h2>Distributions</h2>\n";
  const std::string curves = distance_curves(c.distances);
  std::string bars =
      histogram(c, Measure::footprint_iou, {0, 1, 20, 1}) + histogram(c, Measure::eaves_error, {-5, 5, 20, 0}) +
      histogram(c, Measure::ridge_error, {-5, 5, 20, 0}) + histogram(c, Measure::roof_volume_ratio, {0, 2, 20, 1}) +
      histogram(c, Measure::distance_rms, {0, 4, 20, 0}) + histogram(c, Measure::opening_recall, {0, 1, 20, 1});
  if (curves.empty() && bars.empty()) return out + "<p>No values.</p></section>\n";
  if (!curves.empty())
    out +=
        "<figure>" + curves +
        "<figcaption>Share of the surface that lies at most so far from the other model; left out parts do not count. "
        "<span class=\"chip r\"></span>\u00a0from the reference to the model: what the model lacks. "
        "<span class=\"chip m\"></span>\u00a0from the model to the reference: what it has too much. The dots stand at "
        "95\u00a0%: " +
        fixed(c.distances.p95_to_model, 2) + "\u00a0m and " + fixed(c.distances.p95_to_reference, 2) +
        "\u00a0m.</figcaption></figure>\n";
  if (!bars.empty())
    out +=
        "<div class=\"charts\">" + bars + "</div>\n<p class=\"soft small\">The dashed line is the ideal value.</p>\n";
  return out + "</section>\n";
}

std::string roof_section(const Comparison& c) {
  const std::string table = confusion_table(c);
  return "<section id=\"roofs\"><h2>Roof forms</h2>\n" + (table.empty() ? "<p>No roofs were compared.</p>" : table) +
         "</section>\n";
}

std::string surface_section(const Comparison& c) {
  const SideFacts &reference = c.reference_total, &model = c.model_total;
  std::string out = "<section id=\"surfaces\"><h2>Surfaces</h2>\n<h3>Classes</h3>\n";
  const auto share = [](double part, double whole) { return whole > 0 ? part / whole : 0; };
  out +=
      "<div class=\"wide\" role=\"region\" aria-label=\"Surfaces by class\" tabindex=\"0\"><table "
      "class=\"classes\"><thead><tr><th>class</th><th class=\"n\">reference, m²</th><th "
      "class=\"n\">share</th><th></th>"
      "<th class=\"n\">model, m²</th><th class=\"n\">share</th><th></th></tr></thead><tbody>\n";
  const auto row = [&](std::string_view name, double r, double m) {
    out += fmt::format("<tr><td>{}</td>", name);
    for (const auto& [value, whole, style] :
         {std::tuple(r, reference.surface_area, 'r'), std::tuple(m, model.surface_area, 'm')})
      out += cell(with_thousands(static_cast<std::uint64_t>(std::max(0.0, value) + 0.5))) +
             cell(whole > 0 ? percent(share(value, whole)) : "–") +
             fmt::format("<td class=\"bar\"><span class=\"{}\" style=\"width: {:.1f}%\"></span></td>", style,
                         std::clamp(share(value, whole) * 100, 0.0, 100.0));
    out += "</tr>\n";
  };
  for (std::size_t i = 0; i < kHullCount; ++i) {
    if (reference.area_of[i] <= 0 && model.area_of[i] <= 0) continue;
    std::string name(name_of(static_cast<Hull>(i)));
    std::replace(name.begin(), name.end(), '_', ' ');
    row(name, reference.area_of[i], model.area_of[i]);
  }
  row("<i>class not stated, told from the slope</i>", reference.unclassified_area, model.unclassified_area);
  out +=
      "</tbody></table></div>\n<h3>What is left out of the reference, and why</h3>\n<table><thead><tr><th>part</th><th "
      "class=\"n\">m²</th>"
      "<th class=\"n\">share</th></tr></thead><tbody>\n";
  static constexpr std::array<std::string_view, kLeftOutCount> kReasons{
      "counted", "undersides: nobody sees them, and how deep they lie is convention",
      "party walls: another building of the same model stands against them",
      "blank sides of buildings that have openings elsewhere: not modelled, not windowless"};
  for (std::size_t i = 0; i < kLeftOutCount; ++i)
    out += fmt::format("<tr><td>{}</td>", kReasons[i]) +
           cell(with_thousands(static_cast<std::uint64_t>(std::max(0.0, reference.left_out[i]) + 0.5))) +
           cell(reference.surface_area > 0 ? percent(share(reference.left_out[i], reference.surface_area)) : "–") +
           "</tr>\n";
  out += "</tbody></table>\n<p>" +
         count_of(c.blank_facades, "facade of the reference is", "facades of the reference are") +
         " blank and left out.</p>\n<h3>Validity and size</h3>\n<table><thead><tr><th></th><th "
         "class=\"n\">solids</th><th class=\"n\">valid</th>"
         "<th class=\"n\">share</th><th>defects (ISO 19107): solids</th></tr></thead><tbody>\n";
  append_side(out, reference, "reference");
  append_side(out, model, "model");
  const auto bytes = [](const City& city) {
    std::uint64_t sum = 0;
    for (const CityFile& f : city.files) sum += f.bytes;
    return base::with_byte_unit(sum);
  };
  out += fmt::format(
      "</tbody></table>\n<p>Triangles of the matched buildings: reference {}, model {}. Openings: {} and {}. Files: {} "
      "and {}.</p></section>\n",
      with_thousands(reference.triangles), with_thousands(model.triangles), with_thousands(reference.openings),
      with_thousands(model.openings), bytes(c.reference), bytes(c.model));
  return out;
}

std::string input_section(const Comparison& c) {
  std::string out = "<section id=\"input\"><h2>Files and offset</h2>\n";
  append_files(out, c.reference, "Reference");
  append_files(out, c.model, "Model");
  append_registration(out, c);
  return out + "</section>\n";
}

std::string unmatched_section(const Comparison& c) {
  std::string out = "<section id=\"unmatched\"><h2>Buildings without a counterpart</h2>\n";
  const auto list = [&](const City& city, const std::vector<std::uint32_t>& buildings, std::string_view title) {
    constexpr std::size_t kListed = 500;
    out += fmt::format("<h3>{}: {}</h3>\n", title, with_thousands(buildings.size()));
    if (buildings.empty()) return;
    out += fmt::format("<details{}><summary>Ids, places in {} and footprints</summary><ul class=\"objects\">\n",
                       buildings.size() <= 20 ? " open=\"open\"" : "", escaped(city.crs));
    for (std::size_t i = 0; i < std::min(kListed, buildings.size()); ++i) {
      const Building& b = city.buildings[buildings[i]];
      const Point2 place = place_of(city, b);
      out += fmt::format("<li>{} <span class=\"soft\">{} {}, {}\u00a0m²</span></li>\n",
                         escaped(b.id.empty() ? "(no id)" : b.id), fixed(place.x, 1), fixed(place.y, 1),
                         fixed(b.footprint_area, 0));
    }
    out += "</ul>";
    if (buildings.size() > kListed)
      out += fmt::format("<p class=\"soft\">And {} more; all are in compare.json.</p>",
                         with_thousands(buildings.size() - kListed));
    out += "</details>\n";
  };
  list(c.reference, c.missing, "Missing from the model");
  list(c.model, c.extra, "Only in the model");
  return out + "</section>\n";
}

}  // namespace blockrand::compare
