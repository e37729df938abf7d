#include "pipeline/validate/citygml_reader.h"

#include <fmt/format.h>
#include <libxml/parser.h>
#include <libxml/xmlreader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "pipeline/geometry/solid_defect.h"
#include "pipeline/validate/attribute_names.h"
#include "pipeline/validate/citygml_names.h"
#include "pipeline/validate/citygml_parser.h"
#include "pipeline/validate/detail_check.h"
#include "pipeline/validate/ids.h"

namespace blockrand::validate {
namespace {

using geometry::SolidDefect;
using model::Point3;

constexpr double kLargestCoordinate = 1e9;  // m; beyond is no projected CRS
// Four decimals of a multiple of 1/1024 m are off by half a unit of the last one at most.
constexpr double kGridTolerance = 0.5001e-4;

std::string_view view(const xmlChar* text) { return text ? reinterpret_cast<const char*>(text) : std::string_view(); }

/// The value of an attribute of the element where the reader stands; empty where there is none.
std::string attribute(xmlTextReaderPtr reader, const char* name, std::string_view space = {}) {
  xmlChar* value = space.empty() ? xmlTextReaderGetAttribute(reader, reinterpret_cast<const xmlChar*>(name))
                                 : xmlTextReaderGetAttributeNs(reader, reinterpret_cast<const xmlChar*>(name),
                                                               reinterpret_cast<const xmlChar*>(space.data()));
  std::string text(view(value));
  xmlFree(value);
  return text;
}

std::string_view trimmed(std::string_view s) {
  constexpr std::string_view kSpace = " \n\t\r";
  const std::size_t first = s.find_first_not_of(kSpace);
  return first == std::string_view::npos ? std::string_view() : s.substr(first, s.find_last_not_of(kSpace) - first + 1);
}

/// The numbers of a list, or nothing where one is none.
std::optional<std::vector<double>> number_list(std::string_view text) {
  std::vector<double> out;
  const char *p = text.data(), *const end = p + text.size();
  while (true) {
    while (p < end && (*p == ' ' || *p == '\n' || *p == '\t' || *p == '\r')) ++p;
    if (p == end) return out;
    double value = 0;
    const auto [next, error] = std::from_chars(p, end, value);
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    out.push_back(value);
    p = next;
  }
}

}  // namespace

bool CityGmlParser::parse(xmlTextReaderPtr reader) {
  int status = 0;
  while ((status = xmlTextReaderRead(reader)) == 1) {
    switch (xmlTextReaderNodeType(reader)) {
      case XML_READER_TYPE_ELEMENT: {
        const bool empty = xmlTextReaderIsEmptyElement(reader) == 1;
        line_ = xmlTextReaderGetParserLineNumber(reader);
        start(reader);
        if (empty) end();
        break;
      }
      case XML_READER_TYPE_END_ELEMENT:
        end();
        break;
      case XML_READER_TYPE_TEXT:
      case XML_READER_TYPE_CDATA:
      case XML_READER_TYPE_SIGNIFICANT_WHITESPACE:
        text_ += view(xmlTextReaderConstValue(reader));
        break;
      case XML_READER_TYPE_DOCUMENT_TYPE:
        rule("a document type definition", "");
        break;
      default:
        break;
    }
  }
  if (status != 0) return false;
  finish();
  return true;
}

void CityGmlParser::start(xmlTextReaderPtr reader) {
  // Names live in the reader's dictionary as long as the reader.
  const std::string_view name = view(xmlTextReaderConstLocalName(reader)),
                         space = view(xmlTextReaderConstNamespaceUri(reader));
  text_.clear();
  const bool known = known_element(space, name);
  // What only has the name of one of ours must not end it.
  stack_.push_back(known && space != kAddress ? name : std::string_view());
  if (!known) rule(fmt::format("unexpected element {}", name), object());
  std::string id;
  if (xmlTextReaderHasAttributes(reader) == 1) {
    id = attribute(reader, "id", kGml);
    if (!id.empty() && !ids_.insert(id).second) rule("gml:id twice: " + id, id);
  }
  if (stack_.size() == 1 && (name != "CityModel" || space != kCore))
    rule("the root is no CityModel of CityGML 2.0", "");
  if (space == kGml)
    start_gml(reader, name, id);
  else if (space == kBuilding)
    start_building(name, id);
  else if (space == kCore)
    start_core(reader, name);
  else if (space == kGenerics && name.ends_with("Attribute"))
    attribute_ = attribute(reader, "name");
  else if (space == kGenerics && name == "value" && parent() == "measureAttribute" && attribute(reader, "uom").empty())
    rule(attribute_ + " has no unit", object());
  else if (space == kAppearance && name == "X3DMaterial")
    materials_.emplace_back();
}

void CityGmlParser::start_gml(xmlTextReaderPtr reader, std::string_view name, const std::string& id) {
  if (name == "Envelope") {
    out_.srs_name = attribute(reader, "srsName");
    if (attribute(reader, "srsDimension") != "3") rule("the envelope is not three-dimensional", "");
  } else if (name == "Solid") {
    const std::string_view property = parent();
    if (!body() || (property != "lod1Solid" && property != "lod2Solid" && property != "lod3Solid"))
      return rule("a solid that is nobody's", id);
    ReadSolid solid;
    solid.lod = property[3] - '0';
    body()->solids.push_back(std::move(solid));
    in_solid_ = true;
    solid_id_ = id;
  } else if (name == "MultiSurface" && body() && (parent() == "lod2MultiSurface" || parent() == "lod3MultiSurface") &&
             (parent(2) == "Building" || parent(2) == "BuildingPart")) {
    ReadSolid surfaces;
    surfaces.lod = parent()[3] - '0';
    surfaces.closed = false;
    body()->solids.push_back(std::move(surfaces));
    in_solid_ = true;
    solid_id_ = id;
    group_ids_.push_back(id);
  } else if (name == "surfaceMember") {
    const std::string href = attribute(reader, "href", kLink);
    if (href.empty()) return;
    if (href[0] != '#') return rule("a reference to another file: " + href, object());
    start_surface_member(href.substr(1));
  } else if (name == "MultiSurface") {
    start_multi_surface(id);
    group_ids_.push_back(id);
  } else if (name == "CompositeSurface") {
    group_ids_.push_back(id);
  } else if (name == "Polygon") {
    polygon_ = {};
    polygon_id_ = id;
    in_polygon_ = true;
  }
}

void CityGmlParser::start_surface_member(const std::string& href) {
  if (open_.empty()) return rule("a reference that is nobody's, to #" + href, "");
  Open& open = open_.back();
  note_link(href);
  if (in_solid_) {
    open.solids[static_cast<std::size_t>(body()->solids.back().lod)].push_back({href, true, {}});
  } else if (target_ == Target::surface || target_ == Target::detail_surface) {
    const bool detail = target_ == Target::detail_surface;
    open.surfaces[detail ? 3 : 2].push_back({href, opening_.empty() ? surface_ : opening_, open.boundary_surfaces});
    if (opening_.empty() || open.openings.empty()) return;
    OpenedWall& opening = open.openings.back();
    if (!opening.polygon.empty()) rule("has two polygons", opening.id);
    opening.polygon = href;
  } else if (target_ == Target::element && !elements_.empty()) {
    elements_.back().links.emplace_back(elements_.back().polygons.size(), href);
    elements_.back().polygons.emplace_back();
  } else {
    rule("a reference out of its place, to #" + href, object());
  }
}

void CityGmlParser::start_multi_surface(const std::string& id) {
  const std::string_view property = parent();
  target_ = property == "lod3MultiSurface"      ? Target::detail_surface
            : property == "lod3Geometry"        ? Target::installation
            : property == "relativeGMLGeometry" ? Target::element
            : surface_.empty()                  ? Target::footprint
                                                : Target::surface;
  if (target_ == Target::installation && body()) {
    body()->detail.installations.push_back({installation_, installation_kind_, {}});
  } else if (target_ == Target::element) {
    if (id.empty()) rule("the geometry of an element without a gml:id", object());
    element_ = id;
    element_at_.emplace(id, elements_.size());
    elements_.push_back({id, {}, {}});
  }
}

void CityGmlParser::start_core(xmlTextReaderPtr reader, std::string_view name) {
  if (name == "ImplicitGeometry") {
    element_.clear();
    matrix_.clear();
    reference_point_.reset();
  } else if (name == "relativeGMLGeometry") {
    const std::string href = attribute(reader, "href", kLink);
    if (href.empty()) return;
    if (href[0] != '#') return rule("a reference to another file: " + href, object());
    element_ = href.substr(1);
  }
}

void CityGmlParser::start_building(std::string_view name, const std::string& id) {
  if (name == "Building" || name == "BuildingPart") {
    const bool part = name == "BuildingPart";
    if (part != !open_.empty()) rule(fmt::format("{} out of its place", name), id);
    if (!(part ? is_body_id(id) : is_osm_id(id))) rule(fmt::format("\"{}\" is no id", id), id);
    ReadBody body;
    body.id = id;
    body.building = part && !open_.empty() ? out_.contents.bodies[open_.front().body].id : id;
    if (part && building_of(id) != body.building) rule(fmt::format("{} does not belong to {}", id, body.building), id);
    if (!open_.empty()) open_.front().has_parts = true;
    if (!part) out_.contents.buildings.push_back(id);
    // What the building before it, or a damaged one around it, was at is not its own.
    opening_.clear();
    surface_.clear();
    target_ = Target::footprint;
    in_solid_ = false;
    open_.emplace_back();
    open_.back().body = out_.contents.bodies.size();
    out_.contents.bodies.push_back(std::move(body));
  } else if (const std::string_view kind = surface_kind(name); !kind.empty() && parent() == "boundedBy") {
    surface_ = kind;
    if (!open_.empty()) ++open_.back().boundary_surfaces;
  } else if (const std::string_view opening = opening_kind(name); !opening.empty()) {
    if (parent() != "opening" || open_.empty() || surface_.empty())
      return rule(fmt::format("{} out of its place", name), id);
    opening_ = opening;
    open_.back().openings.push_back({id, open_.back().boundary_surfaces, {}, {}, {}});
  } else if (name == "BuildingInstallation") {
    if (parent() != "outerBuildingInstallation" || open_.empty()) rule("BuildingInstallation out of its place", id);
    in_installation_ = true;
    installation_ = id;
    installation_kind_.clear();
  }
}

void CityGmlParser::end() {
  const std::string_view name = stack_.back();
  if (name == "posList") {
    end_ring();
  } else if (name == "Polygon") {
    end_polygon();
  } else if (name == "Solid") {
    if (in_solid_ && open_.back().solids[static_cast<std::size_t>(body()->solids.back().lod)].empty())
      rule("a solid without faces", object());
    in_solid_ = false;
  } else if (name == "MultiSurface" || name == "CompositeSurface") {
    if (name == "MultiSurface" && in_solid_) in_solid_ = false;  // a body's own; solids hold none
    if (!group_ids_.empty()) group_ids_.pop_back();
  } else if (!surface_kind(name).empty() && parent() == "boundedBy") {
    surface_.clear();
  } else if (!opening_kind(name).empty()) {
    opening_.clear();
  } else if (name == "BuildingInstallation") {
    in_installation_ = false;
  } else if (name == "transformationMatrix") {
    matrix_ = number_list(text_).value_or(std::vector<double>{});
  } else if (name == "pos" && parent(2) == "referencePoint") {
    end_reference_point();
  } else if (name == "ImplicitGeometry") {
    if (body()) end_implicit();
  } else if (name == "Building" || name == "BuildingPart") {
    if (!open_.empty()) end_body();
  } else if (name == "lowerCorner" || name == "upperCorner") {
    end_corner(name == "lowerCorner");
  } else if (name == "value") {
    end_attribute();
  } else if (name == "diffuseColor") {
    if (!materials_.empty()) materials_.back().colour = colour(text_);
  } else if (name == "target") {
    const std::string_view target = trimmed(text_);
    if (target.size() < 2 || target[0] != '#')
      rule(fmt::format("an appearance with the target \"{}\"", target.substr(0, 40)), "");
    else if (!materials_.empty())
      materials_.back().targets.emplace_back(target.substr(1));
  } else if (!open_.empty()) {
    end_element(name);
  }
  stack_.pop_back();
  text_.clear();
}

void CityGmlParser::end_ring() {
  const auto values = number_list(text_);
  if (!values || values->size() % 3 != 0) return rule("coordinates that are no triples of numbers", object());
  std::vector<Point3> ring;
  double off = 0;
  for (std::size_t i = 0; i < values->size(); i += 3) {
    const Point3 p{(*values)[i], (*values)[i + 1], (*values)[i + 2]};
    if (std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) > kLargestCoordinate)
      return rule("a coordinate beyond any CRS", object());
    if (target_ == Target::element && !in_solid_) {  // in a frame of its own
      ring.push_back(p);
      continue;
    }
    const Point3 q = model::snap(p);
    off = std::max({off, std::fabs(p.x - q.x), std::fabs(p.y - q.y), std::fabs(p.z - q.z)});
    if (lower_ && upper_ &&
        (p.x < lower_->x || p.y < lower_->y || p.z < lower_->z || p.x > upper_->x || p.y > upper_->y ||
         p.z > upper_->z))
      outside_ = true;
    ring.push_back(q);
  }
  if (off > kGridTolerance)
    found(Check::off_grid, fmt::format("a coordinate lies {:.6f} m off the 1/1024 m grid", off), object());
  if (ring.size() < 4) return defect(SolidDefect::too_few_points);
  if (ring.front() != ring.back()) return defect(SolidDefect::ring_open);
  ring.pop_back();
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (ring[i] == ring[(i + 1) % ring.size()]) {
      defect(SolidDefect::same_points);
      break;
    }
  if (!in_polygon_) return rule("a ring outside of a polygon", object());
  if ((parent(2) == "exterior") != polygon_.rings.empty()) rule("rings out of order", object());
  polygon_.rings.push_back(std::move(ring));
}

