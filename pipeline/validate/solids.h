// What the two judges of solids say: our own checker, in exact arithmetic, and CGAL.
#pragma once

#include <string>
#include <vector>

#include "pipeline/validate/contents.h"
#include "pipeline/validate/glb.h"

namespace blockrand::validate {

/// Empty texts: valid.
struct Verdict {
  std::string own, cgal;
  bool valid() const { return own.empty() && cgal.empty(); }
  bool agreed() const { return own.empty() == cgal.empty(); }
  std::string text() const;
};

/// Of a solid whose points lie on the 1/1024 m grid.
Verdict judge(const ReadSolid& solid);

/// Of a mesh of triangles, whose corners are equal only when their coordinates are.
Verdict judge(const std::vector<GlbTriangle>& triangles);

/// The finding that a verdict makes, or nothing: SOLID_INVALID, or JUDGES_DISAGREE where only one of them objects.
void note(const Verdict& verdict, const std::string& file, const std::string& object, const std::string& which,
          std::vector<Finding>& findings);

}  // namespace blockrand::validate
