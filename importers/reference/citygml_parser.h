// CityGML's elements, one after the other, become buildings. Knows nothing of where the bytes come from and of CRS.
// Internal to this folder.
#pragma once

#include <libxml/xmlstring.h>

#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "importers/reference/links.h"
#include "importers/reference/note_log.h"
#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

/// What a document says beside its buildings.
struct DocumentFacts {
  bool city_model = false;             ///< some element is CityGML's
  std::string root;                    ///< local name of the outermost element
  std::string foreign_version;         ///< "3.0" where the elements are of a version that is not read
  std::vector<std::string> srs_names;  ///< different ones in order of appearance, a few at most
  std::string description;             ///< of the city model
  bool has_doctype = false;
  std::vector<double> lower, upper;  ///< corners of the model's envelope as written; empty without one
};

/// An element as libxml2's SAX2 interface gives it: five entries for each attribute (local name, prefix, namespace,
/// begin and end of the value).
struct XmlElement {
  std::string_view name, space;
  int line = 0;
  int attribute_count = 0;
  const xmlChar** attributes = nullptr;
};

/// Takes a document's events as they come: `element`, `end_element` and `text`, then `cut_off` and `finish`.
class CityGmlParser {
 public:
  CityGmlParser(ReferenceModel& model, NoteLog& notes) : model_(model), notes_(notes) {}

  void element(const XmlElement& element);
  void end_element();
  void text(std::string_view characters) {
    if (collects_) text_ += characters;
  }
  void doctype() { facts_.has_doctype = true; }
  /// At the end of the text, and where the next member of the city model starts too early: forgets a building that has
  /// no end.
  void cut_off();
  /// Resolves links. Call once.
  void finish();

  const DocumentFacts& facts() const { return facts_; }

 private:
  enum class Space { gml, citygml, foreign, none };
  enum class Role {
    other,
    building,
    surface,
    opening,
    property,
    aggregate,
    solid,
    orientable,
    polygon,
    ring_side,
    ring,
    coordinates,
    attribute_set,
    attribute,
    attribute_value,
    value,
    envelope,
    corner,
    description,
    implicit_property,
    relative_geometry,
    matrix,
    library,
    reference_point,
  };
  struct Attributes {
    std::string id, href, srs_name, name, uom, decimal, within, between;
    bool negative = false;  ///< orientation="-"
    int dimension = 0;      ///< srsDimension
  };
  struct Element {
    std::string name;
    Role role = Role::other;
    Space space = Space::none;
    int line = 0;
    int dimension = 0;           ///< stated here or further out; 0: nowhere
    std::size_t first_item = 0;  ///< of an element that links may name
    Attributes attributes;
  };
  /// A geometry whose faces are not resolved yet.
  struct Pending {
    std::size_t building;
    int surface, opening;  ///< -1: none
    std::size_t geometry;
    std::size_t begin, voids, end;  ///< items; the shells of voids start at `voids`
  };

  /// A use of a template, whose faces are not resolved yet.
  struct Implicit {
    std::size_t building;
    int surface, opening;  ///< -1: none
    int lod, line;
    std::size_t begin, end;               ///< items: the template itself, or a link to it
    std::vector<double> matrix;           ///< row by row; empty: none is stated
    std::vector<double> reference_point;  ///< empty: none is stated
    std::string library;                  ///< file that holds the template
    bool bad_numbers = false;
  };

  Attributes read_attributes(const XmlElement& element);
  Space space_of(std::string_view uri);
  Role start(const Element& e);
  Role start_outside(const Element& e);
  Role start_in_building(const Element& e);
  Role start_property(const Element& e);
  Role start_thing(const Element& e);
  Role start_implicit(const Element& e);
  Role start_template(const Element& e);
  Role start_geometry(const Element& e);
  Role start_in_polygon(const Element& e);
  Role start_building(const Element& e);
  void end(const Element& e);
  void end_value(const Element& e);
  void end_coordinates(const Element& e);
  void end_ring(const Element& e);
  void end_polygon(const Element& e);
  void end_corner();
  void end_template();
  void place(const Implicit& use);
  void drop_empty_geometries();
  Role skip() {
    skip_depth_ = stack_.size() + 1;
    return Role::other;
  }

  std::vector<Geometry>& geometries_of(std::size_t building, int surface, int opening);
  void begin_geometry(GeometryKind kind, const std::string& id);
  void end_geometry() { pending_.back().end = links_.size(); }

  std::string_view parent_name(std::size_t up = 1) const {
    return stack_.size() >= up ? std::string_view(stack_[stack_.size() - up].name) : std::string_view();
  }
  Role parent_role() const { return stack_.empty() ? Role::other : stack_.back().role; }
  Building& building() { return model_.buildings[open_.back().building]; }

  ReferenceModel& model_;
  NoteLog& notes_;
  DocumentFacts facts_;
  Links links_;
  std::vector<Element> stack_;
  std::size_t skip_depth_ = 0;  ///< >0: elements from this depth on are not looked at
  bool collects_ = false;
  std::string text_;
  std::unordered_set<std::string> ids_;  // looked up only

  struct OpenThing {
    std::size_t building;
    int surface = -1, opening = -1;
    bool interior = false, installation = false;  ///< inside of one
  };
  std::vector<OpenThing> open_;  ///< innermost last: buildings, their surfaces, their openings

  std::vector<Pending> pending_;
  std::vector<Implicit> implicit_;
  bool in_implicit_ = false;     ///< within the last of them
  bool in_template_ = false;     ///< within its relativeGMLGeometry, or one of an object that is not looked at
  std::size_t resume_skip_ = 0;  ///< skip_depth_ behind that template
  std::size_t placed_faces_ = 0;
  std::vector<bool> is_template_;  ///< as ReferenceModel::polygons, to the last one of a template
  bool in_property_ = false;
  int property_lod_ = 0;
  bool reversed_ = false;
  std::optional<Polygon3> polygon_;
  bool interior_ring_ = false, in_ring_ = false, ring_is_bad_ = false;
  std::vector<model::Point3> ring_;
};

}  // namespace blockrand::importers::reference
