#include "importers/reference/cityjson_objects.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "importers/reference/coordinate_text.h"

namespace blockrand::importers::reference {
namespace {

enum class Part { building, surface, ignored };

/// What belongs to a building, by the names of all versions. Other types are counted only.
struct KnownType {
  const char* name;
  Part part;
  SurfaceClass surface_class;
  bool interior;
};
constexpr std::array<KnownType, 9> kTypes{{
    {"Building", Part::building, SurfaceClass::wall, false},
    {"BuildingPart", Part::building, SurfaceClass::wall, false},
    {"BuildingInstallation", Part::surface, SurfaceClass::installation, false},
    {"BuildingConstructiveElement", Part::surface, SurfaceClass::installation, false},
    {"IntBuildingInstallation", Part::surface, SurfaceClass::installation, true},
    {"BuildingRoom", Part::surface, SurfaceClass::room, true},
    {"BuildingStorey", Part::surface, SurfaceClass::room, true},
    {"BuildingUnit", Part::surface, SurfaceClass::room, true},
    {"BuildingFurniture", Part::ignored, SurfaceClass::furniture, true},
}};

const KnownType& type_of(int role) { return kTypes[static_cast<std::size_t>(role)]; }

/// m; beyond is no CRS on Earth.
constexpr double kLargest = 1e9;

/// One or several texts.
std::vector<std::string> texts_of(const Json& value) {
  std::vector<std::string> out;
  if (auto one = scalar_text(value)) out.push_back(std::move(*one));
  for (std::size_t i = 0; i < length(value); ++i)
    if (auto one = scalar_text(value[i])) out.push_back(std::move(*one));
  return out;
}

}  // namespace

void CityJsonObjects::set_templates(Json templates) {
  templates_ = std::move(templates);
  template_points_ = points_of(member(templates_, "vertices-templates"), false);
}

/// Points that are none are NaN, so that the numbers of the others hold.
std::vector<model::Point3> CityJsonObjects::points_of(const Json& vertices, bool transformed) {
  std::vector<model::Point3> out;
  out.reserve(length(vertices));
  const auto& [scale, translate] = transform_;
  for (std::size_t i = 0; i < length(vertices); ++i) {
    const Json& v = vertices[i];
    const auto x = number(element(v, 0)), y = number(element(v, 1)), z = number(element(v, 2));
    model::Point3 p{NAN, NAN, NAN};
    if (x && y && z && v.size() == 3) {
      p = {*x, *y, *z};
      if (transformed) p = {*x * scale[0] + translate[0], *y * scale[1] + translate[1], *z * scale[2] + translate[2]};
    }
    const bool sane = std::fabs(p.x) < kLargest && std::fabs(p.y) < kLargest && std::fabs(p.z) < kLargest;
    if (!sane) {
      note(NoteKind::bad_coordinates, "vertex " + std::to_string(i));
      p = {NAN, NAN, NAN};
    }
    out.push_back(p);
  }
  return out;
}

void CityJsonObjects::add(const Json& objects, const std::vector<std::string>& ids, const Json& vertices, int line) {
  line_ = line;
  here_.clear();
  vertices_ = points_of(vertices, true);
  read_members(objects, ids);
  find_parents();
  cut_circles();
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (type_of(members_[i].role).part == Part::building && members_[i].parent == kNone) add_building(i);
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (type_of(members_[i].role).part == Part::surface) add_thing(i);
}

void CityJsonObjects::read_members(const Json& objects, const std::vector<std::string>& ids) {
  members_.clear();
  member_ids_.clear();
  numbers_.clear();
  for (const std::string& id : ids) {
    const auto found = objects.find(id);
    if (found == objects.end()) continue;
    here_ = id;
    const std::string type = text(member(*found, "type"));
    const auto known = std::find_if(kTypes.begin(), kTypes.end(), [&](const KnownType& t) { return type == t.name; });
    if (known == kTypes.end() || known->part == Part::ignored) {
      if (type.empty()) note(NoteKind::malformed_json, "no type");
      auto& others = model_.other_objects;
      const std::string name = type.empty() ? "without type" : type;
      const auto counted = std::find_if(others.begin(), others.end(), [&](const auto& o) { return o.first == name; });
      if (counted == others.end()) {
        others.emplace_back(name, 1);
      } else {
        ++counted->second;
      }
      continue;
    }
    Member m;
    m.object = &*found;
    m.role = static_cast<int>(known - kTypes.begin());
    if (!numbers_.emplace(id, members_.size()).second) continue;
    members_.push_back(std::move(m));
    member_ids_.push_back(id);
  }
  here_.clear();
}

/// "parents" decides; where it is missing, the "children" of another do.
void CityJsonObjects::find_parents() {
  std::vector<std::size_t> named(members_.size(), kNone);
  for (std::size_t i = 0; i < members_.size(); ++i)
    for (const std::string& id : texts_of(member(*members_[i].object, "children")))
      if (const auto child = numbers_.find(id);
          child != numbers_.end() && child->second != i && named[child->second] == kNone)
        named[child->second] = i;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    here_ = member_ids_[i];
    for (const std::string& id : texts_of(member(*members_[i].object, "parents"))) {
      const auto parent = numbers_.find(id);
      if (parent == numbers_.end() || parent->second == i) {
        note(NoteKind::bad_hierarchy,
             "its parent \"" + id + "\" is " + (parent == numbers_.end() ? "missing" : "itself"));
      } else if (members_[i].parent == kNone) {
        members_[i].parent = parent->second;
      }
    }
    if (members_[i].parent == kNone) members_[i].parent = named[i];
    // A building is no part of anything.
    if (members_[i].parent != kNone && text(member(*members_[i].object, "type")) == "Building")
      members_[i].parent = kNone;
  }
  here_.clear();
}

