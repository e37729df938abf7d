#include "pipeline/surroundings/ground_height.h"

#include <algorithm>
#include <cmath>

namespace blockrand::surroundings {

using model::Point2;

namespace {
constexpr double kStep = kSquareSize / kTerrainSteps;
}

SquareIndex square_of(Point2 place) {
  return {static_cast<std::int32_t>(std::floor(place.x / kSquareSize)),
          static_cast<std::int32_t>(std::floor(place.y / kSquareSize))};
}

geometry::PlanBox box_of(SquareIndex square) {
  geometry::PlanBox box;
  box.minimum = {square.x * kSquareSize, square.y * kSquareSize};
  box.maximum = {(square.x + 1) * kSquareSize, (square.y + 1) * kSquareSize};
  return box;
}

SquareGround::SquareGround(SquareIndex square, const HeightAt& height, double level) : square_(square), level_(level) {
  if (!height) return;
  const Point2 corner = box_of(square).minimum;
  bool uneven = false;
  for (int row = 0; row <= kTerrainSteps; ++row)
    for (int column = 0; column <= kTerrainSteps; ++column) {
      const double z = model::snap(height({corner.x + column * kStep, corner.y + row * kStep}).value_or(level));
      heights_.push_back(z);
      uneven = uneven || z != heights_.front();
    }
  if (uneven) return;
  level_ = heights_.front();
  heights_.clear();
}

double SquareGround::at(Point2 place) const {
  if (is_level()) return level_;
  const Point2 corner = box_of(square_).minimum;
  const double x = std::clamp((place.x - corner.x) / kStep, 0.0, static_cast<double>(kTerrainSteps));
  const double y = std::clamp((place.y - corner.y) / kStep, 0.0, static_cast<double>(kTerrainSteps));
  const int column = std::min(static_cast<int>(x), kTerrainSteps - 1),
            row = std::min(static_cast<int>(y), kTerrainSteps - 1);
  const double u = x - column, v = y - row;
  const double low = node(column, row), high = node(column + 1, row + 1);
  // Along the border of two triangles both formulas are one: the weights of the corner beyond are 0.
  const double z = u >= v ? low * (1 - u) + node(column + 1, row) * (u - v) + high * v
                          : low * (1 - v) + node(column, row + 1) * (v - u) + high * u;
  return model::snap(z);
}

std::vector<geometry::DividingLine> SquareGround::lines() const {
  std::vector<geometry::DividingLine> out;
  if (is_level()) return out;
  const Point2 a = box_of(square_).minimum, b = box_of(square_).maximum;
  for (int i = 1; i < kTerrainSteps; ++i) {
    out.push_back({0, {{a.x + i * kStep, a.y}, {a.x + i * kStep, b.y}}, {}});
    out.push_back({0, {{a.x, a.y + i * kStep}, {b.x, a.y + i * kStep}}, {}});
  }
  for (int i = 0; i < kTerrainSteps; ++i) {
    out.push_back({0, {{a.x + i * kStep, a.y}, {b.x, b.y - i * kStep}}, {}});
    if (i > 0) out.push_back({0, {{a.x, a.y + i * kStep}, {b.x - i * kStep, b.y}}, {}});
  }
  return out;
}

}  // namespace blockrand::surroundings
