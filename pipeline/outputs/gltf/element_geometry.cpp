#include "pipeline/outputs/gltf/element_geometry.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "pipeline/base/random.h"
#include "pipeline/outputs/gltf/point_numbers.h"
#include "pipeline/outputs/placed_element.h"

namespace blockrand::outputs {
namespace {

using model::Point3;

/// Twice the area of a face, along its normal.
Point3 area_vector(std::span<const Point3> corners) {
  Point3 n;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point3 &p = corners[i], &q = corners[i + 1 == corners.size() ? 0 : i + 1];
    n.x += (p.y - q.y) * (p.z + q.z);
    n.y += (p.z - q.z) * (p.x + q.x);
    n.z += (p.x - q.x) * (p.y + q.y);
  }
  return n;
}

/// Calls `visit(part, corners, screen)` for each face of an element.
template <class Visit>
void for_each_face(const model::Element& element, bool with_reveal, Panes panes, Visit&& visit) {
  const model::ElementMesh& mesh = element.mesh;
  std::vector<Point3> corners;
  const PaneCut cut(panes, element);
  for (const model::ElementFace& face : mesh.faces) {
    corners.clear();
    for (std::uint32_t i = 0; i < face.count; ++i) corners.push_back(mesh.vertices[mesh.indices[face.first + i]]);
    if (panes != Panes::as_modelled && face.part == model::ElementPart::glass) {
      for (const PanePiece& piece : cut.cut(corners)) visit(face.part, piece.corners, piece.screen);
    } else {
      visit(face.part, std::as_const(corners), false);
    }
  }
  const auto& outline = element.opening.outline;
  if (!with_reveal || !(element.opening.reveal > 0)) return;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const model::Point2 a = outline[i], b = outline[(i + 1) % outline.size()];
    const double depth = -element.opening.reveal;
    corners = {{a.x, a.y, 0}, {b.x, b.y, 0}, {b.x, b.y, depth}, {a.x, a.y, depth}};
    visit(model::ElementPart::wall, std::as_const(corners), false);
  }
}

/// Collects faces of one part; corners with equal place and normal become one.
class PartBuilder {
 public:
  /// \param most_corners  that the faces have together
  explicit PartBuilder(std::size_t most_corners) : most_corners_(most_corners) {}

  void add_face(std::span<const Point3> corners) {
    const Point3 n = area_vector(corners);
    const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    if (!(length > 0)) return;
    const auto quantise = [&](double v) { return static_cast<std::int8_t>(std::nearbyint(v / length * 127)); };
    const std::array<std::int8_t, 3> normal{quantise(n.x), quantise(n.y), quantise(n.z)};
    if (pieces.empty() || pieces.back().vertices.size() + corners.size() > ElementGeometry::kMostVertices) {
      pieces.emplace_back();
      known_.start(std::min(most_corners_, ElementGeometry::kMostVertices));
    }
    at_.clear();
    const Point3 exact{n.x / length, n.y / length, n.z / length};
    for (const Point3& p : corners) at_.push_back(vertex(p, normal, exact));
    auto& indices = pieces.back().indices;
    for (std::size_t i = 2; i < at_.size(); ++i) indices.insert(indices.end(), {at_[0], at_[i - 1], at_[i]});
  }
  std::vector<ElementGeometry::PartTriangles> pieces;  ///< several where one would be too large

 private:
  std::uint32_t vertex(const Point3& p, std::array<std::int8_t, 3> normal, const Point3& exact) {
    auto& vertices = pieces.back().vertices;
    const auto next = static_cast<std::uint32_t>(vertices.size());
    const std::uint32_t word = static_cast<std::uint32_t>(static_cast<std::uint8_t>(normal[0])) << 16 |
                               static_cast<std::uint32_t>(static_cast<std::uint8_t>(normal[1])) << 8 |
                               static_cast<std::uint8_t>(normal[2]);
    const std::uint32_t number = known_.first(base::mix64(hash_of(p) ^ word), next, [&](std::uint32_t other) {
      return vertices[other].position == p && vertices[other].normal == normal;
    });
    if (number == next) vertices.push_back({p, normal, exact});
    return number;
  }
  std::size_t most_corners_;
  PointNumbers known_;  ///< of the last piece's vertices
  std::vector<std::uint32_t> at_;
};

}  // namespace