void CityGmlParser::end_polygon() {
  in_polygon_ = false;
  if (!body()) return rule("a polygon that is nobody's", polygon_id_);
  if (polygon_.rings.empty()) return;  // its rings were found wanting
  if (in_solid_) {
    note_link(polygon_id_);
    open_.back().solids[static_cast<std::size_t>(body()->solids.back().lod)].push_back(
        {polygon_id_, false, std::move(polygon_)});
    return;
  }
  switch (target_) {
    case Target::surface:
    case Target::detail_surface:
      rule("a polygon of a boundary surface that is not in the solid: " + polygon_id_, object());
      break;
    case Target::installation: {
      auto& installations = body()->detail.installations;
      if (installations.empty()) return rule("a polygon of an installation that is nobody's", polygon_id_);
      note_place(polygon_id_,
                 {open_.back().body, kInstallation, installations.back().polygons.size(), installations.size() - 1});
      installations.back().polygons.push_back(std::move(polygon_));
      break;
    }
    case Target::element:
      if (elements_.empty()) return rule("a polygon of an element that is nobody's", polygon_id_);
      note_place(polygon_id_, {open_.back().body, kElement, elements_.back().polygons.size(), elements_.size() - 1});
      elements_.back().polygons.push_back(std::move(polygon_));
      break;
    case Target::footprint:
      note_place(polygon_id_, {open_.back().body, kFootprint, body()->footprint.size()});
      body()->footprint.push_back(std::move(polygon_));
      break;
  }
}

