// Matches in the page: tables of them, and one after the other in detail.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "pipeline/base/markup.h"
#include "pipeline/base/text.h"
#include "pipeline/compare/comparison_sections.h"
#include "pipeline/compare/report_numbers.h"
#include "pipeline/compare/report_pictures.h"
#include "pipeline/compare/report_places.h"
#include "pipeline/compare/report_svg.h"

namespace blockrand::compare {
namespace {

using base::escaped;
using base::with_thousands;

/// What the tables of matches show.
constexpr std::array<std::pair<Measure, std::string_view>, 10> kColumns{{
    {Measure::distance_rms, "RMS, m"},
    {Measure::distance_p95, "95\u00a0%, m"},
    {Measure::completeness_050, "≤ 0.5\u00a0m, %"},
    {Measure::footprint_iou, "IoU, %"},
    {Measure::eaves_error, "eaves, m"},
    {Measure::ridge_error, "ridge, m"},
    {Measure::roof_volume_ratio, "volume"},
    {Measure::storeys_error, "storeys"},
    {Measure::openings_ratio, "openings"},
    {Measure::opening_recall, "found, %"},
}};

constexpr int kPlanWidth = 300, kPlanHeight = 240, kElevationWidth = 420;  // pixels

std::string name_of_match(const MatchResult& match) { return escaped(match.id.empty() ? "(no id)" : match.id); }

/// Ids with a limit: a block may stand against a hundred houses.
std::string ids(const City& city, const std::vector<std::uint32_t>& buildings, std::size_t most) {
  std::string out;
  for (std::size_t i = 0; i < std::min(most, buildings.size()); ++i)
    out += (i == 0 ? "" : ", ") + escaped(city.buildings[buildings[i]].id);
  if (buildings.size() > most) out += fmt::format(" and {} more", buildings.size() - most);
  return out.empty() ? "(no id)" : out;
}

std::string table_head() {
  std::string out = "<thead><tr><th>match</th><th>model’s buildings</th><th>roof</th>";
  for (const auto& [measure, label] : kColumns)
    out += fmt::format("<th class=\"n\" title=\"{}\">{}</th>", escaped(info(measure).text), label);
  return out + "<th class=\"n\" title=\"share of the reference’s surface\">left out, %</th></tr></thead>\n";
}

std::string table_row(const Comparison& c, std::size_t index) {
  const MatchResult& match = c.matches[index];
  std::string out = fmt::format("<tr><td><a href=\"#{}\">{}</a></td><td class=\"ids\">{}</td>", anchor_of(index),
                                name_of_match(match), ids(c.model, match.model.buildings, 3));
  const RoofForm reference = match.reference.roof_form, model = match.model.roof_form;
  out += reference == model ? fmt::format("<td class=\"form\">{}</td>", name_of(reference))
                            : fmt::format("<td class=\"form\">{} → {}</td>", name_of(reference), name_of(model));
  for (const auto& [measure, label] : kColumns)
    out += "<td class=\"n\">" + value_text(info(measure), value_of(match.values, measure).counted) + "</td>";
  return out + "<td class=\"n\">" + fixed(value_of(match.values, Measure::distance_rms).left_out * 100, 0) +
         "</td></tr>\n";
}

std::string picture(const std::string& png, const MatchPictures& size, std::string_view text) {
  if (png.empty())
    return fmt::format("<figure class=\"none\"><p>nothing to draw</p><figcaption>{}</figcaption></figure>", text);
  std::string out = fmt::format("<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,",
                                size.width, size.height, text);
  base::append_base64(out, png);
  return out + fmt::format("\"/><figcaption>{}</figcaption></figure>", text);
}

std::string height_text(const std::optional<double>& value) { return value ? fixed(*value, 2) + "\u00a0m" : "–"; }

std::string side_facts(const City& city, const SideFacts& side, std::string_view style, std::string_view name) {
  std::string out = fmt::format("<tr><th><span class=\"chip {}\"></span>\u00a0{}</th><td class=\"ids\">{}</td>", style,
                                name, ids(city, side.buildings, 8));
  std::optional<int> lod;
  for (const std::uint32_t b : side.buildings) lod = std::max(lod.value_or(-1), city.buildings[b].lod);
  const auto add = [&](std::string_view text) { out += fmt::format("<td class=\"n\">{}</td>", text); };
  add(lod && *lod >= 0 ? std::to_string(*lod) : "–");
  add(fixed(side.footprint_area, 0) + "\u00a0m²");
  add(height_text(side.eaves));
  add(height_text(side.ridge));
  add(side.volume ? fixed(side.volume, 0) + "\u00a0m³" : "–");
  out += fmt::format("<td>{}{}</td>", name_of(side.roof_form), side.pitch ? ", " + fixed(side.pitch, 0) + "°" : "");
  add(with_thousands(side.openings));
  add(side.solids > 0 ? fmt::format("{} of {}", side.valid_solids, side.solids) : "–");
  return out + "</tr>\n";
}

}  // namespace

std::string anchor_of(std::size_t match) { return "m" + std::to_string(match + 1); }

std::string match_tables(const Comparison& c, std::span<const std::size_t> order) {
  if (order.empty()) return "<section id=\"matches\"><h2>Matches</h2>\n<p>There are none.</p></section>\n";
  std::string out = "<section id=\"matches\"><h2>Matches</h2>\n";
  constexpr std::size_t kListed = 10;
  std::vector<std::size_t> measured;
  for (const std::size_t i : order)
    if (finite(value_of(c.matches[i].values, Measure::distance_rms).counted)) measured.push_back(i);
  const auto table = [&](std::span<const std::size_t> rows, std::string_view title) {
    if (rows.empty()) return;
    out += fmt::format(
        "<h3>{0}</h3>\n<div class=\"wide\" role=\"region\" aria-label=\"{0}\" tabindex=\"0\"><table "
        "class=\"matches\">{1}<tbody>\n",
        title, table_head());
    for (const std::size_t i : rows) out += table_row(c, i);
    out += "</tbody></table></div>\n";
  };
  // Of few matches the table of all says as much.
  if (measured.size() > 2 * kListed) {
    table(std::span(measured).first(kListed), "The ten with the largest distance");
    std::vector<std::size_t> best(measured.rbegin(), measured.rbegin() + kListed);
    table(best, "The ten with the smallest distance");
  }
  out += fmt::format(
      "<h3>All {}</h3>\n<div class=\"wide\" role=\"region\" aria-label=\"All matches\" tabindex=\"0\"><table "
      "class=\"matches\" id=\"all\">{}<tbody>\n",
      order.size(), table_head());
  for (const std::size_t i : order) out += table_row(c, i);
  return out + "</tbody></table></div>\n</section>\n";
}

std::string picture_legend(const ReportOptions& options) {
  const auto swatch = [](model::Colour c, std::string_view text) {
    return fmt::format("<li><span class=\"chip\" style=\"background: #{:02x}{:02x}{:02x}\"></span>\u00a0{}</li>", c.r,
                       c.g, c.b, text);
  };
  std::string out =
      "<section id=\"each\"><h2>Match by match</h2>\n<p>Those with the largest distance first. Both models stand on "
      "their own ground and are "
      "seen by one camera.</p>\n<ul class=\"key\">";
  out +=
      "<li><span class=\"chip r\"></span>\u00a0reference</li><li><span class=\"chip m\"></span>\u00a0model</li>"
      "<li><span class=\"dotted\"></span>\u00a0opening that both have (IoU ≥ 0.5)</li>";
  out += swatch(kPictureWall, "wall") + swatch(kPictureRoof, "roof") + swatch(kPictureWindow, "window") +
         swatch(kPictureDoor, "door") + swatch(kPictureOther, "other") + swatch(kPictureLeftOut, "left out") +
         "</ul>\n";
  out +=
      "<div class=\"scale-bar\"><span>distance to the other model</span><svg viewBox=\"0 0 330 30\" width=\"330\" "
      "height=\"30\" role=\"img\" aria-label=\"Colour scale\">";
  constexpr int kSteps = 30;
  for (int i = 0; i < kSteps; ++i) {
    const model::Colour c = heat_colour((i + 0.5) / kSteps);
    out += fmt::format("<rect x=\"{}\" y=\"0\" width=\"10.5\" height=\"12\" fill=\"#{:02x}{:02x}{:02x}\"/>",
                       10 + i * 10, c.r, c.g, c.b);
  }
  for (int i = 0; i <= 4; ++i)
    out += fmt::format("<text class=\"mid\" x=\"{}\" y=\"26\">{}{}</text>", 10 + i * 75, i == 4 ? "≥ " : "",
                       base::shortest(options.heat_range * i / 4));
  return out + "</svg><span>m</span>" +
         fmt::format("<span class=\"chip\" style=\"background: #{:02x}{:02x}{:02x}\"></span>\u00a0left out",
                     kHeatLeftOut.r, kHeatLeftOut.g, kHeatLeftOut.b) +
         "</div>\n</section>\n";
}

std::string match_section(const Comparison& c, std::size_t index, bool pictures, const DistanceQuery& distances,
                          const ReportOptions& options) {
  const MatchResult& match = c.matches[index];
  std::string out = fmt::format("<section class=\"match{}\" id=\"{}\"><h3>{}</h3>\n", pictures ? "" : " plain",
                                anchor_of(index), name_of_match(match));
  out += fmt::format("<div class=\"wide\" role=\"region\" aria-label=\"The buildings of match {}\" tabindex=\"0\">",
                     index + 1) +
         "<table class=\"facts-of\"><thead><tr><th></th><th>buildings</th><th class=\"n\">LoD</th><th "
         "class=\"n\">footprint</th>"
         "<th class=\"n\">eaves</th><th class=\"n\">ridge</th><th class=\"n\">volume</th><th>roof</th><th "
         "class=\"n\">openings</th>"
         "<th class=\"n\">valid</th></tr></thead><tbody>\n";
  out += side_facts(c.reference, match.reference, "r", "reference") + side_facts(c.model, match.model, "m", "model");
  out += "</tbody></table></div>\n<div class=\"row\">";
  const std::string plan = plan_drawing(c, match, kPlanWidth, kPlanHeight);
  if (!plan.empty())
    out += "<figure>" + plan + "<figcaption>Plan: the outlines one over the other</figcaption></figure>";
  out += "<div class=\"beside\"><table class=\"values small\"><tbody>";
  for (std::size_t m = 0; m < kMeasureCount; ++m) {
    const MeasureInfo& measure = kMeasures[m];
    const MeasureValue& value = match.values[m];
    if (measure.better == Better::none || (!finite(value.counted) && !finite(value.all))) continue;
    const std::string counted = value_with_unit(measure, value.counted), all = value_with_unit(measure, value.all);
    out += fmt::format("<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n soft\">{}</td></tr>",
                       escaped(measure.title), counted, all == counted ? "" : all);
  }
  out +=
      "</tbody></table><p class=\"soft small\">Grey: with what is left out, where that makes a "
      "difference.</p></div></div>\n";
  if (pictures) {
    const MatchPictures drawn = draw_pictures(c, match, distances, options);
    out += "<div class=\"pictures\">" + picture(drawn.reference, drawn, "Reference") +
           picture(drawn.model, drawn, "Model") +
           picture(drawn.reference_heat, drawn, "Reference, by distance to the model") +
           picture(drawn.model_heat, drawn, "Model, by distance to the reference") + "</div>\n";
    const std::string elevations = elevation_drawings(match, kElevationWidth);
    out += elevations.empty() ? "<p class=\"soft small\">No facades to draw.</p>"
                              : "<div class=\"elevations\">" + elevations + "</div>\n";
  }
  return out + "</section>\n";
}

}  // namespace blockrand::compare
