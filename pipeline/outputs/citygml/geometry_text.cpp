#include "pipeline/outputs/citygml/geometry_text.h"

#include <array>
#include <cmath>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

constexpr std::string_view kSurfaceNames[model::kSurfaceKindCount] = {
    "GroundSurface",     "WallSurface",    "RoofSurface", "OuterCeilingSurface",
    "OuterFloorSurface", "ClosureSurface", "Window",      "Door"};

void append_id(std::string& out, std::string_view id, const char* kind, std::size_t number) {
  out += id;
  out += kind;
  append_number(out, static_cast<std::int64_t>(number));
}

}  // namespace

void append_polygon_id(std::string& out, std::string_view id, std::size_t face) { append_id(out, id, "_p", face); }
void append_detail_polygon_id(std::string& out, std::string_view id, std::size_t face) {
  append_id(out, id, "_q", face);
}

void append_wall_id(std::string& out, std::string_view id, std::size_t face) { append_id(out, id, "_m", face); }

bool is_shared_face(const model::Solid& lod2, const model::Solid& lod3, std::size_t face) {
  if (!geometry::same_face(lod2, lod3, face)) return false;
  const model::Face &a = lod2.faces[face], &b = lod3.faces[face];
  return a.material == b.material && a.colour == b.colour;
}

std::vector<std::vector<std::size_t>> reveals_by_wall(const model::Solid& lod2, const model::Detail& detail) {
  std::vector<std::vector<std::size_t>> out(std::max(lod2.faces.size(), detail.solid.faces.size()));
  for (const model::Opening& opening : detail.openings) {
    if (opening.kind == model::OpeningKind::passage) continue;
    for (std::uint32_t i = 0; i < opening.reveal_count; ++i) out[opening.wall].push_back(opening.first_reveal + i);
  }
  return out;
}

void GeometryText::ring(const model::Ring& plan, bool counter_clockwise, std::string_view z) {
  model::Ring ring = plan;
  geometry::orient(ring, counter_clockwise);
  out_ += "<LinearRing><posList>";
  for (std::size_t i = 0; i <= ring.points.size(); ++i) {
    const model::Point2& p = ring.points[i == ring.points.size() ? 0 : i];
    if (i) out_ += ' ';
    append_grid(out_, p.x);
    out_ += ' ';
    append_grid(out_, p.y);
    out_ += ' ';
    out_ += z;
  }
  out_ += "</posList></LinearRing>";
}

void GeometryText::footprint(const model::Polygon& plan, double z) {
  std::string height;
  append_grid(height, z);
  out_ += "<Polygon><exterior>";
  ring(plan.outer, true, height);
  out_ += "</exterior>";
  for (const model::Ring& hole : plan.holes) {
    out_ += "<interior>";
    ring(hole, false, height);
    out_ += "</interior>";
  }
  out_ += "</Polygon>";
}

void GeometryText::load_vertices(const model::Solid& solid) {
  vertex_text_.clear();
  vertex_ends_.assign(1, 0);
  for (const model::Point3& p : solid.vertices) {
    append_grid(vertex_text_, p.x);
    vertex_text_ += ' ';
    append_grid(vertex_text_, p.y);
    vertex_text_ += ' ';
    append_grid(vertex_text_, p.z);
    vertex_ends_.push_back(static_cast<std::uint32_t>(vertex_text_.size()));
  }
}

void GeometryText::polygon(const model::Solid& solid, std::size_t face, std::string_view id, Mark mark) {
  out_ += kPolygonBegin;
  if (mark != Mark::none) {
    out_ += " gml:id=\"";
    append_id(out_, id, mark == Mark::detail ? "_q" : "_p", face);
    out_ += '"';
  }
  out_ += '>';
  bool outer = true;
  for (const model::Solid::Loop& loop : solid.loops_of(solid.faces[face])) {
    out_ += outer ? kExteriorBegin : kInteriorBegin;
    const std::span<const std::uint32_t> indices = solid.indices_of(loop);
    for (std::size_t i = 0; i <= indices.size(); ++i) {
      const std::uint32_t v = indices[i == indices.size() ? 0 : i];
      if (i) out_ += ' ';
      out_.append(vertex_text_, vertex_ends_[v], vertex_ends_[v + 1] - vertex_ends_[v]);
    }
    out_ += outer ? kExteriorEnd : kInteriorEnd;
    outer = false;
  }
  out_ += kPolygonEnd;
}

