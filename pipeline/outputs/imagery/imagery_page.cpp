#include "pipeline/outputs/imagery/imagery_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/base/assets.h"
#include "pipeline/base/markup.h"
#include "pipeline/base/text.h"
#include "pipeline/outputs/imagery/seen_outline.h"
#include "pipeline/outputs/report/html_text.h"

namespace blockrand::outputs {
namespace {

using observation::OutlineReceipt;
using observation::RowState;

/// m: around a house on its picture, and a pixel of it.
constexpr double kAround = 8, kChipPixel = 0.25, kLargestChip = 120;

bool walls_shifted(const OutlineReceipt& r) { return r.refined.state == observation::RefinementState::refined; }

/// m: of the row, and of the wall that is shifted most.
double size_of(const OutlineReceipt& r) {
  const double row = r.state == RowState::corrected ? std::sqrt(r.shift.x * r.shift.x + r.shift.y * r.shift.y) : 0;
  return row + (walls_shifted(r) ? r.refined.largest : 0);
}

std::string swatch(model::Colour colour, std::string_view what) {
  return fmt::format(
      "<li><span style=\"background:{};border:1px solid #888;display:inline-block;width:1em;height:1em\"></span> "
      "{}</li>",
      model::text(colour), what);
}

std::string image_rows(const OverlayInputs& in) {
  std::string out;
  for (const observation::ImageReceipt& image : in.seen.images) {
    const importers::imagery::ImageSource& source = image.description.source;
    out += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}: {}</td></tr>\n",
                       escaped(source.path.substr(source.path.find_last_of('/') + 1)), escaped(source.date),
                       escaped(source.attribution + (source.licence.empty() ? "" : ", " + source.licence)),
                       observation::name(image.fit.state), escaped(image.fit.why));
  }
  return out;
}

std::string count_rows(const OverlayInputs& in) {
  std::map<std::pair<RowState, std::string>, std::uint64_t> counts;
  for (const OutlineReceipt& r : in.seen.outlines) ++counts[{r.state, r.reason}];
  std::string out;
  for (const auto& [key, count] : counts) {
    const auto& [state, reason] = key;
    const std::string_view what = state == RowState::corrected && in.seen.applied ? "moved" : observation::words(state);
    out += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td></tr>\n", what, escaped(reason),
                       base::with_thousands(count));
  }
  return out;
}

/// What became of single walls of houses; empty where nobody looked for them.
std::string wall_rows(const OverlayInputs& in) {
  std::map<std::pair<observation::RefinementState, std::string>, std::uint64_t> counts;
  for (const OutlineReceipt& r : in.seen.outlines)
    if (r.refined.state != observation::RefinementState::none) ++counts[{r.refined.state, r.refined.reason}];
  if (counts.empty()) return "";
  std::string out =
      "<h2>Single walls</h2>\n<p>Of houses that stand where the image shows them, or were moved there: walls that it "
      "shows "
      "beside the others.</p>\n<table><thead><tr><th>What</th><th>Why</th><th class=\"n\">Buildings</th></tr></thead>"
      "<tbody>\n";
  for (const auto& [key, count] : counts) {
    const auto& [state, reason] = key;
    std::string_view what = "as mapped";
    if (state == observation::RefinementState::refused) what = "refused";
    if (state == observation::RefinementState::refined)
      what = in.seen.applied ? "walls shifted" : "walls seen elsewhere";
    out += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td></tr>\n", what, escaped(reason),
                       base::with_thousands(count));
  }
  return out + "</tbody></table>\n";
}

