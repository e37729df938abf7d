#include "pipeline/cli/grammar_walls.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>

#include "pipeline/facades/element_library.h"
#include "styles/grammar/evaluation/colour_text.h"
#include "styles/grammar/shapes/scope.h"

namespace blockrand::cli {
namespace {

constexpr double kStoreyHeight = 3.2, kPlinth = 0.4;  ///< m

}  // namespace

TrialHouse::TrialHouse(double width, double depth, double storeys, model::WallSegmentKind front) {
  building_.osm = {model::OsmType::way, 1};
  const double height = kPlinth + storeys * kStoreyHeight;
  model::Attributes& a = building_.attributes;
  a.storeys.value = storeys;
  a.storey_height.value = kStoreyHeight;
  a.plinth_height.value = kPlinth;
  a.height.value = a.eaves_height.value = height;
  a.use.value = a.ground_floor_use.value = "apartments";
  a.era.value = "1840_1918";
  a.style.value = "gruenderzeit";
  a.wall_material.value = "plaster";
  a.shown_wall_colour = {0xdf, 0xce, 0xa1};
  a.shown_roof_colour = {0x8a, 0x52, 0x42};
  building_.situation.position = model::BuildingPosition::mid_row;
  building_.situation.width = width;
  building_.situation.depth = depth;
  building_.situation.fronts = {0};
  const model::Point2 corners[] = {{0, 0}, {width, 0}, {width, depth}, {0, depth}};
  const model::WallSegmentKind kinds[] = {front, model::WallSegmentKind::party_wall, model::WallSegmentKind::courtyard,
                                          model::WallSegmentKind::party_wall};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const double length = i % 2 == 0 ? width : depth;
    const model::Point2 p = corners[i], q = corners[(i + 1) % 4];
    model::WallSegment edge;
    edge.edge = i;
    edge.end = length;
    edge.kind = kinds[i];
    building_.edges.push_back(edge);
    facades::WallFrame wall;
    wall.face = i + 1;
    wall.start = p;
    wall.along = {(q.x - p.x) / length, (q.y - p.y) / length};
    wall.length = length;
    wall.height = height;
    wall.loops = {{{0, 0}, {length, 0}, {length, height}, {0, height}}};
    walls_.push_back(wall);
    facades::FacadeSegment segment;
    segment.wall = i;
    segment.to = length;
    segment.kind = kinds[i];
    segment.edges = {i};
    segment.starts_wall = segment.ends_wall = true;
    segment.turn_left = segment.turn_right = 90;
    segment.kind_left = kinds[(i + 3) % 4];
    segment.kind_right = kinds[(i + 1) % 4];
    segments_.push_back(std::move(segment));
  }
  model::BuildingPart part;
  part.id = building_.id();
  part.osm = building_.osm;
  part.attributes = a;
  building_.parts.push_back(std::move(part));
  for (std::size_t i = 0; i < walls_.size(); ++i)
    contexts_.push_back(std::make_unique<facades::FacadeContext>(
        facades::FacadeContext{building_, building_.parts[0], walls_[i], segments_[i], height, nullptr, nullptr}));
}

std::vector<TrialWall> TrialHouse::walls(bool both) const {
  std::vector<TrialWall> out;
  for (const std::size_t i : both ? std::vector<std::size_t>{0, 2} : std::vector<std::size_t>{0}) {
    const facades::WallFrame& wall = walls_[i];
    grammar::SmallFace face;
    face.size = 4;
    face.points = {{{0, 0, 0}, {wall.length, 0, 0}, {wall.length, wall.height, 0}, {0, wall.height, 0}}};
    TrialWall trial;
    trial.wall = i;
    trial.shape.size = {wall.length, wall.height, 0};
    trial.shape.mesh = face;
    auto origin = std::make_shared<grammar::Origin>();
    const model::Point2 out_of = wall.outward();
    origin->world = {{wall.start.x, 0, -wall.start.y},
                     {grammar::Vector3{wall.along.x, 0, -wall.along.y}, grammar::Vector3{0, 1, 0},
                      grammar::Vector3{out_of.x, 0, -out_of.y}}};
    trial.shape.origin = std::move(origin);
    out.push_back(std::move(trial));
  }
  return out;
}

grammar::AttributeSource TrialHouse::values(std::size_t wall) const {
  return [context = contexts_[wall].get()](std::string_view name) { return facades::context_value(*context, name); };
}

std::vector<outputs::ColouredTriangles> element_triangles(const grammar::Derivation& derivation,
                                                          const TrialHouse& house,
                                                          const elements::ElementCatalogue& elements,
                                                          std::vector<std::string>& complaints) {
  model::Region region;
  facades::ElementLibrary library(region, attributes::Defaults{}, elements);
  const facades::PartMaterials usual = library.usual_materials(house.part());
  std::map<std::string, outputs::ColouredTriangles> groups;
  for (const grammar::Leaf& leaf : derivation.leaves) {
    if (!leaf.order || leaf.order->arguments.empty() || !std::holds_alternative<std::string>(leaf.order->arguments[0]))
      continue;
    const std::string& name = std::get<std::string>(leaf.order->arguments[0]);
    const auto* const kind = elements.find(name);
    if (!kind) continue;  // paint; unknown kinds are told by the check
    const auto [width, height] = facades::ElementLibrary::size(kind, leaf.shape.size.x, leaf.shape.size.y);
    library.ask(name, width, height, usual);
    library.add_request(*leaf.order, true, true, complaints);
    std::string error;
    const std::uint32_t number = library.take(error);
    if (!error.empty()) complaints.push_back(std::move(error));
    if (number == facades::ElementLibrary::kNone) continue;
    const grammar::Frame frame = grammar::scope_in_world(leaf.shape);
    const model::ElementMesh& mesh = library.element(number).mesh;
    for (const model::ElementFace& face : mesh.faces) {
      const model::Colour c = library.materials(number)[static_cast<std::size_t>(face.part)].colour;
      const std::array<double, 4> colour{c.r / 255.0, c.g / 255.0, c.b / 255.0, 1};
      const std::string text = grammar::colour_text(colour, true);
      outputs::ColouredTriangles& group = groups[text];
      group.name = text;
      group.colour = colour;
      group.roughness = 0.9;
      for (std::uint32_t i = 1; i + 1 < face.count; ++i)
        for (const std::uint32_t corner : {0u, i, i + 1}) {
          const model::Point3& v = mesh.vertices[mesh.indices[face.first + corner]];
          const grammar::Vector3 p = grammar::place(frame, {v.x + leaf.shape.size.x / 2, v.y, v.z});
          group.corners.push_back({p.x, p.y, p.z});
        }
    }
  }
  std::sort(complaints.begin(), complaints.end());
  complaints.erase(std::unique(complaints.begin(), complaints.end()), complaints.end());
  std::vector<outputs::ColouredTriangles> out;
  for (auto& [name, group] : groups) out.push_back(std::move(group));
  return out;
}

}  // namespace blockrand::cli
