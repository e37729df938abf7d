#include "pipeline/validate/citygml.h"

#include <fmt/format.h>
#include <libxml/parser.h>
#include <libxml/xmlreader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "pipeline/geometry/solid_defect.h"
#include "pipeline/validate/attribute_names.h"
#include "pipeline/validate/citygml_names.h"
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

class Parser {
 public:
  Parser(const std::string& name, CityGml& out) : name_(name), out_(out) {}

  /// \return false where the file is not well-formed
  bool parse(xmlTextReaderPtr reader) {
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

 private:
  /// A body in the making, beside what Contents keeps of it.
  struct Open {
    std::size_t body = 0;
    bool has_parts = false;
    std::string function;
    std::vector<std::pair<std::string, ReadPolygon>> surfaces;  ///< polygon id and polygon
    std::vector<std::string> references;                        ///< of the LoD2 solid
    bool has_reference_solid = false;
  };
  struct Material {
    std::string colour;
    std::vector<std::string> targets;
  };
  struct Place {
    std::size_t body = 0;
    int solid = -1;  ///< -1: the footprint
    std::size_t polygon = 0;
  };

  void found(Check check, std::string what, std::string object, int number = 0) {
    if (++found_ > 1000) return;  // of one file
    out_.contents.findings.push_back({check, name_, std::move(object), fmt::format("line {}: {}", line_, what), number});
  }
  void rule(std::string what, std::string object) { found(Check::citygml_rule, std::move(what), std::move(object)); }
  void defect(SolidDefect what) {
    found(Check::citygml_rule, fmt::format("{} {}", iso_code(what), name(what)), object(), iso_code(what));
  }

  std::string_view parent(std::size_t up = 1) const {
    return stack_.size() > up ? stack_[stack_.size() - 1 - up] : std::string_view();
  }
  ReadBody* body() { return open_.empty() ? nullptr : &out_.contents.bodies[open_.back().body]; }
  std::string object() { return open_.empty() ? std::string() : body()->id; }

  void start(xmlTextReaderPtr reader) {
    // Names live in the reader's dictionary as long as the reader.
    const std::string_view name = view(xmlTextReaderConstLocalName(reader)),
                           space = view(xmlTextReaderConstNamespaceUri(reader));
    text_.clear();
    stack_.push_back(name);
    if (!known_element(space, name)) rule(fmt::format("unexpected element {}", name), object());
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
    else if (space == kGenerics && name.ends_with("Attribute"))
      attribute_ = attribute(reader, "name");
    else if (space == kGenerics && name == "value" && parent() == "measureAttribute" &&
             attribute(reader, "uom").empty())
      rule(attribute_ + " has no unit", object());
    else if (space == kAppearance && name == "X3DMaterial")
      materials_.emplace_back();
  }

  void start_gml(xmlTextReaderPtr reader, std::string_view name, const std::string& id) {
    if (name == "Envelope") {
      out_.srs_name = attribute(reader, "srsName");
      if (attribute(reader, "srsDimension") != "3") rule("the envelope is not three-dimensional", "");
    } else if (name == "Solid") {
      const std::string_view property = parent();
      if (!body() || (property != "lod1Solid" && property != "lod2Solid")) return rule("a solid that is nobody's", id);
      ReadSolid solid;
      solid.lod = property[3] - '0';
      body()->solids.push_back(std::move(solid));
      in_solid_ = true;
      solid_id_ = id;
      by_reference_ = false;
    } else if (name == "surfaceMember" && in_solid_) {
      const std::string href = attribute(reader, "href", kLink);
      if (href.empty()) return;
      if (href[0] != '#') return rule("a reference to another file: " + href, object());
      open_.back().references.push_back(href.substr(1));
      by_reference_ = true;
    } else if (name == "Polygon") {
      polygon_ = {};
      polygon_.kind = surface_;
      polygon_id_ = id;
      in_polygon_ = true;
    }
  }

  void start_building(std::string_view name, const std::string& id) {
    if (name == "Building" || name == "BuildingPart") {
      const bool part = name == "BuildingPart";
      if (part != !open_.empty()) rule(fmt::format("{} out of its place", name), id);
      if (!(part ? is_body_id(id) : is_osm_id(id))) rule(fmt::format("\"{}\" is no id", id), id);
      ReadBody body;
      body.id = id;
      body.building = part && !open_.empty() ? out_.contents.bodies[open_.front().body].id : id;
      if (part && building_of(id) != body.building)
        rule(fmt::format("{} does not belong to {}", id, body.building), id);
      if (!open_.empty()) open_.front().has_parts = true;
      if (!part) out_.contents.buildings.push_back(id);
      open_.emplace_back();
      open_.back().body = out_.contents.bodies.size();
      out_.contents.bodies.push_back(std::move(body));
    } else if (const std::string_view kind = surface_kind(name); !kind.empty() && parent() == "boundedBy") {
      surface_ = kind;
    }
  }

  void end() {
    const std::string_view name = stack_.back();
    if (name == "posList") {
      end_ring();
    } else if (name == "Polygon") {
      end_polygon();
    } else if (name == "Solid") {
      if (in_solid_ && by_reference_) {
        open_.back().has_reference_solid = true;
        if (!body()->solids.back().polygons.empty()) rule("a solid half of references, half of polygons", object());
      } else if (in_solid_ && body()->solids.back().polygons.empty()) {
        rule("a solid without faces", object());
      }
      in_solid_ = false;
    } else if (!surface_kind(name).empty() && parent() == "boundedBy") {
      surface_.clear();
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

  void end_ring() {
    const auto values = number_list(text_);
    if (!values || values->size() % 3 != 0) return rule("coordinates that are no triples of numbers", object());
    std::vector<Point3> ring;
    double off = 0;
    for (std::size_t i = 0; i < values->size(); i += 3) {
      const Point3 p{(*values)[i], (*values)[i + 1], (*values)[i + 2]};
      if (std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) > kLargestCoordinate)
        return rule("a coordinate beyond any CRS", object());
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

  void end_polygon() {
    in_polygon_ = false;
    if (!body()) return rule("a polygon that is nobody's", polygon_id_);
    if (polygon_.rings.empty()) return;  // its rings were found wanting
    if (in_solid_) {
      ReadSolid& solid = body()->solids.back();
      note_place(polygon_id_, {open_.back().body, static_cast<int>(body()->solids.size()) - 1, solid.polygons.size()});
      solid.polygons.push_back(std::move(polygon_));
    } else if (!surface_.empty()) {
      open_.back().surfaces.emplace_back(polygon_id_, std::move(polygon_));
    } else {
      note_place(polygon_id_, {open_.back().body, -1, body()->footprint.size()});
      body()->footprint.push_back(std::move(polygon_));
    }
  }

  void note_place(const std::string& id, Place place) {
    if (!id.empty()) places_.emplace(id, place);
  }

  /// The LoD2 solid gets the polygons of its boundary surfaces.
  void end_body() {
    Open open = std::move(open_.back());
    ReadBody& body = out_.contents.bodies[open.body];
    ReadSolid* solid = nullptr;
    int number = -1;
    for (std::size_t s = 0; s < body.solids.size(); ++s)
      if (body.solids[s].lod == 2) solid = &body.solids[s], number = static_cast<int>(s);
    if (open.has_reference_solid && solid) {
      std::unordered_map<std::string, std::size_t> index;
      for (std::size_t i = 0; i < open.surfaces.size(); ++i) index.emplace(open.surfaces[i].first, i);
      std::vector<int> used(open.surfaces.size(), 0);
      for (const std::string& id : open.references) {
        const auto place = index.find(id);
        if (place == index.end()) {
          rule("a reference to #" + id + ", which is no polygon of the building", body.id);
          continue;
        }
        if (++used[place->second] > 1) {
          rule("polygon " + id + " is twice in the solid", body.id);
          continue;
        }
        note_place(id, {open.body, number, solid->polygons.size()});
        solid->polygons.push_back(std::move(open.surfaces[place->second].second));
      }
      for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i] == 0) rule(fmt::format("surface polygon {} is not in the solid", open.surfaces[i].first), body.id);
    } else if (!open.surfaces.empty()) {
      rule("boundary surfaces without a solid", body.id);
    }
    for (std::size_t s = 0; s + 1 < body.solids.size(); ++s)
      if (body.solids[s].lod >= body.solids[s + 1].lod)
        rule("solids out of the order of their LoD, or one twice", body.id);
    if (outside_) rule("a point lies outside of the envelope", body.id);
    outside_ = false;
    finish_attributes(body);
    if (open.has_parts) {
      if (!body.footprint.empty() || !body.solids.empty()) rule("a building with geometry beside its parts", body.id);
      assemblies_.push_back(open.body);
    } else if (!body.attributes.count("lod")) {
      rule("neither parts nor an attribute lod", body.id);
    } else {
      const std::string& lod = body.attributes["lod"];
      if (lod >= "0" && lod <= "9" && body.footprint.empty()) rule("no lod0FootPrint", body.id);
    }
    open_.pop_back();
  }

  void finish_attributes(ReadBody& body) {
    for (const std::string& name : attribute_names()) {
      const auto value = body.attributes.find(name);
      const auto source = body.attributes.find(name + "_source"),
                 confidence = body.attributes.find(name + "_confidence");
      if (source != body.attributes.end()) {
        if (!is_source(source->second))
          found(Check::source_wrong, fmt::format("{} from \"{}\"", name, source->second), body.id);
        if (confidence == body.attributes.end()) found(Check::source_wrong, name + " without confidence", body.id);
      } else {
        if (confidence != body.attributes.end())
          found(Check::source_wrong, name + "_confidence without a source", body.id);
        if (value != body.attributes.end()) body.attributes[name + "_source"] = "tag";
      }
      if (confidence != body.attributes.end()) {
        const std::string& text = confidence->second;
        double c = -1;
        std::from_chars(text.data(), text.data() + text.size(), c);
        if (!(c >= 0 && c <= 1)) found(Check::source_wrong, fmt::format("confidence of {} is {}", name, text), body.id);
      }
    }
  }

  void end_corner(bool lower) {
    const auto values = number_list(text_);
    if (!values || values->size() != 3) return rule("the envelope's corner is no point", "");
    (lower ? lower_ : upper_) = Point3{(*values)[0], (*values)[1], (*values)[2]};
  }

  void end_attribute() {
    if (!body() || attribute_.empty()) return;
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

  void end_element(std::string_view name) {
    ReadBody& b = *body();
    const auto number_of = [&](const char* attribute) {
      const std::string number = number_text(trimmed(text_));
      if (number.empty()) return rule(fmt::format("{} is \"{}\"", name, text_.substr(0, 40)), b.id);
      b.attributes[attribute] = number;
    };
    if (name == "function") {
      b.attributes["use"] = text_;
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

  /// "#rrggbb" of three numbers from 0 to 1.
  std::string colour(const std::string& text) {
    const auto values = number_list(text);
    if (!values || values->size() != 3 ||
        std::any_of(values->begin(), values->end(), [](double v) { return !(v >= 0 && v <= 1); })) {
      rule("a colour that is none: " + text.substr(0, 40), "");
      return {};
    }
    return fmt::format("#{:02x}{:02x}{:02x}", std::lround((*values)[0] * 255), std::lround((*values)[1] * 255),
                       std::lround((*values)[2] * 255));
  }

  void finish() {
    for (const Material& m : materials_)
      for (const std::string& target : m.targets) {
        const auto place = places_.find(target);
        if (place == places_.end()) {
          rule("an appearance of #" + target + ", which is no polygon", "");
          continue;
        }
        ReadBody& body = out_.contents.bodies[place->second.body];
        auto& polygons = place->second.solid < 0 ? body.footprint
                                                 : body.solids[static_cast<std::size_t>(place->second.solid)].polygons;
        std::string& slot = polygons[place->second.polygon].colour;
        if (!slot.empty()) rule("#" + target + " has two colours", body.id);
        slot = m.colour;
      }
    if (!out_.contents.buildings.empty() && (!lower_ || !upper_ || out_.srs_name.empty()))
      rule("no envelope with a reference system", "");
    // Buildings of several parts are no bodies of their own.
    std::vector<ReadBody> bodies;
    for (std::size_t i = 0, next = 0; i < out_.contents.bodies.size(); ++i) {
      if (next < assemblies_.size() && assemblies_[next] == i)
        ++next;
      else
        bodies.push_back(std::move(out_.contents.bodies[i]));
    }
    out_.contents.bodies = std::move(bodies);
  }

  const std::string& name_;
  CityGml& out_;
  std::vector<std::string_view> stack_;
  std::vector<Open> open_;  ///< the building, and its part where one is open
  std::vector<std::size_t> assemblies_;
  std::unordered_set<std::string> ids_;
  std::unordered_map<std::string, Place> places_;  ///< polygons by gml:id
  std::vector<Material> materials_;
  std::optional<Point3> lower_, upper_;
  ReadPolygon polygon_;
  std::string text_, surface_, attribute_, polygon_id_, solid_id_;
  bool in_solid_ = false, in_polygon_ = false, by_reference_ = false, outside_ = false;
  int line_ = 0, found_ = 0;
};

}  // namespace

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
    out.readable = Parser(name, out).parse(reader.get());
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
