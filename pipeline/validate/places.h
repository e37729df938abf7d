// Where the corners of a body stand, and how far a place of OpenStreetMap is from the nearest of them.
#pragma once

#include <vector>

#include "pipeline/georef/proj_transform.h"
#include "pipeline/validate/contents.h"
#include "pipeline/validate/glb.h"

namespace blockrand::validate {

/// Longitude and latitude in degrees of a mesh's corners, through the transform to earth-centred coordinates and PROJ.
std::vector<model::Point2> corners_on_earth(georef::ProjTransform& proj_transform, const Matrix& transform,
                                            const std::vector<GlbTriangle>& triangles);

/// All corners of footprint and solids, in the build CRS.
std::vector<model::Point2> plan_points(const ReadBody& body);

/// Metres east and north in the CRS from a place to the nearest point; a thousand kilometres where there is none.
model::Point2 offset(const std::vector<model::Point2>& points, model::Point2 at);
/// The same on the ground, of points in degrees.
model::Point2 offset_on_earth(const std::vector<model::Point2>& points, model::Location at);

}  // namespace blockrand::validate
