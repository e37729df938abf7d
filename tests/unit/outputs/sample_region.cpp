#include "tests/unit/outputs/sample_region.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace blockrand::outputs::test {
namespace {

using model::Face;
using model::Point2;
using model::Point3;
using model::Solid;
using model::SolidTriangles;
using model::SurfaceKind;

model::Ring ring(std::vector<Point2> points) {
  model::Ring r;
  r.nodes.assign(points.size(), 0);
  r.points = std::move(points);
  return r;
}

model::Polygon rectangle(double x, double y, double width, double depth) {
  return {ring({{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}}), {}};
}

class SolidMaker {
 public:
  std::uint32_t vertex(double x, double y, double z) {
    const Point3 p = model::snap(Point3{x, y, z});
    const auto found = std::find(solid.vertices.begin(), solid.vertices.end(), p);
    if (found != solid.vertices.end()) return static_cast<std::uint32_t>(found - solid.vertices.begin());
    solid.vertices.push_back(p);
    return static_cast<std::uint32_t>(solid.vertices.size()) - 1;
  }
  void face(SurfaceKind kind, std::uint8_t material, model::Colour colour,
            const std::vector<std::vector<std::uint32_t>>& loops,
            const std::vector<std::array<std::uint32_t, 3>>& faces_triangles) {
    Face f;
    f.kind = kind;
    f.material = material;
    f.colour = colour;
    f.first_loop = static_cast<std::uint32_t>(solid.loops.size());
    f.loop_count = static_cast<std::uint32_t>(loops.size());
    for (const auto& loop : loops) {
      solid.loops.push_back(
          {static_cast<std::uint32_t>(solid.indices.size()), static_cast<std::uint32_t>(loop.size())});
      solid.indices.insert(solid.indices.end(), loop.begin(), loop.end());
    }
    solid.faces.push_back(f);
    triangles.first.push_back(static_cast<std::uint32_t>(triangles.triangles.size()));
    triangles.triangles.insert(triangles.triangles.end(), faces_triangles.begin(), faces_triangles.end());
  }
  void convex_face(SurfaceKind kind, std::uint8_t material, model::Colour colour,
                   const std::vector<std::uint32_t>& loop) {
    std::vector<std::array<std::uint32_t, 3>> fan;
    for (std::size_t i = 2; i < loop.size(); ++i) fan.push_back({loop[0], loop[i - 1], loop[i]});
    face(kind, material, colour, {loop}, fan);
  }
  std::pair<Solid, SolidTriangles> done() {
    triangles.first.push_back(static_cast<std::uint32_t>(triangles.triangles.size()));
    return {std::move(solid), std::move(triangles)};
  }
  Solid solid;
  SolidTriangles triangles;
};

constexpr model::Colour kWall{222, 205, 170}, kRoof{160, 60, 40}, kGround{90, 90, 90};

}  // namespace

std::pair<Solid, SolidTriangles> prism(const model::Polygon& plan, double base, double top) {
  SolidMaker m;
  const std::vector<Point2>& outer = plan.outer.points;
  const std::size_t n = outer.size();
  std::vector<std::uint32_t> low, high, low_reversed;
  for (const Point2& p : outer) {
    low.push_back(m.vertex(p.x, p.y, base));
    high.push_back(m.vertex(p.x, p.y, top));
  }
  low_reversed.assign(low.rbegin(), low.rend());
  if (plan.holes.empty()) {
    m.convex_face(SurfaceKind::ground, 0, kGround, low_reversed);
    m.convex_face(SurfaceKind::roof, 1, kRoof, high);
  } else {
    const std::vector<Point2>& hole = plan.holes.front().points;  // clockwise: hole[0] is beside outer[0]
    std::vector<std::uint32_t> hole_low, hole_high;
    for (const Point2& p : hole) {
      hole_low.push_back(m.vertex(p.x, p.y, base));
      hole_high.push_back(m.vertex(p.x, p.y, top));
    }
    std::vector<std::array<std::uint32_t, 3>> up, down;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n, hi = (n - i) % n, hj = (n - j) % n;
      up.push_back({high[i], high[j], hole_high[hj]});
      up.push_back({high[i], hole_high[hj], hole_high[hi]});
      down.push_back({low[j], low[i], hole_low[hj]});
      down.push_back({hole_low[hj], low[i], hole_low[hi]});
    }
    m.face(SurfaceKind::ground, 0, kGround, {low_reversed, {hole_low.rbegin(), hole_low.rend()}}, down);
    m.face(SurfaceKind::roof, 1, kRoof, {high, hole_high}, up);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      m.convex_face(SurfaceKind::wall, 0, kWall, {hole_low[i], hole_low[j], hole_high[j], hole_high[i]});
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    m.convex_face(SurfaceKind::wall, 0, kWall, {low[i], low[j], high[j], high[i]});
  }
  return m.done();
}

