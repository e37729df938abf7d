// The shape that rules work on: a box of space with geometry in it, and everything that its children inherit.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "styles/grammar/language/value.h"
#include "styles/grammar/shapes/shape_mesh.h"

namespace blockrand::grammar {

/// A right-handed orthonormal frame: where its origin lies and its axes point, in the frame above it.
struct Frame {
  Vector3 origin;
  std::array<Vector3, 3> axes{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
};

/// A plane that cuts what is inserted later (docs/rule_language.md §2.4, §4.5), in object coordinates; what lies on the
/// side that the normal points to is cut away.
struct TrimPlane {
  Vector3 point, normal;
  bool horizontal = false;
};

/// A texture projection set up for one UV set (docs/rule_language.md §2.7), in object coordinates.
struct Projection {
  Vector3 origin, u_axis, v_axis, w_axis;  ///< axes have length one
  double width = 1, height = 1;            ///< m, of one tile; negative ones mirror
  double width_offset = 0, height_offset = 0;
  double u_along_w = 0;
};

/// Looks of a shape (docs/rule_language.md §3.1, `material.*`). The common ones are fields; the others keep their
/// names.
struct Material {
  std::array<double, 4> colour{1, 1, 1, 1};  ///< sRGB and opacity, 0 to 1
  double roughness = 1, metallic = 0;
  std::string colour_map;
  std::map<std::string, Value> others;  ///< by the name below "material.", only what was set
  bool operator==(const Material&) const = default;
};

struct SplitRecord {
  std::int32_t index = 0, total = 0;
};
struct ComponentRecord {
  std::string selector;
  std::int32_t index = -1, total = 0;
};

/// What stays the same in a whole derivation: where the object stands, and what it was at the start.
struct Origin {
  Frame world;                        ///< object coordinates in the world: x east, y up, z south
  std::vector<double> street_widths;  ///< m by edge of the first face, for street.*; empty when not known, 0: no street
  std::vector<Vector3> edge_normals;  ///< outward, by edge of the first face, in object coordinates
};

/// Everything that a rule sees and changes (docs/rule_language.md §2.0). Copying is cheap: what is large is shared and
/// replaced, never changed in place.
struct Shape {
  Frame pivot;   ///< in object coordinates, the frame of the initial shape
  Frame scope;   ///< in the pivot's frame: scope.t and scope.r
  Vector3 size;  ///< m; negative ones are legal
  MeshPointer
      mesh;  ///< in the scope's frame and in metres: turning and moving the scope does not touch it. May be null: empty
  std::shared_ptr<const Origin> origin;                  ///< may be null: object and world coordinates are the same
  std::shared_ptr<const Material> material;              ///< may be null: the default material
  std::shared_ptr<const std::vector<Value>> attributes;  ///< every `attr` and `const`, by the program's slot
  std::shared_ptr<const std::vector<TrimPlane>> trim_planes;
  std::shared_ptr<const std::array<Projection, kUvSetCount>> projections;
  bool trim_vertical = true, trim_horizontal = false;
  SplitRecord split;
  ComponentRecord component;
  std::uint64_t seed = 0;   ///< `seedian`
  std::uint32_t draws = 0;  ///< random numbers drawn with this seed so far
};

}  // namespace blockrand::grammar
