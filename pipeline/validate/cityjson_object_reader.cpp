#include "pipeline/validate/cityjson_object_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "pipeline/base/text.h"
#include "pipeline/geometry/solid_defect.h"
#include "pipeline/validate/attribute_names.h"
#include "pipeline/validate/cityjson_templates.h"
#include "pipeline/validate/detail_check.h"
#include "pipeline/validate/ids.h"

namespace blockrand::validate {
namespace {

using model::Point3;

// clang-format off
const std::unordered_set<std::string_view> kFirstLevel = {
    "Bridge", "Building", "CityFurniture", "CityObjectGroup", "GenericCityObject", "LandUse", "OtherConstruction",
    "PlantCover", "Railway", "Road", "SolitaryVegetationObject", "TINRelief", "TransportSquare", "Tunnel", "WaterBody",
    "Waterway"};
const std::unordered_set<std::string_view> kSecondLevel = {
    "BridgeConstructiveElement", "BridgeFurniture", "BridgeInstallation", "BridgePart", "BridgeRoom",
    "BuildingConstructiveElement", "BuildingFurniture", "BuildingInstallation", "BuildingPart", "BuildingRoom",
    "BuildingStorey", "BuildingUnit", "TunnelConstructiveElement", "TunnelFurniture", "TunnelHollowSpace",
    "TunnelInstallation", "TunnelPart"};
// clang-format on

struct SurfaceType {
  std::string_view type, kind;
};
constexpr SurfaceType kSurfaces[] = {{"GroundSurface", "ground"},
                                     {"WallSurface", "wall"},
                                     {"RoofSurface", "roof"},
                                     {"OuterCeilingSurface", "outer_ceiling"},
                                     {"OuterFloorSurface", "outer_floor"},
                                     {"ClosureSurface", "closure"},
                                     {"Window", "window"},
                                     {"Door", "door"}};

/// Arrays around a surface, by the type of a geometry that buildings may have.
int surface_depth(std::string_view type) {
  if (type == "MultiSurface" || type == "CompositeSurface") return 1;
  if (type == "Solid") return 2;
  if (type == "MultiSolid" || type == "CompositeSolid") return 3;
  return 0;
}

bool is_lod(const std::string& text) {
  const auto digit = [&](std::size_t i) { return text[i] >= '0' && text[i] <= '9'; };
  return (text.size() == 1 && digit(0)) || (text.size() == 3 && digit(0) && text[1] == '.' && digit(2));
}

/// The shortest text of a number; "" for what is no number or text.
std::string scalar_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (const auto n = number(&value)) return base::shortest(*n);
  return {};
}

class ObjectReader {
 public:
  ObjectReader(const Json& objects, CityJsonScope& scope, CityJsonTemplates& templates, Contents& out,
               CityJsonFindings& findings)
      : objects_(objects), scope_(scope), templates_(templates), out_(out), findings_(findings) {}

  void read(const std::string& id, const Json& object) {
    id_ = id;
    if (!object.is_object()) return rule("is no object");
    const std::string type = text(member(object, "type"));
    const bool extension = type.size() > 1 && type[0] == '+';
    if (!extension && !kFirstLevel.contains(type) && !kSecondLevel.contains(type))
      return rule(fmt::format("of the unknown type \"{}\"", type));
    family(object, type);
    if (const Json* attributes = member(object, "attributes"); attributes && !attributes->is_object())
      rule("its attributes are no object");
    if (const Json* address = member(object, "address")) {
      bool objects = address->is_array();
      for (const Json& a : objects ? *address : Json::array()) objects = objects && a.is_object();
      if (!objects) rule("its address is no array of objects");
    }
    if (const Json* extent = member(object, "geographicalExtent"); extent && !numbers(extent, 6))
      rule("its geographicalExtent is not six numbers");
    const Json* geometry = member(object, "geometry");
    if (geometry && !geometry->is_array()) {
      rule("its geometry is no array");
      geometry = nullptr;
    }
    if (type == "Building" || type == "BuildingPart") building(object, type, geometry);
    if (type == "BuildingInstallation") installation(object, geometry);
  }

 private:
  void rule(std::string detail) { findings_.rule(id_, std::move(detail)); }