/// A house with its surroundings; the largest halls are cut. \param name  of what the picture shows
std::string chip(const OverlayInputs& in, geometry::PlanBox box, std::uint32_t image, const std::string& name) {
  const model::Point2 middle = box.centre();
  const double x = std::min(kLargestChip / 2, (box.maximum.x - box.minimum.x) / 2 + kAround),
               y = std::min(kLargestChip / 2, (box.maximum.y - box.minimum.y) / 2 + kAround);
  box = {{middle.x - x, middle.y - y}, {middle.x + x, middle.y + y}};
  std::vector<std::uint32_t> near;
  for (std::uint32_t b = 0; b < in.seen.outlines.size(); ++b)
    if (in.footprints[b].box.near(box, 0)) near.push_back(b);
  const picture::Image picture = draw_overlay(in, box, kChipPixel, near, image);
  std::string out = fmt::format("<img width=\"{}\" height=\"{}\" alt=\"{} in the image\" src=\"data:image/png;base64,",
                                picture.width, picture.height, name);
  base::append_base64(out, picture::palette_png(picture, 128));
  return out + "\"/>";
}

std::string figure(const OverlayInputs& in, std::uint32_t building) {
  const OutlineReceipt& r = in.seen.outlines[building];
  const SeenOutline seen{r, in.seen.images[r.image], in.seen.applied, in.footprints[building].box,
                         in.seen.roofs[building].courtyards};
  const footprints::StoredFootprint& footprint = in.footprints[building];
  return "<figure>" + chip(in, footprint.box, r.image, footprint.id.text()) + "<figcaption>" +
         osm_link(in.footprints[building].id) + ": " + escaped(imagery_text(seen)) + "</figcaption></figure>\n";
}

/// What is mapped where the image shows no building, the likeliest first.
std::string gone_figures(const OverlayInputs& in) {
  std::vector<std::uint32_t> gone;
  for (std::uint32_t b = 0; b < in.seen.outlines.size(); ++b)
    if (in.seen.outlines[b].gone > 0) gone.push_back(b);
  std::ranges::stable_sort(
      gone, [&](std::uint32_t a, std::uint32_t b) { return in.seen.outlines[a].gone > in.seen.outlines[b].gone; });
  std::string out = fmt::format("<h2>Perhaps gone: {}</h2>\n<p>Mapped, and built; the image shows no house.</p>\n",
                                base::with_thousands(gone.size()));
  gone.resize(std::min(gone.size(), kPicturedCorrections));
  for (const std::uint32_t b : gone) out += figure(in, b);
  return out;
}

/// Courtyards that are mapped open and look built over, the likeliest first.
std::string courtyard_figures(const OverlayInputs& in) {
  std::uint64_t looked = 0, open = 0;
  std::vector<std::pair<double, std::uint32_t>> built_over;
  for (std::uint32_t b = 0; b < in.seen.roofs.size(); ++b) {
    if (in.seen.outlines[b].image >= in.seen.images.size()) continue;
    double most = 0;
    for (const observation::CourtyardView& c : in.seen.roofs[b].courtyards) {
      ++looked, open += c.state == observation::CourtyardState::open;
      if (c.state == observation::CourtyardState::built_over) most = std::max(most, c.built_over);
    }
    if (most > 0) built_over.emplace_back(-most, b);
  }
  if (looked == 0) return {};
  std::ranges::sort(built_over);
  std::string out = fmt::format(
      "<h2>Courtyards perhaps built over: {}</h2>\n<p>Mapped as open, and built so; the image shows a roof. "
      "Of {} courtyards {} are surely open.</p>\n",
      base::with_thousands(built_over.size()), base::with_thousands(looked), base::with_thousands(open));
  built_over.resize(std::min(built_over.size(), kPicturedCandidates));
  for (const auto& [sure, b] : built_over) out += figure(in, b);
  return out;
}

