// Houses with windows and a door for tests of LoD3 outputs.
#pragma once

#include <memory>
#include <vector>

#include "pipeline/facades/openings.h"
#include "pipeline/geometry/triangulate.h"
#include "tests/unit/outputs/sample_region.h"

namespace blockrand::outputs::test {

/// A frame around a pane, in an opening with a pointed head; `width` and `height` in metres.
inline std::shared_ptr<const model::Element> small_window(double width, double height, bool door = false) {
  auto e = std::make_shared<model::Element>();
  e->name = door ? "test door" : "test window";
  e->kind = door ? "house_door" : "casement";
  e->semantic = door ? model::ElementClass::door : model::ElementClass::window;
  const double w = width / 2;
  e->opening.reveal = 0.15;
  e->opening.outline = {{-w, 0}, {w, 0}, {w, height * 0.9}, {0, height}, {-w, height * 0.9}};
  const auto face = [&](std::vector<model::Point3> corners, model::ElementPart part) {
    model::ElementFace f;
    f.first = static_cast<std::uint32_t>(e->mesh.indices.size());
    f.count = static_cast<std::uint32_t>(corners.size());
    f.part = part;
    for (const model::Point3& p : corners) {
      e->mesh.indices.push_back(static_cast<std::uint32_t>(e->mesh.vertices.size()));
      e->mesh.vertices.push_back(p);
    }
    e->mesh.faces.push_back(f);
  };
  const double z = -0.15;
  face({{-w, 0, z}, {w, 0, z}, {w, height * 0.9, z}, {0, height, z}, {-w, height * 0.9, z}},
       door ? model::ElementPart::leaf : model::ElementPart::glass);
  face({{-w, 0, -0.05}, {w, 0, -0.05}, {w, 0.05, -0.05}, {-w, 0.05, -0.05}}, model::ElementPart::frame);
  face({{-w - 0.1, -0.1, 0.03}, {w + 0.1, -0.1, 0.03}, {w + 0.1, 0, 0.03}, {-w - 0.1, 0, 0.03}},
       model::ElementPart::sill);
  return e;
}

/// Two gable houses and a courtyard house with rows of windows on every wall, a door each, and a lamp (an installation)
/// on the first wall. Elements come in two colours. The third building stays LoD2.
inline SampleRegion facade_region() {
  SampleRegion s;
  for (int i = 0; i < 2; ++i) {
    auto& b = s.add_building(100 + i, {{"building", "yes"}});
    s.add_gable(b, b.id(), 391000 + 30 * i, 5819000 + 7 * i, 14, 10, 35, 44, 48);
  }
  auto& court = s.add_building(200, {{"building", "yes"}});
  s.add_courtyard(court, court.id(), 391000, 5819050, 40, 16, 12);
  auto& plain = s.add_building(300, {{"building", "yes"}});
  s.add_box(plain, plain.id(), 391060, 5819060, 10, 10, 35, 9);

  model::Region& region = s.region();
  const auto window = small_window(1.1, 1.8), door = small_window(1.2, 2.2, true);
  auto lamp = std::make_shared<model::Element>(*window);
  lamp->name = "lamp";
  lamp->kind = "lamp";
  lamp->semantic = model::ElementClass::installation;
  lamp->opening = {};
  for (int colour = 0; colour < 2; ++colour)
    for (const auto& e : std::vector<std::shared_ptr<const model::Element>>{window, door, lamp}) {
      model::ColouredElement c;
      c.element = e;
      for (int p = 0; p < model::kElementPartCount; ++p)
        c.materials[static_cast<std::size_t>(p)] = {
            0, {static_cast<std::uint8_t>(40 + 100 * colour), static_cast<std::uint8_t>(30 * p), 90}};
      region.elements.push_back(c);
    }
  std::uint32_t colour = 0;
  for (model::Building& b : region.buildings) {
    if (b.osm.number == 300) continue;
    for (model::BuildingPart& part : b.parts) {
      std::vector<facades::WallFrame> walls;
      for (std::uint32_t f = 0; f < part.lod2.faces.size(); ++f)
        if (auto wall = facades::wall_frame(part.lod2, f)) walls.push_back(std::move(*wall));
      std::vector<facades::WallOpening> wanted;
      std::vector<std::pair<std::uint32_t, model::Point2>> places;
      for (std::uint32_t w = 0; w < walls.size(); ++w)
        for (double v = 0.3; v < 7; v += 3)
          for (double u = 1.5; u < walls[w].length - 1; u += 2.5) {
            const std::uint32_t element = (w == 0 && u == 1.5 && v == 0.3 ? 1 : 0) + 3 * (colour % 2);
            facades::WallOpening o;
            o.wall = w;
            o.kind = element % 3 == 1 ? model::OpeningKind::door : model::OpeningKind::window;
            o.reveal = 0.15;
            for (const model::Point2& p : region.elements[element].element->opening.outline)
              o.outline.push_back({p.x + u, p.y + v});
            wanted.push_back(o);
            places.emplace_back(element, model::Point2{u, v});
          }
      auto opened = facades::cut_openings(part.lod2, walls, wanted);
      part.lod3.solid = std::move(opened.solid);
      part.lod3.triangles = *geometry::triangulate(part.lod3.solid);
      part.lod3.openings = std::move(opened.openings);
      for (std::uint32_t i = 0; i < opened.given.size(); ++i) {
        const auto& [element, at] = places[opened.given[i]];
        const facades::WallFrame& wall = walls[wanted[opened.given[i]].wall];
        part.lod3.placements.push_back({element, model::snap(wall.at(at)), wall.along, i, wall.face, 0});
      }
      part.lod3.placements.push_back({2 + 3 * (colour % 2), model::snap(walls[0].at({4, 2.6})), walls[0].along,
                                      model::kNoOpening, walls[0].face, 0});
      part.lod = 3;
    }
    ++colour;
  }
  return s;
}

}  // namespace blockrand::outputs::test