void GeometryText::reference(std::string_view id, std::size_t face, Mark mark) {
  out_ += "<surfaceMember xlink:href=\"#";
  append_id(out_, id, mark == Mark::detail ? "_q" : "_p", face);
  out_ += "\"/>\n";
}

void GeometryText::begin_solid(std::string_view solid_id, bool closed) {
  out_ += closed ? "<Solid gml:id=\"" : "<MultiSurface gml:id=\"";
  out_ += solid_id;
  out_ += closed ? "\"><exterior><CompositeSurface>\n" : "\">\n";
}

void GeometryText::end_solid(bool closed) {
  out_ += closed ? "</CompositeSurface></exterior></Solid>" : "</MultiSurface>";
}

void GeometryText::solid(const model::Solid& solid, std::string_view solid_id, std::string_view id) {
  load_vertices(solid);
  begin_solid(solid_id, solid.closed);
  for (std::size_t f = 0; f < solid.faces.size(); ++f) polygon(solid, f, id, id.empty() ? Mark::none : Mark::polygon);
  end_solid(solid.closed);
}

void GeometryText::rule_surfaces(const model::Solid& lod3, std::string_view surface_id, std::string_view id) {
  load_vertices(lod3);
  begin_solid(surface_id, false);
  for (std::size_t f = 0; f < lod3.faces.size(); ++f) polygon(lod3, f, id, Mark::detail);
  end_solid(false);
}

void GeometryText::solid_beside_detail(const model::Solid& lod2, const model::Solid& lod3, std::string_view solid_id,
                                       std::string_view id) {
  load_vertices(lod2);
  begin_solid(solid_id);
  for (std::size_t f = 0; f < lod2.faces.size(); ++f)
    if (is_shared_face(lod2, lod3, f))
      reference(id, f, Mark::polygon);
    else
      polygon(lod2, f, id, Mark::polygon);
  end_solid();
}

void GeometryText::detail_solid(const model::Solid& lod2, const model::Solid& lod3, std::string_view solid_id,
                                std::string_view id) {
  load_vertices(lod3);
  begin_solid(solid_id);
  for (std::size_t f = 0; f < lod3.faces.size(); ++f)
    polygon(lod3, f, id, is_shared_face(lod2, lod3, f) ? Mark::polygon : Mark::detail);
  end_solid();
}

void GeometryText::open_surface(std::string_view name, std::string_view id, std::size_t face, const char* kind) {
  out_ += "<bldg:boundedBy><bldg:";
  out_ += name;
  out_ += " gml:id=\"";
  append_id(out_, id, kind, face);
  out_ += "\">";
}

void GeometryText::close_surface(std::string_view name) {
  out_ += "</bldg:";
  out_ += name;
  out_ += "></bldg:boundedBy>\n";
}

/// A property of one polygon.
void GeometryText::single_surface(std::string_view property, std::string_view id, std::size_t face, Mark mark) {
  out_ += "<bldg:";
  out_ += property;
  out_ += "><MultiSurface>";
  reference(id, face, mark);
  out_ += "</MultiSurface></bldg:";
  out_ += property;
  out_ += ">";
}

void GeometryText::surface_group(std::string_view property, std::string_view id, const std::vector<std::size_t>& faces,
                                 Mark mark) {
  out_ += "<bldg:";
  out_ += property;
  out_ += "><MultiSurface>\n";
  for (const std::size_t f : faces) reference(id, f, mark);
  out_ += "</MultiSurface></bldg:";
  out_ += property;
  out_ += ">";
}

void GeometryText::surfaces_of_rules(const model::Detail& detail, std::string_view id) {
  std::size_t number = 0;
  for (const model::RuleFaces& rule : detail.rules) {
    std::array<std::vector<std::size_t>, model::kSurfaceKindCount> faces;
    for (std::size_t f = rule.first; f < rule.first + rule.count; ++f)
      faces[static_cast<std::size_t>(detail.solid.faces[f].kind)].push_back(f);
    for (std::size_t kind = 0; kind < faces.size(); ++kind) {
      if (faces[kind].empty()) continue;
      open_surface(kSurfaceNames[kind], id, number++, "_r");
      out_ += "<gml:name>";
      append_xml(out_, rule.rule);
      out_ += "</gml:name>";
      surface_group("lod3MultiSurface", id, faces[kind], Mark::detail);
      close_surface(kSurfaceNames[kind]);
    }
  }
}

