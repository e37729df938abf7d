#include "pipeline/validate/cityjson_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pipeline/base/json_depth.h"
#include "pipeline/validate/cityjson_object_reader.h"
#include "pipeline/validate/cityjson_templates.h"
#include "pipeline/validate/detail_check.h"

namespace blockrand::validate {
namespace {

using model::Point3;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Levels of arrays and objects. Those of CityJSON have a dozen; copying and printing values takes stack for each.
constexpr std::size_t kDeepest = 256;

/// Parses one JSON text and notices what the document forgets: members given twice, and the order of city objects.
struct Document {
  Json json;
  std::vector<std::string> object_order;  ///< ids in "CityObjects"
  std::vector<std::string> doubled;       ///< names of members given twice in one object
  std::string error;

  explicit Document(std::string_view text) {
    if (base::json_depth(text) > kDeepest) {
      error = fmt::format("nested deeper than {} levels", kDeepest);
      return;
    }
    std::vector<std::unordered_set<std::string>> names;  // by depth
    bool in_objects = false;
    const auto look = [&](int depth, Json::parse_event_t event, Json& value) {
      const auto level = static_cast<std::size_t>(depth);
      if (event == Json::parse_event_t::object_start) {
        if (names.size() <= level + 1) names.resize(level + 2);
        names[level + 1].clear();
      } else if (event == Json::parse_event_t::key) {
        const auto& name = value.get_ref<const std::string&>();
        if (!names[level].insert(name).second) doubled.push_back(name);
        if (level == 1) in_objects = name == "CityObjects";
        if (level == 2 && in_objects) object_order.push_back(name);
      }
      return true;
    };
    try {
      json = Json::parse(text.begin(), text.end(), look);
    } catch (const Json::exception& e) {
      error = e.what();
    }
  }
};

class FileReader {
 public:
  FileReader(const std::string& name, Contents& out) : out_(out), findings_(name, out) {}

  void read_object(std::string_view text) {
    Document document(text);
    if (!parsed(document, "")) return;
    header(document.json);
    objects(document, "");
    tell_unused();
  }

  void read_sequence(std::string_view text) {
    if (text.empty() || text.back() != '\n') findings_.rule("", "the last line has no end");
    for (std::size_t line = 1; !text.empty(); ++line) {
      const std::size_t end = text.find('\n');
      const std::string_view bytes = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      const std::string where = fmt::format("line {}", line);
      if (bytes.find_first_not_of(" \t\r") == std::string_view::npos) {
        findings_.rule("", where + " is empty");
        continue;
      }
      Document document(bytes);
      if (!parsed(document, where + ": ")) continue;
      if (line == 1)
        first_line(document);
      else
        feature(document, where);
    }
    tell_unused();
  }

 private:
  bool parsed(const Document& document, const std::string& where) {
    if (!document.error.empty()) {
      findings_.add(Check::file_unreadable, "", where + document.error);
      return false;
    }
    for (const std::string& name : document.doubled)
      findings_.rule("", fmt::format("{}\"{}\" stands twice in an object", where, name));
    if (document.json.is_object()) return true;
    findings_.rule("", where + "is no JSON object");
    return false;
  }

  void first_line(const Document& document) {
    header(document.json);
    for (const char* name : {"CityObjects", "vertices"})
      if (const Json* m = member(document.json, name); m && !m->empty())
        findings_.rule("", fmt::format("the first line's {} are not empty", name));
  }

  /// Members that a CityJSON object has and a feature has not.
  void header(const Json& root) {
    if (text(member(root, "type")) != "CityJSON") findings_.rule("", "the type is not CityJSON");
    if (text(member(root, "version")) != "2.0") findings_.rule("", "the version is not \"2.0\"");
    const Json* objects = member(root, "CityObjects");
    if (!objects || !objects->is_object()) findings_.rule("", "no CityObjects");
    const Json* vertices = member(root, "vertices");
    if (!vertices || !vertices->is_array()) findings_.rule("", "no vertices");
    const Json* transform = member(root, "transform");
    const auto scale = numbers(member(transform, "scale"), 3), translate = numbers(member(transform, "translate"), 3);
    if (!scale || !translate)
      findings_.rule("", "no transform with scale and translate");
    else if (transform->size() != 2)
      findings_.rule("", "a transform with further members");
    if (scale && translate) {
      for (std::size_t i = 0; i < 3; ++i) {
        scale_[i] = (*scale)[i];
        translate_[i] = (*translate)[i];
        if (!(scale_[i] > 0)) findings_.rule("", fmt::format("a scale of {}", scale_[i]));
      }
    }
    metadata(member(root, "metadata"));
    CityJsonScope scope;  // of the appearance beside the templates
    appearance(member(root, "appearance"), scope, "");
    templates_ = read_templates(root, scope.colours, findings_);
  }

