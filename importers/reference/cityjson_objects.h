// CityJSON's city objects become buildings. Knows nothing of files and of CRS. Internal to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "importers/reference/json_access.h"
#include "importers/reference/note_log.h"
#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

/// Takes a header, then the city objects of a document or of one feature after the other.
class CityJsonObjects {
 public:
  CityJsonObjects(ReferenceModel& model, NoteLog& notes) : model_(model), notes_(notes) {}

  /// How integer vertices become coordinates: v * scale + translate.
  struct Transform {
    std::array<double, 3> scale{1, 1, 1}, translate{0, 0, 0};
  };
  void set_transform(const Transform& transform) { transform_ = transform; }

  /// "geometry-templates" of the header; taken over.
  void set_templates(Json templates);

  /// \param ids   of `objects`, in the order of the file
  /// \param line  where they stand; 0: not known
  void add(const Json& objects, const std::vector<std::string>& ids, const Json& vertices, int line);

 private:
  /// An object that is a building or belongs to one.
  struct Member {
    const Json* object = nullptr;
    int role = 0;  ///< index into the list of known types
    std::size_t parent = kNone;
    std::vector<std::size_t> children;
    std::size_t building = kNone;  ///< index into ReferenceModel::buildings
  };
  /// Where a geometry goes: the building itself, or one of its surfaces.
  struct Target {
    std::size_t building = 0;
    int surface = -1;
    bool interior = false, of_installation = false;
  };
  /// The points that boundaries refer to, and where a template puts them.
  struct Points {
    const std::vector<model::Point3>* list = nullptr;
    std::optional<std::array<double, 16>> matrix;  ///< row by row
    model::Point3 origin;
    bool mirrored = false;  ///< by the matrix: outside would become inside
  };
  struct Faces {
    std::vector<Face> faces;
    std::vector<std::vector<Face>> by_class;  ///< as the semantic surfaces
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  std::vector<model::Point3> points_of(const Json& vertices, bool transformed);
  void read_members(const Json& objects, const std::vector<std::string>& ids);
  void find_parents();
  void cut_circles();
  void add_building(std::size_t first);
  void add_thing(std::size_t member);
  void read_attributes(const Json& object, Building& building);
  bool read_known(const std::string& name, const Json& value, Building& building);
  void read_generic(const std::string& name, const Json& value, Building& building, int depth);
  void read_geometries(const Json& object, const Target& target);
  void read_geometry(const Json& geometry, const Points& points, const Target& target, int lod);
  void read_instance(const Json& geometry, const Target& target);
  void read_shell(const Json& shell, const Json& values, const Points& points, Faces& out);
  std::optional<std::vector<model::Point3>> read_ring(const Json& ring, const Points& points);
  void add_surfaces(const Json& semantics, Faces& faces, const Target& target, int lod);
  std::optional<double> level_of(const Json& geometry);
  std::vector<Geometry>& geometries_of(const Target& target);
  void note(NoteKind kind, const std::string& what) {
    notes_.add(kind, line_, here_.empty() ? what : "\"" + here_ + "\": " + what);
  }

  ReferenceModel& model_;
  NoteLog& notes_;
  Transform transform_;
  Json templates_;
  std::vector<model::Point3> template_points_;
  std::size_t instance_faces_ = 0;
  int line_ = 0;
  std::string here_;  ///< id of the object that is being read
  std::vector<model::Point3> vertices_;
  std::vector<Member> members_;
  std::vector<std::string> member_ids_;                   // as members_
  std::unordered_map<std::string, std::size_t> numbers_;  // of members_ by id; looked up only
  std::unordered_set<std::string> building_ids_;          // looked up only
};

}  // namespace blockrand::importers::reference
