#include "pipeline/facades/wall_masonry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/facades/wall_paint.h"
#include "styles/masonry/relief.h"

namespace blockrand::facades {
namespace {

using model::Point2;

/// Brightness of the three shades of a stone: bricks of one firing differ by about a tenth.
constexpr double kShades[] = {0.9, 1.0, 1.08};
constexpr std::string_view kShadeNames[] = {"stones, dark", "stones", "stones, light"};
/// m. Mortar lies on the lowest layer before a wall (wall_paint.cpp).
constexpr double kMortar = 0.006;
/// m that fronts are smaller all round.
constexpr double kBevelOfBricks = 0.002, kBevelOfStones = 0.006;

model::PartMaterial shaded(model::PartMaterial look, double brightness) {
  const auto channel = [&](std::uint8_t c) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(c * brightness), 0L, 255L));
  };
  look.colour = {channel(look.colour.r), channel(look.colour.g), channel(look.colour.b)};
  return look;
}

}  // namespace

WallMasonry wall_masonry(const MasonryRun& run, const WallFrame& wall, const masonry::Masonry& masonry,
                         std::size_t most_triangles, const MasonryLook& look,
                         std::span<const std::vector<Point2>> openings, std::span<const std::vector<Point2>> covered) {
  WallMasonry out;
  if (wall.loops.empty()) return out;
  masonry::WallToLay to_lay;
  to_lay.outline = wall.loops[0];
  to_lay.openings.assign(openings.begin(), openings.end());
  for (std::size_t i = 1; i < wall.loops.size(); ++i)
    to_lay.openings.emplace_back(wall.loops[i].rbegin(), wall.loops[i].rend());
  to_lay.covered.assign(covered.begin(), covered.end());
  to_lay.from = run.from, to_lay.to = run.to, to_lay.ground = run.ground, to_lay.seed = run.seed;
  to_lay.corner_left = run.turn_left > 0, to_lay.corner_right = run.turn_right > 0;
  const auto laid = masonry::lay(to_lay, masonry);
  if (!laid || laid->stones.empty()) return out;
  masonry::ReliefOptions options;
  options.mortar = kMortar;
  options.relief = masonry.relief;
  options.bevel = masonry::is_brick(masonry.bond) ? kBevelOfBricks : kBevelOfStones;
  options.irregular = !masonry::has_courses(masonry.bond);
  options.from = run.from, options.to = run.to;
  options.turn_left = run.turn_left, options.turn_right = run.turn_right;
  options.most_triangles = most_triangles;
  masonry::Relief relief = masonry::relief_of(*laid, options, !masonry::is_brick(masonry.bond));
  if (relief.detail != masonry::ReliefDetail::full)
    out.told.push_back(fmt::format("masonry: a wall of {} stones has more than {} triangles; {}", laid->stones.size(),
                                   most_triangles,
                                   relief.detail == masonry::ReliefDetail::fronts      ? "stones have no sides"
                                   : relief.detail == masonry::ReliefDetail::dressings ? "its field is left bare"
                                                                                       : "it is left bare"));
  if (laid->undressed > 0)
    out.told.push_back(
        fmt::format("masonry: {} openings of a wall have no room for a sill, lintel or arch", laid->undressed));
  if (relief.detail == masonry::ReliefDetail::none) return out;
  const auto add = [&](model::ElementMesh&& mesh, std::string_view name, const model::PartMaterial& body_look,
                       double origin) {
    if (mesh.faces.empty()) return;
    MasonryBody body;
    body.look = body_look;
    body.element.name = name;
    body.element.kind = kMasonry;
    body.element.mesh = std::move(mesh);
    for (model::Point3& v : body.element.mesh.vertices) v = model::snap(model::Point3{v.x - origin, v.y, v.z});
    out.bodies.push_back(std::move(body));
  };
  if (relief.detail != masonry::ReliefDetail::dressings) {
    PaintOrder order{run.wall, run.from, run.to, 0, wall.height, look.mortar, "mortar"};
    // The first layer of paint is the second on the wall.
    if (auto mortar = wall_paint(order, wall, openings, -1))
      add(std::move(mortar->element.mesh), "mortar", look.mortar, 0);
  }
  for (std::size_t shade = 0; shade < relief.field.size(); ++shade)
    add(std::move(relief.field[shade]), kShadeNames[shade], shaded(look.stones, kShades[shade]), run.from);
  add(std::move(relief.dressings), "dressings", look.dressings, run.from);
  return out;
}

}  // namespace blockrand::facades