  /// Placed elements are no vertices, but lie in the extent as well.
  void check_elements() {
    for (std::size_t i = 0; i < templates_.digests.size(); ++i)
      out_.elements.try_emplace(templates_.digests[i], templates_.elements[i]);
    if (extent_.empty()) return;
    const model::Point3 lower{extent_[0], extent_[1], extent_[2]}, upper{extent_[3], extent_[4], extent_[5]};
    for (const ReadBody& body : out_.bodies)
      for (const ReadPlacement& p : body.detail.placements)
        if (const auto element = out_.elements.find(p.element);
            element != out_.elements.end() && reaches_beyond(p, element->second, lower, upper)) {
          findings_.rule(body.id, fmt::format("an element reaches out of geographicalExtent, at {:.3f} {:.3f} {:.3f}",
                                              p.origin.x, p.origin.y, p.origin.z));
          break;  // one finding a body
        }
  }

  void tell_unused() {
    check_elements();
    if (const auto unused = std::count(templates_.used.begin(), templates_.used.end(), false); unused > 0)
      findings_.rule("", fmt::format("{} geometry templates are used by nothing", unused));
  }

  void metadata(const Json* m) {
    if (!m) return;
    if (!m->is_object()) return findings_.rule("", "the metadata are no object");
    for (const auto& [name, value] : m->items()) {
      if (name == "geographicalExtent") {
        const auto box = numbers(&value, 6);
        if (!box) {
          findings_.rule("", "geographicalExtent is not six numbers");
          continue;
        }
        for (std::size_t i = 0; i < 3; ++i)
          if ((*box)[i] > (*box)[i + 3]) findings_.rule("", "geographicalExtent is turned inside out");
        extent_ = *box;
      } else if (name == "referenceSystem") {
        if (!is_reference_system(text(&value)))
          findings_.rule("", "referenceSystem is no address of the form https://www.opengis.net/def/crs/EPSG/0/25833");
      } else if (name == "referenceDate") {
        if (!is_date(text(&value))) findings_.rule("", "referenceDate is no date");
      } else if (name == "title" || name == "identifier") {
        if (!value.is_string()) findings_.rule("", name + " is no text");
      } else if (name == "pointOfContact") {
        if (text(member(value, "contactName")).empty() || text(member(value, "emailAddress")).empty())
          findings_.rule("", "pointOfContact without contactName or emailAddress");
      } else {
        findings_.rule("", "metadata with the unknown member " + name);
      }
    }
  }

  static bool is_reference_system(std::string_view url) {
    for (const std::string_view start : {"https://www.opengis.net/def/crs/", "http://www.opengis.net/def/crs/"}) {
      if (!url.starts_with(start)) continue;
      url.remove_prefix(start.size());
      const std::size_t first = url.find('/'), second = first == url.npos ? url.npos : url.find('/', first + 1);
      return first != url.npos && first > 0 && second != url.npos && second > first + 1 && second + 1 < url.size() &&
             url.find('/', second + 1) == url.npos;
    }
    return false;
  }

  static bool is_date(std::string_view s) {
    if (s.size() != 10 || s[4] != '-' || s[7] != '-') return false;
    for (const std::size_t i : {0, 1, 2, 3, 5, 6, 8, 9})
      if (s[i] < '0' || s[i] > '9') return false;
    const int month = (s[5] - '0') * 10 + s[6] - '0', day = (s[8] - '0') * 10 + s[9] - '0';
    return month >= 1 && month <= 12 && day >= 1 && day <= 31;
  }

  void feature(const Document& document, const std::string& where) {
    const Json& root = document.json;
    const std::string id = text(member(root, "id"));
    const auto rule = [&](std::string detail) { findings_.rule(id, where + ": " + std::move(detail)); };
    if (text(member(root, "type")) != "CityJSONFeature") rule("the type is not CityJSONFeature");
    for (const auto& [name, value] : root.items())
      if (name != "type" && name != "id" && name != "CityObjects" && name != "vertices" && name != "appearance")
        rule("a feature with the member " + name);
    const Json* objects = member(root, "CityObjects");
    const Json* own = id.empty() ? nullptr : member(objects, id);
    if (!own) rule("the id of the feature is none of its city objects");
    if (!objects || !objects->is_object()) return rule("no CityObjects");
    if (const Json* vertices = member(root, "vertices"); !vertices || !vertices->is_array()) rule("no vertices");
    for (const auto& [name, object] : objects->items()) {
      const bool first_level = is_first_level(text(member(object, "type")));
      if (name == id && !first_level) rule("the feature's object is a part of another");
      if (name != id && first_level) rule(name + " is a second first-level object");
    }
    this->objects(document, where);
  }

