#include "pipeline/surroundings/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "pipeline/base/portable_math.h"
#include "pipeline/base/random.h"

namespace blockrand::surroundings {
namespace {

using base::TomlTable;
using model::Point3;

using Corners = std::vector<Point3>;
using Ring = std::vector<Point3>;  ///< around the axis of a body, counter-clockwise seen from its end; one point: a tip

constexpr double kReach = 400;  ///< m; of all measures
constexpr std::string_view kThemes[] = {"vegetation", "furniture", "transportation", "other"};

Point3 operator+(Point3 a, Point3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point3 operator*(Point3 a, double f) { return {a.x * f, a.y * f, a.z * f}; }
Point3 cross(Point3 a, Point3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double length(Point3 a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

Point3 turned(Point3 p, double degrees) {
  const base::SinCos t = base::sin_cos(degrees * base::kRadiansPerDegree);
  return {p.x * t.cos - p.y * t.sin, p.x * t.sin + p.y * t.cos, p.z};
}

void add(Corners& out, Point3 a, Point3 b, Point3 c) { out.insert(out.end(), {a, b, c}); }

/// A convex face, counter-clockwise.
void add_face(Corners& out, const Ring& ring) {
  for (std::size_t j = 2; j < ring.size(); ++j) add(out, ring[0], ring[j - 1], ring[j]);
}

/// The sides between rings, from the beginning of a body to its end.
void add_sides(Corners& out, const std::vector<Ring>& rings) {
  for (std::size_t i = 1; i < rings.size(); ++i) {
    const Ring &a = rings[i - 1], &b = rings[i];
    const std::size_t sides = std::max(a.size(), b.size());
    for (std::size_t j = 0; j < sides; ++j) {
      const std::size_t k = (j + 1) % sides;
      if (a.size() > 1) add(out, a[j], a[k], b.size() > 1 ? b[j] : b[0]);
      if (b.size() > 1) add(out, a.size() > 1 ? a[k] : a[0], b[k], b[j]);
    }
  }
}

void add_ends(Corners& out, const std::vector<Ring>& rings) {
  Ring first = rings.front();
  std::reverse(first.begin(), first.end());
  if (std::any_of(first.begin(), first.end(), [](Point3 p) { return p.z > 0; })) add_face(out, first);
  add_face(out, rings.back());
}

/// One part of a shape: reads its measures and makes its triangles.
class Part {
 public:
  Part(TomlTable& table, const std::string& shape, std::uint64_t number)
      : table_(table), shape_(shape), number_(number) {}

  Corners make() {
    using Form = Corners (Part::*)();
    constexpr std::pair<std::string_view, Form> kForms[] = {{"box", &Part::box},   {"turned", &Part::around},
                                                            {"pole", &Part::pole}, {"plate", &Part::plate},
                                                            {"lump", &Part::lump}, {"fronds", &Part::fronds}};
    const std::string name = table_.text("form").value_or("");
    for (const auto& [form, maker] : kForms)
      if (form == name) return copied((this->*maker)());
    std::vector<std::string> known;
    std::string list;
    for (const auto& [form, maker] : kForms) {
      known.emplace_back(form);
      list += (list.empty() ? "" : ", ") + known.back();
    }
    const std::string near = base::nearest(name, known);
    table_.fail("form", name.empty() ? "is missing" : "is unknown: `" + name + "`",
                near.empty() ? "Forms: " + list : "Did you mean `" + near + "`?");
  }

 private:
  double measure(std::string_view key, double least, double most) {
    const auto value = table_.number(key, least, most);
    if (!value) table_.fail(key, "is missing", "Give it in metres");
    return *value;
  }
  Point3 place(std::string_view key, bool needed = true) {
    const auto v = table_.numbers(key);
    if (!v && !needed) return {};
    if (!v || v->size() != 3 || std::any_of(v->begin(), v->end(), [](double c) { return !(std::abs(c) <= kReach); }))
      table_.fail(key, "must be three numbers, x, y and z", "Write it like [0, 0, 1.5], in metres");
    return {(*v)[0], (*v)[1], (*v)[2]};
  }
  std::size_t sides(std::int64_t least) {
    const auto value = table_.integer("sides", least, 16);
    if (!value) table_.fail("sides", "is missing", "Give their number");
    return static_cast<std::size_t>(*value);
  }
  double turn() { return table_.number("turn", -360, 360).value_or(0); }
  /// In [-1, 1): the same in every build.
  double chance(std::uint64_t i) const { return 2 * base::random_unit(number_, i, shape_) - 1; }

  Corners copied(const Corners& one) {
    const std::int64_t copies = table_.integer("copies", 1, 16).value_or(1);
    Corners out = one;
    for (std::int64_t i = 1; i < copies; ++i)
      for (const Point3 p : one) out.push_back(turned(p, 360 * static_cast<double>(i) / static_cast<double>(copies)));
    return out;
  }

  Corners box() {
    const Point3 at = place("at"), size = place("size");
    if (!(size.x > 0 && size.y > 0 && size.z > 0)) table_.fail("size", "must be above 0", "Give length, width, height");
    const double angle = turn(), x = size.x / 2, y = size.y / 2;
    std::vector<Ring> rings(2);
    for (std::size_t i = 0; i < 2; ++i)
      for (const Point3 p : {Point3{x, y, 0}, Point3{-x, y, 0}, Point3{-x, -y, 0}, Point3{x, -y, 0}})
        rings[i].push_back(turned(p, angle) + at + Point3{0, 0, i == 0 ? 0 : size.z});
    Corners out;
    add_sides(out, rings);
    add_ends(out, rings);
    return out;
  }

  /// A ring around an upright axis. \param uneven  of its radius; \param lift  m, how much its corners lie up and down
  Ring upright_ring(Point3 middle, double radius, std::size_t sides, double angle, double uneven, double lift,
                    std::uint64_t row) const {
    Ring ring;
    if (radius == 0) return {middle};
    for (std::size_t j = 0; j < sides; ++j) {
      const std::uint64_t i = 64 * row + 2 * j;
      const Point3 p{radius * (1 + uneven * chance(i)), 0, lift * chance(i + 1)};
      ring.push_back(turned(p, angle + 360 * static_cast<double>(j) / static_cast<double>(sides)) + middle);
    }
    return ring;
  }

  Corners around() {
    const Point3 at = place("at", false);
    const auto profile = table_.pairs("rings");
    if (!profile || profile->size() < 2) table_.fail("rings", "needs two rings", "Write it like [[0.5, 0], [0, 2]]");
    const std::size_t n = sides(3);
    const double uneven = table_.number("uneven", 0, 0.5).value_or(0), angle = turn();
    uneven_ = uneven > 0;
    const bool open = table_.boolean("open").value_or(false);
    std::vector<Ring> rings;
    for (std::size_t i = 0; i < profile->size(); ++i) {
      const auto [radius, z] = (*profile)[i];
      if (!(radius >= 0 && radius <= kReach && std::abs(z) <= kReach))
        table_.fail("rings", "has a measure out of range", "Radii are 0 or more");
      if (i > 0 && (*profile)[i] == (*profile)[i - 1]) table_.fail("rings", "has a ring twice", "Leave one out");
      if (i > 0 && radius == 0 && (*profile)[i - 1].first == 0)
        table_.fail("rings", "has two tips in a row", "Give one of them a radius");
      // Uneven rings stand across each other, so that no edge runs from the foot to the top.
      const double half_step = uneven > 0 && i % 2 == 1 ? 180 / static_cast<double>(n) : 0;
      rings.push_back(upright_ring(at + Point3{0, 0, z}, radius, n, angle + half_step, uneven, uneven * radius / 2, i));
    }
    Corners out;
    add_sides(out, rings);
    if (!open) add_ends(out, rings);
    return out;
  }

  Corners lump() {
    const Point3 at = place("at");
    const double radius = measure("radius", 0.01, kReach), height = measure("height", 0.01, kReach);
    const double uneven = table_.number("uneven", 0, 0.5).value_or(0), angle = turn();
    uneven_ = uneven > 0;
    // An icosahedron that stands on a corner: its rings lie at 1/sqrt(5) of its half height.
    const double ring = height / 2 / std::sqrt(5.0), lift = uneven * height / 4;
    std::vector<Ring> rings = {{at - Point3{0, 0, height / 2}},
                               upright_ring(at - Point3{0, 0, ring}, radius, 5, angle, uneven, lift, 0),
                               upright_ring(at + Point3{0, 0, ring}, radius, 5, angle + 36, uneven, lift, 1),
                               {at + Point3{0, 0, height / 2}}};
    Corners out;
    add_sides(out, rings);
    return out;
  }

  Corners pole() {
    const Point3 from = place("from"), to = place("to");
    const double radius = measure("radius", 0.001, kReach);
    const double end_radius = table_.number("top_radius", 0, kReach).value_or(radius);
    const std::size_t n = sides(2);
    const bool closed = table_.boolean("closed").value_or(false);
    const double span = length(to - from);
    if (!(span > 0)) table_.fail("to", "is where it begins", "Give another end");
    const Point3 along = (to - from) * (1 / span);
    const Point3 other = std::abs(along.z) > 0.9 ? Point3{0, 1, 0} : Point3{0, 0, 1};
    Point3 u = cross(other, along);
    u = u * (1 / length(u));
    const Point3 v = cross(along, u);
    std::vector<Ring> rings(2);
    for (std::size_t i = 0; i < 2; ++i) {
      const Point3 middle = i == 0 ? from : to;
      const double r = i == 0 ? radius : end_radius;
      for (std::size_t j = 0; j < (r > 0 ? n : 1); ++j) {
        const base::SinCos t = base::sin_cos(2 * base::kPi * static_cast<double>(j) / static_cast<double>(n));
        rings[i].push_back(middle + u * (r * t.cos) + v * (r * t.sin));
        if (from.z == 0 && i == 0) rings[i].back().z = 0;  // it stands on the ground with its whole foot
      }
    }
    Corners out;
    add_sides(out, rings);
    if (closed) add_ends(out, rings);
    return out;
  }

  Corners plate() {
    const Point3 at = place("at");
    const double thickness = table_.number("thickness", 0, 1).value_or(0),
                 angle = table_.number("turn", -360, 360).value_or(90);
    Ring front;
    if (const auto size = table_.numbers("size")) {
      if (size->size() != 2 || !((*size)[0] > 0 && (*size)[1] > 0))
        table_.fail("size", "must be two numbers above 0, along y and z", "Write it like [1, 0.6]");
      const double y = (*size)[0] / 2, z = (*size)[1] / 2;
      front = {at + Point3{0, -y, -z}, at + Point3{0, y, -z}, at + Point3{0, y, z}, at + Point3{0, -y, z}};
    } else {
      const std::size_t n = sides(3);
      const double radius = measure("radius", 0.001, kReach);
      for (std::size_t j = 0; j < n; ++j) {
        const base::SinCos t =
            base::sin_cos((angle + 360 * static_cast<double>(j) / static_cast<double>(n)) * base::kRadiansPerDegree);
        front.push_back(at + Point3{0, radius * t.cos, radius * t.sin});
      }
    }
    Corners out;
    add_face(out, front);
    if (table_.has("back")) {
      Ring back(front.rbegin(), front.rend());
      for (Point3& p : back) p.x -= thickness;
      add_face(back_, back);
    }
    return out;
  }

  Corners fronds() {
    const Point3 at = place("at");
    const auto count = table_.integer("count", 3, 16);
    if (!count) table_.fail("count", "is missing", "Give their number");
    const double reach = measure("length", 0.1, 20), width = measure("width", 0.01, 5);
    const double rise = measure("rise", -10, 10), droop = measure("droop", -10, 10);
    Corners out;
    for (std::int64_t i = 0; i < *count; ++i) {
      const auto row = static_cast<std::uint64_t>(i);
      const double angle = 360 * static_cast<double>(i) / static_cast<double>(*count) + 8 * chance(4 * row);
      const double far = reach * (1 + 0.12 * chance(4 * row + 1)), up = rise * (1 + 0.35 * chance(4 * row + 2));
      const auto at_length = [&](double x, double y, double z) { return turned({x, y, z}, angle) + at; };
      add_sides(out, {{at},
                      {at_length(0.45 * far, width / 2, up - 0.25 * width), at_length(0.45 * far, 0, up),
                       at_length(0.45 * far, -width / 2, up - 0.25 * width)},
                      {at_length(far, 0, -droop)}});
    }
    return out;
  }

  TomlTable& table_;
  const std::string& shape_;
  std::uint64_t number_;

 public:
  Corners back_;         ///< of a plate
  bool uneven_ = false;  ///< it has no edges of its own
};

void add_part(model::ObjectShape& shape, model::SurroundingMaterial material, const Corners& corners, bool round) {
  if (corners.empty()) return;
  auto part =
      std::find_if(shape.parts.begin(), shape.parts.end(), [&](const auto& p) { return p.material == material; });
  if (part == shape.parts.end()) part = shape.parts.insert(part, {material, {}, round});
  part->round = part->round && round;
  for (const Point3 p : corners) part->corners.push_back(model::snap(p));
}

}  // namespace

model::ObjectShape read_shape(TomlTable& table, const std::string& name, const MaterialOf& material) {
  model::ObjectShape shape;
  shape.name = name;
  shape.kind = table.text("kind").value_or("");
  if (shape.kind.empty()) table.fail("kind", "is missing", "Give the kind that [[object]] rows name");
  const std::string theme = table.text("theme").value_or("");
  const auto found = std::find(std::begin(kThemes), std::end(kThemes), theme);
  if (found == std::end(kThemes))
    table.fail("theme", theme.empty() ? "is missing" : "is unknown: `" + theme + "`",
               "Themes: vegetation, furniture, transportation, other");
  shape.theme = static_cast<model::ObjectTheme>(found - std::begin(kThemes));
  std::uint64_t number = 0;
  for (TomlTable& row : table.tables("parts")) {
    Part part(row, shape.name, number++);
    const Corners corners = part.make();
    add_part(shape, material(row, "material"), corners, part.uneven_);
    if (!part.back_.empty()) add_part(shape, material(row, "back"), part.back_, false);
    row.finish();
  }
  if (shape.parts.empty()) table.fail("parts", "has nothing", "Give one part at least");
  table.finish();
  constexpr double kFar = std::numeric_limits<double>::infinity();
  shape.min = {kFar, kFar, kFar};
  shape.max = {-kFar, -kFar, -kFar};
  for (const auto& part : shape.parts)
    for (const Point3 p : part.corners) {
      shape.min = {std::min(shape.min.x, p.x), std::min(shape.min.y, p.y), std::min(shape.min.z, p.z)};
      shape.max = {std::max(shape.max.x, p.x), std::max(shape.max.y, p.y), std::max(shape.max.z, p.z)};
    }
  return shape;
}

}  // namespace blockrand::surroundings
