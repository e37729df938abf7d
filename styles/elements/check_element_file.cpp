// Is what an element file describes an element? It is made once at each end of its sizes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/base/error.h"
#include "pipeline/base/text.h"
#include "pipeline/model/vector.h"
#include "styles/elements/element_file.h"
#include "styles/elements/make_kind.h"

namespace blockrand::elements {
namespace {

using model::Point2;
using model::Point3;

/// m. Coordinates lie on the grid, and swept ones nearly so.
constexpr double kRounding = 1e-6;
/// m², of an opening, that may stay open, and pieces of it that do not count: what rounding leaves between faces.
constexpr double kMostOpen = 1e-4, kLeastOpen = 1e-6;
/// Pieces of an opening that faces leave: more are no window.
constexpr std::size_t kMostOpenPieces = 10'000;

std::vector<Point3> corners_of(const ElementMesh& mesh, const ElementFace& face) {
  std::vector<Point3> out;
  for (std::uint32_t i = 0; i < face.count; ++i) out.push_back(mesh.vertices[mesh.indices[face.first + i]]);
  return out;
}

/// Newell's normal: twice the area long.
Point3 normal_of(const std::vector<Point3>& c) {
  Point3 n;
  for (std::size_t i = 1; i + 1 < c.size(); ++i) n = n + model::cross(c[i] - c[0], c[i + 1] - c[0]);
  return n;
}

std::string mesh_defect(const ElementMesh& mesh) {
  if (mesh.faces.empty()) return "nothing is made";
  for (const Point3& p : mesh.vertices) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return "a corner is no place";
    if (p.z < -kDeepest - kRounding)
      return fmt::format("it reaches {:.3f} m into the wall; at most {} m is allowed", -p.z, kDeepest);
  }
  for (const ElementFace& face : mesh.faces) {
    const std::vector<Point3> c = corners_of(mesh, face);
    const Point3 n = normal_of(c);
    const double twice = model::length(n);
    const std::string where =
        fmt::format("the face of {} at ({:.3f}, {:.3f}, {:.3f})", model::name(face.part), c[0].x, c[0].y, c[0].z);
    if (!(twice > 2e-9)) return where + " has no area";
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (std::fabs(model::dot(c[i] - c[0], n)) / twice > kRounding) return where + " is not plane";
      const Point3 a = c[i], b = c[(i + 1) % c.size()], d = c[(i + 2) % c.size()];
      if (!(model::dot(model::cross(b - a, d - b), n) > 0)) return where + " is not convex";
    }
  }
  return {};
}

std::string outline_defect(const Outline& outline, double width, double height) {
  const std::size_t n = outline.size();
  if (n < 3) return "the outline has no area";
  if (signed_area(outline) <= 0) return "the outline runs clockwise; it must be counter-clockwise";
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = outline[i], b = outline[(i + 1) % n], c = outline[(i + 2) % n];
    if (!(model::cross(a, b, c) > 0)) return fmt::format("the outline is not convex at ({:.3f}, {:.3f})", b.x, b.y);
  }
  if (!is_simple(outline)) return "the outline crosses itself";
  const Bounds2 box = bounds_of(outline);
  const double half = width / 2 + 1 / model::kGridStepsPerMetre;
  if (box.least.x < -half || box.most.x > half || box.least.y < 0 ||
      box.most.y > height + 1 / model::kGridStepsPerMetre)
    return fmt::format("the outline goes from ({:.3f}, {:.3f}) to ({:.3f}, {:.3f}), beyond {:.3f} x {:.3f} m",
                       box.least.x, box.least.y, box.most.x, box.most.y, width, height);
  return {};
}

