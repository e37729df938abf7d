#include "styles/roofs/dormers.h"

#include <algorithm>

namespace blockrand::roofs {

using model::Point2;
using model::Point3;

namespace {

std::optional<DormerBody> shape_on(const RoofSlope& plane, const DormerParameters& p) {
  if (!takes_elements(plane) || p.width > kWidestElement || p.wall_height < kLeastPart) return std::nullopt;
  return dormer_body({p.kind, p.width, p.wall_height, p.rise, p.roof_pitch, p.chords}, plane.rise);
}

void build_dormer(Roof& roof, const RoofSlope& plane, const DormerBody& shape, Point2 place) {
  // Each point is rounded by itself, from the same numbers wherever it occurs.
  const Point3 foot = plane.in_space(place);
  const auto built = [&](const Point3& p) {
    return model::snap(Point3{foot.x + p.x * plane.along_axis.x + p.y * plane.up_axis.x,
                              foot.y + p.x * plane.along_axis.y + p.y * plane.up_axis.y, foot.z + p.z});
  };
  const auto built_loop = [&](const std::vector<Point3>& loop) {
    std::vector<Point3> out;
    for (const Point3& p : loop) out.push_back(built(p));
    return out;
  };
  const auto element = static_cast<std::int32_t>(roof.elements.size());
  roof.elements.push_back(model::RoofElementKind::dormer);
  roof.surfaces[plane.surface].loops.push_back(built_loop(shape.outline));
  std::vector<Point3> front{shape.outline.front(), shape.outline.back()};
  for (const Point3& p : shape.head)
    if (p != front.back() && p != front.front()) front.push_back(p);
  roof.surfaces.push_back({-1, {built_loop(front)}, true, element});
  for (const DormerBody::Face& face : shape.faces)
    roof.surfaces.push_back({-1, {built_loop(face.loop)}, face.upright, element});
}

}  // namespace

DormerParameters usual_dormer(DormerKind kind) {
  DormerParameters out;
  out.kind = kind;
  if (kind == DormerKind::shed) out.roof_pitch = 12;
  if (kind == DormerKind::eyebrow) {
    out.width = 2.40;  // four times as wide as high, so that tiles can follow
    out.wall_height = 0.60;
    out.roof_pitch = 12;
  }
  return out;
}

std::vector<Point2> dormer_outline(const RoofSlope& plane, const DormerParameters& parameters) {
  const auto shape = shape_on(plane, parameters);
  if (!shape) return {};
  return hull(outline_in_plane(*shape, plane));
}

bool add_laid_out_dormer(Roof& roof, const RoofSlope& plane, const DormerParameters& parameters, Point2 place) {
  const auto shape = shape_on(plane, parameters);
  if (!shape) return false;
  build_dormer(roof, plane, *shape, place);
  return true;
}

}  // namespace blockrand::roofs
