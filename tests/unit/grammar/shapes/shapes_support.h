// The initial shapes of the conformance table (docs/rule_language.md §7.4), and running operations by name as rules do.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "styles/grammar/shapes/components.h"
#include "styles/grammar/shapes/initial_shape.h"
#include "styles/grammar/shapes/measure.h"
#include "styles/grammar/shapes/mesh_tools.h"
#include "styles/grammar/shapes/operations.h"
#include "styles/grammar/shapes/split.h"

namespace blockrand::grammar {

/// w along x, d to the north; the first edge is in front.
Shape rectangle(double w, double d);
Shape u_shape();  ///< 300 m²
Shape l_shape();  ///< 300 m²
Shape triangle();
/// A lot from (x, z) pairs.
Shape lot(const std::vector<std::pair<double, double>>& outline);

Argument word(std::string text);
Argument relative(double value);
Argument floating(double value);
Argument plain(double value);
Argument text_of(std::string text);

/// The operation with these arguments; the shape at the call is the base. Fails the test on errors.
void run(Shape& shape, std::string_view operation, std::vector<Argument> arguments = {});
/// The error's text, or "" when it ran.
std::string error_of(Shape shape, std::string_view operation, std::vector<Argument> arguments = {});
Shape after(Shape shape, std::string_view operation, std::vector<Argument> arguments = {});

/// The components that the selectors take, one after the other, as `sel : X` does: by selector.
std::vector<std::vector<Shape>> taken(const Shape& shape, ComponentKind kind,
                                      const std::vector<std::string>& selectors);

/// Sizes of pieces, by name: "A 2, B 1".
struct Item {
  Mark mark;
  double size;
  char name;
};
std::string pieces_text(const std::vector<SplitItem>& items, bool repeat, double length);
SplitItem item(char name, double size, Mark mark = Mark::plain);
SplitItem block(int inside, bool repeat);

std::vector<Shape> split(const Shape& shape, int axis, const std::vector<SplitItem>& items, bool repeat = false,
                         bool adjust = true);

/// Every edge as often in one direction as in the other, faces without repeated corners, all numbers finite, the
/// scope's box around the geometry.
void expect_sound(const Shape& shape, bool closed);

double volume(const Shape& shape);

}  // namespace blockrand::grammar