ElementGeometry element_geometry(const model::Element& element, bool with_reveal, Panes panes) {
  const auto builder_of = [](model::ElementPart part, bool screen) {
    return 2 * static_cast<std::size_t>(part) + (screen ? 1 : 0);
  };
  std::array<std::size_t, std::size_t{2} * model::kElementPartCount> corner_count{};
  for_each_face(element, with_reveal, panes,
                [&](model::ElementPart part, std::span<const Point3> corners, bool screen) {
                  corner_count[builder_of(part, screen)] += corners.size();
                });
  std::vector<PartBuilder> builders;
  for (const std::size_t n : corner_count) builders.emplace_back(n);
  for_each_face(element, with_reveal, panes,
                [&](model::ElementPart part, std::span<const Point3> corners, bool screen) {
                  builders[builder_of(part, screen)].add_face(corners);
                });
  ElementGeometry out;
  for (std::size_t i = 0; i < builders.size(); ++i)
    for (ElementGeometry::PartTriangles& piece : builders[i].pieces) {
      if (piece.indices.empty()) continue;
      piece.part = static_cast<model::ElementPart>(i / 2);
      piece.screen = i % 2 == 1;
      for (const ElementVertex& v : piece.vertices) {
        const Point3& p = v.position;
        const bool first = out.parts.empty() && &v == &piece.vertices.front();
        out.min = first ? p : Point3{std::min(out.min.x, p.x), std::min(out.min.y, p.y), std::min(out.min.z, p.z)};
        out.max = first ? p : Point3{std::max(out.max.x, p.x), std::max(out.max.y, p.y), std::max(out.max.z, p.z)};
      }
      out.parts.push_back(std::move(piece));
    }
  return out;
}

std::optional<std::pair<Point3, Point3>> element_box(const model::Element& element, bool with_reveal) {
  std::optional<std::pair<Point3, Point3>> box;
  for_each_face(element, with_reveal, Panes::as_modelled,
                [&](model::ElementPart, std::span<const Point3> corners, bool) {
                  const Point3 n = area_vector(corners);
                  if (!(std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) > 0)) return;
                  if (!box) box.emplace(corners[0], corners[0]);
                  auto& [min, max] = *box;
                  for (const Point3& p : corners) {
                    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
                    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
                  }
                });
  return box;
}

std::vector<InstanceGroup> element_instances(const model::Region& region, const Frame& frame, bool glazed) {
  // Those of one element follow each other.
  const std::size_t kinds = glazed ? kPanesCount : 1;
  std::vector<InstanceGroup> groups(region.elements.size() * kinds);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    groups[i].element = static_cast<std::uint32_t>(i / kinds);
    groups[i].panes = static_cast<Panes>(i % kinds);
  }
  // Two points each: where the element stands, and a metre to its right, so that directions are those of the frame.
  std::vector<Point3> source;
  std::vector<std::pair<std::size_t, std::uint32_t>> group_and_feature;
  std::uint32_t feature = 0;
  const std::vector<bool> shown = with_shape(region);
  for (const model::Building& building : region.buildings) {
    if (!building.owned) continue;
    for (const model::BuildingPart& part : building.parts) {
      if (part.lod >= 3)
        for (const model::Placement& p : part.lod3.placements) {
          if (!shown.at(p.element)) continue;
          source.push_back(p.origin);
          source.push_back({p.origin.x + p.along.x, p.origin.y + p.along.y, p.origin.z});
          const Panes panes = glazed ? panes_of(part, p, region.elements[p.element]) : Panes::as_modelled;
          group_and_feature.emplace_back(p.element * kinds + static_cast<std::size_t>(panes), feature);
        }
      ++feature;
    }
  }
  std::vector<Point3> local(source.size());
  if (frame.to_enu && !source.empty())
    frame.to_enu(source, local);
  else
    local = source;
  for (std::size_t i = 0; i < group_and_feature.size(); ++i) {
    const Point3 &origin = local[2 * i], &right = local[2 * i + 1];
    const double east = right.x - origin.x, north = right.y - origin.y, length = std::sqrt(east * east + north * north);
    const model::Point2 along = length > 0 ? model::Point2{east / length, north / length} : model::Point2{1, 0};
    groups[group_and_feature[i].first].instances.push_back({group_and_feature[i].second, origin, along});
  }
  std::erase_if(groups, [](const InstanceGroup& g) { return g.instances.empty(); });
  return groups;
}

std::vector<PartElement> elements_by_part(const std::vector<InstanceGroup>& groups) {
  std::vector<PartElement> out;
  for (const InstanceGroup& group : groups)
    for (const ElementInstance& at : group.instances) out.push_back({group.element, group.panes, &at});
  std::stable_sort(out.begin(), out.end(),
                   [](const PartElement& a, const PartElement& b) { return a.at->feature < b.at->feature; });
  return out;
}

}  // namespace blockrand::outputs