  void objects(const Document& document, const std::string& where) {
    const Json& root = document.json;
    CityJsonScope scope;
    read_vertices(member(root, "vertices"), scope, where);
    appearance(member(root, "appearance"), scope, where);
    const Json* objects = member(root, "CityObjects");
    if (objects && objects->is_object())
      read_city_objects(*objects, document.object_order, scope, templates_, ids_, out_, findings_);
    const auto unused = std::count(scope.used.begin(), scope.used.end(), false);
    if (unused > 0) findings_.rule("", fmt::format("{}{} vertices are used by nothing", prefix(where), unused));
  }

  static std::string prefix(const std::string& where) { return where.empty() ? where : where + ": "; }

  void read_vertices(const Json* vertices, CityJsonScope& scope, const std::string& where) {
    if (!vertices || !vertices->is_array()) return;
    const auto rule = [&](std::string detail) { findings_.rule("", prefix(where) + std::move(detail)); };
    scope.used.assign(vertices->size(), false);
    scope.vertices.reserve(vertices->size());
    std::unordered_set<std::string> seen;
    std::size_t doubled = 0, no_integers = 0, outside = 0, off_grid = 0;
    for (const Json& v : *vertices) {
      double xyz[3] = {kNothing, kNothing, kNothing};
      if (v.is_array() && v.size() == 3 && v[0].is_number_integer() && v[1].is_number_integer() &&
          v[2].is_number_integer()) {
        for (std::size_t i = 0; i < 3; ++i) xyz[i] = v[i].get<double>() * scale_[i] + translate_[i];
        if (!seen.insert(fmt::format("{} {} {}", v[0].get<std::int64_t>(), v[1].get<std::int64_t>(),
                                     v[2].get<std::int64_t>()))
                 .second)
          ++doubled;
        bool on_grid = true, inside = true;
        for (std::size_t i = 0; i < 3; ++i) {
          on_grid = on_grid && model::snap(xyz[i]) == xyz[i];
          inside = inside && (extent_.empty() || (xyz[i] >= extent_[i] && xyz[i] <= extent_[i + 3]));
        }
        off_grid += !on_grid;
        outside += !inside;
      } else {
        ++no_integers;
      }
      scope.vertices.push_back({xyz[0], xyz[1], xyz[2]});
    }
    if (no_integers) rule(fmt::format("{} vertices are not three integers", no_integers));
    if (doubled) rule(fmt::format("{} vertices stand twice", doubled));
    if (outside) rule(fmt::format("{} vertices lie outside of geographicalExtent", outside));
    if (off_grid)
      findings_.add(Check::off_grid, "",
                    fmt::format("{}{} vertices are not on the 1/1024 m grid", prefix(where), off_grid));
  }

  void appearance(const Json* a, CityJsonScope& scope, const std::string& where) {
    if (!a) return;
    const auto rule = [&](std::string detail) { findings_.rule("", prefix(where) + std::move(detail)); };
    if (!a->is_object()) return rule("the appearance is no object");
    for (const auto& [name, value] : a->items())
      if (name != "materials" && name != "textures" && name != "vertices-texture" && name != "default-theme-material" &&
          name != "default-theme-texture")
        rule("an appearance with the unknown member " + name);
    scope.theme = text(member(a, "default-theme-material"));
    const Json* materials = member(a, "materials");
    if (!materials) return;
    if (!materials->is_array()) return rule("the materials are no array");
    for (const Json& m : *materials) {
      if (text(member(m, "name")).empty()) rule("a material without a name");
      scope.colours.push_back(read_colour(member(m, "diffuseColor")).value_or(""));
      if (!m.is_object()) continue;
      for (const auto& [name, value] : m.items()) {
        const bool colour = name == "diffuseColor" || name == "emissiveColor" || name == "specularColor";
        const bool share = name == "ambientIntensity" || name == "shininess" || name == "transparency";
        const auto n = number(&value);
        if (colour && !read_colour(&value)) rule(name + " is not three numbers from 0 to 1");
        if (share && !(n && *n >= 0 && *n <= 1)) rule(name + " is no number from 0 to 1");
        if (!colour && !share && name != "name" && name != "isSmooth")
          rule("a material with the unknown member " + name);
      }
    }
  }

  Contents& out_;
  CityJsonFindings findings_;
  std::array<double, 3> scale_{1, 1, 1}, translate_{};
  std::vector<double> extent_;  // empty: not said
  CityJsonTemplates templates_;
  std::unordered_set<std::string> ids_;
};

}  // namespace

Contents read_cityjson(std::string_view text, const std::string& name) {
  Contents out;
  FileReader reader(name, out);
  if (name.find(".jsonl") != std::string::npos)
    reader.read_sequence(text);
  else
    reader.read_object(text);
  return out;
}

}  // namespace blockrand::validate
