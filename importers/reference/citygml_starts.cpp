// What an element starts, by its name and by what stands open around it.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

#include "importers/reference/citygml_parser.h"

namespace blockrand::importers::reference {
namespace {

bool any_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Different srsNames that are kept for the comparison with the first.
constexpr std::size_t kMostSrsNames = 16;

}  // namespace

CityGmlParser::Role CityGmlParser::start(const Element& e) {
  const std::string& srs = e.attributes.srs_name;
  if (!srs.empty() && facts_.srs_names.size() < kMostSrsNames &&
      std::find(facts_.srs_names.begin(), facts_.srs_names.end(), srs) == facts_.srs_names.end())
    facts_.srs_names.push_back(srs);
  if (in_template_) {
    if (e.space == Space::foreign) return skip();
    return polygon_ ? start_in_polygon(e) : start_geometry(e);
  }
  const bool own = e.space == Space::citygml || e.space == Space::none;
  if (own && !in_property_ && any_of(e.name, {"Building", "BuildingPart"})) return start_building(e);
  return open_.empty() ? start_outside(e) : start_in_building(e);
}

CityGmlParser::Role CityGmlParser::start_outside(const Element& e) {
  if (e.name == "appearanceMember" || e.name == "Appearance") return skip();
  if (e.name == "Envelope" && stack_.size() <= 2) return Role::envelope;
  if (e.name == "description" && stack_.size() == 1) return Role::description;
  if (parent_role() == Role::envelope && any_of(e.name, {"lowerCorner", "upperCorner", "pos"})) return Role::corner;
  // One end tag missing shifts all that follow: a member may stand in a member.
  const auto is_member = [](std::string_view name) {
    return any_of(name, {"cityObjectMember", "featureMember", "featureMembers", "groupMember"});
  };
  const bool member = is_member(parent_name()) && !is_member(e.name);
  if (member && e.space != Space::gml) {
    auto& others = model_.other_objects;
    const auto known = std::find_if(others.begin(), others.end(), [&](const auto& o) { return o.first == e.name; });
    if (known == others.end()) {
      others.emplace_back(e.name, 1);
    } else {
      ++known->second;
    }
    if (e.name != "CityObjectGroup") return skip();
  }
  return Role::other;
}

CityGmlParser::Role CityGmlParser::start_building(const Element& e) {
  Building b;
  b.id = e.attributes.id;
  b.line = e.line;
  if (!open_.empty()) b.parent = static_cast<int>(open_.back().building);
  if (b.id.empty()) notes_.add(NoteKind::missing_id, e.line, "a " + e.name + " without gml:id");
  OpenThing thing;
  thing.building = model_.buildings.size();
  open_.push_back(thing);
  model_.buildings.push_back(std::move(b));
  return Role::building;
}

CityGmlParser::Role CityGmlParser::start_in_building(const Element& e) {
  if (e.space == Space::foreign) {
    notes_.add(NoteKind::unknown_element, e.line, e.name);
    return skip();
  }
  if (in_implicit_) return start_implicit(e);
  if (in_property_) return polygon_ ? start_in_polygon(e) : start_geometry(e);
  if (any_of(e.name, {"address", "externalReference", "appearance", "generalizesTo"})) return skip();
  if (e.name.size() > 4 && e.name.starts_with("lod") && e.name[3] >= '0' && e.name[3] <= '4') return start_property(e);
  const Role around = parent_role();
  if (around == Role::building || around == Role::attribute_set) {
    if (e.name == "genericAttributeSet") return Role::attribute_set;
    if (e.name.ends_with("Attribute")) return Role::attribute;
  }
  if (around == Role::attribute && e.name == "value") return Role::attribute_value;
  if (around == Role::building &&
      any_of(e.name, {"name", "class", "function", "usage", "roofType", "measuredHeight", "storeysAboveGround",
                      "storeysBelowGround", "yearOfConstruction", "yearOfDemolition"}))
    return Role::value;
  return start_thing(e);
}

CityGmlParser::Role CityGmlParser::start_property(const Element& e) {
  const std::string_view what = std::string_view(e.name).substr(4);
  if (what.find("Implicit") != std::string_view::npos) {
    const OpenThing& thing = open_.back();
    const bool furniture =
        thing.surface >= 0 &&
        building().surfaces[static_cast<std::size_t>(thing.surface)].surface_class == SurfaceClass::furniture;
    if (furniture) return skip();
    Implicit use{};
    use.building = thing.building;
    use.surface = thing.surface;
    use.opening = thing.opening;
    use.lod = e.name[3] - '0';
    use.line = e.line;
    use.begin = use.end = links_.size();
    implicit_.push_back(std::move(use));
    in_implicit_ = true;
    return Role::implicit_property;
  }
  if (what.find("Curve") != std::string_view::npos || what.find("Intersection") != std::string_view::npos) {
    notes_.add(NoteKind::not_read, e.line, "curves of " + e.name);
    return skip();
  }
  in_property_ = true;
  property_lod_ = e.name[3] - '0';
  begin_geometry(what == "FootPrint"  ? GeometryKind::footprint
                 : what == "RoofEdge" ? GeometryKind::roof_edge
                                      : GeometryKind::surfaces,
                 "");
  if (!e.attributes.href.empty()) links_.add_link(e.attributes.href, false, e.line);
  return Role::property;
}

/// The template of a use, or of an object that is not looked at: other uses may link to it.
CityGmlParser::Role CityGmlParser::start_template(const Element& e) {
  in_template_ = in_property_ = true;
  resume_skip_ = skip_depth_;
  skip_depth_ = 0;
  if (!e.attributes.href.empty()) links_.add_link(e.attributes.href, false, e.line);
  is_template_.resize(model_.polygons.size(), false);
  return Role::relative_geometry;
}

CityGmlParser::Role CityGmlParser::start_implicit(const Element& e) {
  if (e.name == "relativeGMLGeometry") return start_template(e);
  if (e.name == "transformationMatrix") return Role::matrix;
  if (e.name == "libraryObject") return Role::library;
  const bool in_point = parent_name() == "Point" || parent_name() == "referencePoint";
  return in_point && any_of(e.name, {"pos", "coordinates"}) ? Role::reference_point : Role::other;
}

CityGmlParser::Role CityGmlParser::start_thing(const Element& e) {
  struct Known {
    std::string_view name;
    SurfaceClass surface_class;
    bool interior;
  };
  static constexpr std::array<Known, 13> kKnown{{
      {"GroundSurface", SurfaceClass::ground, false},
      {"WallSurface", SurfaceClass::wall, false},
      {"RoofSurface", SurfaceClass::roof, false},
      {"ClosureSurface", SurfaceClass::closure, false},
      {"OuterCeilingSurface", SurfaceClass::outer_ceiling, false},
      {"OuterFloorSurface", SurfaceClass::outer_floor, false},
      {"FloorSurface", SurfaceClass::floor, true},
      {"CeilingSurface", SurfaceClass::ceiling, true},
      {"InteriorWallSurface", SurfaceClass::interior_wall, true},
      {"BuildingInstallation", SurfaceClass::installation, false},
      {"IntBuildingInstallation", SurfaceClass::installation, true},
      {"Room", SurfaceClass::room, true},
      {"BuildingFurniture", SurfaceClass::furniture, true},
  }};
  OpenThing thing = open_.back();
  const auto known = std::find_if(kKnown.begin(), kKnown.end(), [&](const Known& k) { return k.name == e.name; });
  auto& surfaces = building().surfaces;
  const bool opening = e.name == "Window" || e.name == "Door";
  if (known == kKnown.end() && !opening) return Role::other;
  if (known != kKnown.end() || thing.surface < 0) {  // an opening without a surface gets a wall
    Surface s;
    if (known != kKnown.end()) {
      s.surface_class = known->surface_class;
      s.id = e.attributes.id;
      thing.interior = thing.interior || known->interior;
    }
    s.interior = thing.interior;
    s.of_installation = thing.installation;
    thing.installation = thing.installation || s.surface_class == SurfaceClass::installation;
    thing.surface = static_cast<int>(surfaces.size());
    thing.opening = -1;
    surfaces.push_back(std::move(s));
  }
  if (opening) {
    auto& openings = surfaces[static_cast<std::size_t>(thing.surface)].openings;
    thing.opening = static_cast<int>(openings.size());
    openings.push_back({e.name == "Door", e.attributes.id, {}});
  }
  open_.push_back(thing);
  return opening ? Role::opening : Role::surface;
}

CityGmlParser::Role CityGmlParser::start_geometry(const Element& e) {
  if (any_of(e.name, {"Polygon", "PolygonPatch", "Triangle", "Rectangle"})) {
    polygon_.emplace();
    polygon_->id = e.attributes.id;
    return Role::polygon;
  }
  if (e.name == "Solid" && in_template_) return Role::solid;
  if (e.name == "Solid") {
    Pending& pending = pending_.back();
    if (pending.begin == links_.size()) {
      Geometry& g = geometries_of(pending.building, pending.surface, pending.opening)[pending.geometry];
      g.kind = GeometryKind::solid;
      g.id = e.attributes.id;
    } else {
      end_geometry();
      begin_geometry(GeometryKind::solid, e.attributes.id);
    }
    return Role::solid;
  }
  if (e.name == "ImplicitGeometry") {  // in a property for geometry of its own, where none belongs
    if (!in_template_) ++building().implicit_geometries;
    notes_.add(NoteKind::not_read, e.line, "an ImplicitGeometry as a geometry");
    return skip();
  }
  if (any_of(e.name, {"LineString", "Curve", "MultiCurve", "CompositeCurve", "Point", "MultiPoint"})) {
    notes_.add(NoteKind::not_read, e.line, "a " + e.name);
    return skip();
  }
  if (e.name == "appearance") return skip();  // of a TexturedSurface
  if (!e.attributes.href.empty()) links_.add_link(e.attributes.href, reversed_, e.line);
  if (any_of(e.name, {"OrientableSurface", "TexturedSurface"})) {
    if (e.attributes.negative) reversed_ = !reversed_;
    return Role::orientable;
  }
  if (e.name == "interior" && parent_role() == Role::solid && !in_template_) {
    Pending& pending = pending_.back();
    pending.voids = std::min(pending.voids, links_.size());
  }
  return Role::aggregate;
}

CityGmlParser::Role CityGmlParser::start_in_polygon(const Element& e) {
  if (any_of(e.name, {"exterior", "outerBoundaryIs", "interior", "innerBoundaryIs"})) {
    interior_ring_ = e.name.starts_with("in");
    return Role::ring_side;
  }
  if (any_of(e.name, {"LinearRing", "Ring"})) {
    in_ring_ = true;
    ring_is_bad_ = false;
    ring_.clear();
    return Role::ring;
  }
  return in_ring_ && any_of(e.name, {"posList", "pos", "coordinates"}) ? Role::coordinates : Role::other;
}

}  // namespace blockrand::importers::reference