/// What of a convex piece lies outside a convex polygon, as convex pieces.
void cut_away(const Outline& piece, const Outline& by, std::vector<Outline>& out) {
  Outline inside = piece;
  std::vector<Outline> outside;
  for (std::size_t i = 0; i < by.size() && !inside.empty(); ++i) {
    const Point2 a = by[i], b = by[(i + 1) % by.size()], normal{b.y - a.y, a.x - b.x};
    const double length = model::length(normal);
    if (length == 0) continue;
    const Point2 unit = normal * (1 / length);
    const double limit = model::dot(unit, a);
    if (Outline rest = clipped(inside, -unit, -limit); !rest.empty()) outside.push_back(std::move(rest));
    inside = clipped(inside, unit, limit);
  }
  if (inside.empty()) {
    out.push_back(piece);
    return;
  }
  for (Outline& o : outside)
    if (signed_area(o) > kLeastOpen) out.push_back(std::move(o));
}

/// Where one sees through the opening from in front, past all that closes one.
std::string open_place(const Element& element) {
  std::vector<Outline> open{inset(element.opening.outline, 0.002)};
  for (const ElementFace& face : element.mesh.faces) {
    const bool closes = face.part == Part::frame || face.part == Part::leaf || face.part == Part::glass ||
                        face.part == Part::panel || face.part == Part::wall;
    const std::vector<Point3> c = corners_of(element.mesh, face);
    if (!closes || normal_of(c).z <= kRounding) continue;
    Outline flat;
    for (const Point3& p : c) flat.push_back({p.x, p.y});
    const Bounds2 box = bounds_of(flat);
    std::vector<Outline> left;
    for (Outline& piece : open) {
      const Bounds2 own = bounds_of(piece);
      if (own.most.x <= box.least.x || own.least.x >= box.most.x || own.most.y <= box.least.y ||
          own.least.y >= box.most.y)
        left.push_back(std::move(piece));
      else
        cut_away(piece, flat, left);
    }
    open = std::move(left);
    if (open.size() > kMostOpenPieces) return "what closes it leaves more holes than can be counted";
  }
  double area = 0;
  const Outline* largest = nullptr;
  for (const Outline& piece : open) {
    area += signed_area(piece);
    if (!largest || signed_area(piece) > signed_area(*largest)) largest = &piece;
  }
  if (!largest || area <= kMostOpen) return {};
  const Bounds2 box = bounds_of(*largest);
  return fmt::format(
      "one sees through it near ({:.2f}, {:.2f}): frame, leaf, glass, panel and wall leave {:.3f} m² of the opening "
      "open",
      (box.least.x + box.most.x) / 2, (box.least.y + box.most.y) / 2, area);
}

}  // namespace

std::string element_defect(const Element& element, double width, double height, bool covers) {
  if (std::string defect = mesh_defect(element.mesh); !defect.empty()) return defect;
  if (element.semantic == ElementClass::installation) return {};
  if (covers)
    if (std::string defect = outline_defect(element.opening.outline, width, height); !defect.empty()) return defect;
  return covers ? open_place(element) : std::string();
}

void check_element_file(const ElementFile& file, const ProfileLibrary& profiles) {
  const auto fail = [&](const std::string& what, const std::string& remedy) {
    throw base::InputError(file.file, "", what, remedy);
  };
  const auto maker = [&](const Request& request, Element& element) { return make_from_file(file, request, element); };
  const SizeRange &w = file.kind.width, &h = file.kind.height;
  struct Size {
    const char* name;
    double width, height;
  };
  for (const Size s : {Size{"least", w.least, h.least}, {"usual", w.usual, h.usual}, {"most", w.most, h.most}})
    for (const double detail : {1.0, 0.0, 2.0}) {
      const std::vector<Parameter> asked{{"detail", detail}};
      const std::string at =
          fmt::format("at its {} size, {} x {} m{}, ", s.name, base::shortest(s.width), base::shortest(s.height),
                      detail == 1 ? "" : fmt::format(" and detail {}", detail));
      const auto made = make_kind(file.kind, maker, s.width, s.height, asked, profiles);
      if (!made) fail(at + "it cannot be made: " + made.error(), "Mend that, or narrow width and height");
      // Built-in kinds keep their own promises: gateways may stand open, shaped windows are not convex.
      const std::string defect = element_defect(*made, model::snap(s.width), model::snap(s.height), !file.base);
      if (!defect.empty()) fail(at + defect, kSeePage);
    }
}

}  // namespace blockrand::elements