  /// The ids in "parents" or "children"; `absent` where there is no such member.
  std::vector<std::string> relatives(const Json& object, const char* name) {
    std::vector<std::string> out;
    const Json* list = member(object, name);
    if (!list) return out;
    if (!list->is_array()) {
      rule(fmt::format("its {} are no array", name));
      return out;
    }
    for (const Json& v : *list) {
      if (!v.is_string()) {
        rule(fmt::format("one of its {} is no text", name));
        continue;
      }
      out.push_back(v.get<std::string>());
      if (std::count(out.begin(), out.end(), out.back()) > 1) rule(fmt::format("{} twice in its {}", out.back(), name));
    }
    return out;
  }

  static bool lists(const Json& object, const char* name, const std::string& id) {
    const Json* list = member(object, name);
    return list && list->is_array() && std::find(list->begin(), list->end(), Json(id)) != list->end();
  }

  void family(const Json& object, const std::string& type) {
    const std::vector<std::string> parents = relatives(object, "parents"), children = relatives(object, "children");
    if (kSecondLevel.contains(type) && parents.empty()) rule(type + " without parents");
    if (kFirstLevel.contains(type) && type != "CityObjectGroup" && !parents.empty()) rule(type + " with parents");
    for (const std::string& parent : parents) {
      const Json* found = member(objects_, parent);
      if (!found)
        rule("its parent " + parent + " is not in the file");
      else if (!lists(*found, "children", id_))
        rule("its parent " + parent + " does not name it as a child");
    }
    for (const std::string& child : children) {
      const Json* found = member(objects_, child);
      if (!found)
        rule("its child " + child + " is not in the file");
      else if (!lists(*found, "parents", id_))
        rule("its child " + child + " does not name it as a parent");
    }
  }

  void building(const Json& object, const std::string& type, const Json* geometry) {
    const bool part = type == "BuildingPart";
    if (!part) out_.buildings.push_back(id_);
    if (!(part ? is_body_id(id_) : is_osm_id(id_))) rule("is no id of Blockrand");
    ReadBody body;
    body.id = id_;
    const Json* parent = element(member(object, "parents"), 0);
    body.building = part ? text(parent) : id_;
    if (part && building_of(id_) != body.building) rule("belongs to another building than its id says");
    attributes(object, body);
    for (const Json& g : geometry ? *geometry : Json::array()) read_geometry(g, body);
    check_detail(body, [&](std::string what, const std::string& id) { findings_.rule(id, std::move(what)); });
    if (has_parts(object)) {
      if (!body.footprint.empty() || !body.solids.empty()) rule("has geometry beside its parts");
      return;  // a building of several parts is no body
    }
    for (std::size_t i = 0; i + 1 < body.solids.size(); ++i)
      if (body.solids[i].lod >= body.solids[i + 1].lod) rule("has solids out of the order of their LoD, or one twice");
    const auto lod = body.attributes.find("lod");
    if (lod == body.attributes.end())
      rule("has neither parts nor an attribute lod");
    else if (lod->second >= "0" && lod->second <= "9" && body.footprint.empty())
      rule("has no geometry of LoD 0");
    out_.bodies.push_back(std::move(body));
  }

  bool has_parts(const Json& object) const {
    const Json* children = member(object, "children");
    for (const Json& child : children && children->is_array() ? *children : Json::array())
      if (const Json* found = child.is_string() ? member(objects_, child.get<std::string>()) : nullptr;
          found && text(member(*found, "type")) == "BuildingPart")
        return true;
    return false;
  }

  /// Elements where they stand, or a body of its own: of the body that its parent is.
  void installation(const Json& object, const Json* geometry) {
    const std::string parent = text(element(member(object, "parents"), 0));
    const auto body =
        std::find_if(out_.bodies.rbegin(), out_.bodies.rend(), [&](const ReadBody& b) { return b.id == parent; });
    if (body == out_.bodies.rend()) return rule("its parent " + parent + " is no body that stands before it");
    const std::string kind = text(member(member(object, "attributes"), "function"));
    if (kind.empty()) rule("has no function");
    if (!geometry || geometry->empty()) return rule("has no geometry");
    for (const Json& g : *geometry) {
      if (text(member(g, "type")) == "GeometryInstance") {
        if (const auto placement =
                read_instance(g, scope_, templates_, [&](std::string what) { rule(std::move(what)); }))
          body->detail.placements.push_back(*placement);
        continue;
      }
      ReadBody own;
      read_geometry(g, own);
      if (own.solids.size() != 1 || own.solids[0].lod != 3 || !own.solids[0].closed) {
        rule("has a geometry that is no solid of LoD 3");
        continue;
      }
      body->detail.installations.push_back({id_, kind, std::move(own.solids[0].polygons)});
    }
  }

