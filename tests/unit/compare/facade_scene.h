// Houses with windows at known places, drawn in different ways, for tests of facades.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "pipeline/compare/city.h"
#include "pipeline/compare/facade_agreement.h"

namespace blockrand::compare::test {

/// Where a window is in its wall: m from the wall's left end as seen from outside, and above the ground.
struct Hole {
  double left = 0, right = 0, bottom = 0, top = 0;
  bool door = false;
};

/// How walls are drawn. The building is the same.
enum class Drawn {
  holes,      ///< one polygon with a hole for each opening
  plain,      ///< one polygon without holes
  cells,      ///< rectangles between all edges of openings
  triangles,  ///< those cut into two
  strips,     ///< plain, cut into 40 upright strips at odd places
};

struct HouseStyle {
  Drawn drawn = Drawn::holes;
  double set_back = 0;  ///< m: openings stand so far behind the wall, with reveals
  bool boxes = false;   ///< an opening is a frame, a pane and four sides 0.05 m deep
  double ground = 100;  ///< z
};

/// A house with a flat roof on a plan that runs counter-clockwise; walls[i] are the openings of the wall from plan[i]
/// on.
Building house(const std::vector<Point2>& plan, double height, const std::vector<std::vector<Hole>>& walls,
               const HouseStyle& style = {});
std::vector<Point2> rectangle(double left, double bottom, double right, double top);

/// columns x rows windows of 1.2 x 1.5 m, pitches 2.5 and 3 m, the first at (1, 1).
std::vector<Hole> grid(int columns, int rows);

City city_of(std::vector<Building> buildings);
std::vector<std::uint32_t> all_of(const City& city);
/// z of the lowest ground.
double ground_of(const City& city);
/// Heights above that.
std::vector<Facade> facades(const City& city);

/// Every coordinate turned about the origin.
void turn(City& city, double angle);
/// Every face and opening drawn the other way round.
void reverse(Building& building);

/// All measures of facades, as one match, each side above its lowest ground.
MeasureValues measured(const City& model, const City& reference);
const MeasureValue& value(const MeasureValues& values, Measure measure);

}  // namespace blockrand::compare::test
