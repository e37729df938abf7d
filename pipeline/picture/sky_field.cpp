#include "pipeline/picture/sky_field.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/picture/view.h"

namespace blockrand::picture {
namespace {

/// Directions in which the horizon is looked for, all around.
constexpr int kAzimuths = 16;

/// Of its height: so far beyond the buildings the ground still tells that they are there.
constexpr double kFringe = 1.5;

/// What a horizon at the slope t (a tangent) takes of the light on a wall that looks at it: (2 h + sin 2 h) / pi with h = atan t,
/// the integral of the squared cosine of the elevation up to it.
class TakenOfWall {
 public:
  TakenOfWall() {
    for (int i = 0; i < kSteps; ++i) {
      const double u = static_cast<double>(i) / kSteps, t = u / (1 - u);
      table_[static_cast<std::size_t>(i)] = static_cast<float>(2 / base::kPi * (base::atan2(t, 1) + t / (1 + t * t)));
    }
    table_[kSteps] = 1;
  }
  float operator()(float t) const { return table_[static_cast<std::size_t>(t / (1 + t) * kSteps + 0.5f)]; }

 private:
  static constexpr int kSteps = 512;
  std::array<float, kSteps + 1> table_;
};

float squared(float v) { return v * v; }

}  // namespace

SkyField::SkyField(const Scene& scene, int size) {
  const Box bounds = scene.bounds();
  if (bounds.empty) {
    cells_.resize(1);
    return;
  }
  const Point3 low = bounds.min - scene.origin(), high = bounds.max - scene.origin();
  const double margin = kFringe * (high.z - low.z) + 1e-3;
  const double width = high.x - low.x + 2 * margin, height = high.y - low.y + 2 * margin;
  cell_ = std::max(width, height) / size;
  left_ = low.x - margin;
  bottom_ = low.y - margin;
  columns_ = static_cast<int>(width / cell_) + 1;
  rows_ = static_cast<int>(height / cell_) + 1;
  per_cell_ = static_cast<float>(1 / cell_);
  Cell lowest;
  lowest.top = static_cast<float>(scene.ground() ? scene.ground()->z : low.z);
  cells_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), lowest);
  measure_heights(scene);
  for (int i = 0; i < kAzimuths; ++i) sweep((i + 0.5) * 2 * base::kPi / kAzimuths);
  finish(margin);
}

void SkyField::measure_heights(const Scene& scene) {
  // Seen from below the sheet, rows would run north: the view's rows run south, the grid's north.
  const View view({1, 0, 0}, {0, -1, 0}, {0, 0, -1}, left_, -bottom_, 1 / cell_, columns_, rows_);
  const auto faces = scene.faces();
  for (const Scene::Triangle& t : scene.triangles()) {
    const Scene::Face& face = faces[t.face];
    if (face.closed && face.normal.z <= 0) continue;
    draw(view, t, {columns_, 0, rows_},
         [&](std::size_t i, double height) { cells_[i].top = std::max(cells_[i].top, static_cast<float>(height)); });
  }
}

/// Walks over the grid along parallel lines, with the hull of what lies behind: the steepest way back to it is the horizon.
void SkyField::sweep(double azimuth) {
  static const TakenOfWall kTakenOfWall;
  const base::SinCos way = base::sin_cos(azimuth);
  // Steps of one along the longer axis.
  const bool across = std::fabs(way.cos) >= std::fabs(way.sin);
  const int length = across ? columns_ : rows_, lines = across ? rows_ : columns_;
  const double slope = across ? way.sin / std::fabs(way.cos) : way.cos / std::fabs(way.sin);
  const bool backwards = (across ? way.cos : way.sin) < 0;
  const auto step = static_cast<float>(cell_ * std::sqrt(1 + slope * slope));
  std::vector<int> offset;
  for (int i = 0; i < length; ++i) offset.push_back(static_cast<int>(std::floor(slope * i + 0.5)));
  // Towards the horizon.
  const auto east = static_cast<float>(-way.cos), north = static_cast<float>(-way.sin);
  const float cos2 = squared(east) - squared(north), sin2 = 2 * east * north;

  struct Summit {
    float at, height;
  };
  std::vector<Summit> hull;
  const int first = std::min(0, -offset.back()), last = lines - std::min(0, offset.back());
  for (int line = first; line < last; ++line) {
    hull.clear();
    for (int i = 0; i < length; ++i) {
      const int side = line + offset[static_cast<std::size_t>(i)];
      if (side < 0 || side >= lines) continue;
      const int along = backwards ? length - 1 - i : i;
      const std::size_t index =
          across
              ? static_cast<std::size_t>(side) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(along)
              : static_cast<std::size_t>(along) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(side);
      Cell& cell = cells_[index];
      const float at = static_cast<float>(i) * step;
      const auto rise = [&](const Summit& s) { return (s.height - cell.top) / (at - s.at); };
      while (hull.size() > 1 && rise(hull[hull.size() - 2]) >= rise(hull.back())) hull.pop_back();
      if (!hull.empty()) {
        if (const float t = rise(hull.back()); t > 0) {
          const float level = t * t / (1 + t * t), wall = kTakenOfWall(t);
          cell.taken[0] += level;
          cell.taken[1] += wall;
          cell.taken[2] += wall * east;
          cell.taken[3] += wall * north;
          cell.taken[4] += wall * cos2;
          cell.taken[5] += wall * sin2;
          cell.around += wall * hull.back().height;
        }
      }
      hull.push_back({at, cell.top});
    }
  }
}

