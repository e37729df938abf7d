#include "tests/unit/compare/report_sample.h"

#include "pipeline/compare/summary.h"

namespace blockrand::compare::test {
namespace {

Face face(Hull hull, std::vector<Point3> ring, Point3 normal, double area) {
  Face f;
  f.hull = hull;
  f.rings = {std::move(ring)};
  f.normal = normal;
  f.area = area;
  return f;
}

/// A box of 10 x 8 m.
Building box(std::string id, double x, double ground, double height) {
  Building b;
  b.id = std::move(id);
  b.lod = 3;
  b.ground = ground;
  const double z = ground, t = ground + height;
  model::Polygon footprint;
  footprint.outer.points = {{x, 0}, {x + 10, 0}, {x + 10, 8}, {x, 8}};
  footprint.outer.nodes.assign(4, 0);
  b.footprint = {footprint};
  b.footprint_area = 80;
  b.faces = {face(Hull::ground, {{x, 8, z}, {x + 10, 8, z}, {x + 10, 0, z}, {x, 0, z}}, {0, 0, -1}, 80),
             face(Hull::wall, {{x, 0, z}, {x + 10, 0, z}, {x + 10, 0, t}, {x, 0, t}}, {0, -1, 0}, 10 * height),
             face(Hull::wall, {{x + 10, 0, z}, {x + 10, 8, z}, {x + 10, 8, t}, {x + 10, 0, t}}, {1, 0, 0}, 8 * height),
             face(Hull::wall, {{x + 10, 8, z}, {x, 8, z}, {x, 8, t}, {x + 10, 8, t}}, {0, 1, 0}, 10 * height),
             face(Hull::wall, {{x, 8, z}, {x, 0, z}, {x, 0, t}, {x, 8, t}}, {-1, 0, 0}, 8 * height),
             face(Hull::roof, {{x, 0, t}, {x + 10, 0, t}, {x + 10, 8, t}, {x, 8, t}}, {0, 0, 1}, 80)};
  return b;
}

void add_window(Building& b, double x) {
  Opening o;
  o.polygons = {
      {{{x + 2, 0, b.ground + 1}, {x + 3, 0, b.ground + 1}, {x + 3, 0, b.ground + 2.5}, {x + 2, 0, b.ground + 2.5}}}};
  o.area = 1.5;
  o.normal = {0, -1, 0};
  b.openings.push_back(o);
}

Facade front(std::size_t building, double x, double height) {
  Facade f;
  f.building = building;
  f.left = {x, 0};
  f.right = {x + 10, 0};
  f.top = height;
  f.area = 10 * height;
  f.outline = {{{{0, 0, 0}, {10, 0, 0}, {10, height, 0}, {0, height, 0}}}};
  f.openings = {{2, 3, 1, 2.5, 1.5, false, 0, 0}};
  f.storeys = f.axes = 1;
  return f;
}

SideFacts facts(const Building& b, std::uint32_t index, double height) {
  SideFacts s;
  s.buildings = {index};
  s.footprint_area = 80;
  s.surface_area = 160 + 36 * height;
  s.area_of[static_cast<std::size_t>(Hull::wall)] = 36 * height;
  s.area_of[static_cast<std::size_t>(Hull::roof)] = s.area_of[static_cast<std::size_t>(Hull::ground)] = 80;
  s.left_out[0] = 80 + 36 * height;
  s.left_out[static_cast<std::size_t>(LeftOut::ground)] = 80;
  s.ground = b.ground;
  s.eaves = s.ridge = height;
  s.volume = 80 * height;
  s.roof_form = RoofForm::flat;
  s.solids = s.valid_solids = 1;
  s.openings = b.openings.size();
  s.triangles = 12;
  return s;
}

}  // namespace

void set(MatchResult& match, Measure measure, double value) {
  MeasureValue& v = match.values[static_cast<std::size_t>(measure)];
  v.counted = v.all = value;
}

void sum_up(Comparison& c) {
  c.summaries = summarise(c.matches);
  c.model_total = total_of(c.matches, true);
  c.reference_total = total_of(c.matches, false);
}

Comparison sample(std::size_t matches) {
  Comparison c;
  for (City* city : {&c.model, &c.reference}) {
    city->name = city == &c.model ? "out/" : "survey/<a&b>.gml";
    city->crs = "EPSG:25832";
    city->origin = {500000, 5400000};
    city->height_reference = "unknown";
    city->files = {{city->name, "CityGML 2.0", "EPSG:25832", 1234, matches + 1, 2, {}}};
  }
  c.reference.files[0].notes = {{importers::reference::NoteKind::bad_id, 2, {"line 7: <\"1\">"}}};
  c.registration.matches = matches;
  c.registration.east = 0.25;
  c.registration.rule = "reported only";
  for (std::size_t i = 0; i < matches; ++i) {
    const double x = 30.0 * static_cast<double>(i), height = 9;
    Building model = box("w" + std::to_string(i), x, 0, height + 0.5),
             reference = box(i == 0 ? kNastyId : "r" + std::to_string(i), x, 34, height);
    MatchResult m;
    if (i == 0) {
      add_window(model, x);
      add_window(reference, x);
      reference.faces[3].left_out = LeftOut::blank;
      m.facades.model = {front(i, x, height + 0.5)};
      m.facades.reference = {front(i, x, height), front(i, x, height)};
      m.facades.reference[1].openings.clear();
      m.facades.reference[1].blank = true;
      m.facades.pairs = {{0, 0, {{0, 0}}}, {FacadePair::kNone, 1, {}, true}};
      c.blank_facades = 1;
    }
    m.id = reference.id;
    const auto index = static_cast<std::uint32_t>(i);
    m.model = facts(model, index, height + 0.5);
    m.reference = facts(reference, index, height);
    set(m, Measure::footprint_iou, 1);
    set(m, Measure::eaves_error, 0.5);
    set(m, Measure::distance_rms, 0.5 + static_cast<double>(i));
    m.values[static_cast<std::size_t>(Measure::distance_rms)].left_out = 0.2;
    if (i == 1) {
      m.model.volume = m.reference.volume = std::nullopt;
    } else {
      set(m, Measure::volume_ratio, 9.5 / 9);
      set(m, Measure::opening_recall, 1);
    }
    c.roof_confusion[0][0] += 1;
    c.model.buildings.push_back(std::move(model));
    c.reference.buildings.push_back(std::move(reference));
    c.matches.push_back(std::move(m));
  }
  const auto last = static_cast<std::uint32_t>(matches);
  c.model.buildings.push_back(box("w_extra", -40, 0, 5));
  c.reference.buildings.push_back(box("r_missing", -80, 34, 5));
  c.extra = c.missing = {last};
  c.missing_covered = {0.25};
  c.extra_covered = {0};
  c.distances = {{0.1, 0.5, 1, 5}, {0.2, 0.6, 0.9, 1}, {0.3, 0.7, 0.95, 1}, 2, 1};
  sum_up(c);
  return c;
}

std::vector<float> sample_distances(const MatchResult&, bool, std::span<const Point3> points) {
  std::vector<float> out;
  for (const Point3& p : points) out.push_back(static_cast<float>(p.z > 30 ? p.z - 34 : p.z) / 5);
  return out;
}

}  // namespace blockrand::compare::test
