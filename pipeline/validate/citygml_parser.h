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
  /// A polygon of LoD3's boundary surfaces, or a reference to one of LoD2's.
  struct Member {
    std::string id;
    std::size_t surface = 0;  ///< of the body's boundary surfaces, in their order
    bool link = false;
    ReadPolygon polygon;
  };
  struct OpenedWall {
    std::string id;
    std::size_t surface = 0;
    std::string polygon;  ///< its id
    std::optional<std::size_t> placement;
  };
  /// A body in the making, beside what Contents keeps of it.
  struct Open {
    std::size_t body = 0;
    bool has_parts = false;
    std::string function;
    std::vector<std::pair<std::string, ReadPolygon>> surfaces;  ///< polygon id and polygon
    std::vector<Member> members;                                ///< of LoD3
    std::vector<OpenedWall> openings;
    std::array<std::vector<std::string>, 4> references;  ///< of the solids, by LoD
    std::array<bool, 4> has_reference_solid{};
    std::size_t boundary_surfaces = 0;
  };
  struct Element {
    std::string id;
    std::vector<ReadPolygon> polygons;
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

  void start_multi_surface(const std::string& id);

  void start_core(xmlTextReaderPtr reader, std::string_view name);

  void start_building(std::string_view name, const std::string& id);

  void end();

  void end_ring();

  void end_polygon();

  void end_reference_point();

  /// Elements are turned about the vertical alone.
  void end_implicit();

  void note_place(const std::string& id, Place place) {
    if (!id.empty()) places_.emplace(id, place);
  }

  /// The LoD3 solid gets the polygons of its boundary surfaces, those of LoD2 among them.
  void end_detail(const Open& open, ReadBody& body);

  /// The solids get the polygons of their boundary surfaces.
  void end_body();

  void finish_attributes(ReadBody& body);

  void end_corner(bool lower);

  void end_attribute();

  void end_element(std::string_view name);

  /// "#rrggbb" of three numbers from 0 to 1.
  std::string colour(const std::string& text);

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
  std::vector<std::pair<std::string, Place>> shared_;  ///< polygons of LoD3 that are those of LoD2, by their id
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
  bool in_solid_ = false, in_polygon_ = false, by_reference_ = false, outside_ = false;
  int line_ = 0, found_ = 0;
};

}  // namespace blockrand::validate