  // ---- attributes ----

  void attributes(const Json& object, ReadBody& body) {
    const Json* all = member(object, "attributes");
    if (!all || !all->is_object()) return rule("has no attributes");
    for (const std::string& name : attribute_names()) {
      const Json *value = member(all, name), *source = member(all, name + "_source"),
                 *confidence = member(all, name + "_confidence");
      if (value) {
        body.attributes[name] = scalar_text(*value);
        if (body.attributes[name].empty()) rule(name + " is neither a number nor a text");
        if (!source || !confidence) findings_.add(Check::source_wrong, id_, name + " without source or confidence");
      }
      if (source) {
        body.attributes[name + "_source"] = text(source);
        if (!is_source(text(source)))
          findings_.add(Check::source_wrong, id_, fmt::format("{} from \"{}\"", name, text(source)));
      }
      if (confidence) {
        const auto c = number(confidence);
        body.attributes[name + "_confidence"] = scalar_text(*confidence);
        if (!c || *c < 0 || *c > 1)
          findings_.add(Check::source_wrong, id_,
                        fmt::format("confidence of {} is {}", name, body.attributes[name + "_confidence"]));
      }
    }
    for (const char* name : {"built_roof", "lod", "fallbacks"})
      if (const Json* value = member(all, name)) body.attributes[name] = scalar_text(*value);
    const std::pair<const char*, const char*> same[] = {
        {"measuredHeight", "height"}, {"storeysAboveGround", "storeys"}, {"function", "use"}};
    for (const auto& [standard, name] : same)
      if (const Json* value = member(all, standard); value && scalar_text(*value) != body.attributes[name])
        rule(fmt::format("{} is {}, but {} is {}", standard, scalar_text(*value), name, body.attributes[name]));
    const std::string owner_id = owner(id_), link = text(member(all, "externalReference"));
    const std::string kind = owner_id.starts_with('n') ? "node/" : owner_id.starts_with('w') ? "way/" : "relation/";
    if (!link.empty() && !owner_id.empty() && link != "https://www.openstreetmap.org/" + kind + owner_id.substr(1))
      rule("its external reference leads to " + link.substr(0, 80));
  }

  // ---- geometry ----

  void read_geometry(const Json& g, ReadBody& body) {
    if (!g.is_object()) return rule("has a geometry that is no object");
    for (const auto& [name, value] : g.items())
      if (name != "type" && name != "lod" && name != "boundaries" && name != "semantics" && name != "material" &&
          name != "texture")
        rule("has a geometry with the unknown member " + name);
    const std::string type = text(member(g, "type")), lod = text(member(g, "lod"));
    const int depth = surface_depth(type);
    if (depth == 0) return rule(fmt::format("has a geometry of the type \"{}\"", type));
    if (!is_lod(lod)) return rule("has a geometry whose lod is no text of the form 2 or 2.1");
    // Surfaces of a landmark's model or of rules for footprints stand where a solid would.
    const bool surfaces_alone = depth == 1 && (lod[0] == '2' || lod[0] == '3');
    if ((lod[0] == '0') != (depth == 1) && !surfaces_alone) rule(fmt::format("has a {} of LoD {}", type, lod));
    const Json* boundaries = member(g, "boundaries");
    if (!boundaries || !boundaries->is_array()) return rule("has a geometry without boundaries");
    where_ = fmt::format("its {} of LoD {}", type, lod);
    kinds_.clear();
    parents_.clear();
    polygons_.clear();
    semantic_of_.clear();
    const Json* kinds = semantics(g);
    const Json* single = nullptr;
    const Json* colours = material(g, single);
    surfaces(*boundaries, depth, kinds, colours, single);
    if (depth == 1 && !surfaces_alone) {
      for (ReadPolygon& p : polygons_) body.footprint.push_back(std::move(p));
    } else {
      if (polygons_.size() < 4 && !surfaces_alone) rule(fmt::format("{} has {} faces", where_, polygons_.size()));
      // A second solid of LoD 3, which is found, leaves it open which one has the openings.
      const bool another =
          std::any_of(body.solids.begin(), body.solids.end(), [](const ReadSolid& s) { return s.lod == 3; });
      if (lod[0] == '3' && another) body.detail.openings.clear();
      if (lod[0] == '3' && !another) openings(body);
      body.solids.push_back({lod[0] - '0', std::move(polygons_), !surfaces_alone});
    }
    polygons_.clear();
  }