void CityGmlParser::end_reference_point() {
  const auto values = number_list(text_);
  if (!values || values->size() != 3) return;
  const Point3 p{(*values)[0], (*values)[1], (*values)[2]}, q = model::snap(p);
  const double off = std::max({std::fabs(p.x - q.x), std::fabs(p.y - q.y), std::fabs(p.z - q.z)});
  if (off > kGridTolerance)
    found(Check::off_grid, fmt::format("a reference point lies {:.6f} m off the 1/1024 m grid", off), object());
  reference_point_ = q;
}

void CityGmlParser::end_implicit() {
  if (!turns_about_the_vertical(matrix_))
    return rule("an implicit geometry whose matrix is no rotation about the vertical", object());
  if (!reference_point_) return rule("an implicit geometry without a reference point", object());
  if (element_.empty()) return rule("an implicit geometry without geometry", object());
  auto& placements = body()->detail.placements;
  if (!opening_.empty() && open_.back().openings.empty())
    rule("an element in an opening that is nobody's", object());
  else if (!opening_.empty())
    open_.back().openings.back().placement = placements.size();
  placed_.push_back({open_.back().body, placements.size(), element_});
  placements.push_back({0, *reference_point_, {matrix_[0], matrix_[4]}});
}

void CityGmlParser::end_corner(bool lower) {
  const auto values = number_list(text_);
  if (!values || values->size() != 3) return rule("the envelope's corner is no point", "");
  (lower ? lower_ : upper_) = Point3{(*values)[0], (*values)[1], (*values)[2]};
}

