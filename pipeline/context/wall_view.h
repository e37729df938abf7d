// What can be seen from a wall: rays to the walls and streets around it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "pipeline/context/courtyards.h"
#include "pipeline/context/street_network.h"
#include "pipeline/model/point.h"

namespace blockrand::context {

/// A wall of a footprint, the inside on its left.
struct Wall {
  model::Point2 a, b;           ///< m
  std::uint32_t footprint = 0;  ///< index into the footprints given
};

/// A straight piece of a street's centre line, or of the outline of a pedestrian area; or the bar across a dead end.
struct StreetPiece {
  model::Point2 a, b;          ///< m
  std::uint32_t line = 0;      ///< index into the lines given
  model::Point2 along;         ///< unit vector
  bool any_direction = false;  ///< of a square's outline: says nothing of how the square lies
};

/// m. At a dead end a bar as long as a turning place stands across the street: walls that close it look at street space,
/// not along a line.
inline constexpr double kDeadEndBar = 14;
/// m². Smaller footprints are garages and sheds: one looks over them.
inline constexpr double kOutbuildingArea = 50;

/// What a ray takes for a wall.
enum class Obstacles : std::uint8_t {
  walls,     ///< all but canopies
  buildings  ///< outbuildings are seen over
};

inline constexpr std::uint32_t kNothing = 0xffffffff;

/// Where a ray ends.
struct Sight {
  double wall = std::numeric_limits<double>::infinity();    ///< m to the first wall; infinite for none
  std::uint32_t footprint = kNothing;                       ///< whose wall
  bool from_inside = false;                                 ///< met from its inner side: the ray began in that building
  double street = std::numeric_limits<double>::infinity();  ///< m to the first street before that wall
  std::uint32_t street_piece = kNothing;                    ///< which one: index into Scene::streets
};

/// Walls and streets of a tile and its surroundings, filed under the cells of a grid that is fixed in the CRS. Read-only
/// after construction, safe to share between threads. Canopies hide nothing and are no walls.
class Scene {
 public:
  /// Streets in tunnels are left out; streets are filed as far as `margin` around the footprints.
  /// \param margin  m
  Scene(std::span<const Footprint> footprints, std::span<const NetworkLine> lines, double margin);

  /// Follows a ray.
  /// \param direction  unit vector
  /// \param reach      m, what is farther is not seen
  /// What lies within kOnTheWall of the start is not seen, but for walls met from inside.
  Sight look(model::Point2 from, model::Point2 direction, double reach, Obstacles obstacles = Obstacles::walls) const;

  /// Indices, ascending, of walls (canopies' too) that come into a box, and of some others.
  void walls_near(model::Point2 minimum, model::Point2 maximum, std::vector<std::uint32_t>& out) const;

  std::span<const Wall> walls() const { return walls_; }
  std::span<const StreetPiece> streets() const { return streets_; }
  bool is_canopy(std::uint32_t footprint) const { return sort_[footprint] == Sort::canopy; }
  bool is_outbuilding(std::uint32_t footprint) const { return sort_[footprint] == Sort::outbuilding; }

  /// m. Half of the mean distance that mapping leaves between walls that touch.
  static constexpr double kOnTheWall = 0.05;

 private:
  static constexpr std::uint32_t kAtOnce = 32;
  static constexpr double kCell = 5;  ///< m. Smaller cells cost more steps than they save tests
  void add_streets(std::span<const NetworkLine> lines);
  std::int64_t column(double x) const;
  std::int64_t row(double y) const;
  template <class Visit>
  void for_each_cell(model::Point2 a, model::Point2 b, Visit&& visit) const;
  enum class Sort : std::uint8_t { building, outbuilding, canopy, street };
  /// A wall or piece of street in a cell: what a ray needs, side by side.
  struct Item {
    model::Point2 a, b;
    std::uint32_t index = 0;  ///< into walls_ or streets_
    std::uint32_t owner = 0;  ///< footprint or line
    Sort sort = Sort::building;
  };
  static void test(const Item& item, model::Point2 from, model::Point2 direction, double reach, Obstacles obstacles,
                   Sight& sight, std::uint32_t& street_line);

  std::vector<Wall> walls_;
  std::vector<StreetPiece> streets_;
  std::vector<Sort> sort_;  ///< by footprint
  std::int64_t first_column_ = 0, first_row_ = 0, columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> starts_;      ///< per cell, row by row
  std::vector<Item> items_;                ///< walls, then streets, ascending within a cell
  std::vector<double> ax_, ay_, bx_, by_;  ///< their ends once more: a ray's sides of several are told at once
};

/// Rays of a fan over the half plane before a wall: 13 at steps of 13.5 degrees, from 81 degrees right to 81 left.
inline constexpr int kFanRays = 13;

/// The directions of the fan around an outward normal (a unit vector).
std::array<model::Point2, kFanRays> fan_around(model::Point2 normal);

}  // namespace blockrand::context
