#include "pipeline/compare/body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/compare/area_vector.h"
#include "pipeline/compare/cover.h"
#include "pipeline/compare/face_triangles.h"
#include "pipeline/compare/roofs_from_above.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::compare {

namespace {

using model::Polygon;

/// Sums that tell whether faces close, and what they enclose. Over a closed surface the integral of the normal is 0,
/// and that of place × normal (a matrix) is the volume times the unit matrix (divergence theorem). Walls that are
/// missing in pairs leave the first at 0, not the second.
struct Enclosed {
  Point3 vector;  ///< twice the sum of area vectors
  double area = 0, volume = 0;
  double moments[3][3] = {};
  void add(const Rings3& rings, Point3 base) {
    for (const auto& ring : rings) {
      if (ring.size() < 3) continue;
      const Point3 a = ring[0] - base;
      for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
        const Point3 b = ring[i] - base, c = ring[i + 1] - base;
        const Point3 n = cross(b - a, c - a);
        vector = {vector.x + n.x, vector.y + n.y, vector.z + n.z};
        volume += dot(a, cross(b, c)) / 6;
        const double place[] = {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3};
        const double normal[] = {n.x / 2, n.y / 2, n.z / 2};
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k) moments[i][k] += place[i] * normal[k];
      }
      area += length(area_vector(ring)) / 2;
    }
  }
  bool closed() const {
    constexpr double kShare = 0.001;
    if (area <= 0 || length(vector) / 2 > kShare * area) return false;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        if (std::fabs(moments[i][k] - (i == k ? volume : 0)) > 10 * kShare * std::fabs(volume)) return false;
    return true;
  }
};

Point3 base_of(const Rings3& rings) { return rings.empty() || rings[0].empty() ? Point3{} : rings[0][0]; }

std::vector<Polygon> footprints_of(const City& city, std::span<const std::uint32_t> buildings) {
  std::vector<Polygon> all;
  for (const std::uint32_t b : buildings)
    all.insert(all.end(), city.buildings[b].footprint.begin(), city.buildings[b].footprint.end());
  return all;
}

/// Outlines of footprints together: walls between houses of one match are no eaves.
std::vector<Polygon> outline_of(const City& city, std::span<const std::uint32_t> buildings) {
  std::vector<Polygon> all = footprints_of(city, buildings);
  if (buildings.size() < 2) return all;
  constexpr double kLeastPiece = 0.01, kClearance = 0.02;  // m², m
  return geometry::unite(all, kLeastPiece, kClearance).polygons;
}

RoofSurfaces roofs_of(const City& city, std::span<const std::uint32_t> buildings) {
  RoofSurfaces roof;
  for (const std::uint32_t b : buildings)
    for (const Face& f : city.buildings[b].faces)
      if (f.hull == Hull::roof || f.hull == Hull::outer_floor) roof.add(f.rings);
  return roof;
}

RoofForm form_of_planes(const RoofPlanes& planes) {
  constexpr double kMostlyFlat = 0.2, kOpposite = 30;  // share, degrees
  if (planes.sloped < kMostlyFlat) return RoofForm::flat;
  if (planes.two_pitches) return RoofForm::mansard;
  const auto between = [](double a, double b) { return std::fabs(std::remainder(a - b, 360.0)); };
  const std::vector<double>& d = planes.directions;
  if (d.size() == 1) return RoofForm::shed;
  if (d.size() == 2) return between(d[0], d[1]) >= 180 - kOpposite ? RoofForm::gabled : RoofForm::complex;
  if (d.size() > 4 || d.empty()) return RoofForm::complex;
  for (std::size_t i = 0; i < d.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const double angle = between(d[i], d[k]);
      if (std::fabs(angle - 90) > kOpposite && angle < 180 - kOpposite) return RoofForm::complex;
    }
  return RoofForm::hipped;
}

}  // namespace

geometry::PlanShape plan_of(const City& city, std::span<const std::uint32_t> buildings) {
  const std::vector<Polygon> all = footprints_of(city, buildings);
  return all.empty() ? geometry::PlanShape() : geometry::PlanShape(all);
}