/// What looks like a building where none is mapped, the likeliest first.
std::string unmapped_figures(const OverlayInputs& in) {
  const std::vector<observation::UnmappedBuilding>& all = in.seen.unmapped;
  std::string out = fmt::format(
      "<h2>Perhaps not mapped: {}</h2>\n<p>What looks like a building where the map has none: candidates to look at; "
      "nothing was built there.</p>\n",
      base::with_thousands(all.size()));
  for (const observation::UnmappedBuilding& u : std::span(all).first(std::min(all.size(), kPicturedCandidates))) {
    const importers::imagery::ImageSource& source = in.seen.images[u.image].description.source;
    out += "<figure>" + chip(in, geometry::box_of(u.outline), u.image, u.id) + "<figcaption>" +
           escaped(fmt::format("{}: {:.0f} m², probability {:.2f}, {}{}{}", u.id, u.area, std::min(0.99, u.probability),
                               source.path.substr(source.path.find_last_of('/') + 1),
                               source.date.empty() ? "" : " of " + source.date,
                               u.of_roof ? "; the outline is the roof's, how far it leans is not known" : "")) +
           "</figcaption></figure>\n";
  }
  return out;
}

}  // namespace

std::string imagery_page(const OverlayInputs& in, const std::vector<std::string>& overlays) {
  std::vector<std::uint32_t> largest;
  for (std::uint32_t b = 0; b < in.seen.outlines.size(); ++b)
    if (in.seen.outlines[b].state == RowState::corrected || walls_shifted(in.seen.outlines[b])) largest.push_back(b);
  const std::size_t all = largest.size();
  std::ranges::stable_sort(largest, [&](std::uint32_t a, std::uint32_t b) {
    return size_of(in.seen.outlines[a]) > size_of(in.seen.outlines[b]);
  });
  largest.resize(std::min(largest.size(), kPicturedCorrections));
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<link rel=\"icon\" "
      "href=\"data:,\"/>\n"
      "<title>What the images changed</title>\n<style>";
  out += base::asset("page.css");
  out += "</style>\n</head>\n<body>\n<main>\n<h1>What the images changed</h1>\n";
  out += in.seen.applied ? "<p>Rows of houses that an image surely shows elsewhere were moved there.</p>\n"
                         : "<p>Nothing was moved: that is to be asked for (--imagery-correct apply).</p>\n";
  out +=
      "<h2>Images</h2>\n<table><thead><tr><th>Image</th><th>Date</th><th>By whom, licence</th><th>Does it fit the "
      "map?</th>"
      "</tr></thead><tbody>\n" +
      image_rows(in) + "</tbody></table>\n";
  out +=
      "<h2>Buildings</h2>\n<table><thead><tr><th>What</th><th>Why</th><th "
      "class=\"n\">Buildings</th></tr></thead><tbody>\n" +
      count_rows(in) + "</tbody></table>\n" + wall_rows(in);
  const std::string what = in.seen.applied ? "moved or reshaped" : "seen elsewhere or reshaped";
  out += fmt::format("<h2>The largest of {} {}</h2>\n<ul>", base::with_thousands(all), what);
  out += swatch(kBefore, "as mapped") + swatch(kAfterUnsure, "where the image shows it, just sure enough") +
         swatch(kAfterSure, "the same, quite sure") + swatch(kRefused, "the same, but it stays as mapped") +
         swatch(kAsMapped, "stays as mapped") + swatch(kUnmapped, "perhaps a building that is not mapped") +
         "</ul>\n<p>Outlines are drawn where the image shows the roofs.</p>\n";
  if (largest.empty()) out += "<p>None.</p>\n";
  for (const std::uint32_t b : largest) out += figure(in, b);
  out += gone_figures(in);
  out += courtyard_figures(in);
  out += unmapped_figures(in);
  if (!overlays.empty()) {
    out += "<h2>Tiles</h2>\n<ul>\n";
    for (const std::string& path : overlays)
      if (path.ends_with(".png")) out += "<li><a href=\"" + path + "\">" + path + "</a></li>\n";
    out += "</ul>\n";
  }
  return out + "</main>\n<footer>" + escaped(in.attribution) + "</footer>\n</body>\n</html>\n";
}

}  // namespace blockrand::outputs
