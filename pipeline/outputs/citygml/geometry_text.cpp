#include "pipeline/outputs/citygml/geometry_text.h"

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

bool is_shared_face(const model::Solid& lod2, const model::Solid& lod3, std::size_t face) {
  return geometry::same_face(lod2, lod3, face);
}

void GeometryText::ring(const model::Ring& plan, bool counter_clockwise, std::string_view z) {
  model::Ring ring = plan;
  geometry::orient(ring, counter_clockwise);
  out_ += "<gml:LinearRing><gml:posList>";
  for (std::size_t i = 0; i <= ring.points.size(); ++i) {
    const model::Point2& p = ring.points[i == ring.points.size() ? 0 : i];
    if (i) out_ += ' ';
    append_grid(out_, p.x);
    out_ += ' ';
    append_grid(out_, p.y);
    out_ += ' ';
    out_ += z;
  }
  out_ += "</gml:posList></gml:LinearRing>";
}

void GeometryText::footprint(const model::Polygon& plan, double z) {
  std::string height;
  append_grid(height, z);
  out_ += "<gml:Polygon><gml:exterior>";
  ring(plan.outer, true, height);
  out_ += "</gml:exterior>";
  for (const model::Ring& hole : plan.holes) {
    out_ += "<gml:interior>";
    ring(hole, false, height);
    out_ += "</gml:interior>";
  }
  out_ += "</gml:Polygon>";
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

void GeometryText::polygon(const model::Solid& solid, const model::Face& face, std::string_view id, std::size_t number,
                           bool detail) {
  out_ += "<gml:Polygon";
  if (!id.empty()) {
    out_ += " gml:id=\"";
    append_id(out_, id, detail ? "_q" : "_p", number);
    out_ += '"';
  }
  out_ += '>';
  bool outer = true;
  for (const model::Solid::Loop& loop : solid.loops_of(face)) {
    out_ += outer ? "<gml:exterior><gml:LinearRing><gml:posList>" : "<gml:interior><gml:LinearRing><gml:posList>";
    const std::span<const std::uint32_t> indices = solid.indices_of(loop);
    for (std::size_t i = 0; i <= indices.size(); ++i) {
      const std::uint32_t v = indices[i == indices.size() ? 0 : i];
      if (i) out_ += ' ';
      out_.append(vertex_text_, vertex_ends_[v], vertex_ends_[v + 1] - vertex_ends_[v]);
    }
    out_ += outer ? "</gml:posList></gml:LinearRing></gml:exterior>" : "</gml:posList></gml:LinearRing></gml:interior>";
    outer = false;
  }
  out_ += "</gml:Polygon>";
}

void GeometryText::solid(const model::Solid& solid, std::string_view solid_id, bool polygon_ids) {
  load_vertices(solid);
  out_ += "<gml:Solid gml:id=\"";
  out_ += solid_id;
  out_ += "\"><gml:exterior><gml:CompositeSurface>\n";
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    out_ += "<gml:surfaceMember>";
    polygon(solid, solid.faces[f], polygon_ids ? solid_id : std::string_view{}, f);
    out_ += "</gml:surfaceMember>\n";
  }
  out_ += "</gml:CompositeSurface></gml:exterior></gml:Solid>";
}

void GeometryText::solid_of_references(const model::Solid& solid, std::string_view solid_id, std::string_view id) {
  out_ += "<gml:Solid gml:id=\"";
  out_ += solid_id;
  out_ += "\"><gml:exterior><gml:CompositeSurface>\n";
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    out_ += "<gml:surfaceMember xlink:href=\"#";
    append_polygon_id(out_, id, f);
    out_ += "\"/>\n";
  }
  out_ += "</gml:CompositeSurface></gml:exterior></gml:Solid>";
}

void GeometryText::open_surface(std::string_view name, std::string_view id, std::size_t face) {
  out_ += "<bldg:boundedBy><bldg:";
  out_ += name;
  out_ += " gml:id=\"";
  append_id(out_, id, "_s", face);
  out_ += "\">";
}

void GeometryText::surfaces(const model::Solid& solid, std::string_view id) {
  load_vertices(solid);
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    const std::string_view name = kSurfaceNames[static_cast<std::size_t>(solid.faces[f].kind)];
    open_surface(name, id, f);
    out_ += "<bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember>";
    polygon(solid, solid.faces[f], id, f);
    out_ += "</gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:";
    out_ += name;
    out_ += "></bldg:boundedBy>\n";
  }
}

void GeometryText::solid_of_detail(const model::Solid& lod2, const model::Solid& lod3, std::string_view solid_id,
                                   std::string_view id) {
  out_ += "<gml:Solid gml:id=\"";
  out_ += solid_id;
  out_ += "\"><gml:exterior><gml:CompositeSurface>\n";
  for (std::size_t f = 0; f < lod3.faces.size(); ++f) {
    out_ += "<gml:surfaceMember xlink:href=\"#";
    append_id(out_, id, is_shared_face(lod2, lod3, f) ? "_p" : "_q", f);
    out_ += "\"/>\n";
  }
  out_ += "</gml:CompositeSurface></gml:exterior></gml:Solid>";
}