  /// Windows and doors with the wall whose surface is their parent: its first polygon, then its reveals.
  void openings(ReadBody& body) {
    std::vector<std::vector<std::size_t>> of_surface(kinds_.size());
    for (std::size_t i = 0; i < polygons_.size(); ++i)
      if (semantic_of_[i] < of_surface.size()) of_surface[semantic_of_[i]].push_back(i);
    std::set<std::size_t> walls_told;
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
      if (polygons_[i].kind != "window" && polygons_[i].kind != "door") continue;
      const std::size_t parent = parents_[semantic_of_[i]];
      if (parent >= of_surface.size() || of_surface[parent].empty()) {
        rule(fmt::format("{} has a {} that is in no wall", where_, polygons_[i].kind));
        continue;
      }
      const auto& wall = of_surface[parent];
      ReadOpening opening{fmt::format("{}_p{}", id_, i), i, wall.front(), {}, std::nullopt};
      if (walls_told.insert(parent).second) opening.reveals.assign(wall.begin() + 1, wall.end());
      body.detail.openings.push_back(std::move(opening));
    }
  }

  /// The kinds of "surfaces" go to kinds_, their parents to parents_; returns "values".
  const Json* semantics(const Json& g) {
    const Json* s = member(g, "semantics");
    if (!s) return nullptr;
    const Json *list = member(*s, "surfaces"), *values = member(*s, "values");
    if (!list || !list->is_array() || !values) {
      rule(where_ + " has semantics without surfaces or values");
      return nullptr;
    }
    // Numbers that surfaces name as their children; a wall may have a hundred thousand.
    std::map<std::uint64_t, std::set<double>> named;
    const auto children_of = [&](std::uint64_t surface) -> const std::set<double>& {
      const auto [found, fresh] = named.try_emplace(surface);
      const Json* children = fresh ? member(element(list, surface), "children") : nullptr;
      if (children && children->is_array())
        for (const Json& child : *children)
          if (child.is_number()) found->second.insert(child.get<double>());
      return found->second;
    };
    for (const Json& surface : *list) {
      const std::string type = text(member(surface, "type"));
      const auto found = std::find_if(std::begin(kSurfaces), std::end(kSurfaces),
                                      [&](const SurfaceType& t) { return t.type == type; });
      if (found == std::end(kSurfaces) && !type.starts_with('+'))
        rule(fmt::format("{} has a surface of the type \"{}\"", where_, type));
      kinds_.emplace_back(found == std::end(kSurfaces) ? "" : found->kind);
      const auto parent = whole(member(surface, "parent"));
      parents_.push_back(parent ? static_cast<std::size_t>(*parent) : kNoSurface);
      if (parent && !children_of(*parent).contains(static_cast<double>(kinds_.size() - 1)))
        rule(fmt::format("{} has a surface whose parent does not name it as a child", where_));
    }
    return values->is_null() ? nullptr : values;
  }

  /// "values" of the preferred theme; `single` is its "value" where all surfaces have the same.
  const Json* material(const Json& g, const Json*& single) {
    const Json* themes = member(g, "material");
    if (!themes) return nullptr;
    if (!themes->is_object() || themes->empty()) {
      rule(where_ + " has a material that is no object of themes");
      return nullptr;
    }
    for (const auto& [name, theme] : themes->items())
      if ((member(theme, "values") != nullptr) == (member(theme, "value") != nullptr))
        rule(fmt::format("{} has the theme {} without values, or with two kinds of them", where_, name));
    const Json* theme = member(*themes, scope_.theme);
    if (!theme) theme = &themes->begin().value();
    single = member(*theme, "value");
    const Json* values = member(*theme, "values");
    return values && values->is_null() ? nullptr : values;
  }

  /// Walks boundaries, semantics and materials side by side down to the surfaces.
  void surfaces(const Json& boundaries, int depth, const Json* kinds, const Json* colours, const Json* single) {
    if (!boundaries.is_array()) return rule(where_ + " has boundaries of the wrong depth");
    const auto parallel = [&](const Json*& values, const char* name) {
      if (!values || (values->is_array() && values->size() == boundaries.size())) return;
      if (!values->is_null())
        rule(fmt::format("{} has {} of {} values beside {} surfaces or shells", where_, name,
                         values->is_array() ? values->size() : 0, boundaries.size()));
      values = nullptr;
    };
    parallel(kinds, "semantics");
    parallel(colours, "a material");
    for (std::size_t i = 0; i < boundaries.size(); ++i) {
      const Json *kind = element(kinds, i), *colour = element(colours, i);
      if (depth > 1)
        surfaces(boundaries[i], depth - 1, kind, colour, single);
      else
        surface(boundaries[i], kind, colour ? colour : single);
    }
  }

