// Where the bodies of a tile are made: what they are made of, which of them the tile has, what they stand on.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "pipeline/model/surroundings.h"
#include "pipeline/surroundings/ground_claims.h"

namespace blockrand::surroundings {

/// m. Pieces of bodies are no longer: whether they are cut depends on the ground this far around.
inline constexpr double kLongest = 60;

/// The ground at a place in plan.
struct GroundAt {
  bool building = false;
  model::GroundClass ground = model::GroundClass::land;
  double height = 0;  ///< m above the height reference, of the surface that lies there
};
using GroundAtPlace = std::function<GroundAt(model::Point2)>;

struct BodySite {
  const SurroundingInputs& in;
  const ClaimFinder& claims;
  const std::function<bool(model::Point2)>& is_own;            ///< whether the tile has what lies at a place
  const geometry::PlanBox& around;                             ///< m, all places that `is_own` takes
  const GroundAtPlace& ground;                                 ///< known within kLongest of `around`
  const std::function<double(model::Point2)>& terrain_height;  ///< m, anywhere
};

/// A body of a thing without faces. \param material  name
inline model::SurroundingBody body_of(const BodySite& site, const Thing& thing, model::BodyClass kind,
                                      std::string_view material) {
  model::SurroundingBody made;
  made.body = kind, made.object = site.in.extract.features[thing.feature].id;
  made.material = site.in.catalogue.material(material);
  return made;
}

/// A triangle, and a quadrilateral as two of them: counter-clockwise seen from where they are seen.
inline void add_triangle(std::vector<model::FlatPolygon>& out, model::Point3 a, model::Point3 b, model::Point3 c) {
  if (a != b && b != c && a != c) out.push_back({{a, b, c}, {}});
}
inline void add_quad(std::vector<model::FlatPolygon>& out, model::Point3 a, model::Point3 b, model::Point3 c,
                     model::Point3 d) {
  add_triangle(out, a, b, c), add_triangle(out, a, c, d);
}

}  // namespace blockrand::surroundings
