#include "pipeline/facades/bodies_on_roofs.h"

#include <algorithm>
#include <string>

#include "pipeline/attributes/roof_edges.h"
#include "pipeline/geometry/plan_shape.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/solid_overlap.h"

namespace blockrand::facades {

namespace {

/// Share of a body's plan under higher bodies from which on its roof is theirs to stand on (own choice).
constexpr double kCovered = 0.5;

/// Whether higher bodies of the building cover half of it: a podium under a tower.
bool covered(const model::Building& building, const model::BuildingPart& part, double area) {
  if (building.parts.size() < 2) return false;
  const double top = extent_of(part).high;
  std::vector<model::Polygon> higher;
  for (const model::BuildingPart& other : building.parts)
    if (&other != &part && !other.canopy && !other.lod2.empty() && extent_of(other).high > top)
      higher.push_back(other.plan);
  if (higher.empty()) return false;
  const double common = geometry::PlanShape({part.plan}).common_area(geometry::PlanShape(higher));
  return common >= kCovered * area;
}

}  // namespace

bool is_old(const model::Attributes& attributes) {
  const std::string &style = attributes.style.value, &era = attributes.era.value;
  return style == model::name(model::StyleClass::gruenderzeit) || style == model::name(model::StyleClass::tenement) ||
         era == model::name(model::Era::pre1840) || era == model::name(model::Era::from1840);
}

bool has_hearths(const model::Attributes& a, const attributes::Defaults& defaults) {
  const std::string& group = defaults.groups[defaults.use(a.use.value).group];
  return group == "residential" || ((group == "commercial" || group == "public" || group == "other") && is_old(a) &&
                                    a.style.value != model::name(model::StyleClass::other));
}

HeightExtent extent_of(const model::Solid& solid) {
  HeightExtent out{1e300, -1e300};
  for (const model::Point3& p : solid.vertices) out = {std::min(out.low, p.z), std::max(out.high, p.z)};
  return out;
}

HeightExtent extent_of(const model::BuildingPart& part) {
  if (!part.lod2.empty()) return extent_of(part.lod2);
  if (!part.lod1.empty()) return extent_of(part.lod1);
  const model::Attributes& a = part.attributes;
  return {a.ground_height.value + a.min_height.value, a.ground_height.value + a.height.value};
}

model::BuildingPart* main_body(model::Building& building) {
  model::BuildingPart* best = nullptr;
  double largest = 0;
  for (model::BuildingPart& part : building.parts) {
    if (part.lod2.empty() || part.canopy) continue;
    const double area = geometry::area(part.plan);
    if (area > largest && !covered(building, part, area)) best = &part, largest = area;
  }
  return best;
}

std::vector<model::RoofEdge> edges_of_plan(const model::Building& building, const model::BuildingPart& body,
                                           const model::Polygon& plan) {
  std::size_t count = plan.outer.size();
  for (const model::Ring& hole : plan.holes) count += hole.size();
  if (body.roof_edges.size() == count && plan.outer.points == body.roof_plan.outer.points) return body.roof_edges;
  auto edges = attributes::roof_edges(building, plan);
  edges.resize(count, model::RoofEdge::open);
  return edges;
}

bool meets_a_body(const model::Building& building, const model::RoofInstallation& made,
                  const model::BuildingPart* but_for) {
  const auto view = [](const model::Solid& solid, const model::SolidTriangles& triangles) {
    return geometry::ClosedMesh{solid.vertices, triangles.triangles};
  };
  const geometry::ClosedMesh mine = view(made.solid, made.triangles);
  for (const model::BuildingPart& part : building.parts) {
    if (&part == but_for) continue;
    const bool detailed = !part.lod3.solid.empty() && part.lod3.solid.closed;
    if (geometry::interiors_meet(
            mine, detailed ? view(part.lod3.solid, part.lod3.triangles) : view(part.lod2, part.lod2_triangles)))
      return true;
    for (const model::RoofInstallation& other : part.lod3.roof_installations)
      if (geometry::interiors_meet(mine, view(other.solid, other.triangles))) return true;
  }
  return false;
}

}  // namespace blockrand::facades
