#include "importers/reference/citygml_parser.h"

#include <libxml/tree.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <span>
#include <utility>

#include "importers/reference/coordinate_text.h"
#include "importers/reference/matrix4.h"
#include "importers/reference/polygons.h"

namespace blockrand::importers::reference {
namespace {

std::string_view view(const xmlChar* text) { return text ? reinterpret_cast<const char*>(text) : std::string_view(); }

/// "bldg:Building" → "Building": an undeclared prefix may stay in the local name.
std::string_view without_prefix(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

bool is_gml(std::string_view uri) { return uri.starts_with("http://www.opengis.net/gml"); }

bool any_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// An attribute's value as it is meant. Where entities are not expanded, libxml2's SAX2 leaves each ampersand of a
/// value as "&#38;", for a later pass that DOM trees have; nothing else is left so.
std::string unescaped(std::string_view value) {
  constexpr std::string_view kAmpersand = "&#38;";
  std::string out;
  for (std::size_t at = value.find(kAmpersand); at != std::string_view::npos; at = value.find(kAmpersand)) {
    out.append(value.substr(0, at)) += '&';
    value.remove_prefix(at + kAmpersand.size());
  }
  return out.append(value);
}

/// Metres of a unit as "m", "#m", "urn:ogc:def:uom:UCUM::m" name it; without one metres are meant. 0: unknown.
double metres_of_unit(std::string_view uom) {
  const std::size_t last = uom.find_last_of(":#/");
  const std::string_view unit = last == std::string_view::npos ? uom : uom.substr(last + 1);
  if (any_of(unit, {"", "m", "M", "metre", "meter", "9001"})) return 1;
  if (any_of(unit, {"cm"})) return 0.01;
  if (any_of(unit, {"mm"})) return 0.001;
  if (any_of(unit, {"ft", "[ft_i]", "foot", "9002"})) return 0.3048;
  return 0;
}

}  // namespace

CityGmlParser::Attributes CityGmlParser::read_attributes(const XmlElement& element) {
  Attributes out;
  const int line = element.line;
  for (int i = 0; i < element.attribute_count; ++i) {
    const xmlChar** a = element.attributes + 5 * i;
    const std::string_view full = view(a[0]), name = without_prefix(full), prefix = view(a[1]), uri = view(a[2]);
    const std::string value = unescaped({reinterpret_cast<const char*>(a[3]), static_cast<std::size_t>(a[4] - a[3])});
    if (name == "id" && (is_gml(uri) || prefix == "gml" || full == "gml:id")) {
      out.id = value;
    } else if (name == "href") {
      out.href = trimmed(value);
    } else if (name == "srsName") {
      out.srs_name = trimmed(value);
    } else if (name == "srsDimension" || (name == "dimension" && uri.empty())) {
      out.dimension = whole_number_of(value).value_or(0);
    } else if (name == "orientation") {
      out.negative = trimmed(value) == "-";
    } else if (name == "name") {
      out.name = value;
    } else if (name == "uom") {
      out.uom = trimmed(value);
    } else if (name == "decimal") {
      out.decimal = value;
    } else if (name == "cs") {
      out.within = value;
    } else if (name == "ts") {
      out.between = value;
    }
  }
  if (!out.id.empty()) {
    if (xmlValidateNCName(reinterpret_cast<const xmlChar*>(out.id.c_str()), 0) != 0)
      notes_.add(NoteKind::bad_id, line, "\"" + out.id + "\"");
    if (!ids_.insert(out.id).second) notes_.add(NoteKind::duplicate_id, line, "\"" + out.id + "\"");
  }
  return out;
}

CityGmlParser::Space CityGmlParser::space_of(std::string_view uri) {
  if (uri.empty()) return Space::none;
  if (is_gml(uri)) return Space::gml;
  if (uri.find("opengis.net/citygml/") != std::string_view::npos) {
    const std::string version(uri.substr(uri.rfind('/') + 1));
    (version >= "3" ? facts_.foreign_version : model_.version) = version;
    facts_.city_model = true;
    return Space::citygml;
  }
  if (uri.find("citygml.org/citygml/") != std::string_view::npos) {  // the namespace of all versions before 1.0
    model_.version = "0.4";
    facts_.city_model = true;
    return Space::citygml;
  }
  return Space::foreign;
}

void CityGmlParser::element(const XmlElement& element) {
  Element e;
  e.line = element.line;
  e.name = without_prefix(element.name);
  e.space = space_of(element.space);
  if (element.attribute_count > 0) e.attributes = read_attributes(element);
  // No building holds a member of the city model: an end tag is missing.
  if ((!open_.empty() || skip_depth_ > 0) && e.name == "cityObjectMember") cut_off();
  e.dimension = e.attributes.dimension != 0 ? e.attributes.dimension : stack_.empty() ? 0 : stack_.back().dimension;
  e.first_item = links_.size();
  if (stack_.empty() && facts_.root.empty()) facts_.root = e.name;
  if (skip_depth_ == 0) {
    e.role = start(e);
  } else if (e.name == "relativeGMLGeometry" && !in_template_) {
    e.role = start_template(e);
  }
  text_.clear();
  static constexpr std::array kWithText{Role::coordinates, Role::attribute_value, Role::value,   Role::corner,
                                        Role::description, Role::matrix,          Role::library, Role::reference_point};
  collects_ = std::find(kWithText.begin(), kWithText.end(), e.role) != kWithText.end();
  stack_.push_back(std::move(e));
}

void CityGmlParser::end_element() {
  if (stack_.empty()) return;
  const Element e = std::move(stack_.back());
  stack_.pop_back();
  if (skip_depth_ == 0) {
    end(e);
  } else if (skip_depth_ == stack_.size() + 1) {
    skip_depth_ = 0;
  }
  collects_ = false;
  text_.clear();
}

// ---- geometries ---------------------------------------------------------------------------------------------------

std::vector<Geometry>& CityGmlParser::geometries_of(std::size_t building, int surface, int opening) {
  Building& b = model_.buildings[building];
  if (surface < 0) return b.geometries;
  Surface& s = b.surfaces[static_cast<std::size_t>(surface)];
  return opening < 0 ? s.geometries : s.openings[static_cast<std::size_t>(opening)].geometries;
}

void CityGmlParser::begin_geometry(GeometryKind kind, const std::string& id) {
  const OpenThing& here = open_.back();
  auto& geometries = geometries_of(here.building, here.surface, here.opening);
  pending_.push_back({.building = here.building,
                      .surface = here.surface,
                      .opening = here.opening,
                      .geometry = geometries.size(),
                      .begin = links_.size(),
                      .voids = static_cast<std::size_t>(-1),
                      .end = links_.size()});
  Geometry g;
  g.lod = property_lod_;
  g.kind = kind;
  g.id = id;
  geometries.push_back(std::move(g));
}

void CityGmlParser::finish() {
  for (const Pending& p : pending_) {
    Geometry& g = geometries_of(p.building, p.surface, p.opening)[p.geometry];
    const std::size_t voids = std::min(p.voids, p.end);
    g.faces = links_.resolve(p.begin, voids, notes_);
    g.outer_faces = g.faces.size();
    const std::vector<Face> inner = links_.resolve(voids, p.end, notes_);
    g.faces.insert(g.faces.end(), inner.begin(), inner.end());
  }
  for (const Implicit& use : implicit_) place(use);
  if (std::find(is_template_.begin(), is_template_.end(), true) != is_template_.end()) {
    is_template_.resize(model_.polygons.size(), false);
    drop_polygons(model_, is_template_);
  }
  drop_empty_geometries();
}

void CityGmlParser::end_template() {
  if (resume_skip_ == 0) implicit_.back().end = links_.size();
  is_template_.resize(model_.polygons.size(), true);
  skip_depth_ = resume_skip_;
  in_template_ = in_property_ = reversed_ = false;
}

/// The template's faces where the use has them: its matrix, then its reference point.
void CityGmlParser::place(const Implicit& use) {
  constexpr std::size_t kMostFaces = 20'000'000;  // templates multiply; a mistake or an attack beyond
  Building& b = model_.buildings[use.building];
  const auto refuse = [&](NoteKind kind, const std::string& what) {
    notes_.add(kind, use.line, what);
    ++b.implicit_geometries;
  };
  if (use.begin == use.end)
    return refuse(NoteKind::not_read, use.library.empty() ? "an implicit geometry without a template"
                                                          : "implicit geometry from another file: " + use.library);
  if (use.bad_numbers || use.reference_point.size() < 2)
    return refuse(NoteKind::bad_value, use.bad_numbers ? "an implicit geometry whose matrix or point is none"
                                                       : "an implicit geometry without a reference point");
  const std::vector<Face> faces = links_.resolve(use.begin, use.end, notes_);
  if (faces.empty()) return refuse(NoteKind::not_read, "an implicit geometry without faces");
  if ((placed_faces_ += faces.size()) > kMostFaces) return refuse(NoteKind::not_read, "templates multiply without end");
  const auto& m = use.matrix;
  const auto& at = use.reference_point;
  const auto placed = [&](const model::Point3& p) {
    const auto row = [&](std::size_t r) {
      return m[4 * r] * p.x + m[4 * r + 1] * p.y + m[4 * r + 2] * p.z + m[4 * r + 3];
    };
    const model::Point3 turned = m.empty() ? p : model::Point3{row(0), row(1), row(2)};
    return model::Point3{turned.x + at[0], turned.y + at[1], turned.z + (at.size() > 2 ? at[2] : 0)};
  };
  const bool mirrored = !m.empty() && mirrors(std::span<const double, 16>(m));  // end() saw to its 16 numbers
  Geometry g;
  g.lod = use.lod;
  for (const Face& face : faces) {
    Polygon3 polygon = model_.polygons[face.polygon];
    for (model::Point3& p : polygon.outer) p = placed(p);
    for (auto& hole : polygon.holes)
      for (model::Point3& p : hole) p = placed(p);
    g.faces.push_back({static_cast<std::uint32_t>(model_.polygons.size()), face.reversed != mirrored});
    model_.polygons.push_back(std::move(polygon));
  }
  g.outer_faces = g.faces.size();
  geometries_of(use.building, use.surface, use.opening).push_back(std::move(g));
}

void CityGmlParser::drop_empty_geometries() {
  const auto drop = [](std::vector<Geometry>& list) {
    std::erase_if(list, [](const Geometry& g) { return g.faces.empty(); });
  };
  for (Building& b : model_.buildings) {
    drop(b.geometries);
    for (Surface& s : b.surfaces) {
      drop(s.geometries);
      for (Opening& o : s.openings) drop(o.geometries);
    }
  }
}

void CityGmlParser::cut_off() {
  if (in_template_) is_template_.resize(model_.polygons.size(), true);
  if (!open_.empty()) {
    const std::size_t first = open_.front().building;
    const Building& b = model_.buildings[first];
    notes_.add(NoteKind::incomplete_building, b.line, "building \"" + b.id + "\" has no end");
    std::erase_if(pending_, [&](const Pending& p) { return p.building >= first; });
    std::erase_if(implicit_, [&](const Implicit& use) { return use.building >= first; });
    model_.buildings.resize(first);
  }
  open_.clear();
  stack_.clear();
  skip_depth_ = 0;
  polygon_.reset();
  in_property_ = in_ring_ = reversed_ = in_implicit_ = in_template_ = false;
}

// ---- ends ---------------------------------------------------------------------------------------------------------

void CityGmlParser::end(const Element& e) {
  switch (e.role) {
    case Role::building:
    case Role::surface:
    case Role::opening:
      open_.pop_back();
      break;
    case Role::property:
      end_geometry();
      in_property_ = false;
      reversed_ = false;
      break;
    case Role::orientable:
      if (e.attributes.negative) reversed_ = !reversed_;
      [[fallthrough]];
    case Role::aggregate:
    case Role::solid:
      if (!e.attributes.id.empty()) links_.name(e.attributes.id, e.first_item, reversed_);
      break;
    case Role::polygon:
      end_polygon(e);
      break;
    case Role::ring:
      end_ring(e);
      break;
    case Role::coordinates:
      end_coordinates(e);
      break;
    case Role::attribute_value: {
      std::string name = stack_.back().attributes.name;
      for (std::size_t i = stack_.size() - 1; i-- > 0 && stack_[i].role == Role::attribute_set;)
        name = stack_[i].attributes.name + "/" + name;
      building().attributes.emplace_back(std::move(name), std::string(trimmed(text_)));
      break;
    }
    case Role::value:
      end_value(e);
      break;
    case Role::corner:
      end_corner();
      break;
    case Role::description:
      facts_.description = trimmed(text_);
      break;
    case Role::implicit_property:
      in_implicit_ = false;
      break;
    case Role::relative_geometry:
      end_template();
      break;
    case Role::library:
      implicit_.back().library = trimmed(text_);
      break;
    case Role::matrix:
    case Role::reference_point: {
      const Attributes& a = e.attributes;
      const auto numbers =
          numbers_of(e.name == "coordinates" ? as_number_list(text_, a.decimal, a.within, a.between) : text_);
      Implicit& use = implicit_.back();
      if (numbers) (e.role == Role::matrix ? use.matrix : use.reference_point) = *numbers;
      use.bad_numbers = use.bad_numbers || !numbers || (e.role == Role::matrix && numbers->size() != 16);
      break;
    }
    case Role::envelope:
    case Role::attribute_set:
    case Role::attribute:
    case Role::ring_side:
    case Role::other:
      break;
  }
}

void CityGmlParser::end_polygon(const Element& e) {
  if (polygon_->outer.size() >= 3) {
    links_.add_polygon(static_cast<std::uint32_t>(model_.polygons.size()), reversed_);
    model_.polygons.push_back(std::move(*polygon_));
  }
  polygon_.reset();
  if (!e.attributes.id.empty()) links_.name(e.attributes.id, e.first_item, reversed_);
}

void CityGmlParser::end_ring(const Element& e) {
  in_ring_ = false;
  if (ring_is_bad_) return;
  if (ring_.size() > 1 && ring_.front() == ring_.back()) {
    ring_.pop_back();
  } else if (ring_.size() >= 3) {
    notes_.add(NoteKind::open_ring, e.line, "the last point is not the first");
  }
  if (ring_.size() < 3) {
    notes_.add(NoteKind::short_ring, e.line, std::to_string(ring_.size()) + " different points");
  } else if (interior_ring_) {
    polygon_->holes.push_back(std::move(ring_));
  } else {
    polygon_->outer = std::move(ring_);
  }
  ring_.clear();
}

void CityGmlParser::end_coordinates(const Element& e) {
  constexpr double kLargest = 1e9;  // m; beyond is no CRS on Earth
  const Attributes& a = e.attributes;
  const auto numbers =
      e.name == "coordinates" ? numbers_of(as_number_list(text_, a.decimal, a.within, a.between)) : numbers_of(text_);
  int dimension = e.dimension;
  if (numbers && e.name == "pos" && (numbers->size() == 2 || numbers->size() == 3)) {
    dimension = static_cast<int>(numbers->size());
  } else if (numbers && dimension != 0 && numbers->size() % static_cast<std::size_t>(std::max(1, dimension)) != 0) {
    dimension = 0;  // what is stated does not fit
  }
  const auto list = numbers ? points_of(*numbers, dimension) : std::nullopt;
  const bool sane =
      list && std::all_of(numbers->begin(), numbers->end(), [](double v) { return v < kLargest && v > -kLargest; });
  if (!sane) {
    notes_.add(NoteKind::bad_coordinates, e.line, "\"" + std::string(trimmed(text_).substr(0, 60)) + "\"");
    ring_is_bad_ = true;
    return;
  }
  if (list->two_dimensional && ring_.empty()) notes_.add(NoteKind::two_dimensional, e.line, "a ring without heights");
  ring_.insert(ring_.end(), list->points.begin(), list->points.end());
}

void CityGmlParser::end_corner() {
  const auto numbers = numbers_of(text_);
  if (!numbers || numbers->size() < 2) return;
  if (facts_.lower.empty()) {
    facts_.lower = *numbers;
  } else if (facts_.upper.empty()) {
    facts_.upper = *numbers;
  }
}

void CityGmlParser::end_value(const Element& e) {
  const std::string text(trimmed(text_));
  if (text.empty()) return;
  Building& b = building();
  bool good = true;
  const auto whole = [&](std::optional<int>& target) {
    const auto value = whole_number_of(text);
    good = value && *value >= 0;
    if (good) target = value;
  };
  const auto year = [&](std::optional<int>& target) {
    const auto value = year_of(text);
    good = value.has_value();
    if (good) target = value;
  };
  if (e.name == "name") {
    b.names.push_back(text);
  } else if (e.name == "function") {
    b.functions.push_back(text);
  } else if (e.name == "usage") {
    b.usages.push_back(text);
  } else if (e.name == "class") {
    b.class_code = text;
  } else if (e.name == "roofType") {
    b.roof_type = text;
  } else if (e.name == "measuredHeight") {
    const auto value = number_of(text);
    const double unit = metres_of_unit(e.attributes.uom);
    good = value && unit > 0;
    if (good) b.measured_height = *value * unit;
  } else if (e.name == "storeysAboveGround") {
    whole(b.storeys_above_ground);
  } else if (e.name == "storeysBelowGround") {
    whole(b.storeys_below_ground);
  } else if (e.name == "yearOfConstruction") {
    year(b.year_of_construction);
  } else if (e.name == "yearOfDemolition") {
    year(b.year_of_demolition);
  }
  if (!good) notes_.add(NoteKind::bad_value, e.line, e.name + " \"" + text + "\"");
}

}  // namespace blockrand::importers::reference
