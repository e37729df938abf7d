#include "pipeline/export/citygml/geometry_text.h"

#include "pipeline/export/text.h"

namespace blockrand::export_ {
namespace {

constexpr std::string_view kSurfaceNames[model::kSurfaceKindCount] = {
    "GroundSurface",       "WallSurface",    "RoofSurface", "OuterCeilingSurface",
    "OuterFloorSurface",   "ClosureSurface", "Window",      "Door"};

void append_id(std::string& out, std::string_view id, const char* kind, std::size_t number) {
  out += id;
  out += kind;
  append_number(out, static_cast<std::int64_t>(number));
}

}  // namespace

void append_polygon_id(std::string& out, std::string_view id, std::size_t face) { append_id(out, id, "_p", face); }

void GeometryText::ring(const model::Ring& ring, std::string_view z) {
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
  ring(plan.outer, height);
  out_ += "</gml:exterior>";
  for (const model::Ring& hole : plan.holes) {
    out_ += "<gml:interior>";
    ring(hole, height);
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

void GeometryText::polygon(const model::Solid& solid, const model::Face& face, std::string_view id,
                           std::size_t number) {
  out_ += "<gml:Polygon";
  if (!id.empty()) {
    out_ += " gml:id=\"";
    append_polygon_id(out_, id, number);
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

void GeometryText::surfaces(const model::Solid& solid, std::string_view id) {
  load_vertices(solid);
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    const std::string_view name = kSurfaceNames[static_cast<std::size_t>(solid.faces[f].kind)];
    out_ += "<bldg:boundedBy><bldg:";
    out_ += name;
    out_ += " gml:id=\"";
    append_id(out_, id, "_s", f);
    out_ += "\"><bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember>";
    polygon(solid, solid.faces[f], id, f);
    out_ += "</gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:";
    out_ += name;
    out_ += "></bldg:boundedBy>\n";
  }
}

}  // namespace blockrand::export_