std::optional<double> volume_of(const Building& b) {
  double volume = 0;
  bool closed = !b.shells.empty() && b.all_in_shells;
  for (const Shell& shell : b.shells) {
    Enclosed sum;
    for (const Rings3& rings : shell.polygons) sum.add(rings, base_of(shell.polygons[0]));
    closed = closed && sum.closed();
    volume += shell.outer ? std::fabs(sum.volume) : -std::fabs(sum.volume);
  }
  if (closed) return volume > 0 ? std::optional(volume) : std::nullopt;
  if (b.faces.empty()) return std::nullopt;
  const Point3 base = base_of(b.faces[0].rings);
  Enclosed sum;
  for (const Face& f : b.faces) sum.add(f.rings, base);
  if (!sum.closed())
    for (const Opening& o : b.openings)
      for (const Rings3& rings : o.polygons) sum.add(rings, base);
  if (!sum.closed() || std::fabs(sum.volume) <= 0) return std::nullopt;
  return std::fabs(sum.volume);
}

std::string shell_defect(const Shell& shell) {
  model::Solid solid;
  std::map<geometry::Grid3, std::uint32_t> index;
  const Point3 origin = shell.polygons.empty() ? Point3{} : model::snap(shell.polygons[0][0][0]);
  for (const Rings3& rings : shell.polygons) {
    model::Face face;
    face.first_loop = static_cast<std::uint32_t>(solid.loops.size());
    for (const auto& ring : rings) {
      model::Solid::Loop loop{static_cast<std::uint32_t>(solid.indices.size()), 0};
      for (const Point3& p : ring) {
        const Point3 at = model::snap(p - origin);
        const auto [entry, fresh] =
            index.emplace(geometry::to_grid(at), static_cast<std::uint32_t>(solid.vertices.size()));
        if (fresh) solid.vertices.push_back(at);
        // Points that the grid makes one were a rounding error apart.
        if (loop.count > 0 && solid.indices.back() == entry->second) continue;
        solid.indices.push_back(entry->second);
        ++loop.count;
      }
      while (loop.count > 1 && solid.indices.back() == solid.indices[loop.first]) {
        solid.indices.pop_back();
        --loop.count;
      }
      if (loop.count == 0) continue;
      solid.loops.push_back(loop);
      ++face.loop_count;
    }
    if (face.loop_count == 0) continue;
    // A polygon that shrinks to a line on the grid encloses nothing.
    if (face.loop_count == 1 && solid.loops.back().count < 3) {
      solid.indices.resize(solid.loops.back().first);
      solid.loops.pop_back();
      continue;
    }
    solid.faces.push_back(face);
  }
  const geometry::SolidCheck check = geometry::check_solid(solid);
  if (check.valid() || (!shell.outer && check.defect == geometry::SolidDefect::inside_out)) return "";
  return fmt::format("{} {}", check.code(), geometry::name(check.defect));
}

SideFacts side_facts(const City& city, std::span<const std::uint32_t> buildings) {
  SideFacts out;
  out.buildings.assign(buildings.begin(), buildings.end());
  out.footprint_area = plan_of(city, buildings).area();
  bool has_volume = true;
  double volume = 0;
  for (const std::uint32_t i : buildings) {
    const Building& b = city.buildings[i];
    for (const Face& f : b.faces) {
      out.surface_area += f.area;
      out.area_of[static_cast<std::size_t>(f.hull)] += f.area;
      if (!f.stated) out.unclassified_area += f.area;
    }
    if (!b.footprint.empty() || !b.faces.empty()) out.ground = out.ground ? std::min(*out.ground, b.ground) : b.ground;
    if (const auto v = volume_of(b))
      volume += *v;
    else
      has_volume = false;
    for (const Shell& shell : b.shells) {
      ++out.solids;
      const std::string defect = shell_defect(shell);
      if (defect.empty())
        ++out.valid_solids;
      else
        ++out.defects[defect];
    }
    out.openings += b.openings.size();
    out.triangles += b.triangles;
  }
  if (has_volume) out.volume = volume;
  if (out.ground)
    if (const auto heights = heights_of(roofs_of(city, buildings), outline_of(city, buildings), *out.ground)) {
      out.eaves = heights->eaves;
      out.ridge = heights->ridge;
      out.roof_volume = heights->mean * out.footprint_area * heights->cover;
    }
  return out;
}