std::pair<Solid, SolidTriangles> gable(double x, double y, double width, double depth, double base, double eaves,
                                       double ridge) {
  SolidMaker m;
  const auto a = m.vertex(x, y, base), b = m.vertex(x + width, y, base), c = m.vertex(x + width, y + depth, base),
             d = m.vertex(x, y + depth, base);
  const auto e = m.vertex(x, y, eaves), f = m.vertex(x + width, y, eaves), g = m.vertex(x + width, y + depth, eaves),
             h = m.vertex(x, y + depth, eaves);
  const auto r = m.vertex(x, y + depth / 2, ridge), s = m.vertex(x + width, y + depth / 2, ridge);
  m.convex_face(SurfaceKind::ground, 0, kGround, {a, d, c, b});
  m.convex_face(SurfaceKind::wall, 0, kWall, {a, b, f, e});
  m.convex_face(SurfaceKind::wall, 0, kWall, {b, c, g, s, f});
  m.convex_face(SurfaceKind::wall, 0, kWall, {c, d, h, g});
  m.convex_face(SurfaceKind::wall, 0, kWall, {d, a, e, r, h});
  m.convex_face(SurfaceKind::roof, 1, kRoof, {e, f, s, r});
  m.convex_face(SurfaceKind::roof, 1, kRoof, {r, s, g, h});
  return m.done();
}

SampleRegion::SampleRegion() : extract_(std::make_unique<model::Extract>()) {
  region_.tile = {15, 17600, 12900};
  region_.extract = extract_.get();
  region_.materials = {{"plaster", 0.9f, 0.0f}, {"roof_tiles", 0.8f, 0.0f}, {"metal", 0.4f, 1.0f}};
}

model::Range SampleRegion::tags(const TagList& list) {
  model::Range range{static_cast<std::uint32_t>(extract_->tags.size()), static_cast<std::uint32_t>(list.size())};
  for (const auto& [key, value] : list)
    extract_->tags.push_back({extract_->strings.intern(key), extract_->strings.intern(value)});
  return range;
}

model::Building& SampleRegion::add_building(std::int64_t id, const TagList& list) {
  model::Building building;
  building.osm = {model::OsmType::way, id};
  building.tags = tags(list);
  building.attributes.use = {"residential", model::Source::tag, 1.0f, 0};
  building.attributes.height = {9.5, model::Source::tag, 1.0f, 0};
  region_.buildings.push_back(std::move(building));
  return region_.buildings.back();
}