void SkyField::finish(double margin) {
  const double fringe = margin / cell_;
  for (int y = 0; y < rows_; ++y)
    for (int x = 0; x < columns_; ++x) {
      Cell& cell =
          cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x)];
      cell.around = cell.taken[1] > 0 ? cell.around / cell.taken[1] : cell.top + 1;
      // To nothing at the border, beyond which nothing is known.
      const double inside = std::min({x, y, columns_ - 1 - x, rows_ - 1 - y}) / fringe;
      const auto share = static_cast<float>(std::min(1.0, inside * 2) / kAzimuths);
      cell.taken[0] *= share;
      cell.taken[1] *= share;
      for (std::size_t i = 2; i < 6; ++i) cell.taken[i] *= 2 * share;
    }
}

SkyField::Asker SkyField::asker(Scene::Vector n) const {
  Asker out;
  const float level = n.z > 0 ? squared(n.z) : 0.0f;
  out.parts[0] = level;
  out.parts[1] = 1 - level;
  const float across = std::sqrt(n.x * n.x + n.y * n.y);
  if (!(across > 1e-3f)) return out;
  const float x = n.x / across, y = n.y / across;
  // A wall's cosine, cut off behind it, turns each of the terms into a share of it: pi / 4 of the first, a third of the second.
  out.parts[2] = (1 - level) * 0.7853982f * x;
  out.parts[3] = (1 - level) * 0.7853982f * y;
  out.parts[4] = (1 - level) / 3 * (x * x - y * y);
  out.parts[5] = (1 - level) / 3 * (2 * x * y);
  const auto ahead = static_cast<float>(0.8 * cell_) * (1 - level);
  out.ahead_x = x * ahead;
  out.ahead_y = y * ahead;
  return out;
}

float SkyField::open(const Asker& asker, float x, float y, float z) const {
  const float column = (x + asker.ahead_x - static_cast<float>(left_)) * per_cell_ - 0.5f,
              row = (y + asker.ahead_y - static_cast<float>(bottom_)) * per_cell_ - 0.5f;
  if (!(column >= 0 && row >= 0 && column < static_cast<float>(columns_ - 1) && row < static_cast<float>(rows_ - 1)))
    return 1;
  const int i = static_cast<int>(column), j = static_cast<int>(row);
  const float fx = column - static_cast<float>(i), fy = row - static_cast<float>(j);
  const Cell* below =
      &cells_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)];
  const Cell* const cells[4] = {below, below + 1, below + columns_, below + columns_ + 1};
  const float weights[4] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
  // A roof's slope rises by about a cell from one to the next. What rises more is another building, and the place is not in it.
  const float reach = z + 0.3f + 1.2f * static_cast<float>(cell_) * asker.parts[0];
  float taken = 0, sum = 0;
  for (int k = 0; k < 4; ++k) {
    const Cell& cell = *cells[k];
    if (cell.top > reach) continue;
    float here = asker.parts[0] * cell.taken[0];
    for (std::size_t p = 1; asker.parts[0] < 1 && p < 6; ++p) here += asker.parts[p] * cell.taken[p];
    // The higher up, the less of what stands around rises above.
    const float up = std::clamp((z - cell.top) / std::max(cell.around - cell.top, 1.0f), 0.0f, 1.0f);
    taken += weights[k] * std::max(here, 0.0f) * (1 - up);
    sum += weights[k];
  }
  constexpr float kShut = 0.5f;  // of what stands in a gap of no cell
  return sum > 0 ? std::max(0.0f, 1 - taken / sum) : kShut;
}

}  // namespace blockrand::picture
