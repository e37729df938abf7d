// The plane that fits a face's points best. Only for sources of this folder: it includes Eigen.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <span>

#include "pipeline/model/point.h"
#include "pipeline/model/solid.h"

namespace blockrand::geometry {

inline Eigen::Vector3d between(const model::Point3& from, const model::Point3& to) {
  return {to.x - from.x, to.y - from.y, to.z - from.z};
}

/// Two directions in the fitted plane, and its normal.
struct Frame {
  model::Point3 origin;
  Eigen::Vector3d right, up, normal;
};

/// Least squares. \param points  m; of all rings of the face
Frame fitted_frame(std::span<const model::Point3> points);

/// Whether a face has no folds: its points lie nearer than 1e-7 m to one plane, by which doubles are wrong.
bool is_flat(const model::Solid& solid, const model::Face& face);

/// Rad between two unit vectors whose difference has this length.
inline double angle_between(double difference) { return 2 * std::asin(std::min(1.0, difference / 2)); }

}  // namespace blockrand::geometry
