#include "pipeline/masses/replace_buildings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::masses {
namespace {

using model::Building;
using model::BuildingPart;
using model::Point2;
using model::Point3;

/// m that a model may lie off the outline that it replaces: farther ones are told.
constexpr double kFarOff = 50;

const LandmarkModel* model_of(const LandmarkModels& models, model::OsmId building) {
  const auto found = std::lower_bound(models.begin(), models.end(), building,
                                      [](const LandmarkModel& m, model::OsmId id) { return m.building < id; });
  return found != models.end() && found->building == building ? &*found : nullptr;
}

/// Of the largest polygon of the outline.
const model::Polygon* largest(const Building& building) {
  const auto most =
      std::max_element(building.outline.begin(), building.outline.end(),
                       [](const auto& a, const auto& b) { return geometry::area(a) < geometry::area(b); });
  return most == building.outline.end() ? nullptr : &*most;
}

Point2 middle_of(const model::Polygon& polygon) {
  Point2 low{1e300, 1e300}, high{-1e300, -1e300};
  for (const Point2& p : polygon.outer.points)
    low = {std::min(low.x, p.x), std::min(low.y, p.y)}, high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  return model::snap(Point2{(low.x + high.x) / 2, (low.y + high.y) / 2});
}

/// m between the middles of a model and of the outline.
double far_off(const LandmarkModel& landmark, const model::Polygon& outline) {
  if (landmark.at_outline || landmark.surfaces.vertices.empty()) return 0;
  Point2 low{1e300, 1e300}, high{-1e300, -1e300};
  for (const Point3& v : landmark.surfaces.vertices)
    low = {std::min(low.x, v.x), std::min(low.y, v.y)}, high = {std::max(high.x, v.x), std::max(high.y, v.y)};
  return model::distance(middle_of(outline), {(low.x + high.x) / 2, (low.y + high.y) / 2});
}

}  // namespace

void join_replaced(model::Region& region, const LandmarkModels& models) {
  for (Building& building : region.buildings) {
    const LandmarkModel* landmark = model_of(models, building.osm);
    const model::Polygon* outline = largest(building);
    if (!landmark || !outline || building.parts.empty()) continue;
    if (const double off = far_off(*landmark, *outline); !(off <= kFarthestModel)) {
      if (building.owned)
        region.report.add(
            building.osm, model::IssueCode::override_unmatched,
            fmt::format("{}: {} lies {:.0f} km off the outline and replaces nothing; is longitude first in `at`?",
                        landmark->told->order, landmark->told->file, off / 1000));
      continue;
    }
    building.replaced = landmark->told;
    for (const BuildingPart& part : building.parts)
      if (part.osm != building.osm && part.mapped_index != model::kNoIndex)
        region.settled_parts.push_back({part.mapped_index, model::ObjectState::represented, building.osm});
    BuildingPart whole;
    whole.id = building.id();
    whole.osm = building.osm;
    whole.mapped_index = building.mapped_index;
    whole.tags = building.tags;
    whole.mapped = building.mapped;
    whole.plan = whole.roof_plan = *outline;
    whole.attributes = building.attributes;
    building.parts.clear();
    building.parts.push_back(std::move(whole));
    building.has_mapped_parts = false;
  }
}

void replace_buildings(model::Region& region, const LandmarkModels& models) {
  for (Building& building : region.buildings) {
    const LandmarkModel* landmark = model_of(models, building.osm);
    const model::Polygon* outline = largest(building);
    if (!landmark || !building.replaced || !outline || building.parts.size() != 1) continue;
    BuildingPart& part = building.parts.front();
    const Point2 middle = middle_of(*outline);
    const Point2 by = landmark->at_outline ? middle : Point2{};
    const double ground = model::snap(part.attributes.ground_height.value);
    part.lod2 = landmark->surfaces;
    part.lod2_triangles = landmark->triangles;
    double top = 0;
    Point2 low{1e300, 1e300}, high{-1e300, -1e300};
    for (Point3& v : part.lod2.vertices) {
      v = model::snap(Point3{v.x + by.x, v.y + by.y, v.z + ground});
      top = std::max(top, v.z - ground);
      low = {std::min(low.x, v.x), std::min(low.y, v.y)}, high = {std::max(high.x, v.x), std::max(high.y, v.y)};
    }
    for (std::size_t f = 0; f < part.lod2.faces.size(); ++f) {
      model::Face& face = part.lod2.faces[f];
      if (landmark->coloured[f]) continue;
      const bool roof = face.kind == model::SurfaceKind::roof;
      face.colour = roof ? part.attributes.shown_roof_colour : part.attributes.shown_wall_colour;
    }
    part.lod = 2;
    part.fallbacks.clear();
    const auto is_told = [&](const model::ReportRow& row) {
      return row.object == building.osm && model::info(row.code).issue_class == model::IssueClass::fallback;
    };
    std::erase_if(region.report.rows, is_told);  // of the body that it replaces
    const model::ReplacementModel& told = *building.replaced;
    for (model::Attributes* a : {&building.attributes, &part.attributes}) {
      a->height.value = std::nearbyint(top * 100) / 100;
      a->height.source = model::Source::override_;
      a->height.confidence = 1;
      a->height.evidence = region.evidence.add({"height of the model " + told.file, {}});
      a->roof_height.value = std::min(a->roof_height.value, a->height.value);
      a->eaves_height.value = a->height.value - a->roof_height.value;
    }
    std::string what = fmt::format("{}: {}, {}, {}", told.order, told.file, told.source, told.licence);
    if (!told.author.empty()) what += ", " + told.author;
    const double off = model::distance(middle, {(low.x + high.x) / 2, (low.y + high.y) / 2});
    if (off > kFarOff) what += fmt::format("; it lies {:.0f} m off the outline", off);
    if (landmark->left_out > 0)
      what += fmt::format("; {} faces whose rings cross or touch are left out", landmark->left_out);
    if (building.outline.size() > 1)
      what += fmt::format("; the largest of {} pieces of the outline is its footprint", building.outline.size());
    region.report.add(building.osm, model::IssueCode::building_replaced, std::move(what));
    if (part.lod2.closed) continue;
    part.fallbacks.push_back(model::IssueCode::model_not_closed);
    region.report.add(building.osm, model::IssueCode::model_not_closed, told.file);
  }
}

}  // namespace blockrand::masses