void CityGmlParser::end_attribute() {
  if (!body() || attribute_.empty()) return;
  if (attribute_ == "reveal_depth" && !surface_.empty()) return end_reveal_depth();
  const std::string_view type = parent();
  if (type != "stringAttribute") {
    const std::string number = number_text(trimmed(text_));
    if (number.empty() || (type == "intAttribute" && number.find_first_not_of("-0123456789") != std::string::npos))
      rule(fmt::format("{} {} is \"{}\"", type, attribute_, text_.substr(0, 40)), object());
    text_ = number;
  }
  // Tags and sentences are not compared; of a city they would fill the memory.
  if (!attribute_.starts_with("osm.") && !attribute_.ends_with("_evidence"))
    if (!body()->attributes.emplace(attribute_, text_).second) rule(attribute_ + " stands twice", object());
  attribute_.clear();
}

void CityGmlParser::end_reveal_depth() {
  attribute_.clear();
  const auto values = number_list(text_);
  if (!values || values->size() != 1 || !((*values)[0] >= 0 && (*values)[0] <= kDeepestReveal))
    return rule(fmt::format("a reveal_depth of \"{}\"", text_.substr(0, 40)), object());
  Open& open = open_.back();
  if (opening_.empty())
    open.depths[open.boundary_surfaces] = (*values)[0];
  else if (!open.openings.empty())
    open.openings.back().depth = (*values)[0];
}