void GeometryText::surfaces(const model::Solid& lod2, const model::Detail& detail, std::string_view id,
                            const std::function<void(std::size_t)>& implicit) {
  const model::Solid& lod3 = detail.solid;
  std::vector<std::vector<std::size_t>> openings(lod2.faces.size());  // by wall
  std::vector<bool> written(lod3.faces.size(), false);
  for (std::size_t o = 0; o < detail.openings.size(); ++o)
    if (detail.openings[o].kind != model::OpeningKind::passage) openings[detail.openings[o].wall].push_back(o);
  // LoD2's polygons first: their vertices are the first ones of LoD3, so that one table of texts serves both.
  load_vertices(lod3);
  for (std::size_t f = 0; f < lod2.faces.size(); ++f) {
    const std::string_view name = kSurfaceNames[static_cast<std::size_t>(lod2.faces[f].kind)];
    open_surface(name, id, f);
    out_ += "<bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember>";
    polygon(lod2, lod2.faces[f], id, f);
    out_ += "</gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface>\n";
    out_ += "<bldg:lod3MultiSurface><gml:MultiSurface><gml:surfaceMember";
    if (is_shared_face(lod2, lod3, f)) {
      out_ += " xlink:href=\"#";
      append_id(out_, id, "_p", f);
      out_ += "\"/>";
    } else {
      out_ += '>';
      polygon(lod3, lod3.faces[f], id, f, true);
      out_ += "</gml:surfaceMember>\n";
    }
    written[f] = true;
    for (const std::size_t o : openings[f]) {
      const model::Opening& opening = detail.openings[o];
      for (std::uint32_t i = 0; i < opening.reveal_count; ++i) {
        const std::size_t reveal = opening.first_reveal + i;
        out_ += "<gml:surfaceMember>";
        polygon(lod3, lod3.faces[reveal], id, reveal, true);
        out_ += "</gml:surfaceMember>\n";
        written[reveal] = true;
      }
    }
    out_ += "</gml:MultiSurface></bldg:lod3MultiSurface>\n";
    for (const std::size_t o : openings[f]) {
      const std::size_t face = detail.openings[o].polygon;
      const std::string_view kind = kSurfaceNames[static_cast<std::size_t>(lod3.faces[face].kind)];
      out_ += "<bldg:opening><bldg:";
      out_ += kind;
      out_ += " gml:id=\"";
      append_id(out_, id, "_s", face);
      out_ += "\"><bldg:lod3MultiSurface><gml:MultiSurface><gml:surfaceMember>";
      polygon(lod3, lod3.faces[face], id, face, true);
      out_ += "</gml:surfaceMember></gml:MultiSurface></bldg:lod3MultiSurface>\n";
      implicit(o);
      out_ += "</bldg:";
      out_ += kind;
      out_ += "></bldg:opening>\n";
      written[face] = true;
    }
    out_ += "</bldg:";
    out_ += name;
    out_ += "></bldg:boundedBy>\n";
  }
  for (std::size_t f = lod2.faces.size(); f < lod3.faces.size(); ++f) {
    if (written[f]) continue;
    const std::string_view name = kSurfaceNames[static_cast<std::size_t>(lod3.faces[f].kind)];
    open_surface(name, id, f);
    out_ += "<bldg:lod3MultiSurface><gml:MultiSurface><gml:surfaceMember>";
    polygon(lod3, lod3.faces[f], id, f, true);
    out_ += "</gml:surfaceMember></gml:MultiSurface></bldg:lod3MultiSurface></bldg:";
    out_ += name;
    out_ += "></bldg:boundedBy>\n";
  }
}

void GeometryText::multi_surface(const model::Solid& solid, std::string_view id) {
  load_vertices(solid);
  out_ += "<gml:MultiSurface>";
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    out_ += "<gml:surfaceMember>";
    polygon(solid, solid.faces[f], id, f);
    out_ += "</gml:surfaceMember>\n";
  }
  out_ += "</gml:MultiSurface>";
}

void GeometryText::multi_surface(const model::ElementMesh& mesh, std::string_view id) {
  out_ += "<gml:MultiSurface gml:id=\"";
  out_ += id;
  out_ += "\">";
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const model::ElementFace& face = mesh.faces[f];
    out_ += "<gml:surfaceMember><gml:Polygon gml:id=\"";
    append_id(out_, id, "_p", f);
    out_ += "\"><gml:exterior><gml:LinearRing><gml:posList>";
    for (std::uint32_t i = 0; i <= face.count; ++i) {
      const model::Point3& p = mesh.vertices[mesh.indices[face.first + (i == face.count ? 0 : i)]];
      if (i) out_ += ' ';
      // y up and z out of the wall become z up and y into it, which keeps the frame right-handed.
      append_four_decimals(out_, p.x);
      out_ += ' ';
      append_four_decimals(out_, 0.0 - p.z);
      out_ += ' ';
      append_four_decimals(out_, p.y);
    }
    out_ += "</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>\n";
  }
  out_ += "</gml:MultiSurface>";
}

}  // namespace blockrand::outputs
