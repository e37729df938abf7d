#include "pipeline/outputs/placed_element.h"

#include <algorithm>
#include <cmath>

namespace blockrand::outputs {
namespace {

constexpr double kDecimals = 1e4;  // steps of a metre that CityJSON's templates are written in

bool is_finite(const model::Point3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

bool has_shape(const model::Element& element) {
  const model::ElementMesh& mesh = element.mesh;
  return std::any_of(mesh.faces.begin(), mesh.faces.end(), [&](const model::ElementFace& face) {
    const auto corner = [&](std::uint32_t i) {
      const model::Point3& p = mesh.vertices[mesh.indices[face.first + i]];
      return model::Point3{std::nearbyint(p.x * kDecimals), std::nearbyint(p.y * kDecimals),
                           std::nearbyint(p.z * kDecimals)};
    };
    for (std::uint32_t i = 2; i < face.count; ++i) {
      const model::Point3 a = corner(0), b = corner(i - 1), c = corner(i);
      const model::Point3 u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
      const model::Point3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
      if (is_finite(n) && (n.x != 0 || n.y != 0 || n.z != 0)) return true;
    }
    return false;
  });
}

std::vector<bool> with_shape(const model::Region& region) {
  std::vector<bool> out;
  out.reserve(region.elements.size());
  for (const model::ColouredElement& e : region.elements) out.push_back(has_shape(*e.element));
  return out;
}

PlacedBoxes::PlacedBoxes(const model::Region& region) {
  for (const model::ColouredElement& coloured : region.elements) {
    Box& box = boxes_.emplace_back();
    if (!has_shape(*coloured.element)) continue;
    for (const model::Point3& p : coloured.element->mesh.vertices) {
      if (!is_finite(p)) continue;
      if (!box.there) box.min = box.max = p;
      box.there = true;
      box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
      box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
    }
  }
}

const std::array<model::Point3, 8>* PlacedBoxes::corners(const model::Placement& placement) {
  const Box& box = boxes_.at(placement.element);
  if (!box.there) return nullptr;
  const model::Point2 along = placement.along, out{along.y, -along.x};
  const model::Point3& o = placement.origin;
  for (unsigned i = 0; i < corners_.size(); ++i) {
    const double x = i & 1u ? box.max.x : box.min.x, y = i & 2u ? box.max.y : box.min.y,
                 z = i & 4u ? box.max.z : box.min.z;
    corners_[i] = {o.x + along.x * x + out.x * z, o.y + along.y * x + out.y * z, o.z + y};
  }
  return &corners_;
}

}  // namespace blockrand::outputs
