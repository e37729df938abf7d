// Reads the meshes of GLB tiles for the judges, feature by feature. Shares no code with the exporter.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::validators {

struct GlbTriangle {
  std::array<model::Point3, 3> corners;  ///< dequantised; m in the tile's frame, z up
  std::array<double, 3> normal{};        ///< of the first corner; z up
  std::array<double, 3> colour{};        ///< linear light of the first corner
  std::string material;
};

/// One row of the property table, with what is drawn for it.
struct GlbFeature {
  std::string id;
  std::map<std::string, std::string> texts;  ///< STRING and ENUM columns; what is noData is left out
  std::map<std::string, double> numbers;     ///< SCALAR columns; what is noData is left out
  std::vector<GlbTriangle> triangles;
};

struct GlbFile {
  std::string crs, height_reference, copyright;
  double longitude = 0, latitude = 0, height = 0;
  std::array<double, 16> local_to_ecef{};
  std::vector<GlbFeature> features;
};

/// \throws std::runtime_error  not a GLB, an index or id out of range
GlbFile read_glb(const std::string& path);
GlbFile read_glb_bytes(const std::string& bytes);

}  // namespace blockrand::validators
