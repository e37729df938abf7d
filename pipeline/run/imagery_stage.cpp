#include "pipeline/run/imagery_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "pipeline/base/error.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/text.h"
#include "pipeline/footprints/move_buildings.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/observation/corrections.h"
#include "pipeline/observation/image_quality.h"
#include "pipeline/observation/observe_extract.h"

namespace blockrand::run {

namespace {

using model::Feature;
using observation::Correction;
using observation::RowState;

/// \throws base::InputError  there are images, and none of them shows any of the extract
void check_images(const BuildInputs& inputs, const LocatedExtract& located, base::Progress& progress) {
  if (inputs.images.empty() || !located.area) return;
  const georef::GeoBox& box = located.area->box;
  std::vector<std::string> beside;
  for (const importers::imagery::AerialImage& image : inputs.images) {
    const georef::GeoBox& area = image.describe().area;
    if (area.west > box.east || area.east < box.west || area.south > box.north || area.north < box.south)
      beside.push_back(image.describe().source.path);
  }
  if (beside.size() == inputs.images.size()) {
    const georef::GeoBox& area = inputs.images.front().describe().area;
    throw base::InputError(
        beside.front(), "",
        fmt::format("shows nothing of the extract{}: it lies at {:.4f} to {:.4f} east and {:.4f} to {:.4f} north, the "
                    "buildings at {:.4f} to {:.4f} and {:.4f} to {:.4f}",
                    beside.size() > 1 ? ", nor does any other image" : "", area.west, area.east, area.south, area.north,
                    box.west, box.east, box.south, box.north),
        "Name images of this place, or check their georeference with gdalinfo");
  }
  for (const std::string& path : beside) progress.warn(path + ": shows nothing of the extract");
}

/// Years: an image that is older than the map by more shows another town.
constexpr int kOldImage = 5;

/// Between two dates that begin with a year; 0 where one does not.
int years_between(const std::string& earlier, const std::string& later) {
  int from = 0, to = 0;
  if (std::sscanf(earlier.c_str(), "%4d", &from) != 1 || std::sscanf(later.c_str(), "%4d", &to) != 1) return 0;
  return to - from;
}

/// The outer rings of the areas that overrides keep, as mapped.
std::vector<std::vector<model::Point2>> kept_areas(const attributes::Overrides& overrides,
                                                   const LocatedExtract& located) {
  std::vector<std::vector<model::Point2>> areas;
  for (const attributes::OverrideEntry& entry : overrides.entries) {
    if (!entry.keeps_place) continue;
    for (const Feature& feature : located.extract.features) {
      if (feature.id != entry.object || !feature.area) continue;
      for (const model::MappedRing& ring : located.extract.rings_of(feature.rings)) {
        if (ring.inner) continue;
        areas.emplace_back();
        for (const model::Location at : located.extract.vertices_of(ring))
          areas.back().push_back(located.projection.forward(at));
      }
    }
  }
  return areas;
}

}  // namespace

ImageryStage::ImageryStage(const BuildOptions& options, const BuildInputs& inputs, LocatedExtract& located,
                           base::Progress& progress)
    : options_(options), inputs_(inputs), located_(located), progress_(progress) {
  if (!inputs.tile) check_images(inputs, located, progress);  // they need not show every tile
  const bool looks = !inputs.images.empty();
  const bool keeps = std::ranges::any_of(inputs.overrides.entries, &attributes::OverrideEntry::keeps_place);
  if (looks && keeps) kept_areas_ = kept_areas(inputs.overrides, located);
  if (!looks && keeps && !inputs.tile)
    progress.warn(options.overrides + ": imagery = \"off\" has nothing to act on, there is no --imagery");
}

bool ImageryStage::keeps_place(std::uint32_t building, const footprints::FootprintStore& footprints) const {
  const footprints::StoredFootprint& stored = footprints[building];
  const attributes::OverrideEntry* entry = inputs_.overrides.find(stored.id);
  if (entry && entry->keeps_place) return true;
  return std::ranges::any_of(kept_areas_,
                             [&](const auto& ring) { return geometry::contains(ring, stored.box.centre()); });
}

void ImageryStage::take_pinned(const footprints::FootprintStore& footprints) {
  const outputs::ReadImagery& pinned = *inputs_.tile->imagery;
  seen_.emplace();
  seen_->images = pinned.images;
  seen_->applied = pinned.applied;
  seen_->outlines.resize(footprints.size());
  seen_->roofs.resize(footprints.size());
  seen_->heights.resize(footprints.size());
  const footprints::BuildingNumbers numbers(footprints);
  for (const auto& [id, receipt, roof, height] : pinned.buildings)
    if (const std::uint32_t b = numbers.find(id); b != model::kNoIndex)
      seen_->outlines[b] = receipt, seen_->roofs[b] = roof, seen_->heights[b] = height;
  // A candidate belongs to the tile of its middle.
  const model::TileId tile = inputs_.tile->id;
  for (const observation::UnmappedBuilding& u : pinned.unmapped) {
    const georef::LonLat middle = located_.projection.inverse(geometry::box_of(u.outline).centre());
    const auto units = [](double degrees) { return static_cast<std::int32_t>(std::lround(degrees * 1e7)); };
    if (georef::tile_of({units(middle.lon), units(middle.lat)}, tile.level) == tile) seen_->unmapped.push_back(u);
  }
}

bool ImageryStage::correct(std::span<const footprints::Shard> shards, const footprints::RepairedExtract& repaired) {
  const footprints::FootprintStore& store = repaired.footprints;
  if (inputs_.tile) {
    if (!inputs_.tile->imagery) return false;
    take_pinned(store);
  } else {
    if (inputs_.images.empty()) return false;
    const Correction how = options_.imagery.correct;
    seen_ = observation::observe_extract({located_.extract, store, located_.projection}, inputs_.images, how,
                                         options_.imagery.refine, base::worker_count(options_.jobs), progress_);
    observation::refuse_corrections(*seen_, store, [&](std::uint32_t b) { return keeps_place(b, store); });
    seen_->applied = how == Correction::apply;
  }
  if (!seen_->applied) return false;
  const std::vector<footprints::MovedBuilding> moved = observation::movements(*seen_, store);
  for (const footprints::MovedBuilding& m : moved) seen_->before.emplace_back(m.building, store.polygons(m.building));
  footprints::move_buildings(located_.extract, shards, moved, located_.projection);
  return !moved.empty();
}

void ImageryStage::tell(BuildRecord& record) const {
  if (!seen_) return;
  record.images = seen_->images;
  if (inputs_.tile) return;  // the build of the whole told it
  for (const observation::ImageReceipt& image : seen_->images) {
    const std::string& path = image.description.source.path;
    if (image.fit.state == observation::ImageState::misfit) {
      ++record.summary.images_misfit;
      progress_.warn(fmt::format("IMAGE_MISFIT: {} does not fit the map and is not used: {}", path, image.fit.why));
    } else if (image.fit.state == observation::ImageState::undecided) {
      progress_.warn(fmt::format("IMAGE_UNDECIDED: whether {} fits the map is not known: {}", path, image.fit.why));
    }
  }
  for (const observation::ImageReceipt& image : seen_->images) {
    const std::string& path = image.description.source.path;
    if (image.haze >= observation::kHazy)
      progress_.warn(
          fmt::format("{}: hazy, its darkest places have {:.0f} % of white: edges are faint, roof colours pale", path,
                      100 * image.haze));
    if (image.clouded >= observation::kClouded)
      progress_.warn(
          fmt::format("{}: partly clouded, {:.0f} % of the houses in it lie under white", path, 100 * image.clouded));
    if (image.shift != model::Point2{})
      progress_.warn(
          fmt::format("{}: shows the whole map {:.1f} m east, {:.1f} m north of where it is; taken for an error "
                      "of the image, and undone",
                      path, image.shift.x, image.shift.y));
    if (image.alike != model::Point2{})
      progress_.warn(
          fmt::format("{}: shows most rows {:.1f} m east, {:.1f} m north of where they are mapped: image or map "
                      "is shifted, so nothing is moved by it",
                      path, image.alike.x, image.alike.y));
    if (image.edited_later > 0)
      progress_.warn(fmt::format("{}: {} in it were edited after it was taken ({}): the map may be right there", path,
                                 base::with_thousands(image.edited_later), image.description.source.date));
    const std::string& data = located_.extract.data_time;
    const int years = years_between(image.description.source.date, data);
    if (years > kOldImage)
      progress_.warn(fmt::format("{}: {} years older than the map's data ({})", path, years, data.substr(0, 10)));
  }
  std::map<RowState, std::uint64_t> states;
  for (const observation::OutlineReceipt& receipt : seen_->outlines) ++states[receipt.state];
  std::string figures;
  for (const auto& [state, count] : states)
    figures += fmt::format("{}{} {}", figures.empty() ? "" : ", ", base::with_thousands(count),
                           state == RowState::corrected && seen_->applied ? "moved" : observation::words(state));
  const auto reshaped = std::ranges::count_if(seen_->outlines, [](const auto& receipt) {
    return receipt.refined.state == observation::RefinementState::refined;
  });
  if (reshaped > 0)
    figures += fmt::format("; walls of {} {}", base::with_thousands(static_cast<std::uint64_t>(reshaped)),
                           seen_->applied ? "shifted" : "seen elsewhere");
  const auto gone = std::ranges::count_if(seen_->outlines, [](const auto& receipt) { return receipt.gone > 0; });
  if (gone > 0) figures += fmt::format("; {} perhaps gone", base::with_thousands(static_cast<std::uint64_t>(gone)));
  if (!seen_->unmapped.empty())
    figures += fmt::format("; {} candidate{} for unmapped buildings", base::with_thousands(seen_->unmapped.size()),
                           seen_->unmapped.size() == 1 ? "" : "s");
  record.summary.figures["imagery.json"] = figures;
}

}  // namespace blockrand::run
