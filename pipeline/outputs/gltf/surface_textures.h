// Which faces of a mesh carry which texture, and where it lies on them.
//
// Walls: courses are level and start at the ground of the building part; along the outline they run on around its corners, and
// are stretched by a few per mille so that the last meets the first. Roofs: rows follow the slope up from the lowest point
// of their plane. Flat roofs: along the longest wall. Ground: along the axes of the build CRS, through all tiles alike; paving of a street along it.
#pragma once

#include <array>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "pipeline/model/region.h"
#include "pipeline/outputs/frame.h"
#include "pipeline/outputs/gltf/mesh_buffers.h"
#include "pipeline/outputs/gltf/texture_set.h"

namespace blockrand::outputs {

/// The outline of a building part in the frame of a mesh, by which courses are laid.
struct CourseOutline {
  std::vector<model::Point2> points;  ///< counter-clockwise; empty: none is known
  std::vector<double> along;          ///< m from the first point, one more than points: the last is the whole length
  double ground = 0;                  ///< m, where courses start
};

/// Of the parts of owned buildings, as the features of build_mesh() count them.
std::vector<CourseOutline> course_outlines(const model::Region& region, const Frame& frame);

/// What write_mesh() needs to texture a mesh.
class SurfaceTextures {
 public:
  enum class Of : std::uint8_t { buildings, ground };

  /// All must outlive it. \param folder  from the file to the pictures: "../../../textures/"
  SurfaceTextures(const TextureSet& set, Of of, std::span<const model::MaterialClass> classes,
                  std::span<const CourseOutline> outlines, std::string folder);

  /// The faces of a primitive of `mesh` that have no texture, first, and those of each texture. Triangles of a face lie in a
  /// plane. Elements have none.
  std::vector<MeshPrimitive> split(const MeshPrimitive& all, const Mesh& mesh);

  /// The material of a primitive that split() made.
  int material(GlbDocument& document, const MeshPrimitive& primitive) const;
  /// The same of a primitive of one colour, which is the material's, with repeats as they are.
  int material(GlbDocument& document, const MeshPrimitive& primitive, const model::Colour& colour) const;
  /// What its colours are divided by, in linear light.
  const std::array<double, 3>& mean(const MeshPrimitive& primitive) const { return set_.mean(primitive.texture); }

  /// Names of the textures that were used so far.
  const std::set<std::string>& used() const { return used_; }
  /// Triangles whose colour is too light for their texture: they stay plain.
  std::size_t too_light() const { return too_light_; }

 private:
  struct Layout;
  int row_of(const MeshVertex& vertex) const;
  Layout layout_of(int row, const MeshVertex& vertex, const model::Point3& normal, const model::Point3& middle) const;

  const TextureSet& set_;
  Of of_;
  std::span<const model::MaterialClass> classes_;
  std::span<const CourseOutline> outlines_;
  std::string folder_;
  std::vector<std::array<int, 3>> rows_;  ///< by class: on walls, roofs, grounds
  std::set<std::string> used_;
  std::size_t too_light_ = 0;
};

}  // namespace blockrand::outputs
