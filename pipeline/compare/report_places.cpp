#include "pipeline/compare/report_places.h"

#include <algorithm>

#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::compare {

Point2 place_of(const City& city, const Building& building) {
  double weight = 0;
  Point2 sum;
  for (const model::Polygon& polygon : building.footprint) {
    if (polygon.outer.points.empty()) continue;
    const Point2 centre = geometry::centroid(polygon.outer.points);
    const double area = std::max(1e-6, geometry::area(polygon));
    sum = {sum.x + centre.x * area, sum.y + centre.y * area};
    weight += area;
  }
  if (weight > 0) return {city.origin.x + sum.x / weight, city.origin.y + sum.y / weight};
  bool first = true;
  Point2 low, high;
  for (const Face& face : building.faces)
    for (const auto& ring : face.rings)
      for (const Point3& p : ring) {
        low = first ? p.xy() : Point2{std::min(low.x, p.x), std::min(low.y, p.y)};
        high = first ? p.xy() : Point2{std::max(high.x, p.x), std::max(high.y, p.y)};
        first = false;
      }
  return {city.origin.x + (low.x + high.x) / 2, city.origin.y + (low.y + high.y) / 2};
}

std::string ids_of(const City& city, const std::vector<std::uint32_t>& buildings) {
  std::string out;
  for (const std::uint32_t b : buildings) (out += out.empty() ? "" : "; ") += city.buildings[b].id;
  return out;
}

std::string short_name(const City& city, std::size_t most) {
  if (city.name.size() <= most) return city.name;
  std::size_t end = city.name.rfind(", ", most);
  if (end == std::string::npos) end = city.name.find(", ");
  return end == std::string::npos ? city.name : city.name.substr(0, end) + " …";
}

}  // namespace blockrand::compare
