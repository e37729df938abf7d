// The triangles of a glTF file become buildings in earth-centred coordinates. Internal to this folder.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "importers/reference/gltf_file.h"
#include "importers/reference/gltf_table.h"
#include "importers/reference/matrix4.h"
#include "importers/reference/note_log.h"
#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

/// Takes one file after the other: features of one id are one building, whatever file they stand in.
class GltfScene {
 public:
  GltfScene(ReferenceModel& model, NoteLog& notes) : model_(model), notes_(notes) {}

  /// \param place  leads from the file's axes (y up) to where the polygons are wanted
  /// \throws base::InputError  when instances multiply without end
  void add(GltfFile& file, const std::string& path, const Matrix4& place);

  /// From a node to its parent. Nothing where its matrix is none.
  static std::optional<Matrix4> transform_of(const Json& node);

 private:
  /// Who owns a triangle: a row of a table, a feature or batch without one, or a node.
  struct Feature {
    enum class Kind : std::uint8_t { row, number, node } kind = Kind::node;
    std::size_t table = 0, number = 0;
    friend auto operator<=>(const Feature&, const Feature&) = default;
  };
  struct Instance {
    Matrix4 transform;
    std::vector<Feature> features;  ///< one or none
  };
  struct Owner {
    std::size_t building = 0;
    int lod = 2;
  };

  void add_rows(std::size_t table);
  std::size_t building_of(const std::string& id, int parent, const std::string& key);
  void take_attributes(const FeatureTable& table, std::size_t row, Building& building);
  Owner owner_of(const Feature& feature, std::size_t node);
  std::string name_of_node(std::size_t node) const;
  void walk(const Matrix4& place);
  std::optional<std::size_t> row_of_node(const Json& node) const;
  void add_node(std::size_t node, const Matrix4& world);
  void count_triangles(const Json& primitive, std::size_t instances);
  [[noreturn]] void refuse_number(std::size_t most, const std::string& what) const;
  std::vector<Instance> instances_of(const Json& node, const Matrix4& world);
  /// What a material's faces look like without its images; none: there is no such material.
  std::optional<model::Colour> colour_of(const Json& material) const;
  void add_primitive(const Json& primitive, std::size_t node, const Instance& instance);
  /// The feature of each vertex; empty where the file says none.
  std::vector<Feature> features_of(const Json& primitive, std::size_t vertices);
  std::vector<std::size_t> triangles_of(const Json& primitive, std::size_t vertices);

  ReferenceModel& model_;
  NoteLog& notes_;
  std::size_t placed_triangles_ = 0, placed_primitives_ = 0;  ///< of all files
  std::unordered_map<std::string, std::size_t> by_key_;       ///< buildings of all files; looked up only

  // Of the file that is being read.
  GltfFile* file_ = nullptr;
  std::vector<FeatureTable> tables_;
  std::vector<bool> table_used_;
  std::vector<std::vector<Owner>> row_owners_;
  std::map<Feature, Owner> owners_;
};

}  // namespace blockrand::importers::reference
