// Parts and installations of one building that overlap: val3dity's 601.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/validate/contents.h"
#include "pipeline/validate/glb.h"

namespace blockrand::validate {

struct PartsOverlap {
  std::string first, second;  ///< ids of the bodies, in the order of the file
  std::string detail;         ///< "601 overlaps w1.w3: 2.30 m³ in LoD 2"
};

/// All pairs of bodies of a building, and of what stands on its roofs, whose solids of one level of detail have room in
/// common: val3dity's 601 without a tolerance (geometry::kLeastCommonVolume); of eaves and what else lies along roofs what is 1 cm deep
/// and more than a cubic centimetre. What solids that are invalid give means
/// nothing.
/// \param pairs  increased by the pairs whose boxes meet, which were compared
std::vector<PartsOverlap> find_overlaps(const Contents& contents, std::uint64_t& pairs);
/// The same for the meshes of a GLB, whose coordinates are floats: only what is 1 cm deep and more than 0.01 m³ counts
/// (geometry::overlap_of).
std::vector<PartsOverlap> find_overlaps(const Glb& glb, std::uint64_t& pairs);

}  // namespace blockrand::validate