void GeometryText::surfaces(const model::Solid& solid, std::string_view id) {
  if (!solid.closed) {
    std::array<std::vector<std::size_t>, model::kSurfaceKindCount> faces;
    for (std::size_t f = 0; f < solid.faces.size(); ++f)
      faces[static_cast<std::size_t>(solid.faces[f].kind)].push_back(f);
    std::size_t number = 0;
    for (std::size_t kind = 0; kind < faces.size(); ++kind) {
      if (faces[kind].empty()) continue;
      open_surface(kSurfaceNames[kind], id, number++);
      surface_group("lod2MultiSurface", id, faces[kind], Mark::polygon);
      close_surface(kSurfaceNames[kind]);
    }
    return;
  }
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    const std::string_view name = kSurfaceNames[static_cast<std::size_t>(solid.faces[f].kind)];
    open_surface(name, id, f);
    single_surface("lod2MultiSurface", id, f, Mark::polygon);
    close_surface(name);
  }
}

void GeometryText::surfaces(const model::Solid& lod2, const model::Detail& detail, std::string_view id,
                            const SurfaceText& text) {
  const model::Solid& lod3 = detail.solid;
  const std::vector<std::vector<std::size_t>> reveals = reveals_by_wall(lod2, detail);
  std::vector<std::vector<std::size_t>> openings(lod3.faces.size());  // by wall
  std::vector<bool> written(lod3.faces.size(), false);
  for (std::size_t o = 0; o < detail.openings.size(); ++o)
    if (detail.openings[o].kind != model::OpeningKind::passage) openings[detail.openings[o].wall].push_back(o);
  // Dormers' fronts are no faces of LoD2; they come before reveals, which so are written with their walls.
  for (std::size_t f = 0; f < lod3.faces.size(); ++f) {
    if (written[f]) continue;
    const std::string_view name = kSurfaceNames[static_cast<std::size_t>(lod3.faces[f].kind)];
    open_surface(name, id, f);
    text.wall(f);
    if (f < lod2.faces.size()) {
      single_surface("lod2MultiSurface", id, f, Mark::polygon);
      out_ += '\n';
    }
    written[f] = true;
    if (f >= lod2.faces.size() && openings[f].empty()) {
      single_surface("lod3MultiSurface", id, f, Mark::detail);
    } else if (f < lod2.faces.size() && is_shared_face(lod2, lod3, f)) {
      single_surface("lod3MultiSurface", id, f, Mark::polygon);
    } else {
      out_ += "<bldg:lod3MultiSurface><MultiSurface gml:id=\"";
      append_wall_id(out_, id, f);
      out_ += "\">";
      reference(id, f, Mark::detail);
      for (const std::size_t reveal : reveals[f]) {
        reference(id, reveal, Mark::detail);
        written[reveal] = true;
      }
      out_ += "</MultiSurface></bldg:lod3MultiSurface>\n";
    }
    for (const std::size_t o : openings[f]) {
      const std::size_t face = detail.openings[o].polygon;
      const std::string_view kind = kSurfaceNames[static_cast<std::size_t>(lod3.faces[face].kind)];
      out_ += "<bldg:opening><bldg:";
      out_ += kind;
      out_ += " gml:id=\"";
      append_id(out_, id, "_s", face);
      out_ += "\">";
      text.opening(o);
      single_surface("lod3MultiSurface", id, face, Mark::detail);
      text.inside(o);
      out_ += "</bldg:";
      out_ += kind;
      out_ += "></bldg:opening>\n";
      written[face] = true;
    }
    close_surface(name);
  }
}

void GeometryText::multi_surface(const model::Solid& solid, std::string_view id, bool polygon_ids) {
  load_vertices(solid);
  out_ += "<MultiSurface gml:id=\"";
  append_wall_id(out_, id, 0);
  out_ += "\">";
  for (std::size_t f = 0; f < solid.faces.size(); ++f) polygon(solid, f, id, polygon_ids ? Mark::polygon : Mark::none);
  out_ += "</MultiSurface>";
}

}  // namespace blockrand::outputs