void tell_roofs(const City& model, SideFacts& model_side, const City& reference, SideFacts& reference_side) {
  const auto points =
      common_grid(footprints_of(model, model_side.buildings), footprints_of(reference, reference_side.buildings));
  if (points.empty()) return;
  for (auto [city, side] : {std::pair(&model, &model_side), std::pair(&reference, &reference_side)}) {
    const RoofSurfaces roof = roofs_of(*city, side->buildings);
    if (roof.empty()) continue;
    const RoofPlanes planes = form_of(roof, points);
    if (planes.seen < 0.5) continue;  // half a roof has no form
    side->roof_form = form_of_planes(planes);
    if (planes.sloped > 0 && side->roof_form != RoofForm::flat) side->pitch = planes.pitch;
    if (side->roof_form == RoofForm::gabled) side->fall = planes.directions[0];
  }
}

void measure_bodies(const City& model, const SideFacts& a, const City& reference, const SideFacts& b, bool absolute,
                    MeasureValues& values) {
  const auto set = [&](Measure m, double value, double weight = 1) {
    MeasureValue& v = values[static_cast<std::size_t>(m)];
    v.counted = v.all = value;
    v.weight = v.weight_all = weight;
  };
  const geometry::PlanShape plan_a = plan_of(model, a.buildings), plan_b = plan_of(reference, b.buildings);
  if (!plan_a.empty() && !plan_b.empty()) {
    const double common = plan_a.common_area(plan_b), together = plan_a.area() + plan_b.area() - common;
    set(Measure::footprint_iou, common / together, together);
    set(Measure::area_ratio, plan_a.area() / plan_b.area(), plan_b.area());
    set(Measure::outline_distance, plan_a.outline_distance(plan_b));
    const Point2 c = plan_a.centroid(), d = plan_b.centroid();
    set(Measure::offset_east, c.x - d.x);
    set(Measure::offset_north, c.y - d.y);
  }
  if (absolute && a.ground && b.ground) set(Measure::base_error, *a.ground - *b.ground);
  if (a.eaves && b.eaves) set(Measure::eaves_error, *a.eaves - *b.eaves);
  if (a.ridge && b.ridge) set(Measure::ridge_error, *a.ridge - *b.ridge);
  if (a.volume && b.volume) set(Measure::volume_ratio, *a.volume / *b.volume, *b.volume);
  if (a.roof_volume && b.roof_volume && *b.roof_volume > 0)
    set(Measure::roof_volume_ratio, *a.roof_volume / *b.roof_volume, *b.roof_volume);
  if (a.roof_form != RoofForm::none && b.roof_form != RoofForm::none)
    set(Measure::roof_type_agrees, a.roof_form == b.roof_form ? 1 : 0);
  constexpr double kSameRidge = 30;  // degrees
  if (a.fall && b.fall)
    set(Measure::ridge_agrees, std::fabs(std::remainder(*a.fall - *b.fall, 180.0)) <= kSameRidge ? 1 : 0);
  if (a.pitch && b.pitch) set(Measure::roof_pitch_error, *a.pitch - *b.pitch);
  if (a.surface_area > 0) set(Measure::semantic_model, 1 - a.unclassified_area / a.surface_area, a.surface_area);
  if (b.surface_area > 0) set(Measure::semantic_reference, 1 - b.unclassified_area / b.surface_area, b.surface_area);
  const auto share = [](std::size_t part, std::size_t whole) {
    return static_cast<double>(part) / static_cast<double>(whole);
  };
  if (a.solids > 0) set(Measure::valid_model, share(a.valid_solids, a.solids), static_cast<double>(a.solids));
  if (b.solids > 0) set(Measure::valid_reference, share(b.valid_solids, b.solids), static_cast<double>(b.solids));
  set(Measure::triangles_model, static_cast<double>(a.triangles));
  set(Measure::triangles_reference, static_cast<double>(b.triangles));
}

}  // namespace blockrand::compare
