#include "tests/validators/citygml_reader.h"

#include <libxml/xmlreader.h>

#include <charconv>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string_view>

namespace blockrand::validators {
namespace {

using Reader = std::unique_ptr<xmlTextReader, void (*)(xmlTextReaderPtr)>;

std::string_view view(const xmlChar* text) { return text ? reinterpret_cast<const char*>(text) : ""; }

std::string attribute(xmlTextReaderPtr reader, const char* name) {
  xmlChar* value = xmlTextReaderGetAttribute(reader, reinterpret_cast<const xmlChar*>(name));
  std::string text(view(value));
  xmlFree(value);
  return text;
}

std::vector<double> numbers(std::string_view text) {
  std::vector<double> out;
  const char* p = text.data();
  const char* const end = p + text.size();
  while (true) {
    while (p < end && (*p == ' ' || *p == '\n' || *p == '\t' || *p == '\r')) ++p;
    if (p == end) return out;
    double value = 0;
    const auto [next, error] = std::from_chars(p, end, value);
    if (error != std::errc())
      throw std::runtime_error("not a number: " + std::string(p, std::min<std::size_t>(20, end - p)));
    out.push_back(value);
    p = next;
  }
}

std::vector<model::Point3> points(std::string_view text) {
  const std::vector<double> n = numbers(text);
  if (n.size() % 3 != 0) throw std::runtime_error("coordinates are no multiple of three");
  std::vector<model::Point3> out;
  for (std::size_t i = 0; i < n.size(); i += 3) out.push_back({n[i], n[i + 1], n[i + 2]});
  return out;
}

class Parser {
 public:
  GmlFile parse(xmlTextReaderPtr reader) {
    int status = 0;
    while ((status = xmlTextReaderRead(reader)) == 1) {
      switch (xmlTextReaderNodeType(reader)) {
        case XML_READER_TYPE_ELEMENT: {
          const bool empty = xmlTextReaderIsEmptyElement(reader) == 1;
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
        default:
          break;
      }
    }
    if (status != 0) throw std::runtime_error("not well-formed XML");
    resolve();
    return std::move(file_);
  }

 private:
  void start(xmlTextReaderPtr reader) {
    const std::string name(view(xmlTextReaderConstLocalName(reader)));
    text_.clear();
    stack_.push_back(name);
    const std::string id = attribute(reader, "gml:id");
    if (!id.empty() && !ids_.insert(id).second) throw std::runtime_error("gml:id twice: " + id);
    if (name == "Building" || name == "BuildingPart") {
      open_.push_back(file_.buildings.size());
      file_.buildings.push_back({id, name == "BuildingPart", {}, {}, {}});
    } else if (name == "Envelope") {
      file_.srs_name = attribute(reader, "srsName");
    } else if (name == "Solid") {
      GmlSolid solid;
      solid.id = id;
      solid.building = building().id;
      const std::string& property = stack_.at(stack_.size() - 2);  // "lod2Solid"
      solid.lod = property.size() > 3 ? property[3] - '0' : 0;
      file_.solids.push_back(std::move(solid));
      references_.emplace_back();
      in_solid_ = true;
    } else if (name == "surfaceMember") {
      const std::string href = attribute(reader, "xlink:href");
      if (href.empty()) return;
      if (href[0] != '#') throw std::runtime_error("a reference to another file: " + href);
      if (in_solid_) {
        references_.back().push_back({file_.solids.back().polygons.size(), href.substr(1)});
        file_.solids.back().polygons.emplace_back();
      } else if (!surface_.empty()) {
        surface_of_[href.substr(1)] = surface_;
      }
    } else if (name == "Polygon") {
      polygon_ = {};
      polygon_.id = id;
    } else if (name.size() > 7 && name.ends_with("Surface") && stack_.at(stack_.size() - 2) == "boundedBy") {
      surface_ = name;
    } else if (name.ends_with("Attribute")) {
      attribute_ = attribute(reader, "name");
    }
  }

  void end() {
    const std::string name = stack_.back();
    stack_.pop_back();
    if (name == "posList") {
      std::vector<model::Point3> ring = points(text_);
      if (ring.size() < 4 || ring.front() != ring.back()) throw std::runtime_error("a ring is not closed");
      ring.pop_back();
      const bool exterior = stack_.size() >= 2 && stack_[stack_.size() - 2] == "exterior";
      if (exterior != polygon_.rings.empty()) throw std::runtime_error("rings out of order");
      polygon_.rings.push_back(std::move(ring));
    } else if (name == "Polygon") {
      if (!in_solid_)
        building().footprint.push_back(std::move(polygon_));
      else
        file_.solids.back().polygons.push_back(polygon_);
      if (!polygon_.id.empty()) by_id_[polygon_.id] = std::move(polygon_);
    } else if (name == "Solid") {
      in_solid_ = false;
    } else if (name == surface_) {
      surface_.clear();
    } else if (name == "Building" || name == "BuildingPart") {
      open_.pop_back();
    } else if (name == "lowerCorner") {
      file_.lower = points(text_).at(0);
    } else if (name == "upperCorner") {
      file_.upper = points(text_).at(0);
    } else if (name == "value" && !attribute_.empty()) {
      building().attributes.emplace_back(attribute_, text_);
      attribute_.clear();
    } else if (!open_.empty() && !text_.empty() && text_.find_first_not_of(" \n\t\r") != std::string::npos) {
      building().elements.emplace_back(name, text_);
    }
    text_.clear();
  }

  GmlBuilding& building() {
    if (open_.empty()) throw std::runtime_error("geometry outside of a building");
    return file_.buildings[open_.back()];
  }

  void resolve() {
    for (std::size_t s = 0; s < file_.solids.size(); ++s)
      for (const auto& [slot, id] : references_[s]) {
        const auto found = by_id_.find(id);
        if (found == by_id_.end()) throw std::runtime_error("no polygon with gml:id " + id);
        file_.solids[s].polygons[slot] = found->second;
      }
    for (const auto& [id, surface] : surface_of_)
      if (by_id_.count(id) == 0) throw std::runtime_error("a surface of no polygon: " + id);
    for (GmlSolid& solid : file_.solids)
      for (GmlPolygon& polygon : solid.polygons)
        if (const auto surface = surface_of_.find(polygon.id); surface != surface_of_.end())
          polygon.surface = surface->second;
  }

  GmlFile file_;
  std::vector<std::string> stack_;
  std::vector<std::size_t> open_;                                             // buildings whose end has not come yet
  std::vector<std::vector<std::pair<std::size_t, std::string>>> references_;  // per solid: slot, polygon id
  std::map<std::string, GmlPolygon> by_id_;
  std::map<std::string, std::string> surface_of_;  // "WallSurface" … by polygon id
  std::set<std::string> ids_;
  GmlPolygon polygon_;
  std::string text_, surface_, attribute_;
  bool in_solid_ = false;
};

constexpr int kOptions = XML_PARSE_NONET | XML_PARSE_HUGE | XML_PARSE_NOERROR | XML_PARSE_NOWARNING;

}  // namespace

std::string GmlBuilding::text(const std::string& name) const {
  for (const auto* list : {&attributes, &elements})
    for (const auto& [key, value] : *list)
      if (key == name) return value;
  return {};
}

GmlFile read_citygml(const std::string& path) {
  const Reader reader(xmlReaderForFile(path.c_str(), nullptr, kOptions), xmlFreeTextReader);
  if (!reader) throw std::runtime_error("cannot open " + path);
  try {
    return Parser().parse(reader.get());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ":" + std::to_string(xmlTextReaderGetParserLineNumber(reader.get())) + ": " +
                             error.what());
  }
}

GmlFile read_citygml_text(const std::string& text) {
  const Reader reader(xmlReaderForMemory(text.data(), static_cast<int>(text.size()), "memory.gml", nullptr, kOptions),
                      xmlFreeTextReader);
  if (!reader) throw std::runtime_error("cannot read from memory");
  return Parser().parse(reader.get());
}

}  // namespace blockrand::validators
