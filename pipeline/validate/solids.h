// What the two validators of solids say: our own checker, in exact arithmetic, and CGAL.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/validate/contents.h"
#include "pipeline/validate/glb.h"

namespace blockrand::validate {

/// Empty texts: valid.
struct SolidValidity {
  std::string own, cgal;
  int number = 0;  ///< of the defect that our own checker found (geometry/solid_defect.h); 0 where it found none
  bool valid() const { return own.empty() && cgal.empty(); }
  bool agreed() const { return own.empty() == cgal.empty(); }
  std::string text() const;
};

/// Of a solid whose points lie on the 1/1024 m grid.
SolidValidity validator(const ReadSolid& solid);

/// Of surfaces that need not bound anything: their polygons alone (codes of ISO 19107 below 300), by our own checker.
SolidValidity surfaces_validity(const ReadSolid& surfaces);

/// Of a mesh of triangles, whose corners are equal only when their coordinates are.
SolidValidity validator(const std::vector<GlbTriangle>& triangles);

/// A surface of triangles, equal points being one vertex.
struct ReadMesh {
  std::vector<model::Point3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
/// Nothing where a face cannot be triangulated, or the body is larger than the validators take.
std::optional<ReadMesh> read_mesh(const ReadSolid& solid);
std::optional<ReadMesh> read_mesh(const std::vector<GlbTriangle>& triangles);

/// The finding that a verdict makes, or nothing: SOLID_INVALID, or JUDGES_DISAGREE where only one of them objects.
void note(const SolidValidity& validity, const std::string& file, const std::string& object, const std::string& which,
          std::vector<Finding>& findings);

}  // namespace blockrand::validate
