#include "tests/unit/masonry/masonry_walls.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "pipeline/base/random.h"

namespace blockrand::masonry {

using model::Point2;

Outline rectangle(double left, double low, double right, double high) {
  return {{left, low}, {right, low}, {right, high}, {left, high}};
}

Outline arched(double left, double low, double right, double spring, double rise) {
  const double half = (right - left) / 2, radius = (half * half + rise * rise) / (2 * rise),
               middle = (left + right) / 2;
  const double centre = spring + rise - radius, from = std::atan2(spring - centre, half);
  Outline out{{left, low}, {right, low}};
  constexpr int kPieces = 16;
  for (int i = 0; i <= kPieces; ++i) {
    const double a = from + (std::numbers::pi - 2 * from) * i / kPieces;
    out.push_back({middle + radius * std::cos(a), centre + radius * std::sin(a)});
  }
  return out;
}

Outline pointed(double left, double low, double right, double spring) {
  Outline out{{left, low}, {right, low}};
  const double radius = right - left;
  constexpr int kPieces = 8;
  for (int i = 0; i <= kPieces; ++i) {
    const double a = std::numbers::pi / 3 * i / kPieces;
    out.push_back({left + radius * std::cos(a), spring + radius * std::sin(a)});
  }
  for (int i = kPieces - 1; i >= 0; --i) {
    const double a = std::numbers::pi / 3 * i / kPieces;
    out.push_back({right - radius * std::cos(a), spring + radius * std::sin(a)});
  }
  return out;
}

Outline round_window(Point2 middle, double radius) {
  Outline out;
  for (int i = 0; i < 24; ++i) {
    const double a = 2 * std::numbers::pi * i / 24;
    out.push_back({middle.x + radius * std::cos(a), middle.y + radius * std::sin(a)});
  }
  return out;
}

WallToLay plain_wall(double length, double height) {
  WallToLay wall;
  wall.outline = rectangle(0, 0, length, height);
  wall.to = length;
  wall.seed = 1;
  return wall;
}

WallToLay front_wall(std::uint64_t seed) {
  WallToLay wall;
  wall.outline = {{0, 0}, {9.3, 0}, {9.3, 6.2}, {4.65, 9.4}, {0, 6.2}};
  wall.from = 0, wall.to = 9.3;
  wall.corner_left = wall.corner_right = true;
  wall.seed = seed;
  wall.openings = {rectangle(1.1, 0.95, 2.2, 2.4),   arched(4.1, 0.05, 5.2, 2.1, 0.55), rectangle(6.8, 0.95, 8.2, 2.45),
                   arched(1.1, 3.9, 2.2, 5.3, 0.15), pointed(4.2, 3.9, 5.1, 4.9),       arched(6.9, 3.9, 8.1, 5.2, 0.3),
                   round_window({4.65, 7.3}, 0.4)};
  return wall;
}

WallToLay random_wall(std::uint64_t seed) {
  const auto draw = [&](std::uint64_t number) { return base::random_unit(seed, number, "wall"); };
  WallToLay wall = plain_wall(1.2 + 11 * draw(1), 1.5 + 7 * draw(2));
  const double high = wall.outline[2].y;
  if (draw(3) < 0.4)
    wall.outline.insert(wall.outline.begin() + 3, {wall.to * (0.3 + 0.4 * draw(4)), high + 2 * draw(5)});
  wall.corner_left = draw(6) < 0.6, wall.corner_right = draw(7) < 0.6;
  wall.seed = seed;
  wall.ground = draw(8) < 0.3 ? -draw(9) : 0;
  std::uint64_t number = 20;
  for (double low = 0.1 + draw(11); low + 1.4 < high; low += 2.6)
    for (double left = 0.35 + draw(++number); left + 1.2 < wall.to; left += 1.4 + 1.5 * draw(++number)) {
      const double wide = 0.5 + 0.6 * draw(++number), tall = 0.6 + 0.6 * draw(++number), form = draw(++number);
      const double right = std::min(left + wide, wall.to - 0.3), top = low + tall;
      if (right - left < 0.4) continue;
      if (form < 0.4)
        wall.openings.push_back(rectangle(left, low, right, top));
      else if (form < 0.6)
        wall.openings.push_back(arched(left, low, right, top - 0.2, 0.12));
      else if (form < 0.75 && tall - (right - left) / 2 > 0.05)
        wall.openings.push_back(arched(left, low, right, top - (right - left) / 2, (right - left) / 2));
      else if (form < 0.9 && tall - (right - left) * 0.8 > 0.05)
        wall.openings.push_back(pointed(left, low, right, top - (right - left) * 0.8));
      else
        wall.openings.push_back(
            round_window({(left + right) / 2, low + tall / 2}, std::min(right - left, tall) * 0.45));
    }
  return wall;
}

model::Polygon polygon_of(const Outline& outline) {
  model::Polygon out;
  out.outer.points = outline;
  out.outer.nodes.assign(outline.size(), 0);
  return out;
}

std::vector<Stone> stones_of(const WallToLay& wall, const Masonry& masonry) {
  auto laid = lay(wall, masonry);
  return laid ? std::move(laid->stones) : std::vector<Stone>{};
}

std::string text_of(const Stone& stone) {
  std::string out = fmt::format("{} {} {}", kStoneRoleNames[static_cast<int>(stone.role)], stone.course, stone.shade);
  for (const Point2& p : stone.outline) out += fmt::format(" {:.4f},{:.4f}", p.x, p.y);
  return out;
}

}  // namespace blockrand::masonry