model::BuildingPart& SampleRegion::add_part(model::Building& building, const std::string& part_id,
                                            model::Polygon plan) {
  model::BuildingPart part;
  part.id = part_id;
  part.osm = building.osm;
  part.tags = building.tags;
  part.plan = std::move(plan);
  part.lod = 2;
  model::Attributes& a = part.attributes;
  a.use = {"apartments", model::Source::tag, 1.0f, 0};
  a.storeys = {3, model::Source::neighbours, 0.6f, 0};
  a.storey_height = {2.8, model::Source::preset, 0.5f, 0};
  a.height = {9.5, model::Source::implied, 0.75f, 0};
  a.min_height = {0, model::Source::default_, 0.9f, 0};
  a.roof_storeys = {1, model::Source::default_, 0.3f, 0};
  a.roof_height = {3, model::Source::geometry, 0.4f, 0};
  a.roof_shape = {model::RoofShape::gabled, model::Source::tag, 1.0f, 0};
  a.roof_orientation = {model::RoofOrientation::along, model::Source::default_, 0.5f, 0};
  a.ground_height = {34.25, model::Source::terrain, 0.8f, 0};
  a.plinth_height = {0.75, model::Source::terrain, 0.6f, 0};
  a.wall_colour = {{222, 205, 170}, model::Source::preset, 0.2f, 0};
  a.roof_colour = {{160, 60, 40}, model::Source::tag, 1.0f, 0};
  a.wall_material = {"plaster", model::Source::default_, 0.1f, 0};
  a.roof_material = {"roof_tiles", model::Source::default_, 0.1f, 0};
  a.eaves_height = {6.5, model::Source::implied, 0.4f, 0};
  a.roof_pitch = {35, model::Source::preset, 0.3f, 0};
  a.ground_floor_use = {"apartments", model::Source::preset, 0.6f, 0};
  a.construction_date = {"1862..1914", model::Source::geometry, 0.5f, 0};
  a.era = {"1840_1918", model::Source::geometry, 0.8f, 0};
  a.style = {"gruenderzeit", model::Source::geometry, 0.7f, 0};
  a.substyle = {"gz_mk_front", model::Source::preset, 0.6f, 0};
  building.parts.push_back(std::move(part));
  return building.parts.back();
}

model::BuildingPart& SampleRegion::add_box(model::Building& building, const std::string& part_id, double x, double y,
                                           double width, double depth, double base, double height) {
  return add_prism(building, part_id, rectangle(x, y, width, depth), base, height);
}

model::BuildingPart& SampleRegion::add_prism(model::Building& building, const std::string& part_id, model::Polygon plan,
                                             double base, double height) {
  model::BuildingPart& part = add_part(building, part_id, std::move(plan));
  std::tie(part.lod1, part.lod1_triangles) = prism(part.plan, base, base + height);
  part.lod2 = part.lod1;
  part.lod2_triangles = part.lod1_triangles;
  part.built_roof = model::RoofShape::flat;
  return part;
}

model::BuildingPart& SampleRegion::add_gable(model::Building& building, const std::string& part_id, double x, double y,
                                             double width, double depth, double base, double eaves, double ridge) {
  model::BuildingPart& part = add_part(building, part_id, rectangle(x, y, width, depth));
  std::tie(part.lod1, part.lod1_triangles) = prism(part.plan, base, ridge);
  std::tie(part.lod2, part.lod2_triangles) = gable(x, y, width, depth, base, eaves, ridge);
  part.built_roof = model::RoofShape::gabled;
  return part;
}

model::BuildingPart& SampleRegion::add_courtyard(model::Building& building, const std::string& part_id, double x,
                                                 double y, double size, double court, double height) {
  model::Polygon plan = rectangle(x, y, size, size);
  const double a = (size - court) / 2, b = a + court;
  plan.holes.push_back(ring({{x + a, y + a}, {x + a, y + b}, {x + b, y + b}, {x + b, y + a}}));
  model::BuildingPart& part = add_part(building, part_id, std::move(plan));
  std::tie(part.lod1, part.lod1_triangles) = prism(part.plan, 34.25, 34.25 + height);
  part.lod2 = part.lod1;
  part.lod2_triangles = part.lod1_triangles;
  return part;
}