  void surface(const Json& rings, const Json* kind, const Json* colour) {
    ReadPolygon polygon;
    if (!rings.is_array() || rings.empty()) return rule(where_ + " has a surface without rings");
    for (const Json& ring : rings)
      if (!read_ring(ring, polygon)) return;
    if (kind && !kind->is_null()) {
      const auto index = whole(kind);
      if (index && *index < kinds_.size())
        polygon.kind = kinds_[*index];
      else
        rule(fmt::format("{} has the semantic index {} of {}", where_, kind->dump(), kinds_.size()));
    }
    if (colour && !colour->is_null()) {
      const auto index = whole(colour);
      if (index && *index < scope_.colours.size())
        polygon.colour = scope_.colours[*index];
      else
        rule(fmt::format("{} has the material index {} of {}", where_, colour->dump(), scope_.colours.size()));
    }
    const auto semantic = whole(kind);
    semantic_of_.push_back(semantic ? static_cast<std::size_t>(*semantic) : kNoSurface);
    polygons_.push_back(std::move(polygon));
  }

  bool read_ring(const Json& ring, ReadPolygon& polygon) {
    const auto wrong = [&](std::string detail) {
      rule(where_ + ' ' + std::move(detail));
      return false;
    };
    const auto defect = [&](geometry::SolidDefect what) {
      findings_.rule(id_, fmt::format("{} has a ring: {} {}", where_, iso_code(what), name(what)), iso_code(what));
      return false;
    };
    if (!ring.is_array()) return wrong("has boundaries of the wrong depth");
    std::vector<std::uint64_t> indices;
    for (const Json& v : ring) {
      if (v.is_array()) return wrong("has boundaries of the wrong depth");
      const auto index = whole(&v);
      if (!index || *index >= scope_.vertices.size())
        return wrong(fmt::format("has the vertex index {} of {}", v.dump().substr(0, 20), scope_.vertices.size()));
      indices.push_back(*index);
      scope_.used[*index] = true;
      if (!scope_.lies_somewhere(*index)) return wrong(fmt::format("has the vertex {}, which is no point", *index));
    }
    if (std::set<std::uint64_t>(indices.begin(), indices.end()).size() < 3)
      return defect(geometry::SolidDefect::too_few_points);
    if (indices.front() == indices.back()) return wrong("has a ring whose last vertex repeats the first");
    if (std::adjacent_find(indices.begin(), indices.end()) != indices.end())
      return defect(geometry::SolidDefect::same_points);
    auto& points = polygon.rings.emplace_back();
    for (const std::uint64_t i : indices) points.push_back(scope_.vertices[i]);
    return true;
  }

  static constexpr std::size_t kNoSurface = static_cast<std::size_t>(-1);
  const Json& objects_;
  CityJsonScope& scope_;
  CityJsonTemplates& templates_;
  Contents& out_;
  CityJsonFindings& findings_;
  std::string id_, where_;
  std::vector<std::string> kinds_;        // of the semantic surfaces of the geometry at hand
  std::vector<std::size_t> parents_;      // of the same: their parents
  std::vector<ReadPolygon> polygons_;     // of the geometry at hand
  std::vector<std::size_t> semantic_of_;  // of the same: their semantic surfaces
};

}  // namespace

bool is_first_level(std::string_view type) { return kFirstLevel.contains(type); }

std::optional<std::string> read_colour(const Json* value) {
  const auto channels = numbers(value, 3);
  if (!channels) return std::nullopt;
  std::string out = "#";
  for (const double c : *channels) {
    if (c < 0 || c > 1) return std::nullopt;
    out += fmt::format("{:02x}", std::lround(c * 255));
  }
  return out;
}

void read_city_objects(const Json& objects, const std::vector<std::string>& order, CityJsonScope& scope,
                       CityJsonTemplates& templates, std::unordered_set<std::string>& ids, Contents& out,
                       CityJsonFindings& findings) {
  ObjectReader reader(objects, scope, templates, out, findings);
  for (const std::string& id : order) {
    if (!ids.insert(id).second) findings.rule(id, "its id is given twice in the file");
    // Of city objects that are given twice only the last ones are there.
    if (const Json* object = member(objects, id)) reader.read(id, *object);
  }
}

}  // namespace blockrand::validate