void CityJsonObjects::cut_circles() {
  std::vector<std::size_t> walk(members_.size(), kNone);  // the walk that a member was met on
  for (std::size_t i = 0; i < members_.size(); ++i) {
    for (std::size_t at = i; at != kNone && walk[at] == kNone; at = members_[at].parent) {
      walk[at] = i;
      const std::size_t next = members_[at].parent;
      if (next == kNone || walk[next] != i) continue;
      here_ = member_ids_[at];
      note(NoteKind::bad_hierarchy, "its parents stand in a circle");
      members_[at].parent = kNone;
      break;
    }
  }
  here_.clear();
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& m = members_[i];
    // A part of a room, say: it belongs to the room's building.
    if (type_of(m.role).part == Part::building)
      while (m.parent != kNone && type_of(members_[m.parent].role).part != Part::building)
        m.parent = members_[m.parent].parent;
  }
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (type_of(members_[i].role).part == Part::building && members_[i].parent != kNone)
      members_[members_[i].parent].children.push_back(i);
}

/// The building and its parts, the parts of a part right behind it.
void CityJsonObjects::add_building(std::size_t first) {
  std::vector<std::size_t> open{first};
  while (!open.empty()) {
    const std::size_t i = open.back();
    open.pop_back();
    Member& m = members_[i];
    m.building = model_.buildings.size();
    here_ = member_ids_[i];
    Building b;
    b.id = here_;
    b.line = line_;
    if (m.parent != kNone) b.parent = static_cast<int>(members_[m.parent].building);
    if (b.id.empty()) note(NoteKind::missing_id, "a " + text(member(*m.object, "type")) + " without id");
    if (!building_ids_.insert(b.id).second) note(NoteKind::duplicate_id, "twice in the file");
    read_attributes(member(*m.object, "attributes"), b);
    model_.buildings.push_back(std::move(b));
    Target target;
    target.building = m.building;
    read_geometries(*m.object, target);
    open.insert(open.end(), m.children.rbegin(), m.children.rend());
  }
  here_.clear();
}