SampleRegion SampleRegion::zoo() {
  SampleRegion z;
  constexpr double x = 391000, y = 5819000;  // UTM coordinates of central Berlin
  {
    model::Building& b = z.add_building(
        -7, {{"building", "yes"}, {"name", "Zum \"Krokodil\" & <Söhne>"}, {"note", "two\nlines\tand a tab"}});
    z.add_box(b, b.id(), x, y, 10, 8, 34.25, 6).attributes.use = {"church", model::Source::implied, 0.5f, 1};
  }
  z.region().evidence.add({"the tag amenity=place_of_worship", {}});
  {
    model::Building& b = z.add_building(12, {{"building", "apartments"},
                                             {"addr:street", "Kastanienallee"},
                                             {"addr:housenumber", "12"},
                                             {"addr:postcode", "10435"},
                                             {"addr:city", "Berlin"},
                                             {"addr:country", "DE"},
                                             {"addr:suburb", "Prenzlauer Berg"},
                                             {"start_date", "1904"},
                                             {"description", "]]> \xF0\x9F\x8F\xA0 'quoted'"}});
    z.add_gable(b, b.id(), x + 20.123, y + 3.456, 12.3, 9.7, 34.25, 40.5, 44.125).attributes.roof_direction =
        model::Sourced<double>{90, model::Source::tag, 1.0f, 0};
  }
  {
    model::Building& b = z.add_building(30, {{"building", "cathedral"}, {"name", "St. Marien"}});
    b.has_mapped_parts = true;
    model::BuildingPart& nave = z.add_gable(b, "w30.w31", x + 60, y, 30, 14, 34.25, 50, 58);
    nave.osm = {model::OsmType::way, 31};
    nave.tags = z.tags({{"building:part", "yes"}, {"roof:shape", "gabled"}});
    model::BuildingPart& tower = z.add_box(b, "w30.w32", x + 52, y + 3, 8, 8, 34.25, 40);
    tower.osm = {model::OsmType::way, 32};
    tower.tags = z.tags({{"building:part", "tower"}});
    tower.fallbacks = {model::IssueCode::roof_failed, model::IssueCode::roof_shape_adapted};
    z.add_box(b, "w30.rest", x + 60, y + 14, 5, 5, 34.25, 4);
  }
  {
    model::Building& b = z.add_building(40, {{"building", "yes"}, {"start_date", "about 1900"}});
    z.add_courtyard(b, b.id(), x, y + 40, 40, 20, 22);
  }
  {
    // Two pieces of one outline; the first has the building's id.
    model::Building& b = z.add_building(50, {{"building", "garages"}});
    z.add_box(b, "w50", x + 60, y + 40, 6, 3, 34.25, 2.5);
    model::BuildingPart& second = z.add_box(b, "w50.2", x + 70, y + 40, 6, 3, 34.25, 2.5);
    second.lod = 1;
    second.lod2 = {};
    second.lod2_triangles = {};
    second.fallbacks = {model::IssueCode::lod1_only};
  }
  {
    model::Building& b = z.add_building(60, {{"building", "yes"}});
    model::BuildingPart& part = z.add_box(b, b.id(), x + 80, y + 40, 6, 3, 34.25, 2.5);
    part.lod = 0;
    part.lod1 = part.lod2 = {};
    part.lod1_triangles = part.lod2_triangles = {};
  }
  {
    model::Building& b = z.add_building(70, {{"building", "yes"}});
    b.owned = false;
    z.add_box(b, b.id(), x + 900, y + 900, 10, 8, 34.25, 6);
  }
  return z;
}

SampleRegion SampleRegion::settlement(int count, bool with_tags) {
  SampleRegion s;
  for (int i = 0; i < count; ++i) {
    TagList list;
    if (with_tags)
      list = {{"building", "house"},      {"addr:street", "Am Anger"}, {"addr:housenumber", std::to_string(i + 1)},
              {"addr:postcode", "13595"}, {"addr:city", "Berlin"},     {"building:levels", "2"},
              {"roof:shape", "gabled"}};
    model::Building& b = s.add_building(1000 + i, list);
    const double x = 391000 + (i % 20) * 25.3, y = 5819000 + (i / 20) * 21.7;
    s.add_gable(b, b.id(), x, y, 11.2, 9.1, 34.25, 40.25 + (i % 7) * 0.3, 44.5 + (i % 5) * 0.4);
  }
  return s;
}

}  // namespace blockrand::outputs::test
