#include "tests/unit/grammar/shapes/shapes_support.h"

#include <cmath>
#include <cstdio>

namespace blockrand::grammar {

Shape lot(const std::vector<std::pair<double, double>>& outline) {
  std::vector<Vector3> ring;
  for (const auto& [x, z] : outline) ring.push_back({x, 0, z});
  return initial_shape(ring);
}
Shape rectangle(double w, double d) { return lot({{0, 0}, {w, 0}, {w, -d}, {0, -d}}); }
Shape u_shape() { return lot({{0, 0}, {5, 0}, {5, -10}, {15, -10}, {15, 0}, {20, 0}, {20, -20}, {0, -20}}); }
Shape l_shape() { return lot({{0, 0}, {20, 0}, {20, -10}, {10, -10}, {10, -20}, {0, -20}}); }
Shape triangle() { return lot({{0, 0}, {10, 0}, {0, -10}}); }

Argument word(std::string text) { return {Mark::plain, 0.0, std::move(text)}; }
Argument relative(double value) { return {Mark::relative, value, {}}; }
Argument floating(double value) { return {Mark::floating, value, {}}; }
Argument plain(double value) { return {Mark::plain, value, {}}; }
Argument text_of(std::string text) { return {Mark::plain, std::move(text), {}}; }

std::string error_of(Shape shape, std::string_view operation, std::vector<Argument> arguments) {
  const OperationEntry* entry = find_operation(operation);
  if (entry == nullptr) return "no operation";
  const int count = static_cast<int>(arguments.size());
  if (count < entry->least || count > entry->most) return "count";
  const Shape base = shape;
  const auto result = entry->run(shape, {base, base}, arguments);
  return result ? "" : result.error();
}

void run(Shape& shape, std::string_view operation, std::vector<Argument> arguments) {
  const OperationEntry* entry = find_operation(operation);
  ASSERT_NE(entry, nullptr) << operation;
  for (std::size_t i = 0; i < arguments.size(); ++i)
    EXPECT_TRUE(arguments[i].word.empty() || (entry->words >> i & 1)) << operation << " argument " << i;
  EXPECT_GE(static_cast<int>(arguments.size()), entry->least) << operation;
  EXPECT_LE(static_cast<int>(arguments.size()), entry->most) << operation;
  const Shape base = shape;
  const auto result = entry->run(shape, {base, base}, arguments);
  EXPECT_TRUE(result) << operation << ": " << (result ? "" : result.error());
}

Shape after(Shape shape, std::string_view operation, std::vector<Argument> arguments) {
  run(shape, operation, std::move(arguments));
  return shape;
}

std::vector<std::vector<Shape>> taken(const Shape& shape, ComponentKind kind,
                                      const std::vector<std::string>& selectors) {
  const ComponentSplit parts = components(shape, kind);
  std::vector<bool> gone(parts.items.size(), false);
  std::vector<std::vector<Shape>> out;
  for (const std::string& text : selectors) {
    const auto selector = selector_of_word(text);
    EXPECT_TRUE(selector.has_value()) << text;
    out.emplace_back();
    if (!selector) continue;
    for (std::size_t i = 0; i < parts.items.size(); ++i) {
      if (gone[i] || !selected(parts, i, *selector)) continue;
      gone[i] = true;
      out.back().push_back(component_shape(parts, i));
    }
  }
  return out;
}

SplitItem item(char name, double size, Mark mark) { return {mark, size, name, 0, false}; }
SplitItem block(int inside, bool repeat) { return {Mark::plain, 0, -1, inside, repeat}; }

std::string pieces_text(const std::vector<SplitItem>& items, bool repeat, double length) {
  std::string out;
  double at = 0;
  for (const SplitPiece& piece : split_sizes(items, repeat, length)) {
    EXPECT_NEAR(piece.from, at, 1e-9);
    at = piece.to;
    char line[64];
    std::snprintf(line, sizeof line, "%s%c %.4g", out.empty() ? "" : " ", static_cast<char>(piece.rule),
                  piece.to - piece.from);
    out += line;
  }
  return out;
}

std::vector<Shape> split(const Shape& shape, int axis, const std::vector<SplitItem>& items, bool repeat, bool adjust) {
  return split_shape(shape, axis, split_sizes(items, repeat, split_length(shape, axis)), adjust);
}

void expect_sound(const Shape& shape, bool closed) {
  const Mesh& mesh = mesh_of(shape);
  for (const Vector3 p : mesh.vertices) {
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    for (int i = 0; i < 3; ++i) {
      EXPECT_GE(component(p, i), std::min(0.0, component(shape.size, i)) - 1e-6);
      EXPECT_LE(component(p, i), std::max(0.0, component(shape.size, i)) + 1e-6);
    }
  }
  for (const MeshFace& face : mesh.faces) {
    ASSERT_FALSE(face.loops.empty());
    for (const Loop& loop : face.loops) {
      ASSERT_GE(loop.size(), 3u);
      for (std::size_t i = 0; i < loop.size(); ++i) {
        ASSERT_LT(loop[i].vertex, mesh.vertices.size());
        EXPECT_NE(loop[i].vertex, loop[(i + 1) % loop.size()].vertex);
      }
    }
  }
  for (const UvSet& set : mesh.uv)
    if (!set.empty()) {
      ASSERT_EQ(set.size(), mesh.faces.size());
      for (std::size_t f = 0; f < set.size(); ++f) {
        if (set[f].empty()) continue;
        ASSERT_EQ(set[f].size(), mesh.faces[f].loops.size());
        for (std::size_t l = 0; l < set[f].size(); ++l) ASSERT_EQ(set[f][l].size(), mesh.faces[f].loops[l].size());
      }
    }
  EXPECT_TRUE(!closed || is_closed(mesh));
  EXPECT_TRUE(!closed || signed_volume(mesh) > 0);
}

double volume(const Shape& shape) { return signed_volume(mesh_of(shape)); }

}  // namespace blockrand::grammar
