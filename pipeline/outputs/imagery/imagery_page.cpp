#include "pipeline/outputs/imagery/imagery_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/base/assets.h"
#include "pipeline/base/markup.h"
#include "pipeline/base/template.h"
#include "pipeline/base/text.h"
#include "pipeline/outputs/assets.h"
#include "pipeline/outputs/imagery/seen_outline.h"
#include "pipeline/outputs/report/html_text.h"

namespace blockrand::outputs {
namespace {

using base::Values;
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

Values counted(std::string_view what, std::string_view why, std::uint64_t count) {
  Values row;
  row.set("what", what).set("why", why).set("count", base::with_thousands(count));
  return row;
}

void add_images(Values& page, const OverlayInputs& in) {
  page.set("images", Values::List());
  for (const observation::ImageReceipt& image : in.seen.images) {
    const importers::imagery::ImageSource& source = image.description.source;
    Values row;
    row.set("file", source.path.substr(source.path.find_last_of('/') + 1)).set("date", source.date);
    row.set("licence", source.attribution + (source.licence.empty() ? "" : ", " + source.licence));
    row.set("fit", fmt::format("{}: {}", observation::name(image.fit.state), image.fit.why));
    page.add("images", std::move(row));
  }
}

void add_buildings(Values& page, const OverlayInputs& in) {
  std::map<std::pair<RowState, std::string>, std::uint64_t> counts;
  for (const OutlineReceipt& r : in.seen.outlines) ++counts[{r.state, r.reason}];
  page.set("buildings", Values::List());
  for (const auto& [key, count] : counts) {
    const auto& [state, reason] = key;
    const std::string_view what = state == RowState::corrected && in.seen.applied ? "moved" : observation::words(state);
    page.add("buildings", counted(what, reason, count));
  }
}

/// What became of single walls of houses; nothing where nobody looked for them.
void add_walls(Values& page, const OverlayInputs& in) {
  std::map<std::pair<observation::RefinementState, std::string>, std::uint64_t> counts;
  for (const OutlineReceipt& r : in.seen.outlines)
    if (r.refined.state != observation::RefinementState::none) ++counts[{r.refined.state, r.refined.reason}];
  if (counts.empty()) return;
  Values walls;
  for (const auto& [key, count] : counts) {
    const auto& [state, reason] = key;
    std::string_view what = "as mapped";
    if (state == observation::RefinementState::refused) what = "refused";
    if (state == observation::RefinementState::refined)
      what = in.seen.applied ? "walls shifted" : "walls seen elsewhere";
    walls.add("rows", counted(what, reason, count));
  }
  page.add("walls", std::move(walls));
}

/// A house with its surroundings; the largest halls are cut. \param name  of what the picture shows
Values chip(const OverlayInputs& in, geometry::PlanBox box, std::uint32_t image, const std::string& name) {
  const model::Point2 middle = box.centre();
  const double x = std::min(kLargestChip / 2, (box.maximum.x - box.minimum.x) / 2 + kAround),
               y = std::min(kLargestChip / 2, (box.maximum.y - box.minimum.y) / 2 + kAround);
  box = {{middle.x - x, middle.y - y}, {middle.x + x, middle.y + y}};
  std::vector<std::uint32_t> near;
  for (std::uint32_t b = 0; b < in.seen.outlines.size(); ++b)
    if (in.footprints[b].box.near(box, 0)) near.push_back(b);
  const picture::Image picture = draw_overlay(in, box, kChipPixel, near, image);
  std::string png;
  base::append_base64(png, picture::palette_png(picture, 128));
  Values values;
  values.set("width", std::to_string(picture.width)).set("height", std::to_string(picture.height));
  values.set("name", name).set("png", std::move(png)).set("id", false);
  return values;
}

Values figure(const OverlayInputs& in, std::uint32_t building) {
  const OutlineReceipt& r = in.seen.outlines[building];
  const SeenOutline seen{r, in.seen.images[r.image], in.seen.applied, in.footprints[building].box,
                         in.seen.roofs[building].courtyards};
  const footprints::StoredFootprint& footprint = in.footprints[building];
  Values values = chip(in, footprint.box, r.image, footprint.id.text());
  values.set("id", footprint.id.text()).set("link", osm_link(footprint.id)).set("caption", imagery_text(seen));
  return values;
}

Values chapter(std::string title, std::string text) {
  Values values;
  values.set("title", std::move(title)).set("text", std::move(text));
  values.set("figures", Values::List()).set("none", false).set("key", false);
  return values;
}

/// What is mapped where the image shows no building, the likeliest first.
Values gone_chapter(const OverlayInputs& in) {
  std::vector<std::uint32_t> gone;
  for (std::uint32_t b = 0; b < in.seen.outlines.size(); ++b)
    if (in.seen.outlines[b].gone > 0) gone.push_back(b);
  std::ranges::stable_sort(
      gone, [&](std::uint32_t a, std::uint32_t b) { return in.seen.outlines[a].gone > in.seen.outlines[b].gone; });
  Values values =
      chapter("Perhaps gone: " + base::with_thousands(gone.size()), "Mapped, and built; the image shows no house.");
  gone.resize(std::min(gone.size(), kPicturedCorrections));
  for (const std::uint32_t b : gone) values.add("figures", figure(in, b));
  return values;
}

/// Courtyards that are mapped open and look built over, the likeliest first; nothing where none was looked at.
void add_courtyards(Values& page, const OverlayInputs& in) {
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
  if (looked == 0) return;
  std::ranges::sort(built_over);
  Values values = chapter("Courtyards perhaps built over: " + base::with_thousands(built_over.size()),
                          fmt::format("Mapped as open, and built so; the image shows a roof. "
                                      "Of {} courtyards {} are surely open.",
                                      base::with_thousands(looked), base::with_thousands(open)));
  built_over.resize(std::min(built_over.size(), kPicturedCandidates));
  for (const auto& [sure, b] : built_over) values.add("figures", figure(in, b));
  page.add("chapters", std::move(values));
}

/// What looks like a building where none is mapped, the likeliest first.
Values unmapped_chapter(const OverlayInputs& in) {
  const std::vector<observation::UnmappedBuilding>& all = in.seen.unmapped;
  Values values = chapter("Perhaps not mapped: " + base::with_thousands(all.size()),
                          "What looks like a building where the map has none: candidates to look at; nothing was "
                          "built there.");
  for (const observation::UnmappedBuilding& u : std::span(all).first(std::min(all.size(), kPicturedCandidates))) {
    const importers::imagery::ImageSource& source = in.seen.images[u.image].description.source;
    Values shown = chip(in, geometry::box_of(u.outline), u.image, u.id);
    shown.set("caption",
              fmt::format("{}: {:.0f} m\u00b2, probability {:.2f}, {}{}{}", u.id, u.area, std::min(0.99, u.probability),
                          source.path.substr(source.path.find_last_of('/') + 1),
                          source.date.empty() ? "" : " of " + source.date,
                          u.of_roof ? "; the outline is the roof's, how far it leans is not known" : ""));
    values.add("figures", std::move(shown));
  }
  return values;
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
  Values page;
  page.set("page_css", base::asset("page.css")).set("attribution", in.attribution).set("applied", in.seen.applied);
  add_images(page, in);
  add_buildings(page, in);
  add_walls(page, in);
  Values corrections = chapter(fmt::format("The largest of {} {}", base::with_thousands(all),
                                           in.seen.applied ? "moved or reshaped" : "seen elsewhere or reshaped"),
                               "Outlines are drawn where the image shows the roofs.");
  Values key;
  const std::pair<model::Colour, std::string_view> meanings[] = {
      {kBefore, "as mapped"},
      {kAfterUnsure, "where the image shows it, just sure enough"},
      {kAfterSure, "the same, quite sure"},
      {kRefused, "the same, but it stays as mapped"},
      {kAsMapped, "stays as mapped"},
      {kUnmapped, "perhaps a building that is not mapped"}};
  for (const auto& [colour, what] : meanings)
    key.add("entries", Values().set("colour", model::text(colour)).set("what", what));
  corrections.add("key", std::move(key)).set("none", largest.empty());
  for (const std::uint32_t b : largest) corrections.add("figures", figure(in, b));
  page.add("chapters", std::move(corrections));
  page.add("chapters", gone_chapter(in));
  add_courtyards(page, in);
  page.add("chapters", unmapped_chapter(in));
  Values tiles;
  bool any = false;
  for (const std::string& path : overlays)
    if (path.ends_with(".png")) tiles.add("paths", Values().set("path", path)), any = true;
  if (any) page.add("tiles", std::move(tiles));
  return base::filled(asset, "imagery/imagery.html", std::move(page));
}

}  // namespace blockrand::outputs
