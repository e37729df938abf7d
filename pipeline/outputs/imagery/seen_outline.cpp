#include "pipeline/outputs/imagery/seen_outline.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "pipeline/base/portable_math.h"

namespace blockrand::outputs {
namespace {

using observation::CourtyardState;
using observation::RowState;

std::string_view compass(model::Point2 shift) {
  constexpr std::string_view kWinds[] = {"E", "NE", "N", "NW", "W", "SW", "S", "SE"};
  const double eighth = base::atan2(shift.y, shift.x) * 4 / base::kPi;
  return kWinds[(static_cast<int>(std::lround(eighth)) + 8) % 8];
}

std::string file_name(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

}  // namespace

std::string_view SeenOutline::state() const {
  switch (receipt.state) {
    case RowState::corrected:
      return applied ? "moved" : "seen_elsewhere";
    case RowState::left_alone:
      if (walls_shifted()) return applied ? "reshaped" : "seen_reshaped";
      return "as_mapped";
    case RowState::refused:
      return "refused";
    case RowState::undecided:
    case RowState::outside:
      break;
  }
  return "undecided";
}

std::optional<observation::CourtyardView> SeenOutline::told_courtyard() const {
  std::optional<observation::CourtyardView> told;
  for (const observation::CourtyardView& c : courtyards) {
    if (c.state == CourtyardState::unknown) continue;
    if (!told || c.state > told->state || (c.state == told->state && c.built_over > told->built_over)) told = c;
  }
  return told;
}

SeenOutlines seen_outlines(const observation::ImageryObservations* observations,
                           const footprints::FootprintStore& footprints) {
  if (!observations) return {};
  const auto numbers = std::make_shared<const footprints::BuildingNumbers>(footprints);
  return [observations, numbers, footprints_of = &footprints](model::OsmId id) -> std::optional<SeenOutline> {
    const std::uint32_t b = numbers->find(id);
    if (b == model::kNoIndex || b >= observations->outlines.size()) return std::nullopt;
    const observation::OutlineReceipt& receipt = observations->outlines[b];
    if (receipt.image >= observations->images.size()) return std::nullopt;
    SeenOutline seen{receipt, observations->images[receipt.image], observations->applied, (*footprints_of)[b].box};
    if (b < observations->roofs.size()) seen.courtyards = observations->roofs[b].courtyards;
    return seen;
  };
}

namespace {

std::string_view walls_state(const SeenOutline& seen) {
  if (seen.walls_shifted()) return seen.applied ? "shifted" : "seen_elsewhere";
  return seen.receipt.refined.state == observation::RefinementState::refused ? "refused" : "as_mapped";
}

}  // namespace

std::vector<ImageryAttribute> imagery_attributes(const SeenOutline& seen) {
  const observation::OutlineReceipt& r = seen.receipt;
  std::vector<ImageryAttribute> out = {
      {"imagery_state", std::string(seen.state())}, {"imagery_shift_east", r.shift.x},
      {"imagery_shift_north", r.shift.y},           {"imagery_rotation", r.turn},
      {"imagery_evidence_mapped", r.before},        {"imagery_evidence", r.after},
      {"imagery_confidence", r.confidence},         {"imagery_image", file_name(seen.image.description.source.path)}};
  if (!r.reason.empty()) out.insert(out.begin() + 1, {"imagery_reason", r.reason});
  if (r.gone > 0) out.emplace_back("imagery_perhaps_gone", r.gone);
  if (const auto courtyard = seen.told_courtyard()) {
    out.emplace_back("imagery_courtyard", std::string(observation::name(courtyard->state)));
    out.emplace_back("imagery_courtyard_built_over", courtyard->built_over);
  }
  if (const observation::RefinedOutline& w = r.refined; w.walls > 0) {
    out.emplace_back("imagery_walls_state", std::string(walls_state(seen)));
    if (!w.reason.empty()) out.emplace_back("imagery_walls_reason", w.reason);
    out.emplace_back("imagery_walls_shifted", static_cast<double>(w.walls));
    out.emplace_back("imagery_largest_wall_shift", w.largest);
    out.emplace_back("imagery_walls_evidence_before", w.before);
    out.emplace_back("imagery_walls_evidence", w.after);
    out.emplace_back("imagery_walls_confidence", w.confidence);
  }
  if (!seen.image.description.source.date.empty()) out.emplace_back("imagery_date", seen.image.description.source.date);
  return out;
}

namespace {

std::string place_text(const SeenOutline& seen) {
  const observation::OutlineReceipt& r = seen.receipt;
  const importers::imagery::ImageSource& source = seen.image.description.source;
  const std::string image = file_name(source.path) + (source.date.empty() ? "" : " of " + source.date);
  const double size = std::sqrt(r.shift.x * r.shift.x + r.shift.y * r.shift.y);
  std::string place = fmt::format("{:.2f} m to the {}", size, compass(r.shift));
  if (std::fabs(r.turn) >= 0.05) place += fmt::format(", turned by {:.1f} degrees", r.turn);
  const std::string evidence = fmt::format("walls on edges: {:.2f} where mapped, {:.2f} there; confidence {:.2f}",
                                           r.before, r.after, r.confidence);
  switch (r.state) {
    case RowState::corrected:
      return seen.applied ? fmt::format("moved {}, as {} shows it ({})", place, image, evidence)
                          : fmt::format("{} shows it {} ({}); it stands where it is mapped", image, place, evidence);
    case RowState::refused:
      return fmt::format("{} shows it {} ({}); left where it is mapped: {}", image, place, evidence, r.reason);
    case RowState::left_alone:
      return fmt::format("left where it is mapped: {} ({}; {})", r.reason, image, evidence);
    case RowState::undecided:
    case RowState::outside:
      break;
  }
  return fmt::format("left where it is mapped: {} ({})", r.reason, image);
}

/// What became of single walls; empty where none is seen elsewhere.
std::string walls_text(const SeenOutline& seen) {
  const observation::RefinedOutline& w = seen.receipt.refined;
  if (w.walls == 0) return "";
  const std::string walls = w.walls == 1 ? "1 wall" : fmt::format("{} walls", w.walls);
  const std::string evidence = fmt::format("clearness of all edges {:.2f} before, {:.2f} after; confidence {:.2f}",
                                           w.before, w.after, w.confidence);
  if (!seen.walls_shifted())
    return fmt::format("; {} seen beside, up to {:.2f} m, left: {} ({})", walls, w.largest, w.reason, evidence);
  return fmt::format("; {} {} by up to {:.2f} m ({})", walls, seen.applied ? "shifted" : "seen beside,", w.largest,
                     evidence);
}

}  // namespace

std::string imagery_text(const SeenOutline& seen) {
  std::string place = place_text(seen) + walls_text(seen);
  if (const auto courtyard = seen.told_courtyard())
    place += courtyard->state == CourtyardState::open
                 ? fmt::format("; courtyard: open ({:.2f})", 1 - courtyard->built_over)
                 : fmt::format("; courtyard of {:.0f} m²: perhaps built over ({:.2f})", courtyard->area,
                               courtyard->built_over);
  if (seen.receipt.gone <= 0) return place;
  return fmt::format("perhaps gone ({:.2f}): no roof, wall or shadow is seen; {}", seen.receipt.gone, place);
}

}  // namespace blockrand::outputs
