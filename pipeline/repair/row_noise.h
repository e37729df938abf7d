// How exactly a row was mapped, and how much of each building is meant to be square.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace blockrand::repair {

inline constexpr double kLeastNoise = 0.004;   // m. OSM's grid of 11 mm has a standard deviation of 3 mm
inline constexpr double kLargestNoise = 0.16;  // m. Walls off by more than half a metre are no slips of a mapper's hand

/// A wall's sideways deviation from its building's frame.
struct Deviation {
  double off = 0;              ///< m, at least 0, as if one corner of weight 1 had it all: sine of the angle times sqrt(weight)
  double range = 0;            ///< m. Of a wall of no frame it is anywhere in [0, range]
  std::uint32_t building = 0;  ///< ascending
};

struct RowNoise {
  double noise = 0;           ///< m, standard deviation of a corner's coordinate, never below what is known; see fit_noise
  std::vector<double> share;  ///< per building, (0, 1): of its walls that belong to its frame
};

/// Fits a mixture per row: the walls of a frame deviate by Student's t with three degrees of freedom, whose scale is the
/// noise of the whole row; other walls evenly over their range, in a share of each building's own (EM, from a low and a
/// high noise; the likelier end; McLachlan & Peel, Finite Mixture Models, 2000, ch. 7). Rows in which most walls are
/// oblique keep a small noise so. Where few walls tell, the noise is raised by its uncertainty. Within kLeastNoise and
/// kLargestNoise.
RowNoise fit_noise(std::span<const Deviation> deviations, std::size_t buildings);

}  // namespace blockrand::repair