void CityGmlParser::end_element(std::string_view name) {
  ReadBody& b = *body();
  const auto number_of = [&](const char* attribute) {
    const std::string number = number_text(trimmed(text_));
    if (number.empty()) return rule(fmt::format("{} is \"{}\"", name, text_.substr(0, 40)), b.id);
    b.attributes[attribute] = number;
  };
  if (name == "function") {
    (in_installation_ ? installation_kind_ : b.attributes["use"]) = text_;
  } else if (name == "measuredHeight") {
    number_of("height");
  } else if (name == "storeysAboveGround") {
    number_of("storeys");
  } else if (name == "storeyHeightsAboveGround") {
    const auto heights = number_list(text_);
    if (!heights || heights->empty()) return rule("storeyHeightsAboveGround is no list of numbers", b.id);
    for (const double h : *heights)
      if (h != heights->front()) rule("storeys of different heights", b.id);
    b.attributes["storey_height"] = number_text(trimmed(text_).substr(0, trimmed(text_).find(' ')));
  } else if (name == "uri" && parent() == "externalObject") {
    // w12.w34 is made from the tags of way 34, w12.rest from those of way 12.
    static const std::unordered_map<char, std::string> kinds = {{'n', "node/"}, {'w', "way/"}, {'r', "relation/"}};
    const std::string id = owner(b.id);
    const auto kind = kinds.find(id.empty() ? ' ' : id[0]);
    if (kind != kinds.end() && text_ != "https://www.openstreetmap.org/" + kind->second + id.substr(1))
      rule("its external reference leads to " + text_.substr(0, 80), b.id);
  }
}

std::string CityGmlParser::colour(const std::string& text) {
  const auto values = number_list(text);
  if (!values || values->size() != 3 ||
      std::any_of(values->begin(), values->end(), [](double v) { return !(v >= 0 && v <= 1); })) {
    rule("a colour that is none: " + text.substr(0, 40), "");
    return {};
  }
  return fmt::format("#{:02x}{:02x}{:02x}", std::lround((*values)[0] * 255), std::lround((*values)[1] * 255),
                     std::lround((*values)[2] * 255));
}

CityGml read_citygml(std::string_view xml, const std::string& name) {
  CityGml out;
  constexpr int kOptions = XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING;
  const std::unique_ptr<xmlTextReader, void (*)(xmlTextReaderPtr)> reader(
      xml.empty() || xml.size() > 0x7fffffff
          ? nullptr
          : xmlReaderForMemory(xml.data(), static_cast<int>(xml.size()), "file.gml", nullptr, kOptions),
      xmlFreeTextReader);
  if (reader) {
    xmlTextReaderSetErrorHandler(
        reader.get(), [](void*, const char*, xmlParserSeverities, xmlTextReaderLocatorPtr) {}, nullptr);
    out.readable = CityGmlParser(name, out).parse(reader.get());
  }
  if (!out.readable) {
    const int line = reader ? xmlTextReaderGetParserLineNumber(reader.get()) : 0;
    out.contents = {};
    out.contents.findings.push_back(
        {Check::file_unreadable, name, "", fmt::format("line {}: not well-formed XML", line)});
  }
  return out;
}

}  // namespace blockrand::validate
