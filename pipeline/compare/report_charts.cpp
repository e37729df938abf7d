#include "pipeline/compare/report_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/markup.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/base/text.h"
#include "pipeline/compare/report_numbers.h"
#include "pipeline/compare/report_svg.h"

namespace blockrand::compare {
namespace {

constexpr double kLeft = 44, kTop = 10, kWidth = 560, kHeight = 200;  // pixels: the field of the curves

std::string text_at(double x, double y, std::string_view style, std::string_view text) {
  std::string out = "<text";
  if (!style.empty()) ((out += " class=\"") += style) += '"';
  out += " x=\"";
  append_pixel(out, x);
  out += "\" y=\"";
  append_pixel(out, y);
  return ((out += "\">") += text) + "</text>";
}

std::string line_at(double x, double y, std::string_view by, std::string_view style) {
  std::string out = "<path class=\"" + std::string(style) + "\" d=\"M";
  append_pixel(out, x);
  out += ' ';
  append_pixel(out, y);
  return ((out += by)) + "\"/>";
}

}  // namespace

std::string distance_curves(const DistanceDistribution& d) {
  std::vector<double> upto;
  for (const double v : d.upto)
    if (std::isfinite(v) && v > 0) upto.push_back(v);
  if (upto.size() < 2 || upto.size() != d.upto.size() || d.to_reference.size() != upto.size() ||
      d.to_model.size() != upto.size())
    return {};
  const double low = base::log(upto.front()), high = base::log(upto.back());
  const auto x = [&](double metres) { return kLeft + kWidth * (base::log(metres) - low) / (high - low); };
  const auto y = [&](double share) { return kTop + kHeight * (1 - std::clamp(share, 0.0, 1.0)); };
  std::string out =
      "<svg class=\"chart\" viewBox=\"0 0 640 262\" width=\"640\" height=\"262\" role=\"img\" aria-label=\"Share of "
      "the surface up to each distance\">";
  for (int share = 0; share <= 100; share += 25) {
    out += line_at(kLeft, y(share / 100.0), fmt::format("h{}", kWidth), "grid");
    out += text_at(kLeft - 6, y(share / 100.0) + 4, "end", fmt::format("{}\u00a0%", share));
  }
  for (const double metres : {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
    if (metres < upto.front() * 0.999 || metres > upto.back() * 1.001) continue;
    out += line_at(x(metres), kTop, fmt::format("v{}", kHeight), "grid");
    out += text_at(x(metres), kTop + kHeight + 16, "mid", base::shortest(metres));
  }
  out +=
      text_at(kLeft + kWidth / 2, kTop + kHeight + 36, "mid", "distance to the other model’s surface, m (logarithmic)");
  const auto curve = [&](const std::vector<double>& shares, double p95, std::string_view style) {
    std::string path;
    for (std::size_t i = 0; i < upto.size(); ++i) {
      path += i == 0 ? 'M' : 'L';
      append_pixel(path, x(upto[i]));
      path += ' ';
      append_pixel(path, y(std::isfinite(shares[i]) ? shares[i] : 0));
    }
    out += fmt::format("<path class=\"curve {}\" d=\"{}\"/>", style, path);
    if (std::isfinite(p95) && p95 >= upto.front() && p95 <= upto.back()) {
      std::string circle = "<circle class=\"spot ";
      circle += style;
      circle += "\" r=\"4\" cx=\"";
      append_pixel(circle, x(p95));
      circle += "\" cy=\"";
      append_pixel(circle, y(0.95));
      out += circle + "\"><title>95 % within " + fixed(p95, 2) + " m</title></circle>";
    }
  };
  curve(d.to_model, d.p95_to_model, "r");
  curve(d.to_reference, d.p95_to_reference, "m");
  return out + "</svg>";
}

std::string histogram(const Comparison& c, Measure measure, const HistogramRange& range) {
  const MeasureInfo& what = info(measure);
  std::vector<std::size_t> bars(static_cast<std::size_t>(range.bars), 0);
  std::size_t below = 0, above = 0, count = 0;
  for (const MatchResult& match : c.matches) {
    const std::optional<double> value = finite(value_of(match.values, measure).counted);
    if (!value) continue;
    ++count;
    if (*value < range.from) ++below;
    if (*value > range.to) ++above;
    const double at = std::clamp((*value - range.from) / (range.to - range.from), 0.0, 1.0) * range.bars;
    ++bars[std::min(bars.size() - 1, static_cast<std::size_t>(at))];
  }
  if (count == 0) return {};
  constexpr double kFieldLeft = 34, kFieldTop = 8, kFieldWidth = 290, kFieldHeight = 110;
  const std::size_t most = *std::max_element(bars.begin(), bars.end());
  std::string out = fmt::format(
      "<figure><figcaption><b>{}</b></figcaption><svg class=\"chart\" viewBox=\"0 0 336 168\" width=\"336\" "
      "height=\"168\" role=\"img\" aria-label=\"Histogram of {}\">",
      base::escaped(what.title), base::escaped(what.title));
  const auto x = [&](double value) {
    return kFieldLeft + kFieldWidth * (value - range.from) / (range.to - range.from);
  };
  out += line_at(kFieldLeft, kFieldTop, fmt::format("h{}", kFieldWidth), "grid");
  out += text_at(kFieldLeft - 5, kFieldTop + 4, "end", std::to_string(most));
  out += text_at(kFieldLeft - 5, kFieldTop + kFieldHeight, "end", "0");
  const double step = kFieldWidth / range.bars;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    if (bars[i] == 0) continue;
    const double tall = std::max(1.0, kFieldHeight * static_cast<double>(bars[i]) / static_cast<double>(most));
    std::string bar = "<path class=\"hist\" d=\"M";
    append_pixel(bar, kFieldLeft + step * static_cast<double>(i) + 0.5);
    bar += ' ';
    append_pixel(bar, kFieldTop + kFieldHeight - tall);
    bar += 'h';
    append_pixel(bar, step - 1);
    bar += 'v';
    append_pixel(bar, tall);
    bar += 'h';
    append_pixel(bar, 1 - step);
    out += bar + "Z\"><title>" + std::to_string(bars[i]) + (bars[i] == 1 ? " match" : " matches") + "</title></path>";
  }
  if (range.ideal >= range.from && range.ideal <= range.to)
    out += line_at(x(range.ideal), kFieldTop - 4, fmt::format("v{}", kFieldHeight + 4), "ideal");
  out += line_at(kFieldLeft, kFieldTop + kFieldHeight, fmt::format("h{}", kFieldWidth), "axis");
  for (int i = 0; i <= 4; ++i) {
    const double value = range.from + (range.to - range.from) * i / 4;
    const double shown = is_share(what) ? value * 100 : value;
    std::string label = base::shortest(std::round(shown * 100) / 100);
    if (label.front() == '-') label = "−" + label.substr(1);
    out += text_at(x(value), kFieldTop + kFieldHeight + 15, "mid", label);
  }
  const std::string_view unit = unit_of(what);
  const std::string axis =
      unit.empty() ? what.better == Better::one ? "model : reference" : std::string(what.title)
                   : std::string(what.better == Better::zero ? "model minus reference, " : "") + std::string(unit);
  out += text_at(kFieldLeft + kFieldWidth / 2, kFieldTop + kFieldHeight + 34, "mid", base::escaped(axis));
  out += "</svg><p class=\"soft small\">" + base::with_thousands(count) + (count == 1 ? " match" : " matches");
  if (below + above > 0)
    out += fmt::format("; beyond the scale, in the outermost bars: {} below, {} above", below, above);
  return out + "</p></figure>";
}

std::string confusion_table(const Comparison& c) {
  std::array<std::size_t, kRoofFormCount> rows{}, columns{};
  std::size_t all = 0, agree = 0;
  for (std::size_t r = 0; r < kRoofFormCount; ++r)
    for (std::size_t m = 0; m < kRoofFormCount; ++m) {
      rows[r] += c.roof_confusion[r][m];
      columns[m] += c.roof_confusion[r][m];
      all += c.roof_confusion[r][m];
      if (r == m) agree += c.roof_confusion[r][m];
    }
  if (all == 0) return {};
  std::string out = "<table class=\"confusion\"><thead><tr><th>reference</th>";
  for (std::size_t m = 0; m < kRoofFormCount; ++m)
    if (columns[m] > 0) out += fmt::format("<th class=\"n\">{}</th>", name_of(static_cast<RoofForm>(m)));
  out += "<th class=\"n\">all</th></tr></thead><tbody>";
  for (std::size_t r = 0; r < kRoofFormCount; ++r) {
    if (rows[r] == 0) continue;
    out += fmt::format("<tr><th>{}</th>", name_of(static_cast<RoofForm>(r)));
    for (std::size_t m = 0; m < kRoofFormCount; ++m) {
      if (columns[m] == 0) continue;
      const std::size_t count = c.roof_confusion[r][m];
      // Shade by the share of the row, so that rare forms can be read too.
      const auto shade = static_cast<int>(count * 100 / rows[r]);
      if (count == 0)
        out += "<td class=\"n soft\">·</td>";
      else
        out += fmt::format("<td class=\"n {}\" style=\"--share: {}%\">{}</td>", r == m ? "hit" : "miss", shade, count);
    }
    out += fmt::format("<td class=\"n soft\">{}</td></tr>", rows[r]);
  }
  out += fmt::format(
      "</tbody></table><p class=\"soft small\">Rows: the reference’s form, columns: the model’s, both as the roof’s "
      "planes show it. The same in {} of {} matches ({}).</p>",
      agree, all, percent(static_cast<double>(agree) / static_cast<double>(all), 0));
  return out;
}

}  // namespace blockrand::compare
