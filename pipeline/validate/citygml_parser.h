// The parser behind read_citygml(): elements as they come, joined by their ids at the end of each body and of the file.
#pragma once

#include <fmt/format.h>
#include <libxml/xmlreader.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "pipeline/geometry/solid_defect.h"
#include "pipeline/validate/citygml_reader.h"

namespace blockrand::validate {

class CityGmlParser {
 public:
  CityGmlParser(const std::string& name, CityGml& out) : name_(name), out_(out) {}

  /// \return false where the file is not well-formed
  bool parse(xmlTextReaderPtr reader);

 private:
  /// Where the polygons of a MultiSurface belong.
  enum class Target { footprint, surface, detail_surface, installation, element };
  /// A polygon of a solid, or a reference to one of another solid of the body.
  struct Member {
    std::string id;
    bool link = false;
    ReadPolygon polygon;
  };
  /// A reference of a boundary surface or opening to a polygon of its solid.
  struct SurfaceMember {
    std::string id, kind;
    std::size_t surface = 0;  ///< of the body's boundary surfaces, in their order
  };
  struct OpenedWall {
    std::string id;
    std::size_t surface = 0;
    std::string polygon;  ///< its id
    std::optional<std::size_t> placement;
    std::optional<double> depth;  ///< m, as its own attribute says
  };
  /// A body in the making, beside what Contents keeps of it.
  struct Open {
    std::size_t body = 0;
    bool has_parts = false;
    std::string function;
    std::array<std::vector<Member>, 4> solids;           ///< by LoD
    std::array<std::vector<SurfaceMember>, 4> surfaces;  ///< by LoD
    std::vector<OpenedWall> openings;
    std::size_t boundary_surfaces = 0;
    std::unordered_map<std::size_t, double> depths;  ///< of openings, m, by boundary surface
  };
  struct Element {
    std::string id;
    std::vector<ReadPolygon> polygons;
    std::vector<std::pair<std::size_t, std::string>> links;  ///< polygons that are those of other elements, by their id
  };
  struct Material {
    std::string colour;
    std::vector<std::string> targets;
  };
  struct Place {
    std::size_t body = 0;
    int solid = kFootprint;  ///< of the body, or what else
    std::size_t polygon = 0;
    std::size_t item = 0;  ///< the installation of the body, or the element
  };
  static constexpr int kFootprint = -1, kInstallation = -2, kElement = -3;
  /// A MultiSurface or CompositeSurface with an id, which appearances may name.
  struct Group {
    std::vector<Place> places;
    std::vector<std::string> ids;  ///< of polygons whose places are known later
  };

  void found(Check check, std::string what, std::string object, int number = 0) {
    if (++found_ > 1000) return;  // of one file
    out_.contents.findings.push_back(
        {check, name_, std::move(object), fmt::format("line {}: {}", line_, what), number});
  }
  void rule(std::string what, std::string object) { found(Check::citygml_rule, std::move(what), std::move(object)); }
  void defect(geometry::SolidDefect what) {
    found(Check::citygml_rule, fmt::format("{} {}", iso_code(what), name(what)), object(), iso_code(what));
  }

  std::string_view parent(std::size_t up = 1) const {
    return stack_.size() > up ? stack_[stack_.size() - 1 - up] : std::string_view();
  }
  ReadBody* body() { return open_.empty() ? nullptr : &out_.contents.bodies[open_.back().body]; }
  std::string object() { return open_.empty() ? std::string() : body()->id; }

  void start(xmlTextReaderPtr reader);

  void start_gml(xmlTextReaderPtr reader, std::string_view name, const std::string& id);

  void start_surface_member(const std::string& href);

  void start_multi_surface(const std::string& id);

  void start_core(xmlTextReaderPtr reader, std::string_view name);

  void start_building(std::string_view name, const std::string& id);

  void end();

  void end_ring();

  void end_polygon();

  void end_reference_point();

  /// Elements are turned about the vertical alone.
  void end_implicit();

  /// Where a polygon is, for appearances.
  void note_place(const std::string& id, Place place) {
    if (!id.empty()) places_.emplace(id, place);
    for (const std::string& group : group_ids_)
      if (!group.empty()) groups_[group].places.push_back(place);
  }
  /// The same for one whose place is not known yet.
  void note_link(const std::string& id) {
    for (const std::string& group : group_ids_)
      if (!group.empty() && !id.empty()) groups_[group].ids.push_back(id);
  }

  using PolygonIndex = std::unordered_map<std::string_view, std::size_t>;

  /// The polygons of a body's solid of one LoD. \return where they are, by id
  PolygonIndex end_solid(const Open& open, ReadBody& body, std::size_t lod);

  /// The polygons of a solid get their kinds from the boundary surfaces. \return by member of the surfaces its polygon;
  /// kNowhere for those that are not in the solid
  std::vector<std::size_t> end_surfaces(const Open& open, ReadBody& body, std::size_t lod, const PolygonIndex& index);
  static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

  /// The openings get their polygons, walls and reveals.
  void end_openings(const Open& open, ReadBody& body, const std::vector<std::size_t>& polygon_of);

  void end_body();

  void finish_attributes(ReadBody& body);

  void end_corner(bool lower);

  void end_attribute();

  /// The attribute of a boundary surface or opening that says how far openings lie behind their wall.
  void end_reveal_depth();

  void end_element(std::string_view name);

  /// "#rrggbb" of three numbers from 0 to 1.
  std::string colour(const std::string& text);

  /// Gives the polygon with an id a colour. \return false where there is none
  bool paint(const std::string& id, const std::string& colour);
  void paint(const Place& place, const std::string& colour, const std::string& id);
  /// Colours of polygons: from appearances of them or of surfaces that they are members of.
  void finish_colours();
  void finish_elements();

  void place_element(const ReadBody& body, ReadPlacement& placement, std::uint64_t element);

  ReadPolygon& polygon_at(const Place& place);

  void finish();

  const std::string& name_;
  CityGml& out_;
  std::vector<std::string_view> stack_;
  std::vector<Open> open_;  ///< the building, and its part where one is open
  std::vector<std::size_t> assemblies_;
  std::unordered_set<std::string> ids_;
  std::unordered_map<std::string, Place> places_;  ///< polygons by gml:id
  std::vector<Material> materials_;
  std::optional<model::Point3> lower_, upper_;
  struct Placed {
    std::size_t body = 0, placement = 0;
    std::string element;
  };
  std::vector<std::pair<std::string, Place>> shared_;  ///< polygons of a solid that stand in another, by their id
  std::vector<std::string> group_ids_;                 ///< of the surfaces that are open, outermost first
  std::unordered_map<std::string, Group> groups_;
  std::vector<Element> elements_;
  std::unordered_map<std::string, std::size_t> element_at_;
  std::vector<Placed> placed_;
  Target target_ = Target::footprint;
  std::vector<double> matrix_;
  std::optional<model::Point3> reference_point_;
  std::string opening_, element_, installation_, installation_kind_;
  bool in_installation_ = false;
  ReadPolygon polygon_;
  std::string text_, surface_, attribute_, polygon_id_, solid_id_;
  bool in_solid_ = false, in_polygon_ = false, outside_ = false;
  int line_ = 0, found_ = 0;
};

}  // namespace blockrand::validate