void CityJsonObjects::add_thing(std::size_t i) {
  const Member& m = members_[i];
  here_ = member_ids_[i];
  std::size_t owner = m.parent;
  while (owner != kNone && members_[owner].building == kNone) owner = members_[owner].parent;
  if (owner == kNone) {
    note(NoteKind::bad_hierarchy, "belongs to no building; left out");
    return;
  }
  const KnownType& type = type_of(m.role);
  Target target;
  target.building = members_[owner].building;
  auto& surfaces = model_.buildings[target.building].surfaces;
  target.surface = static_cast<int>(surfaces.size());
  target.interior = type.interior;
  target.of_installation = type.surface_class == SurfaceClass::installation;
  Surface s;
  s.surface_class = type.surface_class;
  s.id = here_;
  s.interior = type.interior;
  surfaces.push_back(std::move(s));
  read_geometries(*m.object, target);
}

// ---- attributes ---------------------------------------------------------------------------------------------------

void CityJsonObjects::read_attributes(const Json& attributes, Building& building) {
  if (!attributes.is_object()) return;
  for (const auto& [name, value] : attributes.items())
    if (!value.is_null() && !read_known(name, value, building)) read_generic(name, value, building, 0);
}

/// \return false where the attribute has no member of its own, or not the value for it
bool CityJsonObjects::read_known(const std::string& name, const Json& value, Building& b) {
  bool good = true;
  const auto whole = [&](std::optional<int>& target) {
    const auto v = loose_number(value);
    good = v && *v >= 0 && *v <= kLargest && *v == std::floor(*v);
    if (good) target = static_cast<int>(*v);
  };
  const auto year = [&](std::optional<int>& target) {
    const auto as_text = scalar_text(value);
    const auto v = as_text ? year_of(*as_text) : std::nullopt;
    good = v.has_value();
    if (good) target = v;
  };
  const auto append = [&](std::vector<std::string>& target) {
    const std::vector<std::string> all = texts_of(value);
    target.insert(target.end(), all.begin(), all.end());
  };
  const auto one = [&](std::string& target) {
    if (const auto all = texts_of(value); !all.empty()) target = all[0];
  };
  if (name == "name") {
    append(b.names);
  } else if (name == "function") {
    append(b.functions);
  } else if (name == "usage") {
    append(b.usages);
  } else if (name == "class") {
    one(b.class_code);
  } else if (name == "roofType") {
    one(b.roof_type);
  } else if (name == "measuredHeight") {
    const auto v = loose_number(value);
    good = v.has_value();
    if (good) b.measured_height = v;
  } else if (name == "storeysAboveGround") {
    whole(b.storeys_above_ground);
  } else if (name == "storeysBelowGround") {
    whole(b.storeys_below_ground);
  } else if (name == "yearOfConstruction" || name == "dateOfConstruction") {
    year(b.year_of_construction);
  } else if (name == "yearOfDemolition" || name == "dateOfDemolition") {
    year(b.year_of_demolition);
  } else {
    return false;
  }
  if (!good) note(NoteKind::bad_value, name + " " + scalar_text(value).value_or("that is no value"));
  return true;
}

/// Objects become "set/name", arrays one attribute for each scalar in them.
void CityJsonObjects::read_generic(const std::string& name, const Json& value, Building& building, int depth) {
  constexpr int kDeepest = 8;
  if (depth > kDeepest) {
    note(NoteKind::bad_value, name + " is nested too deeply");
  } else if (value.is_object()) {
    for (const auto& [inner, v] : value.items()) read_generic(name + "/" + inner, v, building, depth + 1);
  } else if (value.is_array()) {
    for (const Json& v : value) read_generic(name, v, building, depth + 1);
  } else if (auto as_text = scalar_text(value)) {
    building.attributes.emplace_back(name, std::move(*as_text));
  }
}

}  // namespace blockrand::importers::reference
